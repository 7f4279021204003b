// Scene files as TOML.
//
// Typical usage:
//   write_scene_file(scene, "gale.scene.toml");   // read_scene_file() returns the same scene
#pragma once

#include <filesystem>
#include <string>

#include "objects/files/scene_file.h"

namespace objects {

// Returns the text of a scene file that is to lie at `file`. parse_scene_toml(text, file) returns the same scene, numbers to
// the bit, except: its path is `file`; the places of one object that differ in more than place and heading are objects of
// their own; an object that has no place is left out; `where` of scatters names their new lines. Comments of a file that the
// scene was read from are no part of a scene, and are not written. Defaults are left out.
//
// Files of models are named relative to the folder of `file` where one relative path leads there, also upwards, else by
// their whole path. Numbers must be such as scene files may have (scene_limits.h). Throws std::invalid_argument for a text
// that no scene file can hold (a name with control characters or not in UTF-8), for a model that is not there, and for a
// scene that is too large.
std::string to_toml(const SceneFile& scene, const std::filesystem::path& file);

// Replaces a file by the text of the scene at once. Throws what to_toml() throws, and vpe::base::FileError.
void write_scene_file(const SceneFile& scene, const std::filesystem::path& file);

}  // namespace objects
