// Error bounds of a tile's mesh, stored as terms that hold at any vertical exaggeration.
#pragma once

namespace lod {

// Upper bounds, in metres, of radial distances between a mesh's flat triangles and the reference surface S. In
// every direction (mesh - S) = height error + sagitta. The sagitta is the difference that remains with all
// heights 0: the chords below the sphere. It does not grow with exaggeration; the height error does.
struct ErrorTerms {
  double height_error_m = 0;
  double sagitta_m = 0;
  double total_m = 0;  // bound of the sum at exaggeration 1; <= height_error_m + sagitta_m

  // Raises each term to that of `other` if that is larger.
  void include(const ErrorTerms& other);
};

// Returns a bound of the distance between the radius of a facet, with heights exaggerated x times, and the line
// through its values at x = 0 and 1. The radius is a weighted harmonic mean of R + x h over heights within
// range_m of each other that lie in [min, max]. Its second derivative in x is at most R^2 range^2 / (2 a^3),
// where a is the lowest R + t h for t between 0, 1 and x. Hence the bound |x (x - 1)| R^2 range^2 / (4 a^3).
// Infinite for a <= 0, where the ground would pass the planet's centre.
double second_order_bound(double exaggeration, double range_m, double min_height_m, double max_height_m,
                          double radius_m);

// Returns a bound of the radial distance between mesh and S with each post exaggerated x times, for a tile
// whose heights lie in [min, max]: the total at x = 1, the sagitta at x = 0, else |x| height error + sagitta +
// second order.
double error_bound(const ErrorTerms& terms, double exaggeration, double min_height_m, double max_height_m,
                   double radius_m);

}  // namespace lod
