// Scene files and what reading them says.
#pragma once

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

#include "objects/files/scene_file.h"

namespace objects::test {

inline const std::string kModel = "version = 1\n[[model]]\nname = \"m\"\nfile = \"m.glb\"\n";

inline const std::string kWhole = R"(version = 1

[[model]]
name = "rover"
file = "models/../rover.glb"
unit_m = 0.01
up = "y"

[[model]]
name = "stone"
file = "/data/stone.stl"
up = "z"

[[model]]
name = "plain"
file = "plain.obj"
up = "auto"

[[object]]
name = "Rover 1"
model = "rover"
lon = 270
lat = -4.6
height = 1.5
heading = 90
pitch = -3
roll = 2.5
scale = 2
align = "slope"
interest_levels = 2

[[object]]
model = "stone"
at = [[1, 2], [3, 4.5, 30]]
altitude = 100
heading = 5
align = "vertical"

[[scatter]]
name = "field"
models = ["stone", "plain"]
polygon = [[179.9, 0], [-179.9, 0], [180, 0.1]]
seed = 77
rock_abundance = 0.05
diameter_m = [0.5, 4]
buried = 0.25
align = "slope"
tumble = true
most = 5000

[[scatter]]
models = ["plain"]
polygon = [[0, 0], [1, 0], [1, 1], [0, 1]]
density_per_m2 = 0.01
exponent = 2.5
diameter_m = [1, 1]

[[path]]
name = "drive"
model = "rover"
points = [[0, 0, 0], [10.5, 1, 2, 45], [20, 3, 4]]
scale = 0.5
wheelbase_m = 2.9
track_m = 2.3

[[path]]
model = "stone"
points = [[-5, 180, 90]]
)";

inline SceneFile toml(const std::string& text) { return parse_scene_toml(text, "/scenes/a.scene.toml"); }
inline SceneFile geojson(const std::string& text) { return parse_scene_geojson(text, "/scenes/a.geojson"); }

template <class Parse>
std::string error_of(const Parse& parse, const std::string& text) {
  try {
    parse(text);
  } catch (const std::runtime_error& e) {
    return e.what();
  }
  return "no error";
}
inline std::string toml_error(const std::string& text) { return error_of(toml, text); }
inline std::string json_error(const std::string& text) { return error_of(geojson, text); }

// Either result is right; nothing else may happen.
template <class Parse>
bool is_read(const Parse& parse, const std::string& text) {
  try {
    parse(text);
    return true;
  } catch (const std::runtime_error& e) {
    EXPECT_TRUE(std::string(e.what()).starts_with("/scenes/a.")) << e.what();
    return false;
  }
}

}  // namespace objects::test
