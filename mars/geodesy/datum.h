// Vertical datums: the surfaces from which heights are counted.
#pragma once

#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <string_view>

namespace mars {

enum class DatumKind {
  kUnknown,    // the product does not state it
  kAreoid,     // an equipotential surface: areoid, geoid, selenoid
  kSphere,     // a sphere of radius equatorial_m around the centre
  kEllipsoid,  // an ellipsoid of revolution around the centre; heights along its normal
  kRadius,     // the centre: values are planetary radii
};

// Describes a vertical datum. Heights of equal datums may be mixed.
struct VerticalDatum {
  DatumKind kind = DatumKind::kUnknown;
  double equatorial_m = 0;  // kSphere, kEllipsoid; else 0
  double polar_m = 0;       // kEllipsoid; kSphere: equal to equatorial_m; else 0

  static VerticalDatum areoid() { return {DatumKind::kAreoid, 0, 0}; }
  static VerticalDatum sphere(double radius_m) { return {DatumKind::kSphere, radius_m, radius_m}; }
  static VerticalDatum ellipsoid(double equatorial_m, double polar_m) {
    return {DatumKind::kEllipsoid, equatorial_m, polar_m};
  }
  static VerticalDatum radius() { return {DatumKind::kRadius, 0, 0}; }

  bool is_known() const { return kind != DatumKind::kUnknown; }
  // Returns true if it is a surface of known shape, i.e. neither kUnknown nor kAreoid.
  bool is_geometric() const { return is_known() && kind != DatumKind::kAreoid; }
  bool operator==(const VerticalDatum&) const = default;
};

// Returns "unknown", "areoid", "sphere:3396190", "ellipsoid:3396190,3376200" (equatorial and polar radius in
// metres) or "radius". Planet files store this text: it must not change. parse_datum(to_string(d), r) == d.
std::string to_string(const VerticalDatum& datum);

// Parses the texts of to_string(), "geoid" (the areoid), and "sphere" without a radius, which takes
// `default_radius_m`. Returns nullopt for any other text, for radii outside 100 m .. 1e9 m, and for a polar
// radius larger than the equatorial one or smaller than its half.
std::optional<VerticalDatum> parse_datum(std::string_view text, double default_radius_m);

// radius_at() returns the distance from the centre of the point in unit planetocentric `direction` that lies
// `height_m` above a geometric datum. height_at() returns the height of the point at `radius_m`. They are
// inverse to each other within 1e-8 m for |height| up to a tenth of the radius. On an ellipsoid the height is
// measured along the normal (Bowring 1976, iterated).
double radius_at(const VerticalDatum& datum, const glm::dvec3& direction, double height_m);
double height_at(const VerticalDatum& datum, const glm::dvec3& direction, double radius_m);

}  // namespace mars
