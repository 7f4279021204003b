#include "vpe/base/user_folders.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <string>

namespace vpe::base {

namespace fs = std::filesystem;

namespace {

struct FolderSource {
  const char* variable;
  const char* in_home;
};

constexpr std::array<FolderSource, 4> kSources{{{"XDG_CACHE_HOME", ".cache"},
                                                {"XDG_CONFIG_HOME", ".config"},
                                                {"XDG_DATA_HOME", ".local/share"},
                                                {"XDG_STATE_HOME", ".local/state"}}};

fs::path absolute(const Environment& environment, const char* name) {
  const char* value = environment(name);
  return value != nullptr && fs::path(value).is_absolute() ? fs::path(value) : fs::path();
}

}  // namespace

Environment process_environment() {
  return [](const char* name) -> const char* { return std::getenv(name); };
}

fs::path user_folder(UserFolder folder, const Environment& environment) {
  const FolderSource& source = kSources[static_cast<std::size_t>(folder)];
  if (const fs::path set = absolute(environment, source.variable); !set.empty()) return set / "vpe";
  if (const fs::path home = absolute(environment, "HOME"); !home.empty()) return home / source.in_home / "vpe";
  return {};
}

std::vector<fs::path> config_folders(const Environment& environment) {
  std::vector<fs::path> folders;
  if (fs::path user = user_folder(UserFolder::kConfig, environment); !user.empty())
    folders.push_back(std::move(user));
  const char* listed = environment("XDG_CONFIG_DIRS");
  const std::string system = listed != nullptr && *listed != '\0' ? listed : "/etc/xdg";
  for (std::size_t begin = 0; begin <= system.size();) {
    const std::size_t end = std::min(system.find(':', begin), system.size());
    const fs::path folder = system.substr(begin, end - begin);
    if (folder.is_absolute()) folders.push_back(folder / "vpe");
    begin = end + 1;
  }
  return folders;
}

}  // namespace vpe::base
