// Squares that show nothing but ground and one dome.
#include <algorithm>
#include <array>

#include "objects/draw/square_painter.h"

namespace objects {

const DomePainter* SquarePainter::lone_dome() const {
  if (posters_.size() != 1 || !near_to_far_.empty() || may_be_shaded_) return nullptr;
  const auto at = std::ranges::find(image_.domes, posters_.front(), &DomePainter::poster);
  return at == image_.domes.end() ? nullptr : &*at;
}

void SquarePainter::paint_dome_block(const DomeColours& colours, const Seen& seen, vpe::core::Frame& frame) {
  const PixelSquare& block = colours.block;
  const SubSquare part{square_, {}, false, {}, {}, false, posters_};
  const double opacity = dome_->opacity();
  const auto is_edge = [&](int x, int y) {
    if (image_.samples <= 1) return false;
    constexpr std::array<glm::ivec2, 4> kBeside{{{1, 0}, {-1, 0}, {0, 1}, {0, -1}}};
    return std::ranges::any_of(kBeside, [&](const glm::ivec2& d) {
      const SeenPixel* other = beside(x + d.x, y + d.y, seen);
      return other != nullptr && other->front != at(x, y).front;
    });
  };
  for (int y = block.y0; y < block.y1; ++y) {
    for (int x = block.x0; x < block.x1; ++x) {
      if (!is_wanted(x, y)) continue;
      const bool shows = shows_dome(x, y);
      const bool is_smooth = is_edge(x, y);
      if (!shows && !is_smooth) continue;
      const std::size_t pixel =
          static_cast<std::size_t>(y) * static_cast<std::size_t>(frame_width_) + static_cast<std::size_t>(x);
      const std::size_t n = DomeColours::index(block, x, y);
      if (!is_smooth && opacity >= 1) {
        frame.colour[pixel] = dome_->bytes(colours.words[n]);
        ++drawn_.counts.pixels;
      } else {
        const glm::dvec4 over = is_smooth ? smooth_sample(part, x, y)
                                          : glm::dvec4(dome_->colour(colours.words[n]) * opacity, opacity);
        frame.colour[pixel] = to_rgb(to_dvec3(frame.colour[pixel]) * (1 - over.w) + glm::dvec3(over));
        drawn_.counts.pixels += over.w > 0 ? 1 : 0;
      }
      // As layers of objects do: the range is where the opacity passes a half.
      if (!shows || opacity < 0.5) continue;
      ++drawn_.counts.covered;
      if (!frame.range_m.empty())
        frame.range_m[pixel] = std::min(frame.range_m[pixel], colours.places.range_m[n]);
    }
  }
}

void SquarePainter::paint_dome(const Seen& seen, vpe::core::Frame& frame) {
  const bool is_plain = dome_mask_.is_full && dome_->has_bytes() && image_.only.empty();
  // At its border the square may have an edge.
  const auto has_edge = [&](const PixelSquare& b) {
    const bool is_inner = b.x0 > square_.x0 && b.y0 > square_.y0 && b.x1 < square_.x1 && b.y1 < square_.y1;
    if (image_.samples <= 1 || is_inner) return false;
    const auto differs = [&](int x, int y) {
      const SeenPixel* other = seen(x, y);
      return other != nullptr && other->front != dome_seen_.front;
    };
    for (int x = b.x0; x < b.x1; ++x) {
      if ((b.y0 == square_.y0 && differs(x, b.y0 - 1)) || (b.y1 == square_.y1 && differs(x, b.y1))) return true;
    }
    for (int y = b.y0; y < b.y1; ++y) {
      if ((b.x0 == square_.x0 && differs(b.x0 - 1, y)) || (b.x1 == square_.x1 && differs(b.x1, y))) return true;
    }
    return false;
  };
  dome_->draw(square_, ground_, dome_mask_, [&](const DomeColours& colours) {
    const PixelSquare& b = colours.block;
    if (!is_plain || has_edge(b)) {
      paint_dome_block(colours, seen, frame);
      return;
    }
    for (int y = b.y0; y < b.y1; ++y) {
      const std::size_t first =
          static_cast<std::size_t>(y) * static_cast<std::size_t>(frame_width_) + static_cast<std::size_t>(b.x0);
      const std::size_t n = DomeColours::index(b, b.x0, y);
      if (b.x1 - b.x0 == kDomeBlock_px) {
        store_bytes(colours.words.data() + n, frame.colour.data() + first);
      } else {
        for (std::size_t k = 0; k < static_cast<std::size_t>(b.x1 - b.x0); ++k)
          frame.colour[first + k] = dome_->bytes(colours.words[n + k]);
      }
      if (frame.range_m.empty()) continue;
      for (std::size_t k = 0; k < static_cast<std::size_t>(b.x1 - b.x0); ++k)
        frame.range_m[first + k] = std::min(frame.range_m[first + k], colours.places.range_m[n + k]);
    }
    const std::int64_t pixels = std::int64_t{b.x1 - b.x0} * (b.y1 - b.y0);
    drawn_.counts.pixels += pixels;
    drawn_.counts.covered += pixels;
  });
}

}  // namespace objects
