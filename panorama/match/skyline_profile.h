// The skyline of a viewpoint as a function of azimuth, for the full circle.
#pragma once

#include <cstddef>
#include <vector>

namespace panorama {

// Holds elevations at equal steps of azimuth, linear between them. Immutable: may be read from any thread. With
// steps of s degrees the error between samples is at most that of a line through the skyline's own points; a
// skyline with a step (a cliff) has it within one sample.
class SkylineProfile {
 public:
  static constexpr std::size_t kLeastSamples = 8;

  // Takes elevations in degrees, the first of azimuth 0 (north), clockwise. Throws std::invalid_argument for less
  // than kLeastSamples, and for numbers that are not finite.
  explicit SkylineProfile(std::vector<double> elevations_deg);

  // Returns the elevation at any azimuth in degrees.
  double elevation_deg(double azimuth_deg) const;
  // Returns degrees of elevation to one of azimuth, over half_width_deg to both sides.
  double slope(double azimuth_deg, double half_width_deg) const;
  double step_deg() const { return step_deg_; }

  // Returns samples azimuths of a profile, in its order.
  static std::vector<double> azimuths_deg(std::size_t samples);

 private:
  std::vector<double> elevations_deg_;
  double step_deg_;
};

}  // namespace panorama
