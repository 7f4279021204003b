// Names of files as users type them.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>

namespace vpe::window {

// Returns the file that a name means: "~/" is the home folder.
inline std::filesystem::path in_home(const std::string& name) {
  const char* home = std::getenv("HOME");
  if (name.starts_with("~/") && home != nullptr && *home != '\0')
    return std::filesystem::path(home) / name.substr(2);
  return name;
}

}  // namespace vpe::window
