#include "vpe/explore/flight_backup.h"

#include <algorithm>
#include <exception>
#include <system_error>

#include "vpe/base/temporary.h"
#include "vpe/explore/files/user_files.h"

namespace vpe::explore {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view kBegin = "unsaved";
constexpr std::string_view kExtension = ".flight";

}  // namespace

FlightBackup::FlightBackup(fs::path folder) : folder_(std::move(folder)) {
  if (!folder_.empty())
    file_ = folder_ / (std::string(kBegin) + base::process_mark() + std::string(kExtension));
}

std::string FlightBackup::update(const FlightEditor* editor) {
  if (file_.empty()) return {};
  const std::pair<std::uint64_t, std::uint64_t> now = editor == nullptr
                                                          ? std::pair<std::uint64_t, std::uint64_t>{0, 0}
                                                          : std::pair{editor->revision(), editor->saves()};
  if (now == seen_) return {};
  seen_ = now;
  if (editor != nullptr && editor->is_changed()) {
    try {
      write_user_file(file_, editor->to_text());
      exists_ = true;
      return {};
    } catch (const std::exception& e) {
      return std::string("the unsaved flight has no copy: ") + e.what();
    }
  }
  std::error_code ignored;
  if (exists_) fs::remove(file_, ignored);
  exists_ = false;
  return {};
}

std::vector<fs::path> FlightBackup::abandoned() const {
  std::vector<std::pair<fs::file_time_type, fs::path>> found;
  std::error_code error;
  for (fs::directory_iterator entry(folder_, error), end; !error && entry != end; entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    std::error_code failed;
    if (!name.starts_with(kBegin) || !name.ends_with(kExtension)) continue;
    if (!fs::is_regular_file(entry->symlink_status(failed)) || failed) continue;
    const std::string_view mark =
        std::string_view(name).substr(kBegin.size(), name.size() - kBegin.size() - kExtension.size());
    if (!base::is_abandoned(entry->path(), mark)) continue;
    const fs::file_time_type written = fs::last_write_time(entry->path(), failed);
    if (!failed) found.emplace_back(written, entry->path());
  }
  std::ranges::sort(found, std::greater<>());
  std::vector<fs::path> files;
  files.reserve(found.size());
  for (auto& [written, file] : found) files.push_back(std::move(file));
  return files;
}

void FlightBackup::adopt(const fs::path& copy) {
  fs::rename(copy, file_);
  exists_ = true;
}

}  // namespace vpe::explore
