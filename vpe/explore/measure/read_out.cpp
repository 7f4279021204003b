#include "vpe/explore/measure/read_out.h"

#include <cmath>

#include "vpe/base/number.h"

namespace vpe::explore {

namespace {

double east_of(double lon_deg) {
  const double east = lon_deg < 0 ? lon_deg + 360.0 : lon_deg;
  return east < 360.0 ? east : 0.0;  // the sum may have been rounded up to 360
}

}  // namespace

std::string short_source_name(const std::string& source) {
  const std::size_t slash = source.find_last_of('/');
  return slash == std::string::npos || slash + 1 == source.size() ? source : source.substr(slash + 1);
}

ReadOut read_out_at(const paging::Surface& surface, mars::LonLat place, double exaggeration) {
  ReadOut out;
  out.at = paging::query(surface, place);
  out.lon_east_deg = east_of(out.at.place.lon_deg);
  const paging::PlanetMeta& meta = surface.planet().meta();
  out.datum = paging::describe_datum(meta);
  out.illustration = meta.illustration;
  const auto info = [&](int source) -> const mars::SourceInfo& {
    return meta.sources.at(static_cast<std::size_t>(source));
  };
  if (out.at.source) {
    out.source = short_source_name(info(*out.at.source).name);
    out.source_spacing_m = info(*out.at.source).resolution_m;
  } else if (!out.at.nodata) {
    for (const int s : out.at.tile_sources)
      out.source += (out.source.empty() ? "" : " or ") + short_source_name(info(s).name);
  }
  const glm::dvec3 direction = mars::direction(place);
  out.point_m = surface.at(direction, exaggeration).radius_m * direction;
  return out;
}

std::optional<ReadOut> read_out(const paging::Surface& surface, const glm::dvec3& camera_m,
                                const glm::dvec3& direction, double exaggeration) {
  const double range_m = surface.cast(camera_m, direction, exaggeration);
  if (!std::isfinite(range_m)) return std::nullopt;
  const glm::dvec3 point_m = camera_m + range_m * direction;
  ReadOut out = read_out_at(surface, mars::lon_lat(point_m), exaggeration);
  if (range_m > 0) out.point_m = point_m;
  out.range_m = range_m;
  return out;
}

std::string measured_length_text(double length_m) {
  const double size = std::abs(length_m);
  if (size < 9.995) return base::format_display(length_m, 2) + " m";
  if (size < 99.95) return base::format_display(length_m, 1) + " m";
  if (size < 9999.5) return base::format_display(length_m, 0) + " m";
  if (size < 99950) return base::format_display(length_m / 1000, 2) + " km";
  if (size < 999500) return base::format_display(length_m / 1000, 1) + " km";
  return base::format_display(length_m / 1000, 0) + " km";
}

std::string coordinates_text(mars::LonLat place) {
  return base::format_display(place.lon_deg, 5) + ", " + base::format_display(place.lat_deg, 5);
}

std::vector<ReadOutLine> read_out_lines(const ReadOut& r) {
  const paging::PlaceAnswer& a = r.at;
  std::vector<ReadOutLine> lines;
  const auto add = [&](const char* label, std::string text) { lines.push_back({label, std::move(text)}); };
  add("Longitude",
      base::format_display(a.place.lon_deg, 5) + " (" + base::format_display(r.lon_east_deg, 5) + " E)");
  add("Latitude", base::format_display(a.place.lat_deg, 5));
  if (a.nodata) {
    add("Elevation", "no data");
  } else {
    add("Elevation", base::format_display(a.elevation_m, 1) + " m (" + r.datum + ")");
    add("Slope", base::format_display(a.slope_deg, 1) + " deg, down to " +
                     base::format_display(a.aspect_deg, 0) + " deg");
  }
  if (r.range_m) add("Range", measured_length_text(*r.range_m));
  add("Level", std::to_string(a.level) + ", posts " + measured_length_text(a.spacing_m));
  if (!r.source.empty()) {
    add("Source", r.source +
                      (r.source_spacing_m > 0 ? ", posts " + measured_length_text(r.source_spacing_m) : "") +
                      (r.illustration ? ", not data" : ""));
  }
  const auto error_text = [](const paging::ResamplingError& error) {
    return measured_length_text(error.rms_m) + " rms, " + measured_length_text(error.max_m) + " most";
  };
  if (a.resampling.posts > 0) {
    add("Resampling error", error_text(a.resampling));
  } else if (!a.nodata && a.planet_resampling.posts > 0) {
    add("Resampling error", error_text(a.planet_resampling) + " on the planet");
  }
  return lines;
}

}  // namespace vpe::explore
