#include <algorithm>
#include <array>
#include <vector>

#include "mars/embedded/embedded.h"
#include "mars/embedded/math.h"
#include "mars/embedded/troughs.h"

namespace mars {

namespace {

using embedded::chord2;
using embedded::kRadius_m;
using embedded::place;

constexpr std::array<LonLat, 11> kDemoPath{{{297.7 - 360.0, -13.20},
                                            {296.8 - 360.0, -12.78},
                                            {295.8 - 360.0, -12.86},
                                            {294.8 - 360.0, -12.38},
                                            {293.8 - 360.0, -12.38},
                                            {292.8 - 360.0, -11.86},
                                            {291.7 - 360.0, -11.80},
                                            {290.6 - 360.0, -11.10},
                                            {289.4 - 360.0, -11.25},
                                            {288.2 - 360.0, -10.45},
                                            {287.0 - 360.0, -10.60}}};

struct Disc {
  glm::dvec3 centre;  // unit
  double radius;      // chord
};

// Adds discs along a line, `step_m` apart. A region is a union of discs.
void add_line(const glm::dvec3& a, const glm::dvec3& b, double radius_a_m, double radius_b_m, double step_m,
              std::vector<Disc>& discs) {
  const double length_m = std::sqrt(chord2(a, b)) * kRadius_m;
  const int steps = static_cast<int>(length_m / step_m) + 1;
  for (int i = 0; i <= steps; ++i) {
    const double t = static_cast<double>(i) / steps;
    const glm::dvec3 p = a + (b - a) * t;
    const double size = std::sqrt(p.x * p.x + p.y * p.y + p.z * p.z);
    discs.push_back({p / size, embedded::mix(radius_a_m, radius_b_m, t) / kRadius_m});
  }
}

std::vector<Disc> make_landmarks() {
  constexpr double kMargin_m = 3e3;
  // Olympus Mons; Gale; Jezero with its valleys
  std::vector<Disc> discs{{place(226.20, 18.65), 310e3 / kRadius_m},
                          {place(137.81, -5.37), 95e3 / kRadius_m},
                          {place(77.4, 18.4), 55e3 / kRadius_m}};
  for (const embedded::TroughPiece& p : embedded::valles_pieces()) {
    add_line(p.a, p.b, p.half_width_a_km * 1000.0 + kMargin_m, p.half_width_b_km * 1000.0 + kMargin_m, 15e3,
             discs);
  }
  return discs;
}

std::vector<Disc> make_demo() {
  // Discs a little larger than the corridor cover it completely when they are this close together.
  constexpr double kStep_m = 3000.0;
  constexpr double kDisc_m = 12100.0;
  static_assert(kDisc_m * kDisc_m > kDemoHalfWidth_m * kDemoHalfWidth_m + kStep_m * kStep_m / 4.0);
  std::vector<Disc> discs;
  for (std::size_t i = 1; i < kDemoPath.size(); ++i) {
    add_line(place(kDemoPath[i - 1].lon_deg, kDemoPath[i - 1].lat_deg),
             place(kDemoPath[i].lon_deg, kDemoPath[i].lat_deg), kDisc_m, kDisc_m, kStep_m, discs);
  }
  return discs;
}

// Returns true if a disc may touch the cap. Chords are shorter than arcs, so the test is conservative.
bool touches(const std::vector<Disc>& discs, const Cap& cap) {
  return std::any_of(discs.begin(), discs.end(), [&cap](const Disc& d) {
    const double limit = d.radius + cap.radius_rad;
    return chord2(d.centre, cap.centre) <= limit * limit;
  });
}

}  // namespace

std::span<const LonLat> demo_path() { return kDemoPath; }

double embedded_spacing_in(const Cap& cap, const EmbeddedSpacings& spacings) {
  static const std::vector<Disc> demo = make_demo();
  static const std::vector<Disc> landmarks = make_landmarks();
  if (touches(demo, cap)) return spacings.demo_m;
  if (touches(landmarks, cap)) return spacings.landmark_m;
  return spacings.plain_m;
}

}  // namespace mars
