#include "vpe/explore/files/user_files.h"

#include <sys/stat.h>

#include <cerrno>
#include <system_error>

#include "vpe/base/file.h"

namespace vpe::explore {

namespace fs = std::filesystem;

namespace {

constexpr std::uintmax_t kMaxBytes = 1U << 20U;

void create_folders(const fs::path& folder) {
  std::error_code ignored;
  if (folder.empty() || fs::is_directory(folder, ignored)) return;
  create_folders(folder.parent_path());
  if (::mkdir(folder.c_str(), 0700) != 0 && errno != EEXIST) {
    throw base::file_error(
        "create the folder", folder, std::generic_category().message(errno),
        "check the permissions there, or set XDG_CONFIG_HOME and XDG_STATE_HOME to other folders");
  }
}

}  // namespace

std::optional<std::string> read_user_file(const fs::path& file) {
  std::error_code failure;
  if (fs::status(file, failure).type() == fs::file_type::not_found) return std::nullopt;
  const std::vector<std::uint8_t> bytes = base::read_file(file, kMaxBytes);
  return std::string(bytes.begin(), bytes.end());
}

void write_user_file(const fs::path& file, std::string_view text) {
  create_folders(file.parent_path());
  base::write_file(file, text);
}

}  // namespace vpe::explore
