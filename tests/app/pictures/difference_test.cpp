// vpe render --compare: differences as colours, by both backends.
#include <cmath>

#include "tests/app/support/app_fixture.h"
#include "vpe/app/picture/view_palette.h"
#include "vpe/core/appearance/palette.h"
#include "vpe/core/image/image.h"

namespace app_test {
namespace {

using vpe::core::RgbImage;

// A planet with a crater of 200 m, and without.
class Difference : public AppTest {
 protected:
  void SetUp() override {
    Dem globe;
    globe.height_m = [](int, int) { return 0.0; };
    write_dem(dir_ / "globe.tif", globe);
    write_text(dir_ / "works.relief.toml",
               "version = 1\n[[relief]]\nkind = \"crater\"\nlon = 20\nlat = 9\nradius_m = 300000\n"
               "depth_m = 200\nrim_m = 0\nfloor_ratio = 0\npeak_m = 0\nspacing_m = 21000\n");
    for (const Words& words :
         {Words{"build", "globe.tif", "-o", "a.vpe", "--base-spacing", "21000", "--datum", "areoid", "-q"},
          Words{"patch", "a.vpe", "works.relief.toml", "-o", "b.vpe", "-q"}}) {
      const Result result = vpe(words);
      ASSERT_EQ(result.exit_code, 0) << result.err;
    }
  }

  // Draws the crater from above; it has half of the image's height.
  RgbImage draw(const std::string& later, const std::string& earlier, const Words& more) const {
    Words words{"render",
                later,
                "--compare",
                earlier,
                "--pose",
                "20,9,1040000,0,-90,0",
                "--fov",
                "60",
                "--size",
                "120x120",
                "-o",
                "image.png",
                "-q",
                "--set",
                "mode=unlit",
                "--set",
                "overlay.legend=off"};
    words.insert(words.end(), more.begin(), more.end());
    const Result result = vpe(words);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return vpe::core::read_image(dir_ / "image.png");
  }

  static glm::dvec3 expected(double value, double end) {
    vpe::core::Appearance appearance;
    appearance.colour = vpe::core::Colour::kDifference;
    appearance.palette_low = -end;
    appearance.palette_high = end;
    return vpe::core::ColourScale(appearance)(value);
  }

  static void expect_pixel(const RgbImage& image, int x, int y, const glm::dvec3& colour, double within) {
    const vpe::base::Rgb pixel = image.pixels[static_cast<std::size_t>(y * image.width + x)];
    EXPECT_NEAR(pixel.r, colour.x, within) << x << "," << y;
    EXPECT_NEAR(pixel.g, colour.y, within) << x << "," << y;
    EXPECT_NEAR(pixel.b, colour.z, within) << x << "," << y;
  }
};

TEST_F(Difference, IsTheColourOfEachPlace) {
  for (const std::string backend : {"ray", "polygon"}) {
    SCOPED_TRACE(backend);
    const Words more{"--backend", backend, "--set", "palette.low=-250", "--set", "palette.high=250"};
    for (const double sign : {1.0, -1.0}) {
      const RgbImage image = sign > 0 ? draw("b.vpe", "a.vpe", more) : draw("a.vpe", "b.vpe", more);
      expect_pixel(image, 60, 60, expected(-200 * sign, 250), 3);
      for (const auto& [x, y] : {std::pair{8, 60}, {60, 8}, {10, 10}, {110, 110}})
        expect_pixel(image, x, y, expected(0, 250), 1);
      // Halfway to the rim, a quarter of the depth is filled: 1 - t^2.
      for (const auto& [x, y] : {std::pair{75, 60}, {60, 45}})
        expect_pixel(image, x, y, expected(-150 * sign, 250), 12);
    }
    const RgbImage same = draw("b.vpe", "b.vpe", more);
    for (int y = 0; y < 120; y += 7)
      for (int x = 0; x < 120; x += 7) expect_pixel(same, x, y, expected(0, 250), 1);
  }
}

TEST_F(Difference, FlatShadingShowsItToo) {
  for (const std::string backend : {"ray", "polygon"}) {
    SCOPED_TRACE(backend);
    const RgbImage image = draw("b.vpe", "a.vpe",
                                {"--backend", backend, "--set", "palette.low=-250", "--set", "palette.high=250",
                                 "--set", "shading=flat"});
    expect_pixel(image, 60, 60, expected(-200, 250), 12);
    expect_pixel(image, 8, 60, expected(0, 250), 1);
  }
}

TEST(DifferenceEnds, HoldTheLargestOne) {
  using vpe::app::difference_ends;
  const auto expect_ends = [](const std::vector<double>& values, double end) {
    const vpe::core::PaletteEnds ends = difference_ends(values);
    EXPECT_EQ(ends.low, -end);
    EXPECT_EQ(ends.high, end);
  };
  expect_ends({}, 0.1);
  expect_ends({0, 0.01}, 0.1);
  expect_ends({-3.01, 2}, 3.1);
  expect_ends({-7, 123.4}, 125);
}

TEST_F(Difference, EndsByTheViewAreEquallyFarFromZero) {
  const Words words{"render", "b.vpe",     "--compare", "a.vpe",   "--pose",    "20,9,1040000,0,-90,0",
                    "--fov",  "60",        "--size",    "120x120", "--backend", "ray",
                    "-o",     "image.png", "--json"};
  const Result result = vpe(words);
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const nlohmann::json ends = parse_json(result.out)["palette"];
  EXPECT_EQ(ends["low"], -200);
  EXPECT_EQ(ends["high"], 200);
  EXPECT_NE(result.err.find("palette from -200 to 200 m"), std::string::npos) << result.err;

  // The image says what it was compared with.
  expect_failure({"render", "b.vpe", "--from-image", "image.png", "-o", "again.png"}, 2, {"--compare"});
  expect_failure({"render", "b.vpe", "--compare", "b.vpe", "--from-image", "image.png", "-o", "again.png"}, 1,
                 {"image.png", "identity"});
  const Result again =
      vpe({"render", "b.vpe", "--compare", "a.vpe", "--from-image", "image.png", "-o", "again.png", "-q"});
  ASSERT_EQ(again.exit_code, 0) << again.err;
  EXPECT_EQ(read_text(dir_ / "image.png"), read_text(dir_ / "again.png"));
}

}  // namespace
}  // namespace app_test
