// Textures of tiles that are small in an image: the posts and texels of tiles above.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "paging/shading/texel_block.h"
#include "tests/paging/patch_between.h"
#include "vpe/core/appearance/settings.h"

namespace paging {
namespace {

using test_support::build_changed;
using test_support::kPatched;
using test_support::patch_between;
using test_support::PlanetChange;

constexpr std::size_t kBudget = std::size_t{64} << 20;

ShadingParams look(vpe::core::Mode mode) {
  vpe::core::Appearance appearance;
  appearance.mode = mode;
  return shading_params(appearance, glm::normalize(kPatched + glm::dvec3(0.4, -0.7, 0.1)), true, nullptr);
}

// The planets are read alone, and made once.
class CoarseTexture : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    states_ = std::make_unique<States>();
    states_->base = build_changed(states_->dir / "base.vpe", {.has_image = true});
    states_->changed = states_->base->with(patch_between(
        *states_->base, *build_changed(states_->dir / "changed.vpe", {.raised_m = 900, .has_image = true})));
  }
  static void TearDownTestSuite() { states_.reset(); }

  // Returns the tiles of a level that lie within a reach of the middle of the fine part, or next to it.
  static std::vector<lod::TileKey> tiles_at(int level, double reach_rad = 0) {
    std::vector<lod::TileKey> keys;
    for (const lod::TileInfo& tile : states_->base->tree().tiles()) {
      const mars::Cap cap = lod::bounding_cap(tile.key);
      if (tile.key.level == level && glm::length(cap.centre - kPatched) < reach_rad + 2 * cap.radius_rad)
        keys.push_back(tile.key);
    }
    return keys;
  }

  struct States {
    test_support::TempDir dir;
    std::shared_ptr<const PlanetFile> base;
    std::shared_ptr<const PlanetFile> changed;
  };
  static std::unique_ptr<States> states_;
  const std::shared_ptr<const PlanetFile>& base_ = states_->base;
  const int n_ = base_->meta().tile.intervals();
  const int finest_ = base_->meta().finest_level;
};
std::unique_ptr<CoarseTexture::States> CoarseTexture::states_;

TEST_F(CoarseTexture, BlocksArePartsOfGridsAbove) {
  const lod::TileKey tile{mars::Face{2}, 9, 300, 77};
  for (int up = 0; n_ >> up > 0; ++up) {
    const int intervals = n_ >> up;
    const TexelBlock block = coarse_block(tile, intervals, n_);
    EXPECT_EQ(block.tile, lod::ancestor(tile, tile.level - up));
    EXPECT_TRUE(lod::contains(block.image, block.tile));
    EXPECT_EQ(n_ << (block.tile.level - block.image.level), std::max(n_, kImageIntervals));
    const lod::GridLines own = lod::grid_lines(tile, n_);
    const lod::GridLines above = lod::grid_lines(block.tile, n_);
    for (int x = 0; x <= intervals; ++x) {
      const auto of_own = static_cast<std::size_t>(x << up);
      EXPECT_DOUBLE_EQ(above.u[static_cast<std::size_t>(block.first_x + x)], own.u[of_own]);
      EXPECT_DOUBLE_EQ(above.v[static_cast<std::size_t>(block.first_y + x)], own.v[of_own]);
    }
  }
  EXPECT_EQ(least_intervals({mars::Face{0}, 0, 0, 0}, n_), n_);
  EXPECT_EQ(least_intervals({mars::Face{0}, 2, 3, 1}, n_), n_ / 4);
  EXPECT_EQ(least_intervals({mars::Face{0}, 20, 3, 1}, n_), 1);
  EXPECT_EQ(whole_block(tile, n_).image, tile);
}

// On lines of posts nothing is interpolated.
TEST_F(CoarseTexture, TexelsAreThoseOfTheTileAbove) {
  const TerrainShader shader(base_, kBudget);
  int compared = 0;
  for (const vpe::core::Mode mode : {vpe::core::Mode::kLit, vpe::core::Mode::kTextured}) {
    const ShadingParams params = look(mode);
    for (const lod::TileKey& key : tiles_at(finest_)) {
      for (int up = 1; key.level - up >= kFirstEvenTexture; ++up) {
        const ShadedTile coarse = shader.shade(key, n_ >> up, params);
        const ShadedTile above = shader.shade(lod::ancestor(key, key.level - up), n_, params);
        const TexelBlock block = coarse_block(key, n_ >> up, n_);
        ASSERT_EQ(coarse.intervals, n_ >> up);
        ASSERT_EQ(coarse.channels, above.channels);
        EXPECT_EQ(coarse.brightest, above.brightest);
        const auto channels = static_cast<std::size_t>(coarse.channels);
        const auto side = static_cast<std::size_t>(coarse.intervals) + 1;
        const auto above_side = static_cast<std::size_t>(n_) + 1;
        ASSERT_EQ(coarse.texels.size(), channels * side * side);
        for (std::size_t y = 0; y < side; ++y) {
          for (std::size_t b = 0; b < channels * side; ++b) {
            const std::size_t at = channels * ((static_cast<std::size_t>(block.first_y) + y) * above_side +
                                               static_cast<std::size_t>(block.first_x));
            ASSERT_EQ(coarse.texels[channels * side * y + b], above.texels[at + b]);
          }
        }
        ++compared;
      }
    }
  }
  EXPECT_GT(compared, 8);
}

// The definition is that of colours at points, with posts and texels as far apart as these.
TEST_F(CoarseTexture, TexelsHaveTheColoursOfTheirFootprint) {
  const TerrainShader shader(base_, kBudget);
  const ShadingParams params = look(vpe::core::Mode::kTextured);
  TerrainShader::Cursor cursor;
  for (int level = 1; level <= finest_; ++level) {
    for (const lod::TileKey& key : tiles_at(level)) {
      for (int intervals = n_; intervals >= least_intervals(key, n_); intervals /= 2) {
        const ShadedTile texture = shader.shade(key, intervals, params);
        const double spacing_m = lod::nominal_side_m(key.level, base_->radius_m()) / intervals;
        const mars::ChartRect rect = lod::chart_rect(key);
        int off = 0;
        for (int y = 0; y <= intervals; ++y) {
          for (int x = 0; x <= intervals; ++x) {
            const auto between = [&](double a, double b, int k) {
              return a + (b - a) * std::clamp(static_cast<double>(k) / intervals, 1e-9, 1 - 1e-9);
            };
            const mars::ChartPoint place{key.face, between(rect.u0, rect.u1, x), between(rect.v0, rect.v1, y)};
            const glm::dvec3 direction = mars::chart_direction(place.face, place.u, place.v);
            const auto wanted = shader.colour_at(direction, 1.001 * spacing_m, params, cursor);
            ASSERT_TRUE(wanted);
            const std::uint8_t* texel =
                &texture.texels[4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(intervals + 1) +
                                     static_cast<std::size_t>(x))];
            for (int c = 0; c < 3; ++c)
              off += std::abs(texel[c] - std::clamp((*wanted)[c], 0.0, 255.0)) > 2 ? 1 : 0;
          }
        }
        // Tiles above level 5 are put on even lines after they are lit.
        EXPECT_LE(off, 3 * (intervals + 1) * (intervals + 1) / (key.level < kFirstEvenTexture ? 10 : 1000))
            << lod::to_string(key) << " " << intervals;
      }
    }
  }
}

TEST_F(CoarseTexture, BordersMeet) {
  const TerrainShader shader(base_, kBudget);
  const ShadingParams params = look(vpe::core::Mode::kTextured);
  int met = 0;
  for (const lod::TileKey& key : tiles_at(finest_)) {
    const lod::Neighbour across = lod::neighbour(key, lod::Edge::kEast);
    if (across.key.face != key.face || base_->tree().find(across.key) == nullptr) continue;
    for (int intervals = n_; intervals >= 1; intervals /= 2) {
      if (intervals < least_intervals(key, n_)) break;
      const ShadedTile west = shader.shade(key, intervals, params);
      const ShadedTile east = shader.shade(across.key, intervals, params);
      const auto side = static_cast<std::size_t>(intervals) + 1;
      for (std::size_t y = 0; y < side; ++y) {
        for (std::size_t c = 0; c < 3; ++c)
          ASSERT_NEAR(west.texels[4 * (y * side + side - 1) + c], east.texels[4 * y * side + c], 1);
      }
      ++met;
    }
  }
  EXPECT_GT(met, 5);
}

// A patch beside a tile changes posts above that are farther across its border than its own.
TEST_F(CoarseTexture, VersionsNameTexels) {
  const TerrainShader before(base_, kBudget);
  const TerrainShader after(states_->changed, kBudget);
  const ShadingParams params = look(vpe::core::Mode::kTextured);
  int equal = 0;
  int other = 0;
  for (int level = 0; level <= finest_; ++level) {
    for (const lod::TileKey& key : tiles_at(level, 0.1)) {
      if (states_->changed->tree().find(key) == nullptr) continue;
      for (int intervals = n_; intervals >= least_intervals(key, n_); intervals /= 2) {
        const bool is_same = texture_version(*base_, key, intervals, params) ==
                             texture_version(*states_->changed, key, intervals, params);
        if (before.shade(key, intervals, params).texels != after.shade(key, intervals, params).texels) {
          EXPECT_FALSE(is_same) << lod::to_string(key) << " " << intervals;
          ++other;
        }
        equal += is_same ? 1 : 0;
      }
    }
  }
  EXPECT_GT(other, 10);
  EXPECT_GT(equal, 10);
}

}  // namespace
}  // namespace paging
