#include "vpe/window/ui/hand_cursor.h"

#include <algorithm>
#include <array>
#include <string_view>

namespace vpe::window {

namespace {

constexpr std::array<std::string_view, 16> kHand{
    "                ",  //
    "                ",  //
    "                ",  //
    "    ## ## ##    ",  //
    "   #oo#oo#oo##  ",  //
    "   #oooooooo#o# ",  //
    "    #ooooooooo# ",  //
    "   ##ooooooooo# ",  //
    "  #o#ooooooooo# ",  //
    "  #ooooooooooo# ",  //
    "  #oooooooooo#  ",  //
    "   #ooooooooo#  ",  //
    "    #oooooooo#  ",  //
    "     #oooooo#   ",  //
    "     #oooooo#   ",  //
    "     ########   ",  //
};

}  // namespace

CursorImage closed_hand(int factor) {
  const int scale = std::max(1, factor);
  CursorImage image;
  image.side_px = static_cast<int>(kHand.size()) * scale;
  image.hot_px = image.side_px / 2;
  for (int y = 0; y < image.side_px; ++y) {
    for (int x = 0; x < image.side_px; ++x) {
      const char c = kHand[static_cast<std::size_t>(y / scale)][static_cast<std::size_t>(x / scale)];
      const std::uint8_t grey = c == 'o' ? 255 : 0;
      image.rgba.insert(image.rgba.end(), {grey, grey, grey, static_cast<std::uint8_t>(c == ' ' ? 0 : 255)});
    }
  }
  return image;
}

}  // namespace vpe::window
