// Checksums of scenes and their models, kept as long as the files do not change: a film asks for them for each frame.
//
// Typical usage:
//   SceneDigests scenes;
//   for (const std::string& checksum : scenes.of("gale.scene.toml").checksums) digest.add(checksum);
#pragma once

#include <filesystem>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "vpe/base/file.h"

namespace vpe::app {

// Any thread may call any member.
class SceneDigests {
 public:
  struct Known {
    std::vector<std::string> checksums;  // of the scene file and of its models
    bool has_paths = false;              // objects move with time
  };
  // Returns what holds for a scene file now. Reads its files when one of them has changed since the last call. Throws what
  // objects::read_scene_file() throws, and base::FileError.
  Known of(const std::string& scene_file);

 private:
  struct Entry {
    std::vector<std::pair<std::filesystem::path, std::optional<base::FileStamp>>> stamps;
    Known known;
  };
  std::mutex mutex_;
  std::map<std::string, Entry> entries_;
};

}  // namespace vpe::app
