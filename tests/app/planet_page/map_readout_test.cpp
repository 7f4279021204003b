// The maps of the poles and the read-out of a planet's page.
#include "vpe/app/planet/info/map_readout.h"

#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "tests/app/support/process.h"
#include "tests/paging/planet_fixture.h"
#include "vpe/app/planet/info/polar_map.h"
#include "vpe/app/planet/info/relief_map.h"
#include "vpe/base/file.h"
#include "vpe/core/image/image.h"

namespace vpe::app {
namespace {

using test_support::FakeElevation;

TEST(PolarMap, PointsAndPlacesAreInverse) {
  for (const Pole pole : {Pole::kNorth, Pole::kSouth}) {
    const double sign = pole == Pole::kNorth ? 1 : -1;
    for (double lat = 55.5; lat < 90; lat += 4.3) {
      for (double lon = -170; lon < 180; lon += 23) {
        const glm::dvec2 at = polar_point(pole, {lon, sign * lat});
        const auto back = polar_place(pole, at.x, at.y);
        ASSERT_TRUE(back);
        EXPECT_NEAR(back->place.lon_deg, lon, 1e-9);
        EXPECT_NEAR(back->place.lat_deg, sign * lat, 1e-9);
      }
    }
    EXPECT_EQ(polar_place(pole, 0, 0)->place.lat_deg, sign * 90);
    EXPECT_NEAR(polar_place(pole, 1, 0)->place.lat_deg, sign * kPolarLat_deg, 1e-9);
    EXPECT_NEAR(polar_place(pole, 1, 0)->place.lon_deg, 90, 1e-9);
    EXPECT_FALSE(polar_place(pole, 0.8, 0.7));
  }
  // Longitude 0 is below the north pole and above the south pole.
  EXPECT_NEAR(polar_point(Pole::kNorth, {0, 60}).y, 0.8498, 1e-3);
  EXPECT_NEAR(polar_point(Pole::kSouth, {0, -60}).y, -0.8498, 1e-3);
}

// A step to where the light comes from goes up and left by as much.
TEST(PolarMap, LightComesFromTheUpperLeft) {
  for (const Pole pole : {Pole::kNorth, Pole::kSouth}) {
    for (const glm::dvec2 from : {glm::dvec2(0.5, 0.1), glm::dvec2(-0.3, 0.6), glm::dvec2(-0.2, -0.4)}) {
      const auto at = polar_place(pole, from.x, from.y);
      const mars::LonLat there = mars::destination(at->place, at->light_azimuth_deg, 1e-6);
      const glm::dvec2 step = polar_point(pole, there) - from;
      EXPECT_LT(step.x, 0);
      EXPECT_NEAR(step.x, step.y, 1e-4 * std::abs(step.x));
    }
  }
}

TEST(ReliefImages, PolesHaveTheGroundOfThePoles) {
  const test_support::TempDir dir;
  // A cap of 10 degrees is high in the north, and low in the south.
  const auto planet = test_support::build_fake(dir / "caps.vpe", FakeElevation([](const glm::dvec3& d) {
                                                 const double cap = std::cos(10 * mars::kRadiansPerDegree);
                                                 return d.z > cap ? 2000.0 : d.z < -cap ? -2000.0 : 0.0;
                                               }),
                                               60000);
  base::ThreadPool one(1);
  base::ThreadPool three(3);
  const ReliefLook look{-2000, 2000, 1};
  const ReliefImages images = relief_images(planet, look, {}, 1 << 24, three);
  EXPECT_EQ(images.north, relief_images(planet, look, {}, 1 << 24, one).north);
  const auto colour = [&](const std::vector<std::uint8_t>& png, const glm::dvec2& at) {
    base::write_file(dir / "a.png", std::string(png.begin(), png.end()));
    const core::RgbImage image = core::read_image(dir / "a.png");
    EXPECT_EQ(image.width, image.height);
    const auto pixel = [&](double x) { return static_cast<std::size_t>((0.5 + 0.5 * x) * image.width); };
    return image.pixels[pixel(at.y) * static_cast<std::size_t>(image.width) + pixel(at.x)];
  };
  const base::Rgb plain = colour(images.north, polar_point(Pole::kNorth, {120, 65}));
  const base::Rgb high = colour(images.north, polar_point(Pole::kNorth, {120, 85}));
  const base::Rgb low = colour(images.south, polar_point(Pole::kSouth, {120, -85}));
  EXPECT_NE(plain, high);
  EXPECT_NE(plain, low);
  EXPECT_NE(high, low);
  EXPECT_EQ(colour(images.north, {0.95, 0.95}), (base::Rgb{255, 255, 255}));
  // Limits are kept.
  const ReliefImages small = relief_images(planet, look, {4000, 2000}, 1 << 24, one);
  EXPECT_LE(small.whole.size(), 4000U);
  EXPECT_LE(small.south.size(), 2000U);
}

TEST(ElevationGrid, HasTheSurface) {
  const test_support::TempDir dir;
  const auto planet =
      test_support::build_fake(dir / "a.vpe", FakeElevation([](const glm::dvec3& d) {
                                 return d.z > 0.9 ? std::nan("") : 3000 * d.x + 1000 * d.y * d.z;
                               }),
                               20000);
  base::ThreadPool pool(2);
  const ElevationGrid grid = elevation_grid(planet, 1 << 24, pool);
  EXPECT_EQ(grid.width, 240);
  EXPECT_EQ(grid.height, 120);
  // Between posts 20 km apart the surface is flat, up to 15 m lower.
  ASSERT_EQ(grid.values.size(), 240U * 120U);
  for (int y = 0; y < grid.height; y += 7) {
    for (int x = 0; x < grid.width; x += 11) {
      const mars::LonLat place{-180 + 1.5 * (x + 0.5), 90 - 1.5 * (y + 0.5)};
      const glm::dvec3 d = mars::direction(place);
      const std::uint16_t value = grid.values[static_cast<std::size_t>(y * grid.width + x)];
      if (d.z > 0.93) {
        EXPECT_EQ(value, kReadoutNodata);
      }
      if (d.z < 0.87) {
        EXPECT_NEAR(grid.low_m + grid.step_m * value, 3000 * d.x + 1000 * d.y * d.z, 20);
      }
    }
  }
  base::ThreadPool one(1);
  EXPECT_EQ(elevation_grid(planet, 1 << 24, one).values, grid.values);
}

// XML reserves these.
TEST(Readout, ScriptAndStyleFitIntoAPage) {
  for (const std::string& text : {readout_script(), readout_style()}) {
    EXPECT_EQ(text.find_first_of("<&"), std::string::npos);
    EXPECT_EQ(text.find("://"), std::string::npos);
  }
  EXPECT_NE(readout_markup({2, 1, -5, 0.5, {1, kReadoutNodata}}).find("data-values=\"base64,AQD//w==\""),
            std::string::npos);
}

// The script in a page that has just what it uses, run by node: text that it shows for a pointer at shares of a map's sides.
TEST(Readout, TellsPlaceAndElevation) {
  const std::filesystem::path node = app_test::find_program("node");
  if (node.empty()) GTEST_SKIP() << "needs the program node";
  const test_support::TempDir dir;
  const auto planet = test_support::build_fake(
      dir / "a.vpe", FakeElevation([](const glm::dvec3& d) { return d.z < -0.9 ? std::nan("") : 2000 * d.z; }),
      60000);
  base::ThreadPool pool(2);
  const std::string markup = readout_markup(elevation_grid(planet, 1 << 24, pool));
  std::string data = "{";
  for (const char* key : {"width", "height", "low", "step", "pole", "values"}) {
    const std::string name = std::string("data-") + key + "=\"";
    const std::size_t begin = markup.find(name) + name.size();
    data += std::string(key) + ": '" + markup.substr(begin, markup.find('"', begin) - begin) + "', ";
  }
  const std::string page =
      "const heard = {}; const lines = [];\n"
      "function map(kind) { return { dataset: { map: kind }, appendChild(l) { lines.push(l); },\n"
      "  addEventListener(n, f) { heard[kind + n] = f; },\n"
      "  getBoundingClientRect() { return { left: 10, top: 20, width: 200, height: 100 }; } }; }\n"
      "globalThis.document = { getElementById() { return { dataset: " +
      data +
      "} }; },\n"
      "  createElement() { return {}; },\n"
      "  querySelectorAll() { return ['plain', 'north', 'south'].map(map); } };\n" +
      readout_script() +
      "function at(kind, x, y) { heard[kind + 'pointermove']({ clientX: 10 + 200 * x, clientY: 20 + "
      "100 * y });\n"
      "  const l = lines[['plain', 'north', 'south'].indexOf(kind)];\n"
      "  console.log(l.hidden ? 'hidden' : l.textContent); }\n"
      "at('plain', 0.75, 1 / 3); at('plain', 0.25, 0.5); at('plain', 0.5, 0.99); at('north', 0.5, 0.5);\n"
      "at('north', 1, 0.5); at('north', 0.99, 0.99); at('south', 0.5, 0);\n"
      "heard['plainpointerleave'](); console.log(lines[0].hidden);\n";
  app_test::Command command;
  command.program = node;
  command.arguments = {"-"};
  command.folder = dir.path();
  command.input = page;
  const app_test::Result result = app_test::run(command);
  ASSERT_EQ(result.exit_code, 0) << result.err;
  std::istringstream lines(result.out);
  std::vector<std::string> told;
  for (std::string line; std::getline(lines, line);) told.push_back(line);
  ASSERT_EQ(told.size(), 8U) << result.out;
  const auto elevation = [](const std::string& text) {
    return std::stod(text.substr(text.find("about ") + 6));
  };
  EXPECT_TRUE(told[0].starts_with("90.0\u00b0 E, 30.0\u00b0 N, about ")) << told[0];
  // Flat triangles between posts 60 km apart are up to 140 m lower.
  EXPECT_NEAR(elevation(told[0]), 1000, 150);
  EXPECT_TRUE(told[1].starts_with("90.0\u00b0 W, 0.0\u00b0 N, about ")) << told[1];
  EXPECT_EQ(told[2], "0.0\u00b0 E, 88.2\u00b0 S, no data");
  EXPECT_TRUE(told[3].ends_with("90.0\u00b0 N, " + told[3].substr(told[3].find("about")))) << told[3];
  EXPECT_NEAR(elevation(told[3]), 2000, 150);
  EXPECT_TRUE(told[4].starts_with("90.0\u00b0 E, 55.0\u00b0 N, about ")) << told[4];
  EXPECT_EQ(told[5], "hidden");
  EXPECT_TRUE(told[6].starts_with("0.0\u00b0 E, 55.0\u00b0 S, about ")) << told[6];
  EXPECT_EQ(told[7], "true");
}

}  // namespace
}  // namespace vpe::app
