// Formulas of panoramas against the maps that they are made of.
#include "vpe/app/scene/panorama_lookup.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace vpe::app {
namespace {

TEST(PanoramaLookup, FormulaAgreesWithTheMap) {
  std::mt19937 random(3);
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution(low, high)(random);
  };
  panorama::PanoramaMap part = panorama::cylinder_map(1000, 700, 2400, 200, 300);
  part.crop_left_px = 555.5;
  for (const panorama::PanoramaMap& map : {panorama::equirectangular_map(2400, 1200, 2400, 33, 600),
                                           panorama::cylinder_map(2400, 900, 2400, -170, 400), part,
                                           panorama::faceted_map(6, 400, 500, 12, 250)}) {
    ASSERT_EQ(panorama::check(map), "");
    const auto lookup = panorama_lookup(map, {1, 1});
    const auto formula = panorama_formula(map);
    ASSERT_TRUE(formula);
    int shown = 0;
    for (int n = 0; n < 4000; ++n) {
      const double azimuth = between(-3.14, 3.14);
      const double elevation = between(-1.5, 1.5);
      const glm::dvec3 d(std::cos(elevation) * std::sin(azimuth), std::cos(elevation) * std::cos(azimuth),
                         std::sin(elevation));
      const auto place = lookup(d);
      if (!place) continue;
      ++shown;
      EXPECT_NEAR(formula->pixel_sr(d), place->texel_sr, 1e-9 * place->texel_sr);
      if (map.kind == panorama::MapKind::kFacets) continue;
      const double off_px = formula->column_px(azimuth) - place->uv.x * formula->width_px;
      EXPECT_NEAR(std::remainder(off_px, formula->turn_px), 0, 1e-8);
    }
    EXPECT_GT(shown, 400);
  }
}

TEST(PanoramaLookup, FacetsAreThoseOfTheMap) {
  const panorama::PanoramaMap map = panorama::faceted_map(6, 400, 500, 12, 250);
  const auto formula = panorama_formula(map);
  ASSERT_TRUE(formula);
  for (int facet = 0; facet < 6; ++facet) {
    const double azimuth = formula->facet_azimuth_rad(facet);
    EXPECT_EQ(formula->facet_at(azimuth), facet);
    const auto direction = map.to_direction((facet + 0.5) * 400, 250);
    EXPECT_NEAR(std::remainder(direction.azimuth_deg * mars::kRadiansPerDegree - azimuth, 2 * mars::kPi), 0,
                1e-12);
  }
}

TEST(PanoramaLookup, MoreThanACircleHasNoFormula) {
  EXPECT_FALSE(panorama_formula(panorama::cylinder_map(1300, 300, 1200, 0, 150)));
}

}  // namespace
}  // namespace vpe::app
