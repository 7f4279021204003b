#include "vpe/explore/screens/screens_file.h"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>

#include "vpe/base/file.h"
#include "vpe/base/quote.h"
#include "vpe/base/toml_table.h"

namespace vpe::explore {

namespace {

using base::NumberRange;
using base::TomlTable;
using L = ScreenLimits;

constexpr std::string_view kScreensExtension = ".screens.toml";
constexpr NumberRange kScreenCoordinates_m{-L::kMostCoordinate_m, L::kMostCoordinate_m};
constexpr NumberRange kScales{L::kLeastScale, L::kMostScale};
constexpr NumberRange kEyeBases_m{0, L::kMostEyeBase_m};
constexpr NumberRange kFields_deg{ScreenLens::kLeastField_deg, ScreenLens::kMostField_deg};
constexpr NumberRange kDistortions{-ScreenLens::kMostCoefficient, ScreenLens::kMostCoefficient};
constexpr NumberRange kAxes_m{0, 1};
constexpr NumberRange kWidths_m{0, 1, true};
constexpr NumberRange kSides_px{L::kLeastSide_px, L::kMostSide_px};
constexpr NumberRange kPlaces_px{-L::kMostPlace_px, L::kMostPlace_px};

std::string problem_of_screen_name(std::string_view name) {
  const auto is_control = [](unsigned char c) { return c < 0x20 || c == 0x7f; };
  return name.empty() || name.size() > 64 || std::ranges::any_of(name, is_control)
             ? "expected a name of 1 to 64 bytes without control characters"
             : "";
}

glm::dvec3 point_of(const TomlTable& table, std::string_view key) {
  const toml::array& parts =
      table.list_of(table.at(key), key, 3, 3, "three numbers [right, up, backwards] in metres");
  glm::dvec3 point{0, 0, 0};
  for (int n = 0; n < 3; ++n)
    point[n] = table.number_of(parts[static_cast<std::size_t>(n)], key, kScreenCoordinates_m);
  return point;
}

glm::ivec2 pixels_of(const TomlTable& table, std::string_view key, const NumberRange& range,
                     std::string_view form) {
  const toml::array& parts = table.list_of(table.at(key), key, 2, 2, form);
  const auto whole = [&](const toml::node& node) {
    if (!node.is_integer()) table.fail_expecting(node, key, std::string(form) + " as integers");
    return static_cast<int>(table.number_of(node, key, range));
  };
  return {whole(parts[0]), whole(parts[1])};
}

class ScreensTomlReader {
 public:
  explicit ScreensTomlReader(const std::filesystem::path& path) : file_(path.string()) {}

  ScreenSet read(const toml::table& root) {
    const TomlTable top(root, "the file", file_);
    top.require_known({"version", "scale", "head", "eye_base", "level", "screen"});
    if (!top.has("version")) top.fail("version is missing; expected version = 1");
    top.integer("version", 1, 1);
    set_.scale = top.number("scale", kScales, 1);
    set_.eye_base_m = top.number("eye_base", kEyeBases_m, set_.eye_base_m);
    if (top.has("head")) set_.rest_m = point_of(top, "head");
    if (top.has("level")) set_.is_level = top.truth("level");
    const toml::node& node = top.at("screen");
    const toml::array* tables = node.as_array();
    if (tables == nullptr || tables->empty()) top.fail_expecting(node, "screen", "tables [[screen]]");
    if (tables->size() > static_cast<std::size_t>(L::kMostScreens))
      top.fail(node, "expected at most " + std::to_string(L::kMostScreens) + " screens, found " +
                         std::to_string(tables->size()));
    for (const toml::node& one : *tables) {
      if (!one.is_table()) top.fail_expecting(one, "screen", "tables [[screen]]");
      read_screen(TomlTable(*one.as_table(), "[[screen]]", file_));
    }
    return std::move(set_);
  }

 private:
  void read_screen(const TomlTable& table) {
    table.require_known(
        {"name", "eye", "monitor", "window", "pixels", "upper_left", "upper_right", "lower_left", "lens"});
    PlacedScreen screen;
    screen.name = table.text("name", problem_of_screen_name);
    for (const ScreenSet::Entry& other : set_.screens)
      if (other.screen.name == screen.name)
        table.fail(table.at("name"), "another screen is called " + base::quote_text(screen.name) + " too");
    if (table.has("eye"))
      screen.eye = static_cast<ScreenEye>(table.choice("eye", {"middle", "left", "right", "both"}));
    screen.window = window_of(table);
    const glm::ivec2 window_px = pixels_of(table, "pixels", kSides_px, "two sides [width, height] in pixels");
    screen.width_px = window_px.x;
    screen.height_px = window_px.y;
    if (table.has("lens")) {
      for (const std::string_view key : {"upper_left", "upper_right", "lower_left"})
        if (table.has(key))
          table.fail(table.at(key),
                     "a screen has corners or a lens: the screen behind a lens goes with the head");
      screen.place = lens_of(table);
    } else {
      screen.place = ScreenCorners{point_of(table, "upper_left"), point_of(table, "upper_right"),
                                   point_of(table, "lower_left")};
    }
    FittedScreen fitted = fit(screen);
    if (!fitted.problem.empty()) table.fail("screen " + base::quote_text(screen.name) + ": " + fitted.problem);
    set_.screens.push_back({std::move(fitted.screen), window_px});
  }

  static WindowPlace window_of(const TomlTable& table) {
    if (table.has("monitor") == table.has("window"))
      table.fail("expected either monitor, its number or name, or window = [x, y] in screen coordinates");
    if (table.has("window"))
      return pixels_of(table, "window", kPlaces_px, "a position [x, y] in screen coordinates");
    if (table.at("monitor").is_string()) return MonitorName{table.text("monitor", problem_of_screen_name)};
    return MonitorNumber{static_cast<int>(table.integer("monitor", 1, L::kMostMonitors))};
  }

  ScreenLens lens_of(const TomlTable& screen) const {
    const toml::node& node = screen.at("lens");
    if (!node.is_table()) screen.fail_expecting(node, "lens", "a table [screen.lens]");
    const TomlTable table(*node.as_table(), "[screen.lens]", file_);
    table.require_known({"field", "distortion", "axes", "width"});
    ScreenLens lens;
    lens.field_deg = table.number("field", kFields_deg);
    if (table.has("distortion")) {
      const toml::array& parts = table.list_of(table.at("distortion"), "distortion", 1, lens.distortion.size(),
                                               "one to four coefficients of r^2, r^4, r^6, r^8");
      for (std::size_t n = 0; n < parts.size(); ++n)
        lens.distortion[n] = table.number_of(parts[n], "distortion", kDistortions);
    }
    if (table.has("axes") != table.has("width"))
      table.fail(
          "expected axes, the distance between the axes of both lenses, together with width, that of one "
          "eye's screen");
    if (table.has("axes")) {
      lens.axes_m = table.number("axes", kAxes_m);
      lens.width_m = table.number("width", kWidths_m);
    }
    return lens;
  }

  std::string file_;
  ScreenSet set_;
};

}  // namespace

bool is_screens_path(const std::filesystem::path& path) {
  return path.filename().string().ends_with(kScreensExtension);
}

ScreenSet parse_screens_toml(std::string_view text, const std::filesystem::path& path) {
  if (text.size() > kMostScreensFileBytes)
    throw std::runtime_error(path.string() + ":1: expected at most " +
                             std::to_string(kMostScreensFileBytes >> 20U) + " MiB");
  return ScreensTomlReader(path).read(base::parse_toml(text, path.string()));
}

ScreenSet read_screens_file(const std::filesystem::path& path) {
  if (!is_screens_path(path))
    throw base::file_error("read", path, "it is no file of screens", "name it *.screens.toml");
  const std::vector<std::uint8_t> bytes = base::read_file(path, kMostScreensFileBytes);
  return parse_screens_toml({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, path);
}

}  // namespace vpe::explore
