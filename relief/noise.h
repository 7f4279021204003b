// Seeded gradient noise in octaves.
//
// Octave k has the wavelength wavelength_m / 2^k and an amplitude in the ratio gain^k; the amplitudes sum up to amplitude_m.
// Each is gradient noise (Perlin 2002, Improving noise, ACM Trans. Graph. 21(3), 681-682: quintic fade) of unit gradients in
// 16 directions, hashed from seed, octave and cell. The noise has the same bits on every machine.
//
// Bounds: an octave stays within its amplitude, and its derivatives within kNoiseSlope and kNoiseCurvature. Over a
// rectangle it differs from its value at the centre by at most the slope times half of both sides, and by at most what
// the gradient at the centre and half of the curvature times the square of these make.
#pragma once

#include <cstdint>
#include <vector>

#include "relief/shape.h"

namespace relief {

// Bounds each derivative of an octave of amplitude 1 and wavelength 1. Of the four corners' products those derivatives
// that come from the fade are at most 15/8 sqrt(2), those from the gradients 1; sqrt(2) is the scale to amplitude 1.
inline constexpr double kNoiseSlope = 5.2;

// Bounds each second derivative of such an octave: 10 / sqrt(3) is the largest second derivative of the fade, and the
// corners' distances sum up to at most 1.62 a row.
inline constexpr double kNoiseCurvature = 25;

struct NoiseSize {
  double amplitude_m = 0;   // bounds the absolute height; 0 or more
  double wavelength_m = 1;  // of the coarsest octave; above 0
  int octaves = 4;          // 1 or more
  double gain = 0.5;        // 0 to 1
  std::uint32_t seed = 1;
};

// Its support is the plane. It is 0 at places more than 1e15 wavelengths away.
class NoiseShape final : public Shape {
 public:
  explicit NoiseShape(const NoiseSize& size);

  Rect support() const override;
  double height_m(double x_m, double y_m) const override;
  glm::dvec2 gradient(double x_m, double y_m) const override;
  Interval bounds_m(const Rect& rect) const override;

 private:
  struct Octave {
    double amplitude_m;
    double wavelength_m;
    std::uint64_t seed;
    glm::dvec2 offset;  // in wavelengths, so that the cells of octaves have no common corners
  };
  std::vector<Octave> octaves_;
};

}  // namespace relief
