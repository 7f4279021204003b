// Tests the discrete column walk against the pseudo-code of Cohen-Or 1996 (figure 7), ray by ray and step by step, bit for bit.
#include <gtest/gtest.h>

#include <hwy/targets.h>
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <limits>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "tests/support/support.h"
#include "vpe/voxel/columns/discrete.h"

namespace {

using namespace vpe::voxel;
using test_support::Random;

// Holds the voxels of a square map, in both families.
class Map : public HeightGridSource {
 public:
  Map(int intervals, Random& random, double spread_m) : n_(intervals) {
    for (int k = 0; k < side() * side(); ++k)
      heights_.push_back(static_cast<float>(random.uniform(-spread_m, spread_m)));
    for (Store& store : stores_) store.posts.resize(heights_.size() + 1 + kReadAhead);
    const int blocks = n_ / kBlockLines + 1;
    for (int f = 0; f < 2; ++f) {
      Store& store = stores_[f];
      store.maxima.assign(static_cast<std::size_t>(blocks * blocks), std::numeric_limits<float>::lowest());
      for (int k = 0; k <= n_; ++k) {
        for (int p = 0; p <= n_; ++p) {
          const float h = f == 0 ? height(k, p) : height(p, k);
          store.posts[1 + static_cast<std::size_t>(k * side() + p)] = h;
          for (int b = (k - 1) / kBlockLines; b <= k / kBlockLines; ++b) {
            for (int c = (p - 1) / kBlockLines; c <= p / kBlockLines; ++c) {
              float& most = store.maxima[static_cast<std::size_t>(b * blocks + c)];
              most = std::max(most, h);
            }
          }
        }
      }
      store.lines = {{1e-6, 2e-10, -1e-10}, store.posts.data() + 1, store.maxima.data(), side(), 0, blocks};
    }
  }

  int intervals() const { return n_; }
  float height(int x, int y) const { return heights_[static_cast<std::size_t>(x * side() + y)]; }
  const HeightGridLines<float>& lines(LineFamily family) override {
    return stores_[static_cast<std::size_t>(family)].lines;
  }
  const HeightGridLines<double>& exact_lines(LineFamily) override { throw std::logic_error("not asked for"); }

 private:
  int side() const { return n_ + 1; }
  struct Store {
    std::vector<float> posts;
    std::vector<float> maxima;
    HeightGridLines<float> lines;
  };
  int n_;
  std::vector<float> heights_;
  Store stores_[2];
};

// Describes one image of columns over the map.
struct Scene {
  HeightGridFrame frame;
  ColumnCamera camera;
  glm::dvec3 up;  // in the axes of the face
  Rows rows;
  std::vector<float> table;
  std::vector<double> exact;
  double blend_from_m = 0;
  ColumnGroup group{};
  std::vector<float> buffers;
};

// Returns the slope of a row of a column, as the rows of all casts have it.
float slope_of(const Scene& s, int lane, int row) {
  switch (s.rows.kind) {
    case RowKind::kEven:
      return (static_cast<float>(row) - static_cast<float>(s.rows.centre)) * static_cast<float>(s.rows.step);
    case RowKind::kTable: return s.table[static_cast<std::size_t>(row)];
    case RowKind::kSector: break;
  }
  const bool is_fused = std::string_view(column_target()).starts_with("AVX");
  const auto affine = [&](double at_zero, double per_row) {
    const auto a = static_cast<float>(at_zero);
    const auto b = static_cast<float>(per_row);
    const auto r = static_cast<float>(row);
    return is_fused ? std::fma(b, r, a) : b * r + a;
  };
  return affine(s.group.sector_a0[lane], s.group.sector_a1[lane]) /
         affine(s.group.sector_b0[lane], s.group.sector_b1[lane]);
}

// Holds what a column shows: its first row without ground, and the range of each row below.
struct Seen {
  int row = 0;
  std::vector<float> range_m;
};

// Follows the rays of one column, from the lowest one on: along the major axis in steps of a cell, with the other position in
// fixed point, until the ray is on or below the voxel; then climbs to the next ray at the same voxel.
Seen follow(const Scene& s, const Map& map, int lane) {
  const HeightGridFrame& f = s.frame;
  const double ax = s.group.azimuth[0][lane], ay = s.group.azimuth[1][lane], az = s.group.azimuth[2][lane];
  const double nx = s.group.normal[0][lane] * f.du;
  const double ny = s.group.normal[1][lane] * f.dv;
  const double nc = s.group.normal[0][lane] * f.u0 + s.group.normal[1][lane] * f.v0 + s.group.normal[2][lane];
  const bool is_x_major = std::abs(nx) <= std::abs(ny);
  const double across = is_x_major ? ny : nx;
  const double at_zero = -nc / across;
  const double per_line = -(is_x_major ? nx : ny) / across;
  const double x0 = is_x_major ? 0 : at_zero, xk = is_x_major ? 1 : per_line;
  const double y0 = is_x_major ? at_zero : 0, yk = is_x_major ? per_line : 1;
  const double scale = s.camera.radius_m * s.camera.radius_m / s.camera.distance_m;
  const double u0 = f.u0 + f.du * x0, v0 = f.v0 + f.dv * y0;
  const double s0 = (ax * u0 + ay * v0) + az;
  const double s1 = ax * (f.du * xk) + ay * (f.dv * yk);
  const DepthPlane plane = const_cast<Map&>(map).lines(LineFamily::kColumns).reference;
  const double w = plane.w0 + plane.wx * x0 + plane.wy * y0;
  const double wk = plane.wx * xk + plane.wy * yk;
  const double along = s.up.x * u0 + s.up.y * v0 + s.up.z;
  const auto sigma0 = static_cast<float>(s0 * scale), sigma1 = static_cast<float>(s1 * scale);
  const auto base0 = static_cast<float>((along - s.camera.distance_m * w) * scale);
  const auto base1 =
      static_cast<float>((s.up.x * f.du * xk + s.up.y * f.dv * yk - s.camera.distance_m * wk) * scale);
  const auto depth0 = static_cast<float>(w * scale), depth1 = static_cast<float>(wk * scale);
  const auto per_distance = static_cast<float>(1.0 / s.camera.distance_m);
  const auto per_blend = static_cast<float>(1.0 / s.blend_from_m);
  const double one = 1 << kDiscreteFraction;
  const auto fixed0 = static_cast<std::int32_t>(std::lrint((at_zero + 0.5) * one));
  const auto fixed1 = static_cast<std::int32_t>(std::lrint(per_line * one));

  Seen seen;
  seen.row = static_cast<int>(s.group.row[lane]);
  const int end = static_cast<int>(s.group.row_end[lane]);
  const int n = map.intervals();
  const bool is_up = is_x_major ? ny < 0 : nx > 0;
  for (int step = 0; step <= n && seen.row < end; ++step) {
    const int k = is_up ? step : n - step;
    const double position = at_zero + per_line * k;
    const auto line = static_cast<float>(k);
    if (position < -1e-6 || position > n + 1e-6 || !(s0 + s1 * k > 0)) continue;
    const std::int32_t fixed = fixed0 + fixed1 * k;
    const auto voxel = [&](int x, int y) { return is_x_major ? map.height(x, y) : map.height(y, x); };
    float height = voxel(k, std::clamp(fixed >> kDiscreteFraction, 0, n));
    const float sigma = sigma0 + sigma1 * line;
    const auto range_of = [&](float top) {
      const float rise = top + (base0 + base1 * line);
      return std::sqrt(sigma * sigma + rise * rise) / ((depth0 + depth1 * line) - top * per_distance);
    };
    if (s.blend_from_m > 0) {
      const int wide = ((fixed + (1 << (kDiscreteFraction - 1))) >> (kDiscreteFraction + 1)) * 2;
      const float wide_height = voxel(std::min((k + 1) / 2 * 2, n), std::clamp(wide, 0, n));
      const float weight = std::min(std::max(range_of(height) * per_blend - 1.0F, 0.0F), 1.0F);
      height = height + weight * (wide_height - height);
    }
    for (; seen.row < end; ++seen.row) {
      const float slope = slope_of(s, lane, seen.row);
      const float ray0 = base0 - slope * sigma0;
      const float ray1 = base1 - slope * sigma1;
      if (!(height + (ray0 + ray1 * line) >= 0)) break;
      seen.range_m.push_back(range_of(height));
    }
  }
  return seen;
}

// Returns what the walk shows of a column.
Seen walked(const Scene& s, int lane, int first_row) {
  Seen seen;
  seen.row = static_cast<int>(s.group.row[lane]);
  seen.range_m.resize(static_cast<std::size_t>(seen.row - first_row));
  float now = 0;
  for (int row = seen.row - 1; row >= first_row; --row) {
    const float start = s.group.start[row * kMaxLanes + lane];
    if (start != 0) now = start;
    seen.range_m[static_cast<std::size_t>(row - first_row)] = now;
  }
  return seen;
}

// Makes a camera over or beside the map and columns in neighbouring directions.
void make_scene(Random& random, RowKind kind, const Map& map, Scene& s) {
  const double size = random.log_uniform(1e-5, 1e-2);
  const int n = map.intervals();
  s.frame = {n, random.uniform(-0.5, 0.5), size / n, random.uniform(-0.5, 0.5), size / n};
  s.camera.radius_m = 1e6;
  const double height_m = random.log_uniform(1, 1e5);
  s.camera.distance_m = 1e6 + height_m;
  s.camera.ground_m = 1e6;
  const bool is_over = random.integer(0, 2) == 0;
  const double u = s.frame.u0 + size * (is_over ? random.uniform(0, 1) : random.uniform(-3, 4));
  const double v = s.frame.v0 + size * (is_over ? random.uniform(0, 1) : random.uniform(-3, 4));
  s.up = glm::normalize(glm::dvec3(u, v, 1));
  s.camera.up = s.up;
  constexpr int kRows = 200;
  const double lowest = -random.log_uniform(0.01, 10);
  const double step = -lowest * random.log_uniform(1e-3, 2e-2);
  s.rows.kind = kind;
  s.rows.count = kRows;
  s.rows.centre = -lowest / step;
  s.rows.step = step;
  s.table.clear();
  s.exact.clear();
  s.rows.first_elevation = std::atan(lowest);
  s.rows.elevation_step = (std::atan(0.3) - std::atan(lowest)) / kRows;
  for (int r = 0; r <= kRows; ++r) {
    s.exact.push_back(r < kRows ? std::tan(s.rows.first_elevation + r * s.rows.elevation_step)
                                : std::numeric_limits<double>::infinity());
    s.table.push_back(static_cast<float>(s.exact.back()));
  }
  s.rows.slope = s.table.data();
  s.rows.slope_exact = s.exact.data();
  s.buffers.assign(2 * kRows * kMaxLanes + 16, 0);
  auto at = reinterpret_cast<std::uintptr_t>(s.buffers.data());
  s.group.start = s.buffers.data() + ((64 - at % 64) % 64) / sizeof(float);
  s.group.gain = s.group.start + kRows * kMaxLanes;
  s.group.columns = column_lanes();
  const glm::dvec3 east = glm::normalize(glm::cross(glm::dvec3(0, 1, 0.1), s.up));
  const glm::dvec3 north = glm::cross(s.up, east);
  const double first = random.uniform(-3.2, 3.2);
  const double spread = random.log_uniform(1e-5, 0.3);
  for (int lane = 0; lane < kMaxLanes; ++lane) {
    const double angle = first + spread * lane;
    const glm::dvec3 a = std::cos(angle) * east + std::sin(angle) * north;
    const glm::dvec3 normal = glm::cross(a, s.up);
    for (int c = 0; c < 3; ++c) {
      s.group.azimuth[c][lane] = a[c];
      s.group.normal[c][lane] = normal[c];
    }
    s.group.sector_a0[lane] = lowest;
    s.group.sector_a1[lane] = step;
    s.group.sector_b0[lane] = 1 + 0.01 * lane;
    s.group.sector_b1[lane] = 1e-4;
    const bool is_used = lane < s.group.columns;
    s.group.row[lane] = is_used ? static_cast<float>(random.integer(0, 20)) : 0.0F;
    s.group.row_end[lane] = is_used ? static_cast<float>(random.integer(100, kRows)) : 0.0F;
    s.group.row_stop[lane] = kRows;
  }
}

// Follows the columns of many scenes, and compares each with the walk.
void compare_with_pseudo_code(RowKind kind) {
  Random random(961);
  std::int64_t rows = 0;
  std::int64_t columns_with_ground = 0;
  for (int n = 0; n < 300; ++n) {
    const int intervals = n % 7 == 0 ? 4 : (n % 3 == 0 ? 32 : 128);
    Map map(intervals, random, random.log_uniform(0.1, 3000));
    Scene scene;
    make_scene(random, kind, map, scene);
    if (n % 2 == 1) scene.blend_from_m = random.log_uniform(10, 1e5);
    std::vector<Seen> expected;
    std::vector<int> first_row;
    for (int lane = 0; lane < scene.group.columns; ++lane) {
      expected.push_back(follow(scene, map, lane));
      first_row.push_back(static_cast<int>(scene.group.row[lane]));
    }
    walk_grid_discretely(scene.frame, map, scene.camera, scene.up, scene.rows, scene.blend_from_m, scene.group);
    for (int lane = 0; lane < scene.group.columns; ++lane) {
      const auto k = static_cast<std::size_t>(lane);
      const Seen seen = walked(scene, lane, first_row[k]);
      ASSERT_EQ(seen.row, expected[k].row) << n << " " << lane;
      for (std::size_t r = 0; r < seen.range_m.size(); ++r)
        ASSERT_EQ(std::bit_cast<std::uint32_t>(seen.range_m[r]),
                  std::bit_cast<std::uint32_t>(expected[k].range_m[r]))
            << n << " " << lane << " " << r << ": " << seen.range_m[r] << " " << expected[k].range_m[r];
      rows += static_cast<std::int64_t>(seen.range_m.size());
      columns_with_ground += seen.range_m.empty() ? 0 : 1;
    }
  }
  EXPECT_GT(rows, 1200 * column_lanes());
  EXPECT_GT(columns_with_ground, 30 * column_lanes());
}

class DiscreteWalk : public testing::TestWithParam<RowKind> {
 protected:
  ~DiscreteWalk() override { use(0); }
  // Uses the instruction sets of a mask; 0: all that there are.
  static void use(std::int64_t targets) {
    hwy::SetSupportedTargetsForTest(targets);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
  }
};

TEST_P(DiscreteWalk, IsThePseudoCodeOf1996BitForBit) {
  std::string last;
  for (std::int64_t targets = hwy::SupportedTargets(); targets != 0; targets &= targets - 1) {
    use(targets);
    if (std::string_view(column_target()) == last) continue;
    last = column_target();
    SCOPED_TRACE(last);
    compare_with_pseudo_code(GetParam());
    if (HasFatalFailure()) return;
  }
}

INSTANTIATE_TEST_SUITE_P(Rows, DiscreteWalk,
                         testing::Values(RowKind::kEven, RowKind::kTable, RowKind::kSector));

}  // namespace
