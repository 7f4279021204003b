// Points, lines and polygons with attributes, as vector files have them.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <string>
#include <variant>
#include <vector>

namespace mars {

enum class ShapeKind { point, line, polygon };

// Holds one connected shape in degrees east and degrees north, planetocentric. Longitudes of neighbouring vertices
// differ by at most 180 degrees; they may leave [-180, 180].
struct Shape {
  ShapeKind kind = ShapeKind::point;
  // A point: one ring of one vertex. A line: one ring. A polygon: its outline, then its holes; rings are closed, so
  // that the last vertex repeats the first one.
  std::vector<std::vector<glm::dvec2>> rings;
};

// Holds an attribute's value; monostate: it has none.
using FieldValue = std::variant<std::monostate, std::int64_t, double, std::string>;

struct Feature {
  std::int64_t number = 0;  // in its file
  std::vector<Shape> shapes;
  std::vector<FieldValue> values;  // as many as the layer has fields
  std::string style;               // OGR style string of the file; empty: none
};

struct FeatureLayer {
  std::string name;
  std::vector<std::string> fields;
  std::vector<Feature> features;
};

}  // namespace mars
