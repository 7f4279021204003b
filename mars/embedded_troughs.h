// Centre lines of the troughs of Valles Marineris and of the outflow channels.
#pragma once

#include <cstddef>
#include <glm/vec3.hpp>
#include <span>

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

}  // namespace mars::embedded
