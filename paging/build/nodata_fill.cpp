#include "paging/build/nodata_fill.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <utility>

#include "lod/tree/posts.h"
#include "mars/geodesy/cube.h"
#include "mars/geodesy/sphere.h"
#include "paging/build/crossing_map.h"

namespace paging {

namespace {

// Of a neighbour that is far from data, beside 1 for one that is not. With equal weights, each doubling of the
// distance to the far side of a hole adds as much to the step at its near side.
constexpr double kWeightOfFill = 0.25;

struct Height {
  double height_m = 0;
  bool is_near_data = false;
};

// Fills crossings of one face, level by level. Grid level g has 2^g intervals a side; the posts of tiles of
// level l are the crossings of grid level l + k.
class Filler {
 public:
  Filler(const SampleInputs& sampling, mars::Face face, int finest)
      : sampling_(sampling), face_(face), grids_(static_cast<std::size_t>(finest) + 1) {}

  // Asks for the height of a crossing at which the sources have no data.
  void request(int grid_level, const Crossing& at) {
    grid(grid_level).requested.push_back(at);
    grid(grid_level).known_without_data = grid(grid_level).requested.size();
  }

  void fill() {
    for (int g = static_cast<int>(grids_.size()) - 1; g >= 0; --g) look_for_data(g);
    for (int g = 0; g < static_cast<int>(grids_.size()); ++g) interpolate(g);
  }

  double height_m(int grid_level, const Crossing& at) { return grid(grid_level).found.find(at)->height_m; }

 private:
  struct Grid {
    std::vector<Crossing> requested;
    std::size_t known_without_data = 0;  // so many of the first ones
    CrossingMap<double> sampled;         // NaN: no data
    CrossingMap<Height> found;
    std::vector<Crossing> far_from_data;  // to be interpolated
  };

  Grid& grid(int grid_level) { return grids_[static_cast<std::size_t>(grid_level)]; }

  glm::dvec3 direction(int grid_level, const Crossing& at) const {
    return mars::chart_direction(face_, mars::face_line(at.i, grid_level), mars::face_line(at.j, grid_level));
  }

  double spacing_m(int grid_level) const {
    const double coarsest_m = lod::post_spacing_m(0, sampling_.meta.tile.intervals(), sampling_.meta.radius_m);
    return std::ldexp(coarsest_m, sampling_.meta.tile.k - grid_level);
  }

  void sample(int grid_level, const std::vector<glm::dvec3>& directions, std::vector<double>& heights) const {
    heights.resize(directions.size());
    sampling_.elevation.sample(directions, spacing_m(grid_level), heights);
  }

  // Samples crossings, which have places in `sampled` that nobody has read.
  void sample(int grid_level, std::span<const Crossing> crossings) {
    std::vector<glm::dvec3> directions;
    directions.reserve(crossings.size());
    for (const Crossing& c : crossings) directions.push_back(direction(grid_level, c));
    std::vector<double> heights;
    sample(grid_level, directions, heights);
    auto& sampled = grid(grid_level).sampled;
    for (std::size_t n = 0; n < crossings.size(); ++n) *sampled.find(crossings[n]) = heights[n];
  }

  bool is_on_face_edge(int grid_level, const Crossing& c) const {
    const std::int64_t last = std::int64_t{1} << grid_level;
    return c.i == 0 || c.j == 0 || c.i == last || c.j == last;
  }

  // Calls visit(neighbour, weight) for the eight crossings around one that is not on an edge of the face.
  template <class Visit>
  static void visit_around(const Crossing& c, const Visit& visit) {
    for (int dj = -1; dj <= 1; ++dj)
      for (int di = -1; di <= 1; ++di)
        if (di != 0 || dj != 0) visit(Crossing{c.i + di, c.j + dj}, di == 0 || dj == 0 ? 1.0 : 0.5);
  }

  // Returns the mean of the data around a crossing, NaN if there are none.
  double mean_around(int grid_level, const Crossing& c) {
    double sum = 0;
    double weights = 0;
    const auto add = [&](double height_m, double weight) {
      if (!std::isfinite(height_m)) return;
      sum += weight * height_m;
      weights += weight;
    };
    if (is_on_face_edge(grid_level, c)) {
      // Both faces must find the same: a circle instead of the lines of one of them.
      const mars::LonLat place = mars::lon_lat(direction(grid_level, c));
      std::vector<glm::dvec3> circle;
      for (int n = 0; n < 8; ++n)
        circle.push_back(mars::direction(
            mars::destination(place, 45.0 * n, spacing_m(grid_level) / sampling_.meta.radius_m)));
      std::vector<double> heights;
      sample(grid_level, circle, heights);
      for (const double height_m : heights) add(height_m, 1.0);
    } else {
      const auto& sampled = grid(grid_level).sampled;
      visit_around(c, [&](const Crossing& neighbour, double weight) { add(*sampled.find(neighbour), weight); });
    }
    return weights > 0 ? sum / weights : std::numeric_limits<double>::quiet_NaN();
  }

  // Finds data at and around the requested crossings, and requests the coarser neighbours of the others.
  void look_for_data(int g) {
    Grid& grid = this->grid(g);
    std::vector<Crossing>& requested = grid.requested;
    grid.sampled = CrossingMap<double>(requested, 1);
    grid.found = CrossingMap<Height>(requested, 0);
    std::vector<Crossing> to_sample;
    std::size_t kept = 0;
    for (std::size_t n = 0; n < requested.size(); ++n) {
      double* height_m = grid.sampled.add(requested[n]);
      if (height_m == nullptr) continue;
      *height_m = std::numeric_limits<double>::quiet_NaN();
      if (n >= grid.known_without_data) to_sample.push_back(requested[n]);
      requested[kept++] = requested[n];
    }
    requested.resize(kept);
    sample(g, to_sample);
    to_sample.clear();
    for (const Crossing& c : requested) {
      if (std::isfinite(*grid.sampled.find(c)) || is_on_face_edge(g, c)) continue;
      visit_around(c, [&](const Crossing& neighbour, double) {
        if (grid.sampled.add(neighbour) != nullptr) to_sample.push_back(neighbour);
      });
    }
    sample(g, to_sample);
    for (const Crossing& c : requested) {
      double height_m = *grid.sampled.find(c);
      if (!std::isfinite(height_m)) height_m = mean_around(g, c);
      if (std::isfinite(height_m)) {
        *grid.found.add(c) = {height_m, true};
      } else {
        grid.far_from_data.push_back(c);
        if (g > 0)
          visit_coarser(c, [&](const Crossing& coarser) { this->grid(g - 1).requested.push_back(coarser); });
      }
    }
  }

  // Calls visit(crossing) for the crossings of the next coarser level around one: one, two or four.
  template <class Visit>
  static void visit_coarser(const Crossing& c, const Visit& visit) {
    for (std::int64_t j = c.j >> 1; j <= (c.j + 1) >> 1; ++j)
      for (std::int64_t i = c.i >> 1; i <= (c.i + 1) >> 1; ++i) visit(Crossing{i, j});
  }

  void interpolate(int g) {
    for (const Crossing& c : grid(g).far_from_data) {
      double sum = 0;
      double weights = 0;
      if (g > 0)
        visit_coarser(c, [&](const Crossing& coarser) {
          const Height& height = *grid(g - 1).found.find(coarser);
          const double weight = height.is_near_data ? 1 : kWeightOfFill;
          sum += weight * height.height_m;
          weights += weight;
        });
      *grid(g).found.add(c) = {g > 0 ? sum / weights : sampling_.meta.fill_m, false};
    }
  }

  const SampleInputs& sampling_;
  mars::Face face_;
  std::vector<Grid> grids_;
};

}  // namespace

void fill_nodata(const SampleInputs& sampling, const lod::TileKey& key, std::span<const int> level,
                 std::vector<double>& heights_m) {
  const int k = sampling.meta.tile.k;
  const auto side = static_cast<std::int64_t>(sampling.meta.tile.posts());
  const std::int64_t intervals = side - 1;
  const auto crossing = [&](std::size_t n) {
    const auto post = static_cast<std::int64_t>(n);
    const std::int64_t i = key.i * intervals + post % side;
    const std::int64_t j = key.j * intervals + post / side;
    const int finer = level[n] - key.level;
    return finer >= 0 ? Crossing{i << finer, j << finer} : Crossing{i >> -finer, j >> -finer};
  };
  std::vector<std::size_t> posts;
  for (std::size_t n = 0; n < heights_m.size(); ++n)
    if (!std::isfinite(heights_m[n])) posts.push_back(n);
  if (posts.empty()) return;
  Filler filler(sampling, key.face, *std::max_element(level.begin(), level.end()) + k);
  for (const std::size_t n : posts) filler.request(level[n] + k, crossing(n));
  filler.fill();
  for (const std::size_t n : posts) heights_m[n] = filler.height_m(level[n] + k, crossing(n));
}

}  // namespace paging
