// A registry that declares members of a struct as named keys.
//
// Each key is declared once, with its type, limits, unit and meaning. Reading, printing, checks, help texts and
// messages follow from the declaration. The settings (vpe/core/appearance/settings.h) and the preferences
// (vpe/explore/files/preferences.h) are such registries.
//
// Typical usage:
//   using Declare = KeyMembers<Options>;
//   const KeyRegistry<Options> keys({
//       {"speed", Declare::number<&Options::speed>(0.1, 10), "m", "distance moved in a second"},
//       {"pad.invert", Declare::toggle<&Options::pad, &Pad::invert>(), "", "swaps up and down"},
//   });
//   const std::size_t key = keys.find("speed").value();
//   if (const auto value = parse_value(keys.infos()[key], "2.5", problem)) keys.set(key, options, *value);
//   print_value(keys.infos()[key], keys.get(key, options));  // "2.5"
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "mars/geodesy/pose.h"
#include "vpe/core/registry/level_table.h"

namespace vpe::core {

// The types of keys. Each describes the values that are allowed.
struct NumberKey {
  double min = 0;  // both ends are allowed
  double max = 0;
};
// A number, or one word in place of it.
struct NumberOrWordKey {
  double min = 0;  // both ends are allowed
  double max = 0;
  std::string_view word;  // stands for no number
};
struct IntegerKey {
  int min = 0;  // both ends are allowed
  int max = 0;
};
struct SwitchKey {};
struct KeyWord {
  std::string_view text;
  int value = 0;
};
struct ChoiceKey {
  std::vector<KeyWord> words;  // in the order in which people should read them
};
struct TextKey {
  std::string grammar;                              // what is allowed, in words
  std::string (*problem)(const std::string& text);  // returns what is wrong, or "" if the text is allowed
};
struct TableKey {};  // a LevelTable
struct PoseKey {};   // six numbers in the order of mars::Pose, or none

using KeyType =
    std::variant<NumberKey, NumberOrWordKey, IntegerKey, SwitchKey, ChoiceKey, TextKey, TableKey, PoseKey>;

// The value of a NumberOrWordKey. It is no plain optional, to which optional values of other types would
// convert.
struct NumberOrWord {
  explicit NumberOrWord(std::optional<double> n = {}) : number(n) {}
  explicit operator std::optional<double>() const { return number; }
  bool operator==(const NumberOrWord&) const = default;

  std::optional<double> number;  // nullopt: the word
};

// The value of a key: a number as double, an integer and a choice as int, a switch as bool.
using KeyValue =
    std::variant<double, NumberOrWord, int, bool, std::string, LevelTable, std::optional<mars::Pose>>;

// Describes one key.
struct KeyInfo {
  std::string_view name;
  KeyType type;
  std::string_view unit;     // empty for pure numbers, words, and where the meaning names the unit
  std::string_view meaning;  // a phrase in plain English; part of help texts and of files
};

// The words of a switch. Settings say "off" and "on", TOML files "false" and "true".
struct SwitchWords {
  std::string_view off = "off";
  std::string_view on = "on";
  std::string_view allowed = "one of off, on";  // for allowed_text()
};

// Returns true if the key may have this value. `value` must have the alternative that belongs to the type.
// Texts are checked by the key's own function alone.
bool is_allowed(const KeyInfo& key, const KeyValue& value);

// Returns the value of a whole text, or nullopt if the text is not allowed; `problem` is set to the reason
// where more is known than that. Refuses texts with control characters. Poses have no plain text: returns
// nullopt.
std::optional<KeyValue> parse_value(const KeyInfo& key, std::string_view text, std::string& problem,
                                    const SwitchWords& words = {});

// Returns the text from which parse_value() reads the same value to the bit. A pose is "[LON, LAT, ...]" or
// "[]".
std::string print_value(const KeyInfo& key, const KeyValue& value, const SwitchWords& words = {});

// Returns the value of a word of a choice, or nullopt for other words.
std::optional<int> word_value(const ChoiceKey& choice, std::string_view word);

// Returns what is allowed, for messages and help texts: "a number from 0 to 10 m", "one of a, b".
std::string allowed_text(const KeyInfo& key, const SwitchWords& words = {});

// Returns an allowed value near `value`: numbers are brought within the limits; what cannot be mended becomes
// `fallback`, a pose that is not allowed becomes none.
KeyValue within_limits(const KeyInfo& key, const KeyValue& value, const KeyValue& fallback);

// Returns "did you mean A, B?" with the names that are spelled nearly like `name` or contain it, or "" if there
// are none.
std::string did_you_mean(std::string_view name, std::span<const KeyInfo> keys);

// Returns the words separated by ", ".
std::string join(std::span<const std::string_view> words);

// Binds a key's type to a member of Owner. Made by KeyMembers.
template <class Owner>
struct KeyMember {
  KeyType type;
  KeyValue (*get)(const Owner&);
  void (*set)(Owner&, const KeyValue&);
};

// Declares members of Owner. A path of several members leads into nested structs.
template <class Owner>
struct KeyMembers {
  template <auto... path>
  static KeyMember<Owner> number(double min, double max) {
    return bind<double, path...>(NumberKey{min, max});
  }
  // For members of type std::optional<double>; the word means nullopt.
  template <auto... path>
  static KeyMember<Owner> number_or_word(double min, double max, std::string_view word) {
    return bind<NumberOrWord, path...>(NumberOrWordKey{min, max, word});
  }
  template <auto... path>
  static KeyMember<Owner> integer(int min, int max) {
    return bind<int, path...>(IntegerKey{min, max});
  }
  template <auto... path>
  static KeyMember<Owner> toggle() {
    return bind<bool, path...>(SwitchKey{});
  }
  // For enumerations, and for integers and bools whose values have words of their own.
  template <auto... path>
  static KeyMember<Owner> choice(std::vector<KeyWord> words) {
    return bind<int, path...>(ChoiceKey{std::move(words)});
  }
  template <auto... path>
  static KeyMember<Owner> text(std::string grammar, std::string (*problem)(const std::string& text)) {
    return bind<std::string, path...>(TextKey{std::move(grammar), problem});
  }
  template <auto... path>
  static KeyMember<Owner> table() {
    return bind<LevelTable, path...>(TableKey{});
  }
  template <auto... path>
  static KeyMember<Owner> pose() {
    return bind<std::optional<mars::Pose>, path...>(PoseKey{});
  }

 private:
  template <class Stored, auto... path>
  static KeyMember<Owner> bind(KeyType type) {
    return {std::move(type),
            [](const Owner& owner) { return KeyValue(static_cast<Stored>((owner.*....*path))); },
            [](Owner& owner, const KeyValue& value) {
              auto& member = (owner.*....*path);
              member = static_cast<std::remove_reference_t<decltype(member)>>(std::get<Stored>(value));
            }};
  }
};

template <class Value>
constexpr KeyWord word(std::string_view text, Value value) {
  return {text, static_cast<int>(value)};
}

// All keys of Owner, in the order of their declaration. Immutable: any number of threads may use it.
template <class Owner>
class KeyRegistry {
 public:
  struct Declaration {
    std::string_view name;
    KeyMember<Owner> member;
    std::string_view unit;
    std::string_view meaning;
  };

  explicit KeyRegistry(std::vector<Declaration> declarations) {
    for (Declaration& d : declarations) {
      infos_.push_back({d.name, std::move(d.member.type), d.unit, d.meaning});
      accesses_.push_back({d.member.get, d.member.set});
    }
  }

  std::span<const KeyInfo> infos() const { return infos_; }

  // Returns the index of a key in infos(), or nullopt for an unknown name.
  std::optional<std::size_t> find(std::string_view name) const {
    for (std::size_t n = 0; n < infos_.size(); ++n) {
      if (infos_[n].name == name) return n;
    }
    return std::nullopt;
  }

  // Reads or writes the member that belongs to a key. `value` must have the alternative that get() returns.
  KeyValue get(std::size_t key, const Owner& owner) const { return accesses_[key].get(owner); }
  void set(std::size_t key, Owner& owner, const KeyValue& value) const { accesses_[key].set(owner, value); }

  // Returns the values of all keys.
  std::vector<KeyValue> values(const Owner& owner) const {
    std::vector<KeyValue> all;
    for (const Access& access : accesses_) all.push_back(access.get(owner));
    return all;
  }

 private:
  struct Access {
    KeyValue (*get)(const Owner&);
    void (*set)(Owner&, const KeyValue&);
  };
  std::vector<KeyInfo> infos_;
  std::vector<Access> accesses_;
};

}  // namespace vpe::core
