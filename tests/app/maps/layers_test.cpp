// overlay.layers in images and films: vector files on the ground.
#include <cmath>

#include "tests/app/support/app_fixture.h"
#include "vpe/core/image/image.h"

namespace app_test {
namespace {

using vpe::core::read_image;
using vpe::core::RgbImage;

constexpr char kSquare[] = R"({"type": "FeatureCollection", "features": [
  {"type": "Feature", "properties": {"stroke": "#ff00ff", "stroke-width": 4, "fill": "#00ff00", "fill-opacity": 1},
   "geometry": {"type": "Polygon", "coordinates": [[[-5, -5], [5, -5], [5, 5], [-5, 5], [-5, -5]]]}}]})";

class Layers : public AppTest {
 protected:
  void SetUp() override { write_text(dir_ / "square.geojson", kSquare); }

  Words words(const std::string& output, const Words& more) const {
    Words all{"render", planet().string(), "-q", "--pose",    "0,0,1200000,0,-90,0",
              "--size", "240x160",         "-o", path(output)};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
  RgbImage draw(const std::string& output, const Words& more) const {
    const Result result = vpe(words(output, more));
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return read_image(path(output));
  }
};

vpe::base::Rgb pixel(const RgbImage& image, int x, int y) {
  return image.pixels.at(static_cast<std::size_t>(y * image.width + x));
}

TEST_F(Layers, CoverTheGroundOfBothBackends) {
  for (const char* backend : {"ray", "polygon"}) {
    const RgbImage image =
        draw("v.png", {"--backend", backend, "--set", "overlay.layers=" + path("square.geojson")});
    // 5 degrees are 296 km: 34 pixels of 240 x 160 at 60 degrees from 1200 km.
    const double focal_px = 80 / std::tan(30 * 3.14159265358979 / 180);
    const double side_px = focal_px * std::sin(5 * 3.14159265358979 / 180) * 3396190 /
                           (1200000 + 3396190 * (1 - std::cos(5 * 3.14159265358979 / 180)));
    EXPECT_EQ(pixel(image, 120, 80).g, 255) << backend;
    EXPECT_EQ(pixel(image, 120, 80).r, 0) << backend;
    // Heights of a few kilometres move the edge by less than a pixel.
    const auto edge = pixel(image, 120 + static_cast<int>(side_px), 80);
    EXPECT_GT(edge.r, 100) << backend;
    EXPECT_LT(pixel(image, 120 + static_cast<int>(side_px) + 4, 80).g, 250) << backend;
  }
}

TEST_F(Layers, OpacityAndOrder) {
  const RgbImage half =
      draw("h.png", {"--backend", "ray", "--set", "overlay.layers=" + path("square.geojson") + "@0.5"});
  const RgbImage none = draw("n.png", {"--backend", "ray"});
  EXPECT_NEAR(pixel(half, 120, 80).g, (255 + pixel(none, 120, 80).g) / 2.0, 2);
  EXPECT_NEAR(pixel(half, 120, 80).r, pixel(none, 120, 80).r / 2.0, 2);
}

TEST_F(Layers, ARecipeDrawsThemAgain) {
  draw("a.png", {"--backend", "ray", "--set", "overlay.layers=" + path("square.geojson")});
  const Result again =
      vpe({"render", planet().string(), "--from-image", path("a.png"), "-q", "-o", path("b.png")});
  ASSERT_EQ(again.exit_code, 0) << again.err;
  EXPECT_EQ(read_text(dir_ / "a.png"), read_text(dir_ / "b.png"));
}

TEST_F(Layers, WrongFilesAreReportedBeforeAnyWork) {
  Words gone = words("x.png", {"--set", "overlay.layers=" + path("gone.gpkg")});
  expect_failure(gone, 2, {"overlay.layers", "gone.gpkg", "cannot be read"});
  write_text(dir_ / "bad.geojson",
             R"({"type": "Feature", "geometry": {"type": "Point", "coordinates": [0, 95]}})");
  expect_failure(words("x.png", {"--set", "overlay.layers=" + path("bad.geojson")}), 1, {"bad.geojson", "95"});
  write_text(dir_ / "not.geojson", "hello");
  expect_failure(words("x.png", {"--set", "overlay.layers=" + path("not.geojson")}), 1, {"not.geojson"});
  EXPECT_FALSE(exists("x.png"));
  // An output never replaces what is drawn.
  write_text(dir_ / "a.png", kSquare);
  expect_failure({"render", planet().string(), "--pose", "0,0,1200000", "--set",
                  "overlay.layers=" + path("a.png"), "-o", path("a.png")},
                 2, {"a.png"});
}

TEST_F(Layers, AFilmMayChangeThem) {
  write_text(dir_ / "f.flight",
             "flight 1\nview fov=60 size=96x64 fps=2\nat 0 pose lon=0 lat=0 alt=1200000 pitch=-90\n"
             "at 1 set overlay.layers=" +
                 path("square.geojson") + "\nat 2 pose lon=0 lat=0 alt=1200000 pitch=-90\n");
  const Result made =
      vpe({"fly", path("f.flight"), planet().string(), "-q", "--backend", "ray", "-o", path("frames")});
  ASSERT_EQ(made.exit_code, 0) << made.err;
  const RgbImage first = read_image(path("frames/frame_000000.png"));
  const RgbImage last = read_image(path("frames/frame_000003.png"));
  EXPECT_LT(pixel(first, 48, 32).g, 250);
  EXPECT_EQ(pixel(last, 48, 32).g, 255);
}

TEST_F(Layers, TheTimeOfTheSunIsWritten) {
  const Words sun{"--backend", "ray", "--sun", "Ls90,15:00"};
  Words timed = sun;
  timed.insert(timed.end(), {"--set", "overlay.time=ltst"});
  const RgbImage with = draw("t.png", timed);
  const RgbImage without = draw("u.png", sun);
  int changed = 0;
  for (std::size_t i = 0; i < with.pixels.size(); ++i)
    changed += with.pixels[i].r != without.pixels[i].r ? 1 : 0;
  EXPECT_GT(changed, 50);
}

}  // namespace
}  // namespace app_test
