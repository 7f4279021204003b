#include "vpe/app/planet/measured_part.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>

#include "mars/embedded/detail_below.h"
#include "mars/embedded/embedded.h"

namespace vpe::app {

namespace {

// Returns the data that a source of detail lies below, or null for other sources.
const mars::SourceInfo* data_above(const mars::SourceInfo& detail, const paging::PlanetMeta& meta) {
  const std::string_view name = detail.name;
  if (!name.starts_with(mars::kDetailBelow)) return nullptr;
  const std::string_view wanted = name.substr(std::string_view(mars::kDetailBelow).size());
  const auto data = std::ranges::find(meta.sources, wanted, &mars::SourceInfo::name);
  return data == meta.sources.end() ? nullptr : &*data;
}

}  // namespace

const mars::SourceInfo* source_of(const paging::PlaceAnswer& answer, const paging::PlanetMeta& meta) {
  return answer.source ? &meta.sources.at(static_cast<std::size_t>(*answer.source)) : nullptr;
}

const char* kind_of(const paging::PlaceAnswer& answer, const paging::PlanetMeta& meta) {
  const mars::SourceInfo* source = source_of(answer, meta);
  if (source == nullptr) return nullptr;
  return source->illustration ? "synthetic" : "measured";
}

std::vector<double> measured_parts_m(std::span<const paging::PlaceAnswer> answers,
                                     const paging::PlanetMeta& meta) {
  std::vector<double> parts(answers.size(), std::numeric_limits<double>::quiet_NaN());
  std::vector<glm::dvec3> directions;
  std::vector<std::size_t> index;
  for (std::size_t k = 0; k < answers.size(); ++k) {
    const mars::SourceInfo* source = source_of(answers[k], meta);
    if (source == nullptr) continue;
    if (!source->illustration) {
      parts[k] = answers[k].elevation_m;
    } else if (source->name == mars::kEmbeddedDetail) {
      directions.push_back(mars::direction(answers[k].place));
      index.push_back(k);
    } else if (const mars::SourceInfo* data = data_above(*source, meta)) {
      const glm::dvec3 direction = mars::direction(answers[k].place);
      double detail_m = 0;
      mars::detail_below({&direction, 1}, answers[k].spacing_m, data->resolution_m, {&detail_m, 1});
      parts[k] = answers[k].elevation_m - detail_m;
    }
  }
  if (directions.empty()) return parts;
  const auto data = mars::embedded_elevation({.detail = false});
  if (data->infos().front().illustration) return parts;
  std::vector<double> heights(directions.size());
  data->sample(directions, data->infos().front().resolution_m, heights);
  for (std::size_t k = 0; k < index.size(); ++k) parts[index[k]] = heights[k];
  return parts;
}

}  // namespace vpe::app
