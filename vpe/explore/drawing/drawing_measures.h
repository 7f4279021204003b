// Measures drawings: lengths and areas on the planet's sphere and on the reference surface.
#pragma once

#include <functional>
#include <optional>
#include <stop_token>
#include <string>

#include "paging/surface/surface.h"
#include "vpe/explore/drawing/drawing.h"
#include "vpe/explore/drawing/ground_area.h"
#include "vpe/explore/drawing/ground_statistics.h"

namespace vpe::explore {

// Holds what takes no reading of the planet.
struct SphereMeasures {
  double length_m = 0;            // along great circles; of a polygon, its closed outline
  std::optional<double> area_m2;  // of the smaller side of a polygon that does not cross itself
  std::string no_area;            // why a polygon has none
};

// Computes lengths and areas on a sphere. Errors are those of sphere_polygon.h. Any thread may call it.
SphereMeasures sphere_measures(const Drawing& drawing, double radius_m);

// Holds what is read of the surface.
struct GroundMeasures {
  double length_m =
      0;  // over the surface below the great circles, exact but for rounding (paging/surface/section.h)
  double lowest_m = 0;  // of the ground at the point, or below line or outline; above the sphere
  double highest_m = 0;
  std::optional<GroundArea> area;  // of a polygon that does not cross itself
  // Slopes, plane and volumes of such a polygon, unless it is too large for them (kLargestStatistics_rad).
  std::optional<GroundStatistics> statistics;
};

// Measures a drawing on the surface. Returns nullopt if it was asked to stop. `options` are those of the area; the
// statistics have the same limit of cells.
// Throws paging::PlanetError. Any thread may call it.
std::optional<GroundMeasures> ground_measures(const paging::Surface& surface, const Drawing& drawing,
                                              const GroundAreaOptions& options = {},
                                              const std::stop_token& stop = {});

// Returns an area with at least three significant digits: "950 m²", "12.3 km²", "0.42 m²".
std::string measured_area_text(double area_m2);
// Returns a volume likewise: "950 m³", "12.3 km³".
std::string measured_volume_text(double volume_m3);

}  // namespace vpe::explore
