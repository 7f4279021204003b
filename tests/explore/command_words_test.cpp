// Tests of the commands that make what a session shows.
#include "vpe/explore/command_words.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/explore/session_support.h"

namespace vpe::explore {
namespace {

using Words = std::vector<std::string>;

bool has_pair(const Words& words, const std::string& first, const std::string& second) {
  const auto at =
      std::adjacent_find(words.begin(), words.end(),
                         [&](const std::string& a, const std::string& b) { return a == first && b == second; });
  return at != words.end();
}

class CommandWords : public testing::Test {
 protected:
  CommandWords() {
    session_.resize(800, 500);
    session_.put({-59.2, -13.7, 40'000, 33.5, -20, 1});
  }
  Session session_ = test_support::session_at({-59.2, -13.7, 40'000, 33.5, -20, 1});
};

TEST_F(CommandWords, OfAnImageNameTheViewToTheBit) {
  session_.set_fov(41.25);
  MakeOptions options;
  options.planet = "/data/mars file.vpe";
  options.output = "view.png";
  EXPECT_EQ(image_words(session_, options),
            (Words{"render", "/data/mars file.vpe", "--pose=-59.2,-13.7,40000,33.5,-20,1", "--fov", "41.25",
                   "--size", "800x500", "-o", "view.png"}));
}

TEST_F(CommandWords, OfAnImageHaveSizeBackendEyesAndSettings) {
  ASSERT_EQ(session_.set("exaggeration", "2"), "");
  ASSERT_EQ(session_.set("overlay.scale", "on"), "");
  ASSERT_EQ(session_.set("lod.frame_ms", "17"), "");
  MakeOptions options;
  options.width_px = 3840;
  options.height_px = 2160;
  options.backend = core::Backend::kRay;
  options.stereo = core::StereoLayout::kAnaglyph;
  options.eye_base_m = 2.5;
  options.convergence_m = 300;
  Words words = image_words(session_, options);
  EXPECT_EQ(words.front(), "render");
  EXPECT_TRUE(has_pair(words, "--size", "3840x2160"));
  EXPECT_TRUE(has_pair(words, "--backend", "ray"));
  EXPECT_TRUE(has_pair(words, "--stereo", "anaglyph"));
  EXPECT_TRUE(has_pair(words, "--eye-base", "2.5"));
  EXPECT_TRUE(has_pair(words, "--convergence", "300"));
  EXPECT_TRUE(has_pair(words, "--set", "exaggeration=2"));
  EXPECT_TRUE(has_pair(words, "--set", "overlay.scale=on"));
  EXPECT_FALSE(has_pair(words, "--set", "lod.frame_ms=17"));
  options.has_overlays = false;
  words = image_words(session_, options);
  EXPECT_FALSE(has_pair(words, "--set", "overlay.scale=on"));
  EXPECT_TRUE(has_pair(words, "--set", "exaggeration=2"));
}

TEST_F(CommandWords, OfPanoramasLeaveOutOverlaysThatTheyDoNotHave) {
  ASSERT_EQ(session_.set("overlay.scale", "on"), "");
  ASSERT_EQ(session_.set("overlay.distances", "on"), "");
  ASSERT_EQ(session_.set("overlay.layers.legend", "on"), "");
  ASSERT_EQ(session_.set("sun.elevation", "12"), "");
  MakeOptions options;
  options.width_px = 8192;
  options.output = "p.jpg";
  const Words words = panorama_words(session_, options);
  EXPECT_TRUE(has_pair(words, "--set", "overlay.layers.legend=on"));
  EXPECT_EQ(words.front(), "panorama");
  EXPECT_EQ(words[1], "--at=-59.2,-13.7");
  EXPECT_EQ(words[2], "--altitude=40000");
  EXPECT_TRUE(has_pair(words, "--width", "8192"));
  EXPECT_FALSE(has_pair(words, "--set", "overlay.scale=on"));
  EXPECT_TRUE(has_pair(words, "--set", "overlay.distances=on"));
  EXPECT_TRUE(has_pair(words, "--set", "sun.elevation=12"));
}

TEST_F(CommandWords, OfAPlaceAreThoseOfPanoramaAndViewshed) {
  MakeOptions options;
  options.planet = "mars.vpe";
  options.output = "p.jpg";
  options.width_px = 4096;
  const Words words = panorama_words_at(session_, {137.5, -4.25}, 2.5, options);
  EXPECT_EQ(words, (Words{"panorama", "mars.vpe", "--at=137.5,-4.25", "--height=2.5", "--width", "4096", "-o",
                          "p.jpg"}));
  options.output = "v.tif";
  EXPECT_EQ(viewshed_words({-137.5, 4.25}, 1.75, 15'000, options),
            (Words{"viewshed", "mars.vpe", "--at=-137.5,4.25", "--from-height", "1.75", "--radius", "15000",
                   "-o", "v.tif"}));
}

TEST(UsualReach, IsAThousandPostsWithinItsLimits) {
  EXPECT_EQ(usual_reach_m(20, 3396190), 20'000);
  EXPECT_EQ(usual_reach_m(0.1, 3396190), 1000);
  EXPECT_EQ(usual_reach_m(8000, 3396190), 150'000);
  EXPECT_LT(usual_reach_m(100, 500), 500 * mars::kPi / 2);
}

TEST_F(CommandWords, OfFilmsNameFlightPlanetAndSize) {
  MakeOptions options;
  options.planet = "mars.vpe";
  options.output = "f.mp4";
  EXPECT_EQ(film_words(session_, "f.flight", options), (Words{"fly", "f.flight", "mars.vpe", "-o", "f.mp4"}));
  options.width_px = 1280;
  options.height_px = 720;
  EXPECT_TRUE(has_pair(film_words(session_, "f.flight", options), "--size", "1280x720"));
}

}  // namespace
}  // namespace vpe::explore
