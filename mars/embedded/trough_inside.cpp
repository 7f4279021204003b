#include <algorithm>
#include <array>
#include <vector>

#include "mars/embedded/block.h"
#include "mars/embedded/math.h"
#include "mars/embedded/troughs.h"

namespace mars::embedded {

namespace {

constexpr double kJoin_m = 18e3;
constexpr double kMargin_m = 45e3;

// Holds the distances of the posts to one piece.
struct PieceDistances {
  const TroughPiece* piece = nullptr;
  Lane<double> depth_m, half_km, floor_m, gx, gy, gz, across_m;
};

// Fills `out` for out.piece.
void measure(const Block& block, PieceDistances& out) {
  const TroughPiece& p = *out.piece;
  const glm::dvec3 ab = p.b - p.a;
  const double length2 = ab.x * ab.x + ab.y * ab.y + ab.z * ab.z;
  const glm::dvec3 normal{p.a.y * p.b.z - p.a.z * p.b.y, p.a.z * p.b.x - p.a.x * p.b.z,
                          p.a.x * p.b.y - p.a.y * p.b.x};
  const glm::dvec3 side = normal * (-kRadius_m / std::sqrt(chord2(normal, {0, 0, 0})));
  with_simd(block.simd, [&] {
    for (std::size_t i = 0; i < block.padded; ++i) {
      const double hx = block.x[i], hy = block.y[i], hz = block.z[i];
      const double t = clamp01(((hx - p.a.x) * ab.x + (hy - p.a.y) * ab.y + (hz - p.a.z) * ab.z) / length2);
      // Near the piece distances are measured along the ground, i.e. without the radial part of the offset.
      const double vx = p.a.x + t * ab.x - hx, vy = p.a.y + t * ab.y - hy, vz = p.a.z + t * ab.z - hz;
      const double radial = vx * hx + vy * hy + vz * hz;
      const double up = (radial < 0.0 ? -radial : radial) < 0.01 ? radial : 0.0;
      const double lx = vx - up * hx, ly = vy - up * hy, lz = vz - up * hz;
      const double distance = std::sqrt(lx * lx + ly * ly + lz * lz) + 1e-12;
      out.half_km[i] = mix(p.half_width_a_km, p.half_width_b_km, t);
      out.depth_m[i] = out.half_km[i] * 1000.0 - distance * kRadius_m;
      out.floor_m[i] = mix(p.floor_a_m, p.floor_b_m, t);
      out.gx[i] = lx / distance;
      out.gy[i] = ly / distance;
      out.gz[i] = lz / distance;
      out.across_m[i] = hx * side.x + hy * side.y + hz * side.z;
    }
  });
}

// Returns the depth inside a piece at one place.
double depth_at(const glm::dvec3& here, const TroughPiece& p) {
  const glm::dvec3 ab = p.b - p.a;
  const glm::dvec3 ap = here - p.a;
  const double t = clamp01((ap.x * ab.x + ap.y * ab.y + ap.z * ab.z) / chord2(p.a, p.b));
  const glm::dvec3 v = p.a + ab * t - here;
  const double radial = v.x * here.x + v.y * here.y + v.z * here.z;
  const double level2 = chord2(v, {0, 0, 0}) - (std::abs(radial) < 0.01 ? radial * radial : 0.0);
  return mix(p.half_width_a_km, p.half_width_b_km, t) * 1000.0 - std::sqrt(std::max(0.0, level2)) * kRadius_m;
}

}  // namespace

bool find_inside(const Block& block, std::span<const TroughPiece> pieces, Inside& out) {
  // A piece contributes only within kJoin_m of the deepest one; bounds over a small block exclude the others.
  const double size = std::sqrt(chord2(block.centre, {0, 0, 0}));
  const glm::dvec3 middle = block.reach < 0.02 ? block.centre / size : block.at(0);
  const double reach_m = block.reach < 0.02 ? (block.reach + 1.0 - size) * kRadius_m : 1e12;
  struct Close {
    const TroughPiece* piece;
    double most_m;
  };
  std::array<Close, kMostPieces> close;
  std::size_t close_count = 0;
  double least_m = -1e9;
  for (const TroughPiece& p : pieces) {
    const double length = std::sqrt(chord2(p.a, p.b));
    const double wide = std::max(p.half_width_a_km, p.half_width_b_km) * 1000.0 + kMargin_m + kJoin_m;
    if (!block.near((p.a + p.b) * 0.5, 0.5 * length + wide / kRadius_m)) continue;
    const double taper = std::abs(p.half_width_a_km - p.half_width_b_km) * 1000.0 / (length * kRadius_m);
    const double depth_m = depth_at(middle, p);
    const double change_m = 1.2 * (1.0 + taper) * reach_m + 10.0;
    close[close_count++] = {&p, depth_m + change_m};
    least_m = std::max(least_m, depth_m - change_m);
  }
  static thread_local std::vector<PieceDistances> near(kMostPieces);
  std::size_t n = 0;
  bool inside = false;
  for (std::size_t k = 0; k < close_count; ++k) {
    if (close[k].most_m < least_m - kJoin_m) continue;
    inside = inside || close[k].most_m > -kMargin_m;
    near[n++].piece = close[k].piece;
  }
  if (!inside) return false;
  for (std::size_t k = 0; k < n; ++k) measure(block, near[k]);

  Lane<double> deepest, sum{}, half{};
  deepest.fill(-1e9);
  out = {};
  with_simd(block.simd, [&] {
    for (std::size_t k = 0; k < n; ++k) {
      for (std::size_t i = 0; i < block.padded; ++i) deepest[i] = std::max(deepest[i], near[k].depth_m[i]);
    }
    for (std::size_t k = 0; k < n; ++k) {
      const PieceDistances& s = near[k];
      for (std::size_t i = 0; i < block.padded; ++i) {
        const double w = std::max(0.0, 1.0 - (deepest[i] - s.depth_m[i]) / kJoin_m);
        const double ww = w * w;
        sum[i] += ww;
        out.depth_m[i] += ww * s.depth_m[i];
        half[i] += ww * s.half_km[i] * 1000.0;
        out.floor_m[i] += ww * s.floor_m[i];
        out.gx[i] += ww * s.gx[i];
        out.gy[i] += ww * s.gy[i];
        out.gz[i] += ww * s.gz[i];
        out.across_m[i] += ww * s.across_m[i];
      }
    }
    for (std::size_t i = 0; i < block.padded; ++i) {
      out.depth_m[i] /= sum[i];
      out.floor_m[i] /= sum[i];
      out.to_axis_m[i] = half[i] / sum[i] - out.depth_m[i];
      out.gx[i] /= sum[i];
      out.gy[i] /= sum[i];
      out.gz[i] /= sum[i];
      out.across_m[i] /= sum[i];
    }
  });
  return std::any_of(out.depth_m.begin(), out.depth_m.begin() + static_cast<std::ptrdiff_t>(block.padded),
                     [](double d) { return d > -kMargin_m; });
}

}  // namespace mars::embedded
