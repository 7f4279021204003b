// Error bounds of a tile's mesh, stored as terms that hold at any vertical exaggeration.
#pragma once

namespace lod {

// Upper bounds of radial distances between a mesh's flat triangles and S, metres. In every direction
// (mesh - S) = relief part + sag part, where sag is what is left with all heights 0 (the chords under the
// sphere).
struct ErrorTerms {
  double height_error_m = 0;
  double sagitta_m = 0;
  double total_m = 0;  // of the sum, at exaggeration 1; <= relief + sag

  void include(const ErrorTerms& other);  // the larger of each
};

// How far the radius of a facet in one direction, with heights exaggerated x times, is from the line through its
// values at x = 0 and 1. It is a weighted harmonic mean of R + x h over heights within range_m of each other that
// lie in [min, max]; its second derivative in x is at most R^2 range^2 / (2 a^3), a = lowest R + t h for t between
// 0, 1 and x. Hence |x (x - 1)| R^2 range^2 / (4 a^3). Infinite when a <= 0: the ground would pass the planet's
// centre.
double second_order_bound(double exaggeration, double range_m, double min_height_m, double max_height_m,
                          double radius_m);

// Radial distance between mesh and S with heights exaggerated x times, each post by itself, for a tile whose
// heights lie in [min, max]: total at x = 1, sag at x = 0, else |x| relief + sag + second order.
double error_bound(const ErrorTerms& terms, double exaggeration, double min_height_m, double max_height_m,
                   double radius_m);

}  // namespace lod
