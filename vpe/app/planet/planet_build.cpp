#include "vpe/app/planet/planet_build.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <utility>

#include "mars/raster/raster_memory.h"
#include "paging/planet/planet_look.h"
#include "vpe/app/cli/figures.h"
#include "vpe/app/cli/interrupt.h"
#include "vpe/app/cli/json_output.h"
#include "vpe/app/cli/output.h"
#include "vpe/app/cli/progress.h"
#include "vpe/app/planet/build_sources.h"
#include "vpe/app/planet/level_table.h"
#include "vpe/app/planet/planet_json.h"
#include "vpe/app/planet/remote_wait.h"
#include "vpe/base/file.h"
#include "vpe/base/number.h"

namespace vpe::app {

namespace {

constexpr double kNotedSagitta_m = 10;

void print_resumption(const std::string& output, const paging::BuildProgress& p) {
  const std::string part = output + ".part";
  if (p.replaced) {
    std::fprintf(stderr, "vpe: %s was made from other sources or options, or is damaged; starting anew\n",
                 part.c_str());
  } else if (p.kept > 0 && !p.patched) {
    std::fprintf(stderr, "Continuing %s\n", part.c_str());
  }
}

// Runs work(progress function) with a line of progress; signals end it.
template <typename Work>
paging::BuildSummary run(const std::string& output, const char* verb, const Common& common, const Work& work) {
  const InterruptGuard guard;
  try {
    ProgressLine line(common.quiet);
    bool first = true;
    return work([&](const paging::BuildProgress& p) {
      InterruptGuard::check();
      if (first && !common.quiet) print_resumption(output, p);
      first = false;
      line.show(std::string(verb) + " (" + p.stage + ")", p.fraction);
    });
  } catch (const std::exception&) {
    std::error_code none;
    if (std::filesystem::exists(output + ".part", none)) {
      std::fprintf(stderr, "vpe: finished work stays in %s.part; the same command continues it\n",
                   output.c_str());
    }
    throw;
  }
}

std::string duration(double seconds) {
  char text[32];
  if (seconds < 90) {
    std::snprintf(text, sizeof text, "%.0f s", seconds);
  } else if (seconds < 5400) {
    std::snprintf(text, sizeof text, "%.0f min", seconds / 60);
  } else {
    std::snprintf(text, sizeof text, "%.1f h", seconds / 3600);
  }
  return text;
}

std::string estimate_text(const paging::BuildEstimate& e) {
  char text[240];
  const std::string layers =
      e.layer_tiles > 0 ? std::to_string(e.layer_tiles) + " tiles of image layers, " : std::string();
  std::snprintf(text, sizeof text,
                "%lld tiles (%lld finest), %lld image tiles, %s%.1f million posts, about %s, about %s",
                static_cast<long long>(e.leaf_tiles + e.inner_tiles), static_cast<long long>(e.leaf_tiles),
                static_cast<long long>(e.image_tiles), layers.c_str(), 1e-6 * static_cast<double>(e.posts),
                bytes_text(static_cast<double>(e.bytes)).c_str(), duration(e.wall_s).c_str());
  return text;
}

void note_own_light(const std::vector<mars::SourceInfo>& images) {
  if (!paging::have_own_light(images)) return;
  std::fprintf(
      stderr,
      "vpe: note: by its label the imagery is a photograph with its own light; it is shown without synthetic light, "
      "also where it has no data; --set light=on lights it\n");
}

}  // namespace

void limit_rasters(const Common& common) {
  watch_remote_reads(common.quiet);
  // Half of --memory: the allocator keeps about a third more than rasters use, and the tile index and scratch
  // memory need the rest.
  mars::set_raster_memory(static_cast<std::size_t>(common.memory_mb) << 19);
}

paging::BuildSummary run_build(paging::BuildOptions options, const mars::ElevationSource& elevation,
                               const mars::ImageSource* image, const Common& common,
                               std::optional<paging::BuildPlan> plan, const paging::PatchedPlanet* patched) {
  limit_rasters(common);
  if (image != nullptr && !common.quiet) {
    for (const mars::SourceInfo& info : image->infos()) {
      for (const std::string& note : info.notes) std::fprintf(stderr, "vpe: note: %s\n", note.c_str());
    }
  }
  if (image != nullptr && !common.quiet) note_own_light(image->infos());
  const auto infos = elevation.infos();
  if (std::any_of(infos.begin(), infos.end(), [](const mars::SourceInfo& s) { return s.illustration; }))
    options.resampling_posts = kSyntheticResamplingPosts;
  return run(options.output, patched != nullptr ? "patching" : "building", common,
             [&](const paging::ProgressFunction& progress) {
               if (patched != nullptr)
                 return paging::patch_planet(options, *patched, elevation, image, progress, std::move(plan));
               return paging::build_planet(options, elevation, image, progress, std::move(plan));
             });
}

void print_estimate(const paging::BuildEstimate& estimate, const Common& common) {
  if (common.quiet) return;
  std::fprintf(stderr, "To build: %s\n", estimate_text(estimate).c_str());
  if (estimate.largest_sagitta_m > kNotedSagitta_m) {
    std::fprintf(
        stderr,
        "vpe: note: the coarsest posts are %s apart, and the flat facets between them lie up to %s below the "
        "sphere through them; a smaller --base-spacing makes them rounder\n",
        length_text(estimate.coarsest_spacing_m).c_str(), length_text(estimate.largest_sagitta_m, 3).c_str());
  }
  const double memory = 1048576.0 * common.memory_mb;
  if (static_cast<double>(estimate.memory_bytes) > memory / 4) {
    std::fprintf(
        stderr,
        "vpe: warning: the index of so many tiles takes %.0f MB beside the rasters' share of --memory; divide "
        "the build with --part\n",
        1e-6 * static_cast<double>(estimate.memory_bytes));
  }
}

void print_estimate_only(const paging::BuildEstimate& e, const Common& common) {
  if (!common.json) {
    std::printf("%s\n", estimate_text(e).c_str());
    return;
  }
  print_json({{"tiles", e.leaf_tiles + e.inner_tiles},
              {"finest_tiles", e.leaf_tiles},
              {"image_tiles", e.image_tiles},
              {"layer_tiles", e.layer_tiles},
              {"posts", e.posts},
              {"bytes", e.bytes},
              {"processor_s", e.processor_s},
              {"wall_s", e.wall_s},
              {"index_bytes", e.memory_bytes}});
}

paging::BuildSummary run_merge(const paging::MergeOptions& options, const Common& common) {
  return run(options.output, "merging", common,
             [&](const paging::ProgressFunction& progress) { return paging::merge_shards(options, progress); });
}

std::string check_planet_file(const std::string& output, const std::vector<std::string>& inputs) {
  check_outputs({{"-o", output, FileKind::kPlanet}}, {inputs.begin(), inputs.end()});
  return base::resolve_links(output).string();
}

void require_same_content(const std::string& output, const paging::PlannedContent& planned) {
  std::string texts;
  for (const std::string& text : paging::differences(output, planned))
    texts += (texts.empty() ? "" : "; ") + text;
  if (texts.empty()) return;
  throw std::runtime_error(output + ": exists and is another planet: " + texts +
                           "; give another name, or --force to replace it");
}

std::string shard_file_name(const std::string& output, const base::Shard& shard) {
  if (shard.is_all()) return output;
  const std::string of = std::to_string(shard.of);
  std::string number = std::to_string(shard.number);
  number.insert(0, of.size() - number.size(), '0');
  std::filesystem::path path(output);
  const std::string extension = path.extension().string();
  path.replace_extension();
  return path.string() + "." + number + "-of-" + of + extension;
}

void print_build(const paging::BuildSummary& summary, const std::string& output, const Common& common,
                 const mars::Combined* combined) {
  const paging::PlanetMeta& meta = summary.meta;
  std::int64_t nodata_posts = 0;
  for (const paging::LevelSummary& level : meta.levels) nodata_posts += level.nodata_posts;
  if (common.json) {
    nlohmann::json json = planet_json(meta);
    json["path"] = output;
    json["bytes"] = summary.bytes;
    json["tiles_kept"] = summary.kept;
    if (combined != nullptr) {
      json["findings"] = findings_json(*combined);
      json["notes"] = combined->notes;
    }
    print_json(json);
    return;
  }
  if (common.quiet) return;
  std::printf("%s: %lld tiles (%lld finest), %.1f million posts, %s\n", output.c_str(),
              static_cast<long long>(meta.tiles), static_cast<long long>(meta.leaf_tiles),
              1e-6 * static_cast<double>(summary.posts),
              bytes_text(static_cast<double>(summary.bytes)).c_str());
  std::printf("resampling error of the whole planet: %s\n", resampling_text(meta.resampling).c_str());
  if (const paging::LevelSummary* finest = finest_measured(meta)) {
    std::printf("resampling error at the finest level, %d: %s\n", finest->level,
                resampling_text(finest->resampling).c_str());
  }
  const double nodata = static_cast<double>(nodata_posts) / static_cast<double>(summary.posts);
  std::printf("nodata posts: %lld (%s %%)\n", static_cast<long long>(nodata_posts),
              base::format_significant(100 * nodata, 3).c_str());
  print_level_table(meta);
  if (meta.shard) {
    std::printf("Part %lld of %lld. When all parts exist, 'vpe merge PART... -o PLANET.vpe' joins them.\n",
                static_cast<long long>(meta.shard->id.number), static_cast<long long>(meta.shard->id.of));
  }
}

}  // namespace vpe::app
