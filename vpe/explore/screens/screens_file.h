// Files of screens, *.screens.toml; docs/guide/screens.md describes all keys.
//
//   version = 1
//   scale = 10000                    # metres of the world for a metre of the room
//   head = [0, 0.5, 0.6]             # where the head rests
//   [[screen]]
//   name = "table"
//   monitor = 2
//   pixels = [1920, 1080]
//   upper_left = [-0.3, 0, -0.2]
//   upper_right = [0.3, 0, -0.2]
//   lower_left = [-0.3, 0, 0.1375]
#pragma once

#include <cstddef>
#include <filesystem>
#include <string_view>

#include "vpe/explore/screens/placed_screen.h"

namespace vpe::explore {

inline constexpr std::size_t kMostScreensFileBytes = std::size_t{1} << 20U;

// Return the screens of a file, and of a text that messages call `path`: fitted, at least one, with different names.
// Throw std::runtime_error "FILE:LINE: what" for a text that is wrong, and base::FileError for a file that cannot be read
// or has another name than *.screens.toml.
ScreenSet read_screens_file(const std::filesystem::path& path);
ScreenSet parse_screens_toml(std::string_view text, const std::filesystem::path& path);

// Returns true for the names of files of screens.
bool is_screens_path(const std::filesystem::path& path);

}  // namespace vpe::explore
