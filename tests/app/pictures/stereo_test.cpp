// vpe render --stereo.
#include <algorithm>
#include <cmath>

#include "tests/app/support/app_fixture.h"
#include "vpe/core/image/image.h"

namespace app_test {
namespace {

class StereoRender : public AppTest {
 protected:
  static constexpr int kWidth = 200;
  static constexpr int kHeight = 160;

  // Straight down from 300 km.
  Words words(const std::string& output, const Words& more) const {
    Words all{"render", planet().string(), "--pose", "20,10,300000,0,-90,0",
              "--size", "200x160",         "--fov",  "40",
              "--set",  "mode=coloured",   "-o",     output};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
  vpe::core::RgbImage draw(const std::string& output, const Words& more) const {
    const Result result = vpe(words(output, more));
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return vpe::core::read_image(dir_ / output);
  }
};

TEST_F(StereoRender, TheEyesImagesAreShifted) {
  // f = 80 / tan 20 degrees = 219.8 pixels: a point 300 km below moves by 20 pixels for a base of 27.3 km.
  const vpe::core::RgbImage pair = draw("p.png", {"--stereo", "sbs", "--eye-base", "27298"});
  ASSERT_EQ(pair.width, 2 * kWidth);
  ASSERT_EQ(pair.height, kHeight);
  const auto difference = [&](int shift) {
    double sum = 0;
    for (int y = 40; y < 120; ++y) {
      for (int x = 40; x < 160; ++x) {
        const auto row = pair.pixels.begin() + y * pair.width;
        sum += std::abs(row[x + shift].r - row[kWidth + x].r) + std::abs(row[x + shift].g - row[kWidth + x].g);
      }
    }
    return sum;
  };
  int best = -40;
  for (int shift = -40; shift <= 40; ++shift) {
    if (difference(shift) < difference(best)) best = shift;
  }
  EXPECT_NEAR(best, 20, 1);  // the left eye sees it further right

  // Converging on the ground: no shift left there.
  const vpe::core::RgbImage meeting =
      draw("m.png", {"--stereo", "ou", "--eye-base", "27298", "--convergence", "300000"});
  ASSERT_EQ(meeting.height, 2 * kHeight);
  double apart = 0;
  double spread = 0;
  for (int y = 40; y < 120; ++y) {
    for (int x = 40; x < 160; ++x) {
      const auto at = [&](int row, int column) {
        return meeting.pixels[static_cast<std::size_t>(row * kWidth + column)].g;
      };
      apart += std::abs(at(y, x) - at(y + kHeight, x));
      spread += std::abs(at(y, x) - at(y + kHeight, x - 20));
    }
  }
  EXPECT_LT(apart, 0.5 * spread);
}

TEST_F(StereoRender, TheDefaultBaseIsAThirtiethOfTheNearestDistance) {
  const Result result = vpe(words("p.png", {"--stereo", "anaglyph", "--json", "--certificate", "c.json"}));
  ASSERT_EQ(result.exit_code, 0) << result.err;
  draw("one.png", {"--range", "r.tif"});
  const vpe::core::FloatImage range = vpe::core::read_tiff(dir_ / "r.tif");
  const double nearest_m = *std::min_element(range.pixels.begin(), range.pixels.end());
  const auto json = parse_json(result.out);
  EXPECT_NEAR(json["eye_base_m"].get<double>(), nearest_m / 30.0, 1e-6 * nearest_m);
  EXPECT_EQ(vpe::core::read_image(dir_ / "p.png").width, kWidth);
  const auto certificate = parse_json(read_text(dir_ / "c.json"));
  EXPECT_TRUE(certificate.contains("left") && certificate.contains("right"));
}

// Returns the mean difference of two images from a column on, as a share of white.
double mean_difference(const vpe::core::RgbImage& a, const vpe::core::RgbImage& b, int from_column) {
  double sum = 0;
  for (int y = 0; y < a.height; ++y) {
    for (int x = from_column; x < a.width; ++x) {
      const auto n = static_cast<std::size_t>(y * a.width + x);
      sum += std::abs(a.pixels[n].r - b.pixels[n].r) + std::abs(a.pixels[n].g - b.pixels[n].g) +
             std::abs(a.pixels[n].b - b.pixels[n].b);
    }
  }
  return sum / (3.0 * 255 * (a.width - from_column) * a.height);
}

TEST_F(StereoRender, ACarriedEyeIsNearlyTheOneDrawnInFull) {
  for (const char* backend : {"ray", "polygon"}) {
    const Words pair{"--stereo", "sbs", "--eye-base", "9000", "--set", "mode=lit", "--backend", backend};
    const auto with = [&](const Words& more) {
      Words all = pair;
      all.insert(all.end(), more.begin(), more.end());
      return all;
    };
    const Words reproject{"--stereo-method", "reproject", "--certificate",        "c.json",
                          "--stereo-map",    "map.png",   "--stereo-differences", "d.png"};
    const vpe::core::RgbImage full = draw("full.png", pair);
    const vpe::core::RgbImage carried = draw("carried.png", with(reproject));
    ASSERT_EQ(carried.width, 2 * kWidth);
    double left_differs = 0;
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) {
        const auto n = static_cast<std::size_t>(y * carried.width + x);
        left_differs += carried.pixels[n] == full.pixels[n] ? 0 : 1;
      }
    // Triangles know their depths to more digits than the ranges have, so a few pixels may differ in which are edges.
    EXPECT_LE(left_differs, std::string(backend) == "ray" ? 0 : 0.01 * kWidth * kHeight) << backend;
    const double difference = mean_difference(carried, full, kWidth);
    EXPECT_GT(difference, 0) << backend;
    EXPECT_LT(difference, 0.02) << backend;

    const auto certificate = parse_json(read_text(dir_ / "c.json"));
    EXPECT_FALSE(certificate["left"].contains("drawn_share"));
    const double drawn_share = certificate["right"]["drawn_share"].get<double>();
    EXPECT_GT(drawn_share, 0);
    EXPECT_LT(drawn_share, 0.3);
    EXPECT_LE(certificate["right"]["carrying_px"].get<double>(), 1.1);
    EXPECT_GE(certificate["right"]["shift_bound_px"].get<double>(),
              certificate["right"]["carrying_px"].get<double>());
    const vpe::core::RgbImage map = vpe::core::read_image(dir_ / "map.png");
    const auto red = std::ranges::count(map.pixels, vpe::base::Rgb{255, 0, 0});
    EXPECT_NEAR(static_cast<double>(red) / (kWidth * kHeight), drawn_share, 1e-9) << backend;
    const vpe::core::RgbImage differences = vpe::core::read_image(dir_ / "d.png");
    EXPECT_EQ(differences.width, kWidth);
    double sum = 0;
    for (const vpe::base::Rgb& pixel : differences.pixels) sum += pixel.r;
    EXPECT_GT(sum, 0) << backend;

    // The recipe says how the pair was made.
    ASSERT_EQ(vpe({"render", planet().string(), "--from-image", "carried.png", "-o", "again.png"}).exit_code,
              0);
    EXPECT_EQ(read_text(dir_ / "again.png"), read_text(dir_ / "carried.png"));
    // Without a gap nothing is carried.
    draw("none.png", with({"--stereo-method", "reproject", "--stereo-gap", "0"}));
    EXPECT_EQ(read_text(dir_ / "none.png"), read_text(dir_ / "full.png")) << backend;
  }
}

TEST_F(StereoRender, WrongUsageOfTheMethod) {
  const auto fails = [&](const Words& more, const Words& parts) {
    expect_failure(words("x.png", more), 2, parts);
  };
  fails({"--stereo-method", "reproject"}, {"--stereo-method", "needs --stereo"});
  fails({"--stereo", "sbs", "--stereo-method", "warp"}, {"--stereo-method", "warp"});
  fails({"--stereo", "sbs", "--stereo-gap", "17"}, {"--stereo-gap", "17"});
  fails({"--stereo", "sbs", "--stereo-map", "m.png"}, {"--stereo-map", "reproject"});
  fails({"--stereo-differences", "m.png"}, {"--stereo-differences", "reproject"});
  fails({"--stereo", "sbs", "--stereo-method", "reproject", "--stereo-gap", "0", "--stereo-map", "m.png"},
        {"--stereo-map"});
  fails({"--stereo", "sbs", "--stereo-method", "reproject", "--set", "samples=4"}, {"samples", "full"});
  fails({"--stereo", "sbs", "--stereo-method", "reproject", "--stereo-map", "x.png"}, {"x.png"});
  draw("p.png", {"--stereo", "sbs", "--eye-base", "9000"});
  expect_failure(
      {"render", planet().string(), "--from-image", "p.png", "-o", "q.png", "--stereo-method", "reproject"}, 2,
      {"--stereo-method", "--from-image"});
}

TEST_F(StereoRender, WrongUsage) {
  const auto fails = [&](const Words& more, const Words& parts, int code = 2) {
    expect_failure(words("x.png", more), code, parts);
    EXPECT_FALSE(exists("x.png"));
  };
  fails({"--stereo", "cross"}, {"--stereo", "cross"});
  fails({"--eye-base", "3"}, {"--eye-base", "--stereo"});
  for (const char* bad : {"0", "-1", "nan", "1e9"})
    fails({"--stereo", "sbs", "--eye-base", bad}, {"--eye-base", bad});
  for (const char* bad : {"0", "nan"}) fails({"--stereo", "sbs", "--convergence", bad}, {"--convergence", bad});
  fails({"--stereo", "sbs", "--range", "r.tif"}, {"--range", "one eye"});
  fails({"--stereo", "sbs", "--eye-base", "1000000", "--convergence", "0.01"}, {"--stereo", "principal"});
  const Result sky = vpe({"render", planet().string(), "--pose", "20,10,300000,0,60,0", "--size", "64x48",
                          "--stereo", "sbs", "-o", "x.png"});
  EXPECT_EQ(sky.exit_code, 1);
  EXPECT_TRUE(says(sky.err, {"shows only sky", "--eye-base"}));
}

}  // namespace
}  // namespace app_test
