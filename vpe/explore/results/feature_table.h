// A table of results that becomes a layer of features: the values of JSON objects, and where they are.
//
// Typical usage:
//   FeatureTable table("sight");
//   table.add("line", json, {great_circle_line(ends)});
//   table.add("obstacle", {{"distance_m", 812.5}}, {point_shape(place)});
//   mars::write_features(file, table.layer(), info);
#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "mars/geodesy/sphere.h"
#include "mars/vector/feature.h"

namespace vpe::explore {

// Edges that are straight in degrees stay this near to the great circles that they stand for, radians: 0.34 m on Mars.
inline constexpr double kStraightEdge_rad = 1e-7;

// Return shapes with unwrapped longitudes. Vertices are put into edges, so that each stays within kStraightEdge_rad of the
// great circle between two places; within a 16384th of an edge's length of a pole it may not. A line has two places or
// more, an outline three or more, in either direction and without the first one repeated. Pure.
mars::Shape point_shape(mars::LonLat place);
mars::Shape great_circle_line(std::span<const mars::LonLat> places);
mars::Shape great_circle_polygon(std::span<const mars::LonLat> places);

// Collects features whose attributes are values of JSON objects.
//
// An object in an object becomes attributes whose names are joined by "_", as "plane_dip_deg"; so do the objects of a list,
// with their number from 1: "slope_steeper_1_share". A list of other values becomes one text, joined by "; ". True and
// false become 1 and 0. Attributes that no feature has a value of are left out.
class FeatureTable {
 public:
  explicit FeatureTable(std::string name) : name_(std::move(name)) {}

  // Adds a feature. `part` says what it shows, as "line" or "obstacle"; it is the attribute "part" unless it is empty.
  // `values` is an object.
  void add(const std::string& part, const nlohmann::json& values, std::vector<mars::Shape> shapes);

  // Returns the layer. Its attributes are in the order in which they came first; features are numbered from 1.
  mars::FeatureLayer layer() const;

 private:
  struct Row {
    std::vector<std::pair<std::string, mars::FieldValue>> values;
    std::vector<mars::Shape> shapes;
  };
  std::string name_;
  std::vector<Row> rows_;
};

}  // namespace vpe::explore
