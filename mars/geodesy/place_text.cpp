#include "mars/geodesy/place_text.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include "vpe/base/number.h"
#include "vpe/base/quote.h"

namespace mars {

namespace base = vpe::base;

namespace {

constexpr double kLargestLongitude_deg = 360;
constexpr double kLargestLatitude_deg = 90;
constexpr const char* kExpected =
    "longitude and latitude, LON,LAT in degrees, as 137.44, -4.59 or 4.59 S 137.44 E or 137 26 30 E, 4 35 22 S";

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

class Tokenizer {
 public:
  explicit Tokenizer(std::string_view text) : text_(text), lower_(text) {
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
        if (!number(token)) return "a number, found " + base::quote_text(text_.substr(at_));
        tokens.push_back(token);
      } else if (word(token)) {
        tokens.push_back(token);
      } else {
        return std::string(kExpected) + "; found " + base::quote_text(text_.substr(at_));
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
  std::size_t numbers = 0;
  bool has_units = false;
};

std::string add_parts(std::span<const std::pair<Token, int>> parts, Coordinate& out) {
  if (parts.empty()) return kExpected;
  out.numbers = parts.size();
  const Token& first = parts.front().first;
  constexpr std::array<double, 3> kParts{1, 60, 3600};
  int before = -1;
  for (std::size_t n = 0; n < parts.size(); ++n) {
    const auto& [token, given] = parts[n];
    const int unit = given >= 0 ? given : before + 1;
    out.has_units = out.has_units || given >= 0;
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

std::nullopt_t rejected(std::string& fault, std::string why) {
  fault = std::move(why);
  return std::nullopt;
}

// Returns the place if both numbers are within their limits. `has_letters`: the text says which is which.
std::optional<LonLat> within_limits(double lon_deg, double lat_deg, bool has_letters, std::string& fault) {
  if (!(std::abs(lat_deg) <= kLargestLatitude_deg))
    return rejected(fault, "expected a latitude from -90 to 90, found " + base::format_number(lat_deg) +
                               (has_letters ? "" : "; without letters the longitude comes first"));
  if (!(std::abs(lon_deg) <= kLargestLongitude_deg))
    return rejected(fault, "expected a longitude from -360 to 360, found " + base::format_number(lon_deg));
  return LonLat{normalize_lon_deg(lon_deg), lat_deg};
}

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kBlanks = " \t\r\n";
  const std::size_t begin = text.find_first_not_of(kBlanks);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(kBlanks) - begin + 1);
}

// Returns the numbers of "NUMBER,NUMBER", which may have exponents; nullopt for other texts.
std::optional<LonLat> plain_numbers(std::string_view text) {
  const std::size_t comma = text.find(',');
  if (comma == std::string_view::npos) return std::nullopt;
  const auto lon = base::parse_number(trimmed(text.substr(0, comma)));
  const auto lat = base::parse_number(trimmed(text.substr(comma + 1)));
  if (!lon || !lat) return std::nullopt;
  return LonLat{*lon, *lat};
}

}  // namespace

std::optional<LonLat> parse_place(std::string_view text, std::string& fault) {
  if (text.size() > kLongestPlaceText) return rejected(fault, std::string("expected ") + kExpected);
  if (const auto plain = plain_numbers(text))
    return within_limits(plain->lon_deg, plain->lat_deg, false, fault);
  std::vector<Token> tokens;
  if (std::string wrong = Tokenizer(text).read(tokens); !wrong.empty())
    return rejected(fault, "expected " + wrong);
  const Tokens all(tokens);
  const std::optional<Cut> middle = cut(all);
  if (!middle) return rejected(fault, std::string("expected ") + kExpected + "; one comma may separate them");
  Coordinate a;
  Coordinate b;
  std::string wrong = read_coordinate(all.first(middle->at), a);
  if (wrong.empty()) wrong = read_coordinate(all.subspan(middle->at + middle->between), b);
  if (!wrong.empty()) return rejected(fault, "expected " + wrong);
  const bool has_letters = a.is_lon || b.is_lon;
  if (!has_letters && !a.has_units && !b.has_units && (a.numbers == 1) != (b.numbers == 1))
    return rejected(fault, "expected minutes in both coordinates or in none, or letters or units");
  if (a.is_lon && b.is_lon && *a.is_lon == *b.is_lon)
    return rejected(fault, std::string("expected a longitude and a latitude, found two ") +
                               (*a.is_lon ? "longitudes" : "latitudes"));
  const bool lon_first = a.is_lon ? *a.is_lon : !b.is_lon.value_or(false);
  return within_limits((lon_first ? a : b).degrees, (lon_first ? b : a).degrees, has_letters, fault);
}

std::optional<double> parse_coordinate(std::string_view text, Axis axis, std::string& fault) {
  const bool is_lon = axis == Axis::kLongitude;
  const std::string name = is_lon ? "longitude" : "latitude";
  const std::string expected = "expected a " + name + " in degrees, as " +
                               (is_lon ? "137.44 or 222.56 W or 137 26 24 E" : "-4.59 or 4.59 S or 4 35 24 S");
  if (text.size() > kLongestPlaceText) return rejected(fault, expected);
  Coordinate out;
  if (const auto plain = base::parse_number(trimmed(text))) {
    out.degrees = *plain;
  } else {
    std::vector<Token> tokens;
    if (!Tokenizer(text).read(tokens).empty() ||
        std::any_of(tokens.begin(), tokens.end(), [](const Token& t) { return t.kind == Token::Kind::kComma; }))
      return rejected(fault, expected);
    if (const std::string wrong = read_coordinate(tokens, out); !wrong.empty())
      return rejected(fault, wrong == kExpected ? expected : "expected " + wrong);
    if (out.is_lon.value_or(is_lon) != is_lon) return rejected(fault, expected);
  }
  const double limit = is_lon ? kLargestLongitude_deg : kLargestLatitude_deg;
  if (!(std::abs(out.degrees) <= limit))
    return rejected(fault, "expected a " + name + " from -" + base::format_number(limit) + " to " +
                               base::format_number(limit) + ", found " + base::format_number(out.degrees));
  return is_lon ? normalize_lon_deg(out.degrees) : out.degrees;
}

std::string place_text(LonLat place) {
  constexpr int kDigits = 6;
  const std::string degree = "\u00b0 ";
  std::string text =
      base::format_display(std::abs(place.lon_deg), kDigits) + degree + (place.lon_deg < 0 ? "W" : "E");
  if (place.lon_deg < 0) text += " (" + base::format_display(place.lon_deg + 360, kDigits) + degree + "E)";
  return text + ", " + base::format_display(std::abs(place.lat_deg), kDigits) + degree +
         (place.lat_deg < 0 ? "S" : "N");
}

}  // namespace mars
