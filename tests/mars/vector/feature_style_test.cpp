#include "mars/vector/feature_style.h"

#include <gtest/gtest.h>

#include "mars/sources/source.h"
#include "mars/vector/ogr_style.h"
#include "mars/vector/style_values.h"
#include "tests/mars/vector/vector_files.h"
#include "tests/support/support.h"

namespace {

using mars::Feature;
using mars::FeatureLayer;
using mars::FeatureStyle;
using mars::FieldValue;
using mars::StyleColour;
using mars::StyleLength;
using vector_files::expect_words;

// A layer of one feature with these attributes and this style string.
FeatureLayer layer_of(const std::vector<std::pair<std::string, FieldValue>>& attributes,
                      const std::string& style = "") {
  FeatureLayer layer;
  layer.name = "tracks";
  Feature feature;
  feature.number = 17;
  feature.style = style;
  for (const auto& [name, value] : attributes) {
    layer.fields.push_back(name);
    feature.values.push_back(value);
  }
  layer.features.push_back(feature);
  return layer;
}

FeatureStyle style_of(const FeatureLayer& layer, const FeatureStyle& defaults = {}) {
  return mars::feature_style(layer.features[0], layer, defaults);
}

std::string style_error(const FeatureLayer& layer) {
  try {
    style_of(layer);
  } catch (const mars::SourceError& error) {
    return error.what();
  }
  return {};
}

constexpr StyleColour kOrange{{255, 136, 0}, 1};

TEST(FeatureStyle, DefaultsStay) {
  FeatureStyle defaults;
  defaults.width = {5, true};
  defaults.label = "x";
  EXPECT_EQ(style_of(layer_of({}), defaults), defaults);
  EXPECT_EQ(
      style_of(layer_of({{"stroke", FieldValue()}, {"fill", ""}, {"Stroke", "nonsense"}}, "@s1"), defaults),
      defaults);
}

TEST(FeatureStyle, Simplestyle) {
  const FeatureStyle style = style_of(layer_of({{"stroke", "#ff8800"},
                                                {"stroke-width", 2.5},
                                                {"stroke-opacity", 0.25},
                                                {"fill", "f80"},
                                                {"title", "Sol 17"},
                                                {"marker-color", "#FF8800"},
                                                {"marker-size", "large"}}));
  EXPECT_EQ(style.stroke, (StyleColour{kOrange.rgb, 0.25}));
  EXPECT_EQ(style.width, (StyleLength{2.5, false}));
  EXPECT_EQ(style.fill, (StyleColour{kOrange.rgb, 0.6}));
  EXPECT_EQ(style.label, "Sol 17");
  EXPECT_EQ(style.marker, kOrange);
  EXPECT_EQ(style.marker_size.value, 12);
  const FeatureStyle numbers = style_of(layer_of({{"fill", std::int64_t{112233}},
                                                  {"fill-opacity", std::int64_t{1}},
                                                  {"title", std::int64_t{7}},
                                                  {"marker-size", std::int64_t{20}}}));
  EXPECT_EQ(numbers.fill, (StyleColour{{0x11, 0x22, 0x33}, 1}));
  EXPECT_EQ(numbers.label, "7");
  EXPECT_EQ(numbers.marker_size.value, 20);
}

TEST(FeatureStyle, OgrStyleStrings) {
  const FeatureStyle style = style_of(layer_of(
      {{"name", "Gale"}, {"sol", std::int64_t{9}}},
      R"(PEN(c:#ff880080,w:1.5pt,p:"4px 2px"); brush( fc : #00ff00 );SYMBOL(c:#0000FF,s:2.0,id:"http://x/y,z.png");)"
      R"(LABEL(f:"Arial, \"bold\"",t:"{name}: sol {sol}",s:10g,c:#fff))"));
  EXPECT_EQ(style.stroke, (StyleColour{kOrange.rgb, 128 / 255.0}));
  EXPECT_EQ(style.width, (StyleLength{2, false}));
  EXPECT_EQ(style.dash, (std::vector<StyleLength>{{4, false}, {2, false}}));
  EXPECT_EQ(style.fill, (StyleColour{{0, 255, 0}, 1}));
  EXPECT_EQ(style.marker, (StyleColour{{0, 0, 255}, 1}));
  EXPECT_EQ(style.marker_size.value, 16);
  EXPECT_EQ(style.label, "Gale: sol 9");
  EXPECT_EQ(style.label_size, (StyleLength{10, true}));
  EXPECT_EQ(style.label_colour, (StyleColour{{255, 255, 255}, 1}));
  const FeatureStyle none = style_of(
      layer_of({}, R"(PEN(id:"ogr-pen-1");BRUSH(fc:#000000,id:"ogr-brush-1,ogr-brush-0");FUTURE(x:1))"));
  EXPECT_FALSE(none.stroke);
  EXPECT_FALSE(none.fill);
  // An attribute is stronger than the style string.
  EXPECT_EQ(style_of(layer_of({{"stroke", "#ff8800"}}, "PEN(c:#000000)")).stroke, kOrange);
  EXPECT_EQ(style_of(layer_of({}, R"(LABEL(t:"{missing} {open"))")).label, " {open");
}

TEST(FeatureStyle, BadValues) {
  const std::vector<std::pair<FeatureLayer, std::string>> cases{
      {layer_of({{"stroke", "reddish"}}), "stroke is"},
      {layer_of({{"fill", "#12345"}}), "fill is"},
      {layer_of({{"marker-color", "#gggggg"}}), "marker-color is"},
      {layer_of({{"stroke-width", "-1"}}), "stroke-width is"},
      {layer_of({{"stroke-width", "2px"}}), "stroke-width is"},
      {layer_of({{"stroke-opacity", 1.5}}), "stroke-opacity is"},
      {layer_of({{"fill-opacity", "half"}}), "fill-opacity is"},
      {layer_of({{"marker-size", "huge"}}), "marker-size is"},
      {layer_of({}, "PEN(c:red)"), "PEN(c) is"},
      {layer_of({}, "PEN(w:wide)"), "PEN(w) is"},
      {layer_of({}, "PEN(p:\"4px\")"), "PEN(p) is"},
      {layer_of({}, "PEN(p:\"0px 0px\")"), "PEN(p) is"},
      {layer_of({}, "BRUSH(fc:#1)"), "BRUSH(fc) is"},
      {layer_of({}, "SYMBOL(s:1e9px)"), "SYMBOL(s) is"},
      {layer_of({}, "LABEL(c:)"), "LABEL(c) is"},
      {layer_of({}, "PEN(c:#000000"), "style string is"},
      {layer_of({}, "PEN"), "style string is"},
      {layer_of({}, "LABEL(t:\"open)"), "style string is"},
      {layer_of({}, "PEN(c:#000000) BRUSH(fc:#000000)"), "style string is"}};
  for (const auto& [layer, words] : cases)
    expect_words(style_error(layer), {"layer 'tracks'", "feature 17", words, "expected"});
}

TEST(FeatureStyle, ColoursAndLengths) {
  EXPECT_EQ(mars::parse_style_colour("#f80"), kOrange);
  EXPECT_EQ(mars::parse_style_colour("FF8800FF"), kOrange);
  for (const char* text : {"", "#", "#ff88", "#ff88000", "#ff880g", " #ff8800", "#ff8800ff0"})
    EXPECT_FALSE(mars::parse_style_colour(text)) << text;
  EXPECT_DOUBLE_EQ(mars::parse_style_length("1in")->length.value, 96);
  EXPECT_DOUBLE_EQ(mars::parse_style_length("2.54cm")->length.value, 96);
  EXPECT_DOUBLE_EQ(mars::parse_style_length("25.4mm")->length.value, 96);
  EXPECT_DOUBLE_EQ(mars::parse_style_length("72pt")->length.value, 96);
  EXPECT_EQ(mars::parse_style_length("3g")->length, (StyleLength{3, true}));
  EXPECT_FALSE(mars::parse_style_length("3")->has_unit);
  for (const char* text : {"", "px", "-1px", "nan", "1e7px", "1 px", "2em"})
    EXPECT_FALSE(mars::parse_style_length(text)) << text;
}

TEST(FeatureStyle, HasRangesOfScalesAndTextsOfLegends) {
  const FeatureStyle style =
      style_of(layer_of({{"min-scale", 2.5}, {"max-scale", "40"}, {"legend", "Basalt"}}));
  EXPECT_EQ(style.min_scale_m, 2.5);
  EXPECT_EQ(style.max_scale_m, 40);
  EXPECT_EQ(style.legend, "Basalt");
  EXPECT_EQ(style_of(layer_of({{"min-scale", ""}})), FeatureStyle{});
  expect_words(style_error(layer_of({{"min-scale", "-1"}})), {"tracks", "17", "min-scale", "-1", "metres"});
  expect_words(style_error(layer_of({{"max-scale", "far"}})), {"max-scale", "far"});
  expect_words(style_error(layer_of({{"min-scale", 5.0}, {"max-scale", 5.0}})), {"max-scale", "min-scale"});
  expect_words(style_error(layer_of({{"max-scale", "0"}})), {"max-scale"});
}

TEST(FeatureStyle, TakesStyleStringsApart) {
  const auto tools = mars::parse_ogr_style(R"(pen(W: 2px , C:"#000000");label())");
  ASSERT_TRUE(tools);
  ASSERT_EQ(tools->size(), 2U);
  EXPECT_EQ((*tools)[0].name, "PEN");
  EXPECT_EQ((*tools)[0].parameters,
            (std::vector<std::pair<std::string, std::string>>{{"w", "2px"}, {"c", "#000000"}}));
  EXPECT_TRUE((*tools)[1].parameters.empty());
  EXPECT_TRUE(mars::parse_ogr_style("")->empty());
  EXPECT_TRUE(mars::parse_ogr_style("@table")->empty());
  EXPECT_FALSE(mars::parse_ogr_style("PEN(c)"));
  EXPECT_FALSE(mars::parse_ogr_style("(c:1)"));
}

TEST(FeatureStyle, OfKml) {
  const test_support::TempDir folder;
  vector_files::write_text(folder / "s.kml",
                           R"(<?xml version="1.0"?><kml xmlns="http://www.opengis.net/kml/2.2"><Document>
<Style id="s"><LineStyle><color>800088ff</color><width>4</width></LineStyle><PolyStyle><color>ff00ff00</color></PolyStyle>
<IconStyle><color>ff0088ff</color><scale>1.5</scale></IconStyle><LabelStyle><color>ff0088ff</color><scale>2</scale></LabelStyle></Style>
<Placemark><styleUrl>#s</styleUrl><Point><coordinates>1,2</coordinates></Point></Placemark></Document></kml>)");
  const auto layers = vector_files::read(folder / "s.kml");
  const FeatureLayer& layer = layers.at(0);
  const FeatureStyle style = mars::feature_style(layer.features.at(0), layer, {});
  EXPECT_EQ(style.stroke, (StyleColour{kOrange.rgb, 128 / 255.0})) << layer.features[0].style;
  EXPECT_EQ(style.width.value, 4);
  EXPECT_EQ(style.fill, (StyleColour{{0, 255, 0}, 1}));
  EXPECT_EQ(style.marker, kOrange);
  EXPECT_EQ(style.marker_size.value, 12);
  EXPECT_EQ(style.label_colour, kOrange);
}

}  // namespace
