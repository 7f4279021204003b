// Draws the last image of the view as the newest camera sees it, until the next image is there.
#pragma once

#include <vector>

#include "vpe/explore/files/preferences.h"
#include "vpe/warp/image_grid.h"
#include "vpe/window/ui/imgui_helpers.h"

struct ImDrawList;

namespace vpe::window {

// Number of cells of an image that follows the camera. More: nearer to the ground's relief, slower.
inline constexpr glm::ivec2 kMovedCells{64, 36};

// Returns true if two views see the same, whatever their size.
bool is_same_sight(const core::View& a, const core::View& b);

// For the main thread. Keeps memory from frame to frame.
class MovedImage {
 public:
  // Adds the image of `texture`, which `grid` describes, to the list as `to` sees it. `to` has the size of `area`. Where the
  // image does not reach, its border is continued. With Warp::kPolynomial all vertices move by fit_motion().
  void draw(ImDrawList& list, void* texture, const ViewArea& area, const warp::ImageGrid& grid,
            const core::View& to, explore::Warp warp);

 private:
  std::vector<warp::MovedVertex> moved_;
};

}  // namespace vpe::window
