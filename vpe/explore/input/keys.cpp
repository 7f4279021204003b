#include "vpe/explore/input/keys.h"

#include <algorithm>
#include <array>

namespace vpe::explore {

namespace {

constexpr std::array<std::string_view, kKeyCount> kNames{
    "A",   "B",         "C",      "D",      "E",    "F",     "G",       "H",         "I",     "J",   "K",
    "L",   "M",         "N",      "O",      "P",    "Q",     "R",       "S",         "T",     "U",   "V",
    "W",   "X",         "Y",      "Z",      "0",    "1",     "2",       "3",         "4",     "5",   "6",
    "7",   "8",         "9",      "F1",     "F2",   "F3",    "F4",      "F5",        "F6",    "F7",  "F8",
    "F9",  "F10",       "F11",    "F12",    "Left", "Right", "Up",      "Down",      "Space", "Tab", "Enter",
    "Esc", "Backspace", "Insert", "Delete", "Home", "End",   "Page Up", "Page Down", "+",     "-",   ",",
    ".",   "/",         ";",      "'",      "[",    "]",     "\\",      "`"};

char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

bool same(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](char x, char y) { return lower(x) == lower(y); });
}

// Removes "PREFIX+" from the front of the text, if it is there.
bool take(std::string_view& text, std::string_view prefix) {
  if (text.size() <= prefix.size() + 1 || text[prefix.size()] != '+') return false;
  if (!same(text.substr(0, prefix.size()), prefix)) return false;
  text.remove_prefix(prefix.size() + 1);
  return true;
}

}  // namespace

std::string_view name(Key key) { return kNames[static_cast<std::size_t>(key)]; }

std::string name(const Chord& chord) {
  std::string text;
  if (chord.with.ctrl) text += "Ctrl+";
  if (chord.with.alt) text += "Alt+";
  if (chord.with.shift) text += "Shift+";
  return text.append(name(chord.key));
}

std::optional<Chord> parse_chord(std::string_view text) {
  Chord chord;
  for (bool again = true; again;) {
    again = false;
    if (!chord.with.ctrl && take(text, "Ctrl")) again = chord.with.ctrl = true;
    if (!chord.with.alt && take(text, "Alt")) again = chord.with.alt = true;
    if (!chord.with.shift && take(text, "Shift")) again = chord.with.shift = true;
  }
  const auto found =
      std::find_if(kNames.begin(), kNames.end(), [text](std::string_view n) { return same(n, text); });
  if (found == kNames.end()) return std::nullopt;
  chord.key = static_cast<Key>(found - kNames.begin());
  return chord;
}

}  // namespace vpe::explore
