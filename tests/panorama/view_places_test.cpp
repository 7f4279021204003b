#include "panorama/viewer/view_places.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "panorama/viewer/render_view.h"
#include "panorama/viewer/viewer.h"

namespace {

using panorama::PanoramaMap;
using panorama::ViewPlaces;
using vpe::core::View;

std::vector<PanoramaMap> maps() {
  return {panorama::cylinder_map(6000, 2000, 6000, 100.0, 900.0),
          panorama::cylinder_map(3000, 900, 60'000, 350.0, 400.0),
          panorama::equirectangular_map(6000, 3000, 6000, -30.0, 1500.0),
          panorama::faceted_map(8, 750, 2000, 10.0, 900.0), panorama::faceted_map(3, 900, 2000, -170.0, 900.0)};
}

// Returns how far in the view apart are the directions that the map shows at a place and that of the pixel. Places and their images
// without edges are compared, so clamped elevations are not met.
double shift_px(const PanoramaMap& map, const View& view, const glm::dvec2& place, const glm::dvec2& pixel) {
  const vpe::core::Projected seen =
      vpe::core::project(view, panorama::to_vector(map.to_direction(place.x, place.y)));
  return std::hypot(seen.xy.x - pixel.x, seen.xy.y - pixel.y);
}

// 10^6 pixels of 400 views: any heading, pitch and roll, 5 to 120 degrees high, of parts and with offsets.
TEST(ViewPlaces, AreWithinTheStatedShift) {
  std::mt19937 random(20261128);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  double worst_px = 0;
  for (int n = 0; n < 400; ++n) {
    const PanoramaMap map = maps()[static_cast<std::size_t>(n) % maps().size()];
    View view = panorama::view_of(360.0 * unit(random), n % 7 == 0 ? 90.0 : 180.0 * unit(random) - 90.0,
                                  5.0 * std::pow(24.0, unit(random)), 1280, 720,
                                  n % 2 == 0 ? 0.0 : 360.0 * unit(random));
    if (n % 3 == 0) view.principal_offset_px = {200.0 * unit(random), -100.0 * unit(random)};
    if (n % 3 == 1) view.part = {331, 17, 613, 500};
    const vpe::core::SubRectangle part = vpe::core::drawn_part(view);
    const ViewPlaces places(map, view);
    std::vector<glm::dvec2> row(static_cast<std::size_t>(part.width));
    for (const double share : {0.0, 0.3, 0.8}) {
      const int y = static_cast<int>(share * part.height);
      places.row(y, row);
      for (std::size_t x = 0; x < row.size(); ++x) {
        const glm::dvec2 pixel(part.x + static_cast<double>(x) + 0.5, part.y + y + 0.5);
        ASSERT_GE(row[x].x, 0.0);
        ASSERT_LT(row[x].x, map.turn_px);
        worst_px = std::max(worst_px, shift_px(map, view, row[x], pixel));
      }
    }
  }
  // Rounding adds the rest: places are followed back through tangents of the map and of the view.
  EXPECT_LT(worst_px, ViewPlaces::kMostShift_px + 1e-6);
  EXPECT_GT(worst_px, 1e-9);
}

TEST(ViewPlaces, OfRoundViewsAreThoseOfTheirPixels) {
  View view = panorama::view_of(20.0, 10.0, 60.0, 100, 50);
  view.projection = vpe::core::Projection::kEquirectangular;
  for (const PanoramaMap& map : maps()) {
    std::vector<glm::dvec2> row(101);
    ViewPlaces(map, view).row(13, row);
    for (std::size_t x = 0; x < row.size(); ++x) {
      glm::dvec2 is =
          map.place(panorama::to_direction(vpe::core::pixel_ray(view, static_cast<double>(x) + 0.5, 13.5)));
      if (is.x < 0.0) is.x += map.turn_px;
      EXPECT_EQ(row[x], is);
    }
  }
}

// The pixel in the middle looks straight up, where azimuth has no value.
TEST(ViewPlaces, AreNumbersAtTheZenith) {
  for (const PanoramaMap& map : maps()) {
    const View view = panorama::view_of(0.0, 90.0, 40.0, 65, 65);
    std::vector<glm::dvec2> row(65);
    ViewPlaces(map, view).row(32, row);
    for (const glm::dvec2& place : row) EXPECT_TRUE(std::isfinite(place.x) && std::isfinite(place.y));
    EXPECT_FALSE(map.kind != panorama::MapKind::kEquirectangular && panorama::is_shown(map, row[32]));
  }
}

}  // namespace
