// The bound of an image by the parts of tiles that its pixels show, on made pixels; and the errors that it uses, against the
// reference surface.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>

#include "paging/surface/tile_errors.h"
#include "tests/lod/fake_tree.h"
#include "tests/paging/planet_fixture.h"
#include "vpe/core/frame.h"
#include "vpe/gl/certify.h"
#include "vpe/gl/tile_id.h"

namespace {

using lod::BlockErrors;
using vpe::gl::CertifiedTile;
using vpe::gl::TilePart;

constexpr double kRadius_m = 3396190.0;
constexpr double kHeight_m = 1e5;
const vpe::gl::FrameOptics kOptics{1000, 0.5, 0.02, 1, 0.005};

class BoundInImage : public ::testing::Test {
 protected:
  BoundInImage() : tree_(roots(), {2}, kRadius_m) {
    // West and east halves of the western half of a face.
    tile_.key = {mars::Face::kPlusX, 1, 0, 0};
    across_.key = {mars::Face::kPlusX, 1, 1, 0};
    tile_.geometric_error_m = 50;
    across_.geometric_error_m = 90;
  }

  // A camera that looks down on a place of the chart of face +x from kHeight_m, 9 x 5 pixels with f = 1000.
  static vpe::core::View above(double u, double v) {
    vpe::core::View view;
    view.camera.position_m = (kRadius_m + kHeight_m) * mars::chart_direction(mars::Face::kPlusX, u, v);
    const glm::dvec3 down = -glm::normalize(view.camera.position_m);
    const glm::dvec3 right = glm::normalize(glm::cross(down, glm::dvec3(0, 0, 1)));
    view.camera.axes = {right, glm::cross(right, down), down};
    view.width = 9;
    view.height = 5;
    view.fov_deg = 2 * std::atan(2.5 / 1000) / mars::kRadiansPerDegree;
    return view;
  }

  double bound(const vpe::core::View& view, TilePart part, std::span<const CertifiedTile> tiles,
               const vpe::gl::BlockErrorsOf& errors) const {
    std::vector<std::uint32_t> ids(45, vpe::gl::pack({0, part}));
    // Skirts stand on borders: in the middle column.
    for (std::size_t n = 0; n < ids.size(); ++n)
      if (part == TilePart::kSkirt && n % 9 != 4) ids[n] = vpe::gl::pack({0, TilePart::kSurface});
    const std::vector<float> ranges(45, static_cast<float>(kHeight_m));
    return vpe::gl::bound_in_image(tiles, tree_, {ids, ranges, 1e-9}, kOptics, view, errors);
  }
  double bound(const vpe::core::View& view, TilePart part, const vpe::gl::BlockErrorsOf& errors) const {
    const std::array<CertifiedTile, 1> tiles{{{&tile_, 1e-9, 100, 0, 0}}};
    return bound(view, part, tiles, errors);
  }

  static std::vector<lod::TileInfo> roots() {
    std::vector<lod::TileInfo> infos;
    for (int f = 0; f < 6; ++f)
      infos.push_back({{static_cast<mars::Face>(f), 0, 0, 0}, 0, 0, false, {}, {{{}, 32}}, 0.0});
    return infos;
  }
  // 4 blocks: 50 in the south-west, 3 elsewhere.
  static std::shared_ptr<const BlockErrors> blocks(float worst = 50) {
    return std::make_shared<const BlockErrors>(BlockErrors{{-1, -0.5, 0}, {-1, -0.5, 0}, {worst, 3, 3, 3}});
  }
  static double storage_px() { return (1e-9 + 4e-7 * (kHeight_m + 100)) * 1000 / kHeight_m; }

  lod::TileTree tree_;
  lod::SelectedTile tile_;
  lod::SelectedTile across_;
};

TEST_F(BoundInImage, HasTheErrorsOfBlocksInSight) {
  const auto errors = [](const lod::SelectedTile&) { return blocks(); };
  const auto none = [](const lod::SelectedTile&) { return nullptr; };
  const double floor_px = storage_px() + 0.005;
  EXPECT_NEAR(bound(above(-0.8, -0.8), TilePart::kSurface, errors), 50 * 1000 / kHeight_m + floor_px, 1e-6);
  EXPECT_NEAR(bound(above(-0.3, -0.8), TilePart::kSurface, errors), 3 * 1000 / kHeight_m + floor_px, 1e-6);
  EXPECT_NEAR(bound(above(-0.3, -0.8), TilePart::kSurface, none), 50 * 1000 / kHeight_m + floor_px, 1e-6);
  // Ribbons, and thin triangles, are moved by more.
  EXPECT_NEAR(bound(above(-0.3, -0.8), TilePart::kRibbon, errors), 3 * 1000 / kHeight_m + storage_px() + 0.02,
              1e-6);
  // No block says more than the tile.
  EXPECT_NEAR(bound(above(-0.8, -0.8), TilePart::kSurface, [](const auto&) { return blocks(1e9F); }),
              50 * 1000 / kHeight_m + floor_px, 1e-6);
  EXPECT_EQ(vpe::gl::bound_in_image({}, tree_, {}, kOptics, above(0, 0), errors), 0);
}

TEST_F(BoundInImage, CountsBlocksWithinTheReachOfAPixel) {
  const auto errors = [](const lod::SelectedTile&) { return blocks(); };
  // The footprint of the outermost pixel's centre is 400 m to the west; a pixel's point is known to 0.5 m.
  const double metre = 1.25 / kRadius_m;  // of chart at u = -0.5
  EXPECT_LT(bound(above(-0.5 + 500 * metre, -0.8), TilePart::kSurface, errors), 0.1);
  EXPECT_GT(bound(above(-0.5 + 300 * metre, -0.8), TilePart::kSurface, errors), 0.49);
  // A view that is cut: the part without the western columns.
  vpe::core::View part = above(-0.5 + 300 * metre, -0.8);
  part.part = {4, 0, 5, 5};
  const std::vector<std::uint32_t> ids(25, vpe::gl::pack({0, TilePart::kSurface}));
  const std::vector<float> ranges(25, static_cast<float>(kHeight_m));
  const std::array<CertifiedTile, 1> tiles{{{&tile_, 1e-9, 100, 0, 0}}};
  EXPECT_LT(vpe::gl::bound_in_image(tiles, tree_, {ids, ranges, 1e-9}, kOptics, part, errors), 0.1);
  // Ranges that are known worse reach farther.
  EXPECT_GT(vpe::gl::bound_in_image(tiles, tree_, {ids, ranges, 2e-3}, kOptics, part, errors), 0.49);
}

TEST_F(BoundInImage, HasForSkirtsTheLargerErrorOfBothTiles) {
  const vpe::core::View view = above(0, -0.8);
  const auto errors = [&](const lod::SelectedTile& tile) {
    if (tile.key == tile_.key) return blocks();
    return std::make_shared<const BlockErrors>(BlockErrors{{0, 0.5, 1}, {-1, -0.5, 0}, {7, 90, 90, 90}});
  };
  // As deep as both errors.
  const std::array<CertifiedTile, 2> both{{{&tile_, 1e-9, 100, 0, 140}, {&across_, 1e-9, 100, 0, 140}}};
  const double floor_px = storage_px() + 0.02;
  EXPECT_NEAR(bound(view, TilePart::kSkirt, both, errors), 7 * 1000 / kHeight_m + floor_px, 1e-6);
  // What is across is not drawn: its error is what the skirt is deeper than the own one.
  EXPECT_NEAR(bound(view, TilePart::kSkirt, std::span(both).first(1), errors), 90 * 1000 / kHeight_m + floor_px,
              1e-6);
}

// Of all kinds of tiles: finest ones, those above them, and others.
TEST(TileErrors, BoundMeshesOverTheirBlocks) {
  const test_support::TempDir dir;
  const glm::dvec3 fine = glm::normalize(glm::dvec3(0.2, -0.4, 1));
  const auto planet = test_support::build_fake(
      dir / "p.vpe",
      test_support::FakeElevation(test_support::bumpy_height, test_support::fine_around(fine, 0.2, 30000)),
      200000);
  const paging::Surface surface(planet, std::size_t{1} << 28);
  const lod::TileTree& tree = planet->tree();
  paging::TileErrors errors(planet);
  std::array<int, 3> measured{};
  double own = 0;
  double whole = 0;
  for (lod::TileTree::Index n = 0; n < tree.size(); ++n) {
    const lod::TileInfo& info = tree[n];
    int kind = 0;
    for (lod::TileTree::Index c = 0; info.has_children && c < 4; ++c)
      kind = std::max(kind, tree[tree.first_child(n) + c].has_children ? 2 : 1);
    for (int variant = 0; variant < static_cast<int>(info.variants.size()); ++variant) {
      lod::SelectedTile tile;
      tile.key = info.key;
      tile.index = n;
      tile.variant = variant;
      tile.geometric_error_m =
          tree.geometric_error_m(info, info.variants[static_cast<std::size_t>(variant)].terms, 1);
      const auto found = errors.find(tile, 1);
      if (lod::is_full_grid(info, variant)) {
        EXPECT_EQ(found, nullptr);
        continue;
      }
      if (!found) continue;
      EXPECT_EQ(errors.find(tile, 1), found);
      ++measured[static_cast<std::size_t>(kind)];
      for (const float e : found->bound_m) {
        own += static_cast<double>(e) / tile.geometric_error_m;
        ++whole;
        ASSERT_LE(static_cast<double>(e), tile.geometric_error_m * (1 + 1e-6));
      }
      // The middles of triangles and of their edges.
      const paging::PackedMesh packed = planet->mesh(info.key, variant);
      const lod::GridLines lines = lod::grid_lines(info.key, packed.mesh.intervals);
      const double q = planet->meta().quantum_m;
      for (std::size_t t = 0; t + 2 < packed.mesh.triangles.size(); t += 3) {
        std::array<glm::dvec3, 3> corner;
        for (std::size_t k = 0; k < 3; ++k) {
          const std::size_t v = packed.mesh.triangles[t + k];
          corner[k] = mars::chart_direction(info.key.face, lines.u[packed.mesh.vertices[v].i],
                                            lines.v[packed.mesh.vertices[v].j]) *
                      (planet->radius_m() + packed.height_q[v] * q);
        }
        const glm::dvec3 middle = (corner[0] + corner[1] + corner[2]) / 3.0;
        for (const glm::dvec3& p : {middle, 0.5 * (corner[0] + corner[1]), 0.5 * (corner[1] + corner[2])}) {
          const mars::ChartPoint at = mars::chart_on(info.key.face, p);
          const double off_m = std::abs(surface.at(glm::normalize(p)).radius_m - glm::length(p));
          ASSERT_LE(off_m, found->largest_m(at.u, at.v, 1e-9) + 1e-4) << lod::to_string(info.key);
        }
      }
    }
  }
  for (const int count : measured) EXPECT_GT(count, 2);
  EXPECT_LT(own, 0.75 * whole);  // they say more than the tile's error
  lod::SelectedTile root;
  root.key = tree[0].key;
  root.geometric_error_m = 1e9;
  EXPECT_EQ(errors.find(root, 2), nullptr);
}

TEST(TileErrors, KeepWithinTheirBudgetAndStayTheSame) {
  const test_support::TempDir dir;
  const auto planet =
      test_support::build_fake(dir / "p.vpe", test_support::FakeElevation(test_support::bumpy_height), 30000);
  const lod::TileTree& tree = planet->tree();
  // Room for a few tiles of each kind.
  constexpr std::size_t kBudget = std::size_t{1} << 20;
  paging::TileErrors small(planet, kBudget);
  paging::TileErrors large(planet);
  EXPECT_EQ(small.bytes(), 0U);
  int found = 0;
  for (lod::TileTree::Index n = 0; n < tree.size(); ++n) {
    const lod::TileInfo& info = tree[n];
    for (int variant = 0; variant < static_cast<int>(info.variants.size()); ++variant) {
      lod::SelectedTile tile;
      tile.key = info.key;
      tile.index = n;
      tile.variant = variant;
      tile.geometric_error_m =
          tree.geometric_error_m(info, info.variants[static_cast<std::size_t>(variant)].terms, 1);
      const auto a = small.find(tile, 1);
      const auto b = large.find(tile, 1);
      ASSERT_EQ(a == nullptr, b == nullptr);
      if (!a) continue;
      EXPECT_EQ(a->bound_m, b->bound_m);
      EXPECT_LE(small.bytes(), kBudget);
      ++found;
    }
  }
  EXPECT_GT(found, 50);
  EXPECT_GT(small.bytes(), kBudget / 4);
  EXPECT_GT(large.bytes(), kBudget);
  EXPECT_LE(large.bytes(), paging::TileErrors::kUsualBytes);
}

}  // namespace
