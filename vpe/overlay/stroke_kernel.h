// Covers pixels by straight pieces of thin lines, in vectors of pixels.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>
#include <span>

namespace vpe::overlay {

// Kernels may write so many pixels beyond the last one of a row.
inline constexpr int kStrokeLanes = 8;
// No pixel's corner is farther from its centre.
inline constexpr float kPixelCorner_px = 0.7072F;

// Describes an end of a piece: cut off square, or going on to a corner, at most so far beyond the end.
struct PieceEnd {
  bool is_cut = true;
  float extent_px = 0;
};

// Describes a straight piece of a line.
struct StrokePiece {
  glm::dvec2 from;
  glm::vec2 along;  // unit
  float length_px;
  float radius_px;  // half of the width
  PieceEnd start, end;
};

// Describes a round corner between two pieces, of which it adds what is outside of both.
struct StrokeCorner {
  glm::dvec2 at;
  glm::vec2 along, next;  // unit: of the pieces before and after
  float radius_px;
};

// Holds pixels of a row that may be covered: [begin, end).
struct TouchedRow {
  int begin;
  int end;
};

// Refers to the coverage of an image.
struct StrokeRows {
  int width;
  int height;
  std::size_t stride;      // at least width + kStrokeLanes
  std::uint8_t* coverage;  // 0 to 255
  TouchedRow* touched;     // of each row
  int top, bottom;         // rows that may be covered
};

// Raise the coverage of pixels to that by each piece, or corner, by itself. Bits are equal with any instruction set,
// and wherever the image was cut out of a larger one at whole pixels. Distances are floats: a piece that begins 16 384 px away is
// off by less than 0.01 px.
void cover_pieces(std::span<const StrokePiece> pieces, StrokeRows& rows);
void cover_corner(const StrokeCorner& corner, StrokeRows& rows);

}  // namespace vpe::overlay
