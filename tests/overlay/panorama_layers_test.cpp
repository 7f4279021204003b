// Vector layers over panoramas, their legend, and the ranges of scales.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "tests/overlay/ball.h"
#include "tests/support/support.h"
#include "vpe/base/parallel.h"
#include "vpe/overlay/features/area_pixels.h"
#include "vpe/overlay/features/area_tree.h"
#include "vpe/overlay/features/layers_legend.h"
#include "vpe/overlay/features/panorama_lines.h"
#include "vpe/overlay/ground_features.h"

namespace overlay_test {
namespace {

using mars::Shape;
using mars::ShapeKind;
using vpe::base::Rgb;
using vpe::base::ThreadPool;
using vpe::overlay::AreaTree;
using vpe::overlay::FeatureScale;
using vpe::overlay::GroundFeatures;
using vpe::overlay::GroundSight;
using vpe::overlay::LayersLegend;
using vpe::overlay::LayerUse;
using vpe::overlay::LegendRow;
using vpe::overlay::PanoramaLines;
using vpe::overlay::SceneLayer;

using Places = std::vector<glm::dvec2>;
using Attributes = std::vector<std::pair<std::string, std::string>>;

std::shared_ptr<const GroundFeatures> drawn_features(std::vector<std::pair<Shape, Attributes>> all,
                                                     const std::string& name = "test") {
  mars::FeatureLayer layer;
  layer.name = name;
  std::vector<Attributes> wanted;
  for (auto& [shape, attributes] : all) {
    mars::Feature feature;
    feature.number = static_cast<std::int64_t>(layer.features.size());
    feature.shapes = {shape};
    layer.features.push_back(feature);
    for (const auto& [field, value] : attributes)
      if (std::ranges::find(layer.fields, field) == layer.fields.end()) layer.fields.push_back(field);
    wanted.push_back(attributes);
  }
  for (std::size_t f = 0; f < layer.features.size(); ++f) {
    for (const std::string& field : layer.fields) {
      const auto found = std::ranges::find(wanted[f], field, &std::pair<std::string, std::string>::first);
      layer.features[f].values.push_back(found == wanted[f].end() ? mars::FieldValue()
                                                                  : mars::FieldValue(found->second));
    }
  }
  return std::make_shared<const GroundFeatures>(std::move(layer), mars::FeatureStyle{});
}

Shape track(Places places) { return {ShapeKind::line, {std::move(places)}}; }
Shape patch(Places ring) {
  ring.push_back(ring.front());
  return {ShapeKind::polygon, {std::move(ring)}};
}
Shape spot(glm::dvec2 place) { return {ShapeKind::point, {{place}}}; }

// A full cylinder on the ball, as a view draws it.
struct Around {
  Ball ball;
  View view;

  Around(const Ball& b, const mars::Pose& pose, int width, int height)
      : ball(b), view(view_at(pose, width, height)) {
    view.projection = vpe::core::Projection::kCylinder;
    view.fov_deg = 2 * std::atan(height * mars::kPi / width) / mars::kRadiansPerDegree;
  }
  glm::dvec3 on_ground(glm::dvec2 place) const {
    const glm::dvec3 up = mars::direction({place.x, place.y});
    return up * (kRadius_m + ball.height_m(up) * ball.exaggeration);
  }
  bool reaches(const glm::dvec3& point_m, double share) const {
    const glm::dvec3 along = point_m - view.camera.position_m;
    return ball.cast(view.camera.position_m, glm::normalize(along)) > (1 - share) * glm::length(along);
  }
};

class AroundSight : public GroundSight {
 public:
  explicit AroundSight(const Around& around)
      : GroundSight({around.view.camera.position_m,
                     kRadius_m,
                     around.ball.exaggeration,
                     {around.view.width, around.view.height},
                     static_cast<double>(around.view.width),
                     {1, vpe::core::focal_px(around.view)}}),
        around_(around) {}
  double height_m(const glm::dvec3& direction) const override { return around_.ball.height_m(direction); }
  std::optional<glm::dvec2> to_image(const glm::dvec3& point_m) const override {
    const auto p = vpe::core::project(around_.view, point_m);
    return p.behind ? std::nullopt : std::optional(p.xy);
  }
  bool is_hidden(glm::dvec2, const glm::dvec3& point_m, double) const override {
    return !around_.reaches(point_m, vpe::overlay::kHiddenLineShare);
  }
  bool may_show(const glm::dvec3&, double) const override { return true; }

 private:
  const Around& around_;
};

struct Whole {
  int width;
  int height;
  std::vector<Rgb> pixels;

  Whole(int w, int h)
      : width(w), height(h), pixels(static_cast<std::size_t>(w) * static_cast<std::size_t>(h)) {}
  bool is_painted(int x, int y) const {
    return pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                  static_cast<std::size_t>((x + width) % width)] != Rgb{};
  }
  bool is_painted_about(glm::dvec2 at) const {
    for (int y = static_cast<int>(std::floor(at.y)) - 1; y <= static_cast<int>(std::floor(at.y)) + 1; ++y) {
      for (int x = static_cast<int>(std::floor(at.x)) - 1; x <= static_cast<int>(std::floor(at.x)) + 1; ++x)
        if (y >= 0 && y < height && is_painted(x, y)) return true;
    }
    return false;
  }
};

// Draws in regions of a size, from right to left if that is wished.
Whole drawn(PanoramaLines& lines, const Around& around, int part_width, int part_height,
            bool backwards = false) {
  Whole whole(around.view.width, around.view.height);
  std::vector<std::pair<int, int>> corners;
  for (int x = 0; x < whole.width; x += part_width)
    for (int y = 0; y < whole.height; y += part_height) corners.emplace_back(x, y);
  if (backwards) std::ranges::reverse(corners);
  for (const auto& [x, y] : corners) {
    const int w = std::min(part_width, whole.width - x);
    const int h = std::min(part_height, whole.height - y);
    std::vector<Rgb> part(static_cast<std::size_t>(w) * static_cast<std::size_t>(h));
    lines.composite({x, y, w, h, part});
    for (int row = 0; row < h; ++row)
      std::copy_n(part.begin() + row * w, w, whole.pixels.begin() + (y + row) * whole.width + x);
  }
  return whole;
}

PanoramaLines::MakeSight sights(const Around& around) {
  return [&around] { return std::make_unique<AroundSight>(around); };
}

Places random_track(test_support::Random& random, glm::dvec2 about, double reach_deg, int count) {
  Places places;
  for (int n = 0; n < count; ++n)
    places.push_back(about +
                     glm::dvec2(random.uniform(-reach_deg, reach_deg), random.uniform(-reach_deg, reach_deg)));
  return places;
}

TEST(PanoramaLines, LieOnTheGroundWithinAPixelInManyViews) {
  test_support::Random random(61);
  ThreadPool pool(2);
  int seen = 0;
  int hidden = 0;
  for (int k = 0; k < 16; ++k) {
    const Ball ball{{random.uniform(-1, 1), random.uniform(-1, 1)}, 8000, 0.03, k % 4 == 0 ? 2.0 : 1.0};
    const mars::Pose pose{random.uniform(-3, 3),
                          random.uniform(-3, 3),
                          random.log_uniform(17e3, 2e5),
                          random.uniform(-180, 180),
                          0,
                          0};
    const Around around(ball, pose, 512, 200);
    const Places places = random_track(random, {pose.lon_deg, pose.lat_deg}, 9, 4);
    const std::vector<SceneLayer> layers{{drawn_features({{track(places), {{"stroke", "#ffffff"}}}}), 1}};
    PanoramaLines lines(layers, sights(around), vpe::core::HiddenLines::kLeftOut, pool, 1 << 20);
    const Whole whole = drawn(lines, around, 512, 200);
    for (std::size_t i = 1; i < places.size(); ++i) {
      for (int n = 0; n <= 400; ++n) {
        const glm::dvec3 point_m = around.on_ground(places[i - 1] + (places[i] - places[i - 1]) * (n / 400.0));
        const auto at = vpe::core::project(around.view, point_m);
        if (at.xy.y < 2 || at.xy.y > 198) continue;
        if (around.reaches(point_m, 1e-5)) {
          ++seen;
          ASSERT_TRUE(whole.is_painted_about(at.xy)) << "view " << k << " at " << at.xy.x << ", " << at.xy.y;
        } else if (!around.reaches(point_m, 0.01)) {
          ++hidden;
        }
      }
    }
  }
  EXPECT_GT(seen, 2000);
  EXPECT_GT(hidden, 200);
}

TEST(PanoramaLines, HiddenPartsAreLeftOutOrDashed) {
  // Behind a cone in the east.
  const Around around({{0, 0}, 8000, 0.02, 1}, {-3, 0, 6000, 90, 0, 0}, 2048, 400);
  ThreadPool pool(1);
  const std::vector<SceneLayer> layers{
      {drawn_features({{track({{0.3, -0.2}, {0.3, 0.2}}), {{"stroke", "#ffffff"}}}}), 1}};
  for (const auto hidden : {vpe::core::HiddenLines::kLeftOut, vpe::core::HiddenLines::kDashed}) {
    PanoramaLines lines(layers, sights(around), hidden, pool, 1 << 20);
    const Whole whole = drawn(lines, around, 2048, 400);
    const auto count = std::ranges::count_if(whole.pixels, [](const Rgb& p) { return p != Rgb{}; });
    EXPECT_EQ(count > 0, hidden == vpe::core::HiddenLines::kDashed);
    EXPECT_EQ(lines.use()[0].lines[0], 0);
  }
}

TEST(PanoramaLines, RegionsThreadsAndMemoryChangeNoByte) {
  test_support::Random random(62);
  const Around around({{1, 1}, 8000, 0.03, 1}, {0, 0, 15e3, 20, 0, 0}, 600, 280);
  std::vector<std::pair<Shape, Attributes>> all;
  for (int n = 0; n < 4; ++n)
    all.push_back({track(random_track(random, {0, 0}, 3, 4)),
                   {{"stroke", "#ff8020"}, {"stroke-width", std::to_string(1 + n % 9)}}});
  for (int n = 0; n < 20; ++n)
    all.push_back({spot({random.uniform(-3, 3), random.uniform(-3, 3)}), {{"title", "x"}}});
  const std::vector<SceneLayer> layers{{drawn_features(all), 0.7}, {drawn_features(all), 1}};
  ThreadPool one(1);
  ThreadPool four(4);
  const auto make = [&](ThreadPool& pool, std::size_t bytes) {
    return PanoramaLines(layers, sights(around), vpe::core::HiddenLines::kDashed, pool, bytes);
  };
  PanoramaLines plain = make(one, std::size_t{1} << 30);
  const Whole whole = drawn(plain, around, 600, 280);
  EXPECT_EQ(plain.passes(), 1);
  EXPECT_EQ(drawn(plain, around, 256, 280).pixels, whole.pixels);
  EXPECT_EQ(drawn(plain, around, 61, 280).pixels, whole.pixels);
  EXPECT_EQ(drawn(plain, around, 333, 101, true).pixels, whole.pixels);
  PanoramaLines threads = make(four, std::size_t{1} << 30);
  EXPECT_EQ(drawn(threads, around, 300, 280).pixels, whole.pixels);
  PanoramaLines narrow = make(four, 2000);
  EXPECT_EQ(drawn(narrow, around, 256, 280).pixels, whole.pixels);
  EXPECT_GT(narrow.passes(), 1);
  EXPECT_EQ(drawn(narrow, around, 512, 280, true).pixels, whole.pixels);
  EXPECT_EQ(narrow.anchors().size(), 2U);
  EXPECT_EQ(narrow.anchors()[0].size(), plain.anchors()[0].size());
  EXPECT_GT(plain.anchors()[0].size(), 2U);
  EXPECT_LE(plain.anchors()[0].size(), all.size());
}

TEST(PanoramaLines, GoOnAcrossTheSeam) {
  // A line around the camera: each column has a part of it, also the first and the last one.
  const Around around({}, {0, 0, 3000, 0, 0, 0}, 700, 300);
  Places ring;
  for (int n = 0; n <= 72; ++n) {
    const double a = n * 5 * mars::kRadiansPerDegree;
    ring.emplace_back(0.2 * std::cos(a), 0.2 * std::sin(a));
  }
  ThreadPool pool(2);
  const std::vector<SceneLayer> layers{
      {drawn_features({{track(ring), {{"stroke", "#ffffff"}, {"stroke-width", "3"}}}}), 1}};
  PanoramaLines lines(layers, sights(around), vpe::core::HiddenLines::kLeftOut, pool, 1 << 20);
  const Whole whole = drawn(lines, around, 256, 300);
  for (int x = 0; x < 700; ++x) {
    int rows = 0;
    for (int y = 0; y < 300; ++y) rows += whole.is_painted(x, y) ? 1 : 0;
    EXPECT_GE(rows, 3) << x;
    EXPECT_LE(rows, 8) << x;
  }
}

TEST(AreaPixels, HaveTheFillOfTheirPlacesInAnyDivision) {
  const Around around({}, {0, 0, 3000, 0, 0, 0}, 360, 160);
  const Shape shape = patch({{-0.3, -0.2}, {0.35, -0.25}, {0.1, 0.3}, {-0.2, 0.15}});
  const std::vector<SceneLayer> layers{
      {drawn_features({{shape, {{"fill", "#ffffff"}, {"fill-opacity", "1"}}}}), 0.5}};
  const mars::AreaIndex index(shape);
  const vpe::overlay::GroundAnswers ground{
      [](const glm::dvec3& p) { return glm::normalize(p); },
      [&](const glm::dvec3& from, const glm::dvec3& ray) { return around.ball.cast(from, ray); }};
  const FeatureScale scale{1, vpe::core::focal_px(around.view)};
  ThreadPool pool(2);
  const std::vector<float> range_m = around.ball.range(around.view);
  std::vector<Rgb> pixels(range_m.size());
  fill_pixels(layers, around.view, scale, ground, pool, {pixels, range_m, 0, 360});
  int inside = 0;
  int edge = 0;
  for (std::size_t n = 0; n < pixels.size(); ++n) {
    const auto x = static_cast<int>(n % 360);
    const auto y = static_cast<int>(n / 360);
    if (!std::isfinite(range_m[n])) {
      EXPECT_EQ(pixels[n], Rgb{});
      continue;
    }
    const auto place = [&](double u, double v) {
      const glm::dvec3 ray = vpe::core::pixel_ray(around.view, x + u, y + v);
      const mars::LonLat at = mars::lon_lat(around.view.camera.position_m +
                                            ray * around.ball.cast(around.view.camera.position_m, ray));
      return glm::dvec2(at.lon_deg, at.lat_deg);
    };
    int corners = 0;
    for (const glm::dvec2& at : {glm::dvec2{0, 0}, glm::dvec2{1, 0}, glm::dvec2{0, 1}, glm::dvec2{1, 1}})
      corners += index.contains(place(at.x, at.y)) ? 1 : 0;
    if (corners == 4) {
      ++inside;
      EXPECT_EQ(pixels[n].g, 128) << x << "," << y;
    }
    if (pixels[n].g > 0 && pixels[n].g < 128) ++edge;
    if (corners == 0 && !index.contains(place(0.5, 0.5))) {
      EXPECT_LT(pixels[n].g, 128);
    }
  }
  EXPECT_GT(inside, 5000);
  EXPECT_GT(edge, 100);
  // In parts, with ranges that are not known.
  std::vector<Rgb> again(pixels.size());
  std::vector<float> none(pixels.size(), std::numeric_limits<float>::quiet_NaN());
  for (int x = 0; x < 360; x += 100) {
    View view = around.view;
    view.part = {x, 0, std::min(100, 360 - x), 160};
    fill_pixels(layers, view, scale, ground, pool, {again, range_m, static_cast<std::size_t>(x), 360});
  }
  EXPECT_EQ(again, pixels);
  again.assign(pixels.size(), Rgb{});
  fill_pixels(layers, around.view, scale, ground, pool, {again, none, 0, 360});
  std::size_t differing = 0;
  for (std::size_t n = 0; n < pixels.size(); ++n) differing += again[n] != pixels[n];
  EXPECT_LT(differing, pixels.size() / 1000);  // ranges are rounded to 32 bits
}

RC_GTEST_PROP(AreaTree, FindsWhatBruteForceFinds, ()) {
  const auto number = [](double low, double high) {
    return low + *rc::gen::inRange(0, 1'000'001) / 1e6 * (high - low);
  };
  std::vector<AreaTree::Extent> extents(static_cast<std::size_t>(*rc::gen::inRange(0, 60)));
  for (auto& extent : extents) {
    extent.low_deg = {number(-540, 540), number(-90, 90)};
    extent.high_deg =
        extent.low_deg + glm::dvec2(*rc::gen::inRange(0, 8) == 0 ? 400.0 : number(0, 90), number(0, 40));
  }
  const AreaTree tree(extents);
  std::vector<std::uint32_t> found{99};
  for (int k = 0; k < 16; ++k) {
    const glm::dvec2 p(number(-720, 720), number(-90, 90));
    const double pad = k % 2 == 0 ? 0 : number(0, 1);
    tree.find(p, pad, found);
    std::vector<std::uint32_t> expected;
    for (std::uint32_t n = 0; n < extents.size(); ++n) {
      const auto& e = extents[n];
      if (p.y + pad < e.low_deg.y || p.y - pad > e.high_deg.y) continue;
      bool is_in = e.high_deg.x - e.low_deg.x >= 360;
      for (int turn = -4; turn <= 4; ++turn) {
        const double x = p.x + 360 * turn;
        is_in = is_in || (x + pad >= e.low_deg.x && x - pad <= e.high_deg.x);
      }
      if (is_in) expected.push_back(n);
    }
    // Places on an edge may be rounded to either side.
    if (found != expected) {
      std::vector<std::uint32_t> wide;
      tree.find(p, pad + 1e-9, wide);
      RC_ASSERT(std::ranges::includes(wide, expected));
      RC_ASSERT(std::ranges::includes(wide, found));
    }
  }
}

struct Shown {
  Sight sight;
  Scene scene;
  explicit Shown(const View& view) : sight({}, view), scene(sight.scene()) {
    scene.ground_m = [this](const glm::dvec3& d) { return sight.ball.height_m(d); };
  }
};

TEST(FeatureScales, AreRangesOfMetresAPixel) {
  Overlays overlays;
  overlays.layers = "a";
  const auto count = [&](double alt_m, const Attributes& attributes, int width = 320, int height = 180) {
    Shown shown(view_at({0, 0, alt_m, 0, -90, 0}, width, height));
    shown.scene.layers = {{drawn_features({{track({{-0.2, 0}, {0.2, 0}}), attributes},
                                           {patch({{-0.2, 0.01}, {0.2, 0.01}, {0, 0.2}}), attributes},
                                           {spot({0, -0.1}), attributes}}),
                           1}};
    return painted(vpe::overlay::draw(overlays, shown.scene));
  };
  // From 100 km: 180 rows are a quarter of 720, so a pixel of these is 160 m wide.
  const double metres = 100e3 * (180 / 720.0) / (90 / std::tan(30 * mars::kRadiansPerDegree));
  const std::string below = std::to_string(0.99 * metres);
  const std::string above = std::to_string(1.02 * metres);
  const Attributes fill{{"fill", "#ffffff"}};
  const auto with = [&](Attributes more) {
    more.insert(more.end(), fill.begin(), fill.end());
    return more;
  };
  const std::size_t all = count(100e3, fill);
  EXPECT_GT(all, 400U);
  EXPECT_EQ(count(100e3, with({{"min-scale", below}, {"max-scale", above}})), all);
  EXPECT_EQ(count(100e3, with({{"max-scale", below}})), 0U);
  EXPECT_EQ(count(100e3, with({{"min-scale", above}})), 0U);
  EXPECT_GT(count(120e3, with({{"min-scale", above}})), 0U);
  // The same at every size of the image.
  EXPECT_EQ(count(100e3, with({{"max-scale", below}}), 640, 360), 0U);
  EXPECT_GT(count(100e3, with({{"min-scale", below}, {"max-scale", above}}), 640, 360), all);
}

TEST(LayersLegend, HasAnEntryForEachStyleInUse) {
  const auto lower =
      drawn_features({{patch({{0, 0}, {1, 0}, {1, 1}}), {{"fill", "#ff0000"}, {"legend", "Lava"}}},
                      {patch({{2, 0}, {3, 0}, {3, 1}}), {{"fill", "#ff0000"}, {"legend", "Lava"}}},
                      {patch({{4, 0}, {5, 0}, {5, 1}}), {{"fill", "#00ff00"}, {"legend", "Dunes"}}},
                      {track({{0, 0}, {1, 1}}), {{"stroke", "#0000ff"}}}},
                     "units");
  const auto upper = drawn_features({{spot({0, 0}), {}}}, "craters");
  const std::vector<SceneLayer> layers{{lower, 0.5}, {upper, 1}};
  std::vector<LayerUse> uses{LayerUse(*lower), LayerUse(*upper)};
  EXPECT_TRUE(legend_rows(layers, uses).empty());
  for (LayerUse& use : uses)
    for (auto* marks : {&use.areas, &use.lines, &use.points}) std::ranges::fill(*marks, std::uint8_t{1});
  uses[0].points.assign(uses[0].points.size(), 0);
  uses[1].areas.assign(1, 0);
  uses[1].lines.assign(1, 0);
  uses[0].areas[lower->style_number(3)] = 0;
  const std::vector<LegendRow> rows = legend_rows(layers, uses);
  ASSERT_EQ(rows.size(), 4U);
  EXPECT_EQ(rows[0].text, "craters");
  EXPECT_EQ(rows[0].kind, LegendRow::Kind::kPoint);
  EXPECT_EQ(rows[1].text, "Lava");
  EXPECT_EQ(rows[1].kind, LegendRow::Kind::kArea);
  EXPECT_EQ(rows[1].opacity, 0.5);
  EXPECT_EQ(rows[2].text, "Dunes");
  EXPECT_EQ(rows[3].text, "units");
  EXPECT_EQ(rows[3].kind, LegendRow::Kind::kLine);
}

std::vector<LegendRow> rows_of(int count) {
  std::vector<LegendRow> rows;
  for (int n = 0; n < count; ++n) {
    LegendRow row;
    row.style.fill = mars::StyleColour{{static_cast<std::uint8_t>(n), 200, 100}, 1};
    row.text = "Unit " + std::to_string(n);
    rows.push_back(row);
  }
  return rows;
}

TEST(LayersLegend, UsesColumnsAndSaysWhatItLeavesOut) {
  const vpe::overlay::Canvas ruler(1, 1);
  const auto plan = [&](int count, double width, double height) {
    return LayersLegend(rows_of(count), ruler, 1).plan(width, height);
  };
  ASSERT_TRUE(plan(5, 700, 400));
  EXPECT_EQ(plan(5, 700, 400)->shown, 5U);
  EXPECT_EQ(plan(5, 700, 400)->lines, 5U);
  const auto wide = plan(40, 700, 400);
  ASSERT_TRUE(wide);
  EXPECT_EQ(wide->shown, 40U);
  EXPECT_LT(wide->lines, 40U);
  EXPECT_GT(wide->size.width, plan(5, 700, 400)->size.width);
  const auto cut = plan(500, 300, 200);
  ASSERT_TRUE(cut);
  EXPECT_LT(cut->shown, 40U);
  EXPECT_LE(cut->size.width, 300);
  EXPECT_LE(cut->size.height, 200);
  EXPECT_FALSE(plan(5, 30, 400));
  EXPECT_FALSE(plan(5, 400, 10));
  EXPECT_FALSE(plan(0, 400, 400));
  // Any text.
  std::vector<LegendRow> odd = rows_of(2);
  odd[0].text = std::string(5000, 'W');
  odd[1].text = "\xff\xfe\n";
  EXPECT_TRUE(LayersLegend(odd, ruler, 1).plan(500, 400));
}

TEST(LayersLegend, StandsInTheImageClearOfOtherOverlays) {
  Overlays overlays;
  overlays.layers = "a";
  overlays.title = "A title that is rather wide for so small an image";
  overlays.scale_bar = true;
  overlays.north_arrow = true;
  Shown shown(view_at({0, 0, 2e5, 0, -90, 0}, 640, 360));
  shown.scene.layers = {
      {drawn_features({{patch({{-0.5, -0.5}, {0.5, -0.5}, {0, 0.5}}),
                        {{"fill", "#ff00ff"}, {"fill-opacity", "1"}, {"legend", "Lava"}}},
                       {patch({{60, 0}, {61, 0}, {61, 1}}),
                        {{"fill", "#00ffff"}, {"fill-opacity", "1"}, {"legend", "Far away"}}}}),
       1}};
  const Layer without = vpe::overlay::draw(overlays, shown.scene);
  overlays.layers_legend = true;
  const Layer with = vpe::overlay::draw(overlays, shown.scene);
  int left = 640, right = 0, top = 360, bottom = 0;
  bool has_far = false;
  for (int y = 0; y < 360; ++y) {
    for (int x = 0; x < 640; ++x) {
      const vpe::core::Rgba p = at(with, x, y);
      has_far = has_far || (p.g > 200 && p.b > 200 && p.r < 60);
      const vpe::core::Rgba q = at(without, x, y);
      if (p.r == q.r && p.g == q.g && p.b == q.b && p.a == q.a) continue;
      left = std::min(left, x);
      right = std::max(right, x);
      top = std::min(top, y);
      bottom = std::max(bottom, y);
      EXPECT_EQ(q.a, 0) << x << "," << y;  // nothing was there
    }
  }
  EXPECT_LT(left, 20);
  EXPECT_LT(right, 300);
  EXPECT_LT(bottom - top, 60);
  EXPECT_FALSE(has_far);
  // Layers are not there: no legend.
  shown.scene.layers.clear();
  overlays.title.clear();
  overlays.scale_bar = overlays.north_arrow = false;
  EXPECT_EQ(painted(vpe::overlay::draw(overlays, shown.scene)), 0U);
}

}  // namespace
}  // namespace overlay_test
