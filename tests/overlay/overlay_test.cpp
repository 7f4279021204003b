// Tests of whole layers: legend, scale bar, arrow, names, compositing, hostile input.
#include "vpe/overlay/overlay.h"
#include "vpe/overlay/visible_terrain.h"

#include <malloc.h>

#include <fstream>

#include "tests/overlay/ball.h"
#include "tests/support/support.h"
#include "vpe/base/nice_ticks.h"
#include "vpe/core/appearance/palette.h"
#include "vpe/overlay/canvas.h"
#include "vpe/overlay/number_format.h"

namespace overlay_test {
namespace {

using vpe::core::Place;
using vpe::core::Rgba;
using vpe::overlay::any;
using vpe::overlay::composite;
using vpe::overlay::needs_range;

Overlays all_of_them() {
  Overlays all;
  all.legend = all.graticule = all.contours = all.scale_bar = all.north_arrow = true;
  all.time_code = vpe::core::TimeCode::kFlight;
  all.compass = vpe::core::CompassStrip::kBottom;
  all.title = "A title";
  all.names = "places";
  all.distances = true;
  return all;
}

// Each of them alone.
std::vector<Overlays> one_by_one() {
  std::vector<Overlays> each(9);
  each[0].legend = each[1].graticule = each[2].contours = each[3].scale_bar = true;
  each[4].north_arrow = true;
  each[5].time_code = vpe::core::TimeCode::kFlight;
  each[6].title = "A title";
  each[7].names = "places";
  each[8].compass = vpe::core::CompassStrip::kTop;
  return each;
}

const Sight& hill() {
  static const Sight sight(Ball{{20, 10}, 8000, 0.03, 1}, view_at({20, 6, 2e5, 0, -40, 0}, 640, 360));
  return sight;
}

Scene hill_scene() {
  static const std::vector<Place> places{{"Top", 20, 10, 0}};
  Scene scene = hill().scene();
  scene.places = places;
  scene.appearance.mode = vpe::core::Mode::kColoured;
  return scene;
}

TEST(Overlay, NothingSetCostsNothing) {
  EXPECT_FALSE(any({}));
  EXPECT_FALSE(needs_range({}));
  // No range image, no size, no surface of Cairo's.
  Scene scene;
  scene.view.width = scene.view.height = 0;
  const Layer layer = vpe::overlay::draw({}, scene);
  EXPECT_EQ(layer.pixels.size(), 0U);
  std::vector<vpe::base::Rgb> image(7, vpe::base::Rgb{1, 2, 3});
  composite(layer, image);
  EXPECT_EQ(image, (std::vector<vpe::base::Rgb>(7, vpe::base::Rgb{1, 2, 3})));
}

TEST(Overlay, OnlyOverlaysOfTheTerrainNeedRanges) {
  const std::vector<bool> needs{false, true, true, true, true, false, false, true, false};
  const std::vector<Overlays> each = one_by_one();
  for (std::size_t n = 0; n < each.size(); ++n) {
    EXPECT_TRUE(any(each[n]));
    EXPECT_EQ(needs_range(each[n]), needs[n]) << n;
    Scene scene = hill_scene();
    scene.range_m = {};
    if (needs[n]) {
      EXPECT_THROW(vpe::overlay::draw(each[n], scene), std::invalid_argument) << n;
    } else {
      EXPECT_GT(painted(vpe::overlay::draw(each[n], scene)), 50U) << n;
    }
  }
}

TEST(Overlay, EachDrawsSomethingTheSameEveryTime) {
  for (const Overlays& one : one_by_one()) {
    const Layer layer = vpe::overlay::draw(one, hill_scene());
    EXPECT_GT(painted(layer), 50U);
    EXPECT_LT(painted(layer), layer.pixels.size() / 3);
    (void)vpe::overlay::draw(all_of_them(), hill_scene());
    EXPECT_EQ(vpe::overlay::draw(one, hill_scene()).pixels, layer.pixels);
  }
}

TEST(Overlay, SyntheticGroundIsTintedBelowTheLines) {
  Scene scene = hill_scene();
  Overlays tint;
  tint.inspect = vpe::core::Inspect::kSynthetic;
  EXPECT_TRUE(any(tint));
  EXPECT_TRUE(needs_range(tint));
  EXPECT_EQ(painted(vpe::overlay::draw(tint, scene)), 0U);  // a scene that does not know
  scene.is_synthetic = [](const glm::dvec3& place) -> std::optional<bool> {
    const double lon_deg = mars::lon_lat(place).lon_deg;
    if (lon_deg > 21) return std::nullopt;
    return lon_deg > 20;
  };
  const vpe::overlay::VisibleTerrain terrain(scene);
  const std::vector<double> lon_deg = terrain.longitudes_deg();
  const Layer alone = vpe::overlay::draw(tint, scene);
  for (std::size_t n = 0; n < lon_deg.size(); ++n) {
    const bool expected = lon_deg[n] > 20 && lon_deg[n] <= 21;
    ASSERT_EQ(alone.pixels[n], expected ? vpe::overlay::kSyntheticTint : (Rgba{0, 0, 0, 0}));
  }
  Overlays both = tint;
  both.graticule = true;
  Overlays lines;
  lines.graticule = true;
  const Layer over = vpe::overlay::draw(both, scene);
  const Layer only = vpe::overlay::draw(lines, scene);
  for (std::size_t n = 0; n < lon_deg.size(); ++n) {
    if (only.pixels[n].a == 255 || alone.pixels[n].a == 0) {
      ASSERT_EQ(over.pixels[n], only.pixels[n]);
    } else {
      ASSERT_GE(over.pixels[n].a, std::max(only.pixels[n].a, alone.pixels[n].a));
    }
  }
}

TEST(Overlay, LayersAreStraightAndCompositeRoundsOnce) {
  const Layer layer = vpe::overlay::draw(all_of_them(), hill_scene());
  std::vector<vpe::base::Rgb> image;
  test_support::Random random(5);
  const auto byte = [&] { return static_cast<std::uint8_t>(random.integer(0, 255)); };
  for (std::size_t n = 0; n < layer.pixels.size(); ++n) image.push_back({byte(), byte(), byte()});
  std::vector<vpe::base::Rgb> composed = image;
  composite(layer, composed);
  for (std::size_t n = 0; n < image.size(); ++n) {
    const Rgba& o = layer.pixels[n];
    if (o.a == 0) {
      ASSERT_EQ(o, (Rgba{0, 0, 0, 0}));
      ASSERT_EQ(composed[n], image[n]);
    }
    const double share = o.a / 255.0;
    ASSERT_NEAR(composed[n].r, share * o.r + (1 - share) * image[n].r, 0.5001);
    ASSERT_NEAR(composed[n].g, share * o.g + (1 - share) * image[n].g, 0.5001);
    ASSERT_NEAR(composed[n].b, share * o.b + (1 - share) * image[n].b, 0.5001);
  }
  image.pop_back();
  EXPECT_THROW(composite(layer, image), std::invalid_argument);
}

TEST(Overlay, DrawsOverImagesOfAnySizeViewAndProjection) {
  Overlays all = all_of_them();
  for (const glm::ivec2 size : {glm::ivec2{1, 1}, {2, 1}, {1, 3}, {16, 9}, {9, 160}, {400, 12}, {200, 300}}) {
    for (const double pitch : {-90.0, 0.0, 90.0}) {
      const Sight sight(hill().ball, view_at({20, 9, 3e4, 10, pitch, 25}, size.x, size.y));
      const Layer layer = sight.draw(all);
      EXPECT_EQ(layer.width, size.x);
      EXPECT_EQ(layer.pixels.size(), static_cast<std::size_t>(size.x * size.y));
    }
  }
  for (const auto projection : {vpe::core::Projection::kCylinder, vpe::core::Projection::kEquirectangular}) {
    View view = view_at({20, 9, 3e4, 10, 0, 0}, 320, 120);
    view.projection = projection;
    Overlays lines;
    lines.graticule = true;
    EXPECT_GT(painted(Sight(hill().ball, view).draw(lines)), 500U);
    EXPECT_GT(painted(Sight(hill().ball, view).draw(all)), 500U);
  }
  // A part is laid out by itself; its lines are those of the whole.
  View part = view_at({20, 9, 3e5, 10, -80, 0}, 400, 300);
  Overlays graticule;
  graticule.graticule = true;
  graticule.graticule_deg = 1;
  const Layer whole = Sight(Ball{}, part).draw(graticule);
  part.part = {150, 100, 120, 100};
  const Layer piece = Sight(Ball{}, part).draw(graticule);
  EXPECT_EQ(piece.width, 120);
  int same = 0;
  for (int y = 30; y < 70; ++y) {
    for (int x = 40; x < 80; ++x)
      same += (at(piece, x, y).a > 100) == (at(whole, x + 150, y + 100).a > 100) ? 1 : 0;
  }
  EXPECT_GT(same, 1500);  // of 1600: lines are a little wider in the larger image
}

TEST(Overlay, HostileTextIsShownOrLeftOut) {
  Overlays overlays;
  Scene scene = hill_scene();
  for (const std::string& title :
       {std::string("\xff\xfe\x80"), std::string("a\xc3"), std::string("\xed\xa0\x80 \xf8\x88 \xc0\xaf"),
        std::string(100000, 'W'), std::string("\x01\x02\x7f"), std::string("N\u00e4he \u5730 \U0001F680")}) {
    overlays.title = title;
    EXPECT_EQ(vpe::overlay::draw(overlays, scene).pixels.size(), 640U * 360U);
  }
  EXPECT_EQ(vpe::overlay::printable_utf8("a\xff"
                                         "b\n\xc3\xbc"),
            "a\xef\xbf\xbd"
            "b \xc3\xbc");
  EXPECT_EQ(vpe::overlay::printable_utf8("\xed\xa0\x80"), "\xef\xbf\xbd\xef\xbf\xbd\xef\xbf\xbd");
  EXPECT_EQ(vpe::overlay::printable_utf8("\xf0\x9f\x9a\x80\xf4\x90\x80\x80").substr(0, 7),
            "\xf0\x9f\x9a\x80\xef\xbf\xbd");
  // Too long for the image: cut within its width.
  overlays.title = std::string(500, 'W');
  const Layer layer = vpe::overlay::draw(overlays, scene);
  for (int y = 0; y < layer.height; ++y) {
    EXPECT_EQ(at(layer, 0, y).a, 0);
    EXPECT_EQ(at(layer, layer.width - 1, y).a, 0);
  }
  EXPECT_GT(painted(layer), 1000U);
}

TEST(Legend, OnlyWhereTheAppearanceShowsValues) {
  using namespace vpe::core;
  Overlays overlays;
  overlays.legend = true;
  const auto shown = [&](Mode mode, Colour colour, bool colourise, bool has_imagery) {
    Scene scene = hill_scene();
    scene.appearance.mode = mode;
    scene.appearance.colour = colour;
    scene.appearance.colourise = colourise;
    scene.has_imagery = has_imagery;
    return painted(vpe::overlay::draw(overlays, scene)) > 0;
  };
  EXPECT_TRUE(shown(Mode::kColoured, Colour::kElevation, false, true));
  EXPECT_TRUE(shown(Mode::kUnlit, Colour::kSlope, false, true));
  EXPECT_TRUE(shown(Mode::kColoured, Colour::kAspect, false, true));
  EXPECT_TRUE(shown(Mode::kTextured, Colour::kElevation, true, true));
  EXPECT_TRUE(shown(Mode::kTextured, Colour::kElevation, false, false));
  EXPECT_FALSE(shown(Mode::kTextured, Colour::kElevation, false, true));
  EXPECT_FALSE(shown(Mode::kLit, Colour::kElevation, false, true));
  EXPECT_FALSE(shown(Mode::kColoured, Colour::kNone, false, true));
  EXPECT_FALSE(shown(Mode::kColoured, Colour::kImage, false, true));
}

TEST(Legend, BarHasTheColoursOfTheScale) {
  Overlays overlays;
  overlays.legend = true;
  Scene scene = hill_scene();
  scene.appearance.palette_low = -500;
  scene.appearance.palette_high = 500;
  const vpe::core::ColourScale scale(scene.appearance);
  const Layer layer = vpe::overlay::draw(overlays, scene);
  const auto is = [&](const Rgba& p, double value) {
    const glm::dvec3 rgb = scale(value);
    return p.a == 255 && std::abs(p.r - rgb.x) < 2 && std::abs(p.g - rgb.y) < 2 && std::abs(p.b - rgb.z) < 2;
  };
  // Some column holds the whole scale, evenly.
  int best = 0;
  for (int x = 0; x < layer.width; ++x) {
    int top = -1;
    int count = 0;
    for (int y = 0; y < layer.height; ++y) {
      if (top < 0 && is(at(layer, x, y), 500 - 5)) top = y;
    }
    for (int row = 0; top >= 0 && row < 95 && top + row < layer.height; ++row) {
      count += is(at(layer, x, top + row), -500 + 1000 * (94.5 - row) / 95) ? 1 : 0;
    }
    best = std::max(best, count);
  }
  EXPECT_EQ(best, 95);
}

// The round numbers within it end nine rows above the lower end.
TEST(Legend, EndsThatAreAskedForAreLabelled) {
  Overlays overlays;
  overlays.legend = true;
  Scene scene = hill_scene();
  scene.appearance.palette_low = -490;
  scene.appearance.palette_high = 490;
  const Layer layer = vpe::overlay::draw(overlays, scene);
  const auto is_white = [&](int x, int y) {
    const Rgba p = at(layer, x, y);
    return p.a == 255 && p.r == 255 && p.g == 255 && p.b == 255;
  };
  // The bar's outline ends with the lowest long run of white.
  int bottom = 0;
  int right = 0;
  for (int y = layer.height / 2; y < layer.height; ++y) {
    for (int x = 0, run = 0; x < layer.width; ++x) {
      run = is_white(x, y) ? run + 1 : 0;
      if (run < 9) continue;
      bottom = y;
      right = x;
    }
  }
  ASSERT_GT(bottom, layer.height - 40);
  int bright = 0;
  for (int y = bottom - 2; y < bottom + 4; ++y) {
    for (int x = right + 6; x < layer.width; ++x) bright += at(layer, x, y).r > 150 ? 1 : 0;
  }
  EXPECT_GT(bright, 10);
}

TEST(ScaleBar, IsARoundLengthAtTheCentre) {
  Overlays overlays;
  overlays.scale_bar = true;
  for (const double alt_m : {300.0, 4e4, 1e6}) {
    const Sight sight({}, view_at({20, 6, alt_m, 0, -90, 0}, 640, 360));
    const Layer layer = sight.draw(overlays);
    // The longest run of opaque pixels in a row is the bar with its outline of 2 * 0.975 px on each side.
    int longest = 0;
    for (int y = 0; y < layer.height; ++y) {
      int run = 0;
      for (int x = 0; x < layer.width; ++x) {
        run = at(layer, x, y).a > 128 ? run + 1 : 0;
        longest = std::max(longest, run);
      }
    }
    const double m_per_px = alt_m / vpe::core::focal_px(sight.view);
    const double length_m = (longest - 3.9) * m_per_px;
    const double round_m = vpe::base::nice_step_below(length_m * 1.05);
    EXPECT_NEAR(length_m, round_m, 1.5 * m_per_px) << alt_m;
    EXPECT_GT(longest, 50);
  }
  EXPECT_EQ(painted(Sight({}, view_at({20, 6, 1e4, 0, 60, 0})).draw(overlays)), 0U);
}

TEST(NorthArrow, TurnsWithTheView) {
  Overlays overlays;
  overlays.north_arrow = true;
  // The red half lies to the east of the arrow: right of it when north is up.
  const auto east = [&](const mars::Pose& pose) {
    const Layer layer = Sight({}, view_at(pose, 640, 360)).draw(overlays);
    glm::dvec2 red{0, 0};
    glm::dvec2 white{0, 0};
    double reds = 0;
    double whites = 0;
    // The disc alone: its middle is 8 + 15 + letter from the corner.
    for (int y = 15; y < 60; ++y) {
      for (int x = layer.width - 60; x < layer.width - 14; ++x) {
        const Rgba p = at(layer, x, y);
        if (p.a > 200 && p.r > 150 && p.g < 80) {
          red += glm::dvec2(x, y);
          ++reds;
        }
        if (p.a > 40 && p.r < 30 && p.a < 120) {
          white += glm::dvec2(x, y);
          ++whites;
        }
      }
    }
    EXPECT_GT(reds, 5);
    EXPECT_GT(whites, 20);
    return glm::normalize(red / reds - white / whites);
  };
  EXPECT_GT(east({20, 6, 1e5, 0, -90, 0}).x, 0.3);
  EXPECT_LT(east({20, 6, 1e5, 90, -90, 0}).y, -0.3);
  EXPECT_LT(east({20, 6, 1e5, 180, -90, 0}).x, -0.3);
  EXPECT_GT(east({20, 6, 1e5, 270, -90, 0}).y, 0.3);
  EXPECT_GT(east({20, 6, 1e5, 0, -40, 0}).x, 0.3);
  // Roll to the right turns the image to the left.
  EXPECT_LT(east({20, 6, 1e5, 0, -60, 90}).y, -0.3);
  EXPECT_EQ(painted(Sight({}, view_at({0, 90, 1e5, 0, -90, 0}, 33, 33)).draw(overlays)), 0U);
}

// Whether the dot of a place is drawn.
bool is_named(const Sight& sight, const Place& place) {
  Overlays overlays;
  overlays.names = "places";
  Scene scene = sight.scene();
  const std::vector<Place> places{place};
  scene.places = places;
  return painted(vpe::overlay::draw(overlays, scene)) > 20;
}

TEST(Names, AreHiddenBehindGroundBeyondTheHorizonAndOutside) {
  // The camera looks north over a cone of 8 km at 10 N.
  const Ball ball{{20, 10}, 8000, 0.01, 1};
  const Sight sight(ball, view_at({20, 9, 5000, 0, -2, 0}, 640, 360));
  EXPECT_TRUE(is_named(sight, {"in front", 20, 9.3, 0}));
  EXPECT_TRUE(is_named(sight, {"the top", 20, 10, 0}));
  EXPECT_FALSE(is_named(sight, {"behind it", 20, 10.6, 0}));
  EXPECT_TRUE(is_named(sight, {"beside it", 20.75, 10.2, 0}));
  EXPECT_FALSE(is_named(sight, {"beyond the horizon", 22, 18, 0}));
  EXPECT_FALSE(is_named(sight, {"behind the camera", 20, 8.5, 0}));
  EXPECT_FALSE(is_named(sight, {"the antipode", -160, -9, 0}));
  EXPECT_FALSE(is_named(sight, {"far to the side", 30, 9.3, 0}));
  EXPECT_FALSE(is_named(sight, {"too small", 20, 9.3, 10}));
  EXPECT_TRUE(is_named(sight, {"large enough", 20, 9.3, 5000}));
  // Without the cone nothing hides it.
  EXPECT_TRUE(is_named(Sight({}, sight.view), {"behind it", 20, 10.6, 0}));
}

// A feature whose centre is hidden has its name at its highest visible point.
TEST(Names, StandWhereTheirFeaturesAreSeen) {
  const Ball ball{{20, 10}, 8000, 0.01, 1};
  const Sight sight(ball, view_at({20, 9, 5000, 0, -2, 0}, 640, 360));
  Overlays overlays;
  overlays.names = "places";
  const auto painted_by = [&](const Place& place, bool with_ground, const Sight& seen) {
    Scene scene = seen.scene();
    if (with_ground) scene.ground_m = [&](const glm::dvec3& up) { return seen.ball.height_m(up); };
    const std::vector<Place> places{place};
    scene.places = places;
    return painted(vpe::overlay::draw(overlays, scene));
  };
  // Behind the cone, 36 km of ground: too small to be seen around it, and large enough to be seen over its foot.
  EXPECT_EQ(painted_by({"behind it", 20, 10.6, 2000}, true, sight), 0U);
  EXPECT_EQ(painted_by({"around it", 20, 10.6, 120000}, false, sight), 0U);
  EXPECT_GT(painted_by({"around it", 20, 10.6, 120000}, true, sight), 20U);
  EXPECT_EQ(painted_by({"the antipode", -160, -9, 120000}, true, sight), 0U);
  EXPECT_EQ(painted_by({"beyond the horizon", 22, 18, 20000}, true, sight), 0U);
  const Sight plain({}, sight.view);
  EXPECT_EQ(painted_by({"beyond the horizon", 20, 18, 600000}, true, plain), 0U);
  EXPECT_GT(painted_by({"reaches over the horizon", 20, 18, 900000}, true, plain), 20U);
}

TEST(Names, EarlierPlacesWinAndNoneOverlap) {
  const Sight sight({}, view_at({20, 6, 2e5, 0, -90, 0}, 640, 360));
  Overlays overlays;
  overlays.names = "places";
  Scene scene = sight.scene();
  const std::vector<Place> one{{"First place", 20, 6, 0}};
  const std::vector<Place> crowd{{"First place", 20, 6, 0}, {"Second place", 20.001, 6.001, 0}};
  scene.places = one;
  const Layer alone = vpe::overlay::draw(overlays, scene);
  scene.places = crowd;
  EXPECT_EQ(vpe::overlay::draw(overlays, scene).pixels, alone.pixels);
}

TEST(Overlay, DrawingALotKeepsNoMemory) {
  const auto used = [] { return ::mallinfo2().uordblks; };
  for (int n = 0; n < 3; ++n) (void)vpe::overlay::draw(all_of_them(), hill_scene());
  const std::size_t before = used();
  for (int n = 0; n < 10; ++n) (void)vpe::overlay::draw(all_of_them(), hill_scene());
  EXPECT_LT(used(), before + 100'000);  // a layer has 920 000 bytes
}

TEST(NumberFormat, IsRoundAndTheSameInEveryLocale) {
  using namespace vpe::overlay;
  using vpe::base::nice_step_above;
  using vpe::base::nice_step_below;
  EXPECT_EQ(nice_step_below(999), 500);
  EXPECT_EQ(nice_step_below(1000), 1000);
  EXPECT_EQ(nice_step_above(1001), 2000);
  EXPECT_EQ(nice_step_above(0.021), 0.05);
  EXPECT_EQ(number_text(-0.0001, 2), "0.00");
  EXPECT_EQ(number_text(-12.345, 1), "\u221212.3");
  EXPECT_EQ(scale_length_text(250, 250), "250 m");
  EXPECT_EQ(scale_length_text(20000, 20000), "20 km");
  EXPECT_EQ(scale_length_text(0.5, 0.5), "0.5 m");
  EXPECT_EQ(longitude_text(-74.5, 0.5), "74.5\u00b0W");
  EXPECT_EQ(longitude_text(180, 30), "180\u00b0");
  EXPECT_EQ(longitude_text(0, 30), "0\u00b0");
  EXPECT_EQ(latitude_text(-13, 1), "13\u00b0S");
  EXPECT_EQ(time_text(3723.459), "T+01:02:03.45");
  EXPECT_EQ(time_text(59.999999999), "T+00:01:00.00");
  EXPECT_EQ(time_text(1e6), "T+277:46:40.00");
  for (int frame = 0; frame < 300; ++frame) {
    char text[32];
    std::snprintf(text, sizeof text, "T+00:00:%02d.%02d", frame / 25, frame % 25 * 4);
    EXPECT_EQ(time_text(frame / 25.0), text);
  }
  for (const double high : {0.37, 45.0, 360.0, 21300.0}) {
    const std::vector<double> values = vpe::base::nice_ticks_two_or_more(-0.4 * high, high, 6);
    EXPECT_GE(values.size(), 3U);
    EXPECT_LE(values.size(), 7U);
  }
  EXPECT_TRUE(vpe::base::nice_ticks_two_or_more(1, 1, 6).empty());
}

}  // namespace
}  // namespace overlay_test
