// Centre lines of the troughs of Valles Marineris and of the outflow channels.
#pragma once

#include <cstddef>
#include <glm/vec3.hpp>
#include <span>

#include "mars/embedded/block.h"

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
// Kasei, Maja, Simud, Tiu, Ares and the chaos at their heads; Mangala, Ma'adim, Dao, Niger, Harmakhis, Reull.
std::span<const TroughPiece> channel_pieces();

// Smooth union of the pieces near a block.
struct Inside {
  Lane<double> depth_m;  // horizontally inwards from the rim, negative outside
  Lane<double> floor_m;
  Lane<double> to_axis_m;   // from here to the centre line
  Lane<double> gx, gy, gz;  // unit inwards
  Lane<double> across_m;    // from the centre line, positive to the right of the line's direction
};
// False where no post comes near a piece; `out` is set else.
bool find_inside(const Block& block, std::span<const TroughPiece> pieces, Inside& out);

// Chaos: the ground broken into mesas at the heads of the channels. Adds metres to `texture`; `inside` 0..1: on
// the floor. Sets `broken` to the share of it.
struct Chaos {
  const Lane<float>&coves, &km16, &nicks, &inside;
};
void lay_chaos(const Block& block, const Chaos& on, Lane<double>& broken,
               Lane<double>& texture);  // embedded_scour.cpp

// What floods left in a channel where it is not broken: grooves and braids along the flow, islands between
// them. Sets `kept` to the share of the depth that islands keep, and adds metres of relief to `texture`.
void scour(const Block& block, double spacing_m, const Inside& in, const Lane<float>& inside,
           const Lane<double>& broken, Lane<double>& kept, Lane<double>& texture);  // embedded_scour.cpp

}  // namespace mars::embedded
