// Views stored under a key or a name, in a text file that people may edit.
//
// The file has one bookmark a line: N lon lat alt yaw pitch roll fov name. N is the key 1..9, or - for none.
// Angles are in degrees, the altitude in metres above the planet's sphere. The name is the rest of the line and
// may be left out. Lines that begin with # and empty lines are preserved.
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

// Holds the lines of a bookmarks file.
//
// Typical usage:
//   ParsedBookmarks parsed = load_bookmarks(path);
//   if (!parsed.bookmarks) return report(parsed.errors);
//   const std::string problem = parsed.bookmarks->put({1, view, "Home"});
//   if (!problem.empty()) return show(problem);
//   save_bookmarks(path, *parsed.bookmarks);
class Bookmarks {
 public:
  // Returns all bookmarks in the order of the file.
  std::vector<Bookmark> all() const;

  // Return a bookmark, or nullopt if there is none.
  std::optional<Bookmark> at_key(int key) const;
  std::optional<Bookmark> named(std::string_view name) const;

  // Stores a bookmark. Replaces the one with the same key, or, without a key, the one with the same name and no
  // key; otherwise appends it. Removes blanks around the name. Returns what is wrong, or ""; a bad bookmark
  // changes nothing.
  [[nodiscard]] std::string put(Bookmark bookmark);

  // Renames the bookmark at a position of all(), which keeps its line. Returns what is wrong, or "": no other
  // bookmark without a key may have the name of one without a key.
  [[nodiscard]] std::string rename(std::size_t index, std::string_view name);

  // Removes the bookmark at a position of all(). Returns false if there is none.
  bool remove(std::size_t index);

  // Returns the text of the file. parse_bookmarks() reads the same bookmarks back, bit by bit. Lines that were
  // not replaced are unchanged.
  std::string to_text() const;

 private:
  friend ParsedBookmarks parse_bookmarks(std::string_view text, const std::string& name);

  struct Line {
    std::string text;
    std::optional<Bookmark> bookmark;
  };
  std::vector<Line>::iterator line_of(std::size_t index);

  std::vector<Line> lines_;
};

// Holds either bookmarks, or errors (the first kMaxErrors). A file with a bad line is rejected as a whole, so
// that saving cannot lose the line.
struct ParsedBookmarks {
  static constexpr std::size_t kMaxErrors = 20;
  std::optional<Bookmarks> bookmarks;
  std::vector<LineError> errors;
};

// Parses any text. `name` is the file's name in errors.
ParsedBookmarks parse_bookmarks(std::string_view text, const std::string& name);

// Reads a file; a file that does not exist holds no bookmarks. Throws base::FileError if it cannot be read.
ParsedBookmarks load_bookmarks(const std::filesystem::path& path);

// Replaces the file atomically. Creates its folder if needed, and follows a link. Throws base::FileError. If
// two programs save, the later one wins: load, change and save without delay.
void save_bookmarks(const std::filesystem::path& path, const Bookmarks& bookmarks);

}  // namespace vpe::explore
