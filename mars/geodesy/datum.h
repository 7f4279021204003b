// What heights are counted from.
#pragma once

#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <string_view>

namespace mars {

enum class DatumKind {
  kUnknown,    // the product does not say
  kAreoid,     // an equipotential surface: areoid, geoid, selenoid
  kSphere,     // a sphere around the centre, radius equatorial_m
  kEllipsoid,  // an ellipsoid of revolution around the centre; heights along its normal
  kRadius,     // the centre: values are planetary radii
};

// Two datums are equal when heights of one may stand beside heights of the other.
struct VerticalDatum {
  DatumKind kind = DatumKind::kUnknown;
  double equatorial_m = 0;  // kSphere, kEllipsoid; else 0
  double polar_m = 0;       // kEllipsoid; kSphere: as equatorial_m; else 0

  static VerticalDatum areoid() { return {DatumKind::kAreoid, 0, 0}; }
  static VerticalDatum sphere(double radius_m) { return {DatumKind::kSphere, radius_m, radius_m}; }
  static VerticalDatum ellipsoid(double equatorial_m, double polar_m) {
    return {DatumKind::kEllipsoid, equatorial_m, polar_m};
  }
  static VerticalDatum radius() { return {DatumKind::kRadius, 0, 0}; }

  bool is_known() const { return kind != DatumKind::kUnknown; }
  // Whether it is a surface of known shape: all but kUnknown and kAreoid.
  bool is_geometric() const { return is_known() && kind != DatumKind::kAreoid; }
  bool operator==(const VerticalDatum&) const = default;
};

// "unknown", "areoid", "sphere:3396190", "ellipsoid:3396190,3376200" (equatorial and polar radius, metres),
// "radius"; parse_datum(to_string(d)) == d. parse_datum also takes "geoid", and "sphere" alone, whose radius is
// `default_radius_m`; nothing for anything else, and for radii that are not within 100 m .. 1e9 m or of which
// the polar is less than half the equatorial or the larger.
std::string to_string(const VerticalDatum& datum);
std::optional<VerticalDatum> parse_datum(std::string_view text, double default_radius_m);

// Distance from the centre of the point in unit planetocentric `direction` that lies `height_m` above a
// geometric datum, and the height of the point at `radius_m`. Inverses of each other within 1e-8 m for |height|
// up to a tenth of the radius. On an ellipsoid the height is that along the normal (Bowring 1976, iterated).
double radius_at(const VerticalDatum& datum, const glm::dvec3& direction, double height_m);
double height_at(const VerticalDatum& datum, const glm::dvec3& direction, double radius_m);

}  // namespace mars
