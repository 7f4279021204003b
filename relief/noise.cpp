#include "relief/noise.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "relief/interval_math.h"

namespace relief {

namespace {

constexpr double kSqrt2 = 1.4142135623730950488;
constexpr double kMostWavelengths = 1e15;

// Directions at multiples of 22.5 degrees.
constexpr double kC1 = 0.92387953251128675613;
constexpr double kC2 = 0.70710678118654752440;
constexpr double kC3 = 0.38268343236508977173;
constexpr std::array<std::array<double, 2>, 16> kDirections{{{1, 0},
                                                             {kC1, kC3},
                                                             {kC2, kC2},
                                                             {kC3, kC1},
                                                             {0, 1},
                                                             {-kC3, kC1},
                                                             {-kC2, kC2},
                                                             {-kC1, kC3},
                                                             {-1, 0},
                                                             {-kC1, -kC3},
                                                             {-kC2, -kC2},
                                                             {-kC3, -kC1},
                                                             {0, -1},
                                                             {kC3, -kC1},
                                                             {kC2, -kC2},
                                                             {kC1, -kC3}}};

// Mixes bits (finaliser of splitmix64).
std::uint64_t mixed(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15ULL;
  x = (x ^ (x >> 30U)) * 0xbf58476d1ce4e5b9ULL;
  x = (x ^ (x >> 27U)) * 0x94d049bb133111ebULL;
  return x ^ (x >> 31U);
}

double fade(double t) { return t * t * t * (t * (t * 6 - 15) + 10); }
double fade_slope(double t) { return 30 * t * t * (1 - t) * (1 - t); }

struct NoiseValue {
  double value = 0;
  glm::dvec2 gradient{0, 0};
};

// Returns gradient noise within [-1, 1] of cells of size 1.
NoiseValue noise_at(std::uint64_t seed, double u, double v) {
  if (!(std::abs(u) <= kMostWavelengths && std::abs(v) <= kMostWavelengths)) return {};
  const double cell_u = std::floor(u);
  const double cell_v = std::floor(v);
  const double a = u - cell_u;
  const double b = v - cell_v;
  const auto i = static_cast<std::uint64_t>(static_cast<std::int64_t>(cell_u));
  const auto j = static_cast<std::uint64_t>(static_cast<std::int64_t>(cell_v));
  std::array<double, 4> value{};
  std::array<const double*, 4> slope{};
  for (std::size_t corner = 0; corner < 4; ++corner) {
    const std::size_t right = corner & 1U;
    const std::size_t upper = corner >> 1U;
    const std::uint64_t hash = mixed(mixed(seed ^ (i + right)) ^ (j + upper));
    slope[corner] = kDirections[hash >> 60U].data();
    value[corner] = slope[corner][0] * (a - static_cast<double>(right)) +
                    slope[corner][1] * (b - static_cast<double>(upper));
  }
  const double s = fade(a);
  const double t = fade(b);
  const double low = value[0] + s * (value[1] - value[0]);
  const double high = value[2] + s * (value[3] - value[2]);
  NoiseValue out;
  out.value = kSqrt2 * (low + t * (high - low));
  for (int axis = 0; axis < 2; ++axis) {
    const double low_slope = slope[0][axis] + s * (slope[1][axis] - slope[0][axis]);
    const double high_slope = slope[2][axis] + s * (slope[3][axis] - slope[2][axis]);
    out.gradient[axis] = low_slope + t * (high_slope - low_slope);
  }
  out.gradient.x += fade_slope(a) * (value[1] - value[0] + t * (value[3] - value[2] - value[1] + value[0]));
  out.gradient.y += fade_slope(b) * (high - low);
  out.gradient *= kSqrt2;
  return out;
}

}  // namespace

NoiseShape::NoiseShape(const NoiseSize& size) {
  double sum = 0;
  double amplitude = 1;
  for (int n = 0; n < size.octaves; ++n, amplitude *= size.gain) sum += amplitude;
  amplitude = size.amplitude_m / sum;
  double wavelength_m = size.wavelength_m;
  std::uint64_t seed = mixed(size.seed);
  for (int n = 0; n < size.octaves; ++n) {
    seed = mixed(seed);
    const auto part = [seed](unsigned shift) {
      return static_cast<double>((seed >> shift) & 0xffffffU) / 0x1000000;
    };
    octaves_.push_back({amplitude, wavelength_m, seed, {part(0), part(24)}});
    amplitude *= size.gain;
    wavelength_m /= 2;
  }
}

Rect NoiseShape::support() const { return whole_plane(); }

double NoiseShape::height_m(double x_m, double y_m) const {
  double sum_m = 0;
  for (const Octave& o : octaves_) {
    sum_m += o.amplitude_m *
             noise_at(o.seed, x_m / o.wavelength_m + o.offset.x, y_m / o.wavelength_m + o.offset.y).value;
  }
  return sum_m;
}

glm::dvec2 NoiseShape::gradient(double x_m, double y_m) const {
  glm::dvec2 sum(0, 0);
  for (const Octave& o : octaves_) {
    sum += (o.amplitude_m / o.wavelength_m) *
           noise_at(o.seed, x_m / o.wavelength_m + o.offset.x, y_m / o.wavelength_m + o.offset.y).gradient;
  }
  return sum;
}

Interval NoiseShape::bounds_m(const Rect& rect) const {
  const double half_x_m = rect.x1_m / 2 - rect.x0_m / 2;
  const double half_y_m = rect.y1_m / 2 - rect.y0_m / 2;
  const bool is_finite = half_x_m + half_y_m < std::numeric_limits<double>::infinity();
  const double x_m = is_finite ? rect.x0_m + half_x_m : 0;
  const double y_m = is_finite ? rect.y0_m + half_y_m : 0;
  Interval all{0, 0};
  for (const Octave& o : octaves_) {
    Interval own{-1, 1};
    if (is_finite) {
      const double u = x_m / o.wavelength_m + o.offset.x;
      const double v = y_m / o.wavelength_m + o.offset.y;
      const NoiseValue centre = noise_at(o.seed, u, v);
      const double half_u = half_x_m / o.wavelength_m;
      const double half_v = half_y_m / o.wavelength_m;
      const double half = half_u + half_v;
      const double tangent = std::abs(centre.gradient.x) * half_u + std::abs(centre.gradient.y) * half_v;
      const double away = std::min(kNoiseSlope * half, tangent + kNoiseCurvature / 2 * half * half) +
                          kRounding * (1 + std::abs(u) + std::abs(v));
      own = {std::max(-1.0, centre.value - away), std::min(1.0, centre.value + away)};
    }
    all = sum(all, {own.low * o.amplitude_m, own.high * o.amplitude_m});
  }
  double amplitude_m = 0;
  for (const Octave& o : octaves_) amplitude_m += o.amplitude_m;
  return widened(all, kRounding * amplitude_m);
}

}  // namespace relief
