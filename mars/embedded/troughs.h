// Centre lines of the troughs of Valles Marineris and of the outflow channels.
#pragma once

#include <cstddef>
#include <glm/vec3.hpp>
#include <span>

#include "mars/embedded/block.h"

namespace mars::embedded {

inline constexpr std::size_t kMostPieces = 64;  // of one system

// Describes a straight (great-circle) piece of a trough. Half-widths and floor heights vary linearly from a to
// b.
struct TroughPiece {
  glm::dvec3 a, b;  // unit
  double half_width_a_km, half_width_b_km;
  double floor_a_m, floor_b_m;
};

// Returns the pieces of Valles Marineris without Noctis Labyrinthus.
std::span<const TroughPiece> valles_pieces();

// Returns the pieces of the outflow channels: Kasei, Maja, Simud, Tiu, Ares and the chaos at their heads;
// Mangala, Ma'adim, Dao, Niger, Harmakhis, Reull.
std::span<const TroughPiece> channel_pieces();

// Holds the smooth union of the pieces near a block.
struct Inside {
  Lane<double> depth_m;  // horizontal distance inwards from the rim, negative outside
  Lane<double> floor_m;
  Lane<double> to_axis_m;   // distance to the centre line
  Lane<double> gx, gy, gz;  // unit vector inwards
  Lane<double> across_m;    // distance from the centre line, positive to the right of its direction
};

// Sets `out`. Returns false, without setting it, if no post is near a piece.
bool find_inside(const Block& block, std::span<const TroughPiece> pieces, Inside& out);

// Holds the inputs of lay_chaos(): noises, and `inside`, which is 1 on the floor of a channel and 0 outside.
struct Chaos {
  const Lane<float>&coves, &km16, &nicks, &inside;
};

// Adds chaos terrain, i.e. ground broken into mesas at the heads of the channels: metres to `texture`. Sets
// `broken` to its share of the ground.
void lay_chaos(const Block& block, const Chaos& on, Lane<double>& broken,
               Lane<double>& texture);  // scour.cpp

// Adds what floods left in a channel where it is not broken: grooves and braids along the flow, and islands
// between them. Sets `kept` to the share of the depth that islands retain, and adds metres of height to
// `texture`.
void scour(const Block& block, double spacing_m, const Inside& in, const Lane<float>& inside,
           const Lane<double>& broken, Lane<double>& kept, Lane<double>& texture);  // scour.cpp

}  // namespace mars::embedded
