#include "vpe/app/cli/output.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <string>

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

}  // namespace

void check_output(const fs::path& path) {
  std::error_code error;
  if (!path.has_filename() || fs::is_directory(path, error))
    fail(path, "it is a folder; give the name of a file");
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
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
