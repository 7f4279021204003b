// Volumes of OpenVDB files, where the program is built with that library.
#ifdef VPE_MAKE_VDB

#include <gtest/gtest.h>

#include <cstdlib>

#include "objects/files/volume_model_file.h"
#include "objects/volumes/volume_march.h"
#include "tests/support/support.h"
#include "vpe/base/file.h"

namespace objects {
namespace {

class VolumeVdb : public testing::Test {
 protected:
  std::filesystem::path made(const std::string& kind) const {
    const std::filesystem::path path = folder_ / (kind + ".vdb");
    const std::string command = std::string(VPE_MAKE_VDB) + " " + kind + " '" + path.string() + "'";
    EXPECT_EQ(std::system(command.c_str()), 0) << command;
    return path;
  }
  std::string refused(const std::string& kind) const {
    try {
      (void)read_volume_model(made(kind));
      return "";
    } catch (const vpe::base::FileError& error) {
      EXPECT_NE(std::string(error.what()).find(kind + ".vdb"), std::string::npos) << error.what();
      return error.what();
    }
  }

  ::test_support::TempDir folder_;
};

// The file has x to the left, y up and z forward; voxels lie from (-1, 0.5, 0) to (3.75, 2.75, 1.25).
TEST_F(VolumeVdb, HasTheDensityOfTheFile) {
  const VolumeModel model = read_volume_model(made("fog"));
  EXPECT_NEAR(extinction_per_m(model.levels()[0], {-1, 0.5, 1}), 0.5, 0.003);
  EXPECT_EQ(extinction_per_m(model.levels()[0], {2, 0.5, 1}), 0);
  EXPECT_EQ(extinction_per_m(model.levels()[0], {-1, 3, 1}), 0);
  const VolumeRay across{{-1, -10, 1.2}, {0, 1, 0}};
  EXPECT_NEAR(optical_depth(model.levels()[0], across, 0, 100), 6 * 0.25 * 0.5, 1e-3);
  const VolumeRay upward{{-1, 0.6, -10}, {0, 0, 1}};
  EXPECT_NEAR(optical_depth(model.levels()[0], upward, 0, 100), 10 * 0.25 * 0.5, 1e-3);
}

// Units change the size, and not the look.
TEST_F(VolumeVdb, TakesUnitsAndAxes) {
  const std::filesystem::path path = made("fog");
  const VolumeModel large = read_volume_model(path, {.unit_m = 10, .up = UpAxis::kZ});
  EXPECT_NEAR(extinction_per_m(large.levels()[0], {10, 10, 10}), 0.05, 0.0003);
  const VolumeRay along{{-100, 10, 8}, {1, 0, 0}};
  EXPECT_NEAR(optical_depth(large.levels()[0], along, 0, 1000), 20 * 0.25 * 0.5, 2e-3);
}

TEST_F(VolumeVdb, RefusesWhatIsNoVolume) {
  EXPECT_NE(refused("surface").find("level set"), std::string::npos);
  EXPECT_NE(refused("whole").find("no grid of floats"), std::string::npos);
  EXPECT_NE(refused("empty").find("empty"), std::string::npos);
}

TEST_F(VolumeVdb, DamagedFilesAreErrors) {
  const std::filesystem::path path = made("fog");
  const std::vector<std::uint8_t> whole = vpe::base::read_file(path, 1U << 20);
  for (std::size_t n = 1; n < 12; ++n) {
    std::vector<std::uint8_t> bytes = whole;
    if (n % 2 == 0) {
      bytes.resize(bytes.size() * n / 12);
    } else {
      for (std::size_t at = n * 7; at < bytes.size(); at += 97)
        bytes[at] = static_cast<std::uint8_t>(bytes[at] ^ 0x55);
    }
    vpe::base::write_file(path, bytes);
    try {
      const VolumeModel model = read_volume_model(path, {.memory_gb = 1, .time_s = 20});
      EXPECT_EQ(check(model.levels()[0]), "");
    } catch (const vpe::base::FileError& error) {
      EXPECT_NE(std::string(error.what()).find("fog.vdb"), std::string::npos) << error.what();
    }
  }
}

}  // namespace
}  // namespace objects

#endif
