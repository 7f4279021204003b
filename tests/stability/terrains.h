// Planets of any radius with terrain that strains arithmetic, each a function of the post.
#pragma once

#include <cmath>
#include <glm/geometric.hpp>
#include <string>
#include <vector>

#include "tests/paging/planet_fixture.h"

namespace test_support {

// Number of intervals across a face of the planets that build_ground() makes.
inline constexpr int kFacePosts = 64;

// Holds a post of the finest grid.
struct Post {
  mars::Face face = mars::Face::kPlusX;
  int i = 0;
  int j = 0;
};
inline Post post_at(const glm::dvec3& direction) {
  const mars::ChartPoint at = mars::chart_point(direction);
  const auto index = [](double u) {
    return static_cast<int>(std::lround(mars::face_parameter(u) * kFacePosts));
  };
  return {at.face, index(at.u), index(at.v)};
}

// Describes terrain by heights as fractions of the planet's radius.
struct StrangeGround {
  const char* name;
  std::function<double(const glm::dvec3& direction)> height;
};

// Returns terrains whose largest height and depth is `amplitude`, a fraction of the radius.
inline std::vector<StrangeGround> strange_grounds(double amplitude) {
  const glm::dvec3 special_post =
      mars::chart_direction(mars::Face::kPlusX, mars::face_line(40, 6), mars::face_line(24, 6));
  return {
      {"flat", [](const glm::dvec3&) { return 0.0; }},
      {"constant", [=](const glm::dvec3&) { return 0.37 * amplitude; }},
      {"spike", [=](const glm::dvec3& d) { return glm::length(d - special_post) < 1e-9 ? amplitude : 0.0; }},
      {"pit", [=](const glm::dvec3& d) { return glm::length(d - special_post) < 1e-9 ? -amplitude : 0.0; }},
      {"cliff",
       [=](const glm::dvec3& d) { return d.x + 0.7 * d.y + 0.2 * d.z > 0.31 ? amplitude : -amplitude; }},
      {"checkerboard",
       [=](const glm::dvec3& d) {
         const Post post = post_at(d);
         return ((post.i + post.j) & 1) != 0 ? amplitude : -amplitude;
       }},
      {"ramp", [=](const glm::dvec3& d) { return amplitude * d.z; }},
      {"hills", [=](const glm::dvec3& d) { return amplitude / 8000 * bumpy_height(d); }},
      {"no data", [](const glm::dvec3&) { return std::nan(""); }},
  };
}

// Builds a planet of one level with kFacePosts intervals across a face. The step of stored heights is about
// 2^-31 of the largest.
inline std::shared_ptr<const paging::PlanetFile> build_ground(const std::filesystem::path& path,
                                                              double radius_m, const StrangeGround& ground) {
  const FakeElevation source([&](const glm::dvec3& d) { return radius_m * ground.height(d); });
  paging::BuildOptions options;
  options.output = path.string();
  options.radius_m = radius_m;
  options.tile_k = 5;
  options.base_spacing_m = 1.01 * lod::post_spacing_m(1, 32, radius_m);
  options.quantum_m = std::exp2(std::floor(std::log2(radius_m)) - 28);
  options.threads = 2;
  options.resampling_posts = 1000;
  paging::build_planet(options, source, nullptr);
  return paging::PlanetFile::open(path.string());
}

// Returns places where charts, longitudes or faces meet: poles and places as near as 1e-9 degrees, the
// antimeridian, edges and corners of the cube, and places 1e-9 degrees beside them.
inline std::vector<mars::LonLat> hostile_places() {
  std::vector<mars::LonLat> places;
  const double corner_deg = std::atan(std::sqrt(0.5)) / mars::kRadiansPerDegree;
  for (const double beside : {0.0, 1e-9, -1e-9, 1e-5}) {
    for (const double lat : {90.0, -90.0, 45.0, corner_deg, 0.0}) {
      for (const double lon : {0.0, 45.0, 90.0, 135.0, 180.0, -180.0, -45.0, 13.7}) {
        const double off_lat = lat > 0 ? lat - std::abs(beside) : lat + std::abs(beside);
        places.push_back({lon + beside, off_lat});
      }
    }
  }
  return places;
}

}  // namespace test_support
