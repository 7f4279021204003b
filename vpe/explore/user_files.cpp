#include "vpe/explore/user_files.h"

#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <span>
#include <system_error>

#include "vpe/core/file.h"

namespace vpe::explore {

namespace fs = std::filesystem;

namespace {

constexpr std::uintmax_t kMaxBytes = 1U << 20U;

fs::path folder(const Environment& environment, const char* variable, const char* in_home) {
  const auto absolute = [&environment](const char* name) {
    const char* value = environment(name);
    return value != nullptr && fs::path(value).is_absolute() ? fs::path(value) : fs::path();
  };
  if (const fs::path set = absolute(variable); !set.empty()) return set / "vpe";
  if (const fs::path home = absolute("HOME"); !home.empty()) return home / in_home / "vpe";
  return {};
}

void make_folders(const fs::path& folder) {
  std::error_code ignored;
  if (folder.empty() || fs::is_directory(folder, ignored)) return;
  make_folders(folder.parent_path());
  if (::mkdir(folder.c_str(), 0700) != 0 && errno != EEXIST) {
    throw core::file_error(
        "make the folder", folder, std::generic_category().message(errno),
        "check the permissions there, or set XDG_CONFIG_HOME and XDG_STATE_HOME to other folders");
  }
}

}  // namespace

Environment process_environment() {
  return [](const char* name) -> const char* { return std::getenv(name); };
}

fs::path config_folder(const Environment& environment) {
  return folder(environment, "XDG_CONFIG_HOME", ".config");
}
fs::path state_folder(const Environment& environment) {
  return folder(environment, "XDG_STATE_HOME", ".local/state");
}

std::optional<std::string> read_user_file(const fs::path& file) {
  std::error_code failure;
  if (fs::status(file, failure).type() == fs::file_type::not_found) return std::nullopt;
  const std::vector<std::uint8_t> bytes = core::read_file(file, kMaxBytes);
  return std::string(bytes.begin(), bytes.end());
}

void write_user_file(const fs::path& file, std::string_view text) {
  make_folders(file.parent_path());
  std::error_code failure;
  fs::path target = fs::canonical(file, failure);
  if (failure) target = file;
  core::OutputFile out(target, target.string() + "." + std::to_string(::getpid()) + ".tmp");
  out.write({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  out.commit();
}

}  // namespace vpe::explore
