#include "vpe/app/planet/planet_json.h"

#include <nlohmann/json.hpp>

namespace vpe::app {

using nlohmann::json;

namespace {

json sources_json(const std::vector<mars::SourceInfo>& sources, bool are_images) {
  json list = json::array();
  for (const mars::SourceInfo& s : sources) {
    json entry{{"name", s.name},           {"size_bytes", s.size_bytes},  {"resolution_m", s.resolution_m},
               {"quantum_m", s.quantum_m}, {"datum", to_string(s.datum)}, {"illustration", s.illustration}};
    entry["treatment"] = s.treatment.empty() ? json() : json(s.treatment);
    entry["accuracy_m"] = s.accuracy_m ? json(*s.accuracy_m) : json();
    if (are_images) entry["own_light"] = s.has_own_light;
    list.push_back(std::move(entry));
  }
  return list;
}

json image_layers_json(const paging::PlanetMeta& m) {
  json list = json::array();
  for (const paging::ImageLayer& layer : m.image_layers) {
    list.push_back(
        {{"name", layer.name},
         {"source", m.image_sources.at(static_cast<std::size_t>(layer.source)).name},
         {"finest_level", layer.finest_level},
         {"texel_spacing_m", lod::post_spacing_m(layer.finest_level, paging::kImageIntervals, m.radius_m)},
         {"tiles", layer.tiles},
         {"bytes", layer.bytes}});
  }
  return list;
}

json levels_json(const paging::PlanetMeta& m) {
  json list = json::array();
  for (const paging::LevelSummary& l : m.levels) {
    json entry{{"level", l.level},
               {"post_spacing_m", lod::post_spacing_m(l.level, m.tile.intervals(), m.radius_m)},
               {"tiles", l.tiles},
               {"finest_tiles", l.leaf_tiles},
               {"image_tiles", l.image_tiles},
               {"bytes", l.bytes},
               {"holes", l.nodata_posts},
               {"resampling_posts", l.resampling.posts}};
    entry["resampling_max_m"] = l.resampling.posts > 0 ? json(l.resampling.max_m) : json();
    entry["resampling_rms_m"] = l.resampling.posts > 0 ? json(l.resampling.rms_m) : json();
    list.push_back(std::move(entry));
  }
  return list;
}

}  // namespace

json planet_json(const paging::PlanetMeta& m) {
  json out{{"body", m.body},
           {"radius_m", m.radius_m},
           {"datum", to_string(m.datum)},
           {"shape", m.shape},
           {"illustration", m.illustration},
           {"tile_intervals", m.tile.intervals()},
           {"height_quantum_m", m.quantum_m},
           {"tiles", m.tiles},
           {"finest_tiles", m.leaf_tiles},
           {"posts", m.leaf_tiles * m.tile.post_count()},
           {"levels", m.finest_level + 1},
           {"finest_post_spacing_m", lod::post_spacing_m(m.finest_level, m.tile.intervals(), m.radius_m)},
           {"lowest_m", m.lowest_radius_m - m.radius_m},
           {"highest_m", m.highest_radius_m - m.radius_m},
           {"image_tiles", m.image_tiles},
           {"resampling_max_m", m.resampling.max_m},
           {"resampling_rms_m", m.resampling.rms_m},
           {"resampling_posts", m.resampling.posts},
           {"by_level", levels_json(m)},
           {"sources", sources_json(m.sources, false)},
           {"image_sources", sources_json(m.image_sources, true)},
           {"image_layers", image_layers_json(m)},
           {"program", m.program},
           {"arguments", m.arguments},
           {"identity", m.identity}};
  if (m.shard) out["part"] = {{"number", m.shard->id.number}, {"of", m.shard->id.of}};
  return out;
}

}  // namespace vpe::app
