#include "paging/planet/tile_sources.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "paging/planet/planet_database.h"
#include "paging/planet/planet_file.h"

namespace paging {

std::optional<int> TileSources::at(std::size_t post) const {
  if (post < of_post.size()) {
    const std::size_t number = of_post[post];
    if (number == 0) return std::nullopt;
    return of_tile.at(number - 1);
  }
  if (of_tile.size() == 1) return of_tile.front();
  return std::nullopt;
}

std::size_t TileSources::bytes() const {
  return sizeof(TileSources) + of_tile.capacity() * sizeof(int) + of_post.capacity() * sizeof(std::uint16_t) +
         resampling.capacity() * sizeof(SourceResampling);
}

Bytes encode_origin(std::span<const int> source_of_post, const std::vector<int>& of_tile) {
  if (of_tile.size() < 2) return {};
  std::vector<std::uint16_t> numbers(source_of_post.size());
  for (std::size_t n = 0; n < numbers.size(); ++n) {
    if (source_of_post[n] < 0) continue;
    const auto at = std::lower_bound(of_tile.begin(), of_tile.end(), source_of_post[n]);
    numbers[n] = static_cast<std::uint16_t>(at - of_tile.begin() + 1);
  }
  return encode_numbers(numbers);
}

std::int64_t checksum(const TileResampling& row) {
  Bytes bytes;
  const auto put = [&](double value) {
    std::uint64_t bits = 0;
    std::memcpy(&bits, &value, sizeof bits);
    for (int shift = 0; shift < 64; shift += 8) bytes.push_back(static_cast<std::uint8_t>(bits >> shift));
  };
  put(row.of.source);
  put(static_cast<double>(row.of.error.posts));
  put(row.of.error.max_m);
  put(row.of.error.rms_m);
  return checksum(row.key, bytes);
}

std::vector<TileResampling> read_resampling(const Database& db) {
  std::vector<TileResampling> out;
  if (!has_table(db, "resampling")) return out;
  Statement rows(db, "SELECT key, source, posts, max_m, rms_m, checksum FROM resampling ORDER BY key, source");
  while (rows.step()) {
    const TileResampling row{
        rows.integer(0), {static_cast<int>(rows.integer(1)), {rows.real(3), rows.real(4), rows.integer(2)}}};
    if (checksum(row) != rows.integer(5)) {
      throw PlanetError(db.path() + ": damaged: the table resampling is wrong at row " +
                        std::to_string(row.key) + "; build it again");
    }
    out.push_back(row);
  }
  return out;
}

std::string wrong_resampling(const PlanetFile& planet, const Database& db) {
  const PlanetMeta& meta = planet.meta();
  struct Total {
    double max_m = 0;
    double squares_m2 = 0;
    std::int64_t posts = 0;
  };
  std::map<std::pair<int, int>, Total> found;
  for (const TileResampling& row : read_resampling(db)) {
    const auto key = lod::unpack(row.key);
    const lod::TileInfo* tile = key ? planet.tree().find(*key) : nullptr;
    const ResamplingError& e = row.of.error;
    if (tile == nullptr || tile->has_children || row.of.source < 0 ||
        row.of.source >= static_cast<int>(meta.sources.size()) || e.posts <= 0 || !std::isfinite(e.max_m) ||
        !(e.rms_m >= 0 && e.rms_m <= e.max_m * (1 + 1e-6) + 1e-6)) {
      return "row " + std::to_string(row.key) + " cannot be true";
    }
    Total& total = found[{key->level, row.of.source}];
    total.max_m = std::max(total.max_m, e.max_m);
    total.squares_m2 += e.rms_m * e.rms_m * static_cast<double>(e.posts);
    total.posts += e.posts;
  }
  std::size_t stated = 0;
  for (const LevelSummary& level : meta.levels) {
    std::int64_t posts = 0;
    for (const SourceResampling& own : level.resampling_by_source) {
      const auto at = found.find({level.level, own.source});
      ++stated;
      posts += own.error.posts;
      if (at == found.end() || at->second.max_m != own.error.max_m || at->second.posts != own.error.posts ||
          std::abs(std::sqrt(at->second.squares_m2 / static_cast<double>(own.error.posts)) - own.error.rms_m) >
              1e-6 * own.error.rms_m) {
        return "its rows of level " + std::to_string(level.level) + " differ from meta 'levels'";
      }
    }
    if (!level.resampling_by_source.empty() && posts != level.resampling.posts)
      return "level " + std::to_string(level.level) + " of meta 'levels' has not the posts of its sources";
  }
  return stated == found.size() ? "" : "it has rows of levels or sources that meta 'levels' does not have";
}

}  // namespace paging
