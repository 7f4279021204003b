// The kernel of domes: its bound, and the same bits for all instruction sets.
#include "objects/draw/dome_kernel.h"

#include <gtest/gtest.h>

#include <hwy/highway.h>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <random>
#include <vector>

namespace objects {
namespace {

using Kind = PanoramaFormula::Kind;
constexpr double kPi = 3.14159265358979323846;
constexpr int kSide = kDomeBlock_px;

// A block of a perspective view of `focal_px`, the dome's axes turned so that its middle has azimuth 0.
struct Case {
  glm::dvec3 right;
  glm::dvec3 up;
  glm::dvec3 forward;
  glm::dvec3 camera;
  double focal_px = 700;
  bool is_cylinder = false;

  glm::dvec3 ray(double column, double row) const {
    return forward + (column - 0.5 * kSide) / focal_px * right + (0.5 * kSide - row) / focal_px * up;
  }
  glm::dvec3 met(const glm::dvec3& ray) const {
    const glm::dvec3 part(1, 1, is_cylinder ? 0 : 1);
    const glm::dvec3 d = ray * part;
    const glm::dvec3 c = camera * part;
    const double b = glm::dot(c, d);
    const double a = glm::dot(d, d);
    return camera + (std::sqrt(b * b + a * (1 - glm::dot(c, c))) - b) / a * ray;
  }
};

template <class T>
DomeBlock<T> block_of(const Case& c, Kind kind, double elevation_rad) {
  const auto vector = [](const glm::dvec3& v) {
    return typename DomeBlock<T>::Vector{static_cast<T>(v.x), static_cast<T>(v.y), static_cast<T>(v.z)};
  };
  DomeBlock<T> b;
  for (std::size_t n = 0; n < kSide; ++n) {
    const auto at = vector(c.forward + (static_cast<double>(n) + 0.5 - 0.5 * kSide) / c.focal_px * c.right);
    for (std::size_t axis = 0; axis < 3; ++axis) b.column[axis][n] = at[axis];
    b.row_scale[n] = 1;
    b.row_rise[n] = static_cast<T>((0.5 * kSide - static_cast<double>(n) - 0.5) / c.focal_px);
  }
  b.up = vector(c.up);
  b.camera = vector(c.camera);
  const double level = c.is_cylinder ? 0 : 1;
  b.open =
      static_cast<T>(1 - c.camera.x * c.camera.x - c.camera.y * c.camera.y - level * c.camera.z * c.camera.z);
  b.is_cylinder = c.is_cylinder;
  b.kind = kind;
  b.half_facet_px = 1e4;
  if (kind != Kind::kEquirectangular) b.middle_y_px = static_cast<T>(-std::tan(elevation_rad));
  b.sine = static_cast<T>(std::sin(elevation_rad));
  b.cosine = static_cast<T>(std::cos(elevation_rad));
  b.least_x_px = b.least_y_px = -1e9F;
  b.most_x_px = b.most_y_px = 1e9F;
  return b;
}

// Returns a random block whose middle meets the dome at azimuth 0, and the elevation there.
Case random_case(std::mt19937& random, double& elevation_rad) {
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution(low, high)(random);
  };
  for (;;) {
    Case c;
    c.is_cylinder = between(0, 1) < 0.3;
    c.focal_px = std::exp(between(std::log(60), std::log(1e5)));
    const double a = between(0, 2 * kPi), e = between(-1.5, 1.5), roll = between(0, 2 * kPi);
    c.forward = {std::cos(e) * std::sin(a), std::cos(e) * std::cos(a), std::sin(e)};
    const glm::dvec3 side(std::cos(a), -std::sin(a), 0);
    const glm::dvec3 top = glm::cross(side, c.forward);
    c.right = std::cos(roll) * side + std::sin(roll) * top;
    c.up = std::cos(roll) * top - std::sin(roll) * side;
    c.camera = between(0, 0.8) * glm::normalize(glm::dvec3(between(-1, 1), between(-1, 1), between(-1, 1)));
    const glm::dvec3 at = c.met(c.forward);
    const double level = std::hypot(at.x, at.y);
    if (!(level > 1e-3 * glm::length(at))) continue;
    const auto turned = [&](const glm::dvec3& v) {
      return glm::dvec3(v.x * at.y - v.y * at.x, v.x * at.x + v.y * at.y, v.z * level) / level;
    };
    for (glm::dvec3* v : {&c.right, &c.up, &c.forward, &c.camera}) *v = turned(*v);
    elevation_rad = std::atan2(at.z, level);
    return c;
  }
}

// Places are off by at most so much of a pixel of the image: of the direction of the next one, as seen from the dome's middle.
template <class T>
int check_places(const Case& c, Kind kind, double elevation_rad, double most_error_px) {
  const std::vector<float> until_m(kSide * kSide, HUGE_VALF);
  BlockPlaces places;
  if (!find_places(block_of<T>(c, kind, elevation_rad), until_m.data(), kSide, places)) return 0;
  for (int row = 0; row < kSide; ++row) {
    for (int column = 0; column < kSide; ++column) {
      const auto n = static_cast<std::size_t>(row * kSide + column);
      const glm::dvec3 ray = c.ray(column + 0.5, row + 0.5);
      const glm::dvec3 at = c.met(ray);
      double x = static_cast<double>(places.x_px[n]);
      double y = -static_cast<double>(places.y_px[n]);
      if (kind != Kind::kEquirectangular) y += std::tan(elevation_rad);
      glm::dvec3 shown(x, 1, y);  // of facets
      if (kind != Kind::kFacets) {
        if (kind == Kind::kCylinder) shown = {std::sin(x), std::cos(x), y};
        if (kind == Kind::kEquirectangular) {
          const double e = elevation_rad + y;
          shown = {std::cos(e) * std::sin(x), std::cos(e) * std::cos(x), std::sin(e)};
        }
      }
      const auto angle = [](const glm::dvec3& p, const glm::dvec3& q) {
        return std::atan2(glm::length(glm::cross(p, q)), glm::dot(p, q));
      };
      // The least of the pixel's two sides, as seen from the dome's middle.
      const double pixel_rad = std::min(angle(at, c.met(c.ray(column + 1.5, row + 0.5))),
                                        angle(at, c.met(c.ray(column + 0.5, row + 1.5))));
      const double shift_px = angle(at, shown) / pixel_rad;
      EXPECT_LE(shift_px, most_error_px) << column << " " << row << " focal " << c.focal_px;
      const double range = glm::length(at - c.camera);
      EXPECT_NEAR(static_cast<double>(places.range_m[n]), range, 2e-6 * range);
      if (shift_px > most_error_px) return 1;
    }
  }
  return 1;
}

TEST(DomeKernel, PlacesAreWithinTheirBound) {
  constexpr unsigned kSeed = 29;
  std::mt19937 random(kSeed);
  std::array<int, 3> found{};
  for (int n = 0; n < 600; ++n) {
    double elevation_rad = 0;
    const Case c = random_case(random, elevation_rad);
    const auto kind = static_cast<Kind>(n % 3);
    SCOPED_TRACE("case " + std::to_string(n) + " seed " + std::to_string(kSeed));
    // Floats are used where their roundings stay below half of the bound.
    found[static_cast<std::size_t>(n % 3)] += check_places<double>(c, kind, elevation_rad, 1e-3);
    const double k = glm::length(c.camera);
    if (kFloatError_rad * c.focal_px * 1.1 <= 0.01 * (1 - k)) check_places<float>(c, kind, elevation_rad, 0.02);
  }
  for (const int count : found) EXPECT_GT(count, 60);
}

TEST(DomeKernel, HasTheSameBitsForAllInstructionSets) {
  std::mt19937 random(5);
  std::vector<std::uint32_t> texels(64 * 32);
  for (std::uint32_t& t : texels) t = static_cast<std::uint32_t>(random());
  std::vector<BlockLevel> levels(2);
  levels[0] = {texels.data(), 64, 32, 20, 20, 10, 5, 0.25F, 0.5F};
  levels[1] = {texels.data(), 32, 16, 10, 10, 30, 2, 0.25F, 0.5F};
  for (int n = 0; n < 30; ++n) {
    double elevation_rad = 0;
    const Case c = random_case(random, elevation_rad);
    const std::vector<float> until_m(kSide * kSide, 1);
    const auto draw = [&](BlockWords& words, BlockPlaces& places) {
      const DomeBlock<float> block = block_of<float>(c, static_cast<Kind>(n % 3), elevation_rad);
      const bool is_found = find_places(block, until_m.data(), kSide, places);
      if (is_found) take_colours({levels, {0.1F, 0.5F, 0.2F, 0.9F}, n % 2 == 0, 1}, places, words);
      return is_found;
    };
    BlockWords first{};
    BlockPlaces first_places{};
    const bool is_found = draw(first, first_places);
    for (std::int64_t targets = hwy::SupportedTargets(); targets != 0; targets &= targets - 1) {
      const std::int64_t target = targets & -targets;
      hwy::SetSupportedTargetsForTest(target);
      BlockWords words{};
      BlockPlaces places{};
      EXPECT_EQ(draw(words, places), is_found) << hwy::TargetName(target);
      EXPECT_EQ(words, first) << hwy::TargetName(target);
      if (is_found) {
        EXPECT_EQ(places.shows, first_places.shows);
        EXPECT_EQ(std::memcmp(&places.x_px, &first_places.x_px, sizeof places.x_px), 0);
        EXPECT_EQ(std::memcmp(&places.range_m, &first_places.range_m, sizeof places.range_m), 0);
      }
      std::array<vpe::base::Rgb, kSide> bytes;
      store_bytes(words.data(), bytes.data());
      for (std::size_t k = 0; k < kSide; ++k) {
        EXPECT_EQ(bytes[k].r, words[k] & 255U);
        EXPECT_EQ(bytes[k].g, words[k] >> 10U & 255U);
        EXPECT_EQ(bytes[k].b, words[k] >> 20U & 255U);
      }
    }
    hwy::SetSupportedTargetsForTest(0);
  }
}

// Beyond the sides of an image that is no circle lies what is at them; that of a circle goes on.
TEST(DomeKernel, TakesTexelsAcrossTheEnds) {
  std::array<std::uint32_t, 4> texels{10, 50, 90, 130};  // in red
  const BlockLevel level{texels.data(), 4, 1, 1, 1, 0, 0, 0, 0};
  BlockPlaces places{};
  for (std::size_t n = 0; n < places.x_px.size(); ++n)
    places.x_px[n] = static_cast<float>(n % kSide) * 0.5F - 1;
  for (const bool repeats : {false, true}) {
    BlockWords words;
    take_colours({{&level, 1}, {}, repeats, 1}, places, words);
    fetch_ahead({{&level, 1}, {}, repeats, 1}, places);
    EXPECT_EQ(words[0], repeats ? 130U : 10U);
    EXPECT_EQ(words[1], repeats ? 70U : 10U);
    EXPECT_EQ(words[3], 30U);
    EXPECT_EQ(words[9], repeats ? 70U : 130U);
    EXPECT_EQ(words[10], repeats ? 10U : 130U);
  }
}

}  // namespace
}  // namespace objects
