#include "mars/geodesy/datum.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>

namespace mars {

namespace {

std::string shortest(double value) {
  char text[32];
  const auto end = std::to_chars(text, text + sizeof text, value);
  return {text, end.ptr};
}

std::optional<double> number(std::string_view text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  if (!(value >= 100 && value <= 1e9)) return std::nullopt;
  return value;
}

// Height along the normal of an ellipsoid and sine of the normal's latitude, of a point in the meridian plane.
double ellipsoidal_height(double a, double b, double p, double z) {
  const double e2 = 1 - (b * b) / (a * a);
  // Bowring's parametric latitude converges by about e^4 h / a a step; three steps are beyond double precision
  // for flattenings of planets.
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
    case DatumKind::kSphere: return "sphere:" + shortest(datum.equatorial_m);
    case DatumKind::kEllipsoid:
      return "ellipsoid:" + shortest(datum.equatorial_m) + "," + shortest(datum.polar_m);
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
    const auto radius = number(text.substr(7));
    if (!radius) return std::nullopt;
    return VerticalDatum::sphere(*radius);
  }
  if (text.starts_with("ellipsoid:")) {
    text.remove_prefix(10);
    const std::size_t comma = text.find(',');
    if (comma == std::string_view::npos) return std::nullopt;
    const auto equatorial = number(text.substr(0, comma));
    const auto polar = number(text.substr(comma + 1));
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
  // The ellipsoid's own radius there; height grows with radius by the cosine between normal and direction,
  // which is within 1e-3 of one for flattenings of planets: steps of slope one end below rounding.
  double radius = 1 / std::hypot(p / datum.equatorial_m, direction.z / datum.polar_m) + height_m;
  for (int step = 0; step < 12; ++step) {
    radius += height_m - height_at(datum, direction, radius);
  }
  return radius;
}

}  // namespace mars
