#include "relief/spec_polygon.h"

#include <cmath>
#include <optional>

#include "relief/spec.h"
#include "vpe/base/number.h"
#include "vpe/base/quote.h"

namespace relief {

std::vector<mars::LonLat> parse_polygon(std::string_view text, std::string& problem) {
  problem.clear();
  std::vector<mars::LonLat> corners;
  const auto refuse = [&](std::string what) {
    problem = std::move(what);
    return std::vector<mars::LonLat>();
  };
  if (text.empty()) return corners;
  for (std::string_view rest = text; !rest.empty();) {
    const std::string_view corner = rest.substr(0, rest.find(';'));
    const bool is_last = corner.size() == rest.size();
    rest.remove_prefix(is_last ? rest.size() : corner.size() + 1);
    if (!is_last && rest.empty()) return refuse("expected a corner after the last semicolon");
    const std::size_t comma = corner.find(',');
    const auto lon_deg = vpe::base::parse_number(corner.substr(0, comma));
    const auto lat_deg =
        comma == corner.npos ? std::nullopt : vpe::base::parse_number(corner.substr(comma + 1));
    if (!lon_deg || !lat_deg || !(std::abs(*lon_deg) <= 360) || !(std::abs(*lat_deg) <= 90)) {
      return refuse("expected corners LON,LAT with LON from -360 to 360 and LAT from -90 to 90, found " +
                    vpe::base::quote_text(corner));
    }
    corners.push_back({*lon_deg, *lat_deg});
  }
  if (corners.size() < 3 || corners.size() > kMostPolygonCorners) {
    return refuse("expected 3 to " + std::to_string(kMostPolygonCorners) + " corners, found " +
                  std::to_string(corners.size()));
  }
  return corners;
}

std::string format_polygon(std::span<const mars::LonLat> corners) {
  std::string text;
  for (const mars::LonLat& corner : corners) {
    if (!text.empty()) text += ';';
    text += vpe::base::format_number(corner.lon_deg) + "," + vpe::base::format_number(corner.lat_deg);
  }
  return text;
}

}  // namespace relief
