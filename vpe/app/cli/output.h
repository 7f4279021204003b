// What can be said about an output before the work begins. All throw std::runtime_error with the path, what is
// wrong and what to do.
#pragma once

#include <filesystem>

namespace vpe::app {

// The file can be made or replaced: it is no folder, and the folder it lies in is there and may be written to.
void check_output(const std::filesystem::path& path);

// check_output(), and a name whose extension says the format.
void check_image_output(const std::filesystem::path& path);
void check_range_output(const std::filesystem::path& path);
void check_stats_output(const std::filesystem::path& path);

// True for a video, false for a folder of images, which may have to be made.
bool check_film_output(const std::filesystem::path& path);

void make_folder(const std::filesystem::path& path);

}  // namespace vpe::app
