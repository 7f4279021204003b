// Tests of overlays of panoramas: positions, seams, regions.
#include "vpe/overlay/panorama_overlay.h"

#include <cmath>
#include <set>

#include "tests/overlay/ball.h"
#include "vpe/overlay/number_format.h"

namespace overlay_test {
namespace {

using vpe::base::Rgb;
using vpe::core::CompassStrip;
using vpe::overlay::lay_out_panorama;
using vpe::overlay::PanoramaName;
using vpe::overlay::PanoramaScene;
using vpe::overlay::SpriteLayer;

constexpr vpe::base::Rgb kGround{40, 60, 80};

// A cylinder.
PanoramaScene scene_of(std::int64_t width, std::int64_t height, double left_deg = 0, double span_deg = 360) {
  PanoramaScene scene;
  scene.width_px = width;
  scene.height_px = height;
  scene.full_circle_px = std::llround(static_cast<double>(width) * 360 / span_deg);
  scene.left_azimuth_deg = left_deg;
  scene.span_deg = span_deg;
  scene.px_per_deg = static_cast<double>(scene.full_circle_px) / 360;
  scene.horizon_px = 0.5 * static_cast<double>(height);
  const double px_per_deg = scene.px_per_deg;
  const double horizon_px = scene.horizon_px;
  scene.place = [=](double azimuth_deg, double elevation_deg) -> std::optional<glm::dvec2> {
    double from_deg = std::fmod(azimuth_deg - left_deg, 360);
    if (from_deg < 0) from_deg += 360;
    if (from_deg > span_deg) return std::nullopt;
    return glm::dvec2(from_deg * px_per_deg, horizon_px - elevation_deg * px_per_deg);
  };
  return scene;
}

struct Image {
  std::int64_t width;
  std::int64_t height;
  std::vector<vpe::base::Rgb> pixels;

  const vpe::base::Rgb& at(std::int64_t x, std::int64_t y) const {
    return pixels.at(static_cast<std::size_t>(y * width + x));
  }
  bool is_painted(std::int64_t x, std::int64_t y) const { return at(x, y) != kGround; }
};

Image whole(const SpriteLayer& sprites, const PanoramaScene& scene) {
  Image image{scene.width_px, scene.height_px, {}};
  image.pixels.assign(static_cast<std::size_t>(scene.width_px * scene.height_px), kGround);
  sprites.composite({0, 0, scene.width_px, scene.height_px, image.pixels});
  return image;
}

// In parts of some size, each by itself.
Image in_parts(const SpriteLayer& sprites, const PanoramaScene& scene, std::int64_t width,
               std::int64_t height) {
  Image image = whole(SpriteLayer(scene.width_px, scene.height_px, 0), scene);
  for (std::int64_t y = 0; y < scene.height_px; y += height) {
    for (std::int64_t x = 0; x < scene.width_px; x += width) {
      const std::int64_t w = std::min(width, scene.width_px - x);
      const std::int64_t h = std::min(height, scene.height_px - y);
      std::vector<vpe::base::Rgb> part(static_cast<std::size_t>(w * h), kGround);
      sprites.composite({x, y, w, h, part});
      for (std::int64_t row = 0; row < h; ++row) {
        std::copy_n(part.begin() + row * w, w, image.pixels.begin() + (y + row) * scene.width_px + x);
      }
    }
  }
  return image;
}

vpe::core::Overlays all_of_them() {
  vpe::core::Overlays overlays;
  overlays.compass = CompassStrip::kBottom;
  overlays.title = "All of them";
  overlays.legend = true;
  overlays.names = "places";
  overlays.distances = true;
  return overlays;
}

PanoramaScene crowded(std::int64_t width, std::int64_t height, double left_deg = 0, double span_deg = 360) {
  PanoramaScene scene = scene_of(width, height, left_deg, span_deg);
  for (int n = 0; n < 60; ++n)
    scene.names.push_back({"Place " + std::to_string(n), n * 37.7, 3.0 * std::sin(n), 1000.0 * (n + 1), 0});
  scene.appearance.mode = vpe::core::Mode::kColoured;
  return scene;
}

TEST(PanoramaOverlay, NothingSetPaintsNothing) {
  const PanoramaScene scene = scene_of(900, 300);
  EXPECT_TRUE(lay_out_panorama({}, scene).empty());
}

TEST(PanoramaOverlay, PartsAreThoseOfTheWhole) {
  for (const double span_deg : {360.0, 70.0}) {
    const PanoramaScene scene = crowded(1400, 420, 200, span_deg);
    for (const CompassStrip where : {CompassStrip::kBottom, CompassStrip::kTop, CompassStrip::kHorizon}) {
      vpe::core::Overlays overlays = all_of_them();
      overlays.compass = where;
      const SpriteLayer sprites = lay_out_panorama(overlays, scene);
      const Image image = whole(sprites, scene);
      EXPECT_EQ(in_parts(sprites, scene, 256, 420).pixels, image.pixels);
      EXPECT_EQ(in_parts(sprites, scene, 61, 420).pixels, image.pixels);
      EXPECT_EQ(in_parts(sprites, scene, 333, 101).pixels, image.pixels);
      // Laying out again gives the same positions.
      EXPECT_EQ(whole(lay_out_panorama(overlays, scene), scene).pixels, image.pixels);
    }
  }
}

TEST(PanoramaOverlay, TicksAreInTheColumnsOfTheirAzimuths) {
  for (const CompassStrip where : {CompassStrip::kBottom, CompassStrip::kTop, CompassStrip::kHorizon}) {
    PanoramaScene scene = scene_of(3600, 500, 100);
    vpe::core::Overlays overlays;
    overlays.compass = where;
    const Image image = whole(lay_out_panorama(overlays, scene), scene);
    // White columns at the line: every 2 or 1 degrees of 10 pixels.
    const double unit = vpe::overlay::panorama_unit(scene);
    const auto height = static_cast<std::int64_t>(std::ceil(2 * std::max(14 * unit, 9.8)));
    const std::int64_t row = where == CompassStrip::kBottom ? 500 - height + 2
                             : where == CompassStrip::kTop  ? height - 3
                                                            : 250 + 2;
    std::set<std::int64_t> found;
    for (std::int64_t x = 1; x + 1 < 3600; ++x) {
      const int here = image.at(x, row).r + image.at(x + 1, row).r;
      if (here > 230 && image.at(x, row).r >= image.at(x - 1, row).r) found.insert(x + 1);
    }
    for (int azimuth_deg = 110; azimuth_deg < 460; azimuth_deg += 10) {
      const std::int64_t x = (azimuth_deg - 100) * 10;
      EXPECT_TRUE(found.contains(x) || found.contains(x + 1) || found.contains(x - 1))
          << azimuth_deg << " " << static_cast<int>(where);
    }
    for (const std::int64_t x : found)
      EXPECT_LE(std::abs(std::remainder(static_cast<double>(x), 10.0)), 1) << x;
    EXPECT_GE(found.size(), 100U);
  }
}

TEST(PanoramaOverlay, AtTheSeamBothEdgesShowTheirHalf) {
  // The same panorama, begun elsewhere, is the same shifted.
  vpe::core::Overlays overlays;
  overlays.compass = CompassStrip::kHorizon;
  overlays.names = "places";
  const auto draw = [&](double left_deg) {
    PanoramaScene scene = scene_of(1440, 400, left_deg);
    scene.names = {{"On the seam", 0, 5, 3000, 0}, {"Elsewhere", 180, 5, 9000, 0}};
    return whole(lay_out_panorama(overlays, scene), scene);
  };
  const Image seam = draw(0);
  const Image middle = draw(180);
  for (std::int64_t y = 0; y < 400; ++y) {
    for (std::int64_t x = 0; x < 1440; ++x)
      ASSERT_EQ(seam.at(x, y), middle.at((x + 720) % 1440, y)) << x << " " << y;
  }
  // The dot is there, half at each edge.
  EXPECT_TRUE(seam.is_painted(0, 180) && seam.is_painted(1439, 180));
}

TEST(PanoramaOverlay, NamesStandAtTheirPlacesAndNoTextOverAnother) {
  vpe::core::Overlays overlays;
  overlays.names = "places";
  PanoramaScene scene = scene_of(1440, 400, 0, 120);
  scene.names = {{"Here", 30, 4, 3000, 0}};
  const Image one = whole(lay_out_panorama(overlays, scene), scene);
  // 12 px a degree: (360, 200 - 48).
  EXPECT_EQ(one.at(360, 152), (vpe::base::Rgb{255, 255, 255}));
  // A leader up to it, and nothing to the sides.
  EXPECT_TRUE(one.is_painted(360, 143));
  EXPECT_FALSE(one.is_painted(380, 152));
  EXPECT_FALSE(one.is_painted(340, 152));
  // A leader may not cross a text: the second name goes below, and changes nothing above.
  scene.names.push_back({"There", 31, 4, 3000, 0});
  const Image two = whole(lay_out_panorama(overlays, scene), scene);
  std::int64_t below = 0;
  for (std::int64_t x = 0; x < 1440; ++x) {
    for (std::int64_t y = 0; y < 145; ++y) ASSERT_EQ(two.at(x, y), one.at(x, y)) << x << " " << y;
    for (std::int64_t y = 160; y < 400; ++y) below += two.is_painted(x, y) ? 1 : 0;
  }
  EXPECT_GT(below, 50);
  // Forty at one place: the dots would lie on one another.
  scene.names.clear();
  for (int n = 0; n < 40; ++n) scene.names.push_back({"Place", 60, -3 + 0.01 * n, 3000, 0});
  const auto crowded_once = whole(lay_out_panorama(overlays, scene), scene);
  scene.names.resize(1);
  const auto alone = whole(lay_out_panorama(overlays, scene), scene);
  EXPECT_EQ(crowded_once.pixels, alone.pixels);
  // At the end of an arc the text moves inwards: all of it is there.
  const auto painted = [](const Image& p) {
    return std::count_if(p.pixels.begin(), p.pixels.end(),
                         [](const vpe::base::Rgb& c) { return c != kGround; });
  };
  scene.names = {{"A long name, at the very end", 119.5, 0, 3000, 0}};
  const auto at_end = painted(whole(lay_out_panorama(overlays, scene), scene));
  scene.names = {{"A long name, at the very end", 60, 0, 3000, 0}};
  EXPECT_NEAR(static_cast<double>(at_end),
              static_cast<double>(painted(whole(lay_out_panorama(overlays, scene), scene))),
              0.03 * static_cast<double>(at_end));
}

TEST(PanoramaOverlay, SmallPlacesAndThoseOutsideAreLeftOut) {
  vpe::core::Overlays overlays;
  overlays.names = "places";
  PanoramaScene scene = scene_of(720, 720, 0, 60);
  scene.names = {{"Small", 30, 4, 1e6, 100}, {"Outside", 90, 0, 100, 0}, {"Above", 10, 89, 100, 0}};
  EXPECT_TRUE(lay_out_panorama(overlays, scene).empty());
  scene.names[0].diameter_m = 1e5;
  EXPECT_FALSE(lay_out_panorama(overlays, scene).empty());
}

TEST(PanoramaOverlay, LettersHaveASensibleSizeInImagesOfAnySize) {
  for (const auto& [width, height, span_deg] :
       std::vector<std::tuple<std::int64_t, std::int64_t, double>>{{100, 20, 360},
                                                                   {2048, 652, 360},
                                                                   {6000, 2000, 360},
                                                                   {60000, 17000, 360},
                                                                   {1000000, 60000, 360},
                                                                   {2000, 700, 5}}) {
    const double unit = vpe::overlay::panorama_unit(scene_of(width, height, 0, span_deg));
    EXPECT_GT(unit, 0);
    EXPECT_LE(unit, 6);
    EXPECT_LE(unit, static_cast<double>(height) / 720);
  }
  EXPECT_EQ(vpe::overlay::panorama_unit(scene_of(60000, 17000)), 6);
}

// Memory does not grow with the image: only sprites that meet the region are drawn.
TEST(PanoramaOverlay, HugeImagesAreLaidOutAndDrawnInParts) {
  const PanoramaScene scene = crowded(1'000'000, 60'000);
  const SpriteLayer sprites = lay_out_panorama(all_of_them(), scene);
  std::vector<vpe::base::Rgb> part(std::size_t{64} * 60'000, kGround);
  sprites.composite({0, 0, 64, 60'000, part});
  EXPECT_NE(part[std::size_t{64} * 59'900 + 1], kGround);  // the band
  EXPECT_THROW(sprites.composite({0, 0, 65, 60'000, part}), std::invalid_argument);
}

TEST(PanoramaOverlay, TinyImagesAreSurvived) {
  for (const std::int64_t side : {1, 2, 9, 30}) {
    const PanoramaScene scene = crowded(2 * side, side);
    const Image image = whole(lay_out_panorama(all_of_them(), scene), scene);
    EXPECT_EQ(image.pixels.size(), static_cast<std::size_t>(2 * side * side));
  }
}

TEST(PanoramaOverlay, DistancesAreShort) {
  using vpe::overlay::distance_text;
  EXPECT_EQ(distance_text(7.4), "7 m");
  EXPECT_EQ(distance_text(99.6), "100 m");
  EXPECT_EQ(distance_text(847), "850 m");
  EXPECT_EQ(distance_text(994), "990 m");
  EXPECT_EQ(distance_text(996), "1.0 km");
  EXPECT_EQ(distance_text(4249), "4.2 km");
  EXPECT_EQ(distance_text(9949), "9.9 km");
  EXPECT_EQ(distance_text(9960), "10 km");
  EXPECT_EQ(distance_text(123456), "123 km");
  EXPECT_EQ(vpe::overlay::name_text("Gale", 17000), "Gale \u00b7 17 km");
}

TEST(PanoramaOverlay, OverlaysThatPanoramasLackAreNamed) {
  using vpe::overlay::not_for_panoramas;
  EXPECT_EQ(not_for_panoramas(all_of_them()), "");
  vpe::core::Overlays overlays;
  overlays.scale_bar = true;
  EXPECT_NE(not_for_panoramas(overlays).find("overlay.scale"), std::string::npos);
  overlays = {};
  overlays.time_code = vpe::core::TimeCode::kFlight;
  EXPECT_NE(not_for_panoramas(overlays).find("overlay.time"), std::string::npos);
  overlays = {};
  overlays.inspect = vpe::core::Inspect::kSynthetic;
  EXPECT_NE(not_for_panoramas(overlays).find("--aux-layers synthetic"), std::string::npos);
}

}  // namespace
}  // namespace overlay_test
