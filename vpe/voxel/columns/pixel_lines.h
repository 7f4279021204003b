// Parallel lines of pixels that cover an image (Wan, Qu and Kaufman 1999, section 5).
//
// All lines are one line of Bresenham's kind, shifted: a bit for each step says whether it moves aside there (the array B of the
// paper). So each pixel belongs to exactly one line, whatever the angle.
//
// Typical usage:
//   const PixelLines lines(500, 400, {0.3, -1});  // along which elevation rises; y is down
//   std::vector<PixelLines::Pixel> pixels;
//   for (int n = 0; n < lines.count(); ++n) { lines.get(n, pixels); ... }
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <span>
#include <vector>

namespace vpe::voxel {

class PixelLines {
 public:
  // `along` is the direction of the lines, of any length; without one lines run upwards. Throws std::invalid_argument for a
  // size that is not positive.
  PixelLines(int width, int height, const glm::dvec2& along);

  struct Pixel {
    int x = 0;
    int y = 0;
  };

  int count() const { return count_; }
  // Sets the pixels of a line, 0 <= n < count(), in its direction. No line is empty.
  void get(int n, std::vector<Pixel>& pixels) const;

  // Returns for each step whether the lines move aside when they come there; the first is false.
  std::span<const std::uint8_t> shifts() const { return shifts_; }

 private:
  int steps_ = 0;   // pixels along the lines
  int across_ = 0;  // pixels across them
  bool is_upright_ = true;
  bool is_forward_ = false;  // steps grow with y, or with x
  bool turns_up_ = true;     // shifts grow with x, or with y
  int count_ = 0;
  int first_start_ = 0;  // across, of line 0
  std::vector<std::uint8_t> shifts_;
  std::vector<int> offsets_;  // sums of the shifts
};

}  // namespace vpe::voxel
