#include "vpe/window/moved_image.h"

#include <imgui.h>

#include <span>

namespace vpe::window {

bool is_same_sight(const core::View& a, const core::View& b) {
  const mars::Axes& x = a.camera.axes;
  const mars::Axes& y = b.camera.axes;
  return a.camera.position_m == b.camera.position_m && x.forward == y.forward && x.up == y.up &&
         x.right == y.right && a.fov_deg == b.fov_deg;
}

void MovedImage::draw(ImDrawList& list, void* texture, const ViewArea& area, const warp::ImageGrid& grid,
                      const core::View& to, explore::Warp warp) {
  grid.move(to, moved_);
  if (warp == explore::Warp::kPolynomial) {
    if (const auto motion = warp::fit_motion(grid, moved_)) {
      for (std::size_t n = 0; n < moved_.size(); ++n) {
        moved_[n].xy_px = motion->at(grid.places()[n]);
        moved_[n].is_ahead = true;
      }
    }
  }
  const std::vector<glm::ivec2> cells = warp::far_to_near(grid, moved_);
  if (cells.empty()) return;
  list.PushClipRect(at(area.x, area.y), at(area.x + area.width, area.y + area.height), true);
  list.PushTextureID(texture);
  list.PrimReserve(static_cast<int>(6 * cells.size()), static_cast<int>(moved_.size()));
  const auto first = list._VtxCurrentIdx;
  for (std::size_t n = 0; n < moved_.size(); ++n) {
    const glm::vec2 place = moved_[n].is_ahead ? moved_[n].xy_px : glm::vec2(0);
    const glm::vec2 texel = grid.texture_at(n);
    list.PrimWriteVtx(at(area.x + static_cast<double>(place.x), area.y + static_cast<double>(place.y)),
                      {texel.x, texel.y}, IM_COL32_WHITE);
  }
  const auto index = [&](int column, int row) {
    return static_cast<ImDrawIdx>(first + static_cast<unsigned>(grid.index(column, row)));
  };
  for (const glm::ivec2& cell : cells) {
    const ImDrawIdx corners[4]{index(cell.x, cell.y), index(cell.x + 1, cell.y), index(cell.x + 1, cell.y + 1),
                               index(cell.x, cell.y + 1)};
    for (const int k : {0, 1, 2, 0, 2, 3}) list.PrimWriteIdx(corners[k]);
  }
  list.PopTextureID();
  list.PopClipRect();
}

}  // namespace vpe::window
