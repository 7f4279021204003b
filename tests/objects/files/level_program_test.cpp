// Levels of detail made in a process of their own, their bytes, and such processes.
#include "objects/files/level_program.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>

#include <cmath>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <stdexcept>

#include "objects/files/child_limits.h"
#include "objects/files/child_process.h"
#include "objects/files/level_stream.h"
#include "objects/levels/mesh_levels.h"
#include "objects/model/shapes.h"
#include "tests/support/support.h"

namespace objects {
namespace {

using Bytes = std::vector<std::uint8_t>;

Mesh painted_rock() {
  Mesh mesh = make_rock(3, 3);
  mesh.uvs.assign(mesh.positions_m.size(), {0.5F, 0.25F});
  mesh.textures = {{1, 1, {{10, 20, 30, 255}}}};
  for (Material& m : mesh.material_table) m.texture = 0;
  return mesh;
}

Bytes bytes_of(const std::vector<MeshLevel>& levels) {
  Bytes out;
  write_level_stream(
      levels, [&](std::span<const std::uint8_t> piece) { out.insert(out.end(), piece.begin(), piece.end()); });
  return out;
}

void expect_equal(const std::vector<MeshLevel>& a, const std::vector<MeshLevel>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t n = 0; n < a.size(); ++n) {
    EXPECT_EQ(a[n].geometric_error_m, b[n].geometric_error_m);
    EXPECT_EQ(a[n].mesh.positions_m, b[n].mesh.positions_m);
    EXPECT_EQ(a[n].mesh.normals, b[n].mesh.normals);
    EXPECT_EQ(a[n].mesh.triangles, b[n].mesh.triangles);
    EXPECT_EQ(a[n].mesh.materials, b[n].mesh.materials);
    ASSERT_EQ(a[n].mesh.material_table.size(), b[n].mesh.material_table.size());
    for (std::size_t m = 0; m < a[n].mesh.material_table.size(); ++m)
      EXPECT_EQ(a[n].mesh.material_table[m].texture, b[n].mesh.material_table[m].texture);
    EXPECT_EQ(a[n].tree.bytes(), b[n].tree.bytes());
  }
}

TEST(LevelProgram, LevelsAreThoseOfThisProcess) {
  expect_equal(make_levels_apart(painted_rock()), make_levels(painted_rock()));
  expect_equal(make_levels_apart(make_box({1, 2, 3})), make_levels(make_box({1, 2, 3})));
}

class LevelProgramFaults : public ::testing::Test {
 protected:
  ~LevelProgramFaults() override { ::unsetenv("VPE_MODEL_LEVELS"); }

  // Returns what is said where the program is a script, and checks that the mesh is as before.
  std::string error_of(const std::string& script, const LevelProgramOptions& options = {}) {
    const std::filesystem::path file = folder_ / "program";
    std::ofstream(file) << "#!/bin/sh\n" << script << '\n';
    ::chmod(file.c_str(), 0700);
    ::setenv("VPE_MODEL_LEVELS", file.c_str(), 1);
    Mesh mesh = painted_rock();
    try {
      make_levels_apart(std::move(mesh), options);
    } catch (const std::runtime_error& error) {
      EXPECT_EQ(mesh.triangles, painted_rock().triangles);
      EXPECT_EQ(mesh.textures.size(), 1U);
      EXPECT_EQ(mesh.material_table.front().texture, 0);
      return error.what();
    }
    return "";
  }

  test_support::TempDir folder_;
};

TEST_F(LevelProgramFaults, EachIsSaid) {
  EXPECT_NE(error_of("exit 1").find("needs more memory"), std::string::npos);
  EXPECT_NE(error_of("exit 7").find("status 7"), std::string::npos);
  EXPECT_NE(error_of("kill -SEGV $$").find("signal 11"), std::string::npos);
  EXPECT_NE(error_of("kill -XCPU $$").find("more than 300 s"), std::string::npos);
  EXPECT_NE(error_of("echo hello, levels").find("no levels"), std::string::npos);
  EXPECT_NE(error_of("exit 0").find("end early"), std::string::npos);
  EXPECT_NE(error_of("head -c 300000000 /dev/zero", {.memory_gb = 0.25}).find("too much memory"),
            std::string::npos);
  ::setenv("VPE_MODEL_LEVELS", "/nonexistent", 1);
  EXPECT_EQ(model_levels_program(), "");
  EXPECT_THROW(make_levels_apart(painted_rock()), std::runtime_error);
}

TEST_F(LevelProgramFaults, OptionsOutOfRangeAreRefused) {
  EXPECT_THROW(make_levels_apart(painted_rock(), {.memory_gb = 0}), std::invalid_argument);
  EXPECT_THROW(make_levels_apart(painted_rock(), {.time_s = 0.5}), std::invalid_argument);
  EXPECT_THROW(make_levels_apart(painted_rock(), {.memory_gb = std::nan("")}), std::invalid_argument);
}

// Each byte is damaged in turn: what is returned is sound, or an error is thrown and the mesh is as before.
TEST(LevelStream, DamagedBytesAreErrorsOrSoundLevels) {
  const Mesh finest = make_box({1, 2, 3});
  std::vector<MeshLevel> levels(1);
  levels.front().mesh = finest;
  MeshLevel coarse;
  coarse.mesh = make_box({1, 2, 3.5F});
  coarse.geometric_error_m = 0.5;
  levels.push_back(coarse);
  const Bytes good = bytes_of(levels);
  {
    Mesh mesh = finest;
    const std::vector<MeshLevel> got = read_level_stream(good, std::move(mesh));
    ASSERT_EQ(got.size(), 2U);
    EXPECT_EQ(got[1].mesh.positions_m, coarse.mesh.positions_m);
    EXPECT_EQ(got[1].geometric_error_m, 0.5);
  }
  int errors = 0;
  const auto check_bytes = [&](const Bytes& bytes) {
    Mesh mesh = finest;
    try {
      for (const MeshLevel& level : read_level_stream(bytes, std::move(mesh))) EXPECT_EQ(check(level.mesh), "");
    } catch (const std::runtime_error&) {
      ++errors;
      EXPECT_EQ(mesh.triangles, finest.triangles);
    }
  };
  for (std::size_t at = 0; at < good.size(); ++at) {
    Bytes bad = good;
    bad[at] = static_cast<std::uint8_t>(bad[at] ^ 0xA5U);
    check_bytes(bad);
    check_bytes({good.begin(), good.begin() + static_cast<std::ptrdiff_t>(at)});
  }
  EXPECT_GE(errors, static_cast<int>(good.size()));
  Bytes longer = good;
  longer.push_back(0);
  check_bytes(longer);
  EXPECT_GE(errors, static_cast<int>(good.size()) + 1);
}

TEST(LevelStream, ErrorsMustAscend) {
  std::vector<MeshLevel> levels(3);
  for (MeshLevel& level : levels) level.mesh = make_box({1, 1, 1});
  levels[1].geometric_error_m = 0.5;
  for (const double wrong : {0.5, 0.1, std::nan(""), -1.0, std::numeric_limits<double>::infinity()}) {
    levels[2].geometric_error_m = wrong;
    EXPECT_THROW(read_level_stream(bytes_of(levels), make_box({1, 1, 1})), std::runtime_error) << wrong;
  }
}

TEST(ChildProcess, InputComesBackFromCat) {
  Bytes input(3'000'000);
  for (std::size_t n = 0; n < input.size(); ++n) input[n] = static_cast<std::uint8_t>(n * 7);
  const ChildOutput output = run_child({"/bin/cat"}, input, std::size_t{1} << 30);
  EXPECT_EQ(output.bytes, input);
  EXPECT_EQ(output.status, 0);
  EXPECT_TRUE(run_child({"/bin/cat"}, {}, 100).bytes.empty());
  // One that reads nothing does not stop this process.
  EXPECT_EQ(WEXITSTATUS(run_child({"/bin/false"}, input, 100).status), 1);
  EXPECT_TRUE(run_child({"/bin/cat"}, input, 1000).was_too_long);
  EXPECT_THROW(run_child({"/nonexistent/program"}, {}, 100), std::system_error);
}

TEST(ChildProcess, TextsAndNumbers) {
  EXPECT_EQ(number_text(0.1), "0.1");
  EXPECT_EQ(number_of("0.1"), 0.1);
  EXPECT_TRUE(std::isnan(number_of("0.1x")));
  EXPECT_TRUE(std::isnan(number_of("")));
  EXPECT_EQ(signal_text(SIGSEGV), "11 (Segmentation fault)");
  EXPECT_EQ(child_program("no-such-program-of-vpe", "NO_SUCH_VARIABLE_OF_VPE"), "");
}

TEST(ChildProcess, LimitsHoldAndOutputIsSent) {
  ::testing::GTEST_FLAG(death_test_style) = "threadsafe";
  EXPECT_EXIT(
      {
        limit_this_process(64, 1);
        for (volatile bool runs = true; runs;) {
        }
      },
      ::testing::KilledBySignal(SIGXCPU), "");
  EXPECT_TRUE(send_output({}));
}

}  // namespace
}  // namespace objects
