#include "mars/raster/placement/control_points.h"

#include <gdal_priv.h>

#include <algorithm>
#include <cmath>

#include "mars/geodesy/sphere.h"
#include "mars/raster/gdal/gdal_scope.h"
#include "vpe/base/number.h"

namespace mars {
namespace {

const char* const kAddPoints = "add points with gdal_translate -gcp";

constexpr double kNothing = 5e-4;  // smaller numbers are shown as 0

std::string digits(double value) { return value < kNothing ? "0" : vpe::base::format_significant(value, 2); }

std::string of_pixels(const Misfit& misfit, double pixel_m) {
  return digits(misfit.rms_px) + " pixels (" + digits(misfit.rms_px * pixel_m) + " m) RMS, " +
         digits(misfit.largest_px) + " pixels (" + digits(misfit.largest_px * pixel_m) + " m) at most";
}

std::vector<ControlPoint> read_points(const std::string& path, GDALDataset& dataset) {
  const GDAL_GCP* gcps = dataset.GetGCPs();
  std::vector<ControlPoint> points;
  for (int i = 0; i < dataset.GetGCPCount(); ++i) {
    const GDAL_GCP& gcp = gcps[i];
    const std::string number = std::to_string(i + 1);
    ControlPoint point{{gcp.dfGCPPixel, gcp.dfGCPLine},
                       {gcp.dfGCPX, gcp.dfGCPY},
                       gcp.pszId != nullptr && gcp.pszId[0] != '\0' ? gcp.pszId : number};
    for (const double value : {point.pixel.x, point.pixel.y, point.ground.x, point.ground.y}) {
      if (std::isfinite(value)) continue;
      throw source_error(path, "its control point '" + point.name + "' is no number", "",
                         "remove it, or give the points anew with gdal_translate -gcp");
    }
    points.push_back(std::move(point));
  }
  return points;
}

// Removes repeated points. Throws for points that differ at one pixel or at one place.
void remove_repeated(const std::string& path, std::vector<ControlPoint>& points) {
  std::vector<ControlPoint> kept;
  const auto before = [](const glm::dvec2& a, const glm::dvec2& b) {
    return a.x != b.x ? a.x < b.x : a.y < b.y;
  };
  std::stable_sort(points.begin(), points.end(), [&](const ControlPoint& a, const ControlPoint& b) {
    return a.pixel != b.pixel ? before(a.pixel, b.pixel) : before(a.ground, b.ground);
  });
  const auto contradicts = [&](const ControlPoint& a, const ControlPoint& b, const char* what) {
    return source_error(path, "its control points '" + a.name + "' and '" + b.name + "' contradict each other",
                        what, "remove the wrong one");
  };
  for (ControlPoint& point : points) {
    if (!kept.empty() && kept.back().pixel == point.pixel) {
      if (kept.back().ground == point.ground) continue;
      throw contradicts(kept.back(), point, "one pixel at two places");
    }
    kept.push_back(std::move(point));
  }
  std::vector<const ControlPoint*> by_ground;
  for (const ControlPoint& point : kept) by_ground.push_back(&point);
  std::sort(by_ground.begin(), by_ground.end(),
            [&](const ControlPoint* a, const ControlPoint* b) { return before(a->ground, b->ground); });
  for (std::size_t i = 1; i < by_ground.size(); ++i) {
    if (by_ground[i]->ground == by_ground[i - 1]->ground)
      throw contradicts(*by_ground[i - 1], *by_ground[i], "one place at two pixels");
  }
  points = std::move(kept);
}

// Brings longitudes of points on both sides of the antimeridian together.
void join_longitudes(const OGRSpatialReference& crs, std::vector<ControlPoint>& points) {
  if (crs.IsGeographic() == 0) return;
  const double turn = 2 * kPi / crs.GetAngularUnits();
  for (ControlPoint& point : points)
    point.ground.x = points.front().ground.x + std::remainder(point.ground.x - points.front().ground.x, turn);
}

int highest_order(std::size_t count) {
  int order = 0;
  while (order < 3 && count >= polynomial_terms(order + 1)) ++order;
  return order;
}

void select_method(const std::string& path, GcpMethod method, ControlPoints& found) {
  const std::size_t count = found.points.size();
  const std::string has = "has " + std::to_string(count) + " control points";
  const int most = highest_order(count);
  if (most == 0) throw source_error(path, has, "a map needs at least 3", kAddPoints);
  switch (method) {
    case GcpMethod::kByCount:
      found.is_spline = count >= static_cast<std::size_t>(kLeastSplinePoints) &&
                        count <= static_cast<std::size_t>(kMostSplinePoints);
      found.order = most;
      break;
    case GcpMethod::kSpline:
      found.is_spline = true;
      found.order = most;
      break;
    case GcpMethod::kPolynomial1: found.order = 1; break;
    case GcpMethod::kPolynomial2: found.order = 2; break;
    case GcpMethod::kPolynomial3: found.order = 3; break;
  }
  if (found.is_spline && count > static_cast<std::size_t>(kMostSplinePoints)) {
    throw source_error(path, has, "a spline takes at most " + std::to_string(kMostSplinePoints),
                       "use --gcp-method polynomial3");
  }
  if (found.order > most) {
    throw source_error(path, has,
                       "a polynomial of order " + std::to_string(found.order) + " needs " +
                           std::to_string(polynomial_terms(found.order)),
                       "use --gcp-method polynomial" + std::to_string(most) + ", or " + kAddPoints);
  }
}

// Fits the polynomial. Where the user left the method open, a lower order may do where the points do not determine
// the highest.
void check_points(const std::string& path, GcpMethod method, ControlPoints& found) {
  if (are_on_one_line(found.points)) {
    throw source_error(path, "its control points lie on one line",
                       "they do not say where the raster lies beside it", kAddPoints);
  }
  const bool is_free = found.is_spline || method == GcpMethod::kByCount;
  auto check = check_polynomial(found.points, found.order);
  while (!check && is_free && found.order > 1) check = check_polynomial(found.points, --found.order);
  if (!check) {
    throw source_error(
        path, "its control points do not determine a polynomial of order " + std::to_string(found.order),
        "they lie on one curve of that order",
        std::string("use a lower one, such as --gcp-method polynomial1, or ") + kAddPoints);
  }
  found.check = *check;
}

}  // namespace

std::string ControlPoints::treatment() const {
  return "placed by its control points, " +
         (is_spline ? std::string("thin-plate spline") : "polynomial of order " + std::to_string(order));
}

std::string ControlPoints::note(double pixel_m) const {
  const std::string count = std::to_string(points.size()) + " control points";
  const std::string polynomial = "a polynomial of order " + std::to_string(order);
  const auto at_worst = [&](const Misfit& misfit) {
    return misfit.largest_px > 0 ? ", at '" + points[misfit.worst].name + "'" : std::string();
  };
  if (!is_spline) {
    const std::string text = "placed by its " + count + " with " + polynomial;
    if (points.size() == polynomial_terms(order))
      return text + ", which needs all of them: nothing checks them";
    return text + "; they lie off it by " + of_pixels(check.fitted, pixel_m) + at_worst(check.fitted);
  }
  const std::string text = "placed by its " + count + " with a thin-plate spline, which meets each of them";
  if (!check.left_out) return text + ": nothing checks them";
  return text + "; " + polynomial + " through the other points misses a point by " +
         of_pixels(*check.left_out, pixel_m) + at_worst(*check.left_out);
}

ControlPoints control_points(const std::string& path, GDALDataset& dataset, GcpMethod method) {
  ControlPoints found;
  const OGRSpatialReference* crs = dataset.GetGCPSpatialRef();
  if (crs == nullptr || crs->IsEmpty()) crs = dataset.GetSpatialRef();
  if (crs == nullptr || crs->IsEmpty()) {
    throw source_error(
        path, "has control points but no coordinate system", "",
        "name that of its body with gdal_edit.py -a_srs IAU_2015:CODE FILE: 49900 for Mars, 30100 for "
        "the Moon");
  }
  found.crs = *crs;
  found.points = read_points(path, dataset);
  remove_repeated(path, found.points);
  join_longitudes(found.crs, found.points);
  select_method(path, method, found);
  check_points(path, method, found);
  const double diagonal_px = std::hypot(dataset.GetRasterXSize(), dataset.GetRasterYSize());
  const Misfit& misfit = found.check.fitted;
  if (!(misfit.rms_px <= kMostResidual * diagonal_px)) {
    throw source_error(
        path, "its control points contradict each other",
        "a polynomial of order " + std::to_string(found.order) + " misses them by " + digits(misfit.rms_px) +
            " pixels RMS, and '" + found.points[misfit.worst].name + "' by " + digits(misfit.largest_px),
        "correct or remove wrong points; x is the longitude or easting, y the latitude or northing");
  }
  return found;
}

}  // namespace mars
