// colour=difference: colours of heights above another planet, and the planet that has one beside it.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "lod/mesh/mesh.h"
#include "paging/shading/terrain_shader.h"
#include "tests/paging/planet_fixture.h"

namespace paging {
namespace {

using test_support::build_fake;
using test_support::bumpy_height;
using test_support::FakeElevation;
using test_support::fine_around;

constexpr std::size_t kBudget = std::size_t{64} << 20;
const glm::dvec3 kMiddle = glm::normalize(glm::dvec3(0.7, 0.5, 0.3));

// A smooth rise of 200 m at the middle.
double rise_m(const glm::dvec3& d) { return 200 * std::exp(-2000 * glm::dot(d - kMiddle, d - kMiddle)); }

class DifferenceColours : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto fine = fine_around(kMiddle, 0.05, 5000);
    earlier_ = build_fake(dir_.path() / "a.vpe", FakeElevation(bumpy_height, fine), 200000);
    later_ = build_fake(dir_.path() / "b.vpe",
                        FakeElevation([](const glm::dvec3& d) { return bumpy_height(d) + rise_m(d); }, fine),
                        200000);
    vpe::core::Appearance appearance;
    appearance.colour = vpe::core::Colour::kDifference;
    appearance.mode = vpe::core::Mode::kUnlit;
    appearance.palette_low = -250;
    appearance.palette_high = 250;
    scale_ = std::make_shared<const vpe::core::ColourScale>(appearance);
    params_ = shading_params(appearance, {1, 0, 0}, false, scale_);
  }

  glm::dvec3 place(double x, double y) const {
    return glm::normalize(kMiddle + x * glm::dvec3(0.5, -0.7, 0) + y * glm::dvec3(0, 0, 1));
  }

  test_support::TempDir dir_;
  std::shared_ptr<const PlanetFile> earlier_;
  std::shared_ptr<const PlanetFile> later_;
  std::shared_ptr<const vpe::core::ColourScale> scale_;
  ShadingParams params_;
};

TEST_F(DifferenceColours, AreThoseOfBothSurfaces) {
  const Surface before(earlier_, kBudget);
  const Surface after(later_, kBudget);
  const TerrainShader shader(later_->compared_with(earlier_), kBudget);
  EXPECT_TRUE(shows_difference(params_));
  for (const bool is_flat : {false, true}) {
    ShadingParams params = params_;
    params.flat = is_flat;
    TerrainShader::Cursor cursor;
    for (int n = 0; n < 200; ++n) {
      const glm::dvec3 at = place(0.0004 * (n % 20 - 10), 0.0004 * (n / 10 - 10));
      const double difference = after.at(at).height_m - before.at(at).height_m;
      EXPECT_NEAR(difference, rise_m(at), 5);
      const auto colour = shader.colour_at(at, 1000, params, cursor);
      ASSERT_TRUE(colour);
      // Facets have the mean of their corners, some 5 km apart.
      EXPECT_LT(glm::length(*colour - (*scale_)(difference)), is_flat ? 12 : 2) << n;
    }
  }
}

// Swapped planets have the colour of the negative; a planet and itself that of 0.
TEST_F(DifferenceColours, HaveASign) {
  TerrainShader::Cursor up;
  TerrainShader::Cursor down;
  TerrainShader::Cursor none;
  const TerrainShader raised(later_->compared_with(earlier_), kBudget);
  const TerrainShader sunk(earlier_->compared_with(later_), kBudget);
  const TerrainShader same(later_->compared_with(later_), kBudget);
  const double most = rise_m(kMiddle);
  EXPECT_LT(glm::length(*raised.colour_at(kMiddle, 1000, params_, up) - (*scale_)(most)), 8);
  EXPECT_LT(glm::length(*sunk.colour_at(kMiddle, 1000, params_, down) - (*scale_)(-most)), 8);
  EXPECT_GT(glm::length((*scale_)(most) - (*scale_)(-most)), 100);
  for (int n = 0; n < 50; ++n)
    EXPECT_EQ(*same.colour_at(place(0.001 * n, 0.002 * n), 1000, params_, none), (*scale_)(0));
}

TEST_F(DifferenceColours, TexelsAndFacetsShowThem) {
  const auto compared = later_->compared_with(earlier_);
  const TerrainShader shader(compared, kBudget);
  const lod::TileKey key = compared->tree().deepest(lod::tile_at(mars::chart_point(kMiddle), 20)).key;
  const int n = compared->meta().tile.intervals();
  const std::vector<double> before = earlier_->heights(key).posts.height_m;
  const TileHeights after = later_->heights(key);
  const ShadedTile tile = shader.shade(key, n, params_);
  ASSERT_EQ(tile.channels, 4);
  for (std::size_t p = 0; p < before.size(); ++p) {
    const glm::dvec3 expected = (*scale_)(after.posts.height_m[p] - before[p]);
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(tile.texels[4 * p + static_cast<std::size_t>(c)], expected[c], 1) << p;
  }
  const lod::TileMesh mesh = lod::mesh_full(n);
  const ShadedTile facets = shader.shade_facets(key, mesh, after.posts.height_m, params_);
  ASSERT_EQ(facets.texels.size(), 4 * mesh.triangle_count());
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    double mean = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const lod::MeshVertex v = mesh.vertices[mesh.triangles[3 * t + k]];
      const std::size_t p = std::size_t{v.j} * static_cast<std::size_t>(n + 1) + v.i;
      mean += (after.posts.height_m[p] - before[p]) / 3;
    }
    const glm::dvec3 expected = (*scale_)(mean);
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(facets.texels[4 * t + static_cast<std::size_t>(c)], expected[c], 8) << t;
  }
}

TEST_F(DifferenceColours, NodataOfEitherIsNodata) {
  const auto holed = build_fake(
      dir_.path() / "c.vpe",
      FakeElevation([](const glm::dvec3& d) { return glm::length(d - kMiddle) < 0.01 ? std::nan("") : 0.0; },
                    fine_around(kMiddle, 0.05, 5000)),
      200000);
  for (const auto& planet : {later_->compared_with(holed), holed->compared_with(later_)}) {
    const TerrainShader shader(planet, kBudget);
    TerrainShader::Cursor cursor;
    EXPECT_FALSE(shader.colour_at(kMiddle, 1000, params_, cursor));
    EXPECT_TRUE(shader.colour_at(place(0.05, 0), 1000, params_, cursor));
    const lod::TileKey key = planet->tree().deepest(lod::tile_at(mars::chart_point(kMiddle), 20)).key;
    EXPECT_TRUE(shader.shade(key, planet->meta().tile.intervals(), params_).nodata);
    const TileHeights own = planet->heights(key);
    EXPECT_TRUE(
        shader.shade_facets(key, lod::mesh_full(own.posts.intervals), own.posts.height_m, params_).nodata);
  }
}

TEST_F(DifferenceColours, NeedAnEarlierPlanet) {
  const TerrainShader shader(later_, kBudget);
  TerrainShader::Cursor cursor;
  try {
    shader.colour_at(kMiddle, 1000, params_, cursor);
    FAIL();
  } catch (const PlanetError& e) {
    EXPECT_NE(std::string(e.what()).find("--compare"), std::string::npos) << e.what();
  }
}

TEST_F(DifferenceColours, APlanetBesideAnotherHasItsOwnPages) {
  EXPECT_EQ(later_->earlier(), nullptr);
  EXPECT_EQ(later_->compared_version(), 0U);
  const auto compared = later_->compared_with(earlier_);
  EXPECT_EQ(compared->earlier(), earlier_);
  EXPECT_EQ(compared->meta(), later_->meta());
  EXPECT_EQ(compared->path(), later_->path());
  EXPECT_EQ(compared->tree().size(), later_->tree().size());
  EXPECT_GT(compared->compared_version(), later_->version());
  for (const lod::TileInfo& tile : later_->tree().tiles().first(20))
    EXPECT_EQ(compared->heights(tile.key).posts.height_m, later_->heights(tile.key).posts.height_m);
  // Another earlier planet, other pages of colours, the same ones of heights.
  const auto again = compared->compared_with(later_);
  EXPECT_EQ(again->earlier(), later_);
  const lod::TileKey root{};
  EXPECT_NE(shading_version(*again, root, MadeOf::kBorders, params_),
            shading_version(*compared, root, MadeOf::kBorders, params_));
  TerrainShader shader(compared, kBudget);
  TerrainShader::Cursor first;
  TerrainShader::Cursor second;
  const glm::dvec3 raised = *shader.colour_at(kMiddle, 1000, params_, first);
  shader.change_planet(again, kBudget);
  EXPECT_EQ(*shader.colour_at(kMiddle, 1000, params_, second), (*scale_)(0));
  EXPECT_NE(raised, (*scale_)(0));
}

}  // namespace
}  // namespace paging
