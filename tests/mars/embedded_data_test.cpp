// The embedded Mars against the data that it carries: heights at posts, means over their areas, no marks of their grid.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <glm/geometric.hpp>
#include <vector>

#include "mars/embedded/data_files.h"
#include "mars/embedded/embedded.h"
#include "mars/embedded/math.h"
#include "mars/embedded/surface.h"
#include "mars/sources/source.h"
#include "tests/mars/patch.h"
#include "tests/support/support.h"

namespace mars {
namespace {

using embedded::kMeasuredColumns;
using test_support::Random;

constexpr int kRows = kMeasuredColumns / 2;

LonLat post_place(double column, double row) {
  return {(column + 0.5) * embedded::kMeasuredPost_deg, 90.0 - (row + 0.5) * embedded::kMeasuredPost_deg};
}

std::vector<double> heights(const std::vector<glm::dvec3>& directions, double spacing_m,
                            const EmbeddedOptions& options = {}) {
  std::vector<double> out(directions.size());
  embedded_elevation(options)->sample(directions, spacing_m, out);
  return out;
}

std::vector<double> raster_heights(const std::vector<glm::dvec3>& directions) {
  std::vector<double> out(directions.size());
  open_elevation(find_data_file("mola8.tif"))->sample(directions, embedded::kMeasuredPost_m, out);
  return out;
}

// Posts of every row, at both poles and on both sides of longitude 0 and 180 too.
std::vector<glm::dvec3> posts(Random& random, int count) {
  std::vector<glm::dvec3> directions;
  for (int k = 0; k < count; ++k) {
    int column = random.integer(0, kMeasuredColumns - 1);
    int row = random.integer(0, kRows - 1);
    if (k % 10 == 0) row = (k % 20 == 0) ? k / 20 % 4 : kRows - 1 - k / 20 % 4;
    if (k % 10 == 1) column = (kRows * (k / 10 % 2) + kMeasuredColumns + k / 20 % 4 - 2) % kMeasuredColumns;
    directions.push_back(direction(post_place(column, row)));
  }
  return directions;
}

TEST(EmbeddedData, FilesAreFoundAndAsTheyWerePacked) {
  EXPECT_FALSE(find_data_file("mola8.tif").empty());
  EXPECT_FALSE(find_data_file("mdim21.vrt").empty());
  EXPECT_TRUE(find_data_file("absent.tif").empty());
  EXPECT_EQ(embedded::MeasuredMars::get().height_fault(), "");
  EXPECT_EQ(embedded::MeasuredMars::get().colour_fault(), "");
  const std::filesystem::path folder = std::filesystem::path(find_data_file("mola8.tif")).parent_path();
  std::uintmax_t bytes = 0;
  for (const char* name : {"mola8.tif", "mdim21.jpg", "mdim21.vrt"})
    bytes += std::filesystem::file_size(folder / name);
  EXPECT_LT(bytes, std::uintmax_t{8} << 20);
  const std::string check = "cd '" + folder.string() + "' && sha256sum --quiet --strict -c SHA256SUMS";
  EXPECT_EQ(std::system(check.c_str()), 0);
}

TEST(EmbeddedData, HeightsAtPostsAreTheRasters) {
  Random random(61);
  const auto directions = posts(random, 100'000);
  const auto raster = raster_heights(directions);
  const auto spline = heights(directions, 5000.0);
  double worst_m = 0.0;
  for (std::size_t i = 0; i < directions.size(); ++i)
    worst_m = std::max(worst_m, std::abs(spline[i] - raster[i]));
  EXPECT_LT(worst_m, 0.8);
}

// S of a planet with posts of a metre: the plane through the three posts around.
double facet_height(LonLat p, double u, double v) {
  const LocalFrame f = local_frame(p);
  std::vector<glm::dvec3> corners;
  for (const auto& [e, n] : {std::pair{-u, -v}, {1.0 - u, -v}, {-u, 1.0 - v}})
    corners.push_back(glm::normalize(f.up + (e * f.east + n * f.north) / kMarsRadius_m));
  const auto h = heights(corners, 1.0);
  return h[0] + u * (h[1] - h[0]) + v * (h[2] - h[0]);
}

void check_facets(int count) {
  Random random(62);
  const auto directions = posts(random, count);
  const auto raster = raster_heights(directions);
  double worst_m = 0.0;
  for (std::size_t i = 0; i < directions.size(); ++i) {
    const double u = random.uniform(0, 1);
    const double v = random.uniform(0, 1 - u);
    const LonLat p = lon_lat(directions[i]);
    const double off_m = std::abs(facet_height(p, u, v) - raster[i]);
    worst_m = std::max(worst_m, off_m);
    EXPECT_LT(off_m, 1.0) << p.lon_deg << "," << p.lat_deg;
  }
  ::testing::Test::RecordProperty("worst_m", std::to_string(worst_m));
}

TEST(EmbeddedData, SurfaceAtPostsIsTheRasterWithinAMetre) { check_facets(600); }
TEST(LongEmbeddedData, SurfaceAtPostsIsTheRasterWithinAMetre) { check_facets(100'000); }

TEST(EmbeddedData, DetailHasNoMeanOverThePost) {
  Random random(63);
  double square = 0.0, worst_m = 0.0;
  constexpr int kPosts = 60;
  constexpr int kSteps = 64;
  for (int k = 0; k < kPosts; ++k) {
    // Rows up to 60 degrees, whose posts stand for themselves.
    const int column = random.integer(0, kMeasuredColumns - 1);
    const int row = random.integer(kRows / 6, kRows - kRows / 6);
    std::vector<glm::dvec3> area;
    for (int b = 0; b < kSteps; ++b) {
      for (int a = 0; a < kSteps; ++a)
        area.push_back(
            direction(post_place(column - 0.5 + (a + 0.5) / kSteps, row - 0.5 + (b + 0.5) / kSteps)));
    }
    const auto with = heights(area, 110.0);
    const auto without = heights(area, 110.0, {.detail = false});
    double mean_m = 0.0;
    for (std::size_t i = 0; i < area.size(); ++i)
      mean_m += (with[i] - without[i]) / static_cast<double>(area.size());
    square += mean_m * mean_m / kPosts;
    worst_m = std::max(worst_m, std::abs(mean_m));
  }
  RecordProperty("rms_m", std::to_string(std::sqrt(square)));
  RecordProperty("worst_m", std::to_string(worst_m));
  EXPECT_LT(std::sqrt(square), 0.5);
  EXPECT_LT(worst_m, 1.5);
}

TEST(EmbeddedData, NamedPlacesAreAsHighAsMolaHasThem) {
  struct Named {
    const char* name;
    LonLat place;
    double height_m, within_m;
  };
  // Heights of the grid of eight posts a degree; `within` is what the ground rises within a post.
  for (const Named& n : {Named{"Olympus Mons, caldera", {226.2, 18.65}, 19963, 150},
                         Named{"Olympus Mons, summit", {226.875, 17.375}, 21128, 150},
                         Named{"Hellas, floor", {70, -42.5}, -6200, 400},
                         Named{"Hellas, deepest", {62.1875, -32.8125}, -8130, 60},
                         Named{"Mount Sharp", {137.8, -5.4}, -1591, 700},
                         Named{"Bradbury Landing", {137.4417, -4.5895}, -4476, 60},
                         Named{"Viking 1 lander", {312.05, 22.27}, -3635, 30},
                         Named{"north pole", {0, 90}, -1985, 30}, Named{"south pole", {0, -90}, 3837, 30},
                         Named{"antimeridian", {180, 0}, raster_heights({direction({180, 0})})[0], 40}}) {
    EXPECT_NEAR(heights({direction(n.place)}, 5000.0)[0], n.height_m, n.within_m) << n.name;
  }
}

TEST(EmbeddedData, ColoursAtPixelsAreTheMosaics) {
  Random random(64);
  // Nearer to the poles rasters average over as many pixels of a row as are 7.4 km.
  auto directions = posts(random, 20'000);
  std::erase_if(directions, [](const glm::dvec3& d) { return std::abs(d.z) > 0.7; });
  ASSERT_GT(directions.size(), 5000U);
  std::vector<vpe::base::Rgb> colours(directions.size()), expected(directions.size());
  std::vector<std::uint8_t> alpha(directions.size());
  embedded_image()->sample(directions, 5000.0, colours, alpha);
  open_image(find_data_file("mdim21.vrt"))->sample(directions, embedded::kMeasuredPost_m, expected, alpha);
  int off = 0;
  for (std::size_t i = 0; i < directions.size(); ++i) {
    const auto& a = colours[i];
    const auto& b = expected[i];
    off += std::abs(a.r - b.r) > 1 || std::abs(a.g - b.g) > 1 || std::abs(a.b - b.b) > 1;
  }
  EXPECT_EQ(off, 0);
}

TEST(EmbeddedData, DetailChangesNoMeanColour) {
  Random random(65);
  for (int k = 0; k < 30; ++k) {
    const LonLat p =
        post_place(random.integer(0, kMeasuredColumns - 1), random.integer(kRows / 4, kRows * 3 / 4));
    const auto directions = patch(p, 96, 77.0);
    std::vector<vpe::base::Rgb> with(directions.size()), without(directions.size());
    std::vector<std::uint8_t> alpha(directions.size());
    embedded_image()->sample(directions, 77.0, with, alpha);
    embedded_image({.detail = false})->sample(directions, 77.0, without, alpha);
    double sum = 0.0;
    for (std::size_t i = 0; i < with.size(); ++i)
      sum += (with[i].r + with[i].g + with[i].b - without[i].r - without[i].g - without[i].b) / 3.0;
    EXPECT_NEAR(sum / static_cast<double>(with.size()), 0.0, 7.0) << p.lon_deg << "," << p.lat_deg;
  }
}

// Slopes along the grid of the data, across it, and between: no direction stands out.
TEST(EmbeddedData, TheGridOfTheDataDoesNotShow) {
  constexpr double kStep_m = 300.0;
  double along = 0.0, across = 0.0, between = 0.0;
  for (const LonLat& p : {LonLat{20, -20}, LonLat{150, -10}, LonLat{-150, 15}, LonLat{60, 25}, LonLat{100, 40},
                          LonLat{-10, -40}, LonLat{-60, -13}, LonLat{-80, 5}}) {
    const auto d = patch(p, 130, kStep_m);
    auto h = heights(d, kStep_m);
    const auto base = heights(d, kStep_m, {.detail = false});
    double scale = 0.0, e = 0.0, n = 0.0, x = 0.0;
    for (std::size_t i = 0; i < h.size(); ++i) h[i] -= base[i];
    const auto square = [&](std::size_t i, std::size_t j, double length) {
      return (h[i] - h[j]) * (h[i] - h[j]) / (length * length);
    };
    for (std::size_t j = 0; j + 4 < 130; ++j) {
      for (std::size_t i = 0; i + 4 < 130; ++i) {
        const std::size_t k = j * 130 + i;
        // Steps of about 1.2 km in each direction.
        e += square(k, k + 4, 4.0);
        n += square(k, k + 4 * 130, 4.0);
        x += 0.5 * (square(k, k + 3 * 131, 4.2426) + square(k + 3, k + 3 * 130, 4.2426));
        scale += square(k, k + 4, 4.0) + square(k, k + 4 * 130, 4.0);
      }
    }
    along += e / scale;
    across += n / scale;
    between += x / scale;
  }
  RecordProperty("along", std::to_string(along / between));
  RecordProperty("across", std::to_string(across / between));
  EXPECT_NEAR(std::sqrt(along / between), 1.0, 0.1);
  EXPECT_NEAR(std::sqrt(across / between), 1.0, 0.1);
}

TEST(EmbeddedData, WithoutFilesItIsASphereWithDetail) {
  const embedded::MeasuredMars none("", "/nowhere/mdim21.vrt");
  EXPECT_NE(none.height_fault().find("mola8.tif is missing in "), std::string::npos) << none.height_fault();
  EXPECT_NE(none.height_fault().find("VPE_DATA"), std::string::npos);
  EXPECT_NE(none.colour_fault().find("/nowhere/mdim21.vrt"), std::string::npos) << none.colour_fault();
  for (const double spacing_m : {5000.0, 200.0, 1.0}) {
    const auto directions = patch({30, 20}, 24, spacing_m);
    double lowest = 1e9, highest = -1e9;
    embedded::evaluate_all(
        none, directions, spacing_m, embedded::best_simd(), embedded::Wanted::kHeights,
        [&](const embedded::Block& b, std::span<const std::uint32_t> index, const embedded::Surface& s) {
          for (std::size_t i = 0; i < index.size(); ++i) {
            lowest = std::min(lowest, s.height_m[i]);
            highest = std::max(highest, s.height_m[i]);
            ASSERT_LT(i, b.count);
          }
        });
    EXPECT_GT(lowest, -600.0);
    EXPECT_LT(highest, 600.0);
    EXPECT_EQ(spacing_m > 2048.0, lowest == highest);
  }
}

}  // namespace
}  // namespace mars
