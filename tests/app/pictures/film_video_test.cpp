// Videos: segments, joined seamlessly, and recognized when complete.
#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <future>

#include "tests/app/support/film_fixture.h"
#include "tests/support/worst.h"

namespace app_test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

class FilmVideo : public FilmTest {
 protected:
  void SetUp() override {
    if (!has_ffmpeg()) GTEST_SKIP() << "skipped: no ffmpeg, ffprobe";
    FilmTest::SetUp();
  }
  json probe(const std::string& film, const Words& more) const {
    Command command;
    command.program = find_program("ffprobe");
    command.arguments = {"-v", "error", "-of", "json"};
    command.arguments.insert(command.arguments.end(), more.begin(), more.end());
    command.arguments.push_back("file:" + path(film));
    return parse_json(run(command).out);
  }
  struct Rate {
    const char* text;
    std::int64_t num, den;
    int frames, segment;
  };
  void make_even(const std::string& film, const Rate& r) const {
    write_text(dir_ / "f.flight", "flight 1\nview size=32x18 fps=" + std::string(r.text) +
                                      "\nat 0 set mode=lit\nat 0 pose lon=0 lat=0 alt=500000 pitch=-40\n"
                                      "at 100 pose lon=90 lat=0 alt=500000 pitch=-40\n");
    expect_counts(film, r.frames, 0, {"--frames", "0-" + std::to_string(r.frames - 1)});
    expect_even(film, r.frames, r.den == 1 ? std::string(r.text) + "/1" : r.text, r.num, r.den, r.segment);
    EXPECT_EQ(leftovers(), Words{});
  }
  // Expects every frame at its time, a constant rate, and key frames at the start of each segment.
  void expect_even(const std::string& film, int frames, const std::string& rate, std::int64_t num,
                   std::int64_t den, int segment) const {
    const json stream = probe(film, {"-count_frames", "-show_streams"})["streams"].at(0);
    EXPECT_EQ(stream["nb_read_frames"], std::to_string(frames));
    EXPECT_EQ(stream["nb_frames"], std::to_string(frames));
    EXPECT_EQ(stream["r_frame_rate"], rate);
    EXPECT_EQ(stream["avg_frame_rate"], rate);
    EXPECT_EQ(stream["start_pts"], 0);
    EXPECT_NEAR(std::stod(stream["duration"].get<std::string>()),
                static_cast<double>(frames) * static_cast<double>(den) / static_cast<double>(num), 2e-6);
    std::vector<std::int64_t> times;
    int keys = 0;
    const json packets = probe(film, {"-show_packets"});
    for (const json& packet : packets["packets"]) {
      times.push_back(packet["pts"]);
      const bool is_key = packet["flags"].get<std::string>().find('K') != std::string::npos;
      keys += is_key ? 1 : 0;
      if (static_cast<int>(times.size()) % segment == 1) {
        EXPECT_TRUE(is_key) << times.size();
      }
    }
    EXPECT_GE(keys, (frames + segment - 1) / segment);
    std::sort(times.begin(), times.end());
    ASSERT_EQ(times.size(), static_cast<std::size_t>(frames));
    const std::int64_t tick = times.at(1);
    for (std::size_t n = 0; n < times.size(); ++n) EXPECT_EQ(times[n], static_cast<std::int64_t>(n) * tick);
  }
};

// The last segment has one frame.
TEST_F(FilmVideo, IsEven) { make_even("a:b ü.mp4", {"2", 2, 1, 17, 8}); }

class LongFilmVideo : public FilmVideo {};

// The last segment has two frames, or the length of segments is no whole number of microseconds.
TEST_F(LongFilmVideo, IsEvenAtOtherRates) {
  make_even("a.mp4", {"10", 10, 1, 42, 40});
  make_even("b.mp4", {"2997/100", 2997, 100, 600, 120});
  make_even("c.mp4", {"30000/1001", 30000, 1001, 500, 120});
  make_even("d.mp4", {"240", 240, 1, 1000, 240});
}

TEST_F(FilmVideo, CanBeSeekedAnywhere) {
  expect_counts("x.mp4", kFrames, 0);
  Command all;
  all.program = find_program("ffmpeg");
  all.arguments = {"-v", "error", "-i", path("x.mp4"), "-f", "rawvideo", "-pix_fmt", "gray", "-"};
  const std::string images = run(all).out;
  constexpr std::size_t kSize = 64 * 48;
  ASSERT_EQ(images.size(), kFrames * kSize);
  // About the joins at 8 and 16.
  for (const int k : {7, 8, 9, 16}) {
    Command one = all;
    one.arguments.insert(one.arguments.begin() + 2, {"-ss", std::to_string(k / 2.0)});
    one.arguments.insert(one.arguments.end() - 1, {"-frames:v", "1"});
    EXPECT_EQ(run(one).out, images.substr(static_cast<std::size_t>(k) * kSize, kSize)) << k;
  }
}

// Players of HD expect BT.709. Compared are means over squares, which do not see the coarser grid of chroma.
TEST_F(FilmVideo, ColoursAreThoseOfTheFramesAndTagged) {
  write_text(dir_ / "f.flight",
             "flight 1\nview size=320x192 fps=2\nat 0 pose lon=0 lat=0 alt=900000 pitch=-60\n"
             "at 1 pose lon=1 lat=0 alt=900000 pitch=-60\n");
  for (const char* output : {"frames", "x.mp4"})
    ASSERT_EQ(vpe({"fly", "f.flight", planet().string(), "-o", output, "-q"}).exit_code, 0);
  const json stream = probe("x.mp4", {"-show_streams"})["streams"].at(0);
  EXPECT_EQ(stream["color_space"], "bt709");
  EXPECT_EQ(stream["color_primaries"], "bt709");
  EXPECT_EQ(stream["color_transfer"], "bt709");
  EXPECT_EQ(stream["color_range"], "tv");
  const auto decode = [&](const Words& input) {
    Command command;
    command.program = find_program("ffmpeg");
    command.arguments = {"-v", "error"};
    command.arguments.insert(command.arguments.end(), input.begin(), input.end());
    command.arguments.insert(command.arguments.end(),
                             {"-vf", "scale=flags=accurate_rnd+full_chroma_int", "-frames:v", "2", "-f",
                              "rawvideo", "-pix_fmt", "rgb24", "-"});
    return run(command).out;
  };
  const std::string film = decode({"-i", path("x.mp4")});
  const std::string frames = decode({"-framerate", "2", "-i", path("frames/frame_%06d.png")});
  constexpr std::size_t kWidth = 320, kHeight = 192, kSquare = 32;
  ASSERT_EQ(film.size(), 2 * 3 * kWidth * kHeight);
  ASSERT_EQ(frames.size(), film.size());
  double worst = 0;
  for (std::size_t frame = 0; frame < 2; ++frame)
    for (std::size_t y0 = 0; y0 < kHeight; y0 += kSquare)
      for (std::size_t x0 = 0; x0 < kWidth; x0 += kSquare)
        for (std::size_t c = 0; c < 3; ++c) {
          double sum = 0;
          for (std::size_t n = 0; n < kSquare * kSquare; ++n) {
            const std::size_t at = 3 * ((frame * kHeight + y0 + n / kSquare) * kWidth + x0 + n % kSquare) + c;
            sum += static_cast<double>(static_cast<unsigned char>(film[at])) -
                   static_cast<double>(static_cast<unsigned char>(frames[at]));
          }
          worst = std::max(worst, std::abs(sum / (kSquare * kSquare)));
        }
  test_support::record_worst("film: colours of squares of 32 px", worst, 1.5, "of 255");
  EXPECT_LE(worst, 1.5);
}

TEST_F(FilmVideo, ACompleteFilmIsKeptAndADamagedOneMadeAgain) {
  expect_counts("x.mp4", kFrames, 0, {"--stats", "a.jsonl", "--backend", "polygon"});
  const std::string film = read_text(dir_ / "x.mp4");
  const json manifest = parse_json(read_text(dir_ / "x.mp4.json"));
  EXPECT_EQ(manifest["frames"].size(), std::size_t{kFrames});
  EXPECT_EQ(manifest["complete"], true);
  EXPECT_EQ(leftovers(), Words{});
  // Neither ffmpeg nor a renderer is needed.
  Command command = fly_command("x.mp4", {"--stats", "b.jsonl"});
  command.environment["PATH"] = path("nothing");
  command.environment["__EGL_VENDOR_LIBRARY_FILENAMES"] = path("none.json");
  const Result again = run(command);
  ASSERT_EQ(again.exit_code, 0) << again.err;
  EXPECT_TRUE(says(again.out, {"x.mp4: 24 frames, all there already"}));
  EXPECT_EQ(read_text(dir_ / "x.mp4"), film);
  const auto first_row = [&](const char* name) {
    const std::string text = read_text(dir_ / name);
    return parse_json(text.substr(0, text.find('\n')));
  };
  const json a = first_row("a.jsonl");
  const json b = first_row("b.jsonl");
  EXPECT_EQ(a["triangles"], b["triangles"]);
  EXPECT_EQ(a["shift_bound_px"], b["shift_bound_px"]);
  EXPECT_TRUE(b["draw_ms"].is_null());
  expect_counts("x.mp4", 0, kSegment, {"--part", "2/3"});
  EXPECT_EQ(leftovers(), Words{});
  // A damaged film is made again.
  std::string damaged = film;
  damaged[damaged.size() / 2] ^= 1;
  write_text(dir_ / "x.mp4", damaged);
  expect_counts("x.mp4", kFrames, 0, {"--backend", "polygon"});
  EXPECT_EQ(read_text(dir_ / "x.mp4"), film);
}

TEST_F(FilmVideo, PartsMakeSegmentsThatARunWithoutPartJoins) {
  expect_counts("whole.mp4", kFrames, 0, {"--backend", "polygon"});  // like parts
  auto one = std::async(std::launch::async, [&] { expect_counts("x.mp4", kSegment, 0, {"--part", "1/2"}); });
  auto two = std::async(std::launch::async, [&] {
    expect_counts("x.mp4", 2 * kSegment, 0, {"--part", "2/2"});
  });
  one.get();
  two.get();
  EXPECT_FALSE(exists("x.mp4"));
  EXPECT_FALSE(exists("x.mp4.json"));
  EXPECT_TRUE(exists("x.mp4.parts/manifest.part-1-of-2.json"));
  EXPECT_TRUE(says(fly("x.mp4", {"--part", "2/2"}).out, {"all there already", "without --part"}));
  // An edit keeps the first segment; a damaged one is made again; foreign files stay.
  write_text(dir_ / "f.flight", film_flight("lon=-41 lat=-7 alt=300000"));
  expect_counts("x.mp4", kSegment, 0, {"--part", "3/3"});
  write_text(dir_ / "f.flight", film_flight());
  std::string bytes = read_text(dir_ / "x.mp4.parts/segment_000001.mp4");
  bytes[bytes.size() / 2] ^= 4;
  write_text(dir_ / "x.mp4.parts/segment_000001.mp4", bytes);
  write_text(dir_ / "x.mp4.parts/notes.txt", "mine");
  expect_counts("x.mp4", 2 * kSegment, kSegment);
  EXPECT_EQ(decoded("x.mp4"), decoded("whole.mp4"));
  EXPECT_EQ(files("x.mp4.parts"), (std::map<std::string, std::string>{{"notes.txt", "mine"}}));
}

TEST_F(FilmVideo, PartsWithNothingToDoSaySo) {
  const Result idle = fly("x.mp4", {"--part", "1/8"});
  EXPECT_EQ(idle.exit_code, 0) << idle.err;
  EXPECT_TRUE(says(
      idle.err, {"x.mp4 has 3 segments of 8 frames, so 5 of 8 parts have nothing to do", "3 parts are enough"}))
      << idle.err;
  const Result join = fly("x.mp4", {"--join"});
  EXPECT_EQ(join.exit_code, 1);
  EXPECT_TRUE(says(join.err, {"x.mp4: 24 of 24 frames are missing: 0-23 (parts 3, 6, 8 of 8)"})) << join.err;
  EXPECT_FALSE(exists("x.mp4"));
}

TEST_F(LongFilmVideo, AnFfmpegThatDiesLeavesWholeSegments) {
  expect_counts("whole.mp4", kFrames, 0);
  fs::create_directory(dir_ / "bin");
  // Works once as an encoder, then dies.
  write_text(dir_ / "bin/ffmpeg", "#!/bin/sh\ncase \"$*\" in *rawvideo*)\n  if [ -e " + path("used") +
                                      " ]; then echo 'No space left on device' >&2; exit 1; fi\n  : > " +
                                      path("used") + ";;\nesac\nexec " + find_program("ffmpeg").string() +
                                      " \"$@\"\n");
  fs::permissions(dir_ / "bin/ffmpeg", fs::perms::owner_all);
  Command command = fly_command("x.mp4");
  command.environment["PATH"] = path("bin");
  const Result result = run(command);
  EXPECT_EQ(result.exit_code, 1) << "signal " << result.signal;
  EXPECT_TRUE(says(result.err, {"x.mp4", "ffmpeg reports: No space left on device", "8 of 24 frames are there",
                                "the same command continues"}));
  EXPECT_EQ(leftovers(), Words{"x.mp4.parts"});
  EXPECT_EQ(files("x.mp4.parts").size(), 2U);
  EXPECT_FALSE(exists("x.mp4"));
  expect_counts("x.mp4", 2 * kSegment, kSegment);
  EXPECT_EQ(decoded("x.mp4"), decoded("whole.mp4"));
}

TEST_F(FilmVideo, NeedsFfmpeg) {
  Command command = fly_command("x.mp4");
  command.environment["PATH"] = path("nothing");
  const Result result = run(command);
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_TRUE(says(result.err, {"x.mp4", "cannot start ffmpeg", "install ffmpeg", "PNG frames"}));
  EXPECT_EQ(leftovers(), Words{});
  EXPECT_FALSE(exists("x.mp4.parts"));
}

TEST_F(FilmVideo, IsNotJoinedWhenFramesFail) {
  write_text(dir_ / "f.flight", round_flight());
  fs::copy_file(planet(), dir_ / "p.vpe");
  damage_a_face(dir_ / "p.vpe");
  // The face is in the images of the first and the last segment.
  const Words words{"fly", "f.flight", "p.vpe", "-o", "x.mp4", "--json"};
  const Result result = vpe(words);
  ASSERT_EQ(result.exit_code, 1) << "signal " << result.signal;
  EXPECT_TRUE(says(result.err, {"frames failed", "frame 0: ", "p.vpe", "the film is not joined"}));
  const json report = parse_json(result.out);
  EXPECT_EQ(report["made"], kSegment);
  EXPECT_EQ(report["manifest"], "x.mp4.parts/manifest.json");
  EXPECT_FALSE(exists("x.mp4"));
  fs::copy_file(planet(), dir_ / "p.vpe", fs::copy_options::overwrite_existing);
  const json again = parse_json(vpe(words).out);
  EXPECT_EQ(again["kept"], kSegment);
  EXPECT_EQ(again["made"], kFrames - kSegment);
  EXPECT_TRUE(exists("x.mp4"));
  EXPECT_EQ(leftovers(), Words{});
}

// ffmpeg takes names for URLs in places.
TEST_F(FilmVideo, NamesMayHoldWhatUrlsGiveAMeaning) {
  for (const char* folder : {"", "dir#1?x/"}) {
    for (const char* name : {"film #2.mp4", "a?b=1&c.mp4", "100%41.mp4", "it's \\ \"x\"\n.mp4"}) {
      const std::string film = std::string(folder) + name;
      SCOPED_TRACE(film);
      fs::create_directories(dir_ / folder);
      const Result result = fly(film, {"--frames", "0-9"});
      EXPECT_EQ(result.exit_code, 0) << result.err;
      EXPECT_TRUE(exists(film));
    }
  }
  EXPECT_EQ(leftovers(), Words{});
}

// Segments of another folder, with the name that is left over by the cut, are not taken.
TEST_F(FilmVideo, ANumberSignLeadsToNoOtherFolder) {
  ASSERT_EQ(fly("plain.mp4").exit_code, 0);
  fs::create_directory(dir_ / "dir");
  fs::copy_file(dir_ / "plain.mp4", dir_ / "segment_000000.mp4");
  ASSERT_EQ(fly("film#.mp4", {"--frames", "0-9"}).exit_code, 0);
  ASSERT_EQ(fly("film.mp4", {"--frames", "0-9"}).exit_code, 0);
  EXPECT_EQ(decoded("film#.mp4"), decoded("film.mp4"));
}

// Holds a folder as another vpe does.
class Held {
 public:
  Held(const fs::path& folder, int operation) : file_(::open(folder.c_str(), O_RDONLY | O_DIRECTORY)) {
    EXPECT_EQ(::flock(file_, operation), 0);
  }
  ~Held() { ::close(file_); }
  Held(const Held&) = delete;
  Held& operator=(const Held&) = delete;

 private:
  int file_;
};

TEST_F(FilmVideo, OneRunAtATimeMakesAFilm) {
  fs::create_directory(dir_ / "x.mp4.parts");
  {
    const Held alone(dir_ / "x.mp4.parts", LOCK_EX);
    for (const Words& more : {Words{}, Words{"--part", "1/3"}}) {
      const Result result = fly("x.mp4", more);
      EXPECT_EQ(result.exit_code, 1);
      EXPECT_TRUE(says(result.err, {"x.mp4", "another vpe is making it", "x.mp4.parts", "wait for it"}));
    }
  }
  {
    const Held shared(dir_ / "x.mp4.parts", LOCK_SH);
    EXPECT_EQ(fly("x.mp4").exit_code, 1);
    EXPECT_EQ(fly("x.mp4", {"--part", "1/3"}).exit_code, 0);
  }
  expect_counts("x.mp4", kFrames - kSegment, kSegment);
  EXPECT_EQ(leftovers(), Words{});
}

TEST_F(FilmVideo, TwoRunsAtOnceMakeOneFilm) {
  ASSERT_EQ(fly("whole.mp4").exit_code, 0);
  auto other = std::async(std::launch::async, [&] { return fly("x.mp4"); });
  for (const Result& result : {fly("x.mp4"), other.get()}) {
    if (result.exit_code != 0) {
      EXPECT_TRUE(says(result.err, {"another vpe is making it"}));
    }
  }
  EXPECT_EQ(decoded("x.mp4"), decoded("whole.mp4"));
  EXPECT_EQ(leftovers(), Words{});
}

}  // namespace
}  // namespace app_test
