#include "paging/build/overwrite_check.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <map>

#include "paging/build/build_inputs.h"
#include "paging/build/shard_file.h"
#include "paging/build/shard_plan.h"
#include "paging/planet/sqlite.h"
#include "vpe/base/number.h"

namespace paging {

namespace {

using Texts = std::vector<std::string>;

std::vector<std::int64_t> integers(const Database& db, const char* sql) {
  std::vector<std::int64_t> out;
  Statement rows(db, sql);
  while (rows.step()) out.push_back(rows.integer(0));
  return out;
}

std::string file_name(const mars::SourceInfo& source) {
  return std::filesystem::path(source.name).filename().string();
}

std::string names_of(const std::vector<mars::SourceInfo>& sources) {
  std::string text;
  for (const mars::SourceInfo& s : sources) text += (text.empty() ? "" : ", ") + file_name(s);
  return text.empty() ? "none" : text;
}

std::string names_of(const std::vector<ImageLayer>& layers) {
  std::string text;
  for (const ImageLayer& layer : layers) text += (text.empty() ? "" : ", ") + layer.name;
  return text.empty() ? "none" : text;
}

void compare_sources(const char* what, const std::vector<mars::SourceInfo>& old,
                     const std::vector<mars::SourceInfo>& now, Texts& texts) {
  const auto same_name = [](const auto& a, const auto& b) { return file_name(a) == file_name(b); };
  if (!std::equal(old.begin(), old.end(), now.begin(), now.end(), same_name)) {
    texts.push_back(std::string("its ") + what + " are " + names_of(old) + ", not " + names_of(now));
    return;
  }
  for (std::size_t n = 0; n < old.size(); ++n) {
    const mars::SourceInfo& a = old[n];
    const mars::SourceInfo& b = now[n];
    if (a.size_bytes != b.size_bytes || a.mtime_s != b.mtime_s) {
      texts.push_back(file_name(b) + " has changed since (size or time)");
    } else if (a.treatment != b.treatment || !(a.datum == b.datum)) {
      texts.push_back(file_name(b) + " is interpreted differently");
    }
  }
}

template <typename Value>
void compare(const char* what, const Value& old, const Value& now, Texts& texts) {
  if (old == now) return;
  const auto text = [](const auto& value) {
    if constexpr (std::is_arithmetic_v<std::decay_t<decltype(value)>>) {
      return vpe::base::format_number(static_cast<double>(value));
    } else {
      return value;
    }
  };
  texts.push_back(std::string("its ") + what + " is " + text(old) + ", not " + text(now));
}

void compare_tiles(const char* what, const std::vector<std::int64_t>& old, const std::vector<std::int64_t>& now,
                   const char* options, Texts& texts) {
  if (old == now) return;
  texts.push_back("its " + std::to_string(old.size()) + " " + what + " are not the " +
                  std::to_string(now.size()) + " of this one (" + options + ")");
}

std::string shard_text(const PlanetMeta& meta) {
  if (!meta.shard) return "a whole planet";
  return "part " + std::to_string(meta.shard->id.number) + " of " + std::to_string(meta.shard->id.of);
}

Texts compare_content(const PlanetMeta& meta, const Database& db, const PlannedContent& planned) {
  Texts texts;
  const PlanetMeta& now = planned.meta;
  if (shard_text(meta) != shard_text(now)) return {"it is " + shard_text(meta) + ", not " + shard_text(now)};
  compare("body", meta.body, now.body, texts);
  compare("radius in metres", meta.radius_m, now.radius_m, texts);
  compare("datum", to_string(meta.datum), to_string(now.datum), texts);
  compare("shape", meta.shape, now.shape, texts);
  compare_sources("elevation sources", meta.sources, now.sources, texts);
  compare_sources("image sources", meta.image_sources, now.image_sources, texts);
  compare("image layers", names_of(meta.image_layers), names_of(now.image_layers), texts);
  if (texts.empty()) {
    compare("height step in metres", meta.quantum_m, now.quantum_m, texts);
    compare("mean height in metres", meta.fill_m, now.fill_m, texts);
  }
  compare_tiles("finest tiles", integers(db, "SELECT key FROM node WHERE NOT inner ORDER BY key"),
                planned.leaves, "--region, --spacing, --base-spacing", texts);
  compare_tiles("image tiles", integers(db, "SELECT key FROM image ORDER BY key"), planned.images,
                "--image, --region", texts);
  return texts;
}

}  // namespace

PlannedContent planned_content(const BuildOptions& options, const BuildPlan& plan,
                               const mars::ElevationSource& elevation, const mars::ImageSource* image) {
  PlannedContent out;
  out.meta = describe_planet(options, elevation, image);
  if (!options.shard.is_all()) out.meta.shard = ShardMeta{options.shard, options.mesh_ratio, {}};
  for (const lod::TileKey& key : shard_plan(plan, options.shard).leaves) out.leaves.push_back(lod::pack(key));
  if (image != nullptr) {
    const std::vector<lod::TileKey> keys = plan_images(options, *image);
    const auto count = static_cast<std::int64_t>(keys.size());
    for (std::int64_t n = options.shard.begin(count); n < options.shard.end(count); ++n)
      out.images.push_back(lod::pack(keys[static_cast<std::size_t>(n)]));
  }
  std::sort(out.leaves.begin(), out.leaves.end());
  std::sort(out.images.begin(), out.images.end());
  return out;
}

PlannedContent planned_content(const std::vector<std::string>& shards) {
  PlannedContent out;
  for (const std::string& path : shards) {
    const ShardFile shard(path);
    out.meta = shard.meta();
    for (const NodeRow& row : shard.nodes()) {
      if (!row.inner) out.leaves.push_back(row.key);
    }
    for (const std::int64_t key : shard.image_keys()) out.images.push_back(key);
  }
  out.meta.shard.reset();
  std::sort(out.leaves.begin(), out.leaves.end());
  std::sort(out.images.begin(), out.images.end());
  return out;
}

std::vector<std::string> differences(const std::string& path, const PlannedContent& planned) {
  try {
    const Database db(path, Database::Mode::kReadOnly);
    std::map<std::string, std::string> rows;
    Statement all(db, "SELECT key, value FROM meta");
    while (all.step()) rows[all.text(0)] = all.text(1);
    const std::string& format = rows["format"];
    if (std::atoi(format.c_str()) > kFormatMajor)
      return {"its format, " + format + ", is of a newer version of vpe"};
    return compare_content(from_rows(rows, path), db, planned);
  } catch (const PlanetError&) {
    return {};
  } catch (const DatabaseError& e) {
    if (e.code() == SQLITE_CORRUPT || e.code() == SQLITE_NOTADB || e.code() == SQLITE_ERROR) return {};
    throw;
  }
}

}  // namespace paging
