#include "vpe/explore/files/unsaved_copy.h"

#include <algorithm>
#include <exception>
#include <string_view>
#include <system_error>
#include <utility>

#include "vpe/base/temporary.h"
#include "vpe/explore/files/user_files.h"

namespace vpe::explore {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view kUnsavedBegin = "unsaved";

}  // namespace

UnsavedCopy::UnsavedCopy(fs::path folder, std::string extension, std::string noun)
    : folder_(std::move(folder)), extension_(std::move(extension)), noun_(std::move(noun)) {
  if (!folder_.empty()) file_ = folder_ / (std::string(kUnsavedBegin) + base::process_mark() + extension_);
}

std::string UnsavedCopy::update(const State& state, bool is_unsaved,
                                const std::function<std::string()>& to_text) {
  if (file_.empty() || state == seen_) return {};
  seen_ = state;
  if (is_unsaved) {
    try {
      write_user_file(file_, to_text());
      exists_ = true;
      return {};
    } catch (const std::exception& e) {
      return "the unsaved " + noun_ + " has no copy: " + e.what();
    }
  }
  std::error_code ignored;
  if (exists_) fs::remove(file_, ignored);
  exists_ = false;
  return {};
}

std::vector<fs::path> UnsavedCopy::abandoned() const {
  std::vector<std::pair<fs::file_time_type, fs::path>> found;
  std::error_code error;
  for (fs::directory_iterator entry(folder_, error), end; !error && entry != end; entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    std::error_code failed;
    if (!name.starts_with(kUnsavedBegin) || !name.ends_with(extension_)) continue;
    if (!fs::is_regular_file(entry->symlink_status(failed)) || failed) continue;
    if (name.size() < kUnsavedBegin.size() + extension_.size()) continue;
    const std::string_view mark = std::string_view(name).substr(
        kUnsavedBegin.size(), name.size() - kUnsavedBegin.size() - extension_.size());
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

void UnsavedCopy::adopt(const fs::path& copy) {
  fs::rename(copy, file_);
  exists_ = true;
}

}  // namespace vpe::explore
