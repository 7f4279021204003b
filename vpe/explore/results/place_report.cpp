#include "vpe/explore/results/place_report.h"

#include <algorithm>
#include <utility>

#include "vpe/base/number.h"

namespace vpe::explore {

namespace {

std::string name_text(const NearestName& name) {
  return name.is_inside ? "in " + name.name : measured_length_text(name.distance_m) + " from " + name.name;
}

const char* kind_text(GroundKind kind) {
  switch (kind) {
    case GroundKind::kMeasured: return "measured";
    case GroundKind::kSynthetic: return "synthetic: made up, not data";
    case GroundKind::kNodata: return "no data";
    case GroundKind::kUnknown: break;
  }
  return "unknown: the planet file does not tell its source";
}

GroundKind kind_at(const paging::PlaceAnswer& answer, const paging::PlanetMeta& meta) {
  if (answer.nodata) return GroundKind::kNodata;
  if (!answer.source) return GroundKind::kUnknown;
  return meta.sources.at(static_cast<std::size_t>(*answer.source)).illustration ? GroundKind::kSynthetic
                                                                                : GroundKind::kMeasured;
}

}  // namespace

std::optional<NearestName> nearest_name(std::span<const core::Place> places, mars::LonLat place,
                                        double radius_m) {
  const core::Place* smallest = nullptr;
  std::optional<NearestName> nearest;
  for (const core::Place& named : places) {
    const double middle_m = mars::distance_rad({named.lon_deg, named.lat_deg}, place) * radius_m;
    const double off_m = std::max(0.0, middle_m - named.diameter_m / 2);
    if (named.diameter_m > 0 && off_m == 0 &&
        (smallest == nullptr || named.diameter_m < smallest->diameter_m)) {
      smallest = &named;
    }
    if (!nearest || off_m < nearest->distance_m) nearest = NearestName{named.name, off_m, false};
  }
  if (smallest != nullptr) return NearestName{smallest->name, 0, true};
  return nearest;
}

PlaceReport what_is_here(const paging::Surface& surface, mars::LonLat place,
                         std::span<const core::Place> places) {
  PlaceReport report;
  report.ground = read_out_at(surface, place);
  report.kind = kind_at(report.ground.at, surface.planet().meta());
  report.name = nearest_name(places, place, surface.planet_radius_m());
  return report;
}

std::vector<ReadOutLine> place_lines(const PlaceReport& report) {
  const ReadOut& ground = report.ground;
  const paging::PlaceAnswer& answer = ground.at;
  std::vector<ReadOutLine> lines;
  const auto add = [&](const char* label, std::string text) { lines.push_back({label, std::move(text)}); };
  if (report.name) add("Name", name_text(*report.name));
  add("Place", coordinates_text(answer.place));
  if (!answer.nodata) {
    add("Elevation", base::format_display(answer.elevation_m, 1) + " m (" + ground.datum + ")");
    add("Slope", base::format_display(answer.slope_deg, 1) + "\u00b0, down to " +
                     base::format_display(answer.aspect_deg, 0) + "\u00b0");
  }
  if (!ground.source.empty()) {
    add("Source",
        ground.source +
            (ground.source_spacing_m > 0 ? ", posts " + measured_length_text(ground.source_spacing_m) : ""));
  }
  add("Posts", measured_length_text(answer.spacing_m) + " apart");
  if (answer.resampling.posts > 0)
    add("Error", "at most " + measured_length_text(answer.resampling.max_m) + " from its source");
  add("Ground", kind_text(report.kind));
  return lines;
}

}  // namespace vpe::explore
