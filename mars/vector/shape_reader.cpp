#include "mars/vector/shape_reader.h"

#include <ogr_geometry.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "mars/raster/gdal/gdal_scope.h"

namespace mars {
namespace {

using Ring = std::vector<glm::dvec2>;

class ShapeReader {
 public:
  ShapeReader(const FeaturePlace& place, ReadBudget& budget) : place_(place), budget_(budget) {}

  std::vector<Shape> take() { return std::move(shapes_); }

  void add(const OGRGeometry& geometry) {
    if (is_half_a_point(geometry)) check({geometry.toPoint()->getX(), geometry.toPoint()->getY()});
    if (geometry.IsEmpty() != 0) return;
    switch (wkbFlatten(geometry.getGeometryType())) {
      case wkbPoint: add_point(*geometry.toPoint()); return;
      case wkbLineString: add_line(*geometry.toLineString()); return;
      case wkbPolygon:
      case wkbTriangle: add_polygon(*geometry.toPolygon()); return;
      case wkbTIN:
      case wkbPolyhedralSurface:
        for (const auto* part : *geometry.toPolyhedralSurface()) add(*part);
        return;
      default: break;
    }
    if (!OGR_GT_IsSubClassOf(wkbFlatten(geometry.getGeometryType()), wkbGeometryCollection))
      throw place_.error(
          std::string("its geometry is a ") + geometry.getGeometryName() + ", which is not known here",
          "give points, lines and polygons");
    for (const auto* part : *geometry.toGeometryCollection()) add(*part);
  }

 private:
  // A point is empty to GDAL if one coordinate is NaN; in GeoPackage both are.
  static bool is_half_a_point(const OGRGeometry& geometry) {
    if (wkbFlatten(geometry.getGeometryType()) != wkbPoint) return false;
    return std::isnan(geometry.toPoint()->getX()) != std::isnan(geometry.toPoint()->getY());
  }

  void add_point(const OGRPoint& point) {
    budget_.take_vertices(1, place_);
    const glm::dvec2 p(point.getX(), point.getY());
    check(p);
    shapes_.push_back({ShapeKind::point, {{p}}});
  }

  void add_line(const OGRSimpleCurve& curve) {
    Ring line = vertices(curve);
    if (line.size() < 2) throw place_.error("its line has 1 vertex", "a line has at least 2");
    shapes_.push_back({ShapeKind::line, {std::move(line)}});
  }

  void add_polygon(const OGRPolygon& polygon) {
    Shape shape{ShapeKind::polygon, {}};
    for (const auto* part : polygon) {
      if (part->IsEmpty() != 0) continue;
      Ring ring = vertices(*part);
      std::size_t places = ring.front() == ring.back() ? 0 : 1;
      for (std::size_t i = 1; i < ring.size(); ++i) places += ring[i] == ring[i - 1] ? 0 : 1;
      if (places < 3)
        throw place_.error("its ring has fewer than 3 places", "a polygon has at least 3; give a line instead");
      shape.rings.push_back(std::move(ring));
    }
    if (!shape.rings.empty()) shapes_.push_back(std::move(shape));
  }

  Ring vertices(const OGRSimpleCurve& curve) {
    const auto count = static_cast<std::size_t>(curve.getNumPoints());
    budget_.take_vertices(count, place_);
    Ring points(count);
    constexpr int kStep = sizeof(glm::dvec2);
    curve.getPoints(&points[0].x, kStep, &points[0].y, kStep);
    for (const glm::dvec2 p : points) check(p);
    return points;
  }

  void check(glm::dvec2 p) const {
    if (!std::isfinite(p.x) || !std::isfinite(p.y))
      throw place_.error("it has a coordinate that is not a finite number", "remove the feature or correct it");
  }

  const FeaturePlace& place_;
  ReadBudget& budget_;
  std::vector<Shape> shapes_;
};

}  // namespace

SourceError FeaturePlace::error(const std::string& fault, const std::string& advice) const {
  return source_error(path, "layer '" + layer + "', feature " + std::to_string(number), fault, advice);
}

void ReadBudget::take_vertices(std::size_t count, const FeaturePlace& place) {
  if (count > vertices) {
    throw place.error(
        "the file has more than the " + std::to_string(most_vertices) + " vertices that are accepted",
        "divide the file, e.g. with ogr2ogr -spat, or simplify it with ogr2ogr -simplify");
  }
  vertices -= count;
}

void ReadBudget::take_bytes(std::size_t count, const FeaturePlace& place) {
  if (count > bytes) {
    throw place.error(
        "the attributes have more than the " + std::to_string(most_bytes) + " bytes that are accepted",
        "leave attributes out, e.g. with ogr2ogr -select");
  }
  bytes -= count;
}

std::vector<Shape> shapes_of(const OGRGeometry& geometry, const FeaturePlace& place, ReadBudget& budget) {
  ShapeReader reader(place, budget);
  if (geometry.hasCurveGeometry(TRUE) != 0) {
    const std::unique_ptr<OGRGeometry> linear(geometry.getLinearGeometry());
    if (!linear)
      throw place.error(GdalScope::last_message(), "convert its curves with ogr2ogr -nlt CONVERT_TO_LINEAR");
    reader.add(*linear);
  } else {
    reader.add(geometry);
  }
  return reader.take();
}

}  // namespace mars
