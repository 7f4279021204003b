// Members of a struct as keys of a TOML file. Each is declared once: type, range, meaning; reading, writing,
// printing and messages follow from that.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <variant>
#include <vector>

#include "mars/geodesy/pose.h"

namespace vpe::explore {

struct NumberKey {
  double* value;
  double min;
  double max;
};

struct IntegerKey {
  int* value;
  int min;
  int max;
};

struct SwitchKey {
  bool* value;
};

struct ChoiceKey {
  std::vector<std::string_view> words;  // of the values 0, 1, ...
  std::function<int()> read;
  std::function<void(int)> write;
};

template <class Enum>
ChoiceKey choice_key(Enum& value, std::vector<std::string_view> words) {
  static_assert(std::is_enum_v<Enum>);
  return {std::move(words), [&value] { return static_cast<int>(value); },
          [&value](int word) { value = static_cast<Enum>(word); }};
}

struct TextKey {
  std::string* value;
  std::string_view grammar;                         // what is allowed, in words
  std::string (*problem)(const std::string& text);  // empty when all is well
};

// Six numbers in the order of the struct, or an empty list for none.
struct PoseKey {
  std::optional<mars::Pose>* value;
};

// Whether a PoseKey may have this value: finite, latitude and pitch up to 90 degrees, other angles up to 360.
bool is_pose(const mars::Pose& pose);

// Bound to the members of one object, which must outlive it.
struct KeyEntry {
  std::string_view name;  // "table.key"
  std::variant<NumberKey, IntegerKey, SwitchKey, ChoiceKey, TextKey, PoseKey> member;
  std::string_view meaning;
};

// A file that is no TOML, or has an unknown key or a bad value: what() is "FILE:LINE: what, and what is
// allowed".
class KeyFileError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// Sets the members that the text names; others stay. Throws KeyFileError; some members may have been set then.
void read_keys(std::string_view toml, const std::string& file, std::span<const KeyEntry> keys);

enum class KeysShown {
  kAll,
  kChanged,  // those that are as by default are comments, so that they follow a later default
};

// TOML that read_keys() reads back to the same values to the bit, with ranges, defaults and meanings in
// comments. `defaults` are the same keys of another object. A text that TOML cannot hold (not UTF-8) is written
// as empty.
std::string write_keys(std::span<const KeyEntry> keys, std::span<const KeyEntry> defaults, KeysShown shown);

}  // namespace vpe::explore
