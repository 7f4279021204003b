// Describes how a feature is drawn, by what its file says.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "mars/vector/feature.h"
#include "vpe/base/rgb.h"

namespace mars {

// Holds a colour and how opaque it is.
struct StyleColour {
  vpe::base::Rgb rgb;
  double opacity = 1;  // 0 to 1

  bool operator==(const StyleColour&) const = default;
};

// Holds a length on the image or on the ground.
struct StyleLength {
  double value = 0;
  bool on_ground = false;  // metres; else pixels

  bool operator==(const StyleLength&) const = default;
};

// Describes how a feature is drawn.
struct FeatureStyle {
  std::optional<StyleColour> stroke = StyleColour{};  // of lines and outlines; nullopt: not drawn
  StyleLength width{2, false};
  std::vector<StyleLength> dash;                      // lengths of a stroke and of a gap in turn; empty: solid
  std::optional<StyleColour> fill;                    // of polygons; nullopt: not filled
  std::optional<StyleColour> marker = StyleColour{};  // of points; nullopt: not drawn
  StyleLength marker_size{8, false};
  std::string label;  // empty: none
  StyleColour label_colour;
  StyleLength label_size{14, false};  // height of the letters
  // The feature is drawn where a pixel covers at least min_scale_m and less than max_scale_m metres of ground.
  double min_scale_m = 0;
  double max_scale_m = std::numeric_limits<double>::infinity();
  std::string legend;  // what a legend says of it; empty: the layer's name

  bool operator==(const FeatureStyle&) const = default;
};

// Returns the style of a feature of a layer: `defaults`, changed by its OGR style string, and then by its attributes
// of the Simplestyle specification 1.1.0: title (the label), stroke, stroke-width, stroke-opacity, fill, fill-opacity,
// marker-color, marker-size (small, medium, large: 6, 8 and 12 pixels; or a number of pixels). Colours there are #rgb
// or #rrggbb; the # may be left out. Where `defaults` have no fill, the opacity of one is 0.6. Three attributes are of
// this program: min-scale and max-scale, metres a pixel, and legend. Attributes without a value change nothing.
//
// Reads of style strings (OGR Feature Style Specification): PEN(c, w, p), BRUSH(fc), SYMBOL(c, s),
// LABEL(c, s, t), and id ogr-pen-1 and ogr-brush-1, which draw nothing. Other tools and parameters are left out.
// Colours are #rrggbb or #rrggbbaa. Units are px, pt, mm, cm, in (96 pixels to the inch) and g, which is taken for
// metres; a number without a unit is one of pixels, and in SYMBOL(s) and LABEL(s), as KML has it, a scale of the
// default. {NAME} in a label's text stands for the attribute NAME. A reference to a table of styles, @NAME, changes
// nothing.
//
// Throws SourceError, which names layer, feature and property, for a value that is not as above. Pure.
FeatureStyle feature_style(const Feature& feature, const FeatureLayer& layer, const FeatureStyle& defaults);

}  // namespace mars
