// Slopes of walls of the embedded Mars against measured ones: digital terrain models of the Context Camera
// (CTX) with posts of 20 m, on the north-western flank of Aeolis Mons in Gale (137.28 to 137.54 E, 4.65 to
// 5.06 S).
#include <cmath>
#include <string>
#include <vector>

#include "mars/embedded/embedded.h"
#include "mars/sources/source.h"
#include "tests/support/support.h"

namespace mars {
namespace {

constexpr double kPost_m = 20.0;
constexpr double kPost_deg = kPost_m / kMarsRadius_m / kRadiansPerDegree;
constexpr std::size_t kColumns = 755;
constexpr std::size_t kRows = 1215;

// One grid for all surfaces.
std::vector<glm::dvec3> grid() {
  std::vector<glm::dvec3> directions;
  for (std::size_t j = 0; j < kRows; ++j) {
    for (std::size_t i = 0; i < kColumns; ++i)
      directions.push_back(
          direction({137.28 + static_cast<double>(i) * kPost_deg, -5.06 + static_cast<double>(j) * kPost_deg}));
  }
  return directions;
}

std::vector<double> heights(const ElevationSource& source, const std::vector<glm::dvec3>& directions) {
  std::vector<double> out(directions.size());
  source.sample(directions, kPost_m, out);
  return out;
}

double square_of_gradient(const std::vector<double>& h, std::size_t at, std::size_t steps) {
  const double length_m = kPost_m * static_cast<double>(steps);
  const double east = (h[at + steps] - h[at]) / length_m;
  const double north = (h[at + steps * kColumns] - h[at]) / length_m;
  return east * east + north * north;
}

// Slopes of the data that the program carries, over 2 km; 0 near the borders.
std::vector<double> broad_slopes(const std::vector<double>& data) {
  constexpr std::size_t kReach = 50;
  std::vector<double> out(data.size());
  for (std::size_t j = kReach; j + kReach < kRows; ++j) {
    for (std::size_t i = kReach; i + kReach < kColumns; ++i) {
      const std::size_t at = j * kColumns + i;
      const double east = data[at + kReach] - data[at - kReach];
      const double north = data[at + kReach * kColumns] - data[at - kReach * kColumns];
      out[at] = std::sqrt(east * east + north * north) / (2.0 * kReach * kPost_m);
    }
  }
  return out;
}

TEST(EmbeddedSlope, WallsAreAsSteepAsThoseOfGale) {
  const std::string folder = "gale-ctx20/";
  const std::string pair = "B01_009861_1753_XI_04S222W__";
  VPE_NEED_SHARED(first, folder + pair + "B06_011984_1754_XN_04S222W-DEM-geoid-adj.tif");
  const auto directions = grid();
  const auto synthetic = heights(*embedded_elevation(), directions);
  const auto broad = broad_slopes(heights(*embedded_elevation({.detail = false}), directions));
  // Two stereo pairs, and the mosaic of them, which has seams.
  for (const std::string& name :
       {pair + "B06_011984_1754_XN_04S222W-DEM-geoid-adj.tif",
        pair + "D01_027412_1751_XN_04S222W-DEM-geoid-adj.tif", std::string("gale_ctx20_mosaic.tif")}) {
    const auto path = test_support::shared_data(folder + name);
    if (path.empty()) continue;
    const auto real = heights(*open_elevation(path.string()), directions);
    // Ground is a wall from the first of these slopes on, and more wall than plain from the second on
    // (mars/embedded/ground.cpp). Both surfaces are compared at the same posts.
    for (const double steep : {0.07, 0.145}) {
      for (const std::size_t steps : {1U, 5U}) {
        double real_sum = 0.0, synthetic_sum = 0.0, count = 0.0;
        for (std::size_t j = 0; j + steps < kRows; ++j) {
          for (std::size_t i = 0; i + steps < kColumns; ++i) {
            const std::size_t at = j * kColumns + i;
            if (broad[at] < steep) continue;
            const double square = square_of_gradient(real, at, steps);
            if (!std::isfinite(square)) continue;
            real_sum += square;
            synthetic_sum += square_of_gradient(synthetic, at, steps);
            count += 1.0;
          }
        }
        ASSERT_GT(count, 50'000.0) << name;
        const auto degrees = [count](double sum) {
          return std::atan(std::sqrt(sum / count)) / kRadiansPerDegree;
        };
        const std::string what = name.substr(0, 33) + " from " + std::to_string(steep) + ", " +
                                 std::to_string(static_cast<int>(kPost_m) * static_cast<int>(steps)) + " m";
        RecordProperty(what, std::to_string(degrees(real_sum)) + " real, " +
                                 std::to_string(degrees(synthetic_sum)) + " synthetic [degrees]");
        EXPECT_NEAR(std::sqrt(synthetic_sum / real_sum), 1.0, 0.3)
            << what << ": " << degrees(real_sum) << " and " << degrees(synthetic_sum) << " degrees";
      }
    }
  }
}

// What the sources state as their accuracy.
TEST(EmbeddedSlope, DeviatesFromFinerDataByTheStatedAccuracy) {
  VPE_NEED_SHARED(gale, "gale-mola128/gale_megt128.lbl");
  const auto real = open_elevation(gale.string());
  std::vector<glm::dvec3> directions;
  for (double lat_deg = -8.6; lat_deg < -2.1; lat_deg += 0.045) {
    for (double lon_deg = 134.6; lon_deg < 141.0; lon_deg += 0.045)
      directions.push_back(direction({lon_deg, lat_deg}));
  }
  std::vector<double> expected(directions.size()), found(directions.size());
  real->sample(directions, 463.0, expected);
  for (const bool detail : {false, true}) {
    const auto mars = embedded_elevation({.finest_m = 463.0, .detail = detail});
    mars->sample(directions, 463.0, found);
    double sum = 0.0;
    for (std::size_t n = 0; n < found.size(); ++n) sum += (found[n] - expected[n]) * (found[n] - expected[n]);
    const double rms_m = std::sqrt(sum / static_cast<double>(found.size()));
    RecordProperty(detail ? "with detail [m]" : "data alone [m]", std::to_string(rms_m));
    EXPECT_EQ(mars->infos().back().accuracy_m, detail ? kDetailAccuracy_m : kMeasuredAccuracy_m);
    EXPECT_LE(rms_m, *mars->infos().back().accuracy_m);
    EXPECT_GE(rms_m, 0.8 * *mars->infos().back().accuracy_m);
  }
}

}  // namespace
}  // namespace mars
