#include "vpe/app/cli/output.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <string>

#include "vpe/app/cli/program.h"
#include "vpe/base/file.h"
#include "vpe/base/temporary.h"
#include "vpe/core/image/image.h"

namespace vpe::app {

namespace fs = std::filesystem;

namespace {

[[noreturn]] void fail(const fs::path& path, const std::string& why) {
  throw std::runtime_error(path.string() + ": cannot write: " + why);
}

std::string extension(const fs::path& path) {
  std::string text = path.extension().string();
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

// Returns true for what is written to instead of replaced.
bool is_stream(const fs::path& path) {
  std::error_code none;
  const fs::file_status status = fs::status(path, none);
  return fs::is_fifo(status) || fs::is_character_file(status);
}

// Returns true if both paths are, or would become, one file.
bool is_same_file(const fs::path& a, const fs::path& b) {
  std::error_code error;
  if (fs::equivalent(a, b, error)) return !error;
  const fs::path whole = fs::weakly_canonical(base::resolve_links(a), error);
  return !error && whole == fs::weakly_canonical(base::resolve_links(b), error) && !error;
}

void check_name(const Output& output) {
  switch (output.kind) {
    case FileKind::kImage: return check_image_output(output.path);
    case FileKind::kMap:
      if (extension(output.path) != ".tif" && extension(output.path) != ".tiff")
        fail(output.path, "maps are GeoTIFF files; let the name end in .tif");
      return check_output(output.path);
    case FileKind::kRange: return check_range_output(output.path);
    case FileKind::kStatistics: return check_stats_output(output.path);
    case FileKind::kPlanet:
      if (is_stream(output.path)) fail(output.path, "a planet is a database; give the name of a file");
      return check_output(output.path);
    default: return check_output(output.path);
  }
}

void check_distinct(const Output& output, std::span<const Output> earlier, std::span<const fs::path> inputs) {
  for (const fs::path& input : inputs) {
    if (input.empty() || !is_same_file(output.path, input)) continue;
    throw UsageError(output.option + " " + output.path.string() + ": is also an input, '" + input.string() +
                     "'; give the output another name");
  }
  for (const Output& other : earlier) {
    if (other.path.empty() || !is_same_file(output.path, other.path)) continue;
    throw UsageError(output.option + " " + output.path.string() + ": is also the output of " + other.option +
                     "; give each its own name");
  }
}

void remove_stale(const fs::path& path) {
  const fs::path target = base::resolve_links(path);
  base::remove_stale_temporaries(
      target.has_parent_path() ? target.parent_path() : fs::path("."),
      [name = target.filename().string()](const std::string& other) { return other == name; });
}

}  // namespace

void check_outputs(const std::vector<Output>& outputs, const std::vector<fs::path>& inputs) {
  for (std::size_t n = 0; n < outputs.size(); ++n) {
    const Output& output = outputs[n];
    if (output.path.empty()) continue;
    check_name(output);
    if (is_stream(output.path)) continue;
    check_distinct(output, std::span(outputs).first(n), inputs);
    check_kind(output.path, output.kind);
    remove_stale(output.path);
  }
}

void check_kind(const fs::path& path, FileKind kind) {
  std::error_code none;
  if (fs::is_directory(path, none)) fail(path, "it is a directory; move it, or give the output another name");
  if (!fs::exists(path, none) || fs::file_size(path, none) == 0 || is_of_kind(path, kind)) return;
  fail(path,
       std::string("it exists and is not ") + name_of(kind) + "; move it, or give the output another name");
}

void check_output(const fs::path& path) {
  std::error_code error;
  const fs::path target = base::resolve_links(path);
  const fs::file_status status = fs::status(target, error);
  if (!path.has_filename() || fs::is_directory(status)) fail(path, "it is a folder; give the name of a file");
  if (fs::is_block_file(status) || fs::is_socket(status))
    fail(path, "it is a device or socket; give the name of a file");
  if (is_stream(target)) {
    if (::access(target.c_str(), W_OK) != 0)
      fail(path, std::string(std::strerror(errno)) + "; give another name");
    return;
  }
  const fs::path folder = target.has_parent_path() ? target.parent_path() : fs::path(".");
  if (!fs::is_directory(folder, error))
    fail(path, "there is no folder '" + folder.string() + "'; make it first");
  if (::access(folder.c_str(), W_OK) != 0) {
    fail(path, "folder '" + folder.string() + "': " + std::strerror(errno) +
                   "; choose another or change its permissions");
  }
}

void check_image_output(const fs::path& path) {
  if (!core::is_image_path(path)) fail(path, "no known image format; let the name end in .png, .jpg or .jpeg");
  check_output(path);
}

void check_range_output(const fs::path& path) {
  const std::string end = extension(path);
  if (end != ".tif" && end != ".tiff") fail(path, "ranges need 32-bit numbers; let the name end in .tif");
  check_output(path);
}

void check_stats_output(const fs::path& path) {
  const std::string end = extension(path);
  if (end != ".csv" && end != ".jsonl")
    fail(path, "no known format for statistics; let the name end in .csv or .jsonl");
  check_output(path);
}

bool check_film_output(const fs::path& path) {
  const std::string end = extension(path);
  if (end == ".mp4") {
    check_output(path);
    if (is_stream(path)) fail(path, "a film is read back; give the name of a file");
    return true;
  }
  constexpr std::array kOtherFiles{".mov", ".mkv", ".avi", ".webm", ".m4v", ".gif", ".png", ".jpg", ".jpeg"};
  if (std::find(kOtherFiles.begin(), kOtherFiles.end(), end) != kOtherFiles.end()) {
    fail(path, "a film is an .mp4, or a folder of PNG frames");
  }
  std::error_code error;
  if (fs::exists(path, error) && !fs::is_directory(path, error)) {
    fail(path, "it is a file, not a folder for frames; give a folder, or let the name end in .mp4");
  }
  return false;
}

void make_folder(const fs::path& path) {
  std::error_code error;
  fs::create_directories(path, error);
  if (error)
    throw std::runtime_error(path.string() + ": cannot make the folder: " + error.message() +
                             "; choose another");
}

}  // namespace vpe::app
