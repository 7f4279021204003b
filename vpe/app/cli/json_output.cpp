#include "vpe/app/cli/json_output.h"

#include <cstdio>

namespace vpe::app {

using nlohmann::json;

namespace {

json sources_json(const std::vector<mars::SourceInfo>& sources) {
  json list = json::array();
  for (const mars::SourceInfo& s : sources) {
    json entry{{"name", s.name},           {"size_bytes", s.size_bytes},  {"resolution_m", s.resolution_m},
               {"quantum_m", s.quantum_m}, {"datum", to_string(s.datum)}, {"illustration", s.illustration}};
    entry["treatment"] = s.treatment.empty() ? json() : json(s.treatment);
    entry["accuracy_m"] = s.accuracy_m ? json(*s.accuracy_m) : json();
    list.push_back(std::move(entry));
  }
  return list;
}

json levels_json(const paging::PlanetMeta& m) {
  json list = json::array();
  for (const paging::LevelSummary& l : m.levels) {
    json entry{{"level", l.level + 1},
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

std::string csv_field(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + "\"";
}

json planet_json(const paging::PlanetMeta& m) {
  return {{"body", m.body},
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
          {"sources", sources_json(m.sources)},
          {"image_sources", sources_json(m.image_sources)},
          {"program", m.program},
          {"identity", m.identity}};
}

json stats_json(const core::FrameStats& s) {
  return {{"tiles_visited", s.tiles_visited},
          {"tiles_culled_frustum", s.tiles_culled_frustum},
          {"tiles_culled_horizon", s.tiles_culled_horizon},
          {"tiles_culled_occlusion", s.tiles_culled_occlusion},
          {"tiles_drawn", s.tiles_drawn},
          {"tiles_missing", s.tiles_missing},
          {"tiles_substituted", s.tiles_substituted},
          {"pages_uploaded", s.pages_uploaded},
          {"pages_evicted", s.pages_evicted},
          {"triangles", s.triangles},
          {"skirt_triangles", s.skirt_triangles},
          {"bytes_resident", s.bytes_resident},
          {"tiles_by_level", s.tiles_by_level},
          {"select_ms", s.select_ms},
          {"occlude_ms", s.occlude_ms},
          {"load_ms", s.load_ms},
          {"draw_ms", s.draw_ms},
          {"read_ms", s.read_ms}};
}

void warn_of(std::span<const std::string> failures) {
  for (const std::string& failure : failures) std::fprintf(stderr, "vpe: warning: %s\n", failure.c_str());
}

void print_json(const json& value) {
  std::printf("%s\n", value.dump(2, ' ', false, json::error_handler_t::replace).c_str());
}

void note_illustration(const paging::PlanetMeta& meta, bool quiet) {
  if (meta.illustration && !quiet) {
    std::fprintf(stderr, "Note: this planet is an illustration; its numbers are not data about Mars.\n");
  }
}

}  // namespace vpe::app
