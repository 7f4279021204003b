// Draws a dome into squares of pixels, by blocks of 16 x 16 pixels. Internal to objects/draw.
//
// For domes whose panorama has a formula. SeenPosters::meet() and colour() draw the same image a pixel at a time; blocks that
// reach farther than a tangent of kMostTangent about their middle, or across the edge of a facet, are left to them. Against these a place
// is off by at most kDomePlaceError_px of the image, the range by a 2^20th, and the level of the pyramid by what is not bilinear
// in it within a block: less than 0.05, and 600 / f^2 at least two blocks from a pole, f being the focal length in pixels.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>

#include "objects/draw/dome_kernel.h"
#include "objects/draw/pixel_square.h"
#include "objects/draw/seen_posters.h"

namespace objects {

inline constexpr double kDomePlaceError_px = 0.02;

// Says which pixels of a square of at most kSide columns and rows show a dome.
struct DomeMask {
  static constexpr int kSide = 64;
  std::array<std::uint64_t, kSide> rows{};  // a bit for each column, that of the first one lowest
  bool is_full = false;                     // all pixels of the square do
  bool is_before_all = false;               // and no ground is there
};

// Holds the pixels of a block that show a dome.
struct DomeColours {
  PixelSquare block;
  BlockPlaces places;  // only `range_m` is set in any case
  BlockWords words;

  static std::size_t index(const PixelSquare& block, int x, int y) {
    return static_cast<std::size_t>(y - block.y0) * kDomeBlock_px + static_cast<std::size_t>(x - block.x0);
  }
};

// Draws one dome of a view. Immutable; any thread may call any member.
class DomePainter {
 public:
  // Returns whether a painter can be made of an image.
  static bool knows(const SeenPosters& posters, std::uint32_t poster);
  // All must outlive this.
  DomePainter(const SeenPosters& posters, std::uint32_t poster, const vpe::core::View& view,
              const ViewRays& rays, double gamma);

  std::uint32_t poster() const { return poster_; }
  double opacity() const { return opacity_; }
  // Finds which pixels of a square show the dome before, or in place of, its ground. `cone` holds their rays.
  DomeMask find(const PixelSquare& square, const ViewCone& cone, const GroundRanges& ground) const;
  // Draws the pixels that find() found; calls `paint` for each block, with what does not outlive the call.
  void draw(const PixelSquare& square, const GroundRanges& ground, const DomeMask& mask,
            const std::function<void(const DomeColours&)>& paint) const;
  // Returns whether words hold the bytes of the image.
  bool has_bytes() const { return steps_ == 1; }
  // Return the colour of a word, 0 to 255 before gamma, and the same in bytes, rounded.
  glm::dvec3 colour(std::uint32_t word) const;
  vpe::base::Rgb bytes(std::uint32_t word) const {
    return {bytes_[word & 1023U], bytes_[word >> 10U & 1023U], bytes_[word >> 20U & 1023U]};
  }

 private:
  // Describes the rays of a square: at column i and row j scale[j] column[i] + rise[j] up, east, north and up of the dome.
  struct SquareRays;
  struct BlockOrigin;
  struct BlockPyramid;
  // Levels of the pyramid at the corners of a square's blocks.
  static constexpr std::size_t kNodes = DomeMask::kSide / kDomeBlock_px + 1;
  using Levels = std::array<std::array<double, kNodes>, kNodes>;

  SquareRays rays_of(const PixelSquare& square) const;
  glm::dvec3 ray_at(double x, double y) const;
  glm::dvec3 meet(const glm::dvec3& ray) const;
  double level_at(double x, double y) const;
  bool shows_all(const ViewCone& cone, const GroundRanges& ground) const;
  Levels levels_of(const PixelSquare& square) const;
  BlockOrigin origin_of(double x, double y) const;
  template <class T>
  DomeBlock<T> block_of(const SquareRays& rays, const BlockOrigin& origin, int column, int row) const;
  bool find_block(const SquareRays& rays, const PixelSquare& square, const GroundRanges* ground,
                  const PixelSquare& block, BlockOrigin& origin, BlockPlaces& places) const;
  void find_pixels(const PixelSquare& block, const GroundRanges& ground, DomeColours& out) const;

  const SeenPosters& posters_;
  std::uint32_t poster_;
  const vpe::core::View& view_;
  const ViewRays& rays_;
  const PlacedPoster& placed_;
  const PanoramaFormula& formula_;
  double opacity_;
  bool has_doubles_;    // floats do not do
  bool repeats_whole_;  // the panorama is a circle of whole columns
  float steps_;
  glm::dvec2 principal_px_;
  double focal_px_;
  glm::dvec3 right_;  // of the camera; east, north and up of the dome
  glm::dvec3 up_;
  glm::dvec3 forward_;
  glm::dvec3 camera_;  // from the dome's middle, in radii
  double open_;        // DomeBlock::open
  bool is_central_;
  std::array<std::uint8_t, 1024> bytes_{};
  std::array<float, 1024> values_{};  // of a channel, before gamma
};

}  // namespace objects
