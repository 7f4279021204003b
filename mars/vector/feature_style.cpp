#include "mars/vector/feature_style.h"

#include <algorithm>
#include <string_view>

#include "mars/raster/gdal/gdal_scope.h"
#include "mars/vector/field_types.h"
#include "mars/vector/ogr_style.h"
#include "mars/vector/style_values.h"
#include "vpe/base/number.h"
#include "vpe/base/quote.h"

namespace mars {
namespace {

constexpr double kSmallMarker_px = 6;
constexpr double kMediumMarker_px = 8;
constexpr double kLargeMarker_px = 12;
constexpr double kFillOpacity = 0.6;

// Reads the properties of one feature.
class StyleReader {
 public:
  StyleReader(const Feature& feature, const FeatureLayer& layer, const FeatureStyle& defaults)
      : feature_(feature), layer_(layer), defaults_(defaults), style_(defaults) {}

  FeatureStyle read() {
    read_style_string();
    read_simplestyle();
    read_scales();
    if (const std::string text = attribute("legend"); !text.empty()) style_.legend = text;
    return style_;
  }

 private:
  [[noreturn]] void fail(const std::string& property, std::string_view value,
                         const std::string& expected) const {
    throw source_error("layer '" + layer_.name + "'", "feature " + std::to_string(feature_.number),
                       property + " is " + vpe::base::quote_text(value), "expected " + expected);
  }

  StyleColour colour(const std::string& property, std::string_view text) const {
    if (const auto value = parse_style_colour(text)) return *value;
    fail(property, text, "a colour, as #ff8800");
  }

  StyleMeasure measure(const std::string& property, std::string_view text) const {
    if (const auto value = parse_style_length(text)) return *value;
    fail(property, text, "a length that is not negative, as 2px or 0.5mm");
  }

  // Returns a length, or a multiple of `base` for a number without a unit.
  StyleLength scaled(const std::string& property, std::string_view text, StyleLength base) const {
    const StyleMeasure value = measure(property, text);
    return value.has_unit ? value.length : StyleLength{base.value * value.length.value, base.on_ground};
  }

  // Returns the text of the attribute of this name, or "".
  std::string attribute(std::string_view name) const {
    const auto found = std::ranges::find(layer_.fields, name);
    const auto index = static_cast<std::size_t>(found - layer_.fields.begin());
    return index < feature_.values.size() ? field_text(feature_.values[index]) : "";
  }

  void read_style_string() {
    const auto tools = parse_ogr_style(feature_.style);
    if (!tools) fail("style string", feature_.style, "one of OGR, as PEN(c:#ff0000,w:2px)");
    for (const StyleTool& tool : *tools) {
      for (const auto& [key, value] : tool.parameters) {
        const std::string property = tool.name + "(" + key + ")";
        if (tool.name == "PEN") read_pen(key, value, property);
        if (tool.name == "BRUSH") read_brush(key, value, property);
        if (tool.name == "SYMBOL") read_symbol(key, value, property);
        if (tool.name == "LABEL") read_label(key, value, property);
      }
    }
  }

  void read_pen(const std::string& key, const std::string& value, const std::string& property) {
    if (key == "c") style_.stroke = colour(property, value);
    if (key == "w") style_.width = measure(property, value).length;
    if (key == "p") style_.dash = pattern(value, property);
    if (key == "id" && value.find("ogr-pen-1") == 0) style_.stroke.reset();
  }

  void read_brush(const std::string& key, const std::string& value, const std::string& property) {
    if (key == "fc") style_.fill = colour(property, value);
    if (key == "id" && value.find("ogr-brush-1") == 0) style_.fill.reset();
  }

  void read_symbol(const std::string& key, const std::string& value, const std::string& property) {
    if (key == "c") style_.marker = colour(property, value);
    if (key == "s") style_.marker_size = scaled(property, value, defaults_.marker_size);
  }

  void read_label(const std::string& key, const std::string& value, const std::string& property) {
    if (key == "c") style_.label_colour = colour(property, value);
    if (key == "s") style_.label_size = scaled(property, value, defaults_.label_size);
    if (key == "t") style_.label = with_attributes(value);
  }

  std::vector<StyleLength> pattern(std::string_view text, const std::string& property) const {
    std::vector<StyleLength> lengths;
    for (std::size_t at = text.find_first_not_of(' '); at < text.size(); at = text.find_first_not_of(' ', at)) {
      const std::size_t end = std::min(text.find(' ', at), text.size());
      lengths.push_back(measure(property, text.substr(at, end - at)).length);
      at = end;
    }
    const bool has_length = std::ranges::any_of(lengths, [](StyleLength l) { return l.value > 0; });
    if (lengths.empty() || lengths.size() % 2 != 0 || !has_length)
      fail(property, text, "lengths of strokes and gaps in turn, as \"4px 5px\"");
    return lengths;
  }

  std::string with_attributes(std::string_view text) const {
    std::string filled;
    for (std::size_t at = 0; at < text.size();) {
      const std::size_t open = text.find('{', at);
      const std::size_t end = open == std::string_view::npos ? open : text.find('}', open);
      if (end == std::string_view::npos) return filled + std::string(text.substr(at));
      filled += std::string(text.substr(at, open - at)) + attribute(text.substr(open + 1, end - open - 1));
      at = end + 1;
    }
    return filled;
  }

  double opacity(const std::string& name, const std::string& text) const {
    const auto value = vpe::base::parse_number(text);
    if (!value || *value < 0 || *value > 1) fail(name, text, "a number from 0 to 1");
    return *value;
  }

  void read_simplestyle() {
    if (const std::string text = attribute("title"); !text.empty()) style_.label = text;
    read_paint("stroke", 1, style_.stroke);
    read_paint("fill", kFillOpacity, style_.fill);
    if (const std::string text = attribute("stroke-width"); !text.empty())
      style_.width = pixels("stroke-width", text);
    if (const std::string text = attribute("marker-color"); !text.empty())
      style_.marker = colour("marker-color", text);
    if (const std::string text = attribute("marker-size"); !text.empty())
      style_.marker_size = marker_size(text);
  }

  double scale(const std::string& name, double unsaid) const {
    const std::string text = attribute(name);
    if (text.empty()) return unsaid;
    const auto value = vpe::base::parse_number(text);
    if (!value || !(*value >= 0)) fail(name, text, "metres of ground a pixel, 0 or more");
    return *value;
  }

  void read_scales() {
    style_.min_scale_m = scale("min-scale", defaults_.min_scale_m);
    style_.max_scale_m = scale("max-scale", defaults_.max_scale_m);
    if (!(style_.max_scale_m > style_.min_scale_m))
      fail("max-scale", attribute("max-scale"), "more metres a pixel than min-scale");
  }

  // Reads a colour and its opacity, each of which may be given alone.
  void read_paint(const std::string& name, double unsaid_opacity, std::optional<StyleColour>& paint) const {
    if (const std::string text = attribute(name); !text.empty()) {
      const double unsaid = paint ? paint->opacity : unsaid_opacity;
      paint = colour(name, text);
      const bool has_own = text.size() >= 8;
      if (!has_own) paint->opacity = unsaid;
    }
    const std::string text = attribute(name + "-opacity");
    if (text.empty()) return;
    const double value = opacity(name + "-opacity", text);
    if (paint) paint->opacity = value;
  }

  StyleLength pixels(const std::string& name, const std::string& text) const {
    const StyleMeasure value = measure(name, text);
    if (value.has_unit) fail(name, text, "a number of pixels");
    return value.length;
  }

  StyleLength marker_size(const std::string& text) const {
    if (text == "small") return {kSmallMarker_px, false};
    if (text == "medium") return {kMediumMarker_px, false};
    if (text == "large") return {kLargeMarker_px, false};
    const auto value = parse_style_length(text);
    if (!value || value->has_unit) fail("marker-size", text, "small, medium, large or a number of pixels");
    return value->length;
  }

  const Feature& feature_;
  const FeatureLayer& layer_;
  const FeatureStyle& defaults_;
  FeatureStyle style_;
};

}  // namespace

FeatureStyle feature_style(const Feature& feature, const FeatureLayer& layer, const FeatureStyle& defaults) {
  return StyleReader(feature, layer, defaults).read();
}

}  // namespace mars
