#include "mars/geodesy/angles.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "mars/geodesy/sphere.h"

namespace mars {

namespace {

constexpr std::size_t kPart = 64;
using Part = std::array<double, kPart>;

constexpr double kQuarterTurn = std::numbers::pi / 2;
constexpr double kQuarterTurnRest = 6.123233995736766e-17;  // pi / 2 beyond its double
constexpr double kThreeEighths = 3 * (std::numbers::pi / 4);
constexpr double kThreeEighthsRest = 9.184850993605148e-17;

// Returns atan2(y, x) without branches, so that a loop over it becomes vectors. The quotient of both is reduced to at most
// 0.66 of the octant; the rational function is that of Cephes' atan (Moshier 1984).
[[gnu::always_inline]] inline double angle(double y, double x) {
  const double ax = std::abs(x);
  const double ay = std::abs(y);
  const bool is_steep = ay > ax;
  const double less = is_steep ? ax : ay;
  const double more = is_steep ? ay : ax;
  const bool is_near_diagonal = less > 0.66 * more;
  const double up = is_near_diagonal ? less - more : less;
  const double along = is_near_diagonal ? less + more : more;
  const double t = up / (along == 0 ? 1.0 : along);
  const double z = t * t;
  const double p =
      (((-8.750608600031904122785e-1 * z - 1.615753718733365076637e1) * z - 7.500855792314704667340e1) * z -
       1.228866684490136173410e2) *
          z -
      6.485021904942025371773e1;
  const double q =
      ((((z + 2.485846490142306297962e1) * z + 1.650270098316988542046e2) * z + 4.328810604912902668951e2) * z +
       4.853903996359136964868e2) *
          z +
      1.945506571482613964425e2;
  const double rest = t * (z * p / q);
  // The angle is a multiple of an eighth of a turn, plus or minus the arc of t.
  const bool is_west = std::copysign(1.0, x) < 0;
  const double sign = is_steep != is_west ? -1.0 : 1.0;
  const double whole = is_steep ? kQuarterTurn : is_west ? 2 * kQuarterTurn : 0.0;
  const double whole_rest = is_steep ? kQuarterTurnRest : is_west ? 2 * kQuarterTurnRest : 0.0;
  const double near = is_west ? kThreeEighths : kQuarterTurn / 2;
  const double near_rest = is_west ? kThreeEighthsRest : kQuarterTurnRest / 2;
  const double base = is_near_diagonal ? near : whole;
  const double base_rest = is_near_diagonal ? near_rest : whole_rest;
  return std::copysign(base + (sign * t + (sign * rest + base_rest)), y);
}

struct Parts {
  Part x, y, z, lon, lat;
};

[[gnu::always_inline]] inline void fill_angles(Parts& p, double scale) {
  for (std::size_t i = 0; i < kPart; ++i) {
    const double horizontal = std::sqrt(p.x[i] * p.x[i] + p.y[i] * p.y[i]);
    p.lon[i] = angle(p.y[i], p.x[i]) / kRadiansPerDegree;
    p.lat[i] = angle(p.z[i], horizontal * scale) / kRadiansPerDegree;
  }
}

void fill_angles_plain(Parts& p, double scale) { fill_angles(p, scale); }

// The same code for wider registers. No products are fused with sums, so both give the same bits.
#if defined(__x86_64__) && defined(__GNUC__)
[[gnu::target("avx2")]] void fill_angles_avx2(Parts& p, double scale) { fill_angles(p, scale); }
bool has_avx2() { return __builtin_cpu_supports("avx2") != 0; }
#else
void fill_angles_avx2(Parts& p, double scale) { fill_angles(p, scale); }
bool has_avx2() { return false; }
#endif

using Fill = void (*)(Parts&, double);

void fill_all(Fill fill, std::span<const glm::dvec3> directions, double scale,
              std::span<glm::dvec2> angles_deg) {
  Parts p{};
  for (std::size_t start = 0; start < directions.size(); start += kPart) {
    const std::size_t count = std::min(kPart, directions.size() - start);
    for (std::size_t i = 0; i < count; ++i) {
      const glm::dvec3& d = directions[start + i];
      p.x[i] = d.x;
      p.y[i] = d.y;
      p.z[i] = d.z;
    }
    fill(p, scale);
    for (std::size_t i = 0; i < count; ++i) angles_deg[start + i] = {p.lon[i], p.lat[i]};
  }
}

}  // namespace

void lon_lat_deg(std::span<const glm::dvec3> directions, double scale, std::span<glm::dvec2> angles_deg) {
  fill_all(has_avx2() ? fill_angles_avx2 : fill_angles_plain, directions, scale, angles_deg);
}

void lon_lat_deg_plain(std::span<const glm::dvec3> directions, double scale, std::span<glm::dvec2> angles_deg) {
  fill_all(fill_angles_plain, directions, scale, angles_deg);
}

}  // namespace mars
