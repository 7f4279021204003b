#include "vpe/voxel/columns/refine.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <vector>

namespace {

using namespace vpe::voxel;

// Provides one height grid below the middle of a face, whose facets lie in one tilted plane.
class TiltedGround : public FacetSource {
 public:
  static constexpr int kIntervals = 64;
  static constexpr double kDepth_m = 1e6;

  explicit TiltedGround(LineFamily family)
      : posts_(static_cast<std::size_t>((kIntervals + 1) * (kIntervals + 1) + 1 + kReadAhead), 0.0F) {
    lines_.reference = {1.0 / kDepth_m, 0, 0};
    lines_.posts = posts_.data() + 1;
    lines_.side = kIntervals + 1;
    facets_.face = mars::Face::kPlusZ;
    facets_.frame = {kIntervals, -0.01, 0.02 / kIntervals, -0.01, 0.02 / kIntervals};
    facets_.family = family;
    facets_.lines = &lines_;
    for (int x = 0; x <= kIntervals; ++x) {
      for (int y = 0; y <= kIntervals; ++y) {
        const int line = family == LineFamily::kColumns ? x : (family == LineFamily::kRows ? y : x - y);
        const int along = family == LineFamily::kColumns ? y : x;
        posts_[static_cast<std::size_t>(lines_.line(line) + along - posts_.data())] =
            static_cast<float>(height(x, y));
      }
    }
  }
  const Facets& at(const glm::dvec3&) override { return facets_; }
  // Returns H at a post.
  static double height(int x, int y) { return kRise_m * x + kFall_m * y; }

  // Returns where a ray meets the plane; `direction` is of any length.
  double range_m(const glm::dvec3& camera_m, const glm::dvec3& direction) const {
    const mars::FaceAxes& axes = mars::face_axes(facets_.face);
    // 1 for places in the plane.
    const auto inverse_depth_times = [&](const glm::dvec3& p) {
      const HeightGridFrame& f = facets_.frame;
      const double z = glm::dot(p, axes.out);
      const double x = (glm::dot(p, axes.right) - f.u0 * z) / f.du;
      const double y = (glm::dot(p, axes.up) - f.v0 * z) / f.dv;
      return z / kDepth_m - (kRise_m * x + kFall_m * y) / (kDepth_m * kDepth_m);
    };
    return (1 - inverse_depth_times(camera_m)) / inverse_depth_times(direction) * glm::length(direction);
  }

 private:
  static constexpr double kRise_m = 40;  // of H a post
  static constexpr double kFall_m = -25;

  std::vector<float> posts_;
  HeightGridLines<float> lines_;
  Facets facets_;
};

// Returns a row of rays from above the ground's middle, down to it.
RayRow row_down(int count) {
  const mars::FaceAxes& axes = mars::face_axes(mars::Face::kPlusZ);
  RayRow row;
  row.camera_m = (TiltedGround::kDepth_m + 5000) * axes.out;
  row.radius_m = TiltedGround::kDepth_m;
  row.first = -axes.out - 0.9 * axes.right + 0.13 * axes.up;
  row.step = (1.8 / count) * axes.right;
  row.count = count;
  return row;
}

double range_m(const RayRow& row, int k) {
  return TiltedGround(LineFamily::kRows).range_m(row.camera_m, row.first + static_cast<double>(k) * row.step);
}

// Refines a row whose hints are off by shares of the range.
std::vector<float> refined(const RayRow& row, LineFamily family, double off_a, double off_b,
                           std::vector<int>& unresolved) {
  TiltedGround ground(family);
  TiltedGround exact(family);
  const auto room = static_cast<std::size_t>(row.count);
  std::vector<float> a(room);
  std::vector<float> b(room);
  const std::vector<float> share(room, 0.25F);
  for (int k = 0; k < row.count; ++k) {
    a[static_cast<std::size_t>(k)] = static_cast<float>((1 + off_a) * range_m(row, k));
    b[static_cast<std::size_t>(k)] = static_cast<float>((1 + off_b) * range_m(row, k));
  }
  std::vector<float> range(room, -1.0F);
  refine_row(row, a.data(), b.data(), share.data(), ground, exact, range.data(), unresolved);
  return range;
}

TEST(RefineRow, MeetsTheFacetsOfEachRay) {
  for (const LineFamily family : {LineFamily::kColumns, LineFamily::kRows, LineFamily::kDiagonals}) {
    for (const double off : {0.0, 0.0004, 0.03}) {
      for (const int count : {1, 7, 128, 300}) {
        const RayRow row = row_down(count);
        std::vector<int> unresolved;
        const std::vector<float> range = refined(row, family, off, -off, unresolved);
        EXPECT_TRUE(unresolved.empty());
        for (int k = 0; k < count; ++k) {
          const double expected_m = range_m(row, k);
          EXPECT_NEAR(static_cast<double>(range[static_cast<std::size_t>(k)]), expected_m, 2e-6 * expected_m)
              << "pixel " << k << " of " << count << ", off by " << off;
        }
      }
    }
  }
}

TEST(RefineRow, GivesUpRaysFarFromTheirHints) {
  const RayRow row = row_down(200);
  std::vector<int> unresolved;
  const std::vector<float> range = refined(row, LineFamily::kRows, 0.1, 0.11, unresolved);
  std::ranges::sort(unresolved);
  ASSERT_EQ(unresolved.size(), 200U);
  for (int k = 0; k < row.count; ++k) EXPECT_EQ(unresolved[static_cast<std::size_t>(k)], k);
  EXPECT_EQ(range[150], static_cast<float>(1.1 * range_m(row, 150)));
}

// Gives hints of a block of rays over tilted ground that are off by shares of the range, other ones in each pixel.
class OffHints : public BlockHints {
 public:
  OffHints(const RayBlock& block, double off) : block_(block), off_(off) {}
  static double range_m(const RayBlock& block, int row, int column) {
    return TiltedGround(LineFamily::kRows).range_m(block.camera_m, block.ray(row, column));
  }
  void get(int row, float* a, float* b, float* share) override {
    rows.push_back(row);
    for (int k = 0; k < block_.columns; ++k) {
      const double off = off_ * (1 + (7 * row + k) % 5);
      a[k] = static_cast<float>((1 + off) * range_m(block_, row, k));
      b[k] = static_cast<float>((1 - off) * range_m(block_, row, k));
      share[k] = 0.75F;
    }
  }
  std::vector<int> rows;

 private:
  RayBlock block_;
  double off_;
};

RayBlock block_down(int rows, int columns) {
  const RayRow row = row_down(columns);
  const mars::FaceAxes& axes = mars::face_axes(mars::Face::kPlusZ);
  return {row.camera_m, row.radius_m, row.first, row.step, (-0.2 / rows) * axes.up, columns, rows};
}

TEST(RefineBlock, MeetsTheFacetsOfEachRay) {
  constexpr std::ptrdiff_t kStride = 150;
  for (const LineFamily family : {LineFamily::kColumns, LineFamily::kRows, LineFamily::kDiagonals}) {
    for (const double off : {0.0, 0.0004, 0.007}) {
      for (const int columns : {3, 100, kRayBlockColumns}) {
        for (const int rows : {1, 5, kRayBlockRows}) {
          const RayBlock block = block_down(rows, columns);
          TiltedGround ground(family);
          TiltedGround exact(family);
          OffHints hints(block, off);
          std::vector<float> range(kStride * kRayBlockRows, -1.0F);
          std::vector<UnresolvedPixel> unresolved;
          refine_block(block, hints, ground, exact, range.data(), kStride, unresolved);
          EXPECT_TRUE(unresolved.empty());
          EXPECT_EQ(hints.rows.size(), static_cast<std::size_t>(rows));
          for (int row = 0; row < rows; ++row) {
            for (int k = 0; k < kStride; ++k) {
              const auto seen = static_cast<double>(range[static_cast<std::size_t>(row * kStride + k)]);
              const double expected_m = k < columns ? OffHints::range_m(block, row, k) : -1.0;
              ASSERT_NEAR(seen, expected_m, 2e-6 * std::abs(expected_m))
                  << "pixel " << row << ", " << k << " of " << rows << " x " << columns << ", off by " << off;
            }
          }
        }
      }
    }
  }
}

// Provides the plane of TiltedGround by two height grids that meet in the middle, one of floats and one of doubles.
class HalvedGround : public FacetSource {
 public:
  HalvedGround() {
    add(-0.02, float_posts_, floats_);
    facets_[0].lines = &floats_;
    add(0.0, double_posts_, doubles_);
    facets_[1].exact_lines = &doubles_;
    facets_[1].id = 1;
  }
  const Facets& at(const glm::dvec3& place_m) override {
    const mars::FaceAxes& axes = mars::face_axes(mars::Face::kPlusZ);
    return facets_[glm::dot(place_m, axes.right) < 0 ? 0 : 1];
  }

 private:
  static constexpr int kSide = TiltedGround::kIntervals + 1;

  template <class T>
  void add(double u0, std::vector<T>& posts, HeightGridLines<T>& lines) {
    posts.assign(static_cast<std::size_t>(kSide * kSide + 1 + kReadAhead), T(0));
    lines.reference = {1.0 / TiltedGround::kDepth_m, 0, 0};
    lines.posts = posts.data() + 1;
    lines.side = kSide;
    Facets& facets = facets_[u0 < 0 ? 0 : 1];
    facets.face = mars::Face::kPlusZ;
    facets.frame = {TiltedGround::kIntervals, u0, 0.02 / TiltedGround::kIntervals, -0.01,
                    0.02 / TiltedGround::kIntervals};
    facets.family = LineFamily::kRows;
    for (int x = 0; x < kSide; ++x) {
      for (int y = 0; y < kSide; ++y)
        posts[static_cast<std::size_t>(lines.line(y) + x - posts.data())] =
            static_cast<T>(TiltedGround::height(x + (u0 < 0 ? -32 : 32), y));
    }
  }

  std::vector<float> float_posts_;
  std::vector<double> double_posts_;
  HeightGridLines<float> floats_;
  HeightGridLines<double> doubles_;
  std::array<Facets, 2> facets_;
};

TEST(RefineBlock, MeetsFacetsOfFloatsAndOfDoubles) {
  const RayBlock block = block_down(kRayBlockRows, kRayBlockColumns);
  for (const double off : {0.0, 0.0004, 0.007}) {
    HalvedGround ground;
    HalvedGround exact;
    OffHints hints(block, off);
    std::vector<float> range(static_cast<std::size_t>(block.rows * block.columns));
    std::vector<UnresolvedPixel> unresolved;
    refine_block(block, hints, ground, exact, range.data(), block.columns, unresolved);
    EXPECT_TRUE(unresolved.empty());
    for (int row = 0; row < block.rows; ++row) {
      for (int k = 0; k < block.columns; ++k) {
        const double expected_m = OffHints::range_m(block, row, k);
        ASSERT_NEAR(static_cast<double>(range[static_cast<std::size_t>(row * block.columns + k)]), expected_m,
                    2e-6 * expected_m)
            << "pixel " << row << ", " << k << ", off by " << off;
      }
    }
  }
}

TEST(RefineBlock, NamesPixelsFarFromTheirHints) {
  const RayBlock block = block_down(4, 60);
  TiltedGround ground(LineFamily::kRows);
  TiltedGround exact(LineFamily::kRows);
  // Hints at 1.1 and 0.9 of the range and beyond, so the nearer one is far from it too.
  OffHints hints(block, 0.1);
  std::vector<float> range(4 * 60);
  std::vector<UnresolvedPixel> unresolved;
  refine_block(block, hints, ground, exact, range.data(), 60, unresolved);
  ASSERT_EQ(unresolved.size(), 4U * 60U);
  std::vector<bool> is_named(4 * 60);
  for (const UnresolvedPixel& pixel : unresolved) {
    const double range_m = OffHints::range_m(block, pixel.row, pixel.column);
    const double off = 0.1 * (1 + (7 * pixel.row + pixel.column) % 5);
    EXPECT_EQ(pixel.a, static_cast<float>((1 + off) * range_m));
    EXPECT_EQ(pixel.b, static_cast<float>((1 - off) * range_m));
    const auto n = static_cast<std::size_t>(pixel.row * 60 + pixel.column);
    EXPECT_EQ(range[n], pixel.b);
    EXPECT_FALSE(is_named[n]);
    is_named[n] = true;
  }
}

TEST(HintsFromRow, AreTheSamplesOnEitherSide) {
  std::vector<float> samples(40);
  for (std::size_t n = 0; n < samples.size(); ++n) samples[n] = 100.0F + static_cast<float>(n * n);
  constexpr int kCount = 37;
  std::vector<float> a(kCount);
  std::vector<float> b(kCount);
  std::vector<float> share(kCount);
  const double first = -2.25;
  const double step = 1.25;
  hints_from_row(samples.data(), static_cast<int>(samples.size()), first, step, kCount, a.data(), b.data(),
                 share.data());
  for (std::size_t k = 0; k < kCount; ++k) {
    const double place = std::clamp(first + static_cast<double>(k) * step, 0.0, 39.0);
    const auto before = static_cast<std::size_t>(std::min(std::floor(place), 38.0));
    EXPECT_EQ(a[k], samples[before]) << k;
    EXPECT_EQ(b[k], samples[before + 1]) << k;
    EXPECT_NEAR(static_cast<double>(share[k]), place - static_cast<double>(before), 1e-5) << k;
  }
}

TEST(NearestInColumns, AreTheSamplesNearestToPixels) {
  constexpr int kLines = 50;
  for (const std::size_t count : {std::size_t{1}, std::size_t{4}, std::size_t{37}}) {
    std::vector<double> maps;
    for (std::size_t k = 0; k < count; ++k) {
      maps.push_back(1.0 + 0.05 * static_cast<double>(k));
      maps.push_back(-3.0 + 1.5 * static_cast<double>(k));
    }
    std::vector<std::int32_t> index(count + 1, -1);
    nearest_in_columns(kLines, maps.data(), 7.5, 2.25, 2.0, static_cast<int>(count), index.data());
    for (std::size_t k = 0; k < count; ++k) {
      const double line = (maps[2 * k] * 7.5 + maps[2 * k + 1] - 2.25) * 2.0;
      const double nearest = std::clamp(std::floor(line + 0.5), 0.0, kLines - 1.0);
      EXPECT_EQ(index[k], static_cast<int>(k) * kLines + static_cast<int>(nearest)) << k << " of " << count;
    }
    EXPECT_EQ(index[count], -1);
  }
}

}  // namespace
