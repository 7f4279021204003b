// Help, version and wrong usage.
#include "tests/app/support/app_fixture.h"

namespace app_test {
namespace {

class Usage : public AppTest {};

const Words kCommands{"build", "info", "query", "render", "fly", "settings"};

TEST_F(Usage, HelpAndVersion) {
  const Result all = vpe({"--help"});
  EXPECT_EQ(all.exit_code, 0);
  EXPECT_TRUE(says(all.out, kCommands));
  EXPECT_EQ(all.err, "");
  for (const std::string& command : kCommands) {
    const Result one = vpe({command, "--help"});
    EXPECT_EQ(one.exit_code, 0) << command;
    EXPECT_TRUE(says(one.out, {"vpe " + command, "--memory", "--threads", "--config"}));
  }
  const Result version = vpe({"--version"});
  EXPECT_EQ(version.exit_code, 0);
  EXPECT_EQ(version.out.find("vpe "), 0U);
  EXPECT_NE(version.out.find_first_of("0123456789"), std::string::npos);
}

TEST_F(Usage, CommandsAndOptions) {
  expect_failure({}, 2, {"subcommand is required", "--help"});
  expect_failure({"frobnicate"}, 2, {"unknown command 'frobnicate'", "build", "query", "settings"});
  expect_failure({"info", "--bogus"}, 2, {"not expected", "--bogus"});
  expect_failure({"info", "--bogus", "x.vpe", "y.vpe"}, 2, {"--bogus"});
  expect_failure({"build", "-o", "x.vpe"}, 2, {"DEM is required"});
  expect_failure({"build", "x.tif"}, 2, {"--output is required"});
  expect_failure({"render", "x.vpe", "-o", "x.png"}, 2, {"--pose is required"});
  expect_failure({"render", "x.vpe", "--pose", "0,0,1"}, 2, {"--output is required"});
  expect_failure({"fly", "-o", "x"}, 2, {"FLIGHT is required"});
  expect_failure({"info", "--memory", "63"}, 2, {"--memory", "63", "64"});
  expect_failure({"info", "--threads", "-1"}, 2, {"--threads", "-1"});
  expect_failure({"render", "x.vpe", "--pose", "0,0,1", "-o", "x.png", "--backend", "magic"}, 2,
                 {"--backend", "magic", "polygon", "ray"});
}

TEST_F(Usage, Places) {
  const std::string p = planet().string();
  expect_failure({"query", p, "0,91"}, 2, {"'0,91'", "latitude", "-90 to 90"});
  expect_failure({"query", p, "0,-90.001"}, 2, {"latitude"});
  expect_failure({"query", p, "nan,0"}, 2, {"'nan,0'", "LON,LAT"});
  expect_failure({"query", p, "0,inf"}, 2, {"'0,inf'", "LON,LAT"});
  expect_failure({"query", p, "1,2,3"}, 2, {"'1,2,3'", "LON,LAT"});
  expect_failure({"query", p, "1,2", "there"}, 2, {"'there'", "LON,LAT"});
  expect_failure({"query", "nan,0"}, 2, {"'nan,0'", "neither a file nor a place"});
  expect_failure({"query", "0,91"}, 2, {"latitude"});
}

class ImageUsage : public Usage {
 protected:
  // Wrong usage is reported although the planet does not exist: nothing was done before.
  void expect_usage(const Words& more, const Words& parts, const std::string& pose = "0,0,300000") const {
    Words arguments{"render", "missing.vpe", "-o", "x.png", "--pose", pose};
    arguments.insert(arguments.end(), more.begin(), more.end());
    expect_failure(arguments, 2, parts);
    EXPECT_FALSE(exists("x.png"));
  }
};

TEST_F(ImageUsage, Pose) {
  expect_usage({}, {"--pose 'nan,0,1'", "LON,LAT,ALT"}, "nan,0,1");
  expect_usage({}, {"--pose '0,0,inf'", "LON,LAT,ALT"}, "0,0,inf");
  expect_usage({}, {"--pose '0,91,1'", "latitude", "-90..90"}, "0,91,1");
  expect_usage({}, {"--pose '0,0'", "LON,LAT,ALT"}, "0,0");
  expect_usage({}, {"--pose '0,0,1,2,3,4,5'", "LON,LAT,ALT"}, "0,0,1,2,3,4,5");
  expect_usage({}, {"--pose ''", "LON,LAT,ALT"}, "");
  expect_usage({}, {"--pose '0,0,1e17'", "ALT", "1000000000000000 m"}, "0,0,1e17");
  expect_usage({"--height", "nan"}, {"--height", "'nan'"});
}

TEST_F(ImageUsage, InterestAndLevelControl) {
  for (const char* bad :
       {"", "1", "1,2,3", "1,2,3,4,5", "nan,0,1,1", "361,0,1,1", "0,91,1,1", "0,0,-1,1", "0,0,1e9,1",
        "0,0,inf,1", "0,0,1,31", "0,0,1,-31", "0,0,1,0.5", "0,0,1,+", "0;0;1;1"}) {
    expect_usage({"--interest", bad}, {"--interest '" + std::string(bad) + "'", "LON,LAT,RADIUS,LEVELS"});
    expect_failure({"fly", "missing.flight", "--interest", bad, "-o", "x"}, 2, {"--interest"});
  }
  expect_usage({"--set", "lod.metric=1992"}, {"lod.metric=1992", "error, distance"});
  expect_usage({"--set", "lod.distance.scale=-1"}, {"lod.distance.scale", "0 to 1000000000000 m"});
  expect_usage({"--set", "lod.centre.weight=101"}, {"lod.centre.weight", "0 to 100"});
  expect_usage({"--set", "lod.centre.table=1:2,1:3"}, {"lod.centre.table", "X:LEVELS"});
  expect_usage({"--set", "lod.frame_ms=fast"}, {"lod.frame_ms", "10000 ms"});
  expect_usage({"--set", "lod.center.scale=1"}, {"did you mean", "lod.centre.scale"});
}

TEST_F(ImageUsage, CullFrom) {
  for (const char* pose : {"", "0,0", "nan,0,1", "0,0,1,2,3,4,5"}) {
    expect_usage({"--cull-from", pose}, {"--cull-from '" + std::string(pose) + "'", "LON,LAT,ALT"});
  }
  expect_usage({"--cull-from", "0,91,1"}, {"--cull-from '0,91,1'", "latitude", "-90..90"});
  expect_usage({"--cull-from", "0,0,1e17"}, {"--cull-from '0,0,1e17'", "ALT", "1000000000000000 m"});
}

TEST_F(ImageUsage, SizeAndFieldOfView) {
  for (const char* size : {"0x0", "640x0", "100000x100000", "axb", "640", "-1x5", "6.5x3"}) {
    expect_usage({"--size", size}, {"--size '" + std::string(size) + "'", "WIDTHxHEIGHT", "1..32768"});
  }
  for (const char* fov : {"0", "180", "-20", "nan", "wide"}) {
    expect_usage({"--fov", fov}, {"--fov", "'" + std::string(fov) + "'", "0.001 .. 179"});
  }
}

TEST_F(ImageUsage, Settings) {
  expect_usage({"--set", "lod.tolerence=3"},
               {"--set lod.tolerence=3", "unknown", "did you mean lod.tolerance?"});
  expect_usage({"--set", "mode"}, {"--set mode", "="});
  expect_usage({"--set", "mode=pretty"}, {"--set mode=pretty", "wireframe", "textured"});
  expect_usage({"--set", "exaggeration=nan"}, {"--set exaggeration=nan", "number", "100"});
  expect_usage({"--set", "mode=lit", "--set", "exaggeration=1e9"}, {"--set exaggeration=1e9", "100"});
  expect_usage({"--set", "palette=rainbow"}, {"palette=rainbow", "no palette and no file", "viridis", "turbo"});
  expect_usage({"--set", "sun=noon"}, {"--set sun=noon", "neither local nor a date", "2026-11-20T12:00Z"});
  expect_usage({"--sun", "2026-02-30"}, {"--sun", "no such day", "Ls90,15:00"});
  for (const char* tolerance : {"nan", "-1", "1001"})
    expect_usage({"--tolerance", tolerance}, {"--tolerance", tolerance});
}

TEST_F(Usage, Build) {
  write_dem(dir_ / "x.tif");
  for (const char* region : {"1,2,3", "0,nan,3,5", "0,5,3,5", "0,0,3,91"}) {
    expect_failure({"build", "x.tif", "-o", "x.vpe", "--region", region}, 2,
                   {"--region '" + std::string(region) + "'"});
  }
  for (const char* option : {"--spacing", "--base-spacing", "--radius"}) {
    expect_failure({"build", "x.tif", "-o", "x.vpe", option, "nan"}, 2, {option, "'nan'", "number"});
    expect_failure({"build", "x.tif", "-o", "x.vpe", option, "-5"}, 2, {option, "'-5'", "number"});
  }
  const std::string before = read_text(dir_ / "x.tif");
  expect_failure({"build", "x.tif", "-o", "x.tif"}, 2, {"-o x.tif", "input", "another name"});
  expect_failure({"build", "x.tif", "-o", "./x.tif"}, 2, {"input"});
  EXPECT_EQ(read_text(dir_ / "x.tif"), before);
  EXPECT_FALSE(exists("x.vpe"));
}

TEST_F(Usage, Frames) {
  write_text(dir_ / "f.flight", small_flight());
  for (const char* frames : {"5-2", "a-b", "0-20", "0-5x0", "1-", "0-5x"}) {
    expect_failure({"fly", "f.flight", "missing.vpe", "-o", "frames", "--frames", frames}, 2,
                   {"--frames '" + std::string(frames) + "'", "A-BxN", "0-19"});
  }
  EXPECT_FALSE(exists("frames"));
}

}  // namespace
}  // namespace app_test
