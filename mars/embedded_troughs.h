// Centre lines of the troughs of Valles Marineris and of the outflow channels.
#pragma once

#include <cstddef>
#include <glm/vec3.hpp>
#include <span>

#include "mars/embedded_block.h"

namespace mars::embedded {

inline constexpr std::size_t kMostPieces = 64;  // of one system

// A straight (great-circle) piece of a trough. Half-widths and floor heights run linearly from a to b.
struct TroughPiece {
  glm::dvec3 a, b;  // unit
  double half_width_a_km, half_width_b_km;
  double floor_a_m, floor_b_m;
};

// Valles Marineris, Noctis excluded.
std::span<const TroughPiece> valles_pieces();
// Kasei, Maja, Simud, Tiu, Ares, Mangala, Ma'adim, Dao, Harmakhis.
std::span<const TroughPiece> channel_pieces();

// Smooth union of the pieces near a block.
struct Inside {
  Lane<double> depth_m;  // horizontally inwards from the rim, negative outside
  Lane<double> floor_m;
  Lane<double> to_axis_m;   // from here to the centre line
  Lane<double> gx, gy, gz;  // unit inwards
};
// False where no post comes near a piece; `out` is set else.
bool find_inside(const Block& block, std::span<const TroughPiece> pieces, Inside& out);

}  // namespace mars::embedded
