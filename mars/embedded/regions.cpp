#include "mars/embedded/regions.h"

#include <algorithm>
#include <array>
#include <vector>

#include "mars/embedded/embedded.h"
#include "mars/embedded/math.h"

namespace mars {

namespace {

using embedded::chord2;
using embedded::kRadius_m;
using embedded::place;

constexpr std::array<LonLat, 11> kDemoPath{{{-62.3, -12.78},
                                            {-63.0, -12.62},
                                            {-64.0, -12.36},
                                            {-65.0, -12.06},
                                            {-66.0, -11.95},
                                            {-67.0, -11.75},
                                            {-68.0, -11.45},
                                            {-69.0, -11.28},
                                            {-70.2, -11.20},
                                            {-71.4, -10.75},
                                            {-72.6, -10.20}}};

struct Disc {
  glm::dvec3 centre;  // unit
  double radius;      // chord
};

// Adds discs along the path, which cover all within half_width_m of it.
void add_path(double half_width_m, std::vector<Disc>& discs) {
  const double disc_m = 1.01 * half_width_m;
  const double step_m = 0.25 * half_width_m;
  for (std::size_t i = 1; i < kDemoPath.size(); ++i) {
    const glm::dvec3 a = place(kDemoPath[i - 1].lon_deg, kDemoPath[i - 1].lat_deg);
    const glm::dvec3 b = place(kDemoPath[i].lon_deg, kDemoPath[i].lat_deg);
    const int steps = static_cast<int>(std::sqrt(chord2(a, b)) * kRadius_m / step_m) + 1;
    for (int k = 0; k <= steps; ++k) {
      const glm::dvec3 p = a + (b - a) * (static_cast<double>(k) / steps);
      const double size = std::sqrt(p.x * p.x + p.y * p.y + p.z * p.z);
      discs.push_back({p / size, disc_m / kRadius_m});
    }
  }
}

std::vector<Disc> make_demo() {
  std::vector<Disc> discs;
  add_path(kDemoHalfWidth_m, discs);
  return discs;
}

std::vector<Disc> make_landmarks() {
  std::vector<Disc> discs{{place(137.6, -5.3), 85e3 / kRadius_m},  // Gale
                          {place(77.4, 18.4), 45e3 / kRadius_m}};  // Jezero
  add_path(45e3, discs);
  return discs;
}

std::vector<Disc> make_broad() {
  // Olympus Mons, Noctis Labyrinthus, and Valles Marineris from west to east.
  std::vector<Disc> discs{{place(226.20, 18.65), 320e3 / kRadius_m}, {place(262.0, -7.5), 260e3 / kRadius_m},
                          {place(270.0, -7.0), 260e3 / kRadius_m},   {place(280.0, -7.5), 330e3 / kRadius_m},
                          {place(290.0, -9.5), 360e3 / kRadius_m},   {place(299.0, -12.0), 330e3 / kRadius_m},
                          {place(307.0, -12.5), 300e3 / kRadius_m}};
  add_path(150e3, discs);
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

EmbeddedRegion embedded_region_in(const Cap& cap) {
  static const std::vector<Disc> demo = make_demo();
  static const std::vector<Disc> landmarks = make_landmarks();
  static const std::vector<Disc> broad = make_broad();
  if (touches(demo, cap)) return EmbeddedRegion::kDemo;
  if (touches(landmarks, cap)) return EmbeddedRegion::kLandmark;
  return touches(broad, cap) ? EmbeddedRegion::kBroad : EmbeddedRegion::kPlain;
}

}  // namespace mars
