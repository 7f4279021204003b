// Views kept under a key or a name, in a text file that people may edit.
//
// One bookmark a line: N lon lat alt yaw pitch roll fov name. N is the key 1..9, or - for none; degrees, metres
// above the planet's sphere; the name is the rest of the line and may be left out. Lines that begin with # and
// empty lines are kept where they are.
//
//   # N lon lat alt yaw pitch roll fov name
//   1 -74.2 -13.5 12000 90 -15 0 60 Valles Marineris, west
//   - 137.4 -4.6 -3500 0 -5 0 60 Below Mount Sharp
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "vpe/explore/files/saved_view.h"
#include "vpe/explore/files/text_lines.h"

namespace vpe::explore {

struct Bookmark {
  int key = 0;  // 1..9; 0: none
  SavedView view;
  std::string name;
};

struct ParsedBookmarks;

class Bookmarks {
 public:
  // In the order of the file.
  std::vector<Bookmark> all() const;

  // Nothing when there is none.
  std::optional<Bookmark> at_key(int key) const;
  std::optional<Bookmark> named(std::string_view name) const;

  // In the place of the one with the same key; without a key, of the one of the same name without a key; else
  // at the end. Blanks about the name are dropped. Returns what is wrong, empty when all is well; then nothing
  // changes.
  [[nodiscard]] std::string put(Bookmark bookmark);

  // By position in all(); false where there is none.
  bool remove(std::size_t index);

  // parse_bookmarks() reads the same bookmarks back, to the bit. Lines of the file that were not replaced are
  // as they were.
  std::string to_text() const;

 private:
  friend ParsedBookmarks parse_bookmarks(std::string_view text, const std::string& name);

  struct Line {
    std::string text;
    std::optional<Bookmark> bookmark;
  };
  std::vector<Line> lines_;
};

// Either bookmarks and no errors, or no bookmarks and what is wrong (the first kMaxErrors): a file with a bad
// line is refused, so that saving cannot lose it.
struct ParsedBookmarks {
  static constexpr std::size_t kMaxErrors = 20;
  std::optional<Bookmarks> bookmarks;
  std::vector<LineError> errors;
};

// Any text is allowed. `name` is what errors call the file.
ParsedBookmarks parse_bookmarks(std::string_view text, const std::string& name);

// A file that is not there holds no bookmarks. Throws base::FileError when it cannot be read.
ParsedBookmarks load_bookmarks(const std::filesystem::path& path);

// The file appears whole or stays as it was; its folder is made when missing, and a link is followed. Throws
// base::FileError. Of two programs that save, the last one counts: load, change and save in one go.
void save_bookmarks(const std::filesystem::path& path, const Bookmarks& bookmarks);

}  // namespace vpe::explore
