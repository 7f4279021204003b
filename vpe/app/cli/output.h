// Checks of output paths before the work begins. All functions throw std::runtime_error that names the path,
// what is wrong, and what to do.
#pragma once

#include <filesystem>

namespace vpe::app {

// Checks that a file can be made or replaced: its path is not a folder, and its folder exists and may be
// written to.
void check_output(const std::filesystem::path& path);

// Check, beside check_output(), that the extension names a format: .png, .jpg or .jpeg; .tif or .tiff; .csv or
// .jsonl.
void check_image_output(const std::filesystem::path& path);
void check_range_output(const std::filesystem::path& path);
void check_stats_output(const std::filesystem::path& path);

// Checks the output of a film. Returns true for a video, and false for a folder of images, which need not exist
// yet.
bool check_film_output(const std::filesystem::path& path);

// Makes a folder, and the folders above it, unless it exists.
void make_folder(const std::filesystem::path& path);

}  // namespace vpe::app
