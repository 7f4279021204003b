// Slope and aspect: by hand, at hostile places, and against gdaldem on a plane.
#include "vpe/core/appearance/slope.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <glm/geometric.hpp>
#include <sstream>

#include "mars/geodesy/sphere.h"
#include "tests/app/support/process.h"
#include "tests/support/support.h"
#include "vpe/base/file.h"
#include "vpe/base/number.h"

namespace vpe::core {
namespace {

using mars::kRadiansPerDegree;
using test_support::Random;

constexpr glm::dvec3 kEast(1, 0, 0);
constexpr glm::dvec3 kNorth(0, 1, 0);
constexpr glm::dvec3 kUp(0, 0, 1);

double turn(double a, double b) { return std::abs(std::remainder(a - b, 360.0)); }

TEST(Slope, ByHand) {
  EXPECT_EQ(slope_deg(kUp, kUp), 0);
  EXPECT_DOUBLE_EQ(slope_deg(kEast, kUp), 90);
  EXPECT_DOUBLE_EQ(slope_deg(-kUp, kUp), 180);
  EXPECT_DOUBLE_EQ(slope_deg({0, -3, 3}, kUp * 7.0), 45);
  EXPECT_NEAR(slope_deg({1e-12, 0, 1}, kUp), 1e-12 / kRadiansPerDegree, 1e-22);
  // Ground that falls to the north, east, south, west.
  EXPECT_DOUBLE_EQ(aspect_deg({0, 1, 1}, kUp, kNorth, kEast), 0);
  EXPECT_DOUBLE_EQ(aspect_deg({1, 0, 1}, kUp, kNorth, kEast), 90);
  EXPECT_DOUBLE_EQ(aspect_deg({0, -1, 1}, kUp, kNorth, kEast), 180);
  EXPECT_DOUBLE_EQ(aspect_deg({-1, 0, 1}, kUp, kNorth, kEast), 270);
  EXPECT_EQ(aspect_deg({-1e-30, 1, 1}, kUp, kNorth, kEast), 0);
  EXPECT_TRUE(std::isnan(aspect_deg(kUp, kUp, kNorth, kEast)));
  EXPECT_TRUE(std::isnan(aspect_deg({1e-14, 0, 1}, kUp, kNorth, kEast)));
  EXPECT_DOUBLE_EQ(aspect_deg({1e-9, 0, 1}, kUp, kNorth, kEast), 90);
}

TEST(Slope, ComesBackAtAnyPlace) {
  Random random(1);
  for (int trial = 0; trial < 5000; ++trial) {
    mars::LonLat at = mars::lon_lat(random.direction());
    if (trial % 7 == 0) at.lat_deg = trial % 2 == 0 ? 90 : -90;
    const mars::LocalFrame f = mars::local_frame(at);
    const double slope = random.log_uniform(1e-6, 120);
    const double aspect = random.uniform(0, 360);
    const glm::dvec3 down =
        f.north * std::cos(aspect * kRadiansPerDegree) + f.east * std::sin(aspect * kRadiansPerDegree);
    const glm::dvec3 normal =
        (f.up * std::cos(slope * kRadiansPerDegree) + down * std::sin(slope * kRadiansPerDegree)) *
        random.log_uniform(1e-3, 1e3);
    EXPECT_NEAR(slope_deg(normal, f.up), slope, 1e-13 * 100);
    const double found = aspect_deg(normal, f.up, f.north, f.east);
    EXPECT_GE(found, 0);
    EXPECT_LT(found, 360);
    EXPECT_LT(turn(found, aspect), 1e-12 / std::min(1.0, slope * kRadiansPerDegree));
  }
}

TEST(Slope, NorthAtThePolesIsAlongTheNamedMeridian) {
  const glm::dvec3 normal(1, 0, 1);  // at the north pole, falls along the meridian of longitude 0
  const auto at = [&](double lon_deg) {
    const mars::LocalFrame f = mars::local_frame({lon_deg, 90});
    return aspect_deg(normal, f.up, f.north, f.east);
  };
  EXPECT_NEAR(at(0), 180, 1e-12);  // north of the meridian of 0 leads over the pole, away from 0
  EXPECT_NEAR(at(180), 0, 1e-12);
  EXPECT_NEAR(at(90), 270, 1e-12);
}

// Returns smooth random ground over a square, metres.
class Ground {
 public:
  explicit Ground(std::uint64_t seed) {
    Random random(seed);
    for (Wave& w : waves_) {
      const double length = random.log_uniform(1500, 12000);
      const double heading = random.uniform(0, 2 * mars::kPi);
      w = {2 * mars::kPi / length * std::cos(heading), 2 * mars::kPi / length * std::sin(heading),
           random.uniform(0, 2 * mars::kPi), 0.02 * length * random.uniform(0.2, 1)};
    }
  }
  double height_m(double x, double y) const {
    double sum = 0;
    for (const Wave& w : waves_) sum += w.height * std::sin(w.x * x + w.y * y + w.phase);
    return sum;
  }
  glm::dvec3 normal(double x, double y) const {
    glm::dvec3 n(0, 0, 1);
    for (const Wave& w : waves_) {
      const double rise = w.height * std::cos(w.x * x + w.y * y + w.phase);
      n.x -= w.x * rise;
      n.y -= w.y * rise;
    }
    return n;
  }

 private:
  struct Wave {
    double x, y, phase, height;
  };
  Wave waves_[12];
};

struct Difference {
  double slope_rms_deg = 0;
  double slope_most_deg = 0;
  double aspect_rms_deg = 0;
  double aspect_most_deg = 0;
};

class Gdaldem {
 public:
  Gdaldem(int side, double spacing_m, const Ground& ground) : side_(side) {
    std::string grid = "ncols " + std::to_string(side) + "\nnrows " + std::to_string(side) +
                       "\nxllcorner 0\nyllcorner 0\ncellsize " + base::format_number(spacing_m) + "\n";
    for (int row = 0; row < side; ++row) {
      for (int column = 0; column < side; ++column) {
        heights_.push_back(ground.height_m(spacing_m * column, -spacing_m * row));
        char text[32];
        std::snprintf(text, sizeof text, "%.9f ", heights_.back());
        grid += text;
      }
      grid += "\n";
    }
    base::write_file(dir_ / "z.asc", std::string_view(grid));
  }

  // For inner posts, row after row.
  std::vector<double> run(const std::vector<std::string>& what) const {
    app_test::Command command;
    command.program = app_test::find_program("gdaldem");
    command.folder = dir_.path();
    command.arguments = {what[0], "-q", "-of", "AAIGrid", "-co", "DECIMAL_PRECISION=9"};
    command.arguments.insert(command.arguments.end(), what.begin() + 1, what.end());
    command.arguments.insert(command.arguments.end(), {"z.asc", what[0] + ".asc"});
    const app_test::Result result = app_test::run(command);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    const std::vector<std::uint8_t> bytes = base::read_file(dir_ / (what[0] + ".asc"), 1 << 26);
    std::istringstream in(std::string(bytes.begin(), bytes.end()));
    std::string word;
    std::vector<double> all;
    while (in >> word) {
      const auto value = base::parse_number(word);
      if (value) {
        all.push_back(*value);
      } else {
        all.clear();  // a line of the header: its value follows
        in >> word;
      }
    }
    EXPECT_EQ(all.size(), heights_.size());
    std::vector<double> inner;
    for (int row = 1; row + 1 < side_; ++row) {
      for (int column = 1; column + 1 < side_; ++column) inner.push_back(all.at(at(row, column)));
    }
    return inner;
  }

  double height(int row, int column) const { return heights_[at(row, column)]; }
  std::size_t at(int row, int column) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(side_) + static_cast<std::size_t>(column);
  }

 private:
  test_support::TempDir dir_;
  int side_;
  std::vector<double> heights_;
};

// Aspect only where ground is steeper than this: below it, a small error changes it arbitrarily.
constexpr double kSteep_deg = 2;

Difference compare(const std::vector<glm::dvec3>& normals, const std::vector<double>& slope,
                   const std::vector<double>& aspect) {
  Difference d;
  double steep = 0;
  for (std::size_t n = 0; n < normals.size(); ++n) {
    const double ours = slope_deg(normals[n], kUp);
    const double off = std::abs(ours - slope[n]);
    d.slope_rms_deg += off * off;
    d.slope_most_deg = std::max(d.slope_most_deg, off);
    if (ours < kSteep_deg) continue;
    const double turned = turn(aspect_deg(normals[n], kUp, kNorth, kEast), aspect[n]);
    d.aspect_rms_deg += turned * turned;
    d.aspect_most_deg = std::max(d.aspect_most_deg, turned);
    ++steep;
  }
  EXPECT_GT(steep, 0.5 * static_cast<double>(normals.size()));
  d.slope_rms_deg = std::sqrt(d.slope_rms_deg / static_cast<double>(normals.size()));
  d.aspect_rms_deg = std::sqrt(d.aspect_rms_deg / steep);
  return d;
}

// gdaldem's ZevenbergenThorne has the same definition: half the difference of the two neighbours on each
// axis. Its default, Horn, averages three such differences, weights 1 2 1, so it sees ground a little smoother.
TEST(Slope, AgreesWithGdaldemOnAPlane) {
  if (app_test::find_program("gdaldem").empty()) GTEST_SKIP() << "skipped: no gdaldem";
  constexpr int kSide = 120;
  constexpr double kSpacing_m = 100;
  const Ground ground(11);
  const Gdaldem gdaldem(kSide, kSpacing_m, ground);
  std::vector<glm::dvec3> central;
  std::vector<glm::dvec3> exact;
  for (int row = 1; row + 1 < kSide; ++row) {
    for (int column = 1; column + 1 < kSide; ++column) {
      const glm::dvec3 east(2 * kSpacing_m, 0,
                            gdaldem.height(row, column + 1) - gdaldem.height(row, column - 1));
      const glm::dvec3 north(0, 2 * kSpacing_m,
                             gdaldem.height(row - 1, column) - gdaldem.height(row + 1, column));
      central.push_back(glm::normalize(glm::cross(east, north)));
      exact.push_back(ground.normal(kSpacing_m * column, -kSpacing_m * row));
    }
  }
  const auto horn_slope = gdaldem.run({"slope"});
  const auto horn_aspect = gdaldem.run({"aspect"});
  const auto same_slope = gdaldem.run({"slope", "-alg", "ZevenbergenThorne"});
  const auto same_aspect = gdaldem.run({"aspect", "-alg", "ZevenbergenThorne"});

  const auto show = [](const char* what, const Difference& d) {
    std::printf("  %s: slope RMS %.5f, most %.5f; aspect RMS %.5f, most %.5f degrees\n", what, d.slope_rms_deg,
                d.slope_most_deg, d.aspect_rms_deg, d.aspect_most_deg);
    return d;
  };
  const Difference same = show("ours against ZevenbergenThorne", compare(central, same_slope, same_aspect));
  EXPECT_LT(same.slope_most_deg, 1e-4);
  EXPECT_LT(same.aspect_most_deg, 1e-3);
  const Difference horn = show("ours against Horn", compare(central, horn_slope, horn_aspect));
  const Difference truth = show("the true normal against Horn", compare(exact, horn_slope, horn_aspect));
  const Difference ours = show("the true normal against ours", compare(exact, same_slope, same_aspect));
  // Horn differs by definition, not more than it differs from the truth, to which central differences are
  // closer.
  EXPECT_LT(horn.slope_rms_deg, 0.5);
  EXPECT_LT(horn.aspect_rms_deg, 2.0);
  EXPECT_GT(horn.slope_rms_deg, 10 * same.slope_rms_deg);
  EXPECT_LT(horn.slope_rms_deg, truth.slope_rms_deg);
  EXPECT_LT(ours.slope_rms_deg, truth.slope_rms_deg);
}

}  // namespace
}  // namespace vpe::core
