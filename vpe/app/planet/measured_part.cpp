#include "vpe/app/planet/measured_part.h"

#include <cmath>
#include <limits>

#include "mars/embedded/embedded.h"

namespace vpe::app {

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
