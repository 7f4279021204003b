// Builds a planet file from elevation and image sources.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "mars/sources/source.h"
#include "paging/build/patch_start.h"
#include "paging/plan/build_plan.h"
#include "paging/planet/planet_meta.h"
#include "vpe/base/shard.h"

namespace paging {

// Describes a longitude-latitude box, east-positive degrees; west > east crosses the antimeridian.
struct Region {
  double west_deg = -180;
  double south_deg = -90;
  double east_deg = 180;
  double north_deg = 90;
};

// Returns true when a cap touches the region. Conservative: may return true for a near miss.
bool touches(const Region& region, const mars::Cap& cap);

struct BuildOptions {
  std::string output;  // the planet file to make
  std::string body = "Mars";
  double radius_m = mars::kMarsRadius_m;
  bool true_radii = false;  // the sources' heights are counted from the sphere of radius_m
  // Coarsest post spacing anywhere, so that the surface is round. Smaller: rounder where sources are coarse,
  // but more tiles; larger: facets of the globe become visible.
  double base_spacing_m = 3700;
  // Finest post spacing; 0 = as fine as the sources. Larger: smaller file, faster build, less detail.
  double finest_spacing_m = 0;
  std::vector<Region> regions;  // where to exceed the base spacing, texels too; empty = wherever sources do
  // 2^k intervals a tile. Larger: fewer, bigger tiles, so less overhead but coarser loading and culling;
  // smaller: the reverse. docs/measurements/simplifiers.md has the measurement.
  int tile_k = 7;
  // Height step stored; 0 = chosen from the sources (docs/design/planet-file.md). Smaller: smoother slopes,
  // larger file; larger: terraces become visible in shading.
  double quantum_m = 0;
  // A tile's mesh is within side / mesh_ratio of its posts. Larger: more triangles a tile and smaller errors;
  // smaller: fewer triangles, and views need deeper tiles.
  double mesh_ratio = 256;
  double finest_image_m = 0;  // texels not finer than this; 0 = as fine as the image
  int image_quality = 90;     // JPEG; larger: larger file, smaller: visible blocks
  int threads = 0;            // 0 = all cores
  // Largest number of source posts that are compared with the reference surface. Smaller: faster, and the
  // resampling error is less certain.
  std::size_t resampling_posts = 4'000'000;
  vpe::base::Shard shard;  // only this shard of the tiles, into a file for merge_shards()
  bool keep_shard = true;  // a finished shard of the same sources and options is kept; false: built again
  // Arguments of a command that opens the same sources. The file keeps them, so that it can be patched.
  std::vector<std::string> arguments;
  // Seconds between commits: about what a killed build may lose. Smaller: loses less, writes more often.
  double commit_s = 1.0;
};

struct BuildProgress {
  const char* stage = "";
  std::int64_t done = 0;  // tiles of this stage
  std::int64_t total = 0;
  double fraction = 0;    // of the whole build, by measured cost shares
  std::int64_t kept = 0;  // tiles and image tiles that an earlier, stopped build had finished
  bool replaced = false;  // OUTPUT.part of other options or sources existed and has been removed
  bool patched = false;   // the tiles that are kept come from the planet that is patched
};
// Called from worker threads, one at a time. May throw to stop.
using ProgressFunction = std::function<void(const BuildProgress&)>;

struct BuildSummary {
  PlanetMeta meta;
  std::int64_t bytes = 0;
  std::int64_t posts = 0;
  std::int64_t mesh_triangles = 0;  // of all stored meshes
  std::int64_t kept = 0;            // as BuildProgress::kept
  bool is_kept_whole = false;       // the shard was there already: nothing was built
};

// Returns the tiles of a build. Reads no more of the source than its footprints. Throws std::runtime_error when
// they are too many.
BuildPlan plan_tiles(const BuildOptions& options, const mars::ElevationSource& elevation);

// Builds the planet file: OUTPUT.part first, renamed when complete. Memory is a few tiles a thread plus about
// 600 bytes a tile. The content is a function of the options and sources. It does not depend on the number of
// threads, nor on how often the build was stopped: a build that ends early (killed, disk full, an exception of
// a source or of progress()) leaves OUTPUT.part, and the next build with the same options and sources
// continues it. Other sources (by name, size, time and samples of their bytes), options or program versions
// start anew.
//
// `image` may be null. `plan` may be what plan_tiles() returned for the same options and source, to save
// planning twice. With options.shard, the file holds that shard of the tiles and is no planet file yet;
// PlanetMeta::shard is set. Such a file that is finished already is kept, see BuildOptions::keep_shard.
//
// Throws PlanetError, DatabaseError, mars::SourceError, std::runtime_error (too many tiles). After
// UnusableSource (source_heights.h) no OUTPUT.part is left.
//
// Typical usage:
//   BuildOptions options;
//   options.output = "mars.vpe";
//   const BuildSummary summary = build_planet(options, *mars::open_elevation("mola.tif"), nullptr);
BuildSummary build_planet(const BuildOptions& options, const mars::ElevationSource& elevation,
                          const mars::ImageSource* image, const ProgressFunction& progress = {},
                          std::optional<BuildPlan> plan = {});

// Builds the same planet file as build_planet() does, but begins with a copy of `patched`, a finished planet file, and
// makes only the tiles in which the planet differs from it: finest tiles where `patched` says that sources changed,
// their surroundings where the spacing changes, and all tiles above these. Identity, and meta but for `arguments`, are
// those of the full build. OUTPUT may be the patched file itself. A patch that is stopped is continued by the next one
// of the same file with the same sources and options.
//
// Throws what build_planet() and plan_patch() throw. Shards cannot be patched.
BuildSummary patch_planet(const BuildOptions& options, const PatchedPlanet& patched,
                          const mars::ElevationSource& elevation, const mars::ImageSource* image,
                          const ProgressFunction& progress = {}, std::optional<BuildPlan> plan = {});

}  // namespace paging
