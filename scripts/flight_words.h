// Words of a line of a flight: splitting, keys with values, and numbers within limits. Used by the parser alone.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace scripts {

using Words = std::vector<std::string>;

// Quotes what was found. Bytes that a terminal might interpret are replaced.
std::string quote(std::string_view text);

// Splits a line into words without their quotes; a comment ends it. Sets `fault` to what was expected when a
// quote is wrong.
Words split_words(std::string_view line, std::string& fault);

struct KeyValue {
  std::string_view key;
  std::string_view value;
};

// Splits KEY=VALUE at its first equals sign. Returns nullopt for other words. The result refers to `word`.
std::optional<KeyValue> split_key_value(std::string_view word);

// Describes a number that a command may have.
struct Field {
  std::string_view key;
  double min = 0;
  double max = 0;
  bool whole = false;
  double value = 0;
  bool given = false;
};

// Returns text such as "lat=NUMBER from -90 to 90".
std::string what_is_allowed(const Field& field);

// Reads a number into a field. Returns false, and changes nothing, for text that the field does not allow.
bool read(Field& field, std::string_view text);

// Returns the keys, separated by commas.
std::string join_keys(std::span<const Field> fields);

// Describes a value that is not a number. It refers to the words that it was read from.
struct TextField {
  std::string_view key;
  std::optional<std::string_view> value = {};
};

}  // namespace scripts
