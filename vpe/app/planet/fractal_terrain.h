// Made-up terrain for measurements: a square patch of fine fractal terrain of any size on a coarse planet.
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "lod/tree/tile_key.h"
#include "mars/sources/source.h"
#include "paging/planet/planet_file.h"

namespace vpe::app {

inline constexpr int kPatchTileK = 7;  // tiles of 128 intervals, the default of `vpe build`

// The area of one tile, covered by finest tiles `levels_below` it: 128 * 2^levels_below + 1 posts a side.
struct PatchSpec {
  lod::TileKey patch;
  int levels_below = 0;

  int side_posts() const { return (1 << (kPatchTileK + levels_below)) + 1; }
  int finest_level() const { return patch.level + levels_below; }
  double spacing_m() const;
};

// Octaves of seeded noise as a function of direction: waves from 20 km down to twice the requested spacing,
// each half as long and half as high as the one before, so that tiles of all levels look alike and only their
// number grows with the grid. Slopes are about 7 degrees (RMS). Fine in the patch and in tiles that contain it,
// coarser from level to level elsewhere. The same bits on every machine. Any thread may call any member.
class FractalPatch : public mars::ElevationSource {
 public:
  explicit FractalPatch(const PatchSpec& spec);

  std::vector<mars::SourceInfo> infos() const override;
  void sample(std::span<const glm::dvec3> directions, double spacing_m,
              std::span<double> heights_m) const override;
  void origin(std::span<const glm::dvec3> directions, std::span<int> source_index) const override;
  double spacing_in(const mars::Cap& cap) const override;
  // Visits posts of the patch.
  void visit_posts(std::size_t max_posts, const mars::PostVisitor& visit) const override;

  // Returns the processor time that sample() and visit_posts() took so far, of all threads together. It is not
  // part of the builder's.
  double processor_s() const;

 private:
  PatchSpec spec_;
  mutable std::atomic<std::int64_t> spent_ns_{0};
};

struct PatchBuild {
  std::shared_ptr<const paging::PlanetFile> planet;
  std::int64_t finest_posts = 0;  // of all finest tiles, also outside the patch
  std::int64_t patch_cells = 0;   // of the finest tiles in the patch
  double processor_s = 0;         // without the time for the terrain itself
  double wall_s = 0;
  std::int64_t bytes = 0;
};

// Builds the planet file and replaces an old one. Calls `step` with the fraction that is done; it may throw to
// stop. Throws what paging::build_planet() throws.
PatchBuild build_patch(const PatchSpec& spec, const std::filesystem::path& file, int threads,
                       const std::function<void(double)>& step);

}  // namespace vpe::app
