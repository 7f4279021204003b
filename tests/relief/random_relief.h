// Random reliefs of every kind.
#pragma once

#include <string>
#include <vector>

#include "relief/spec.h"
#include "tests/support/support.h"

namespace relief {

inline constexpr ReliefKind kEveryKind[] = {ReliefKind::kCrater, ReliefKind::kRamp, ReliefKind::kPad,
                                            ReliefKind::kTrench, ReliefKind::kDune, ReliefKind::kDam,
                                            ReliefKind::kFlood,  ReliefKind::kNoise};

// Returns the corners of a star round a place, up to about `size_deg` away. Its border may cross itself.
inline std::vector<mars::LonLat> random_polygon(test_support::Random& random, mars::LonLat place,
                                                double size_deg) {
  std::vector<mars::LonLat> corners;
  const int count = random.integer(3, 9);
  for (int n = 0; n < count; ++n) {
    const double bearing_deg = 360.0 * n / count + random.uniform(-50, 50);
    corners.push_back(
        mars::destination(place, bearing_deg, size_deg * random.uniform(0.2, 1) * mars::kRadiansPerDegree));
  }
  return corners;
}

// Returns a relief of some metres to some hundred kilometres that has no problem_of(). Each key that it may leave out is
// given or not.
inline ReliefSpec random_relief(test_support::Random& random, ReliefKind kind) {
  ReliefSpec spec;
  spec.kind = kind;
  spec.place = {random.uniform(-180, 180), random.integer(0, 9) == 0 ? 90.0 : random.uniform(-90, 90)};
  spec.azimuth_deg = random.uniform(-360, 360);
  if (random.integer(0, 2) == 0) spec.strength = random.uniform(0, 1);
  const double size_m = random.log_uniform(1, 1e5);
  const auto maybe = [&](std::optional<double>& member, double low, double high) {
    if (random.integer(0, 1) == 0) member = random.uniform(low, high);
  };
  const auto area = [&] {
    if (random.integer(0, 1) == 0) {
      spec.radius_m = size_m;
    } else {
      spec.length_m = size_m;
      maybe(spec.width_m, 0.1 * size_m, 3 * size_m);
    }
    maybe(spec.falloff_m, 0.05 * size_m, size_m);
  };
  switch (kind) {
    case ReliefKind::kCrater:
      spec.radius_m = size_m;
      maybe(spec.depth_m, 0, 0.5 * size_m);
      maybe(spec.rim_m, 0, 0.2 * size_m);
      maybe(spec.floor_ratio, 0, 0.9);
      maybe(spec.peak_m, 0, 0.1 * size_m);
      spec.ejecta_ratio = random.uniform(1.1, 8);
      break;
    case ReliefKind::kRamp:
      spec.length_m = size_m;
      spec.width_m = size_m * random.uniform(0.1, 1);
      spec.start_m = random.uniform(-0.1, 0.1) * size_m;
      spec.end_m = random.uniform(-0.1, 0.1) * size_m;
      maybe(spec.falloff_m, 0.05 * size_m, size_m);
      break;
    case ReliefKind::kPad: area(); break;
    case ReliefKind::kTrench:
      spec.length_m = size_m;
      spec.width_m = size_m * random.uniform(0.1, 1);
      spec.depth_m = size_m * random.uniform(0, 0.5);
      maybe(spec.slope_deg, 5, 89);
      break;
    case ReliefKind::kDune:
      spec.height_m = size_m / 10;
      spec.form = random.integer(0, 1) == 0 ? DuneForm::kBarchan : DuneForm::kTransverse;
      maybe(spec.width_m, 0.1 * size_m, 3 * size_m);
      maybe(spec.stoss_m, 0.1 * size_m, 3 * size_m);
      maybe(spec.horn_m, 0, size_m);
      maybe(spec.slope_deg, 5, 80);
      break;
    case ReliefKind::kDam:
      spec.length_m = size_m;
      spec.height_m = size_m * random.uniform(0, 0.3);
      maybe(spec.width_m, 0.01 * size_m, size_m);
      maybe(spec.foundation_m, 0, 0.3 * size_m);
      maybe(spec.slope_deg, 5, 80);
      maybe(spec.falloff_m, 0.05 * size_m, size_m);
      break;
    case ReliefKind::kFlood:
      if (random.integer(0, 1) == 0) {
        spec.radius_m = size_m;
      } else {
        spec.polygon = random_polygon(random, spec.place, size_m / 6e4);
      }
      maybe(spec.falloff_m, 0.05 * size_m, size_m);
      break;
    case ReliefKind::kNoise:
      area();
      spec.amplitude_m = size_m / 20;
      spec.wavelength_m = size_m * random.uniform(0.02, 2);
      spec.octaves = random.integer(1, 8);
      spec.gain = random.uniform(0, 1);
      spec.seed = random.integer(0, 1000000);
      break;
  }
  constexpr Mode kModes[] = {Mode::kAdd, Mode::kReplace, Mode::kMax, Mode::kMin};
  if (random.integer(0, 1) == 0) spec.mode = kModes[random.integer(0, 3)];
  if (spec.mode.value_or(usual_mode(kind)) != Mode::kAdd) {
    maybe(spec.level_m, -4000, 4000);
    if (random.integer(0, 1) == 0) spec.rise_m = random.uniform(-0.1, 0.1) * size_m;
  }
  maybe(spec.spacing_m, 0.1, 100);
  return spec;
}

}  // namespace relief
