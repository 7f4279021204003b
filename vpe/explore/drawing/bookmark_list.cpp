#include "vpe/explore/drawing/bookmark_list.h"

#include <algorithm>
#include <utility>

namespace vpe::explore {

namespace {

std::string bookmark_name(const Bookmark& bookmark) {
  return bookmark.key != 0 ? "bookmark " + std::to_string(bookmark.key) : "bookmark '" + bookmark.name + "'";
}

}  // namespace

std::optional<Bookmark> BookmarkList::at_key(int key) const {
  const auto found = std::find_if(all_.begin(), all_.end(), [key](const Bookmark& b) { return b.key == key; });
  return key == 0 || found == all_.end() ? std::nullopt : std::optional(*found);
}

void BookmarkList::change(std::vector<Bookmark> next, std::string what) {
  std::size_t bytes = 0;
  for (const Bookmark& b : all_) bytes += sizeof b + b.name.size();
  steps_.keep(std::exchange(all_, std::move(next)), bytes, std::move(what));
  ++revision_;
}

std::string BookmarkList::put(const Bookmark& bookmark) {
  Bookmarks checked;
  if (std::string problem = checked.put(bookmark); !problem.empty()) return problem;
  std::vector<Bookmark> next = all_;
  const auto same_place = [&bookmark](const Bookmark& b) {
    return b.key == bookmark.key && (b.key != 0 || b.name == bookmark.name);
  };
  const auto found = std::find_if(next.begin(), next.end(), same_place);
  if (found != next.end())
    *found = checked.all().front();
  else
    next.push_back(checked.all().front());
  change(std::move(next), "set " + bookmark_name(bookmark));
  return "";
}

std::string BookmarkList::rename(std::size_t index, std::string_view name) {
  Bookmarks checked;
  for (const Bookmark& bookmark : all_)
    if (std::string problem = checked.put(bookmark); !problem.empty()) return problem;
  if (std::string problem = checked.rename(index, name); !problem.empty()) return problem;
  if (checked.all()[index].name == all_[index].name) return "";
  change(checked.all(), "rename " + bookmark_name(all_[index]));
  return "";
}

bool BookmarkList::remove(std::size_t index) {
  if (index >= all_.size()) return false;
  std::vector<Bookmark> next = all_;
  std::string what = "delete " + bookmark_name(next[index]);
  next.erase(next.begin() + static_cast<std::ptrdiff_t>(index));
  change(std::move(next), std::move(what));
  return true;
}

void BookmarkList::load(std::vector<Bookmark> bookmarks) {
  all_ = std::move(bookmarks);
  steps_.clear();
  ++revision_;
  mark_saved();
}

}  // namespace vpe::explore
