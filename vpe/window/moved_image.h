// Draws the last image of the view as the newest camera sees it, until the next image is there.
#pragma once

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "vpe/core/frame.h"
#include "vpe/explore/files/preferences.h"
#include "vpe/warp/carry.h"
#include "vpe/warp/image_grid.h"
#include "vpe/window/ui/display.h"
#include "vpe/window/ui/imgui_helpers.h"

struct ImDrawList;

namespace vpe::window {

// Number of cells of an image that follows the camera. More: nearer to the ground's relief, slower.
inline constexpr glm::ivec2 kMovedCells{64, 36};

// Returns true if two views see the same, whatever their size.
bool is_same_sight(const core::View& a, const core::View& b);

// A rectangle of a texture, in shares of its sides.
struct TexturePart {
  void* texture = nullptr;  // ImTextureID
  glm::vec2 low{0, 0};
  glm::vec2 size{1, 1};
};

// For the main thread. Keeps memory from frame to frame.
class MovedImage {
 public:
  // Adds an image, the part of a texture that `grid` describes, to the list as `to` sees it. `to` has the size of `area`. Where the
  // image does not reach, its border is continued. With Warp::kPolynomial all vertices move by fit_motion().
  void draw(ImDrawList& list, const TexturePart& image, const ViewArea& area, const warp::ImageGrid& grid,
            const core::View& to, explore::Warp warp);

  // Takes an image with its ranges for draw_carried(), or none.
  void take(core::Frame image) { image_ = std::move(image); }
  void forget() { image_ = {}; }
  // Adds the taken image, drawn as `from` sees it, pixel by pixel as `to` sees its ground; pixels of which nothing is known
  // are transparent, so that the grid shows there. `height_m` of the camera above the ground. Draws nothing where no image
  // was taken.
  void draw_carried(ImDrawList& list, const ViewArea& area, const core::View& from, const core::View& to,
                    double height_m);

 private:
  std::vector<warp::MovedVertex> moved_;
  core::Frame image_;
  std::optional<base::ThreadPool> pool_;  // once it is needed
  warp::Carrier carrier_;
  warp::CarriedImage carried_;
  std::vector<std::uint8_t> rgba_;
  std::optional<Texture> texture_;
};

}  // namespace vpe::window
