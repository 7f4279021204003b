// Places, views and timing for the benchmarks of culling.
#pragma once

#include <algorithm>
#include <chrono>
#include <string>
#include <vector>

#include "mars/geodesy/pose.h"
#include "paging/surface/surface.h"
#include "vpe/base/quantile.h"
#include "vpe/core/view.h"

namespace bench {

using Clock = std::chrono::steady_clock;

struct Place {
  std::string name;
  double lon, lat, height_m, pitch_deg;
};

// Returns places on the embedded Mars.
inline std::vector<Place> culling_places() {
  return {{"canyon", -72.0, -12.5, 100, 0},    {"canyon", -72.0, -12.5, 2, 0},
          {"crater", 137.4, -5.0, 100, 0},     {"crater", 137.4, -5.0, 2, 0},
          {"plain", 118.0, 48.0, 100, 0},      {"volcano", -133.8, 18.6, 1000, -10},
          {"flight", -74.0, -13.5, 8000, -15}, {"orbit", -72.0, -12.5, 400000, -30}};
}

// Returns view n of `count` around a place.
inline vpe::core::View view_at(const Place& place, const paging::Surface& surface, int n, int count) {
  vpe::core::View view;
  view.width = 1280;
  view.height = 720;
  view.fov_deg = 60;
  const double ground = surface.at(mars::direction({place.lon, place.lat})).height_m;
  view.camera =
      mars::to_camera({place.lon, place.lat, ground + place.height_m, 360.0 * n / count, place.pitch_deg, 0},
                      surface.planet_radius_m());
  return view;
}

inline double ms_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

// Returns the median time of a number of rounds.
template <class Work>
double median_ms(Work&& work, int rounds = 7) {
  std::vector<double> times;
  for (int round = 0; round < rounds; ++round) {
    const auto start = Clock::now();
    work();
    times.push_back(ms_since(start));
  }
  return vpe::base::median_upper(times);
}

}  // namespace bench
