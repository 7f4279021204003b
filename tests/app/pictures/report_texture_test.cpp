// Textures in place of triangles: the figures of the report, of a small planet with imagery.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <stdexcept>

#include "tests/gl/appearance_fixture.h"
#include "vpe/app/report/papers/papers_texture.h"
#include "vpe/core/image/image.h"
#include "vpe/report/interleaved_timing.h"

namespace vpe::app {
namespace {

double number(const report::Table& table, std::size_t row, const std::string& name) {
  for (std::size_t k = 0; k < table.columns.size(); ++k)
    if (table.columns[k].name == name) return std::get<double>(table.rows.at(row)[k]);
  throw std::out_of_range(name);
}

// Builds a planet with an image, and hills of 30 km and posts of some 5 km round kWavyMiddle.
std::shared_ptr<const paging::PlanetFile> hilly_planet(const std::filesystem::path& path) {
  paging::BuildOptions options;
  options.output = path.string();
  options.base_spacing_m = 100000;
  options.threads = 2;
  options.tile_k = 5;
  options.resampling_posts = 1000;
  const test_support::WavyImage image;
  const auto height_m = [](const glm::dvec3& d) {
    return test_support::bumpy_height(d) + 1500 * std::sin(700 * d.x) * std::sin(650 * d.y + 1);
  };
  paging::build_planet(
      options,
      test_support::FakeElevation(height_m, test_support::fine_around(test_support::kWavyMiddle, 0.06, 5000)),
      &image);
  return paging::PlanetFile::open(options.output);
}

// Two views of the planet's fine ground.
TexturePaperPlan small_plan() {
  const mars::LonLat place = mars::lon_lat(test_support::kWavyMiddle);
  TexturePaperPlan plan;
  plan.views = {{"above", {place.lon_deg, place.lat_deg, 80000, 40, -70, 0}},
                {"oblique", {place.lon_deg, place.lat_deg, 40000, 120, -25, 0}}};
  plan.width_px = 96;
  plan.height_px = 72;
  plan.rounds = 1;
  plan.memory_bytes = std::size_t{768} << 20;
  return plan;
}

class ReportTexture : public ::testing::Test {
 protected:
  test_support::TempDir dir_;
};

TEST_F(ReportTexture, ComparesTexturesWithLightOfVertices) {
  const auto planet = hilly_planet(dir_ / "p.vpe");
  const TexturePaperPlan plan = small_plan();
  int steps = 0;
  const TexturePaper paper = measure_texture_paper(plan, planet, dir_.path(), [&] { ++steps; });
  EXPECT_EQ(steps, count_texture_steps(plan));
  ASSERT_EQ(paper.tables.size(), 2U);
  const report::Table& all = paper.tables[0];
  ASSERT_EQ(all.rows.size(), 6U);
  EXPECT_NEAR(number(all, 2, "similarity"), 1, 1e-9);  // the textured image itself
  EXPECT_NEAR(number(all, 2, "triangles_to_full"), 1, 1e-9);
  EXPECT_NEAR(number(all, 0, "time_to_gouraud"), 1, 1e-9);
  for (std::size_t n = 0; n < all.rows.size(); ++n) {
    EXPECT_GT(number(all, n, "triangles"), 0);
    EXPECT_GT(number(all, n, "time_s"), 0);
    EXPECT_LE(number(all, n, "similarity_least"), number(all, n, "similarity"));
    if (n != 2) {
      EXPECT_LT(number(all, n, "similarity"), 1);
    }
  }
  for (std::size_t n = 0; n < 2; ++n) EXPECT_EQ(number(all, n, "triangles"), number(all, 2, "triangles"));
  // So small a planet has no coarser tiles for the smallest shares.
  for (std::size_t n = 3; n < 6; ++n) EXPECT_LT(number(all, n, "triangles_to_full"), 1);

  // The page says what the tables do.
  const report::Table& views = paper.tables[1];
  ASSERT_EQ(views.rows.size(), 12U);
  std::vector<double> gouraud, sixteenth, sixty_fourth;
  for (std::size_t view = 0; view < 2; ++view) {
    const auto similarity = [&](std::size_t n) { return number(views, 6 * view + n, "similarity"); };
    gouraud.push_back(std::max(similarity(0), similarity(1)));
    sixteenth.push_back(similarity(4));
    sixty_fourth.push_back(similarity(5));
  }
  const double aim = report::median(gouraud);
  const bool holds = report::median(sixteenth) >= aim && report::median(sixty_fourth) >= aim;
  const std::string& said = paper.section.paragraphs.back();
  EXPECT_NE(said.find("Aim: "), std::string::npos) << said;
  EXPECT_EQ(said.find(": holds.") != std::string::npos, holds) << said;
  EXPECT_EQ(said.find(": does not hold.") != std::string::npos, !holds) << said;
  ASSERT_EQ(paper.section.images.size(), 3U);
  for (const char* name : {"gouraud", "16", "64"}) {
    const core::RgbImage image = core::read_image(dir_ / ("environment-texture-" + std::string(name) + ".png"));
    EXPECT_EQ(image.width, 96) << name;
    EXPECT_EQ(image.height, 72) << name;
  }
}

// Rows are there, without figures.
TEST_F(ReportTexture, SaysWhyThereIsNothingToMeasure) {
  const auto expect_nothing = [&](const TexturePaperPlan& plan,
                                  const std::shared_ptr<const paging::PlanetFile>& planet, const char* why) {
    const TexturePaper paper = measure_texture_paper(plan, planet, dir_.path(), [] { FAIL(); });
    EXPECT_NE(paper.section.paragraphs.back().find(why), std::string::npos) << paper.section.paragraphs.back();
    ASSERT_EQ(paper.tables.size(), 2U);
    ASSERT_EQ(paper.tables[0].rows.size(), 6U);
    for (const auto& row : paper.tables[0].rows)
      for (std::size_t k = 1; k < row.size(); ++k) EXPECT_TRUE(std::holds_alternative<std::monostate>(row[k]));
    EXPECT_TRUE(paper.tables[1].rows.empty());
    EXPECT_TRUE(paper.section.images.empty());
  };
  const auto planet = hilly_planet(dir_ / "p.vpe");
  TexturePaperPlan none = small_plan();
  none.views.clear();
  expect_nothing(none, planet, "no views");
  const auto plain = test_support::build_fake(dir_ / "plain.vpe",
                                              test_support::FakeElevation(test_support::bumpy_height), 200000);
  expect_nothing(small_plan(), plain, "no imagery");
  const char* before = std::getenv("VPE_EGL");
  const std::string kept = before == nullptr ? "" : before;
  setenv("VPE_EGL", "device-that-nobody-has", 1);
  expect_nothing(small_plan(), planet, "no OpenGL");
  if (before == nullptr) {
    unsetenv("VPE_EGL");
  } else {
    setenv("VPE_EGL", kept.c_str(), 1);
  }
}

}  // namespace
}  // namespace vpe::app
