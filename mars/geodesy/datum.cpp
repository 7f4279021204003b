#include "mars/geodesy/datum.h"

#include <algorithm>
#include <cctype>
#include <cmath>

#include "vpe/base/number.h"

namespace mars {

namespace {

// Parses a radius. A leading + is refused: to_string() never writes one.
std::optional<double> parse_radius(std::string_view text) {
  if (text.starts_with('+')) return std::nullopt;
  const auto value = vpe::base::parse_number(text);
  return value && *value >= 100 && *value <= 1e9 ? value : std::nullopt;
}

// Returns the height above an ellipsoid, along its normal, of a point of the meridian plane.
double ellipsoidal_height(double a, double b, double p, double z) {
  const double e2 = 1 - (b * b) / (a * a);
  // Each step of Bowring's iteration of the parametric latitude reduces the error by a factor of about
  // e^4 h / a; three steps exceed double precision for the flattening of planets.
  if (p <= 1e-150 * std::abs(z)) return std::abs(z) - b;  // over a pole
  double t = z * a / (p * b);
  for (int step = 0; step < 6; ++step) {
    const double c = 1 / std::sqrt(1 + t * t);
    const double s = t * c;
    const double ep2 = e2 / (1 - e2);
    const double tan_lat = (z + ep2 * b * s * s * s) / (p - e2 * a * c * c * c);
    t = tan_lat * b / a;
  }
  const double c = 1 / std::sqrt(1 + t * t);
  const double s = t * c;
  const double dp = p - a * c;
  const double dz = z - b * s;
  // Along the outward normal (c / a, s / b) of the foot (a c, b s).
  const double length = std::hypot(c / a, s / b);
  return (dp * c / a + dz * s / b) / length;
}

}  // namespace

std::string to_string(const VerticalDatum& datum) {
  switch (datum.kind) {
    case DatumKind::kUnknown: return "unknown";
    case DatumKind::kAreoid: return "areoid";
    case DatumKind::kSphere: return "sphere:" + vpe::base::format_shortest(datum.equatorial_m);
    case DatumKind::kEllipsoid:
      return "ellipsoid:" + vpe::base::format_shortest(datum.equatorial_m) + "," +
             vpe::base::format_shortest(datum.polar_m);
    case DatumKind::kRadius: return "radius";
  }
  return "unknown";
}

std::optional<VerticalDatum> parse_datum(std::string_view text, double default_radius_m) {
  if (text == "unknown") return VerticalDatum{};
  if (text == "areoid" || text == "geoid") return VerticalDatum::areoid();
  if (text == "radius") return VerticalDatum::radius();
  if (text == "sphere") return VerticalDatum::sphere(default_radius_m);
  if (text.starts_with("sphere:")) {
    const auto radius = parse_radius(text.substr(7));
    if (!radius) return std::nullopt;
    return VerticalDatum::sphere(*radius);
  }
  if (text.starts_with("ellipsoid:")) {
    text.remove_prefix(10);
    const std::size_t comma = text.find(',');
    if (comma == std::string_view::npos) return std::nullopt;
    const auto equatorial = parse_radius(text.substr(0, comma));
    const auto polar = parse_radius(text.substr(comma + 1));
    if (!equatorial || !polar || *polar > *equatorial || *polar < *equatorial / 2) return std::nullopt;
    return VerticalDatum::ellipsoid(*equatorial, *polar);
  }
  return std::nullopt;
}

double height_at(const VerticalDatum& datum, const glm::dvec3& direction, double radius_m) {
  if (datum.kind != DatumKind::kEllipsoid) return radius_m - datum.equatorial_m;
  const double p = std::hypot(direction.x, direction.y) * radius_m;
  return ellipsoidal_height(datum.equatorial_m, datum.polar_m, p, direction.z * radius_m);
}

double radius_at(const VerticalDatum& datum, const glm::dvec3& direction, double height_m) {
  if (datum.kind != DatumKind::kEllipsoid) return datum.equatorial_m + height_m;
  const double p = std::hypot(direction.x, direction.y);
  // Starts at the ellipsoid's radius. The height grows with the radius by the cosine between normal and
  // direction, which is within 1e-3 of one for the flattening of planets, so steps of slope one converge.
  double radius = 1 / std::hypot(p / datum.equatorial_m, direction.z / datum.polar_m) + height_m;
  for (int step = 0; step < 12; ++step) {
    radius += height_m - height_at(datum, direction, radius);
  }
  return radius;
}

}  // namespace mars
