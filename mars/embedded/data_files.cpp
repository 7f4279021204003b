#include "mars/embedded/data_files.h"

#include <cstdlib>
#include <filesystem>

namespace mars {

namespace fs = std::filesystem;

std::vector<std::string> data_folders() {
  if (const char* chosen = std::getenv("VPE_DATA"); chosen != nullptr && *chosen != '\0') return {chosen};
  std::vector<std::string> folders;
  std::error_code none;
  const fs::path program = fs::read_symlink("/proc/self/exe", none);
  if (!program.empty()) {
    folders.push_back((program.parent_path().parent_path() / "share/vpe").string());
    folders.push_back((program.parent_path() / "share").string());
  }
  folders.emplace_back(VPE_INSTALLED_DATA);
  folders.emplace_back(VPE_SOURCE_DATA);
  folders.emplace_back(VPE_SOURCE_SCRIPTS);
  return folders;
}

std::string find_data_file(const std::string& name) {
  for (const std::string& folder : data_folders()) {
    std::error_code none;
    const fs::path path = fs::path(folder) / name;
    if (fs::is_regular_file(path, none)) return path.string();
  }
  return {};
}

}  // namespace mars
