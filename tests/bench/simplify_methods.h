// Methods that greedy insertion is compared with: meshes of one tile's posts.
#pragma once

#include <memory>
#include <optional>

#include "lod/mesh/mesh.h"

namespace bench {

// Every step-th line, S's diagonals.
lod::TileMesh regular_grid(int intervals, int step);

// Right-triangulated irregular network as in martini, but with each triangle's true error at its posts.
class Rtin {
 public:
  Rtin(const lod::Posts& posts, double radius_m);
  lod::TileMesh mesh(double tolerance_m) const;

 private:
  struct Post {
    int i, j;
  };
  template <class Visit>
  void at_depth(Post a, Post b, Post c, int depth, Visit&& visit) const;
  double& error(Post p) { return geometric_error_m_[static_cast<std::size_t>(p.j * side_ + p.i)]; }
  double error(Post p) const { return geometric_error_m_[static_cast<std::size_t>(p.j * side_ + p.i)]; }

  int side_;
  std::vector<double> geometric_error_m_;
};

// OpenMesh's decimater with ModQuadric; borders collapse only along themselves and no triangle may turn over in
// the chart. Thresholds must ascend from call to call: the mesh is decimated further each time.
class Decimater {
 public:
  Decimater(const lod::Posts& posts, double radius_m);
  ~Decimater();
  void decimate(double largest_quadric_m2);
  std::optional<lod::TileMesh> mesh() const;  // none while there are more than 65536 vertices

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace bench
