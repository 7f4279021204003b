// Models of sticks: vertical runs of voxels on a grid, which share a table (Cohen-Or 1996, section 2).
//
// A model is a grid of columns. A column has a stick: runs of voxels, from the foot upwards, each opaque or
// semi-transparent, with gaps between them (cavities). Equal sticks are stored once. Coarser levels halve the grid
// and fill small cavities (build_sticks.h).
//
// Typical usage:
//   const StickModel model = build_sticks(voxels);
//   StickHits hits;
//   model.cast(ray, level, until, hits);
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "objects/model/mesh.h"
#include "objects/model/triangle_tree.h"

namespace objects {

struct StickLimits {
  static constexpr int kMostSide = 4096;  // voxels along an axis
  static constexpr std::size_t kMostColumns = std::size_t{1} << 24;
  static constexpr std::size_t kMostVoxels = std::size_t{1} << 28;  // with a colour of their own
};

// The grid of a level, in the model frame (objects/model/mesh.h).
struct StickGrid {
  int columns_x = 0;
  int columns_y = 0;
  int height = 0;               // voxels
  float voxel_m = 0;            // edge of a voxel
  glm::vec3 corner_m{0, 0, 0};  // the least corner of voxel (0, 0, 0)

  bool operator==(const StickGrid&) const = default;
};

// Colour, opacity and light of a voxel.
struct StickVoxel {
  Rgba colour;  // sRGB; alpha: the share of light, of 255, that a path as long as a voxel's edge takes
  std::int8_t normal[3]{0, 0, 127};  // outward, of length 127

  bool operator==(const StickVoxel&) const = default;
};
static_assert(sizeof(StickVoxel) == 7);

// The kinds of sticks of the paper, cheapest first.
enum class StickKind : std::uint8_t {
  kEmpty,
  kUniform,   // one opaque run of one colour
  kTextured,  // one opaque stretch of several colours, without a gap: a ray climbs it
  kComplex,   // gaps, or semi-transparent runs: rays go on behind
};

// A place where a ray meets opaque voxels.
struct StickHit {
  float t = 0;  // along the ray, in lengths of its direction
  StickVoxel voxel;
  glm::vec3 face{
      0, 0, 1};  // outward normal of the voxel's side; of a ray that begins inside: the one nearest to -ray
  std::array<std::uint16_t, 3> place{0, 0, 0};  // of the voxel in the level's grid
};

// A stretch of a ray in semi-transparent voxels of one colour that follow each other.
struct StickLayer {
  float t = 0;  // where it begins
  float end_t = 0;
  float opacity = 0;  // share of light that it takes, 0 to 1 (Beer and Lambert)
  StickVoxel voxel;   // the first one
};

struct StickHits {
  std::vector<StickLayer> layers;  // from near to far, before the front
  StickHit front;
  bool has_front = false;
};

// The heights between which areas of 8 by 8 columns have voxels, so that rays skip areas.
struct StickBlocks {
  static constexpr int kSide = 8;  // columns
  struct Heights {
    std::uint16_t low = 0;
    std::uint16_t high = 0;  // behind the last voxel; low: there is none
  };
  int blocks_x = 0;
  std::vector<Heights> blocks;      // row by row
  std::array<int, 3> low{0, 0, 0};  // the box of all voxels
  std::array<int, 3> high{0, 0, 0};
};

// Immutable. Any thread may call any member.
class StickModel {
 public:
  struct Run {
    std::uint16_t begin = 0;  // voxels from the foot of the grid
    std::uint16_t length = 0;
    std::uint32_t first_voxel = 0;  // of the level's voxels; uniform runs have one for all
    bool is_uniform = false;
    bool is_opaque = true;  // alpha of the voxels is 255, else 1 to 254

    bool operator==(const Run&) const = default;
  };
  struct Stick {
    StickKind kind = StickKind::kEmpty;
    std::uint16_t runs = 0;
    std::uint32_t first_run = 0;

    bool operator==(const Stick&) const = default;
  };
  struct Level {
    StickGrid grid;
    std::vector<std::uint32_t> columns;  // index into sticks, row by row (x runs fastest); stick 0 is empty
    std::vector<Stick> sticks;           // build_sticks() makes them all different
    std::vector<Run> runs;               // of a stick: ascending, without overlap
    std::vector<StickVoxel> voxels;

    bool operator==(const Level&) const = default;
    std::size_t bytes() const;
  };

  StickModel() = default;
  // Levels run from the finest to the coarsest. Throws std::invalid_argument if check() finds fault with one, or if
  // voxels do not grow from level to level.
  explicit StickModel(std::vector<Level> levels);

  const std::vector<Level>& levels() const { return levels_; }
  // A ball around all voxels of all levels.
  const Ball& ball() const { return ball_; }

  // Finds what a ray meets with t in [0, until) at a level: climbs sticks, skips cavities, collects semi-transparent
  // stretches. `hits` is overwritten; a level that does not exist and a ray that is not finite meet nothing. A ray
  // that begins in an opaque voxel meets it at t = 0; one that leaves a voxel from its side does not meet it. Voxels
  // include their sides, so that no ray passes between two of a common side or edge. A ray that runs in the plane of
  // a side is in the voxel above or to the right of it. The error of t is a rounding of a float, and some 1e-15 times
  // the distance of the origin.
  void cast(const ModelRay& ray, std::size_t level, float until, StickHits& hits) const;

  std::size_t bytes() const;

 private:
  std::vector<Level> levels_;
  std::vector<StickBlocks> blocks_;  // of levels
  Ball ball_;
};

// Returns "" if a level can be cast against, else what is wrong with it: sizes, indices, kinds, order of runs,
// opacities, numbers that are not finite, limits. Pure.
std::string check(const StickModel::Level& level);

}  // namespace objects
