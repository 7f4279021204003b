// The bookmarks of a project, edited with undo. Those of the user are a file of their own (files/bookmarks.h).
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "vpe/explore/drawing/undo_steps.h"
#include "vpe/explore/files/bookmarks.h"

namespace vpe::explore {

// Holds bookmarks. For one thread at a time.
class BookmarkList : public UndoStore {
 public:
  static constexpr std::size_t kUndoBytes = std::size_t{4} << 20;

  std::span<const Bookmark> all() const { return all_; }
  std::optional<Bookmark> at_key(int key) const;

  // Stores a bookmark. Replaces the one with the same key, or, without a key, the one with the same name;
  // otherwise appends it. Returns what is wrong, or ""; a bad bookmark changes nothing.
  [[nodiscard]] std::string put(const Bookmark& bookmark);
  // Renames a bookmark, given by its position. Returns what is wrong, or ""; then nothing is changed.
  [[nodiscard]] std::string rename(std::size_t index, std::string_view name);
  // Removes a bookmark by its position. Returns false if there is none.
  bool remove(std::size_t index);
  // Replaces all, without undo, as saved ones.
  void load(std::vector<Bookmark> bookmarks);

  // Return numbers that change with each edit, and whether there are edits since load() or mark_saved().
  std::uint64_t revision() const { return revision_; }
  bool is_changed() const { return revision_ != saved_; }
  void mark_saved() { saved_ = revision_; }

  UndoState undo_state() const override { return steps_.state(); }
  std::string undo_text() const override { return steps_.undo_text(); }
  std::string redo_text() const override { return steps_.redo_text(); }
  bool undo() override { return steps_.undo(all_) && ++revision_ > 0; }
  bool redo() override { return steps_.redo(all_) && ++revision_ > 0; }
  void forget_redo() override { steps_.forget_redo(); }

 private:
  void change(std::vector<Bookmark> next, std::string what);

  std::vector<Bookmark> all_;
  std::uint64_t revision_ = 1;
  std::uint64_t saved_ = 1;
  UndoSteps<std::vector<Bookmark>> steps_{kUndoBytes};
};

}  // namespace vpe::explore
