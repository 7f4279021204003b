// Tests tables of colour scales against the scales themselves.
#include "vpe/voxel/paint/scale_table.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <glm/common.hpp>
#include <optional>

#include "tests/support/support.h"

namespace {

namespace core = vpe::core;
using vpe::voxel::ScaleTable;

void write(const std::filesystem::path& file, const std::string& text) { std::ofstream(file) << text; }

// Looks a value up as the kernel does; returns nullopt where the scale itself must be evaluated.
std::optional<glm::dvec3> look_up(const ScaleTable& table, double value) {
  const float at = (static_cast<float>(value) - table.first) * table.per_unit;
  const float inside = std::min(std::max(at, -1.0F), static_cast<float>(ScaleTable::kInner));
  const ScaleTable::Bucket& b = table.buckets[static_cast<std::size_t>(std::floor(inside) + 1)];
  if (b.base[3] != 0.0F) return std::nullopt;
  const float share = inside - std::floor(inside);
  return glm::dvec3(b.base[0] + share * b.rise[0], b.base[1] + share * b.rise[1],
                    b.base[2] + share * b.rise[2]);
}

// Returns the share of values for which the scale must be evaluated.
double check(const core::ColourScale& scale, const std::string& name) {
  const ScaleTable table = vpe::voxel::scale_table(scale);
  const double low = std::min(scale.low(), scale.high()), span = std::abs(scale.high() - scale.low());
  int evaluated = 0;
  constexpr int kValues = 40000;
  for (int n = 0; n < kValues; ++n) {
    const double value = static_cast<float>(low + span * (1.2 * (n + 0.37) / kValues - 0.1));
    const auto found = look_up(table, value);
    evaluated += found ? 0 : 1;
    if (!found) continue;
    const glm::dvec3 off = glm::abs(*found - scale(value));
    EXPECT_LE(std::max({off.x, off.y, off.z}), vpe::voxel::kScaleTableError + 0.05) << name << " " << value;
  }
  return static_cast<double>(evaluated) / kValues;
}

TEST(ScaleTable, IsEveryBuiltInScale) {
  for (const std::string_view palette : core::palette_names()) {
    for (const auto colour : {core::Colour::kElevation, core::Colour::kSlope, core::Colour::kAspect}) {
      for (const bool reversed : {false, true}) {
        core::Appearance a;
        a.palette = palette;
        a.colour = colour;
        if (reversed) {
          a.palette_low = 170;
          a.palette_high = -35;
        }
        EXPECT_LT(check(core::ColourScale(a), std::string(palette)), 0.1) << palette;
      }
    }
  }
}

TEST(ScaleTable, EvaluatesTheScaleAtStepsAndBends) {
  const test_support::TempDir dir;
  write(dir / "steps.txt", "-100 0 0 0\n0 10 200 30\n0 255 0 0\n1 9 9 9\n700 0 0 255\n700 0 255 0\n");
  core::Appearance a;
  a.palette = (dir / "steps.txt").string();
  const double evaluated = check(core::ColourScale(a), "steps");
  EXPECT_GT(evaluated, 0.001);
  EXPECT_LT(evaluated, 0.05);
  // All stops are at one value.
  write(dir / "one.txt", "5 0 0 0\n5 200 100 50\n");
  a.palette = (dir / "one.txt").string();
  const ScaleTable table = vpe::voxel::scale_table(core::ColourScale(a));
  for (const double value : {-1e9, 4.0, 5.0, 6.0, 1e9}) EXPECT_FALSE(look_up(table, value).has_value());
}

}  // namespace
