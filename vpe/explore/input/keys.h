// Names of keys, independent of the window system. The key of a letter or digit is the one at its position on a
// US keyboard, so that WASD are neighbours on every keyboard.
#pragma once

#include <bitset>
#include <optional>
#include <string>
#include <string_view>

namespace vpe::explore {

enum class Key {
  kA,
  kB,
  kC,
  kD,
  kE,
  kF,
  kG,
  kH,
  kI,
  kJ,
  kK,
  kL,
  kM,
  kN,
  kO,
  kP,
  kQ,
  kR,
  kS,
  kT,
  kU,
  kV,
  kW,
  kX,
  kY,
  kZ,
  k0,
  k1,
  k2,
  k3,
  k4,
  k5,
  k6,
  k7,
  k8,
  k9,
  kF1,
  kF2,
  kF3,
  kF4,
  kF5,
  kF6,
  kF7,
  kF8,
  kF9,
  kF10,
  kF11,
  kF12,
  kLeft,
  kRight,
  kUp,
  kDown,
  kSpace,
  kTab,
  kEnter,
  kEscape,
  kBackspace,
  kInsert,
  kDelete,
  kHome,
  kEnd,
  kPageUp,
  kPageDown,
  kPlus,  // with =
  kMinus,
  kComma,
  kPeriod,
  kSlash,
  kSemicolon,
  kApostrophe,
  kLeftBracket,
  kRightBracket,
  kBackslash,
  kGrave,
};
inline constexpr std::size_t kKeyCount = static_cast<std::size_t>(Key::kGrave) + 1;

struct Modifiers {
  bool ctrl = false;
  bool alt = false;
  bool shift = false;

  bool operator==(const Modifiers&) const = default;
};

// A key with the modifiers that are held.
struct Chord {
  Key key = Key::kA;
  Modifiers with;

  bool operator==(const Chord&) const = default;
};

// Holds the set of keys that are down.
class KeySet {
 public:
  void set(Key key, bool is_down = true) { down_.set(static_cast<std::size_t>(key), is_down); }
  bool has(Key key) const { return down_.test(static_cast<std::size_t>(key)); }
  // Removes all keys. Call it when the window loses the focus, since it does not see keys released then.
  void clear() { down_.reset(); }
  bool any() const { return down_.any(); }

 private:
  std::bitset<kKeyCount> down_;
};

// Returns the label of a key: "W", "F1", "Page Up", "+".
std::string_view name(Key key);

// Returns the name of a chord: "Ctrl+1", "Alt+Left".
std::string name(const Chord& chord);
// Parses the name of a chord in upper or lower case, with modifiers in any order.
std::optional<Chord> parse_chord(std::string_view text);

}  // namespace vpe::explore
