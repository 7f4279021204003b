#include "vpe/explore/measure/place_text.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include "vpe/base/number.h"
#include "vpe/explore/files/text_lines.h"

namespace vpe::explore {

namespace {

constexpr const char* kExpected =
    "longitude and latitude in degrees, as 137.44, -4.59 or 4.59 S 137.44 E or 137 26 30 E, 4 35 22 S";

struct Token {
  enum class Kind { kNumber, kUnit, kLetter, kName, kComma };
  Kind kind = Kind::kComma;
  double number = 0;
  bool is_signed = false;
  bool is_minus = false;
  bool is_whole = true;
  int unit = 0;        // 0 degrees, 1 minutes, 2 seconds
  char letter = ' ';   // E, W, N or S
  bool is_lon = true;  // of a letter or a name
};
using Tokens = std::span<const Token>;

// A longer text stands before one that it begins with.
constexpr std::array<std::pair<std::string_view, int>, 13> kUnits{{{"\u00b0", 0},
                                                                   {"\u00ba", 0},
                                                                   {"deg", 0},
                                                                   {"d", 0},
                                                                   {"''", 2},
                                                                   {"\u2032\u2032", 2},
                                                                   {"'", 1},
                                                                   {"\u2032", 1},
                                                                   {"\u2019", 1},
                                                                   {"min", 1},
                                                                   {"\"", 2},
                                                                   {"\u2033", 2},
                                                                   {"\u201d", 2}}};
constexpr std::array<std::pair<std::string_view, bool>, 4> kNames{
    {{"longitude", true}, {"latitude", false}, {"lon", true}, {"lat", false}}};
constexpr std::array<std::pair<std::string_view, char>, 8> kLetters{{{"east", 'E'},
                                                                     {"west", 'W'},
                                                                     {"north", 'N'},
                                                                     {"south", 'S'},
                                                                     {"e", 'E'},
                                                                     {"w", 'W'},
                                                                     {"n", 'N'},
                                                                     {"s", 'S'}}};
constexpr std::string_view kMinus = "\u2212";

bool is_digit(char c) { return c >= '0' && c <= '9'; }

class Reader {
 public:
  explicit Reader(std::string_view text) : text_(text), lower_(text) {
    for (char& c : lower_) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    decimal_comma_ = text.find(';') != std::string_view::npos;
  }

  // Splits the text into tokens. Returns what was expected, or "".
  std::string read(std::vector<Token>& tokens) {
    while (at_ < text_.size()) {
      const char c = text_[at_];
      Token token;
      if (c == ',' || c == ';') {
        ++at_;
        tokens.push_back(token);
      } else if (std::string_view(" \t\r\n()[]:=").find(c) != std::string_view::npos) {
        ++at_;
      } else if (takes("\u00a0")) {  // no-break space
      } else if (is_digit(c) || c == '.' || c == '+' || c == '-' || text_.substr(at_).starts_with(kMinus)) {
        if (!number(token)) return "a number, found " + found_text(text_.substr(at_));
        tokens.push_back(token);
      } else if (word(token)) {
        tokens.push_back(token);
      } else {
        return std::string(kExpected) + "; found " + found_text(text_.substr(at_));
      }
    }
    return {};
  }

 private:
  bool takes(std::string_view word) {
    if (!std::string_view(lower_).substr(at_).starts_with(word)) return false;
    at_ += word.size();
    return true;
  }

  bool word(Token& token) {
    for (const auto& [name, is_lon] : kNames) {
      if (!takes(name)) continue;
      token.kind = Token::Kind::kName;
      token.is_lon = is_lon;
      return true;
    }
    for (const auto& [name, unit] : kUnits) {
      if (!takes(name)) continue;
      token.kind = Token::Kind::kUnit;
      token.unit = unit;
      return true;
    }
    for (const auto& [name, letter] : kLetters) {
      if (!takes(name)) continue;
      token.kind = Token::Kind::kLetter;
      token.letter = letter;
      token.is_lon = letter == 'E' || letter == 'W';
      return true;
    }
    return false;
  }

  bool number(Token& token) {
    const std::size_t begin = at_;
    token.kind = Token::Kind::kNumber;
    token.is_minus = takes("-") || takes(kMinus);
    token.is_signed = token.is_minus || takes("+");
    std::string digits;
    for (; at_ < text_.size(); ++at_) {
      const bool comma = decimal_comma_ && text_[at_] == ',' && !digits.empty() && at_ + 1 < text_.size() &&
                         is_digit(text_[at_ + 1]);
      if (!is_digit(text_[at_]) && text_[at_] != '.' && !comma) break;
      digits += comma ? '.' : text_[at_];
      token.is_whole = token.is_whole && is_digit(text_[at_]);
    }
    const std::optional<double> value = base::parse_number(digits);
    if (!value) {
      at_ = begin;
      return false;
    }
    token.number = *value;
    return true;
  }

  std::string_view text_;
  std::string lower_;
  std::size_t at_ = 0;
  bool decimal_comma_ = false;
};

// Holds one coordinate as read: its value, and whether letters or names identify it.
struct Coordinate {
  double degrees = 0;
  std::optional<bool> is_lon;  // where it says so
  char letter = ' ';
};

std::string add_parts(std::span<const std::pair<Token, int>> parts, Coordinate& out) {
  if (parts.empty()) return kExpected;
  const Token& first = parts.front().first;
  constexpr std::array<double, 3> kParts{1, 60, 3600};
  int before = -1;
  for (std::size_t n = 0; n < parts.size(); ++n) {
    const auto& [token, given] = parts[n];
    const int unit = given >= 0 ? given : before + 1;
    if (unit <= before || unit > 2 || (n == 0) != (unit == 0))
      return "degrees, then minutes, then seconds in each coordinate";
    if (n > 0 && token.is_signed) return "a sign before the degrees only, or a comma between the coordinates";
    if (n > 0 && token.number >= 60)
      return "minutes and seconds below 60, found " + base::format_number(token.number);
    if (n + 1 < parts.size() && !token.is_whole) return "a fraction in the last number of a coordinate only";
    out.degrees += token.number / kParts[static_cast<std::size_t>(unit)];
    before = unit;
  }
  if (first.is_signed && out.letter != ' ')
    return std::string("either a sign or a letter, since it is ambiguous what ") +
           (first.is_minus ? "-" : "+") + " means with " + out.letter;
  if (first.is_minus || out.letter == 'W' || out.letter == 'S') out.degrees = -out.degrees;
  return {};
}

std::string read_coordinate(Tokens tokens, Coordinate& out) {
  std::vector<std::pair<Token, int>> parts;  // numbers and the units after them, -1: none
  bool takes_unit = false;
  bool is_closed = false;  // a letter after the numbers ends them
  for (const Token& token : tokens) {
    switch (token.kind) {
      case Token::Kind::kNumber:
        if (is_closed) return "the letter E, W, N or S before or after all of a coordinate's numbers";
        parts.emplace_back(token, -1);
        break;
      case Token::Kind::kUnit:
        if (!takes_unit) return "signs of degrees, minutes and seconds after their numbers";
        parts.back().second = token.unit;
        break;
      case Token::Kind::kName:
      case Token::Kind::kLetter:
        if (out.is_lon && *out.is_lon != token.is_lon) return "E or W with a longitude, N or S with a latitude";
        out.is_lon = token.is_lon;
        if (token.kind == Token::Kind::kName) break;
        if (out.letter != ' ') return "one letter E, W, N or S in a coordinate";
        out.letter = token.letter;
        is_closed = !parts.empty();
        break;
      case Token::Kind::kComma: break;
    }
    takes_unit = token.kind == Token::Kind::kNumber;
  }
  return add_parts(parts, out);
}

template <class Is>
std::vector<std::size_t> where(Tokens tokens, const Is& is) {
  std::vector<std::size_t> found;
  for (std::size_t n = 0; n < tokens.size(); ++n)
    if (is(tokens[n])) found.push_back(n);
  return found;
}

// Holds where the second coordinate begins, and how many tokens separate the two.
struct Cut {
  std::size_t at = 0;
  std::size_t between = 0;
};
// Finds the boundary of the two coordinates; returns nullopt if it is ambiguous.
std::optional<Cut> cut(Tokens tokens) {
  const auto of_kind = [&](Token::Kind kind) {
    return where(tokens, [&](const Token& t) { return t.kind == kind; });
  };
  const std::vector<std::size_t> commas = of_kind(Token::Kind::kComma);
  if (commas.size() == 1) return Cut{commas[0], 1};
  if (!commas.empty()) return std::nullopt;
  const std::vector<std::size_t> names = of_kind(Token::Kind::kName);
  if (names.size() == 2 && names[0] == 0) return Cut{names[1], 0};
  const std::vector<std::size_t> letters = of_kind(Token::Kind::kLetter);
  if (!names.empty() || letters.size() == 1 || letters.size() > 2) return std::nullopt;
  if (letters.size() == 2) return letters[0] == 0 ? Cut{letters[1], 0} : Cut{letters[0] + 1, 0};
  const std::vector<std::size_t> numbers = of_kind(Token::Kind::kNumber);
  const std::vector<std::size_t> degrees =
      where(tokens, [](const Token& t) { return t.kind == Token::Kind::kUnit && t.unit == 0; });
  if (degrees.size() == 2) return Cut{degrees[1] - 1, 0};
  if (numbers.empty() || numbers.size() % 2 != 0) return std::nullopt;
  return Cut{numbers[numbers.size() / 2], 0};
}

std::optional<mars::LonLat> rejected(std::string& fault, std::string why) {
  fault = std::move(why);
  return std::nullopt;
}

}  // namespace

std::optional<mars::LonLat> read_place(std::string_view text, std::string& fault) {
  if (text.size() > kLongestPlaceText) return rejected(fault, std::string("expected ") + kExpected);
  std::vector<Token> tokens;
  if (std::string wrong = Reader(text).read(tokens); !wrong.empty())
    return rejected(fault, "expected " + wrong);
  const Tokens all(tokens);
  const std::optional<Cut> middle = cut(all);
  if (!middle) return rejected(fault, std::string("expected ") + kExpected + "; one comma may separate them");
  Coordinate a;
  Coordinate b;
  std::string wrong = read_coordinate(all.first(middle->at), a);
  if (wrong.empty()) wrong = read_coordinate(all.subspan(middle->at + middle->between), b);
  if (!wrong.empty()) return rejected(fault, "expected " + wrong);
  if (a.is_lon && b.is_lon && *a.is_lon == *b.is_lon)
    return rejected(fault, std::string("expected a longitude and a latitude, found two ") +
                               (*a.is_lon ? "longitudes" : "latitudes"));
  const bool lon_first = a.is_lon ? *a.is_lon : !b.is_lon.value_or(false);
  const Coordinate& lon = lon_first ? a : b;
  const Coordinate& lat = lon_first ? b : a;
  if (!(std::abs(lat.degrees) <= 90)) {
    const bool has_letters = a.is_lon || b.is_lon;
    return rejected(fault, "expected a latitude from -90 to 90, found " + base::format_number(lat.degrees) +
                               (has_letters ? "" : "; without letters the longitude comes first"));
  }
  if (!(std::abs(lon.degrees) <= 360))
    return rejected(fault, "expected a longitude from -360 to 360, found " + base::format_number(lon.degrees));
  return mars::LonLat{mars::normalize_lon_deg(lon.degrees), lat.degrees};
}

std::string place_text(mars::LonLat place) {
  constexpr int kDigits = 6;
  const std::string degree = "\u00b0 ";
  std::string text =
      base::format_display(std::abs(place.lon_deg), kDigits) + degree + (place.lon_deg < 0 ? "W" : "E");
  if (place.lon_deg < 0) text += " (" + base::format_display(place.lon_deg + 360, kDigits) + degree + "E)";
  return text + ", " + base::format_display(std::abs(place.lat_deg), kDigits) + degree +
         (place.lat_deg < 0 ? "S" : "N");
}

}  // namespace vpe::explore
