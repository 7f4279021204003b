// Blocks of pixels of the first image that are flat enough to move as one facet. Private to vpe/warp.
//
// Inverse depth is linear over the image of a plane, and the image of a plane moves to another view by a homography. So a
// block whose inverse depths are linear but for a small rest moves as its plane does, with an error that the rest bounds.
// Such blocks are most of an image of ground; the others are carried cell by cell.
#pragma once

#include <glm/vec2.hpp>
#include <span>
#include <vector>

#include "vpe/base/parallel.h"
#include "vpe/warp/carry.h"
#include "vpe/warp/moved_pixels.h"

namespace vpe::warp {

// Largest error of a pixel's position where it moves with the plane of its block, pixels. Larger: more blocks are flat.
inline constexpr double kMostFlat_px = 1.0 / 16;

// Holds a value that is linear in the new image, relative to FlatBlock::origin.
struct Linear {
  float x = 0;
  float y = 0;
  float at_origin = 0;
};

// A flat block as the new camera sees it.
struct FlatBlock {
  // Place in the block, in pixels of the first image: column and row over the divisor, which is positive where the plane is
  // ahead of both cameras.
  Linear column, row, divisor;
  Linear inverse_depth;  // along the new camera's axis
  glm::ivec2 origin{};   // pixel of the new image
  glm::ivec2 low{};      // first pixel of the new image that may show the block
  glm::ivec2 end{};      // past the last one
  glm::ivec2 first{};    // upper left pixel in the first image
  glm::vec2 size{};      // to the lower right one
  float margin =
      0;  // by which the facet is larger on each side, so that none of its neighbours' errors is a crack
  glm::vec2
      column_step{};  // what a column and a row of the first image are in the new one, at the block's middle
  glm::vec2 row_step{};
  bool is_sky = false;
};

// Splits the first image.
class BlockPlan {
 public:
  static constexpr int kLarge = 16;  // cells a side of blocks that are tried first
  static constexpr int kSmall = 8;   // of their quarters, and of rough blocks

  // `pixels` holds the inverse depths of the first image.
  BlockPlan(const Motion& motion, const MovedPixels& pixels, glm::ivec2 new_size, const CarryOptions& options,
            base::ThreadPool& pool);

  // Holds the blocks of a row of large ones.
  struct Row {
    std::vector<FlatBlock> flat;
    std::vector<glm::ivec2> rough;  // upper left pixels of small blocks
    int low = 0;                    // rows of the new image that flat blocks reach
    int end = 0;
  };
  std::span<const Row> rows() const { return rows_; }
  // Returns the largest bound of what flat blocks that are in the new image add to a pixel's position.
  double added_px() const { return added_px_; }

 private:
  std::vector<Row> rows_;
  double added_px_ = 0;
};

}  // namespace vpe::warp
