// The image of a cursor: a closed hand, which no set of standard cursors has everywhere.
#pragma once

#include <cstdint>
#include <vector>

namespace vpe::window {

struct CursorImage {
  int side_px = 0;                 // width and height
  int hot_px = 0;                  // column and row of the point that it points at
  std::vector<std::uint8_t> rgba;  // rows from the top, not premultiplied
};

// Draws a closed hand, white with a black outline, 16 pixels times `factor` (1 or more) wide.
CursorImage closed_hand(int factor);

}  // namespace vpe::window
