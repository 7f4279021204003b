#include "vpe/explore/places/place_search.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <utility>

namespace vpe::explore {

namespace {

// Letters of U+00C0 to U+017F without their accents; a blank where there is no single letter.
constexpr std::string_view kLatin =
    "aaaaaaaceeeeiiiidnooooo ouuuuytsaaaaaaaceeeeiiiidnooooo ouuuuyty"
    "aaaaaaccccccccddddeeeeeeeeeegggggggghhhhiiiiiiiiiiiijjkkklllllll"
    "lllnnnnnnnnnoooooooorrrrrrssssssssttttttuuuuuuuuuuuuwwyyyzzzzzzs";

// Reads one character of UTF-8. Returns a blank for a byte that begins none.
char32_t next_character(std::string_view text, std::size_t& at) {
  const auto byte = [&](std::size_t n) { return static_cast<unsigned char>(text[n]); };
  const unsigned char first = byte(at++);
  if (first < 0x80) return first;
  const std::size_t more = first >= 0xf0 ? 3 : first >= 0xe0 ? 2 : 1;
  if (first < 0xc2 || first > 0xf4 || at + more > text.size()) return U' ';
  char32_t c = first & (0x3fU >> more);
  for (std::size_t n = 0; n < more; ++n) {
    if ((byte(at + n) & 0xc0U) != 0x80) return U' ';
    c = (c << 6) | (byte(at + n) & 0x3fU);
  }
  at += more;
  return c;
}

enum Match { kEqual, kBegins, kWordBegins, kContains, kNearly, kNone };

Match match_of(const std::string& name, const std::string& text, int errors) {
  if (name == text) return kEqual;
  if (name.starts_with(text)) return kBegins;
  if (name.find(" " + text) != std::string::npos) return kWordBegins;
  if (name.find(text) != std::string::npos) return kContains;
  if (errors == 0) return kNone;
  for (std::size_t at = 0; at != std::string::npos;) {
    if (typing_errors(text, std::string_view(name).substr(at), errors) <= errors) return kNearly;
    at = name.find(' ', at);
    if (at != std::string::npos) ++at;
  }
  return kNone;
}

constexpr std::array<std::string_view, 27> kSightNames{
    "Olympus Mons",    "Valles Marineris", "Gale",
    "Hellas Planitia", "Planum Boreum",    "Jezero",
    "Argyre Planitia", "Elysium Mons",     "Arsia Mons",
    "Pavonis Mons",    "Ascraeus Mons",    "Noctis Labyrinthus",
    "Candor Chasma",   "Kasei Valles",     "Utopia Planitia",
    "Isidis Planitia", "Chryse Planitia",  "Amazonis Planitia",
    "Planum Australe", "Schiaparelli",     "Huygens",
    "Gusev",           "Meridiani Planum", "Syrtis Major Planum",
    "Arabia Terra",    "Melas Chasma",     "Coprates Chasma"};

}  // namespace

const std::span<const std::string_view> kSights{kSightNames};

std::vector<core::Place> sights_first(std::vector<core::Place> places) {
  const auto rank = [](const core::Place& place) { return std::ranges::find(kSightNames, place.name); };
  std::ranges::stable_sort(places, {}, rank);
  return places;
}

std::string folded(std::string_view text) {
  std::string out;
  const auto add_blank = [&out] {
    if (!out.empty() && out.back() != ' ') out += ' ';
  };
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t from = at;
    const char32_t c = next_character(text, at);
    if (c == '\'' || c == U'\u2019') continue;
    if (c < 0x80) {
      const auto byte = static_cast<unsigned char>(c);
      if (std::isalnum(byte) != 0)
        out += static_cast<char>(std::tolower(byte));
      else
        add_blank();
    } else if (c >= 0xc0 && c < 0xc0 + kLatin.size() && at - from == 2) {
      const char letter = kLatin[c - 0xc0];
      if (letter == ' ')
        add_blank();
      else
        out += letter;
    } else {
      out += text.substr(from, at - from);
    }
  }
  while (out.ends_with(' ')) out.pop_back();
  return out;
}

int typing_errors(std::string_view typed, std::string_view word, int most) {
  // Three rows of the table of Damerau and Levenshtein, whose last row's least value leaves the rest of the word.
  constexpr std::size_t kLongest = 64;
  if (typed.size() > kLongest) return most + 1;
  word = word.substr(0, std::min(word.size(), typed.size() + static_cast<std::size_t>(std::max(most, 0))));
  std::array<std::array<int, 2 * kLongest + 1>, 3> rows{};
  if (word.size() > 2 * kLongest) return most + 1;
  for (std::size_t j = 0; j <= word.size(); ++j) rows[0][j] = static_cast<int>(j);
  for (std::size_t i = 1; i <= typed.size(); ++i) {
    auto& row = rows[i % 3];
    const auto& before = rows[(i + 2) % 3];
    const auto& second = rows[(i + 1) % 3];
    row[0] = static_cast<int>(i);
    for (std::size_t j = 1; j <= word.size(); ++j) {
      row[j] = std::min({row[j - 1] + 1, before[j] + 1, before[j - 1] + (typed[i - 1] == word[j - 1] ? 0 : 1)});
      const bool is_exchanged = i > 1 && j > 1 && typed[i - 1] == word[j - 2] && typed[i - 2] == word[j - 1];
      if (is_exchanged) row[j] = std::min(row[j], second[j - 2] + 1);
    }
  }
  const auto& last = rows[typed.size() % 3];
  const int least =
      *std::min_element(last.begin(), last.begin() + static_cast<std::ptrdiff_t>(word.size()) + 1);
  return std::min(least, most + 1);
}

PlaceSearch::PlaceSearch(std::vector<core::Place> places) : places_(std::move(places)) {
  folded_.reserve(places_.size());
  for (const core::Place& place : places_) folded_.push_back(folded(place.name));
}

std::vector<const core::Place*> PlaceSearch::find(std::string_view text, std::size_t most) const {
  constexpr std::size_t kOneError = 4;  // letters
  constexpr std::size_t kTwoErrors = 8;
  const std::string wanted = folded(text);
  if (wanted.empty()) return {};
  const int errors = wanted.size() >= kTwoErrors ? 2 : wanted.size() >= kOneError ? 1 : 0;
  std::array<std::vector<const core::Place*>, kNone> found;
  for (std::size_t n = 0; n < places_.size(); ++n) {
    const Match match = match_of(folded_[n], wanted, errors);
    if (match != kNone && found[match].size() < most) found[match].push_back(&places_[n]);
  }
  std::vector<const core::Place*> all;
  for (const auto& kind : found) all.insert(all.end(), kind.begin(), kind.end());
  if (all.size() > most) all.resize(most);
  return all;
}

const core::Place* PlaceSearch::named(std::string_view name) const {
  const auto at = std::ranges::find(folded_, folded(name));
  return at == folded_.end() ? nullptr : &places_[static_cast<std::size_t>(at - folded_.begin())];
}

}  // namespace vpe::explore
