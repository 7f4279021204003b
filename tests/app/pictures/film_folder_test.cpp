// Folders of frames: which frames a second run keeps, and which it makes again.
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <future>
#include <sstream>

#include "tests/app/support/film_fixture.h"
#include "vpe/app/film/film_target.h"
#include "vpe/core/image/image.h"
#include "vpe/core/image/png_text.h"

namespace app_test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

class FilmFolder : public FilmTest {
 protected:
  // Returns the frames of "out" whose bytes differ from those of "old".
  static int changed(const std::map<std::string, std::string>& old,
                     const std::map<std::string, std::string>& now) {
    int n = 0;
    for (const auto& [name, bytes] : now) n += old.at(name) == bytes ? 0 : 1;
    return n;
  }
  static std::span<const std::uint8_t> bytes_of(const std::string& text) {
    return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
  }
  static void write_bytes(const fs::path& file, const std::vector<std::uint8_t>& bytes) {
    write_text(file, std::string(bytes.begin(), bytes.end()));
  }
  // Returns a command on a machine that cannot draw triangles.
  Result fly_without_egl(const std::string& output, const Words& more = {}) const {
    Command command = fly_command(output, more);
    command.arguments.insert(command.arguments.end(), {"--backend", "polygon"});
    command.environment["__EGL_VENDOR_LIBRARY_FILENAMES"] = path("none.json");
    return run(command);
  }
};

TEST_F(FilmFolder, NothingIsDrawnWhenEveryFrameIsStored) {
  expect_counts("out", kFrames, 0, {"--stats", "a.csv", "--log", "a.flight", "--backend", "polygon"});
  const auto first = files("out");
  EXPECT_EQ(first.size(), std::size_t{kFrames});
  ASSERT_EQ(fly_without_egl("other").exit_code, 1);
  const Result again = fly_without_egl("out", {"--threads", "1", "--stats", "b.csv", "--log", "b.flight"});
  ASSERT_EQ(again.exit_code, 0) << again.err;
  EXPECT_TRUE(says(again.out, {"24 frames, all there already"}));
  EXPECT_EQ(files("out"), first);
  EXPECT_EQ(read_text(dir_ / "a.flight"), read_text(dir_ / "b.flight"));
  // The same rows, except for what only drawing tells: times and the state of caches.
  std::istringstream a(read_text(dir_ / "a.csv"));
  std::istringstream b(read_text(dir_ / "b.csv"));
  const auto cells = [](const std::string& line) {
    Words out;
    std::istringstream in(line);
    for (std::string cell; std::getline(in, cell, ',');) out.push_back(cell);
    return out;
  };
  std::string line_a;
  std::string line_b;
  std::getline(a, line_a);
  std::getline(b, line_b);
  ASSERT_EQ(line_a, line_b);
  const Words header = cells(line_a);
  int rows = 0;
  for (; std::getline(a, line_a) && std::getline(b, line_b); ++rows) {
    const Words x = cells(line_a);
    const Words y = cells(line_b);
    ASSERT_EQ(x.size(), header.size());
    ASSERT_EQ(y.size(), header.size());
    for (std::size_t n = 0; n < header.size(); ++n) {
      const bool only_drawing =
          header[n].ends_with("_ms") || header[n].starts_with("pages_") || header[n] == "bytes_resident";
      EXPECT_EQ(y[n], only_drawing ? "" : x[n]) << header[n];
      EXPECT_NE(x[n], "") << header[n];
    }
  }
  EXPECT_EQ(rows, kFrames);
}

TEST_F(FilmFolder, DamagedAndMissingFramesAreMadeAgainAndForeignFilesStay) {
  expect_counts("out", kFrames, 0);
  const auto whole = files("out");
  test_support::Random random(7);
  for (int k = 0; k < 16; ++k) {
    const fs::path file = dir_ / "out" / frame_name(k);
    std::string bytes = whole.at(frame_name(k));
    const auto at = static_cast<std::size_t>(random.integer(0, static_cast<int>(bytes.size()) - 1));
    if (k < 8) {
      bytes[at] = static_cast<char>(bytes[at] ^ (1 << random.integer(0, 7)));
    } else {
      bytes.resize(at);
    }
    write_text(file, bytes);
  }
  fs::remove(dir_ / "out" / frame_name(16));
  write_text(dir_ / "out" / frame_name(17), "");
  write_text(dir_ / "out" / frame_name(18), whole.at(frame_name(19)));  // a good frame, but another one
  // Valid checksums, but no pixels; and a frame of another version (its fingerprint differs: FilmFrame).
  const auto texts = vpe::core::read_png_text(bytes_of(whole.at(frame_name(20))));
  ASSERT_TRUE(texts);
  ASSERT_EQ(texts->at(0).keyword, vpe::app::kFingerprintKey);
  const std::string& frame = whole.at(frame_name(20));
  const std::string empty = frame.substr(0, 33) + frame.substr(frame.size() - 12);
  write_bytes(dir_ / "out" / frame_name(20), vpe::core::with_png_text(bytes_of(empty), *texts));
  auto other = *vpe::core::read_png_text(bytes_of(whole.at(frame_name(21))));
  other[0].text = std::string(32, '0');
  const auto image = vpe::core::read_image(dir_ / "out" / frame_name(21));
  write_bytes(dir_ / "out" / frame_name(21),
              vpe::core::with_png_text(vpe::core::encode_png(image.pixels, 64, 48), other));
  const std::map<std::string, std::string> foreign{
      {"notes.txt", "mine"}, {"frame_x.png", "mine"},   {"frame_000000.png.bak", "mine"},
      {"x.png.tmp", "mine"}, {"frame_999999.png", "x"}, {"frame_000003.PNG", "mine"}};
  for (const auto& [name, text] : foreign) write_text(dir_ / "out" / name, text);
  expect_counts("out", 21, kFrames - 21);
  auto expected = whole;
  expected.insert(foreign.begin(), foreign.end());
  EXPECT_EQ(files("out"), expected);
}

TEST_F(FilmFolder, AnEditRemakesTheFramesThatChange) {
  expect_counts("out", kFrames, 0);
  const auto before = files("out");
  // Up to the pose at 4 s, frame 8, nothing depends on the last pose; nor does the pose at 8 s, frame 16.
  write_text(dir_ / "f.flight", film_flight("lon=-41 lat=-7 alt=300000"));
  expect_counts("out", 14, 10);
  const auto turned = files("out");
  EXPECT_EQ(changed(before, turned), 14);
  // A setting has effect from its time on: frame 20.
  write_text(dir_ / "f.flight", film_flight("lon=-41 lat=-7 alt=300000", "at 10 set exaggeration=3\n"));
  expect_counts("out", 4, 20);
  EXPECT_EQ(changed(turned, files("out")), 4);
  // Back again, under another name.
  fs::rename(dir_ / "f.flight", dir_ / "g.flight");
  write_text(dir_ / "f.flight", film_flight());
  expect_counts("out", 14, 10);
  EXPECT_EQ(files("out"), before);
  // The sun, by its own option and as a setting; a palette, by its file's content.
  const Words sun{"--sun", "2026-11-20T12:00Z"};
  expect_counts("out", kFrames, 0, sun);
  EXPECT_GT(changed(before, files("out")), kFrames / 2);
  expect_counts("out", 0, kFrames, {"--set", "sun=2026-11-20T12:00Z"});
  const Words palette{"--set", "palette=" + path("p.txt")};
  write_text(dir_ / "p.txt", "-8000 0 0 0\n9000 255 255 255\n");
  expect_counts("out", kFrames, 0, palette);
  expect_counts("out", 0, kFrames, palette);
  write_text(dir_ / "p.txt", "-8000 0 0 1\n9000 255 255 255\n");
  expect_counts("out", kFrames, 0, palette);
  // Inputs that change every image, or may do so.
  expect_counts("out", kFrames, 0, {"--memory", "512"});
  expect_counts("out", 0, kFrames, {"--memory", "512", "--threads", "1"});
}

TEST_F(FilmFolder, SelectionsAndPartsFillOneFolder) {
  expect_counts("out", 6, 0, {"--frames", "0-20x4"});
  EXPECT_TRUE(exists("out/manifest.frames-0-20x4.json"));
  EXPECT_FALSE(exists("out/manifest.json"));
  // Both halves at once.
  auto one = std::async(std::launch::async, [&] { expect_counts("out", 9, 3, {"--part", "1/2"}); });
  auto two = std::async(std::launch::async, [&] { expect_counts("out", 9, 3, {"--part", "2/2"}); });
  one.get();
  two.get();
  expect_counts("out", 0, kFrames);
  expect_counts("whole", kFrames, 0);
  EXPECT_EQ(files("out"), files("whole"));
  const json part = parse_json(read_text(dir_ / "out/manifest.part-2-of-2.json"));
  EXPECT_EQ(part["frames"].size(), 12U);
  EXPECT_EQ(part["part"], "2/2");
  EXPECT_EQ(part["frames"][0]["index"], 12);
  const json whole = parse_json(read_text(dir_ / "out/manifest.json"));
  EXPECT_EQ(whole, parse_json(read_text(dir_ / "whole/manifest.json")));
  EXPECT_EQ(whole["frames"].size(), std::size_t{kFrames});
  EXPECT_EQ(whole["complete"], true);
  EXPECT_EQ(whole["flight"], "f.flight");
  EXPECT_EQ(whole["fps"], "2");
  EXPECT_EQ(whole["frames"][7]["time_s"], 3.5);
  EXPECT_EQ(whole["frames"][7]["checksum"].get<std::string>().size(), 32U);
  EXPECT_GT(whole["frames"][7]["figures"]["shift_bound_px"], 0);
  // More parts than frames: some have nothing to do.
  expect_counts("out", 0, 0, {"--part", "1/100"});
}

TEST_F(FilmFolder, JoiningNamesTheFramesThatAreMissing) {
  expect_counts("out", 8, 0, {"--part", "2/3"});
  fs::remove(dir_ / "out" / frame_name(9));
  const Result join = fly("out", {"--join"});
  EXPECT_EQ(join.exit_code, 1);
  EXPECT_TRUE(
      says(join.err, {"out: 17 of 24 frames are missing: 0-7, 9, 16-23 (parts 1, 2, 3 of 3)", "--part"}))
      << join.err;
  EXPECT_FALSE(exists("out/" + frame_name(0)));
  const Result made = fly("out");
  EXPECT_EQ(made.exit_code, 0) << made.err;
  EXPECT_TRUE(says(made.err, {"note: out: 17 of 24 frames are missing: 0-7, 9, 16-23", "--join"})) << made.err;
  expect_counts("out", 0, kFrames, {"--join"});
  EXPECT_EQ(fly("out", {"--join", "--part", "1/2"}).exit_code, 2);
}

// Without --backend the machine decides, but stored frames come first.
TEST_F(FilmFolder, TheBackendThatBeganAFilmContinuesIt) {
  const auto drawn_by = [&](const std::string& folder, Words more, int made, int kept) {
    more.emplace_back("--json");
    const Result result = fly(folder, more);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    const json report = parse_json(result.out);
    EXPECT_EQ(report["made"], made);
    EXPECT_EQ(report["kept"], kept);
    return report["backend"].get<std::string>();
  };
  write_text(dir_ / "f.flight",
             "flight 1\nview size=64x48 fov=50 fps=2\nat 0 pose lon=-74 lat=-13 alt=50000 yaw=20 pitch=-20\n"
             "at 12 pose lon=-60 lat=-10 alt=60000 yaw=60 pitch=-30\n");
  EXPECT_EQ(drawn_by("parts", {"--part", "1/2"}, kFrames / 2, 0), "polygon");
  EXPECT_EQ(drawn_by("parts", {}, kFrames / 2, kFrames / 2), "polygon");
  EXPECT_EQ(drawn_by("rays", {"--frames", "0-7", "--backend", "ray", "--set", "rays.mode=multires"}, 8, 0),
            "ray");
  EXPECT_EQ(drawn_by("rays", {"--part", "1/2"}, 4, 8), "ray");
  EXPECT_EQ(drawn_by("rays", {}, kFrames / 2, kFrames / 2), "ray");
  // auto would not choose exact rays.
  EXPECT_EQ(drawn_by("exact", {"--frames", "0-7", "--backend", "ray"}, 8, 0), "ray");
  EXPECT_EQ(drawn_by("exact", {"--part", "1/1"}, kFrames, 0), "polygon");
}

// One of many frames does not suit rays: every setting of the flight counts, however briefly it holds.
TEST_F(FilmFolder, OneWireframeOfManyFramesMakesTriangles) {
  const auto backend = [&](const std::string& more) {
    write_text(
        dir_ / "f.flight",
        "flight 1\nview size=64x48 fov=50 fps=100\nat 0 pose lon=-74 lat=-13 alt=50000 yaw=20 pitch=-20\n" +
            more + "at 12 pose lon=-60 lat=-10 alt=60000 yaw=60 pitch=-30\n");
    const Result result = fly("many", {"--frames", "0-0", "--force", "--json"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return parse_json(result.out)["backend"].get<std::string>();
  };
  EXPECT_EQ(backend("at 6.005 set mode=wireframe\nat 6.015 set mode=textured\n"), "polygon");
  EXPECT_EQ(backend("at 6.005 interest lon=-70 lat=-12 radius=1000 levels=1\n"
                    "at 6.015 interest lon=-70 lat=-12 radius=1000 levels=-1\n"),
            "polygon");
}

TEST_F(FilmFolder, PartAutoReadsTheEnvironment) {
  const std::vector<std::map<std::string, std::string>> environments{
      {{"SLURM_ARRAY_TASK_ID", "1"}, {"SLURM_ARRAY_TASK_COUNT", "4"}, {"SLURM_ARRAY_TASK_MIN", "1"}},
      {{"OMPI_COMM_WORLD_RANK", "1"}, {"OMPI_COMM_WORLD_SIZE", "4"}},
  };  // more: FilmPart
  int there = 0;
  for (const auto& environment : environments) {
    Command command = fly_command("out", {"--part", "auto"});
    command.environment.insert(environment.begin(), environment.end());
    const Result result = run(command);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    there += kFrames / 4;
    EXPECT_EQ(files("out").size(), static_cast<std::size_t>(there));
  }
  const Result none = fly("out", {"--part", "auto"});
  EXPECT_EQ(none.exit_code, 2);
  EXPECT_TRUE(says(none.err, {"--part auto", "SLURM_ARRAY_TASK_ID", "k/n"}));
}

TEST_F(FilmFolder, DeadWritersFilesGoAndLivingOnesStay) {
  std::array<char, 256> host{};
  ASSERT_EQ(::gethostname(host.data(), host.size() - 1), 0);
  const pid_t dead = ::fork();
  if (dead == 0) ::_exit(0);
  ASSERT_EQ(::waitpid(dead, nullptr, 0), dead);
  const auto name = [&](const std::string& file, pid_t pid) {
    return "out/" + file + "." + host.data() + "-" + std::to_string(pid) + ".tmp";
  };
  fs::create_directory(dir_ / "out");
  const Words stale{name(frame_name(3), dead), name("manifest.json", dead)};
  const Words living{name(frame_name(3), ::getpid()), name("other.png", dead), "out/frame_000004.png.tmp",
                     "out/frame_000005.png.far.away-12.tmp"};
  for (const auto& list : {stale, living}) {
    for (const std::string& file : list) write_text(dir_ / file, "half");
  }
  expect_counts("out", kFrames, 0);
  for (const std::string& file : stale) EXPECT_FALSE(exists(file)) << file;
  for (const std::string& file : living) EXPECT_TRUE(exists(file)) << file;
}

TEST_F(FilmFolder, AStoppedFilmReportsItsProgressAndContinues) {
  expect_counts("whole", kFrames, 0);
  for (const auto& [signal, code] : {std::pair{SIGTERM, 143}}) {  // FlySignals tests the other
    const std::string out = "out" + std::to_string(code);
    Command command = fly_command(out);
    command.signal = signal;
    command.when = [&] { return exists(out + "/" + frame_name(2)); };
    const Result result = run(command);
    ASSERT_TRUE(result.signalled);
    if (result.exit_code == 0) continue;  // it ended before the signal
    EXPECT_EQ(result.exit_code, code);
    const auto there = static_cast<int>(files(out).size());
    EXPECT_TRUE(
        says(result.err, {"stopped", std::to_string(there) + " of 24 frames", "the same command continues"}));
    EXPECT_EQ(leftovers(), Words{});
    expect_counts(out, kFrames - there, there);
    EXPECT_EQ(files(out), files("whole"));
  }
}

TEST_F(FilmFolder, AFullDiskIsReportedAndTheFilmContinues) {
  expect_counts("out", 6, 0, {"--frames", "0-5"});
  Command command = fly_command("out");
  // Files of more than 2 kB cannot be written, as on a full disk.
  command.arguments.insert(command.arguments.begin(),
                           {"-c", "trap '' XFSZ; ulimit -f 4; exec \"$0\" \"$@\"", command.program.string()});
  command.program = "/bin/sh";
  const Result result = run(command);
  EXPECT_EQ(result.exit_code, 1) << "signal " << result.signal;
  EXPECT_TRUE(says(result.err, {frame_name(6), "cannot write", "too large", "free space",
                                "6 of 24 frames are there", "the same command continues"}));
  EXPECT_EQ(leftovers(), Words{});
  expect_counts("out", kFrames - 6, 6);
}

TEST_F(FilmFolder, FramesThatFailDoNotStopTheFilm) {
  write_text(dir_ / "f.flight", round_flight());
  fs::copy_file(planet(), dir_ / "p.vpe");
  damage_a_face(dir_ / "p.vpe");
  const Words words{"fly", "f.flight", "p.vpe", "-o", "out", "--json"};
  const Result result = vpe(words);
  ASSERT_EQ(result.exit_code, 1) << "signal " << result.signal;
  const json report = parse_json(result.out);
  const int failed = report["failed"];
  EXPECT_GT(failed, 5);
  EXPECT_LT(failed, kFrames);
  EXPECT_EQ(report["made"].get<int>() + failed, kFrames);
  EXPECT_EQ(static_cast<int>(files("out").size()), kFrames - failed);
  const json manifest = parse_json(read_text(dir_ / "out/manifest.json"));
  EXPECT_EQ(manifest["complete"], false);
  int reported = 0;
  for (const json& frame : manifest["frames"]) {
    EXPECT_EQ(frame.contains("failed"), !exists("out/" + frame_name(frame["index"])));
    reported += frame.contains("failed") ? 1 : 0;
  }
  EXPECT_EQ(reported, failed);
  EXPECT_TRUE(says(result.err, {"out: " + std::to_string(failed) + " of 24 frames failed", "frame 0: ", "p.vpe",
                                "damaged", "and " + std::to_string(failed - 5) + " more",
                                "the same command makes only the missing frames"}));
  // After the repair, only those are made.
  fs::copy_file(planet(), dir_ / "p.vpe", fs::copy_options::overwrite_existing);
  const json again = parse_json(vpe(words).out);
  EXPECT_EQ(again["made"], failed);
  EXPECT_EQ(again["kept"], kFrames - failed);
  EXPECT_EQ(parse_json(read_text(dir_ / "out/manifest.json"))["complete"], true);
}

}  // namespace
}  // namespace app_test
