// Tests of the list of planet files.
#include "vpe/explore/files/planet_files.h"

#include <gtest/gtest.h>

#include <fstream>

#include "tests/support/support.h"

namespace vpe::explore {
namespace {

namespace fs = std::filesystem;

TEST(PlanetFiles, AreThoseOfAllFoldersByNameEachOnce) {
  const test_support::TempDir folder;
  const fs::path a = folder / "a";
  const fs::path b = folder / "b";
  fs::create_directories(a / "folder.vpe");
  fs::create_directories(b);
  for (const fs::path& file :
       {a / "moon.vpe", a / "dem.tif", b / "mars.vpe", b / "moon.vpe", b / "mars.vpe.part"})
    std::ofstream(file) << "-";
  const std::vector<fs::path> folders{a, b, a / "../b", {}, folder / "none"};
  EXPECT_EQ(planet_files(folders), (std::vector<fs::path>{b / "mars.vpe", a / "moon.vpe", b / "moon.vpe"}));
  EXPECT_TRUE(planet_files({}).empty());
}

TEST(PlanetFiles, AreNotTooMany) {
  const test_support::TempDir folder;
  for (std::size_t n = 0; n < kMostPlanets + 20; ++n)
    std::ofstream(folder / (std::to_string(1000 + n) + ".vpe")) << "-";
  const std::vector<fs::path> folders{folder.path()};
  const std::vector<fs::path> found = planet_files(folders);
  ASSERT_EQ(found.size(), kMostPlanets);
  EXPECT_EQ(found.front().filename(), "1000.vpe");
}

}  // namespace
}  // namespace vpe::explore
