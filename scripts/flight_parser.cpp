#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <set>
#include <span>

#include "scripts/flight.h"
#include "scripts/flight_words.h"
#include "scripts/ground_lines.h"
#include "vpe/base/number.h"
#include "vpe/core/appearance/settings.h"
#include "vpe/core/view.h"

namespace scripts {

using vpe::base::format_number;
using vpe::base::parse_integer;
using vpe::base::parse_number;
using vpe::core::DrawnBy;
using vpe::core::ViewLimits;

namespace {

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
      fail("the first command " + versions() + ", found an empty file");
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

  static std::string versions() { return "\"flight 1\", \"flight 1.1\", \"flight 1.2\" or \"flight 1.3\""; }

  bool version(const Words& words) {
    const bool named = words.size() == 2 && words[0] == "flight";
    constexpr std::array<std::string_view, 4> kVersions{"1", "1.1", "1.2", "1.3"};
    const auto found = named ? std::find(kVersions.begin(), kVersions.end(), words[1]) : kVersions.end();
    version_seen_ = found != kVersions.end();
    if (version_seen_) {
      version_ = static_cast<FlightVersion>(found - kVersions.begin());
      return true;
    }
    const bool other = named && parse_number(words[1]).has_value();
    fail(other ? versions() + " (this program reads versions 1 to 1.3), found version " + words[1]
               : "the first command " + versions() + ", found " + quote(words[0]));
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
    std::array texts{TextField{"size"}, TextField{"fps"}};
    if (read_fields(take_texts(words, 1, texts), fields, texts) && fields[0].given)
      flight_.view.fov_deg = fields[0].value;
    const auto& [size, fps] = texts;
    if (size.value) {
      if (const std::optional<ImageSize> read = read_size(*size.value)) {
        flight_.view.width = read->width;
        flight_.view.height = read->height;
      }
    }
    if (fps.value) read_fps(*fps.value);
  }

  // Moves values of keys that are not numbers into `texts`. Returns the other words from `first` on.
  Words take_texts(const Words& words, std::size_t first, std::span<TextField> texts) {
    Words others;
    for (const std::string& word : std::span(words).subspan(first)) {
      const std::optional<KeyValue> pair = split_key_value(word);
      const auto own = std::find_if(texts.begin(), texts.end(),
                                    [&](const TextField& text) { return pair && text.key == pair->key; });
      if (own == texts.end()) {
        others.push_back(word);
      } else if (own->value) {
        fail(std::string(pair->key) + " once, found it again");
      } else {
        own->value = pair->value;
      }
    }
    return others;
  }

  std::optional<ImageSize> read_size(std::string_view text) {
    const std::size_t x = text.find('x');
    const auto side = [](std::string_view digits) {
      const std::optional<std::int64_t> value = parse_integer(digits);
      return value && *value >= 1 && *value <= ViewLimits::kMaxSide_px ? static_cast<int>(*value) : 0;
    };
    const int width = side(text.substr(0, x));
    const int height = x == std::string_view::npos ? 0 : side(text.substr(x + 1));
    if (width > 0 && height > 0) return ImageSize{width, height};
    fail("size=WIDTHxHEIGHT, each from 1 to " + std::to_string(ViewLimits::kMaxSide_px) + ", found " +
         quote(text));
    return std::nullopt;
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
    if (words.size() < 3) return fail("at TIME followed by " + std::string(commands()));
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
    if (name == "view") return timed_view(arguments);
    if (name == "object") return object(arguments);
    if (name == "relief" || name == "patch") return ground(name, arguments);
    fail(std::string(commands()) + " after the time, found " + quote(name));
  }

  std::string_view commands() const {
    if (version_ == FlightVersion::k1) return "pose, look, set, interest or end";
    if (version_ == FlightVersion::k1_1) return "pose, look, set, interest, view or end";
    return version_ == FlightVersion::k1_2 ? "pose, look, set, interest, view, object or end"
                                           : "pose, look, set, interest, view, object, relief, patch or end";
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

  void timed_view(const Words& words) {
    if (version_ == FlightVersion::k1)
      return fail("\"flight 1.1\" as the first command of a flight with \"at TIME view\", found \"flight 1\"");
    std::array fields{Field{"fov", ViewLimits::kMinFov_deg, ViewLimits::kMaxFov_deg},
                      Field{"base", 0, FlightLimits::kMaxEyeBase_m},
                      Field{"convergence", 0, FlightLimits::kMaxConvergence_m}};
    std::array texts{TextField{"size"}, TextField{"backend"}, TextField{"eyes"}};
    const std::size_t errors_before = errors_.size();
    (void)read_fields(take_texts(words, 0, texts), fields, texts);
    const auto& [fov, base, convergence] = fields;
    const auto& [size, backend, eyes] = texts;
    ViewState view;
    if (fov.given) view.fov_deg = fov.value;
    if (base.given) view.eye_base_m = base.value;
    if (convergence.given) view.convergence_m = convergence.value;
    if (size.value) view.size = read_size(*size.value);
    if (backend.value) view.backend = read_backend(*backend.value);
    if (eyes.value) view.eyes = read_eyes(*eyes.value);
    if (errors_.size() != errors_before || full()) return;
    if (words.empty())
      return fail("at least one of fov, base, convergence, size, backend, eyes after \"view\"");
    if (!flight_.views.empty() && flight_.views.back().time_s == time_s_)
      return fail("one view at " + format_number(time_s_) + " s, found a second one");
    flight_.views.push_back({time_s_, view});
  }

  void object(const Words& words) {
    if (version_ < FlightVersion::k1_2)
      return fail("\"flight 1.2\" as the first command of a flight with \"at TIME object\"");
    using Limits = vpe::core::ObjectTrackLimits;
    if (words.empty() || words[0].empty() || words[0].size() > Limits::kMostNameBytes)
      return fail("the name of an object, 1 to " + std::to_string(Limits::kMostNameBytes) +
                  " bytes, after \"object\"");
    std::array fields{Field{"lon", -360, 360}, Field{"lat", -90, 90},
                      Field{"height", -Limits::kMostHeight_m, Limits::kMostHeight_m},
                      Field{"heading", -360, 360}};
    std::array texts{TextField{"show"}};
    const std::size_t errors_before = errors_.size();
    (void)read_fields(take_texts(words, 1, texts), fields, texts);
    const auto& [lon, lat, height, heading] = fields;
    const std::optional<std::string_view> show = texts[0].value;
    if (show && *show != "on" && *show != "off") fail("show=on or show=off, found " + quote(*show));
    if (errors_.size() != errors_before || full()) return;
    const bool has_place = lon.given || lat.given || height.given || heading.given;
    if (has_place && !(lon.given && lat.given)) return fail("lon=.. and lat=.. of an object");
    if (!has_place && !show) return fail("lon=.. and lat=.., or show=on or show=off of an object");
    if (flight_.objects.empty() || flight_.objects.back().time_s != time_s_) objects_now_.clear();
    if (!objects_now_.insert(words[0]).second)
      return fail("one line of " + quote(words[0]) + " at " + format_number(time_s_) +
                  " s, found a second one");
    ObjectCommand command{time_s_, words[0], std::nullopt, std::nullopt};
    if (has_place)
      command.place = {lon.value, lat.value, height.value,
                       heading.given ? std::optional(heading.value) : std::nullopt};
    if (show) command.is_shown = *show == "on";
    flight_.objects.push_back(std::move(command));
  }

  void ground(std::string_view name, const Words& words) {
    if (version_ < FlightVersion::k1_3)
      return fail("\"flight 1.3\" as the first command of a flight with \"at TIME " + std::string(name) + "\"");
    const std::string problem = name == "relief" ? ground_.add_relief(time_s_, words, flight_.reliefs)
                                                 : ground_.add_patch(time_s_, words, flight_.patches);
    if (!problem.empty()) fail(problem);
  }

  std::optional<DrawnBy> read_backend(std::string_view text) {
    const std::optional<vpe::core::Backend> backend = vpe::core::parse_backend(text);
    if (backend || text == to_string(DrawnBy::kAuto)) return vpe::core::drawn_by(backend);
    fail("backend=polygon, backend=ray or backend=auto, found " + quote(text));
    return std::nullopt;
  }

  std::optional<Eyes> read_eyes(std::string_view text) {
    const std::optional<vpe::core::StereoLayout> layout = vpe::core::parse_stereo(text);
    if (layout || text == "off") return Eyes{layout};
    fail("eyes=off, eyes=sbs, eyes=ou or eyes=anaglyph, found " + quote(text));
    return std::nullopt;
  }

  void end(const Words& words) {
    if (!words.empty()) return fail("nothing after \"end\", found " + quote(words[0]));
    flight_.end_s = time_s_;
    ended_ = true;
  }

  // Reads KEY=NUMBER words into `fields`. Returns false when one of them is wrong. `texts` are the other keys that
  // the command allows.
  bool read_fields(const Words& words, std::span<Field> fields, std::span<const TextField> texts = {}) {
    const std::size_t errors_before = errors_.size();
    std::string other_keys;
    for (const TextField& text : texts) other_keys.append(", ").append(text.key);
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
  FlightVersion version_ = FlightVersion::k1;
  bool version_seen_ = false;
  bool view_seen_ = false;
  bool time_seen_ = false;
  bool ended_ = false;
  std::set<std::string> objects_now_;  // with a line at the time of the last one
  GroundLines ground_;
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
  include(flight.views);
  include(flight.objects);
  include(flight.reliefs);
  include(flight.patches);
  return last_s;
}

ParsedFlight parse_flight(std::string_view text, const std::string& name) { return Parser(name).run(text); }

}  // namespace scripts
