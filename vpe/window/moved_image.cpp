#include "vpe/window/moved_image.h"

#include <imgui.h>

#include <algorithm>
#include <span>

namespace vpe::window {

bool is_same_sight(const core::View& a, const core::View& b) {
  const mars::Axes& x = a.camera.axes;
  const mars::Axes& y = b.camera.axes;
  return a.camera.position_m == b.camera.position_m && x.forward == y.forward && x.up == y.up &&
         x.right == y.right && a.fov_deg == b.fov_deg;
}

void MovedImage::draw(ImDrawList& list, const TexturePart& image, const ViewArea& area,
                      const warp::ImageGrid& grid, const core::View& to, explore::Warp warp) {
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
  list.PushTextureID(image.texture);
  list.PrimReserve(static_cast<int>(6 * cells.size()), static_cast<int>(moved_.size()));
  const auto first = list._VtxCurrentIdx;
  for (std::size_t n = 0; n < moved_.size(); ++n) {
    const glm::vec2 place = moved_[n].is_ahead ? moved_[n].xy_px : glm::vec2(0);
    const glm::vec2 texel = image.low + image.size * grid.texture_at(n);
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

void MovedImage::draw_carried(ImDrawList& list, const ViewArea& area, const core::View& from,
                              const core::View& to, double height_m) {
  if (image_.range_m.empty()) return;
  // The ground may be nearer beside the image than below the camera; what that hides is seen until the next image.
  constexpr double kOfHeight = 0.5;
  if (!warp::check_carry(from, to).empty()) return;
  if (!pool_) pool_.emplace(0);
  warp::CarryOptions options;
  options.nearest_m = kOfHeight * std::max(height_m, 0.0);
  carrier_.carry(from, image_, to, options, *pool_, carried_);
  rgba_.resize(4 * carried_.colour.size());
  for (std::size_t n = 0; n < carried_.colour.size(); ++n) {
    const base::Rgb& colour = carried_.colour[n];
    const std::uint8_t opacity = carried_.origin[n] == warp::Origin::kOpen ? 0 : 255;
    std::uint8_t* const out = &rgba_[4 * n];
    out[0] = colour.r;
    out[1] = colour.g;
    out[2] = colour.b;
    out[3] = opacity;
  }
  if (!texture_) texture_.emplace();
  texture_->upload_rgba(rgba_, carried_.width, carried_.height);
  list.AddImage(texture_->id(), at(area.x, area.y), at(area.x + area.width, area.y + area.height));
}

}  // namespace vpe::window
