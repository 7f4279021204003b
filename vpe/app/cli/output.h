// Checks of output paths before the work begins. Errors name the path, what is wrong, and what to do; they are
// std::runtime_error where nothing else is said.
//
// Typical usage:
//   check_outputs({{"-o", output, FileKind::kImage}, {"--range", range, FileKind::kRange}}, {planet});
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "vpe/app/cli/file_kind.h"

namespace vpe::app {

// A file that a command writes.
struct Output {
  std::string option;  // that names it, such as "--log"; for messages
  std::filesystem::path path;
  FileKind kind;
};

// Checks all outputs of a command before its work, and removes temporary files that dead writers of the same
// outputs left. Outputs and inputs with an empty path are left out; inputs need not exist. Throws UsageError
// for an output that is an input or another output, also through links, and std::runtime_error for one that
// check_output() refuses, whose extension names no format of its kind, or that exists and is not of its kind
// (is_of_kind()). Empty files, pipes and character devices may always be written.
void check_outputs(const std::vector<Output>& outputs, const std::vector<std::filesystem::path>& inputs);

// Checks one file as check_outputs() does: one that exists is of this kind, or empty.
void check_kind(const std::filesystem::path& path, FileKind kind);

// Checks that a file can be made or replaced: its path is not a folder or device, and its folder exists and may
// be written to. Follows symbolic links.
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
