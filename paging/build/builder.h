// Sources -> planet file.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "mars/sources/source.h"
#include "paging/planet/planet_meta.h"
#include "vpe/base/shard.h"

namespace paging {

// Longitude-latitude box, east-positive degrees; west > east crosses the antimeridian.
struct Region {
  double west_deg = -180;
  double south_deg = -90;
  double east_deg = 180;
  double north_deg = 90;
};

// True when a cap touches the region (conservative: may say yes for a near miss).
bool touches(const Region& region, const mars::Cap& cap);

struct BuildOptions {
  std::string output;  // the planet file to make
  std::string body = "Mars";
  double radius_m = mars::kMarsRadius_m;
  bool true_radii = false;       // the sources' heights are counted from the sphere of radius_m
  double base_spacing_m = 3700;  // at least this fine everywhere, so that the surface is round
  double finest_spacing_m = 0;   // not finer than this; 0 = as fine as the sources
  std::vector<Region> regions;   // where to go beyond the base spacing, texels too; empty = wherever sources do
  int tile_k = 7;                // 2^k intervals a tile; docs/simplifiers.md has the measurement
  double quantum_m = 0;          // height step stored; 0 = chosen from the sources (docs/planet-file.md)
  double mesh_ratio = 256;       // a tile's mesh is within side / mesh_ratio of its posts
  double finest_image_m = 0;     // texels not finer than this; 0 = as fine as the image
  int image_quality = 90;        // JPEG
  int threads = 0;               // 0 = all cores
  std::size_t resampling_posts = 4'000'000;  // how many source posts to compare with S at most
  vpe::base::Shard part;                     // only this part of the tiles, into a file for merge_parts
  double commit_s = 1.0;                     // what a killed build may lose, about
};

struct BuildProgress {
  const char* stage = "";
  std::int64_t done = 0;  // tiles of this stage
  std::int64_t total = 0;
  double fraction = 0;    // of the whole build, by measured cost shares
  std::int64_t kept = 0;  // tiles and image tiles that an earlier, stopped build had finished
  bool replaced = false;  // an OUTPUT.part of other options or sources was there, and is gone
};
using ProgressFunction =
    std::function<void(const BuildProgress&)>;  // called from worker threads, one at a time

struct BuildSummary {
  PlanetMeta meta;
  std::int64_t bytes = 0;
  std::int64_t posts = 0;
  std::int64_t mesh_triangles = 0;  // of all stored meshes
  std::int64_t kept = 0;            // as BuildProgress::kept
};

// Builds the planet file: OUTPUT.part first, renamed when complete. Memory is a few tiles a thread plus about
// 600 bytes a tile. Content is a function of the options and sources, whatever the number of threads and
// however often the build was stopped: one that ends early (killed, disk full, an exception of a source or of
// progress()) leaves OUTPUT.part, which the next build with the same options and sources continues. Other
// sources (by name, size and time), options or program versions start anew. image may be null. With
// options.part, the file holds that part of the tiles, is no planet file yet, and PlanetMeta::share is set.
// Throws PlanetError, DatabaseError, mars::SourceError, std::runtime_error (plan too large).
BuildSummary build_planet(const BuildOptions& options, const mars::ElevationSource& elevation,
                          const mars::ImageSource* image, const ProgressFunction& progress = {});

}  // namespace paging
