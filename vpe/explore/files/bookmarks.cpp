#include "vpe/explore/files/bookmarks.h"

#include <algorithm>
#include <array>
#include <system_error>

#include "vpe/base/file.h"
#include "vpe/base/number.h"
#include "vpe/base/quote.h"

namespace vpe::explore {

namespace {

namespace fs = std::filesystem;

constexpr int kLastKey = 9;
constexpr std::uintmax_t kLargestFile = 4 << 20;
constexpr std::string_view kBookmarkBlanks = " \t\r\v\f";
constexpr const char* kHeader = "# vpe bookmarks: N lon lat alt yaw pitch roll fov name";

std::string_view trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(kBookmarkBlanks);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(kBookmarkBlanks) - begin + 1);
}

std::string_view take_word(std::string_view& line) {
  line = trimmed(line);
  const std::string_view word = line.substr(0, line.find_first_of(kBookmarkBlanks));
  line.remove_prefix(word.size());
  return word;
}

std::string to_line(const Bookmark& b) {
  std::string line = b.key == 0 ? "-" : std::to_string(b.key);
  const mars::Pose& p = b.view.pose;
  for (const double value :
       {p.lon_deg, p.lat_deg, p.alt_m, p.yaw_deg, p.pitch_deg, p.roll_deg, b.view.fov_deg}) {
    line += " " + base::format_number(value);
  }
  return b.name.empty() ? line : line + " " + b.name;
}

// Parses a bookmark; sets `fault` to what was expected if it is wrong.
Bookmark read_line(std::string_view line, std::string& fault) {
  Bookmark b;
  const std::string_view key = take_word(line);
  if (const auto number = base::parse_integer(key); number && *number >= 1 && *number <= kLastKey) {
    b.key = static_cast<int>(*number);
  } else if (key != "-") {
    fault = "a key from 1 to 9, or - for none, found " + base::quote_text(key);
    return b;
  }
  mars::Pose& p = b.view.pose;
  const std::array<const char*, 7> names{"lon", "lat", "alt", "yaw", "pitch", "roll", "fov"};
  const std::array<double*, 7> values{&p.lon_deg,   &p.lat_deg,  &p.alt_m,       &p.yaw_deg,
                                      &p.pitch_deg, &p.roll_deg, &b.view.fov_deg};
  for (std::size_t n = 0; n < names.size(); ++n) {
    const std::string_view word = take_word(line);
    const std::optional<double> number = base::parse_number(word);
    if (!number) {
      fault = std::string("a number for ") + names[n] +
              (word.empty() ? ", found the end of the line" : ", found " + base::quote_text(word));
      return b;
    }
    *values[n] = *number;
  }
  b.name = trimmed(line);
  if (const std::string problem = problem_of(b.view); !problem.empty())
    fault = "numbers in their range: " + problem;
  if (!is_one_line(b.name)) fault = "a name without control characters, found " + base::quote_text(b.name);
  return b;
}

}  // namespace

std::vector<Bookmark> Bookmarks::all() const {
  std::vector<Bookmark> list;
  for (const Line& line : lines_) {
    if (line.bookmark) list.push_back(*line.bookmark);
  }
  return list;
}

std::optional<Bookmark> Bookmarks::at_key(int key) const {
  for (const Line& line : lines_) {
    if (line.bookmark && line.bookmark->key == key && key != 0) return line.bookmark;
  }
  return std::nullopt;
}

std::optional<Bookmark> Bookmarks::named(std::string_view name) const {
  for (const Line& line : lines_) {
    if (line.bookmark && line.bookmark->name == name) return line.bookmark;
  }
  return std::nullopt;
}

std::string Bookmarks::put(Bookmark bookmark) {
  bookmark.name = std::string(trimmed(bookmark.name));
  if (bookmark.key < 0 || bookmark.key > kLastKey) return "a bookmark's key must be 1 to 9";
  if (!is_one_line(bookmark.name)) return "a bookmark's name must be one line of text";
  if (bookmark.key == 0 && bookmark.name.empty()) return "a bookmark needs a key or a name";
  if (std::string problem = problem_of(bookmark.view); !problem.empty()) return problem;
  const auto same_place = [&](const Line& line) {
    return line.bookmark && line.bookmark->key == bookmark.key &&
           (bookmark.key != 0 || line.bookmark->name == bookmark.name);
  };
  if (lines_.empty()) lines_.push_back({kHeader, std::nullopt});
  const auto found = std::find_if(lines_.begin(), lines_.end(), same_place);
  Line& line = found != lines_.end() ? *found : lines_.emplace_back();
  line = {to_line(bookmark), std::move(bookmark)};
  return "";
}

std::vector<Bookmarks::Line>::iterator Bookmarks::line_of(std::size_t index) {
  return std::ranges::find_if(lines_, [&index](const Line& line) { return line.bookmark && index-- == 0; });
}

std::string Bookmarks::rename(std::size_t index, std::string_view name) {
  const auto line = line_of(index);
  if (line == lines_.end()) return "there is no bookmark " + std::to_string(index + 1);
  Bookmark renamed = *line->bookmark;
  renamed.name = std::string(trimmed(name));
  if (!is_one_line(renamed.name)) return "a bookmark's name must be one line of text";
  if (renamed.key == 0) {
    if (renamed.name.empty()) return "a bookmark needs a key or a name";
    const auto is_other = [&](const Line& other) {
      return other.bookmark && &other != &*line && other.bookmark->key == 0 &&
             other.bookmark->name == renamed.name;
    };
    if (std::ranges::any_of(lines_, is_other))
      return "another bookmark is called " + base::quote_text(renamed.name);
  }
  *line = {to_line(renamed), std::move(renamed)};
  return "";
}

bool Bookmarks::remove(std::size_t index) {
  const auto line = line_of(index);
  if (line == lines_.end()) return false;
  lines_.erase(line);
  return true;
}

std::string Bookmarks::to_text() const {
  std::string text;
  for (const Line& line : lines_) text.append(line.text).append("\n");
  return text;
}

ParsedBookmarks parse_bookmarks(std::string_view text, const std::string& name) {
  ParsedBookmarks parsed;
  Bookmarks bookmarks;
  std::array<int, kLastKey + 1> line_of_key{};
  int number = 0;
  for (const std::string_view line : lines_of(text)) {
    ++number;
    Bookmarks::Line& kept = bookmarks.lines_.emplace_back();
    kept.text = line;
    if (const std::string_view words = trimmed(line); words.empty() || words.starts_with('#')) continue;
    std::string fault;
    kept.bookmark = read_line(line, fault);
    if (fault.empty() && kept.bookmark->key != 0) {
      int& first = line_of_key[static_cast<std::size_t>(kept.bookmark->key)];
      if (first != 0) {
        fault = "each key once, found " + std::to_string(kept.bookmark->key) + " again after line " +
                std::to_string(first);
      }
      first = number;
    }
    if (!fault.empty() && parsed.errors.size() < ParsedBookmarks::kMaxErrors) {
      parsed.errors.push_back({name, number, "expected " + fault});
    }
  }
  if (parsed.errors.empty()) parsed.bookmarks = std::move(bookmarks);
  return parsed;
}

ParsedBookmarks load_bookmarks(const fs::path& path) {
  std::error_code ignored;
  if (!fs::exists(path, ignored) && !ignored) return {Bookmarks(), {}};
  const std::vector<std::uint8_t> bytes = base::read_file(path, kLargestFile);
  return parse_bookmarks({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, path.string());
}

void save_bookmarks(const fs::path& path, const Bookmarks& bookmarks) {
  std::error_code error;
  const fs::path target = base::resolve_links(path);
  if (const fs::path folder = target.parent_path(); !folder.empty()) {
    fs::create_directories(folder, error);
    if (error) throw base::file_error("create the folder", folder, error.message(), "check its permissions");
  }
  base::write_file(target, bookmarks.to_text());
}

}  // namespace vpe::explore
