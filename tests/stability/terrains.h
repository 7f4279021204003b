// Planets of any radius with ground that strains arithmetic, each a function of the post.
#pragma once

#include <cmath>
#include <glm/geometric.hpp>
#include <string>
#include <vector>

#include "tests/paging/planet_fixture.h"

namespace test_support {

// Intervals a face of planets made by build_ground().
inline constexpr int kFacePosts = 64;

// A post of the finest grid, found from its direction.
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

// Heights as parts of the planet's radius.
struct StrangeGround {
  const char* name;
  std::function<double(const glm::dvec3& direction)> height;
};

// `relief`: the largest height, and depth, as a part of the radius.
inline std::vector<StrangeGround> strange_grounds(double relief) {
  const glm::dvec3 hotspot =
      mars::chart_direction(mars::Face::kPlusX, mars::face_line(40, 6), mars::face_line(24, 6));
  return {
      {"flat", [](const glm::dvec3&) { return 0.0; }},
      {"constant", [=](const glm::dvec3&) { return 0.37 * relief; }},
      {"spike", [=](const glm::dvec3& d) { return glm::length(d - hotspot) < 1e-9 ? relief : 0.0; }},
      {"pit", [=](const glm::dvec3& d) { return glm::length(d - hotspot) < 1e-9 ? -relief : 0.0; }},
      {"cliff", [=](const glm::dvec3& d) { return d.x + 0.7 * d.y + 0.2 * d.z > 0.31 ? relief : -relief; }},
      {"checkerboard",
       [=](const glm::dvec3& d) {
         const Post post = post_at(d);
         return ((post.i + post.j) & 1) != 0 ? relief : -relief;
       }},
      {"ramp", [=](const glm::dvec3& d) { return relief * d.z; }},
      {"hills", [=](const glm::dvec3& d) { return relief / 8000 * bumpy_height(d); }},
      {"no data", [](const glm::dvec3&) { return std::nan(""); }},
  };
}

// Of one depth: kFacePosts intervals a face. The step of stored heights is 2^-31 of the largest, or so.
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

// Places where charts, longitudes or faces meet: poles and their neighbourhood to 1e-9 degrees, the
// antimeridian, edges and corners of the cube, and 1e-9 degrees beside them.
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
