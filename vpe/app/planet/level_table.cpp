#include "vpe/app/planet/level_table.h"

#include <algorithm>
#include <cstdio>

#include "vpe/app/cli/figures.h"
#include "vpe/base/number.h"

namespace vpe::app {

namespace {

using base::format_significant;

// Metres, in the columns of the table.
std::string cell(double value_m) {
  constexpr int kDigits = 4;
  return format_significant(value_m, kDigits);
}

}  // namespace

void print_level_table(const paging::PlanetMeta& meta) {
  std::printf("%-6s %9s %9s %9s %9s %10s %12s %9s %11s\n", "level", "posts, m", "tiles", "finest", "images",
              "MB", "nodata", "RMS, m", "maximum, m");
  bool has_images_alone = false;
  for (const paging::LevelSummary& l : meta.levels) {
    const bool is_measured = l.resampling.posts > 0;
    has_images_alone = has_images_alone || (l.tiles == 0 && l.image_tiles > 0);
    std::printf("%-6d %9s %9lld %9lld %9lld %10s %12lld %9s %11s\n", l.level,
                cell(lod::post_spacing_m(l.level, meta.tile.intervals(), meta.radius_m)).c_str(),
                static_cast<long long>(l.tiles), static_cast<long long>(l.leaf_tiles),
                static_cast<long long>(l.image_tiles),
                base::format_fixed(1e-6 * static_cast<double>(l.bytes), 1).c_str(),
                static_cast<long long>(l.nodata_posts), is_measured ? cell(l.resampling.rms_m).c_str() : "-",
                is_measured ? cell(l.resampling.max_m).c_str() : "-");
  }
  if (has_images_alone)
    std::printf("Levels without tiles hold imagery that is finer than the ground below it.\n");
}

std::string resampling_text(const paging::ResamplingError& resampling) {
  return "RMS " + length_text(resampling.rms_m) + ", maximum " + length_text(resampling.max_m) + " (" +
         std::to_string(resampling.posts) + " source posts)";
}

const paging::LevelSummary* finest_measured(const paging::PlanetMeta& meta) {
  const auto measured = [](const paging::LevelSummary& l) { return l.resampling.posts > 0; };
  if (std::ranges::count_if(meta.levels, measured) < 2) return nullptr;
  return &*std::find_if(meta.levels.rbegin(), meta.levels.rend(), measured);
}

}  // namespace vpe::app
