// Scenes of a few objects for vpe query --all-surfaces.
#pragma once

#include <cmath>
#include <fstream>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <sstream>

#include "mars/geodesy/sphere.h"
#include "objects/model/mesh.h"
#include "objects/sticks/build_sticks.h"
#include "objects/sticks/stick_file.h"
#include "objects/sticks/voxelise.h"
#include "tests/app/support/app_fixture.h"

namespace app_test {

using nlohmann::json;

inline constexpr double kRadius_m = 3396190;
inline constexpr double kDegree = 3.14159265358979323846 / 180;

// Holds an object as its scene file places it.
struct Thing {
  std::string name;
  objects::Mesh mesh;
  mars::LonLat place;
  double altitude_m = 0;  // above the sphere
  double heading_deg = 0;
  double pitch_deg = 0;
  double roll_deg = 0;
  double scale = 1;
  int voxels = 200;  // along the longest side; 0: the mesh itself
};

inline glm::dvec3 up_at(const mars::LonLat& p) {
  const double lon = p.lon_deg * kDegree;
  const double lat = p.lat_deg * kDegree;
  return {std::cos(lat) * std::cos(lon), std::cos(lat) * std::sin(lon), std::sin(lat)};
}

// Returns the axes of a model, x to the right, y forward, z up, times its scale.
inline glm::dmat3 axes_of(const Thing& t) {
  const glm::dvec3 up = up_at(t.place);
  const glm::dvec3 east = glm::normalize(glm::cross(glm::dvec3(0, 0, 1), up));
  const glm::dvec3 north = glm::cross(up, east);
  const auto turn = [](glm::dvec3& a, glm::dvec3& b, double angle_deg) {
    const glm::dvec3 from = a;
    a = std::cos(angle_deg * kDegree) * a + std::sin(angle_deg * kDegree) * b;
    b = std::cos(angle_deg * kDegree) * b - std::sin(angle_deg * kDegree) * from;
  };
  glm::dmat3 axes(east, north, up);
  turn(axes[1], axes[0], t.heading_deg);
  turn(axes[1], axes[2], t.pitch_deg);
  turn(axes[2], axes[0], t.roll_deg);
  return t.scale * axes;
}

// Asks for all surfaces among things that it writes as a scene.
class SurfaceTest : public AppTest {
 protected:
  // Writes the models and the scene of some things, and returns the file's name.
  std::string write_scene(const std::vector<Thing>& things) const {
    std::ostringstream scene;
    scene.precision(17);
    scene << "version = 1\n";
    for (std::size_t n = 0; n < things.size(); ++n) {
      const Thing& t = things[n];
      const std::string file = "model" + std::to_string(n) + (t.voxels > 0 ? ".sticks" : ".obj");
      if (t.voxels > 0) {
        const objects::VoxelGrid voxels = objects::voxelise(t.mesh, {}, {.voxels_longest = t.voxels});
        objects::write_stick_file(dir_ / file, objects::build_sticks(voxels));
      } else {
        std::ofstream obj(dir_ / file);
        obj.precision(9);
        for (const glm::vec3& p : t.mesh.positions_m) obj << "v " << p.x << " " << p.y << " " << p.z << "\n";
        for (const glm::uvec3& f : t.mesh.triangles)
          obj << "f " << f.x + 1 << " " << f.y + 1 << " " << f.z + 1 << "\n";
      }
      scene << "[[model]]\nname = \"m" << n << "\"\nfile = \"" << file << "\"\n";
      if (t.voxels == 0) scene << "up = \"z\"\n";
    }
    for (std::size_t n = 0; n < things.size(); ++n) {
      const Thing& t = things[n];
      scene << "[[object]]\nmodel = \"m" << n << "\"\nname = \"" << t.name << "\"\nlon = " << t.place.lon_deg
            << "\nlat = " << t.place.lat_deg << "\naltitude = " << t.altitude_m
            << "\nheading = " << t.heading_deg << "\npitch = " << t.pitch_deg << "\nroll = " << t.roll_deg
            << "\nscale = " << t.scale << "\n";
    }
    write_text(dir_ / "a.scene.toml", scene.str());
    return "a.scene.toml";
  }

  json ask(const std::vector<mars::LonLat>& places, const Words& more) const {
    std::ostringstream input;
    input.precision(17);
    for (const mars::LonLat& p : places) input << p.lon_deg << "," << p.lat_deg << "\n";
    Words words{"query", planet().string(), "--json", "--all-surfaces"};
    words.insert(words.end(), more.begin(), more.end());
    const Result result = vpe(words, input.str());
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return parse_json(result.out);
  }

  // Returns the ground's height at a place.
  double ground_m(const mars::LonLat& place) const { return ask({place}, {})[0]["elevation_m"].get<double>(); }
};

}  // namespace app_test
