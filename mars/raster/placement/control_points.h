// Ground control points of a raster: which of them count, and by which method they place it.
#pragma once

#include <ogr_spatialref.h>

#include <string>
#include <vector>

#include "mars/raster/placement/control_fit.h"
#include "mars/raster/placement/placement_options.h"

class GDALDataset;

namespace mars {

struct ControlPoints {
  std::vector<ControlPoint> points;  // longitudes within 180 degrees of the first one
  OGRSpatialReference crs;
  bool is_spline = false;
  int order = 1;  // of the polynomial; with the spline, of that which checks the points
  PolynomialCheck check;

  // Returns what they do, for planet files, which store it: it must not change.
  std::string treatment() const;

  // Returns a sentence for the user with the residuals: root mean square and largest, in pixels and in metres.
  std::string note(double pixel_m) const;
};

// Largest root mean square of the residuals of the polynomial, as a share of the raster's diagonal. More of it means
// that the points are of another raster, or that their coordinates are exchanged.
inline constexpr double kMostResidual = 0.1;

// Reads the points of a raster and selects the method. Points that are given twice count once. Throws SourceError with
// `path` if the points have no coordinate system, are no numbers, contradict each other, lie on one line, are too few
// or too many for the method, do not determine it, or have residuals beyond kMostResidual. Must be called inside a
// GdalScope.
ControlPoints control_points(const std::string& path, GDALDataset& dataset, GcpMethod method);

}  // namespace mars
