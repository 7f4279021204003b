// Levels of models in the user's cache.
#include "vpe/app/scene/level_cache.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <iterator>

#include "objects/levels/mesh_levels.h"
#include "objects/model/shapes.h"
#include "objects/scene/model.h"
#include "tests/support/support.h"

namespace {

using objects::Model;
using vpe::app::KeptLevels;

constexpr std::size_t kLeastTriangles = 2000;

class LevelCache : public ::testing::Test {
 protected:
  static objects::Mesh large() {
    objects::Mesh mesh = objects::make_ellipsoid({1, 2, 1}, 49);
    EXPECT_GT(mesh.triangles.size(), kLeastTriangles);
    return mesh;
  }
  static KeptLevels cached_levels(objects::Mesh mesh, const std::filesystem::path& folder) {
    return vpe::app::cached_levels(std::move(mesh), folder, kLeastTriangles);
  }

  std::vector<std::filesystem::path> files() const {
    std::vector<std::filesystem::path> out;
    if (!std::filesystem::exists(folder())) return out;
    for (const auto& entry : std::filesystem::directory_iterator(folder())) out.push_back(entry.path());
    return out;
  }

  std::filesystem::path folder() const { return dir_ / "models"; }

  static void expect_equal(const std::vector<Model::Level>& a, const std::vector<Model::Level>& b) {
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t n = 0; n < a.size(); ++n) {
      EXPECT_EQ(a[n].geometric_error_m, b[n].geometric_error_m);
      EXPECT_EQ(a[n].mesh.positions_m, b[n].mesh.positions_m);
      EXPECT_EQ(a[n].mesh.triangles, b[n].mesh.triangles);
      EXPECT_EQ(a[n].mesh.materials, b[n].mesh.materials);
      EXPECT_EQ(a[n].mesh.material_table.size(), b[n].mesh.material_table.size());
      EXPECT_EQ(a[n].tree.bytes(), b[n].tree.bytes());
    }
  }

  test_support::TempDir dir_;
};

TEST_F(LevelCache, TheSecondTimeLevelsAreThoseOfTheFirst) {
  const auto made = cached_levels(large(), folder()).levels;
  ASSERT_EQ(files().size(), 1U);
  expect_equal(made, objects::make_levels(large()));
  const auto stamp = std::filesystem::last_write_time(files().front());
  expect_equal(cached_levels(large(), folder()).levels, made);
  EXPECT_EQ(std::filesystem::last_write_time(files().front()), stamp);
}

TEST_F(LevelCache, TexturesAreThoseOfTheModel) {
  objects::Mesh mesh = large();
  mesh.uvs.assign(mesh.positions_m.size(), {0.5F, 0.5F});
  mesh.textures = {{1, 1, {{10, 20, 30, 255}}}};
  for (objects::Material& m : mesh.material_table) m.texture = 0;
  (void)cached_levels(mesh, folder());
  const Model model("m", cached_levels(mesh, folder()).levels);
  ASSERT_GT(model.levels().size(), 1U);
  EXPECT_EQ(model.levels().back().mesh.material_table[0].texture, 0);
  EXPECT_EQ(model.textures().size(), 1U);
}

TEST_F(LevelCache, DamagedFilesAreMadeAgain) {
  const auto made = cached_levels(large(), folder()).levels;
  const std::filesystem::path file = files().front();
  std::ifstream in(file, std::ios::binary);
  const std::string good{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  for (const std::size_t keep : {std::size_t{7}, good.size() - 1}) {
    std::ofstream(file, std::ios::binary) << good.substr(0, keep);
    expect_equal(cached_levels(large(), folder()).levels, made);
  }
  std::string bad = good;
  bad[good.size() / 3] = static_cast<char>(bad[good.size() / 3] ^ 4);
  std::ofstream(file, std::ios::binary) << bad;
  expect_equal(cached_levels(large(), folder()).levels, made);
}

TEST_F(LevelCache, SmallMeshesAndMissingFoldersAreNoTrouble) {
  EXPECT_GE(cached_levels(objects::make_box({1, 1, 1}), folder()).levels.size(), 1U);
  EXPECT_TRUE(files().empty());
  EXPECT_GT(cached_levels(large(), {}).levels.size(), 1U);
  std::ofstream(dir_ / "file") << "x";
  EXPECT_GT(cached_levels(large(), dir_ / "file").levels.size(), 1U);  // no folder can be made there
}

TEST_F(LevelCache, ModelsOfTwentyThousandTrianglesAreKept) {
  (void)vpe::app::cached_levels(large(), folder());
  EXPECT_TRUE(files().empty());
  objects::Mesh mesh = objects::make_ellipsoid({1, 2, 1}, 145);
  ASSERT_EQ(mesh.triangles.size(), 20'590U);
  EXPECT_GT(vpe::app::cached_levels(std::move(mesh), folder()).levels.size(), 1U);
  EXPECT_EQ(files().size(), 1U);
}

TEST_F(LevelCache, WithoutTheProgramThereIsTheFinestLevelAndANote) {
  ASSERT_EQ(::setenv("VPE_MODEL_LEVELS", "/nonexistent", 1), 0);
  const KeptLevels made = cached_levels(large(), folder());
  ::unsetenv("VPE_MODEL_LEVELS");
  EXPECT_TRUE(files().empty());
  EXPECT_NE(made.note.find("vpe-model-levels is missing"), std::string::npos) << made.note;
  ASSERT_EQ(made.levels.size(), 1U);
  EXPECT_EQ(made.levels.front().mesh.triangles, large().triangles);
  EXPECT_EQ(made.levels.front().tree.bytes(), objects::TriangleTree(large()).bytes());
}

}  // namespace
