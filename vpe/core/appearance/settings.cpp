#include "vpe/core/appearance/settings.h"

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <variant>

#include "mars/geodesy/mars_time.h"
#include "vpe/base/number.h"
#include "vpe/core/appearance/gazetteer.h"
#include "vpe/core/appearance/palette.h"

namespace vpe::core {

namespace {

struct Number {
  double SettingsValues::*member;
  double min;
  double max;
};

struct Integer {
  int SettingsValues::*member;
  int min;
  int max;
};

struct Table {
  LevelTable SettingsValues::*member;
};

struct Text {
  std::string SettingsValues::*member;
  std::string grammar;
  std::string (*problem)(const std::string& text);  // empty when all is well
};

struct Word {
  std::string_view text;
  int value;
};

struct Choice {
  std::vector<Word> words;
  int (*read)(const SettingsValues&);
  void (*write)(SettingsValues&, int);
};

template <auto member>
Choice choice(std::vector<Word> words) {
  return {std::move(words), [](const SettingsValues& values) { return static_cast<int>(values.*member); },
          [](SettingsValues& values, int value) {
            using Member = std::remove_reference_t<decltype(values.*member)>;
            values.*member = static_cast<Member>(value);
          }};
}

template <class Enum>
Word word(std::string_view text, Enum value) {
  return {text, static_cast<int>(value)};
}

struct Key {
  std::string_view name;
  std::variant<Number, Integer, Choice, Table, Text> type;
  std::string_view unit;
  std::string_view meaning;
};

constexpr double kMost = LevelTableLimits::kMaxLevels;

const std::vector<Key>& keys() {
  using V = SettingsValues;
  static const std::vector<Key> all{
      {"mode",
       choice<&V::mode>({word("wireframe", Mode::kWireframe), word("markers", Mode::kMarkers),
                         word("unlit", Mode::kUnlit), word("lit", Mode::kLit),
                         word("coloured", Mode::kColoured), word("textured", Mode::kTextured)}),
       "",
       "how the surface is painted: edges of triangles, a dot at each vertex, colour without light, light "
       "without "
       "colour, both, or imagery with light (coloured where there is none)"},
      {"shading", choice<&V::shading>({word("flat", Shading::kFlat), word("gouraud", Shading::kGouraud)}), "",
       "one light and colour for each drawn triangle, or from posts and interpolated between them"},
      {"colour",
       choice<&V::colour>({word("none", Colour::kNone), word("elevation", Colour::kElevation),
                           word("slope", Colour::kSlope), word("aspect", Colour::kAspect),
                           word("image", Colour::kImage)}),
       "",
       "what the colour of coloured and unlit surfaces shows; image: the planet file's imagery at each post"},
      {"palette", Text{&V::palette, palette_grammar(), palette_problem}, "",
       "colours of elevation, slope and aspect; auto: as suits what is shown"},
      {"palette.low", Number{&V::palette_low, -1e6, 1e6}, "",
       "value at the palette's lower end, metres or degrees; both ends equal: as suits what is shown"},
      {"palette.high", Number{&V::palette_high, -1e6, 1e6}, "", "value at the palette's upper end"},
      {"ramp.low.hue", Number{&V::low_hue_deg, -360, 720}, "deg", "palette=hsv: hue at the lower end"},
      {"ramp.low.saturation", Number{&V::low_saturation, 0, 1}, "", "saturation there"},
      {"ramp.low.value", Number{&V::low_value, 0, 1}, "", "brightness there"},
      {"ramp.high.hue", Number{&V::high_hue_deg, -360, 720}, "deg", "palette=hsv: hue at the upper end"},
      {"ramp.high.saturation", Number{&V::high_saturation, 0, 1}, "", "saturation there"},
      {"ramp.high.value", Number{&V::high_value, 0, 1}, "", "brightness there"},
      {"colourise", choice<&V::colourise>({{"off", 0}, {"on", 1}}), "",
       "imagery keeps its brightness and takes hue and saturation from what 'colour' shows"},
      {"exaggeration", Number{&V::exaggeration, 0.1, 100}, "",
       "factor on every elevation, about the planet's sphere"},
      {"sun",
       Text{&V::sun, mars::sun_grammar(), [](const std::string& text) { return mars::sun_problem(text); }}, "",
       "where the light comes from: sun.azimuth and sun.elevation (local), a date, or a season and hour at the "
       "ground below the eye (in a film: below its start)"},
      {"sun.azimuth", Number{&V::sun_azimuth_deg, 0, 360}, "deg",
       "where the light comes from, clockwise from north, at the ground below the eye (in a film: below its "
       "start)"},
      {"sun.elevation", Number{&V::sun_elevation_deg, 0, 90}, "deg",
       "height of the light above the horizon, at the same place"},
      {"sun.ambient", Number{&V::sun_ambient, 0, 1}, "", "share of the light that reaches shaded slopes"},
      {"sun.diffuse", Number{&V::sun_diffuse, 0, 10}, "", "light on slopes that face the sun"},
      {"shadows", choice<&V::shadows>({{"off", 0}, {"on", 1}}), "", "ground casts shadows on ground"},
      {"gamma", Number{&V::gamma, 0.1, 10}, "", "coefficient of the display: greater is brighter"},
      {"haze.visibility", Number{&V::haze_visibility_m, 0, 1e9}, "m",
       "distance at which haze leaves 2 % of the contrast, in air as at the planet's sphere (thinner above, "
       "thicker below); "
       "0 = clear air"},
      {"markers.size", Number{&V::marker_px, 1, 64}, "px", "side of a dot of mode markers"},
      {"overlay.legend", choice<&V::legend>({{"off", 0}, {"on", 1}}), "", "palette with values and units"},
      {"overlay.graticule", choice<&V::graticule>({{"off", 0}, {"on", 1}}), "",
       "lines of longitude and latitude"},
      {"overlay.graticule.step", Number{&V::graticule_deg, 0, 90}, "deg",
       "between lines; 0 = as suits the picture"},
      {"overlay.contours", choice<&V::contours>({{"off", 0}, {"on", 1}}), "", "lines of equal elevation"},
      {"overlay.contours.step", Number{&V::contour_m, 0, 1e6}, "m", "between lines; 0 = as suits the picture"},
      {"overlay.scale", choice<&V::scale_bar>({{"off", 0}, {"on", 1}}), "",
       "bar of a round length at the ground in the picture's centre"},
      {"overlay.north", choice<&V::north_arrow>({{"off", 0}, {"on", 1}}), "", "arrow to the north"},
      {"overlay.time", choice<&V::time_code>({{"off", 0}, {"on", 1}}), "", "time of the frame in its flight"},
      {"overlay.compass",
       choice<&V::compass>({word("off", CompassStrip::kOff), word("on", CompassStrip::kBottom),
                            word("top", CompassStrip::kTop), word("horizon", CompassStrip::kHorizon)}),
       "", "marks of azimuth along the lower edge (on), the upper edge or the horizon"},
      {"overlay.title", Text{&V::title, "any text", [](const std::string&) { return std::string(); }}, "",
       "a line at the top"},
      {"overlay.names",
       Text{&V::names, "a CSV file with columns name, lon, lat",
            [](const std::string& text) { return gazetteer_problem(text); }},
       "", "names of places, but of those that ground hides"},
      {"overlay.distances", choice<&V::distances>({{"off", 0}, {"on", 1}}), "",
       "how far away it is beside each name, in a straight line from the eye"},
      {"lod.tolerance", Number{&V::lod_tolerance_px, 0, 1000}, "px",
       "largest geometric error that may be drawn; 0 draws the exact surface (with --backend voxel: see "
       "rays.mode)"},
      {"lod.triangles", Integer{&V::lod_triangles, 0, 1'000'000'000}, "",
       "hard cap on the triangles of a frame, above the tolerance; 0 = none"},
      {"lod.rule",
       choice<&V::lod_metric>({word("error", LodMetric::kError), word("hitchner", LodMetric::kDistance)}), "",
       "what decides how fine a tile is: its projected error, or the three control functions of 1992 alone"},
      {"lod.distance.scale", Number{&V::lod_distance_scale_m, 0, 1e12}, "m",
       "rule hitchner: a tile at distance x from the eye gets scale / x + offset levels"},
      {"lod.distance.offset", Number{&V::lod_distance_offset, -kMost, kMost}, "levels",
       "rule hitchner: levels that a tile gets however far it is"},
      {"lod.distance.weight", Number{&V::lod_distance_weight, 0, 100}, "",
       "rule hitchner: factor on the levels by distance"},
      {"lod.distance.table", Table{&V::lod_distance_table}, "",
       "rule hitchner: levels from each distance on, metres, in place of scale and offset; as in "
       "0:12,1e5:8,1e6:4"},
      {"lod.centre.scale", Number{&V::lod_centre_scale, 0, 1000}, "",
       "a tile at distance x from the picture's centre, in halves of its height, gets scale / x + offset "
       "levels"},
      {"lod.centre.offset", Number{&V::lod_centre_offset, -kMost, kMost}, "levels",
       "levels that a tile gets wherever it is in the picture"},
      {"lod.centre.weight", Number{&V::lod_centre_weight, 0, 100}, "",
       "factor on the levels by distance from the picture's centre; 0 = all of the picture alike"},
      {"lod.centre.table", Table{&V::lod_centre_table}, "",
       "levels from each distance from the centre on, halves of the picture's height, in place of scale and "
       "offset"},
      {"lod.interest.weight", Number{&V::lod_interest_weight, 0, 100}, "",
       "factor on the levels of regions of interest"},
      {"lod.frame_ms", Number{&V::lod_frame_ms, 0, 10000}, "ms",
       "time that a frame should take while the eye moves, held by drawing coarser; 0 = none; single pictures "
       "and "
       "films are always drawn in full"},
      {"cull.occlusion",
       choice<&V::occlusion>(
           {word("auto", Occlusion::kAuto), word("off", Occlusion::kOff), word("on", Occlusion::kOn)}),
       "",
       "leaves out what nearer ground hides, which changes no pixel; auto: in windows only while it saves more "
       "than "
       "it costs"},
      {"rays.mode",
       choice<&V::ray_mode>({word("exact", RayMode::kExact), word("multires", RayMode::kMultires),
                             word("plain", RayMode::kPlain)}),
       "",
       "voxel backend: exact draws the exact surface; multires takes coarser cells far away; plain follows "
       "every "
       "ray in steps of 0.6 cells, slowly, for comparison"},
      {"rays.cell", Number{&V::ray_cell_px, RayLimits::kLeastCell_px, RayLimits::kMostCell_px}, "px",
       "voxel backend, multires: cells are off the surface by at most this in the picture; more is faster"},
      {"samples", choice<&V::samples>({{"1", 1}, {"2", 2}, {"4", 4}}), "",
       "colour samples a pixel (anti-aliasing); without a GPU more than one more than doubles the time; voxel "
       "backend: rays a pixel"},
      {"edges", choice<&V::smooth_edges>({{"hard", 0}, {"smooth", 1}}), "",
       "stair steps at ridges and the skyline are smoothed when there is one sample a pixel"},
      {"background",
       choice<&V::background>({word("black", Background::kBlack), word("white", Background::kWhite),
                               word("sky", Background::kSky)}),
       "", "colour behind the planet; sky is the dusty air of Mars, black seen from space"},
      {"inspect",
       choice<&V::inspect>({word("none", Inspect::kNone), word("borders", Inspect::kBorders),
                            word("levels", Inspect::kLevels)}),
       "",
       "shows how the picture is made: lines along the tiles' borders, or tiles tinted by their level of "
       "detail"},
  };
  return all;
}

const Key* find_key(std::string_view name) {
  const auto key = std::find_if(keys().begin(), keys().end(), [&](const Key& k) { return k.name == name; });
  return key == keys().end() ? nullptr : &*key;
}

std::string to_text(const SettingsValues& values, const Key& key) {
  if (const auto* number = std::get_if<Number>(&key.type)) return base::format_number(values.*number->member);
  if (const auto* integer = std::get_if<Integer>(&key.type)) return std::to_string(values.*integer->member);
  if (const auto* table = std::get_if<Table>(&key.type)) return format_level_table(values.*table->member);
  if (const auto* plain = std::get_if<Text>(&key.type)) return values.*plain->member;
  const auto& words = std::get<Choice>(key.type);
  const auto found = std::find_if(words.words.begin(), words.words.end(),
                                  [&](const Word& w) { return w.value == words.read(values); });
  return std::string(found->text);
}

// Sets the value when it is allowed. problem: more than that it is not allowed, where more is known.
bool apply(SettingsValues& values, const Key& key, std::string_view text, std::string& problem) {
  if (const auto* number = std::get_if<Number>(&key.type)) {
    const std::optional<double> value = base::parse_number(text);
    if (!value || *value < number->min || *value > number->max) return false;
    values.*number->member = *value;
    return true;
  }
  if (const auto* integer = std::get_if<Integer>(&key.type)) {
    const std::optional<std::int64_t> value = base::parse_integer(text);
    if (!value || *value < integer->min || *value > integer->max) return false;
    values.*integer->member = static_cast<int>(*value);
    return true;
  }
  if (const auto* table = std::get_if<Table>(&key.type)) {
    std::optional<LevelTable> value = parse_level_table(text);
    if (value) values.*table->member = std::move(*value);
    return value.has_value();
  }
  if (const auto* plain = std::get_if<Text>(&key.type)) {
    std::string value(text);
    const bool is_plain = std::none_of(
        value.begin(), value.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == '\x7f'; });
    problem = is_plain ? plain->problem(value) : "it holds control characters";
    if (problem.empty()) values.*plain->member = std::move(value);
    return problem.empty();
  }
  const auto& words = std::get<Choice>(key.type);
  const auto found =
      std::find_if(words.words.begin(), words.words.end(), [&](const Word& w) { return w.text == text; });
  if (found == words.words.end()) return false;
  words.write(values, found->value);
  return true;
}

SettingInfo info_of(const Key& key) {
  SettingInfo info;
  info.key = key.name;
  info.default_text = to_text({}, key);
  info.unit = key.unit;
  info.meaning = key.meaning;
  if (const auto* number = std::get_if<Number>(&key.type)) {
    info.min = number->min;
    info.max = number->max;
  } else if (const auto* integer = std::get_if<Integer>(&key.type)) {
    info.type = SettingType::kInteger;
    info.min = integer->min;
    info.max = integer->max;
  } else if (std::holds_alternative<Table>(key.type)) {
    info.type = SettingType::kTable;
    info.grammar = level_table_grammar();
  } else if (const auto* plain = std::get_if<Text>(&key.type)) {
    info.type = SettingType::kText;
    info.grammar = plain->grammar;
  } else {
    info.type = SettingType::kChoice;
    for (const Word& w : std::get<Choice>(key.type).words) info.choices.push_back(w.text);
  }
  return info;
}

std::string join(const std::vector<std::string_view>& words) {
  std::string text;
  for (const std::string_view w : words) text.append(text.empty() ? "" : ", ").append(w);
  return text;
}

std::string what_is_allowed(const Key& key) {
  const SettingInfo info = info_of(key);
  if (info.type == SettingType::kTable || info.type == SettingType::kText) return info.grammar;
  if (info.type == SettingType::kChoice) return "one of " + join(info.choices);
  std::string text = info.type == SettingType::kInteger ? "a whole number from " : "a number from ";
  text.append(base::format_number(info.min)).append(" to ").append(base::format_number(info.max));
  if (!info.unit.empty()) text.append(" ").append(info.unit);
  return text;
}

std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0]++;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replaced, row[j] + 1, diagonal + 1});
    }
  }
  return row.back();
}

std::string unknown_key(std::string_view name) {
  constexpr std::size_t kLongestName = 64;
  const std::string_view shown = name.substr(0, kLongestName);
  std::vector<std::string_view> all;
  std::vector<std::string_view> near;
  for (const Key& key : keys()) {
    all.push_back(key.name);
    const bool part = shown.size() >= 3 && key.name.find(shown) != std::string_view::npos;
    const std::size_t typos = std::max<std::size_t>(1, key.name.size() / 4);
    if (part || edit_distance(shown, key.name) <= typos) near.push_back(key.name);
  }
  std::string text = "unknown setting \"";
  text.append(shown).append("\"; ");
  return near.empty() ? text.append("the settings are ").append(join(all))
                      : text.append("did you mean ").append(join(near)).append("?");
}

}  // namespace

std::span<const SettingInfo> Settings::list() {
  static const std::vector<SettingInfo> infos = [] {
    std::vector<SettingInfo> all;
    for (const Key& key : keys()) all.push_back(info_of(key));
    return all;
  }();
  return infos;
}

std::string Settings::set(std::string_view name, std::string_view text) {
  const Key* key = find_key(name);
  if (key == nullptr) return unknown_key(name);
  std::string problem;
  if (name.starts_with("overlay.") && !core::overlays_refused().empty() && text != to_text({}, *key)) {
    return std::string(name) + ": " + std::string(core::overlays_refused());
  }
  if (apply(values_, *key, text, problem)) return {};
  constexpr std::size_t kLongestText = 64;
  return std::string(name) + "=" + std::string(text.substr(0, kLongestText)) +
         " is not allowed: " + (problem.empty() ? "" : problem + "; ") + "expected " + what_is_allowed(*key);
}

std::string Settings::assign(std::string_view assignment) {
  const std::size_t equals = assignment.find('=');
  if (equals == std::string_view::npos) {
    return "expected KEY=VALUE, found \"" + std::string(assignment.substr(0, 64)) + "\"";
  }
  return set(assignment.substr(0, equals), assignment.substr(equals + 1));
}

std::optional<std::string> Settings::get(std::string_view name) const {
  const Key* key = find_key(name);
  return key == nullptr ? std::nullopt : std::optional(to_text(values_, *key));
}

}  // namespace vpe::core
