// A build whose disk is full, or whose source disappears, reports this and can be continued.
#include "paging/planet/planet_file.h"
#include "tests/app/support/app_fixture.h"

namespace app_test {
namespace {

namespace fs = std::filesystem;

class BuildFailure : public AppTest {
 protected:
  static std::string identity(const fs::path& planet) {
    return paging::PlanetFile::open(planet.string())->meta().identity;
  }

  // Runs a shell script whose folder `disk` is a file system of its own with this many bytes; `grow` in the
  // script enlarges it to 64 MB. Returns false where this process may not mount one.
  static bool can_mount(const fs::path& folder) {
    Command command;
    command.program = "/bin/sh";
    command.arguments = {"-c", "unshare -rm mount -t tmpfs -o size=64k none " + folder.string()};
    return app_test::run(command).exit_code == 0;
  }
  Result on_small_disk(const std::string& bytes, const std::string& script) const {
    fs::create_directory(dir_ / "disk");
    Command command =
        command_for({"-c", "unshare -rm sh -c 'mount -t tmpfs -o size=" + bytes +
                               " none disk && grow() { mount -o remount,size=64m disk; }; " + script + "'"});
    command.program = "/bin/sh";
    return app_test::run(command);
  }
};

TEST_F(BuildFailure, FullDisk) {
  fs::create_directory(dir_ / "probe");
  if (!can_mount(dir_ / "probe")) GTEST_SKIP() << "no file system can be mounted here";
  write_dem(dir_ / "x.tif");
  const std::string build = command_for({}).program.string() + " build x.tif --base-spacing 40000 -o ";
  ASSERT_EQ(vpe({"build", "x.tif", "--base-spacing", "40000", "-o", "whole.vpe"}).exit_code, 0);
  const auto size = fs::file_size(dir_ / "whole.vpe");
  // Too small for the tables, for the first tiles, and for the last ones.
  for (const std::uintmax_t bytes : {std::uintmax_t{16384}, size / 8, size * 9 / 10}) {
    SCOPED_TRACE(bytes);
    const Result result = on_small_disk(
        std::to_string(bytes),
        build +
            "disk/x.vpe; echo exit $?; test -e disk/x.vpe.part && echo kept; "
            // Tried again while something else has filled the rest of the disk.
            "cat /dev/zero > disk/log 2>/dev/null; sum() { cksum < disk/x.vpe.part 2>/dev/null; }; "
            "before=$(sum); " +
            build +
            "disk/x.vpe; test \"$before\" = \"$(sum)\" && echo same; "
            "rm disk/log; grow; " +
            build + "disk/x.vpe && cp disk/x.vpe . && ls disk");
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_TRUE(says(result.out, {"exit 1\n", "same\n"}));
    EXPECT_TRUE(says(result.err, {"disk/x.vpe.part", "disk is full", "free some space"}));
    // The message is true: either there is work to continue, and it is continued, or there is none.
    const bool kept = result.out.find("kept") != std::string::npos;
    EXPECT_EQ(result.err.find("the same command continues it") != std::string::npos, kept) << result.err;
    EXPECT_EQ(result.err.find("Continuing") != std::string::npos, kept) << result.err;
    EXPECT_EQ(result.err.find("damaged"), std::string::npos) << result.err;
    EXPECT_EQ(result.out.substr(result.out.size() - 6), "x.vpe\n") << result.out;
    EXPECT_EQ(identity(dir_ / "x.vpe"), identity(dir_ / "whole.vpe"));
    fs::remove(dir_ / "x.vpe");
  }
}

// The eastern half of a mosaic is on a disk that is missing for a while, or unreadable beyond some block.
TEST_F(BuildFailure, SourceDisappears) {
  Dem half;
  half.width = 90;
  half.height_m = [](int column, int row) { return 30.0 * ((column * 7 + row * 11) % 90); };
  write_dem(dir_ / "west.tif", half);
  half.west_deg = 0;
  write_dem(dir_ / "east.tif", half);
  Command mosaic = command_for({"-q", "m.vrt", "west.tif", "east.tif"});
  mosaic.program = find_program("gdalbuildvrt");
  ASSERT_EQ(run(mosaic).exit_code, 0);
  const Words build{"build", "m.vrt", "--base-spacing", "100000", "-o", "m.vpe"};
  ASSERT_EQ(vpe(build).exit_code, 0);
  const std::string whole = identity(dir_ / "m.vpe");
  fs::remove(dir_ / "m.vpe");

  fs::rename(dir_ / "east.tif", dir_ / "away.tif");
  Result result = vpe(build);
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_TRUE(says(result.err, {"m.vrt", "east.tif", "No such file"}));
  EXPECT_FALSE(exists("m.vpe"));

  const auto time = fs::last_write_time(dir_ / "away.tif");
  fs::copy_file(dir_ / "away.tif", dir_ / "east.tif");
  fs::resize_file(dir_ / "east.tif", fs::file_size(dir_ / "east.tif") / 2);
  fs::last_write_time(dir_ / "east.tif", time);
  result = vpe(build);
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_TRUE(says(result.err, {"m.vrt", "east.tif"}));
  EXPECT_FALSE(exists("m.vpe"));

  fs::rename(dir_ / "away.tif", dir_ / "east.tif");
  result = vpe(build);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(identity(dir_ / "m.vpe"), whole);
}

}  // namespace
}  // namespace app_test
