#include "paging/planet/planet_summary.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "paging/planet/planet_meta.h"
#include "vpe/base/json_integer.h"

namespace paging {

using nlohmann::json;
using vpe::base::json_integer;

namespace {

__extension__ using Wide = unsigned __int128;

constexpr double kUnit_m = 0x1p-20;
constexpr double kLargest_m = 0x1p22;

Wide wide(const ResamplingSum& sum) { return Wide{sum.high} << 64 | Wide{sum.low}; }

json error_json(const ResamplingError& error) {
  return {
      {"resampling_max_m", error.max_m}, {"resampling_rms_m", error.rms_m}, {"resampling_posts", error.posts}};
}

ResamplingError error_from(const json& j) {
  return {j.at("resampling_max_m").get<double>(), j.at("resampling_rms_m").get<double>(),
          json_integer<std::int64_t>(j.at("resampling_posts"))};
}

void set(ResamplingSum& sum, Wide squares) {
  sum.high = static_cast<std::uint64_t>(squares >> 64);
  sum.low = static_cast<std::uint64_t>(squares);
}

}  // namespace

void ResamplingSum::add(double deviation_m) {
  max_m = std::max(max_m, deviation_m);
  ++posts;
  const auto units = static_cast<std::uint64_t>(std::llround(std::min(deviation_m, kLargest_m) / kUnit_m));
  set(*this, wide(*this) + Wide{units} * units);
}

void ResamplingSum::include(const ResamplingSum& other) {
  max_m = std::max(max_m, other.max_m);
  posts += other.posts;
  set(*this, wide(*this) + wide(other));
}

ResamplingError ResamplingSum::error() const {
  if (posts == 0) return {};
  const double squares = std::ldexp(static_cast<double>(high), 64) + static_cast<double>(low);
  return {max_m, kUnit_m * std::sqrt(squares / static_cast<double>(posts)), posts};
}

ResamplingSum sum_of(const ResamplingError& error) {
  ResamplingSum sum;
  sum.max_m = error.max_m;
  sum.posts = error.posts;
  const double units = std::min(error.rms_m, kLargest_m) / kUnit_m;
  set(sum, static_cast<Wide>(units * units * static_cast<double>(error.posts)));
  return sum;
}

bool ShardMeta::operator==(const ShardMeta& o) const {
  return id.number == o.id.number && id.of == o.id.of && mesh_ratio == o.mesh_ratio &&
         resampling == o.resampling;
}

void set_resampling(PlanetMeta& meta, const ResamplingSums& sums) {
  ResamplingSum all;
  std::map<int, ResamplingSum> by_level;
  std::map<int, std::vector<SourceResampling>> by_source;
  for (const auto& [place, sum] : sums) {
    const auto [level, source] = place;
    all.include(sum);
    by_level[level].include(sum);
    if (source >= 0) by_source[level].push_back({source, sum.error()});
  }
  meta.resampling = all.error();
  for (LevelSummary& level : meta.levels) {
    level.resampling = by_level[level.level].error();
    level.resampling_by_source = by_source[level.level];
  }
}

std::string to_text(const std::vector<LevelSummary>& levels) {
  json list = json::array();
  for (const LevelSummary& l : levels) {
    json& level = list.emplace_back(error_json(l.resampling));
    level.update({{"level", l.level},
                  {"tiles", l.tiles},
                  {"leaf_tiles", l.leaf_tiles},
                  {"image_tiles", l.image_tiles},
                  {"bytes", l.bytes},
                  {"holes", l.nodata_posts}});
    for (const SourceResampling& own : l.resampling_by_source) {
      json& entry = level["by_source"].emplace_back(error_json(own.error));
      entry["source"] = own.source;
    }
  }
  return list.dump();
}

std::vector<LevelSummary> levels_from_text(const std::string& text) {
  std::vector<LevelSummary> levels;
  for (const json& j : json::parse(text)) {
    LevelSummary l;
    l.level = json_integer<int>(j.at("level"));
    l.tiles = json_integer<std::int64_t>(j.at("tiles"));
    l.leaf_tiles = json_integer<std::int64_t>(j.at("leaf_tiles"));
    l.image_tiles = json_integer<std::int64_t>(j.at("image_tiles"));
    l.bytes = json_integer<std::int64_t>(j.at("bytes"));
    l.nodata_posts = json_integer<std::int64_t>(j.at("holes"));
    l.resampling = error_from(j);
    if (j.contains("by_source")) {
      for (const json& own : j.at("by_source"))
        l.resampling_by_source.push_back({json_integer<int>(own.at("source")), error_from(own)});
    }
    levels.push_back(l);
  }
  return levels;
}

std::string to_text(const ShardMeta& shard) {
  json sums = json::array();
  for (const auto& [place, s] : shard.resampling)
    sums.push_back({place.first, place.second, s.max_m, s.posts, s.high, s.low});
  return json{{"number", shard.id.number},
              {"of", shard.id.of},
              {"mesh_ratio", shard.mesh_ratio},
              {"resampling_by_source", std::move(sums)}}
      .dump();
}

ShardMeta shard_from_text(const std::string& text) {
  const json j = json::parse(text);
  ShardMeta shard;
  shard.id = {json_integer<std::int64_t>(j.at("number")), json_integer<std::int64_t>(j.at("of"))};
  shard.mesh_ratio = j.at("mesh_ratio").get<double>();
  const auto sum_from = [](const json& s, std::size_t at) {
    return ResamplingSum{s.at(at).get<double>(), json_integer<std::int64_t>(s.at(at + 1)),
                         json_integer<std::uint64_t>(s.at(at + 2)), json_integer<std::uint64_t>(s.at(at + 3))};
  };
  if (j.contains("resampling_by_source")) {
    for (const json& s : j.at("resampling_by_source"))
      shard.resampling[{json_integer<int>(s.at(0)), json_integer<int>(s.at(1))}] = sum_from(s, 2);
  } else {  // before format 1.3: by level, from 0 on
    int level = 0;
    for (const json& s : j.at("resampling")) shard.resampling[{level++, -1}] = sum_from(s, 0);
  }
  return shard;
}

}  // namespace paging
