// Tests the panel "Layers": vector files added, ordered, switched, picked in the view and on the map; wrong files.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <glm/geometric.hpp>

#include "mars/sources/layered_image.h"
#include "tests/window/explore_window_fixture.h"
#include "vpe/base/file.h"

namespace vpe::window {
namespace {

namespace fs = std::filesystem;

constexpr const char* kUnits = R"({"type": "FeatureCollection", "features": [
  {"type": "Feature", "properties": {"unit": "mNh", "age": 3.75, "fill": "#ff0000", "fill-opacity": 1, "stroke-opacity": 0},
   "geometry": {"type": "Polygon", "coordinates": [[[15, 5], [25, 5], [25, 15], [15, 15], [15, 5]]]}},
  {"type": "Feature", "properties": {"unit": "eHt", "age": 3.1, "fill": "#0000ff", "fill-opacity": 1, "stroke-opacity": 0},
   "geometry": {"type": "Polygon", "coordinates": [[[20, 9], [24, 9], [24, 12], [20, 12], [20, 9]]]}}]})";
constexpr const char* kWide =
    R"({"type": "Feature", "properties": {"unit": "wide", "fill": "#ff0000", "fill-opacity": 1},
  "geometry": {"type": "Polygon", "coordinates": [[[80, -30], [140, -30], [140, 30], [80, 30], [80, -30]]]}})";
constexpr const char* kLanding = "name,lon,lat\nThe lander,18,8\n";

class LayersPanelTest : public ExploreWindowTest {
 protected:
  void SetUp() override {
    ExploreWindowTest::SetUp();
    base::write_file(units(), std::string_view(kUnits));
    base::write_file(landing(), std::string_view(kLanding));
    base::write_file(folder_ / "broken.geojson", std::string_view("{\"type\": \"Feat"));
  }
  fs::path units() const { return folder_ / "units.geojson"; }
  fs::path landing() const { return folder_ / "landing.csv"; }
  void open_above(const std::string& layers = {}) {
    if (!layers.empty()) {
      ASSERT_EQ(extra_.session.settings.set("overlay.layers", layers), "");
    }
    open(960, 1200);
    window_->session().put({20, 10, 2'000'000, 0, -90, 0});
    click("Layers");
    settle();
  }
  void press_beside(const std::string& label) {
    click(label);
    settle();
  }
  std::string setting() { return window_->session().settings().get("overlay.layers").value_or(""); }
  std::string picked_unit() {
    const ShownFeature& shown = window_->layers().picked().at(window_->layers().picked_index());
    const mars::FeatureLayer& layer = shown.layer->layer();
    for (const auto& [name, text] : explore::field_texts(layer, layer.features[shown.feature]))
      if (name == "unit" || name == "name") return text;
    return {};
  }
  bool is_red(mars::LonLat place) {
    const glm::dvec3 colour = colour_at(seen(place));
    return colour.r > 180 && colour.g < 60 && colour.b < 60;
  }
  bool is_blue(mars::LonLat place) {
    const glm::dvec3 colour = colour_at(seen(place));
    return colour.b > 180 && colour.r < 60 && colour.g < 60;
  }
};

TEST_F(LayersPanelTest, FilesAreAddedOrderedSwitchedAndRemoved) {
  open_above();
  EXPECT_FALSE(is_red({17, 13}));
  enter("##layer file", units().string());
  EXPECT_EQ(setting(), units().string()) << window_->state().message;
  EXPECT_TRUE(is_red({17, 13}));
  EXPECT_TRUE(is_blue({22, 10}));
  EXPECT_EQ(window_->layers().loader().find(units().string())->features, 2U);
  enter("##layer file", landing().string());
  const std::string both = units().string() + ";" + landing().string();
  EXPECT_EQ(setting(), both);
  press_beside("layer units.geojson/\u2191");
  EXPECT_EQ(setting(), landing().string() + ";" + units().string());
  press_beside("layer landing.csv/\u2191");
  EXPECT_EQ(setting(), both);
  // A layer that is off is remembered by the panel, not by the setting.
  press_beside("layer units.geojson/##on");
  EXPECT_EQ(setting(), landing().string());
  EXPECT_EQ(window_->layers().files_shown().size(), 2U);
  EXPECT_FALSE(is_red({17, 13}));
  press_beside("layer units.geojson/##on");
  EXPECT_EQ(setting(), both);
  EXPECT_TRUE(is_red({17, 13}));
  // Opacity.
  const WidgetPlace slider = place_of("layer units.geojson/##opacity");
  drag({slider.x1 - 5, (slider.y0 + slider.y1) / 2}, {-0.5 * (slider.x1 - slider.x0), 0});
  settle();
  EXPECT_LT(window_->layers().files_shown()[0].item.opacity, 0.8);
  EXPECT_GT(window_->layers().files_shown()[0].item.opacity, 0.2);
  EXPECT_NE(setting().find("units.geojson@0."), std::string::npos);
  EXPECT_FALSE(is_red({17, 13}));
  press_beside("Hidden parts dashed");
  EXPECT_EQ(window_->session().settings().get("overlay.layers.hidden"), "dashed");
  press_beside("Legend##layers");
  EXPECT_EQ(window_->session().settings().get("overlay.layers.legend"), "on");
  press_beside("layer units.geojson/x");
  EXPECT_EQ(setting(), landing().string());
  EXPECT_EQ(window_->layers().loader().find(units().string()), nullptr);
}

TEST_F(LayersPanelTest, ABrokenFileIsToldInItsRowAndHurtsNoOther) {
  open_above(units().string());
  EXPECT_TRUE(is_red({17, 13}));
  enter("##layer file", (folder_ / "broken.geojson").string());
  const LoadedFile* broken = window_->layers().loader().find((folder_ / "broken.geojson").string());
  ASSERT_NE(broken, nullptr);
  EXPECT_EQ(broken->state, LoadedFile::State::kFailed);
  EXPECT_NE(broken->error.find("broken.geojson"), std::string::npos) << broken->error;
  EXPECT_EQ(window_->state().image_error, "");
  EXPECT_TRUE(is_red({17, 13}));
  EXPECT_EQ(window_->layers().readable_setting(), units().string());
  // It is read anew once it is mended.
  base::write_file(folder_ / "broken.geojson", std::string_view(kUnits));
  press_beside("layer broken.geojson/\u21ba");
  EXPECT_EQ(broken->state, LoadedFile::State::kRead);
  enter("##layer file", (folder_ / "none.gpkg").string());
  EXPECT_TRUE(window_->state().message_is_error);
  EXPECT_NE(window_->state().message.find("none.gpkg"), std::string::npos) << window_->state().message;
  EXPECT_EQ(window_->layers().files_shown().size(), 2U);
}

TEST_F(LayersPanelTest, AClickShowsAttributesAndNextThoseBelow) {
  open_above(units().string() + ";" + landing().string());
  const glm::dvec2 overlap = seen({22, 10});
  click(overlap.x, overlap.y);
  settle();
  ASSERT_EQ(window_->layers().picked().size(), 2U);
  EXPECT_EQ(picked_unit(), "eHt");
  press_beside("Next##picked");
  EXPECT_EQ(picked_unit(), "mNh");
  press_beside("Next##picked");
  EXPECT_EQ(picked_unit(), "eHt");
  const glm::dvec2 lander = seen({18, 8});
  click(lander.x + 3, lander.y - 2);
  settle();
  ASSERT_EQ(window_->layers().picked().size(), 2U);
  EXPECT_EQ(picked_unit(), "The lander");
  // Away from all, and by a drag: nothing.
  const glm::dvec2 off = seen({28, 2});
  click(off.x, off.y);
  EXPECT_TRUE(window_->layers().picked().empty());
  drag(overlap, {40, 0});
  settle();
  EXPECT_TRUE(window_->layers().picked().empty());
  // In the middle by a button.
  window_->session().put({22, 10, 2'000'000, 0, -90, 0});
  settle();
  press_beside("Middle##pick");
  EXPECT_EQ(picked_unit(), "eHt");
  press_beside("Clear##picked");
  EXPECT_TRUE(window_->layers().picked().empty());
}

TEST_F(LayersPanelTest, TheMapShowsLayersAndAClickThereFindsThem) {
  base::write_file(folder_ / "wide.geojson", std::string_view(kWide));
  open_above((folder_ / "wide.geojson").string());
  const WidgetPlace map = place_of("map");
  const auto on_map = [&](mars::LonLat place) {
    const double per_deg = (map.x1 - map.x0) / 360;
    return glm::dvec2((map.x0 + map.x1) / 2 + place.lon_deg * per_deg,
                      (map.y0 + map.y1) / 2 - place.lat_deg * per_deg);
  };
  core::RgbImage shown;
  window_->capture(&shown);
  move(on_map({60, -60}).x, on_map({60, -60}).y);
  ASSERT_FALSE(shown.pixels.empty());
  const auto is_red_at = [&](mars::LonLat place) {
    const glm::dvec2 at = on_map(place);
    const base::Rgb pixel =
        shown.pixels[static_cast<std::size_t>(at.y) * static_cast<std::size_t>(shown.width) +
                     static_cast<std::size_t>(at.x)];
    return pixel.r > 240 && pixel.g < 20;
  };
  EXPECT_TRUE(is_red_at({110, 10}));
  EXPECT_TRUE(is_red_at({135, -25}));
  EXPECT_FALSE(is_red_at({150, 0}));
  const mars::Pose before = window_->session().pose();
  click(on_map({110, 10}).x, on_map({110, 10}).y);
  settle();
  ASSERT_EQ(window_->layers().picked().size(), 1U);
  EXPECT_EQ(picked_unit(), "wide");
  EXPECT_EQ(window_->session().pose().lon_deg, before.lon_deg) << "the camera stays";
  click(on_map({60, 0}).x, on_map({60, 0}).y);
  settle();
  EXPECT_NEAR(window_->session().pose().lon_deg, 60, 3) << "where there is no feature the camera flies";
}

TEST_F(LayersPanelTest, APlanetWithoutImageLayersSaysSo) {
  open_above();
  EXPECT_TRUE(window_->layers().images_shown().empty());
  EXPECT_EQ(window_->session().settings().get("image.layers"), "");
}

// An image of one colour within a cap.
class PlainImage : public mars::ImageSource {
 public:
  PlainImage(std::string name, base::Rgb colour, double reach_rad)
      : name_(std::move(name)), colour_(colour), reach_rad_(reach_rad) {}
  std::vector<mars::SourceInfo> infos() const override {
    mars::SourceInfo info;
    info.name = name_;
    info.resolution_m = spacing_m();
    return {info};
  }
  void sample(std::span<const glm::dvec3> directions, double, std::span<base::Rgb> colours,
              std::span<std::uint8_t> alpha) const override {
    for (std::size_t n = 0; n < directions.size(); ++n) {
      colours[n] = colour_;
      alpha[n] = mars::angle_between_rad(directions[n], mars::direction({20, 10})) <= reach_rad_ ? 255 : 0;
    }
  }
  double spacing_in(const mars::Cap&) const override { return spacing_m(); }

 private:
  double spacing_m() const { return reach_rad_ > 1 ? 80'000 : 40'000; }

  std::string name_;
  base::Rgb colour_;
  double reach_rad_;
};

TEST_F(LayersPanelTest, ImageLayersAreSwitchedAndMoved) {
  const auto both = mars::stack_images_apart(
      {{"wide", std::make_shared<PlainImage>("wide.tif", base::Rgb{220, 20, 20}, 4.0)},
       {"inset", std::make_shared<PlainImage>("inset.tif", base::Rgb{20, 20, 220}, 0.3)}});
  paging::BuildOptions options;
  options.output = (folder_ / "layers.vpe").string();
  options.base_spacing_m = 400'000;
  options.tile_k = 4;
  options.resampling_posts = 1000;
  paging::build_planet(options, test_support::FakeElevation(test_support::bumpy_height), both.get());
  planet_ = paging::PlanetFile::open(options.output);
  ASSERT_EQ(extra_.session.settings.set("mode", "textured"), "");
  ASSERT_EQ(extra_.session.settings.set("light", "off"), "");
  open_above();
  const auto setting = [&] { return window_->session().settings().get("image.layers").value_or("?"); };
  EXPECT_EQ(setting(), "");
  EXPECT_TRUE(is_blue({20, 10}));
  press_beside("As the planet was built");
  EXPECT_EQ(setting(), "wide;inset");
  EXPECT_TRUE(is_blue({20, 10}));
  press_beside("image inset/inset##on");
  EXPECT_EQ(setting(), "wide");
  EXPECT_TRUE(is_red({20, 10}));
  press_beside("image inset/inset##on");
  EXPECT_TRUE(is_blue({20, 10}));
  press_beside("image inset/\u2193");
  EXPECT_EQ(setting(), "inset;wide");
  EXPECT_TRUE(is_red({20, 10}));
  press_beside("As the planet was built");
  EXPECT_EQ(setting(), "");
  EXPECT_TRUE(is_blue({20, 10}));
}

}  // namespace
}  // namespace vpe::window
