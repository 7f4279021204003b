// Options of rasters that have no map but ground control points or an RPC (rational polynomial coefficients).
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace mars {

enum class GcpMethod {
  kByCount,      // the spline from kLeastSplinePoints to kMostSplinePoints points; else a polynomial
  kPolynomial1,  // affine
  kPolynomial2,
  kPolynomial3,
  kSpline,  // thin-plate spline, which meets every point
};

// The method by count: points of a spline, and the polynomial that fewer or more of them allow.
inline constexpr int kLeastSplinePoints = 10;
inline constexpr int kMostSplinePoints = 2000;  // its equations take time with the cube of their number

struct PlacementOptions {
  GcpMethod gcp_method = GcpMethod::kByCount;
  // Height of the ground above the surface from which the RPC counts. Unset: the RPC's own height offset.
  std::optional<double> rpc_height_m = {};
  std::string rpc_dem = {};  // raster of such heights, in place of one height; empty: none
  // Geographic system of the RPC, in any text of GDAL. Empty: that of the raster; if it has none, WGS 84 for the
  // Earth, else planetocentric degrees on a sphere of body_radius_m.
  std::string rpc_crs = {};
  double body_radius_m = 0;  // 0: that of Mars
};

// Limit of |rpc_height_m|.
inline constexpr double kMostRpcHeight_m = 1e5;

// Returns the method of "polynomial1", "polynomial2", "polynomial3" or "tps", or nullopt for other texts.
std::optional<GcpMethod> parse_gcp_method(std::string_view text);

}  // namespace mars
