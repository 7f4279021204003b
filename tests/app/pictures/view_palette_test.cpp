// Palettes by the view: palette.low=auto and palette.high=auto.
#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/app/support/app_fixture.h"
#include "vpe/core/image/image.h"
#include "vpe/core/image/png_text.h"
#include "vpe/core/view.h"

namespace app_test {
namespace {

const Words kAuto{"--set", "mode=unlit", "--set", "palette.low=auto", "--set", "palette.high=auto"};

class ViewPaletteApp : public AppTest {
 protected:
  Words words(const std::string& pose, const std::string& output, const Words& more,
              const std::string& size = "320x180") const {
    Words all{"render", planet().string(), "--pose", pose, "--size", size, "-o", output, "--json"};
    all.insert(all.end(), kAuto.begin(), kAuto.end());
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
  nlohmann::json palette(const std::string& pose, const Words& more = {},
                         const std::string& size = "320x180") const {
    const Result result = vpe(words(pose, "view.png", more, size));
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return parse_json(result.out)["palette"];
  }
};

// Returns the elevations of all pixels with ground, in order.
std::vector<double> elevations_of(const vpe::core::View& view, const std::vector<float>& range_m) {
  std::vector<double> all;
  for (int y = 0; y < view.height; ++y) {
    for (int x = 0; x < view.width; ++x) {
      const auto range = static_cast<double>(range_m[static_cast<std::size_t>(y * view.width + x)]);
      if (!std::isfinite(range)) continue;
      const glm::dvec3 point = view.camera.position_m + vpe::core::pixel_ray(view, x + 0.5, y + 0.5) * range;
      all.push_back(glm::length(point) - mars::kMarsRadius_m);
    }
  }
  std::sort(all.begin(), all.end());
  return all;
}

TEST_F(ViewPaletteApp, EndsAreQuantilesOfWhatIsSeen) {
  struct Case {
    std::string text;
    mars::Pose pose;
  };
  const std::vector<Case> cases{{"31,1,300000,0,-60,0", {31, 1, 300000, 0, -60, 0}},
                                {"100,20,60000,30,-10,0", {100, 20, 60000, 30, -10, 0}},
                                {"200,-40,9000000,0,-90,0", {200, -40, 9000000, 0, -90, 0}}};
  for (const Case& one : cases) {
    for (const std::string backend : {"ray", "polygon"}) {
      SCOPED_TRACE(one.text + " " + backend);
      const auto ends = palette(one.text, {"--backend", backend, "--range", "range.tif", "--tolerance", "0"});
      vpe::core::View view;
      view.camera = mars::to_camera(one.pose, mars::kMarsRadius_m);
      view.width = 320;
      view.height = 180;
      const std::vector<double> seen = elevations_of(view, vpe::core::read_tiff(dir_ / "range.tif").pixels);
      ASSERT_GT(seen.size(), 1000U);
      const auto share = [&](double part) {
        return seen[static_cast<std::size_t>(part * static_cast<double>(seen.size() - 1))];
      };
      const double low = ends["low"];
      const double high = ends["high"];
      // Rounded outwards, by less than a tenth of what lies between them.
      const double slack_m = 0.1 * (share(0.98) - share(0.02));
      EXPECT_LE(low, share(0.02) + 0.02 * slack_m);
      EXPECT_GT(low, share(0.02) - slack_m);
      EXPECT_GE(high, share(0.98) - 0.02 * slack_m);
      EXPECT_LT(high, share(0.98) + slack_m);
    }
  }
}

TEST_F(ViewPaletteApp, EndsDependOnNeitherBackendThreadsNorSize) {
  const std::string pose = "31,1,300000,0,-60,0";
  const auto first = palette(pose, {"--backend", "ray"});
  EXPECT_LT(first["low"], first["high"]);
  EXPECT_EQ(palette(pose, {"--backend", "polygon"}), first);
  EXPECT_EQ(palette(pose, {"--threads", "1"}), first);
  EXPECT_EQ(palette(pose, {}, "960x540"), first);
  EXPECT_EQ(palette(pose, {"--set", "palette.low=-12.5"})["low"], -12.5);
  EXPECT_EQ(palette(pose, {"--set", "palette.low=-12.5"})["high"], first["high"]);
  EXPECT_TRUE(palette(pose, {"--set", "palette.low=0", "--set", "palette.high=0"}).is_null());
  EXPECT_EQ(palette(pose, {"--set", "colour=aspect"}), parse_json(R"({"low": 0.0, "high": 360.0})"));
  const auto slope = palette(pose, {"--set", "colour=slope"});
  EXPECT_GE(slope["low"], 0);
  EXPECT_LT(slope["high"], 45);
  expect_failure(words(pose, "x.png", {"--set", "palette.low=view"}), 2,
                 {"palette.low=view", "a number from -1000000 to 1000000, or auto"});
}

TEST_F(ViewPaletteApp, AViewWithoutGroundHasTheUsualRange) {
  EXPECT_EQ(palette("31,1,300000,0,60,0"), parse_json(R"({"low": 0.0, "high": 0.0})"));
}

// West of the meridian there are no data, but ground all the same.
TEST_F(ViewPaletteApp, GroundWithoutDataDoesNotCount) {
  Dem dem;
  dem.no_data = -32768;
  dem.height_m = [](int column, int row) { return column < 90 ? -32768.0 : 3000 + 10.0 * (row - 45); };
  write_dem(dir_ / "half.tif", dem);
  ASSERT_EQ(vpe({"build", "half.tif", "-o", "half.vpe", "--base-spacing", "100000", "--quiet"}).exit_code, 0);
  for (const std::string colour : {"elevation", "slope"}) {
    Words words = this->words("0,0,900000,0,-90,0", "half.png", {"--set", "colour=" + colour});
    words[1] = "half.vpe";
    const Result result = vpe(words);
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const auto ends = parse_json(result.out)["palette"];
    if (colour == "slope") {
      EXPECT_LE(ends["high"], 2) << ends;
      continue;
    }
    EXPECT_GT(ends["low"], 2800) << ends;
    EXPECT_LT(ends["high"], 3200) << ends;
  }
}

TEST_F(ViewPaletteApp, TheImageIsThatOfTheNumbersAndItsRecipeDrawsItAgain) {
  const std::string pose = "31,1,300000,0,-60,0";
  const auto ends = palette(pose, {"--backend", "ray"});
  const auto image = vpe::core::read_image(dir_ / "view.png");
  Words by_numbers{"render",    planet().string(),
                   "--pose",    pose,
                   "--size",    "320x180",
                   "-o",        "same.png",
                   "--backend", "ray",
                   "--set",     "mode=unlit",
                   "--set",     "palette.low=" + ends["low"].dump(),
                   "--set",     "palette.high=" + ends["high"].dump()};
  ASSERT_EQ(vpe(by_numbers).exit_code, 0);
  EXPECT_TRUE(vpe::core::read_image(dir_ / "same.png").pixels == image.pixels);
  const std::string text = read_text(dir_ / "view.png");
  const std::vector<std::uint8_t> bytes(text.begin(), text.end());
  const auto texts = vpe::core::read_png_text(bytes);
  ASSERT_TRUE(texts);
  const auto recipe = parse_json(texts->back().text)["recipe"];
  EXPECT_EQ(recipe["palette"], ends);
  EXPECT_NE(recipe["settings"].dump().find("palette.low=auto"), std::string::npos);
  ASSERT_EQ(vpe({"render", planet().string(), "--from-image", "view.png", "-o", "again.png"}).exit_code, 0);
  EXPECT_TRUE(read_text(dir_ / "again.png") == read_text(dir_ / "view.png"));
}

// The camera looks straight down and turns about itself while it rises: the ground below keeps its colour.
TEST_F(ViewPaletteApp, AFilmHasOneRange) {
  write_text(dir_ / "f.flight",
             "flight 1\nview fov=50 size=97x55 fps=10\n"
             "at 0 set mode=unlit palette.low=auto palette.high=auto\n"
             "at 0 pose lon=30 lat=0 alt=200000 yaw=0 pitch=-90\n"
             "at 1 pose lon=30 lat=0 alt=900000 yaw=0 pitch=-90\n");
  const auto fly = [&](const Words& more) {
    Words all{"fly", "f.flight", planet().string(), "-o", "film", "--backend", "ray", "--tolerance", "0"};
    all.insert(all.end(), more.begin(), more.end());
    const Result result = vpe(all);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return result;
  };
  fly({"--frames", "0-2", "--log", "log.flight"});
  fly({"--json"});
  const auto palette = parse_json(read_text(dir_ / "film" / "manifest.json"))["palette"]["elevation"];
  EXPECT_LT(palette["low"], palette["high"]);
  const std::string log = read_text(dir_ / "log.flight");
  EXPECT_NE(log.find("palette.low=" + std::to_string(palette["low"].get<int>())), std::string::npos) << log;
  EXPECT_EQ(log.find("palette.low=auto"), std::string::npos);
  // Frames of the first run are kept: it had the same range.
  EXPECT_EQ(parse_json(fly({"--json"}).out)["made"], 0);
  const auto middle = [&](const std::string& frame) {
    const auto image = vpe::core::read_image(dir_ / "film" / frame);
    return image.pixels[static_cast<std::size_t>(27 * 97 + 48)];
  };
  const auto first = middle("frame_000000.png");
  const auto last = middle("frame_000009.png");
  EXPECT_NEAR(first.r, last.r, 2);
  EXPECT_NEAR(first.g, last.g, 2);
  EXPECT_NEAR(first.b, last.b, 2);
}

TEST_F(ViewPaletteApp, PanoramasHaveTheNumbersInTheirRecipe) {
  const Words words{
      "panorama", planet().string(), "--at",       "31,1",  "--height",         "5000",  "--width",
      "512",      "--set",           "mode=unlit", "--set", "palette.low=auto", "--set", "palette.high=auto",
      "-o",       "pano.png"};
  ASSERT_EQ(vpe(words).exit_code, 0);
  const auto settings = parse_json(read_text(dir_ / "pano.json"))["vpe"]["recipe"]["settings"];
  const double low = std::stod(settings["palette.low"].get<std::string>());
  const double high = std::stod(settings["palette.high"].get<std::string>());
  EXPECT_LT(low, high);
  ASSERT_EQ(vpe({"panorama", planet().string(), "--from-sidecar", "pano.json", "-o", "again.png"}).exit_code,
            0);
  EXPECT_TRUE(vpe::core::read_image(dir_ / "again.png").pixels ==
              vpe::core::read_image(dir_ / "pano.png").pixels);
}

}  // namespace
}  // namespace app_test
