#include "paging/planet/planet_meta.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>

#include "paging/planet/codec.h"
#include "vpe/base/json_integer.h"
#include "vpe/base/number.h"
#include "vpe/core/json_text.h"

namespace paging {

using nlohmann::json;
using vpe::base::json_integer;

const char* const kSchema = R"sql(
CREATE TABLE meta(key TEXT PRIMARY KEY, value TEXT NOT NULL) WITHOUT ROWID;
CREATE TABLE node(key INTEGER PRIMARY KEY, face INTEGER, level INTEGER, i INTEGER, j INTEGER,
  min_m REAL, max_m REAL, slope REAL, inner INTEGER, steps INTEGER, sources TEXT, checksum INTEGER);
CREATE TABLE variant(key INTEGER, variant INTEGER, relief_m REAL, sag_m REAL, total_m REAL, triangles INTEGER,
  PRIMARY KEY(key, variant)) WITHOUT ROWID;
CREATE TABLE posts_error(key INTEGER PRIMARY KEY, relief_m REAL, sag_m REAL, total_m REAL, checksum INTEGER);
CREATE TABLE heights(key INTEGER PRIMARY KEY, checksum INTEGER, data BLOB);
CREATE TABLE missing(key INTEGER PRIMARY KEY, checksum INTEGER, data BLOB);
CREATE TABLE origin(key INTEGER PRIMARY KEY, checksum INTEGER, data BLOB);
CREATE TABLE resampling(key INTEGER, source INTEGER, posts INTEGER, max_m REAL, rms_m REAL, checksum INTEGER,
  PRIMARY KEY(key, source)) WITHOUT ROWID;
CREATE TABLE mesh(id INTEGER PRIMARY KEY, key INTEGER, variant INTEGER, checksum INTEGER, data BLOB);
CREATE UNIQUE INDEX mesh_key ON mesh(key, variant);
CREATE TABLE image(key INTEGER PRIMARY KEY, checksum INTEGER, data BLOB);
CREATE INDEX image_keys ON image(key);
)sql";
const char* const kLayerSchema = R"sql(
CREATE TABLE image_layer(id INTEGER PRIMARY KEY, layer INTEGER, key INTEGER, checksum INTEGER, data BLOB);
CREATE UNIQUE INDEX image_layer_key ON image_layer(layer, key);
)sql";

namespace {

constexpr int kMinorWithoutLayers = 4;  // so that their files are the same as before

json to_json(const mars::SourceInfo& s) {
  json j{{"name", s.name},
         {"size_bytes", s.size_bytes},
         {"mtime_s", s.mtime_s},
         {"resolution_m", s.resolution_m},
         {"quantum_m", s.quantum_m},
         {"datum", to_string(s.datum)},
         {"illustration", s.illustration}};
  j["accuracy_m"] = s.accuracy_m ? json(*s.accuracy_m) : json();
  if (s.body_radius_m > 0) j["body_radius_m"] = s.body_radius_m;
  if (!s.treatment.empty()) j["treatment"] = s.treatment;
  if (!s.content.empty()) j["content"] = s.content;
  // Files of sources without it stay as they were.
  if (s.has_own_light) j["own_light"] = true;
  return j;
}

// The first files of format 1 have an empty text for images.
mars::VerticalDatum datum_from(const std::string& text, double radius_m) {
  if (text.empty()) return {};
  const auto datum = mars::parse_datum(text, radius_m);
  if (!datum) throw std::invalid_argument("datum '" + text + "'");
  return *datum;
}

mars::SourceInfo source_from(const json& j, double radius_m) {
  mars::SourceInfo s;
  s.name = j.at("name").get<std::string>();
  s.size_bytes = json_integer<std::int64_t>(j.at("size_bytes"));
  s.mtime_s = json_integer<std::int64_t>(j.at("mtime_s"));
  s.resolution_m = j.at("resolution_m").get<double>();
  s.quantum_m = j.at("quantum_m").get<double>();
  s.datum = datum_from(j.at("datum").get<std::string>(), radius_m);
  s.illustration = j.at("illustration").get<bool>();
  if (!j.at("accuracy_m").is_null()) s.accuracy_m = j.at("accuracy_m").get<double>();
  s.body_radius_m = j.value("body_radius_m", 0.0);
  s.treatment = j.value("treatment", std::string());
  s.content = j.value("content", std::string());
  s.has_own_light = j.value("own_light", false);
  return s;
}

json to_json(const std::vector<mars::SourceInfo>& sources) {
  json list = json::array();
  for (const auto& s : sources) list.push_back(to_json(s));
  return list;
}

std::vector<mars::SourceInfo> sources_from(const json& list, double radius_m) {
  std::vector<mars::SourceInfo> sources;
  for (const auto& s : list) sources.push_back(source_from(s, radius_m));
  return sources;
}

auto tie(const mars::SourceInfo& s) {
  return std::tie(s.name, s.size_bytes, s.mtime_s, s.resolution_m, s.quantum_m, s.accuracy_m, s.illustration,
                  s.body_radius_m, s.treatment, s.content, s.has_own_light);
}

bool equal(const std::vector<mars::SourceInfo>& a, const std::vector<mars::SourceInfo>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const auto& x, const auto& y) { return tie(x) == tie(y) && x.datum == y.datum; });
}

json to_json(const std::vector<ImageLayer>& layers) {
  json list = json::array();
  for (const ImageLayer& layer : layers) {
    list.push_back({{"name", layer.name},
                    {"source", layer.source},
                    {"finest_level", layer.finest_level},
                    {"tiles", layer.tiles},
                    {"bytes", layer.bytes}});
  }
  return list;
}

// The layers of a file are named by people, in settings.
std::vector<ImageLayer> layers_from(const json& list, std::size_t sources) {
  std::vector<ImageLayer> layers;
  for (const json& j : list) {
    ImageLayer layer;
    layer.name = j.at("name").get<std::string>();
    layer.source = json_integer<int>(j.at("source"));
    layer.finest_level = json_integer<int>(j.at("finest_level"));
    layer.tiles = json_integer<std::int64_t>(j.at("tiles"));
    layer.bytes = json_integer<std::int64_t>(j.at("bytes"));
    if (layer.name.empty() || std::ranges::find(layers, layer.name, &ImageLayer::name) != layers.end())
      throw std::invalid_argument("two layers '" + layer.name + "'");
    if (layer.source < 0 || layer.source >= static_cast<int>(sources))
      throw std::invalid_argument("no such source");
    layers.push_back(std::move(layer));
  }
  return layers;
}

// Covers all other rows, including those of later minor formats.
std::string meta_checksum(const std::map<std::string, std::string>& rows) {
  Bytes bytes;
  for (const auto& [key, value] : rows) {
    if (key == kMetaChecksumKey) continue;
    for (const std::string* part : {&key, &value}) {
      bytes.insert(bytes.end(), part->begin(), part->end());
      bytes.push_back(0);
    }
  }
  return std::to_string(paging::checksum(0, bytes));
}

void check_ranges(const PlanetMeta& m, const std::string& path) {
  const bool sane = std::isfinite(m.radius_m) && m.radius_m >= kMinRadius_m && m.radius_m < kMaxRadius_m &&
                    m.tile.k >= 3 && m.tile.k <= 7 && std::isfinite(m.quantum_m) && m.quantum_m > 0.0 &&
                    std::isfinite(m.fill_m) && std::isfinite(m.lowest_radius_m) &&
                    std::isfinite(m.highest_radius_m) && (m.shape == "sphere" || m.shape == "radius");
  if (!sane)
    throw PlanetError(path + ": damaged: a value of the table meta is out of range; build the file again");
}

}  // namespace

bool is_planet_file(const std::string& path) {
  // "The Database Header" of the SQLite file format: the application_id is big-endian, at byte 68.
  constexpr std::string_view kBegin("SQLite format 3\0", 16);
  constexpr std::size_t kAt = 68;
  std::array<char, kAt + 4> head{};
  std::ifstream file(path, std::ios::binary);
  if (!file.read(head.data(), head.size()) || !std::string_view(head.data(), head.size()).starts_with(kBegin))
    return false;
  std::uint32_t id = 0;
  for (std::size_t n = kAt; n < head.size(); ++n) id = id << 8U | static_cast<std::uint8_t>(head[n]);
  return id == static_cast<std::uint32_t>(kApplicationId);
}

bool PlanetMeta::operator==(const PlanetMeta& o) const {
  return body == o.body && radius_m == o.radius_m && datum == o.datum && shape == o.shape &&
         tile.k == o.tile.k && quantum_m == o.quantum_m && fill_m == o.fill_m && equal(sources, o.sources) &&
         equal(image_sources, o.image_sources) && image_layers == o.image_layers &&
         resampling.max_m == o.resampling.max_m && resampling.rms_m == o.resampling.rms_m &&
         resampling.posts == o.resampling.posts && lowest_radius_m == o.lowest_radius_m &&
         highest_radius_m == o.highest_radius_m && leaf_tiles == o.leaf_tiles && tiles == o.tiles &&
         image_tiles == o.image_tiles && finest_level == o.finest_level &&
         finest_image_level == o.finest_image_level && program == o.program && identity == o.identity &&
         illustration == o.illustration && build_settings == o.build_settings && arguments == o.arguments &&
         levels == o.levels && shard == o.shard;
}

std::map<std::string, std::string> to_rows(const PlanetMeta& m) {
  // json writes doubles with the fewest digits that read back to the same bits, whatever the locale.
  std::map<std::string, std::string> rows{
      {"format", std::to_string(kFormatMajor) + "." +
                     std::to_string(m.image_layers.empty() ? kMinorWithoutLayers : kFormatMinor)},
      {"body", m.body},
      {"radius_m", json(m.radius_m).dump()},
      {"datum", to_string(m.datum)},
      {"shape", m.shape},
      {"tile_k", std::to_string(m.tile.k)},
      {"quantum_m", json(m.quantum_m).dump()},
      {"fill_m", json(m.fill_m).dump()},
      {"sources", vpe::core::json_text(to_json(m.sources))},
      {"image_sources", vpe::core::json_text(to_json(m.image_sources))},
      {"resampling_max_m", json(m.resampling.max_m).dump()},
      {"resampling_rms_m", json(m.resampling.rms_m).dump()},
      {"resampling_posts", std::to_string(m.resampling.posts)},
      {"lowest_radius_m", json(m.lowest_radius_m).dump()},
      {"highest_radius_m", json(m.highest_radius_m).dump()},
      {"leaf_tiles", std::to_string(m.leaf_tiles)},
      {"tiles", std::to_string(m.tiles)},
      {"image_tiles", std::to_string(m.image_tiles)},
      {"finest_level", std::to_string(m.finest_level)},
      {"finest_image_level", std::to_string(m.finest_image_level)},
      {"program", m.program},
      {"identity", m.identity},
      {"illustration", m.illustration ? "true" : "false"}};
  if (!m.build_settings.empty()) rows[kBuildSettingsKey] = m.build_settings;
  if (!m.arguments.empty()) rows[kArgumentsKey] = vpe::core::json_text(json(m.arguments));
  if (!m.levels.empty()) rows["levels"] = to_text(m.levels);
  if (!m.image_layers.empty()) rows["image_layers"] = vpe::core::json_text(to_json(m.image_layers));
  if (m.shard) rows["part"] = to_text(*m.shard);
  rows[kMetaChecksumKey] = meta_checksum(rows);
  return rows;
}

PlanetMeta from_rows(const std::map<std::string, std::string>& rows, const std::string& path) {
  const auto text = [&](const char* key) -> const std::string& {
    const auto at = rows.find(key);
    if (at == rows.end()) {
      throw PlanetError(path + ": incomplete planet file: meta has no '" + key + "'; build it again");
    }
    return at->second;
  };
  const std::string& format = text("format");
  const int major = std::atoi(format.c_str());
  if (major < 1) throw PlanetError(path + ": damaged: meta.format is '" + format + "'; build the file again");
  if (major > kFormatMajor) {
    throw PlanetError(path + ": planet file format " + format + " is newer than this program reads (" +
                      std::to_string(kFormatMajor) + ".x); update vpe");
  }
  if (text(kMetaChecksumKey) != meta_checksum(rows)) {
    throw PlanetError(path + ": damaged: the table meta has a wrong checksum; build the file again");
  }
  PlanetMeta m;
  const char* current = "";
  try {
    const auto value = [&](const char* key) {
      current = key;
      return json::parse(text(key));
    };
    m.body = text("body");
    m.radius_m = value("radius_m").get<double>();
    current = "datum";
    m.datum = datum_from(text("datum"), m.radius_m);
    m.shape = text("shape");
    m.tile.k = json_integer<int>(value("tile_k"));
    m.quantum_m = value("quantum_m").get<double>();
    m.fill_m = value("fill_m").get<double>();
    m.sources = sources_from(value("sources"), m.radius_m);
    m.image_sources = sources_from(value("image_sources"), m.radius_m);
    m.resampling.max_m = value("resampling_max_m").get<double>();
    m.resampling.rms_m = value("resampling_rms_m").get<double>();
    m.resampling.posts = json_integer<std::int64_t>(value("resampling_posts"));
    m.lowest_radius_m = value("lowest_radius_m").get<double>();
    m.highest_radius_m = value("highest_radius_m").get<double>();
    m.leaf_tiles = json_integer<std::int64_t>(value("leaf_tiles"));
    m.tiles = json_integer<std::int64_t>(value("tiles"));
    m.image_tiles = json_integer<std::int64_t>(value("image_tiles"));
    m.finest_level = json_integer<int>(value("finest_level"));
    m.finest_image_level = json_integer<int>(value("finest_image_level"));
    m.program = text("program");
    m.identity = text("identity");
    m.illustration = value("illustration").get<bool>();
    if (rows.contains(kBuildSettingsKey)) m.build_settings = text(kBuildSettingsKey);
    if (rows.contains(kArgumentsKey)) m.arguments = value(kArgumentsKey).get<std::vector<std::string>>();
    if (rows.contains("image_layers"))
      m.image_layers = layers_from(value("image_layers"), m.image_sources.size());
    current = "levels";
    if (rows.contains("levels")) m.levels = levels_from_text(text("levels"));
    current = "part";
    if (rows.contains("part")) m.shard = shard_from_text(text("part"));
  } catch (const json::exception& e) {
    throw PlanetError(path + ": damaged: meta '" + current + "': " + e.what() + "; build the file again");
  } catch (const std::invalid_argument& e) {
    throw PlanetError(path + ": damaged: meta '" + current + "': " + e.what() + "; build the file again");
  }
  check_ranges(m, path);
  return m;
}

std::optional<std::vector<int>> source_indices(const std::string& sources) {
  std::vector<int> numbers;
  for (std::size_t begin = 0; begin < sources.size();) {
    const std::size_t end = std::min(sources.find(',', begin), sources.size());
    const auto number = vpe::base::parse_integer(std::string_view(sources).substr(begin, end - begin));
    if (!number || *number < 0 || *number > std::numeric_limits<int>::max()) return std::nullopt;
    numbers.push_back(static_cast<int>(*number));
    begin = end + 1;
  }
  return numbers;
}

namespace {

void put(Bytes& bytes, double value) {
  std::uint64_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  for (int shift = 0; shift < 64; shift += 8) bytes.push_back(static_cast<std::uint8_t>(bits >> shift));
}

}  // namespace

std::int64_t checksum(const NodeRow& row) {
  Bytes bytes;
  const auto put = [&bytes](double value) { paging::put(bytes, value); };
  put(row.min_m);
  put(row.max_m);
  put(row.slope);
  put(row.inner ? 1.0 : 0.0);
  put(row.coarser_neighbour_mask);
  for (const char c : row.sources) bytes.push_back(static_cast<std::uint8_t>(c));
  for (const lod::MeshVariant& v : row.variants) {
    put(v.terms.height_error_m);
    put(v.terms.sagitta_m);
    put(v.terms.total_m);
    put(v.triangles);
  }
  return checksum(row.key, bytes);
}

std::int64_t posts_checksum(const NodeRow& row) {
  const lod::ErrorTerms& terms = row.posts_terms.value();
  Bytes bytes;
  for (const double value : {terms.height_error_m, terms.sagitta_m, terms.total_m}) put(bytes, value);
  return checksum(row.key, bytes);
}

}  // namespace paging
