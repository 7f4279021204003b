#include "panorama/page/page_folder.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <string>
#include <vector>

#include "panorama/page/page_files.h"
#include "vpe/base/file.h"
#include "vpe/base/temporary.h"

namespace panorama {

namespace {

namespace fs = std::filesystem;
using vpe::base::file_error;

constexpr std::string_view kDraftEnd = ".tmp";
constexpr std::string_view kOldEnd = ".old";

// Returns true for names of files and folders at the top of a page's folder.
bool is_page_entry(const std::string& name) {
  static constexpr std::array<std::string_view, 6> kEntries{"index.html", "data.js", "preview.jpg",
                                                            "tiles",      "layers",  kViewerFolder};
  return std::find(kEntries.begin(), kEntries.end(), name) != kEntries.end() || name.starts_with("picture.");
}

enum class FolderState { kFree, kPage, kOther };

FolderState state_of(const fs::path& folder) {
  std::error_code error;
  const fs::file_status status = fs::status(folder, error);
  if (status.type() == fs::file_type::not_found) return FolderState::kFree;
  if (!fs::is_directory(status))
    throw file_error("write", folder, "it is no folder", "choose another name for the page's folder");
  bool is_empty = true;
  bool is_page = true;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    is_empty = false;
    is_page = is_page && is_page_entry(entry->path().filename().string());
  }
  if (error) throw file_error("read", folder, error.message(), "check the permissions");
  if (is_empty) return FolderState::kFree;
  std::ifstream data(folder / "data.js", std::ios::binary);
  std::string first;
  std::getline(data, first);
  return is_page && first == kPageMark ? FolderState::kPage : FolderState::kOther;
}

// Returns the folder itself, without links and a slash at the end.
fs::path plain_path(const fs::path& folder) {
  const fs::path path = folder.has_filename() ? folder : folder.parent_path();
  return vpe::base::resolve_links(path);
}

void rename_or_throw(const fs::path& from, const fs::path& to) {
  std::error_code error;
  fs::rename(from, to, error);
  if (error) throw file_error("write", to, error.message(), "check the permissions of its folder");
}

// Removes drafts of this page by processes that are gone.
void remove_stale_drafts(const fs::path& folder) {
  const fs::path parent = folder.has_parent_path() ? folder.parent_path() : fs::path(".");
  const std::string name = folder.filename().string();
  std::vector<fs::path> stale;
  std::error_code error;
  for (fs::directory_iterator entry(parent, error), end; !error && entry != end; entry.increment(error)) {
    std::string text = entry->path().filename().string();
    if (text.ends_with(kOldEnd)) text.resize(text.size() - kOldEnd.size());
    if (!text.starts_with(name + ".") || !text.ends_with(kDraftEnd)) continue;
    const std::string_view mark =
        std::string_view(text).substr(name.size(), text.size() - name.size() - kDraftEnd.size());
    if (vpe::base::is_abandoned(entry->path(), mark)) stale.push_back(entry->path());
  }
  for (const fs::path& path : stale) fs::remove_all(path, error);
}

}  // namespace

void check_page_folder(const fs::path& folder, bool force) {
  if (state_of(plain_path(folder)) != FolderState::kOther || force) return;
  throw file_error("write", folder, "the folder holds files that are not those of such a page",
                   "choose another folder, or write beside them with --force");
}

PageFolder::PageFolder(const fs::path& folder, bool force) : folder_(plain_path(folder)), force_(force) {
  check_page_folder(folder_, force_);
  remove_stale_drafts(folder_);
  draft_ = vpe::base::temporary_name(folder_);
  std::error_code error;
  fs::remove_all(draft_, error);
  if (!fs::create_directory(draft_, error)) {
    throw file_error("write", folder_, error.message(),
                     "make the folder that it shall be in, or check the permissions there");
  }
}

PageFolder::~PageFolder() {
  std::error_code ignored;
  if (!draft_.empty()) fs::remove_all(draft_, ignored);
}

void PageFolder::make(const fs::path& name) const {
  std::error_code error;
  fs::create_directories(draft_ / name, error);
  if (error)
    throw file_error("write", draft_ / name, error.message(), "make room or check the permissions there");
}

void PageFolder::write(const fs::path& name, std::string_view text) const {
  // The folder is a draft, so its files need no other names of their own.
  std::ofstream file(draft_ / name, std::ios::binary);
  file.write(text.data(), static_cast<std::streamsize>(text.size()));
  file.close();
  if (!file) {
    const std::error_code error(errno, std::generic_category());
    throw file_error("write", draft_ / name, error.message(),
                     "make room on the disk or check the permissions there");
  }
}

void PageFolder::copy(const fs::path& from, const fs::path& name) const {
  std::error_code error;
  fs::copy_file(from, draft_ / name, error);
  if (error) {
    throw file_error("copy", from, error.message(),
                     "make room on the disk of '" + folder_.string() + "', or leave the picture out");
  }
}

void PageFolder::finish() {
  const FolderState state = state_of(folder_);
  check_page_folder(folder_, force_);
  if (state == FolderState::kOther) {
    std::vector<fs::path> entries;
    for (const fs::directory_entry& entry : fs::directory_iterator(draft_)) entries.push_back(entry.path());
    for (const fs::path& entry : entries) {
      const fs::path to = folder_ / entry.filename();
      std::error_code error;
      fs::remove_all(to, error);
      rename_or_throw(entry, to);
    }
  } else if (state == FolderState::kPage) {
    const fs::path old = draft_.string() + std::string(kOldEnd);
    rename_or_throw(folder_, old);
    try {
      rename_or_throw(draft_, folder_);
    } catch (...) {
      std::error_code ignored;
      fs::rename(old, folder_, ignored);
      throw;
    }
    std::error_code ignored;
    fs::remove_all(old, ignored);
  } else {
    rename_or_throw(draft_, folder_);
  }
}

}  // namespace panorama
