// Overlays as users request them: in images, as layers, in films.
#include <png.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "tests/app/support/app_fixture.h"
#include "vpe/core/image/image.h"
#include "vpe/core/view.h"
#include "vpe/overlay/overlay.h"

namespace app_test {
namespace {

class OverlayApp : public AppTest {
 protected:
  void SetUp() override {
    if (!vpe::core::overlays_refused().empty()) GTEST_SKIP() << vpe::core::overlays_refused();
    write_text(dir_ / "names.csv", "name,lon,lat\nHere,31,2\n");
  }
  Result render(const Words& more, const std::string& output) const {
    Words words{"render", planet().string(),
                "--pose", "31,1,300000,0,-60,0",
                "--size", "320x180",
                "--set",  "mode=coloured",
                "-o",     output};
    words.insert(words.end(), more.begin(), more.end());
    return vpe(words);
  }
  static Words all() {
    Words words;
    for (const char* key : {"legend", "graticule", "contours", "scale", "north", "time"}) {
      words.insert(words.end(), {"--set", std::string("overlay.") + key + "=on"});
    }
    words.insert(words.end(), {"--set", "overlay.title=A title", "--set", "overlay.names=names.csv"});
    return words;
  }
};

vpe::overlay::Layer read_layer(const std::filesystem::path& path) {
  const std::string bytes = read_text(path);
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  EXPECT_NE(png_image_begin_read_from_memory(&image, bytes.data(), bytes.size()), 0);
  EXPECT_NE(image.format & PNG_FORMAT_FLAG_ALPHA, 0U);
  image.format = PNG_FORMAT_RGBA;
  vpe::overlay::Layer layer{static_cast<int>(image.width), static_cast<int>(image.height), {}};
  layer.pixels.resize(std::size_t{image.width} * image.height);
  EXPECT_NE(png_image_finish_read(&image, nullptr, layer.pixels.data(), 0, nullptr), 0);
  return layer;
}

TEST_F(OverlayApp, TheImageIsThePlainOneUnderTheLayer) {
  ASSERT_EQ(render({}, "plain.png").exit_code, 0);
  const Result result = render(all(), "with.png");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.err.find("contours"), std::string::npos) << result.err;
  Words more = all();
  more.insert(more.end(), {"--overlay-layer", "layer.png"});
  ASSERT_EQ(render(more, "without.png").exit_code, 0);
  EXPECT_TRUE(read_text(dir_ / "without.png") == read_text(dir_ / "plain.png"));
  auto image = vpe::core::read_image(dir_ / "plain.png");
  const auto layer = read_layer(dir_ / "layer.png");
  ASSERT_EQ(layer.width, 320);
  const auto before = image.pixels;
  vpe::overlay::composite(layer, image.pixels);
  EXPECT_TRUE(image.pixels != before);
  EXPECT_TRUE(image.pixels == vpe::core::read_image(dir_ / "with.png").pixels);
  EXPECT_EQ(leftovers(), Words{});
}

TEST_F(OverlayApp, EachOneOnAndOffLeavesThePlainImage) {
  // Contours are drawn only where the terrain is accurate enough for them.
  const Words exact{"--tolerance", "0"};
  ASSERT_EQ(render(exact, "plain.png").exit_code, 0);
  const Words words = all();
  for (std::size_t n = 1; n < words.size(); n += 2) {
    ASSERT_EQ(render({"--tolerance", "0", "--set", words[n]}, "on.png").exit_code, 0) << words[n];
    EXPECT_TRUE(read_text(dir_ / "on.png") != read_text(dir_ / "plain.png")) << words[n];
    const std::string key = words[n].substr(0, words[n].find('='));
    const std::string off = key == "overlay.title" || key == "overlay.names" ? "=" : "=off";
    ASSERT_EQ(render({"--tolerance", "0", "--set", words[n], "--set", key + off}, "off.png").exit_code, 0)
        << key;
    EXPECT_TRUE(read_text(dir_ / "off.png") == read_text(dir_ / "plain.png")) << key;
  }
}

// Rings of hills about a place, in metres above the sphere.
constexpr double kRings_m = 1750;
double ring_height_m(double angle_rad) { return kRings_m + 10000 * std::cos(6 * angle_rad); }

// Returns the height of the rings where the ray of a pixel's centre meets them.
double ring_height_m(const vpe::core::View& view, const glm::dvec3& middle, double x, double y) {
  const glm::dvec3 ray = vpe::core::pixel_ray(view, x + 0.5, y + 0.5);
  const glm::dvec3& camera = view.camera.position_m;
  const double along = -glm::dot(camera, ray);
  double height_m = kRings_m;
  for (int n = 0; n < 60; ++n) {
    const double r = mars::kMarsRadius_m + height_m;
    const double range_m = along - std::sqrt(r * r - glm::dot(camera, camera) + along * along);
    height_m = ring_height_m(std::acos(glm::dot(glm::normalize(camera + ray * range_m), middle)));
  }
  return height_m;
}

// Posts are 42 km apart: between them the surface is off the rings by 7 m. At the default tolerance the drawn
// ground is off by up to a pixel, 400 m here.
TEST_F(OverlayApp, ContoursLieOnTheGroundAtDefaultSettings) {
  constexpr double kStep_m = 700;
  constexpr double kTolerance_px = 0.1;
  constexpr double kBetweenPosts_m = 7;
  const glm::dvec3 middle = mars::direction({31, 1});
  Dem dem;
  dem.width = 720;
  dem.height = 360;
  dem.cell_deg = 0.5;
  dem.height_m = [&](int column, int row) {
    const mars::LonLat at{-180 + 0.5 * (column + 0.5), 90 - 0.5 * (row + 0.5)};
    return ring_height_m(std::acos(std::clamp(glm::dot(mars::direction(at), middle), -1.0, 1.0)));
  };
  write_dem(dir_ / "rings.tif", dem);
  ASSERT_EQ(vpe({"build", "rings.tif", "-o", "rings.vpe", "--base-spacing", "50000", "--quiet"}).exit_code, 0);
  vpe::core::View view;
  view.camera = mars::to_camera({46, 1, 1e5, 0, -90, 0}, mars::kMarsRadius_m);
  view.width = 640;
  view.height = 360;
  for (const Words& backend :
       {Words{"--backend", "polygon"}, Words{"--backend", "ray"},
        Words{"--backend", "ray", "--set", "rays.mode=multires", "--set", "rays.cell=4"}}) {
    SCOPED_TRACE(backend.back());
    Words words{"render",
                "rings.vpe",
                "--pose",
                "46,1,100000,0,-90,0",
                "--size",
                "640x360",
                "--set",
                "overlay.contours=on",
                "--set",
                "overlay.contours.step=700",
                "-o",
                "rings.png",
                "--overlay-layer",
                "layer.png"};
    words.insert(words.end(), backend.begin(), backend.end());
    const Result result = vpe(words);
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const auto layer = read_layer(dir_ / "layer.png");
    int on = 0;
    double worst_m = 0;
    double allowed_m = 0;
    for (int y = 4; y < layer.height - 4; ++y) {
      for (int x = 4; x < layer.width - 4; ++x) {
        const auto& p = layer.pixels[static_cast<std::size_t>(y * layer.width + x)];
        if (p.a < 150 || p.r > 100) continue;  // the middle of a line, without its halo
        ++on;
        const double here_m = ring_height_m(view, middle, x, y);
        const double beside_m = std::max(std::abs(ring_height_m(view, middle, x + 1, y) - here_m),
                                         std::abs(ring_height_m(view, middle, x, y + 1) - here_m));
        worst_m = std::max(worst_m, std::abs(std::remainder(here_m, kStep_m)));
        const double range_m = 1.2e5;  // at most
        allowed_m = std::max(
            allowed_m, kTolerance_px * range_m / vpe::core::focal_px(view) + kBetweenPosts_m + 1.5 * beside_m);
      }
    }
    EXPECT_GT(on, 500);
    EXPECT_LT(worst_m, allowed_m);
    EXPECT_LT(allowed_m, kStep_m / 5);
  }
}

TEST_F(OverlayApp, WrongUsageIsReportedBeforeAnyWork) {
  const Words base{"render", planet().string(), "--pose", "0,0,9e6", "-o", "x.png"};
  const auto with = [&](const Words& more) {
    Words words = base;
    words.insert(words.end(), more.begin(), more.end());
    return words;
  };
  expect_failure(with({"--overlay-layer", "l.png"}), 2,
                 {"--overlay-layer", "no overlay", "overlay.graticule=on"});
  expect_failure(with({"--overlay-layer", "l.jpg", "--set", "overlay.time=on"}), 2, {"l.jpg", ".png"});
  expect_failure(with({"--overlay-layer", "none/l.png", "--set", "overlay.time=on"}), 1, {"none"});
  expect_failure(with({"--set", "overlay.names=none.csv"}), 2, {"overlay.names", "none.csv", "No such file"});
  write_text(dir_ / "bad.csv", "name,lon,lat\nA,1,2\nB,x,2\n");
  expect_failure(with({"--set", "overlay.names=bad.csv"}), 1, {"bad.csv:3", "a longitude", "\"x\""});
  EXPECT_FALSE(exists("x.png"));
}

TEST_F(OverlayApp, FilmsHaveThemAndDetectChanges) {
  const auto fly = [&](const Words& more) {
    Words words{"fly", "f.flight", planet().string(), "-o", "film", "--frames", "0-3", "--json"};
    words.insert(words.end(), more.begin(), more.end());
    const Result result = vpe(words);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return parse_json(result.out);
  };
  write_text(dir_ / "f.flight", small_flight("fov=50 size=320x180 fps=10"));
  EXPECT_EQ(fly({})["made"], 4);
  const std::string plain = read_text(dir_ / "film" / "frame_000001.png");
  const std::string first_line =
      "at 0 set overlay.title=\"Over # the hills\" overlay.time=on overlay.names=names.csv "
      "overlay.graticule=on\n";
  std::string text = small_flight("fov=50 size=320x180 fps=10");
  text.insert(text.find("at 0"), first_line);
  write_text(dir_ / "f.flight", text);
  EXPECT_EQ(fly({})["made"], 4);
  const std::string named = read_text(dir_ / "film" / "frame_000001.png");
  EXPECT_TRUE(named != plain);
  EXPECT_EQ(fly({})["made"], 0);
  // The same bytes again; other frames when the names change.
  EXPECT_EQ(fly({"--force"})["made"], 4);
  EXPECT_TRUE(read_text(dir_ / "film" / "frame_000001.png") == named);
  write_text(dir_ / "names.csv", "name,lon,lat\nThere,31,2\n");
  EXPECT_EQ(fly({})["made"], 4);
  write_text(dir_ / "names.csv", "name,lon\n");
  expect_failure({"fly", "f.flight", planet().string(), "-o", "film", "--frames", "0-3", "--quiet"}, 1,
                 {"names.csv:1", "latitude"});
}

}  // namespace
}  // namespace app_test
