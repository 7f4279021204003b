// Tests vector layers on the map: coverage against closed forms and sampling, layers against the exact places.
#include "vpe/explore/measure/map_layers.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <tuple>

#include "mars/vector/area_index.h"
#include "vpe/explore/measure/map_coverage.h"

namespace vpe::explore {
namespace {

using mars::FeatureLayer;
using mars::FeatureStyle;
using mars::Shape;
using mars::ShapeKind;

constexpr base::Rgb kBlack{0, 0, 0};
constexpr base::Rgb kRed{255, 0, 0};
constexpr base::Rgb kGreen{0, 255, 0};

core::RgbImage black(const MapView& map) {
  core::RgbImage image;
  image.width = map.width;
  image.height = map.height;
  image.pixels.assign(static_cast<std::size_t>(map.width) * static_cast<std::size_t>(map.height), kBlack);
  return image;
}
base::Rgb at(const core::RgbImage& image, int x, int y) {
  return image.pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                      static_cast<std::size_t>(x)];
}
MapLayer layer_of(std::vector<Shape> shapes, FeatureStyle style, double opacity = 1) {
  auto layer = std::make_shared<FeatureLayer>();
  for (Shape& shape : shapes) layer->features.emplace_back().shapes.push_back(std::move(shape));
  return {
      layer,
      [style = std::make_shared<FeatureStyle>(style)](std::uint32_t) -> const FeatureStyle& { return *style; },
      opacity};
}
FeatureStyle filled(base::Rgb colour) {
  FeatureStyle style;
  style.stroke.reset();
  style.fill = mars::StyleColour{colour, 1};
  return style;
}

double sum_of(const MapCoverage& coverage, int width, int height) {
  double sum = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) sum += coverage.at(x, y);
  return sum;
}

TEST(MapCoverage, AreasHaveTheirArea) {
  MapCoverage coverage(60, 50);
  const std::vector<std::vector<glm::dvec2>> rings{{{10.3, 8}, {40.1, 8}, {40.1, 33}, {10.3, 33}, {10.3, 8}},
                                                   {{20, 10}, {30, 10}, {30, 20}, {20, 20}, {20, 10}}};
  coverage.add_area(rings);
  EXPECT_NEAR(sum_of(coverage, 60, 50), 29.8 * 25 - 100, 1e-3);
  EXPECT_NEAR(coverage.at(10, 9), 0.7, 1e-6);
  EXPECT_EQ(coverage.at(25, 15), 0);
  EXPECT_EQ(coverage.at(9, 9), 0);
  // Parts that touch leave no gap, and what is outside of the image does not matter.
  MapCoverage halves(60, 50);
  halves.add_area(std::vector<std::vector<glm::dvec2>>{{{-9, -9}, {31.4, -9}, {31.4, 70}, {-9, 70}, {-9, -9}}});
  halves.add_area(
      std::vector<std::vector<glm::dvec2>>{{{31.4, -9}, {90, -9}, {90, 70}, {31.4, 70}, {31.4, -9}}});
  EXPECT_NEAR(sum_of(halves, 60, 50), 60 * 50, 1e-2);
  EXPECT_NEAR(halves.at(31, 20), 1, 1e-6);
}

TEST(MapCoverage, LinesAndDiscsHaveTheirWidth) {
  for (const double angle : {0.0, 0.4, 0.785, 1.3, 1.571}) {
    MapCoverage coverage(100, 100);
    const glm::dvec2 along(std::cos(angle), std::sin(angle));
    coverage.add_line(glm::dvec2(50, 50) - 30.0 * along, glm::dvec2(50, 50) + 30.0 * along, 4);
    EXPECT_NEAR(sum_of(coverage, 100, 100), 60 * 4 + mars::kPi * 4, 6) << angle;
  }
  MapCoverage disc(40, 40);
  disc.add_disc({20.2, 19.7}, 8);
  EXPECT_NEAR(sum_of(disc, 40, 40), mars::kPi * 64, 2);
  MapCoverage twice(40, 40);
  twice.add_disc({20.2, 19.7}, 8);
  twice.add_disc({20.2, 19.7}, 8);
  core::RgbImage image = black({{0, 0}, 1, 40, 40});
  twice.paint(kRed, 0.5, image);
  EXPECT_EQ(at(image, 20, 20).r, 128) << "what overlaps is painted once";
  twice.paint(kGreen, 1, image);
  EXPECT_EQ(at(image, 20, 20).g, 0) << "and forgotten";
}

TEST(MapLayers, AreasAreWhereTheirPlacesAre) {
  // A polygon with a hole across the antimeridian, and a cap around the south pole.
  Shape ring{
      ShapeKind::polygon,
      {{{160, -20}, {215, -5}, {200, 40}, {165, 30}, {160, -20}}, {{180, 0}, {190, 0}, {185, 20}, {180, 0}}}};
  Shape cap{ShapeKind::polygon, {{{0, -70}, {-120, -60}, {-240, -75}, {-360, -70}}}};
  for (const Shape& shape : {ring, cap}) {
    const mars::AreaIndex index(shape);
    for (const MapView& map : {whole_map(360, 180), MapView{{178, 5}, 0.5, 200, 150},
                               MapView{{-100, -60}, 1, 250, 90}, whole_map(500, 180)}) {
      core::RgbImage image = black(map);
      const std::vector<MapLayer> layers{layer_of({shape}, filled(kRed))};
      paint_map_layers(map, layers, 3e6, image);
      for (int y = 0; y < map.height; ++y) {
        for (int x = 0; x < map.width; ++x) {
          int inside = 0;
          for (const double dx : {-1.0, 0.5, 2.0}) {
            for (const double dy : {-1.0, 0.5, 2.0}) {
              const auto place = map.place({x + dx, y + dy});
              inside += place && index.contains({place->lon_deg, place->lat_deg}) ? 1 : 0;
            }
          }
          const auto place = map.place({x + 0.5, y + 0.5});
          if (!place) continue;
          if (inside == 9) {
            ASSERT_GT(at(image, x, y).r, 200) << x << ", " << y;
          }
          if (inside == 0) {
            ASSERT_LT(at(image, x, y).r, 55) << x << ", " << y;
          }
        }
      }
    }
  }
}

TEST(MapLayers, OrderOpacityAndKinds) {
  const MapView map{{0, 0}, 0.1, 100, 100};
  const Shape box{ShapeKind::polygon, {{{-3, -3}, {3, -3}, {3, 3}, {-3, 3}, {-3, -3}}}};
  FeatureStyle outlined = filled(kGreen);
  outlined.stroke = mars::StyleColour{kRed, 1};
  outlined.width = {4, false};
  core::RgbImage image = black(map);
  const std::vector<MapLayer> one{layer_of({box}, outlined)};
  paint_map_layers(map, one, 3e6, image);
  EXPECT_EQ(at(image, 50, 50), kGreen);
  EXPECT_EQ(at(image, 20, 50), kRed);
  EXPECT_EQ(at(image, 10, 50), kBlack);
  image = black(map);
  const std::vector<MapLayer> two{layer_of({box}, filled(kRed)), layer_of({box}, filled(kGreen), 0.25)};
  paint_map_layers(map, two, 3e6, image);
  EXPECT_EQ(at(image, 50, 50), (base::Rgb{191, 64, 0}));
  // A pixel covers 5236 m.
  for (const auto& [least_m, most_m, is_shown] :
       {std::tuple{5000.0, 6000.0, true}, {5300.0, 1e9, false}, {0.0, 5200.0, false}}) {
    FeatureStyle ranged = filled(kRed);
    ranged.min_scale_m = least_m;
    ranged.max_scale_m = most_m;
    image = black(map);
    const std::vector<MapLayer> layers{layer_of({box}, ranged)};
    paint_map_layers(map, layers, 3e6, image);
    EXPECT_EQ(at(image, 50, 50), is_shown ? kRed : kBlack) << least_m;
  }
  // Points have a size in pixels or metres.
  FeatureStyle marked;
  marked.marker = mars::StyleColour{kRed, 1};
  marked.marker_size = {20 * 0.1 * mars::kRadiansPerDegree * 3e6, true};
  image = black(map);
  const std::vector<MapLayer> points{layer_of({{ShapeKind::point, {{{360, 0}}}}}, marked)};
  paint_map_layers(map, points, 3e6, image);
  EXPECT_EQ(at(image, 50, 50), kRed);
  EXPECT_EQ(at(image, 58, 50), kRed);
  EXPECT_EQ(at(image, 62, 50), kBlack);
}

RC_GTEST_PROP(MapLayers, LinesAreWhereTheirPlacesAre, ()) {
  const auto number = [](int low, int high) { return *rc::gen::inRange(low, high) / 100.0; };
  MapView map = whole_map(300, 150);
  map = zoomed(map, {number(0, 30000), number(0, 15000)}, number(100, 2000));
  std::vector<glm::dvec2> places;
  for (int n = 0; n < 5; ++n)
    places.emplace_back(map.middle.lon_deg + number(-9000, 9000),
                        std::clamp(map.middle.lat_deg + number(-4000, 4000), -90.0, 90.0));
  FeatureStyle style;
  style.stroke = mars::StyleColour{kRed, 1};
  style.width = {3, false};
  core::RgbImage image = black(map);
  const std::vector<MapLayer> layers{layer_of({{ShapeKind::line, {places}}}, style)};
  paint_map_layers(map, layers, 3e6, image);
  for (std::size_t n = 1; n < places.size(); ++n) {
    for (int k = 0; k <= 100; ++k) {
      const glm::dvec2 place = places[n - 1] + (places[n] - places[n - 1]) * (k / 100.0);
      const glm::dvec2 xy = map.position({place.x, place.y});
      if (xy.x < 1 || xy.y < 1 || xy.x >= map.width - 1 || xy.y >= map.height - 1) continue;
      RC_ASSERT(at(image, static_cast<int>(xy.x), static_cast<int>(xy.y)).r > 200);
    }
  }
}

}  // namespace
}  // namespace vpe::explore
