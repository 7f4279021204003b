// Flights to frames and to videos.
#include <algorithm>
#include <csignal>
#include <sstream>

#include "tests/app/support/app_fixture.h"
#include "vpe/core/image/image.h"

namespace app_test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

class Fly : public AppTest {
 protected:
  void SetUp() override { write_text(dir_ / "f.flight", small_flight()); }
  Result fly(const std::string& output, const Words& more = {}, const std::string& flight = "f.flight") const {
    Words words{"fly", flight, planet().string(), "-o", output};
    words.insert(words.end(), more.begin(), more.end());
    return vpe(words);
  }
  std::vector<std::string> names(const std::string& folder) const {
    std::vector<std::string> out;
    for (const auto& entry : fs::directory_iterator(dir_ / folder)) {
      const std::string name = entry.path().filename().string();
      if (!name.starts_with("manifest.")) out.push_back(name);
    }
    std::sort(out.begin(), out.end());
    return out;
  }
};

TEST_F(Fly, RegionsOfInterestAreDrawnAndLogged) {
  const auto triangles = [&](const std::string& csv) {
    std::istringstream in(read_text(dir_ / csv));
    std::string line;
    std::getline(in, line);
    const auto column =
        std::count(line.begin(), line.begin() + static_cast<std::ptrdiff_t>(line.find("triangles")), ',');
    std::vector<long> all;
    while (std::getline(in, line)) {
      std::istringstream row(line);
      std::string cell;
      for (std::ptrdiff_t c = 0; c <= column; ++c) std::getline(row, cell, ',');
      all.push_back(std::stol(cell));
    }
    return all;
  };
  ASSERT_EQ(fly("plain", {"--stats", "plain.csv", "--backend", "polygon"}).exit_code, 0);
  // In the second half the planet is finer; the regions of the option count from the start.
  std::string text = small_flight();
  const std::size_t end = text.find("at 2 pose");
  ASSERT_NE(end, std::string::npos) << text;
  text.insert(end, "at 1 interest lon=0 lat=0 radius=1e8 levels=3\n");
  write_text(dir_ / "i.flight", text);
  ASSERT_EQ(fly("finer", {"--stats", "finer.csv", "--log", "l.flight", "--interest", "0,0,1e8,-2"}, "i.flight")
                .exit_code,
            0);
  const std::vector<long> plain = triangles("plain.csv");
  const std::vector<long> finer = triangles("finer.csv");
  ASSERT_EQ(plain.size(), 20U);
  ASSERT_EQ(finer.size(), 20U);
  EXPECT_LT(finer.front(), plain.front());
  EXPECT_GT(finer.back(), plain.back());
  EXPECT_TRUE(says(read_text(dir_ / "l.flight"), {"at 0 interest lon=0 lat=0 radius=100000000 levels=-2",
                                                  "at 1 interest lon=0 lat=0 radius=100000000 levels=3"}));
  // The log gives the same frames by itself.
  ASSERT_EQ(fly("again", {}, "l.flight").exit_code, 0);
  for (const std::string& name : names("finer")) {
    EXPECT_EQ(read_text(dir_ / "again" / name), read_text(dir_ / "finer" / name)) << name;
  }
}

TEST_F(Fly, FramesStatsAndLog) {
  const Result result = fly("a/b", {"--json", "--stats", "s.csv", "--log", "l.flight"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const json report = parse_json(result.out);
  EXPECT_EQ(report["frames"], 20);
  EXPECT_EQ(report["output"], "a/b");
  EXPECT_GT(report["shift_bound_px"], 0);
  EXPECT_LE(report["shift_bound_px"], 1.01);
  Words expected;
  for (int k = 0; k < 20; ++k)
    expected.push_back("frame_0000" + std::string(k < 10 ? "0" : "") + std::to_string(k) + ".png");
  EXPECT_EQ(names("a/b"), expected);
  const auto frame = vpe::core::read_image(dir_ / "a/b/frame_000007.png");
  EXPECT_EQ(frame.width, 96);
  EXPECT_EQ(frame.height, 54);
  EXPECT_NE(read_text(dir_ / "a/b/frame_000000.png"), read_text(dir_ / "a/b/frame_000019.png"));
  const std::string csv = read_text(dir_ / "s.csv");
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 21);
  EXPECT_EQ(csv.find("frame,t_s,"), 0U);

  // The log is a flight that gives the same frames.
  const Result again = fly("again", {"--quiet"}, "l.flight");
  ASSERT_EQ(again.exit_code, 0) << again.err;
  EXPECT_EQ(again.out + again.err, "");
  for (const std::string& name : expected) {
    EXPECT_EQ(read_text(dir_ / "again" / name), read_text(dir_ / "a/b" / name)) << name;
  }
}

TEST_F(Fly, SomeFrames) {
  ASSERT_EQ(fly("all").exit_code, 0);
  ASSERT_EQ(fly("some", {"--frames", "3-15x4", "--stats", "s.jsonl"}).exit_code, 0);
  EXPECT_EQ(names("some"),
            (Words{"frame_000003.png", "frame_000007.png", "frame_000011.png", "frame_000015.png"}));
  // A frame does not depend on those before it.
  for (const std::string& name : names("some")) {
    EXPECT_EQ(read_text(dir_ / "some" / name), read_text(dir_ / "all" / name)) << name;
  }
  std::istringstream lines(read_text(dir_ / "s.jsonl"));
  std::vector<int> frames;
  for (std::string line; std::getline(lines, line);) {
    const json row = parse_json(line);
    frames.push_back(row["frame"]);
    EXPECT_NEAR(row["t_s"].get<double>(), frames.back() / 10.0, 1e-12);
    EXPECT_GT(row["tiles_drawn"], 0);
  }
  EXPECT_EQ(frames, (std::vector<int>{3, 7, 11, 15}));
  ASSERT_EQ(fly("one", {"--frames", "19", "--size", "40x30"}).exit_code, 0);
  EXPECT_EQ(names("one"), Words{"frame_000019.png"});
  EXPECT_EQ(vpe::core::read_image(dir_ / "one/frame_000019.png").width, 40);
}

TEST_F(Fly, Video) {
  if (find_program("ffmpeg").empty() || find_program("ffprobe").empty())
    GTEST_SKIP() << "skipped: no ffmpeg, ffprobe";
  write_text(dir_ / "v.flight", small_flight("fov=50 size=96x54 fps=30"));
  const std::string name = "Film über Höhen.mp4";
  const Result result = fly(name, {"--frames", "0-24"}, "v.flight");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(leftovers(), Words{});
  Command probe;
  probe.program = find_program("ffprobe");
  probe.arguments = {"-v", "error", "-count_frames", "-of", "json", "-show_streams", path(name)};
  const json streams = parse_json(run(probe).out)["streams"];
  ASSERT_EQ(streams.size(), 1U);
  EXPECT_EQ(streams[0]["nb_read_frames"], "25");
  EXPECT_EQ(streams[0]["r_frame_rate"], "30/1");
  EXPECT_EQ(streams[0]["width"], 96);
  EXPECT_EQ(streams[0]["height"], 54);
  EXPECT_EQ(streams[0]["pix_fmt"], "yuv420p");
}

class FlySignals : public Fly {
 protected:
  void SetUp() override {
    Fly::SetUp();
    // Ten thousand frames: only the signal ends it. The first segment of a video has 40 of them.
    write_text(dir_ / "long.flight",
               "flight 1\nview size=96x54 fps=10\nat 0 pose lon=0 lat=0 alt=500000 pitch=-40\n"
               "at 1000 pose lon=90 lat=0 alt=500000 pitch=-40\n");
  }
  Result stop(const Words& arguments, int signal, std::function<bool()> when) const {
    Command command = command_for(arguments);
    command.signal = signal;
    command.when = std::move(when);
    return run(command);
  }
};

TEST_F(FlySignals, WhileFramesAreDrawn) {
  for (const auto& [signal, code] : {std::pair{SIGINT, 130}, std::pair{SIGTERM, 143}}) {
    const std::string out = "out" + std::to_string(code);
    const Result result = stop({"fly", "long.flight", planet().string(), "-o", out, "--json"}, signal,
                               [&] { return exists(out + "/frame_000005.png"); });
    EXPECT_TRUE(result.signalled);
    EXPECT_EQ(result.exit_code, code) << "signal " << result.signal;
    EXPECT_TRUE(says(result.err, {"stopped"}));
    EXPECT_EQ(result.out, "");
    EXPECT_EQ(leftovers(), Words{});
    // Existing frames are whole.
    const std::vector<std::string> frames = names(out);
    EXPECT_GE(frames.size(), 6U);
    for (const std::string& name : frames)
      EXPECT_EQ(vpe::core::read_image(dir_ / out / name).width, 96) << name;
  }
}

TEST_F(FlySignals, WhileAVideoIsMade) {
  if (find_program("ffmpeg").empty()) GTEST_SKIP() << "skipped: no ffmpeg";
  const std::string old = "    ftyp: the old film";
  write_text(dir_ / "old.mp4", old);
  write_text(dir_ / "old.mp4.json", "{\n\"program\": \"vpe 0.1.0\"\n}\n");
  for (const auto& [signal, code] : {std::pair{SIGINT, 130}, std::pair{SIGTERM, 143}}) {
    for (const char* name : {"new.mp4", "old.mp4"}) {
      const Result result =
          stop({"fly", "long.flight", planet().string(), "-o", name, "--stats", "s.csv"}, signal,
               [&] { return exists(std::string(name) + ".parts/segment_000000.json"); });
      EXPECT_TRUE(result.signalled);
      EXPECT_EQ(result.exit_code, code) << "signal " << result.signal;
      EXPECT_TRUE(says(result.err, {"stopped", "of 10000 frames are there", "the same command continues"}));
      // Whole segments stay for the next run; nothing half-written does.
      EXPECT_EQ(leftovers(), Words{std::string(name) + ".parts"});
      fs::remove_all(dir_ / (std::string(name) + ".parts"));
      EXPECT_FALSE(exists("s.csv"));
    }
  }
  EXPECT_FALSE(exists("new.mp4"));
  EXPECT_EQ(read_text(dir_ / "old.mp4"), old);
}

TEST_F(Fly, FfmpegThatFails) {
  // Simulates a full disk or an ffmpeg without an encoder.
  fs::create_directory(dir_ / "bin");
  write_text(dir_ / "bin/ffmpeg", "#!/bin/sh\necho 'Unknown encoder' >&2\nexit 3\n");
  fs::permissions(dir_ / "bin/ffmpeg", fs::perms::owner_all);
  Command command = command_for({"fly", "f.flight", planet().string(), "-o", "x.mp4"});
  command.environment["PATH"] = path("bin");
  const Result result = run(command);
  EXPECT_EQ(result.exit_code, 1) << "signal " << result.signal;
  EXPECT_TRUE(says(result.err, {"x.mp4", "ffmpeg reports: Unknown encoder", "folder to get PNG frames"}));
  EXPECT_EQ(leftovers(), Words{});
  EXPECT_FALSE(exists("x.mp4"));
}

TEST_F(Fly, FramesThatCannotBeWritten) {
  // A folder where a frame belongs.
  fs::create_directories(dir_ / "out/frame_000004.png/x");
  const Result result = fly("out");
  EXPECT_EQ(result.exit_code, 1) << "signal " << result.signal;
  EXPECT_TRUE(says(result.err, {"out/frame_000004.png", "cannot", "directory"}));
  EXPECT_EQ(leftovers(), Words{});
}

TEST_F(Fly, FailsBeforeDrawingWhereItPassesBelowTheGround) {
  write_text(dir_ / "low.flight",
             "flight 1\nview size=32x18 fps=10\nat 0 pose lon=-149 lat=0 alt=20000\nat 1 pose lon=-149 lat=1 "
             "alt=-20000\n");
  const Result result = fly("low", {}, "low.flight");
  EXPECT_EQ(result.exit_code, 1) << result.err;
  EXPECT_TRUE(
      says(result.err, {"low.flight", "below the ground at 0.9 s", "149.0", " W", "--allow-underground"}))
      << result.err;
  EXPECT_FALSE(exists("low"));
  const Result allowed = fly("low", {"--allow-underground"}, "low.flight");
  EXPECT_EQ(allowed.exit_code, 0) << allowed.err;
  EXPECT_TRUE(exists("low/frame_000009.png"));
}

}  // namespace
}  // namespace app_test
