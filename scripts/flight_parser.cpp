#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>

#include "scripts/flight.h"
#include "vpe/base/number.h"
#include "vpe/core/appearance/settings.h"
#include "vpe/core/view.h"

namespace scripts {

using vpe::base::format_number;
using vpe::base::parse_integer;
using vpe::base::parse_number;
using vpe::core::ViewLimits;

namespace {

using Words = std::vector<std::string>;

// Quotes what was found. Bytes that a terminal might interpret are replaced.
std::string quote(std::string_view text) {
  constexpr std::size_t kLongest = 40;
  std::string quoted = "\"";
  for (const char c : text.substr(0, kLongest)) {
    const auto byte = static_cast<unsigned char>(c);
    quoted += byte >= 0x20 && byte < 0x7f ? c : '?';
  }
  return quoted + (text.size() > kLongest ? "...\"" : "\"");
}

constexpr std::string_view kBlanks = " \t\r\v\f";

// Splits a line into words without their quotes. Sets `fault` to what was expected when a quote is wrong.
Words split_words(std::string_view line, std::string& fault) {
  Words words;
  for (;;) {
    const std::size_t begin = line.find_first_not_of(kBlanks);
    if (begin == std::string_view::npos || line[begin] == '#') return words;
    line.remove_prefix(begin);
    std::string& word = words.emplace_back();
    std::size_t at = 0;
    while (at < line.size() && kBlanks.find(line[at]) == std::string_view::npos && line[at] != '#') {
      // Only the first equals sign can be before a quoted value.
      const bool opens =
          line[at] == '=' && word.find('=') == std::string::npos && line.substr(at + 1).starts_with('"');
      word += line[at++];
      if (!opens) continue;
      for (++at; at < line.size() && line[at] != '"'; ++at) {
        if (line[at] == '\\' && at + 1 < line.size()) ++at;
        word += line[at];
      }
      if (at == line.size()) {
        fault = "a closing quote after " + quote(word);
        return {};
      }
      ++at;
      if (at < line.size() && kBlanks.find(line[at]) == std::string_view::npos && line[at] != '#') {
        fault = "a blank after a closing quote, found " + quote(line.substr(at));
        return {};
      }
      break;
    }
    line.remove_prefix(at);
  }
}

struct KeyValue {
  std::string_view key;
  std::string_view value;
};

std::optional<KeyValue> split_key_value(std::string_view word) {
  const std::size_t equals = word.find('=');
  if (equals == 0 || equals == std::string_view::npos) return std::nullopt;
  return KeyValue{word.substr(0, equals), word.substr(equals + 1)};
}

// Describes a number that a command may have.
struct Field {
  std::string_view key;
  double min = 0;
  double max = 0;
  bool whole = false;
  double value = 0;
  bool given = false;
};

std::string what_is_allowed(const Field& field) {
  return std::string(field.key) + (field.whole ? "=WHOLE NUMBER" : "=NUMBER") + " from " +
         format_number(field.min) + " to " + format_number(field.max);
}

bool read(Field& field, std::string_view text) {
  const std::optional<double> number = parse_number(text);
  if (!number || *number < field.min || *number > field.max) return false;
  if (field.whole && std::nearbyint(*number) != *number) return false;
  field.value = *number;
  return true;
}

std::string join_keys(std::span<const Field> fields) {
  std::string keys;
  for (const Field& field : fields) keys.append(keys.empty() ? "" : ", ").append(field.key);
  return keys;
}

class Parser {
 public:
  explicit Parser(const std::string& name) : name_(name) {}

  ParsedFlight run(std::string_view text) {
    if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
    while (!text.empty() && !full()) {
      const std::size_t end = text.find('\n');
      ++line_;
      std::string fault;
      const Words words = split_words(text.substr(0, end), fault);
      text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
      if (!fault.empty()) fail(fault);
      if (words.empty()) continue;
      if (!version_seen_) {
        if (!version(words)) return {std::nullopt, std::move(errors_)};
      } else {
        command(words);
      }
    }
    line_ = std::max(line_, 1);
    if (!version_seen_) {
      fail("the first command \"flight 1\", found an empty file");
    } else if (flight_.waypoints.empty() && errors_.empty()) {
      fail("at least one pose (at T pose lon=.. lat=.. alt=..), found none in the file");
    }
    if (!errors_.empty()) return {std::nullopt, std::move(errors_)};
    return {std::move(flight_), {}};
  }

 private:
  bool full() const { return errors_.size() >= ParsedFlight::kMaxErrors; }

  void fail(const std::string& expected) {
    if (!full()) errors_.push_back({name_, line_, "expected " + expected});
  }

  bool version(const Words& words) {
    version_seen_ = words.size() == 2 && words[0] == "flight" && words[1] == "1";
    if (version_seen_) return true;
    const bool other = words.size() == 2 && words[0] == "flight" && parse_integer(words[1]).has_value();
    fail(other ? "\"flight 1\" (this program reads version 1 only), found version " + std::string(words[1])
               : "the first command \"flight 1\", found " + quote(words[0]));
    return false;
  }

  void command(const Words& words) {
    if (ended_) return fail("nothing after \"end\", found " + quote(words[0]));
    if (words[0] == "at") return timed(words);
    if (words[0] == "view") return view(words);
    fail("a command: view or at, found " + quote(words[0]));
  }

  void view(const Words& words) {
    if (view_seen_) return fail("one view line, found a second one");
    if (time_seen_) return fail("the view line before the first \"at\"");
    view_seen_ = true;
    std::array fields{Field{"fov", ViewLimits::kMinFov_deg, ViewLimits::kMaxFov_deg}};
    Words numbers;
    std::optional<std::string_view> size, fps;
    for (const std::string_view word : std::span(words).subspan(1)) {
      const std::optional<KeyValue> pair = split_key_value(word);
      std::optional<std::string_view>* own =
          pair && pair->key == "size" ? &size : (pair && pair->key == "fps" ? &fps : nullptr);
      if (own == nullptr) {
        numbers.emplace_back(word);
      } else if (own->has_value()) {
        fail(std::string(pair->key) + " once, found it again");
      } else {
        *own = pair->value;
      }
    }
    if (read_fields(numbers, fields, ", size, fps") && fields[0].given) flight_.view.fov_deg = fields[0].value;
    if (size) read_size(*size);
    if (fps) read_fps(*fps);
  }

  void read_size(std::string_view text) {
    const std::size_t x = text.find('x');
    const auto side = [](std::string_view digits) {
      const std::optional<std::int64_t> value = parse_integer(digits);
      return value && *value >= 1 && *value <= ViewLimits::kMaxSide_px ? static_cast<int>(*value) : 0;
    };
    const int width = side(text.substr(0, x));
    const int height = x == std::string_view::npos ? 0 : side(text.substr(x + 1));
    if (width == 0 || height == 0) {
      return fail("size=WIDTHxHEIGHT, each from 1 to " + std::to_string(ViewLimits::kMaxSide_px) + ", found " +
                  quote(text));
    }
    flight_.view.width = width;
    flight_.view.height = height;
  }

  void read_fps(std::string_view text) {
    const std::optional<FrameRate> rate = parse_frame_rate(text);
    if (!rate) {
      return fail("fps=NUMBER or fps=A/B from " + format_number(FrameRate::kMin) + " to " +
                  format_number(FrameRate::kMax) + ", found " + quote(text));
    }
    flight_.view.fps = *rate;
  }

  void timed(const Words& words) {
    if (words.size() < 3) return fail("at TIME followed by pose, look, set, interest or end");
    const std::optional<double> time_s = parse_number(words[1]);
    if (!time_s || *time_s < 0 || *time_s > FlightLimits::kMaxTime_s) {
      return fail("a time in seconds from 0 to " + format_number(FlightLimits::kMaxTime_s) +
                  " after \"at\", found " + quote(words[1]));
    }
    if (time_seen_ && *time_s < time_s_) {
      return fail("a time of " + format_number(time_s_) + " s or later (times may not run backwards), found " +
                  quote(words[1]));
    }
    time_seen_ = true;
    time_s_ = *time_s;
    const std::string_view name = words[2];
    const Words arguments(words.begin() + 3, words.end());
    if (name == "pose") return pose(arguments);
    if (name == "look") return look(arguments);
    if (name == "set") return set(arguments);
    if (name == "interest") return interest(arguments);
    if (name == "end") return end(arguments);
    fail("pose, look, set, interest or end after the time, found " + quote(name));
  }

  void pose(const Words& words) {
    using Limits = FlightLimits;
    std::array fields{Field{"lon", -360, 360},
                      Field{"lat", -90, 90},
                      Field{"alt", Limits::kMinAlt_m, Limits::kMaxAlt_m},
                      Field{"height", 0, Limits::kMaxAlt_m},
                      Field{"yaw", -360, 360},
                      Field{"pitch", -90, 90},
                      Field{"roll", -360, 360}};
    if (!read_fields(words, fields)) return;
    const auto& [lon, lat, alt, height, yaw, pitch, roll] = fields;
    if (!lon.given || !lat.given) return fail("lon=.. and lat=.. in a pose");
    if (alt.given == height.given) {
      return fail(
          std::string("either alt=.. (above the sphere) or height=.. (above the terrain) in a pose, found ") +
          (alt.given ? "both" : "neither"));
    }
    if (!flight_.waypoints.empty() && flight_.waypoints.back().time_s == time_s_) {
      return fail("one pose at " + format_number(time_s_) + " s, found a second one");
    }
    flight_.waypoints.push_back({.time_s = time_s_,
                                 .lon_deg = lon.value,
                                 .lat_deg = lat.value,
                                 .up_m = alt.given ? alt.value : height.value,
                                 .above_terrain = height.given,
                                 .yaw_deg = yaw.value,
                                 .pitch_deg = pitch.value,
                                 .roll_deg = roll.value});
  }

  void look(const Words& words) {
    std::array fields{Field{"yaw", -360, 360}, Field{"pitch", -90, 90}, Field{"roll", -360, 360}};
    if (!read_fields(words, fields)) return;
    const auto& [yaw, pitch, roll] = fields;
    if (words.empty()) return fail("at least one of yaw, pitch, roll after \"look\"");
    if (!flight_.heads.empty() && flight_.heads.back().time_s == time_s_) {
      return fail("one look at " + format_number(time_s_) + " s, found a second one");
    }
    flight_.heads.push_back({time_s_, yaw.value, pitch.value, roll.value});
  }

  void set(const Words& words) {
    if (words.empty()) return fail("KEY=VALUE after \"set\"");
    for (const std::string_view word : words) {
      const std::optional<KeyValue> pair = split_key_value(word);
      if (!pair) {
        fail("KEY=VALUE after \"set\", found " + quote(word));
      } else if (const std::string problem = vpe::core::Settings().set(pair->key, pair->value);
                 !problem.empty()) {
        fail("a setting of this program: " + printable(problem));
      } else {
        flight_.sets.push_back({time_s_, std::string(pair->key), std::string(pair->value)});
      }
    }
  }

  void interest(const Words& words) {
    std::array fields{Field{"lon", -360, 360}, Field{"lat", -90, 90},
                      Field{"radius", 0, FlightLimits::kMaxRadius_m},
                      Field{"levels", -FlightLimits::kMaxLevels, FlightLimits::kMaxLevels, true}};
    if (!read_fields(words, fields)) return;
    const auto& [lon, lat, radius, levels] = fields;
    if (!lon.given || !lat.given || !radius.given || !levels.given) {
      return fail("lon, lat, radius and levels in a region of interest");
    }
    flight_.interests.push_back(
        {time_s_, {lon.value, lat.value, radius.value, static_cast<int>(levels.value)}});
  }

  void end(const Words& words) {
    if (!words.empty()) return fail("nothing after \"end\", found " + quote(words[0]));
    flight_.end_s = time_s_;
    ended_ = true;
  }

  // Reads KEY=NUMBER words into `fields`. Returns false when one of them is wrong.
  bool read_fields(const Words& words, std::span<Field> fields, const char* other_keys = "") {
    const std::size_t errors_before = errors_.size();
    for (const std::string_view word : words) {
      const std::optional<KeyValue> pair = split_key_value(word);
      const auto field = std::find_if(fields.begin(), fields.end(),
                                      [&](const Field& f) { return pair && f.key == pair->key; });
      if (field == fields.end()) {
        fail("KEY=NUMBER with one of the keys " + join_keys(fields) + other_keys + ", found " + quote(word));
      } else if (field->given) {
        fail(std::string(field->key) + " once, found it again");
      } else if (!read(*field, pair->value)) {
        fail(what_is_allowed(*field) + ", found " + quote(pair->value));
      } else {
        field->given = true;
      }
    }
    return errors_.size() == errors_before && !full();
  }

  static std::string printable(std::string text) {
    for (char& c : text) {
      if (static_cast<unsigned char>(c) < 0x20 || static_cast<unsigned char>(c) >= 0x7f) c = '?';
    }
    return text;
  }

  std::string name_;
  int line_ = 0;
  double time_s_ = 0;
  bool version_seen_ = false;
  bool view_seen_ = false;
  bool time_seen_ = false;
  bool ended_ = false;
  Flight flight_;
  std::vector<FlightError> errors_;
};

}  // namespace

std::string to_string(const FlightError& error) {
  return error.file + ":" + std::to_string(error.line) + ": " + error.expected;
}

double duration_s(const Flight& flight) {
  if (flight.end_s) return *flight.end_s;
  double last_s = 0;
  const auto include = [&](const auto& commands) {
    if (!commands.empty()) last_s = std::max(last_s, commands.back().time_s);
  };
  include(flight.waypoints);
  include(flight.heads);
  include(flight.sets);
  include(flight.interests);
  return last_s;
}

ParsedFlight parse_flight(std::string_view text, const std::string& name) { return Parser(name).run(text); }

}  // namespace scripts
