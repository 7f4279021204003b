// A planet to be patched in memory, and changes of its ground.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "paging/live/relief_patch.h"
#include "paging/planet/verify.h"
#include "relief/relief_source.h"
#include "relief/spec_line.h"
#include "tests/paging/planet_fixture.h"

namespace test_support {

using Planet = std::shared_ptr<const paging::PlanetFile>;

// Places at corners and edges of the cube, at a pole and the antimeridian, and inside a face.
inline const std::vector<mars::LonLat>& live_places() {
  static const std::vector<mars::LonLat> kPlaces{
      {45, 35.264389682754654}, {45, 0}, {20, 90}, {180, 3}, {0, 0}, {11, 23}};
  return kPlaces;
}

inline constexpr double kLiveQuantum_m = 1.0 / 16;

// Heights are whole quanta, so that a planet loses nothing of them.
inline double whole_quanta(const glm::dvec3& d) {
  return std::round(bumpy_height(d) / kLiveQuantum_m) * kLiveQuantum_m;
}

inline FakeElevation::Spacing fine_at_places(double spacing_m) {
  return [=](const mars::Cap& cap) {
    for (const mars::LonLat& place : live_places())
      if (glm::length(cap.centre - mars::direction(place)) < cap.radius_rad + 0.02) return spacing_m;
    return 1e9;
  };
}

inline paging::BuildOptions live_options(const std::filesystem::path& path) {
  paging::BuildOptions options;
  options.output = path.string();
  options.base_spacing_m = 120000;
  options.threads = 2;
  options.tile_k = 4;
  options.quantum_m = kLiveQuantum_m;
  options.resampling_posts = 2000;
  return options;
}

// Builds a planet with posts of some 8 km about the places.
inline Planet build_live(const std::filesystem::path& path,
                         const FakeElevation::Height& height = whole_quanta) {
  const paging::BuildOptions options = live_options(path);
  paging::build_planet(options, FakeElevation(height, fine_at_places(9000)), nullptr);
  return paging::PlanetFile::open(options.output);
}

// Returns a crater at a place whose posts are as far apart as is given.
inline relief::ReliefSpec crater_at(const mars::LonLat& place, double radius_m, double spacing_m,
                                    double depth_m = 2000) {
  relief::ReliefSpec spec;
  spec.kind = relief::ReliefKind::kCrater;
  spec.place = place;
  spec.radius_m = radius_m;
  spec.depth_m = depth_m;
  spec.spacing_m = spacing_m;
  return spec;
}

// Expects that a planet is sound: posts and meshes meet, and no error is larger than it is stated.
inline void expect_sound(const paging::PlanetFile& planet, std::size_t deep_tiles = 400) {
  const paging::VerifyReport report = paging::verify(planet, {.threads = 2, .deep_tiles = deep_tiles});
  for (std::size_t n = 0; n < std::min<std::size_t>(report.problems.size(), 10); ++n)
    ADD_FAILURE() << report.problems[n].where << ": " << report.problems[n].what;
  EXPECT_GT(report.measured, 0);
}

// Returns the posts of the finest tiles of a planet, with their tiles.
struct LivePost {
  lod::TileKey tile;
  glm::dvec3 direction;
  double height_m = 0;
};
inline std::vector<LivePost> finest_posts(const paging::PlanetFile& planet, const mars::Cap& cap) {
  std::vector<LivePost> out;
  const int n = planet.meta().tile.intervals();
  for (const lod::TileInfo& tile : planet.tree().tiles()) {
    if (tile.has_children) continue;
    const mars::Cap own = lod::bounding_cap(tile.key);
    if (mars::angle_between_rad(own.centre, cap.centre) > own.radius_rad + cap.radius_rad) continue;
    const paging::TileHeights heights = planet.heights(tile.key);
    const lod::GridLines lines = lod::grid_lines(tile.key, n);
    // Posts on borders may lie on the edge of a coarser tile.
    for (int j = 1; j < n; ++j)
      for (int i = 1; i < n; ++i)
        out.push_back({tile.key,
                       mars::chart_direction(tile.key.face, lines.u[static_cast<std::size_t>(i)],
                                             lines.v[static_cast<std::size_t>(j)]),
                       heights.posts.at(i, j)});
  }
  return out;
}

}  // namespace test_support
