// Outputs never replace inputs, each other, or files of another kind or program.
#include <sys/stat.h>

#include <csignal>
#include <future>

#include "paging/planet/planet_file.h"
#include "paging/planet/sqlite.h"
#include "tests/app/support/app_fixture.h"

namespace app_test {
namespace {

namespace fs = std::filesystem;

class Outputs : public AppTest {
 protected:
  void SetUp() override { fs::copy_file(planet(), dir_ / "p.vpe"); }

  static Words with(Words words, const Words& more) {
    words.insert(words.end(), more.begin(), more.end());
    return words;
  }
  static Words render(const Words& more, const std::string& planet = "p.vpe") {
    return with({"render", planet, "--pose", "10,5,400000,0,-90,0", "--size", "32x24"}, more);
  }
  static Words horizon(const Words& more) {
    return with({"horizon", "p.vpe", "--at", "10,5", "--height", "4000", "--step", "30"}, more);
  }
  static Words panorama(const Words& more, const std::string& planet = "p.vpe") {
    return with({"panorama", planet, "--at", "10,5", "--height", "4000", "--width", "64", "--elevation=-20,10"},
                more);
  }
  static Words fly(const Words& more) { return with({"fly", "f.flight", "p.vpe", "--size", "32x24"}, more); }

  // Expects a refusal that leaves the file as it was.
  void expect_refused(const Words& words, int exit_code, const std::string& file, const Words& parts) const {
    const std::string before = read_text(dir_ / file);
    const Result result = vpe(words);
    EXPECT_EQ(result.exit_code, exit_code) << file << result.err;
    EXPECT_TRUE(says(result.err, parts));
    EXPECT_TRUE(read_text(dir_ / file) == before) << file;
  }
  void expect_made(const Words& words) const {
    const Result result = vpe(words);
    EXPECT_EQ(result.exit_code, 0) << result.err;
  }
};

TEST_F(Outputs, AreNoInputs) {
  write_dem(dir_ / "dem.tif");
  write_text(dir_ / "f.flight", small_flight());
  write_text(dir_ / "names.csv", "name,lon,lat,diameter\nA,1,2,3\n");
  fs::create_symlink("p.vpe", dir_ / "link.json");
  fs::create_hard_link(dir_ / "p.vpe", dir_ / "hard.csv");
  const Words parts{"is also an input", "another name"};
  expect_refused(render({"-o", "x.png", "--certificate", "p.vpe"}), 2, "p.vpe", parts);
  expect_refused(render({"-o", "x.png", "--certificate", "link.json"}), 2, "p.vpe", parts);
  expect_refused(render({"-o", "x.png", "--explain-lod", "./p.vpe"}), 2, "p.vpe", parts);
  expect_refused(render({"-o", "x.png", "--range", "dem.tif"}, "dem.tif"), 2, "dem.tif", parts);
  expect_refused(horizon({"-o", "p.vpe"}), 2, "p.vpe", parts);
  expect_refused(horizon({"-o", "hard.csv"}), 2, "hard.csv", parts);
  expect_refused(horizon({"-o", "x.csv", "--names", "names.csv", "--features", "names.csv"}), 2, "names.csv",
                 parts);
  expect_refused(fly({"-o", "frames", "--log", "f.flight"}), 2, "f.flight", parts);
  expect_refused(panorama({"-o", "dem.tif"}, "dem.tif"), 2, "dem.tif", parts);
  expect_refused({"build", "dem.tif", "-o", "dem.tif"}, 2, "dem.tif", parts);
  for (const char* name : {"x.png", "x.csv", "frames"}) EXPECT_FALSE(exists(name)) << name;
}

TEST_F(Outputs, DifferFromEachOther) {
  const Words parts{"is also the output of", "own name"};
  expect_made(render({"-o", "x.png"}));
  expect_refused(render({"-o", "x.png", "--overlay-layer", "./x.png", "--set", "overlay.graticule=on"}), 2,
                 "x.png", parts);
  fs::create_symlink("y.json", dir_ / "z.json");  // neither exists
  const Result result = vpe(render({"-o", "x.png", "--certificate", "y.json", "--explain-lod", "z.json"}));
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_TRUE(says(result.err, parts));
  EXPECT_FALSE(exists("y.json"));
  expect_made(render({"-o", "x.png", "--certificate", "/dev/null", "--explain-lod", "/dev/null"}));
}

TEST_F(Outputs, ReplaceOnlyFilesOfTheirKind) {
  write_text(dir_ / "f.flight", small_flight());
  write_text(dir_ / "mine.flight", small_flight());
  write_text(dir_ / "note.txt", "mine\n");
  write_text(dir_ / "package.json", "{\"name\": \"mine\"}\n");
  write_dem(dir_ / "other.tif");
  write_text(dir_ / "empty", "");
  fs::create_directory(dir_ / "frames");
  write_text(dir_ / "frames/frame_000000.png", "mine");
  write_text(dir_ / "film.mp4.json", "{\"title\": \"mine\"}\n");
  fs::create_directory(dir_ / "land");
  write_text(dir_ / "land/landscape.ini", "[landscape]\nauthor = somebody\n");
  fs::copy_file(dir_ / "other.tif", dir_ / "q.range.tif");
  const Words parts{"exists and is not", "move it"};
  expect_refused(render({"-o", "x.png", "--certificate", "package.json"}), 1, "package.json", parts);
  expect_refused(render({"-o", "x.png", "--certificate", "p2.vpe"}), 0, "p.vpe", {});
  expect_refused(render({"-o", "x.png", "--range", "other.tif"}), 1, "other.tif", parts);
  expect_refused(horizon({"-o", "note.txt"}), 1, "note.txt", parts);
  expect_refused(horizon({"--landscape", "land"}), 1, "land/landscape.ini", parts);
  expect_refused(fly({"-o", "frames"}), 1, "frames/frame_000000.png", parts);
  expect_refused(fly({"-o", "film.mp4"}), 1, "film.mp4.json", parts);
  expect_refused(fly({"-o", "new", "--log", "mine.flight"}), 1, "mine.flight", parts);
  expect_refused(panorama({"-o", "other.tif"}), 1, "other.tif", parts);
  expect_refused(panorama({"-o", "q.png", "--aux-layers", "range"}), 1, "q.range.tif", parts);
  // Their own files are replaced, and so are empty ones.
  for (int n = 0; n < 2; ++n) {
    expect_made(render({"-o", "v.png", "--certificate", "c.json", "--range", "r.tif", "--explain-lod", "e.json",
                        "--backend", "polygon"}));
    expect_made(render({"-o", "v.png", "--stereo", "sbs", "--certificate", "s.json"}));
    expect_made(horizon({"-o", "h.csv", "--landscape", "own"}));
    expect_made(panorama({"-o", "r.tif.tif", "--aux-layers", "range,lonlat"}));
    expect_made(render({"-o", "v.png", "--certificate", "empty"}));
    write_text(dir_ / "empty", "");
  }
}

TEST_F(Outputs, ANewPlanetReplacesNoStrangersDatabase) {
  write_dem(dir_ / "dem.tif");
  paging::Database(path("notes.sqlite"), paging::Database::Mode::kCreate)
      .execute("CREATE TABLE t(x); INSERT INTO t VALUES(1)");
  const Words parts{"notes.sqlite", "is not a planet file", "another name"};
  const Words build{"build", "dem.tif", "--base-spacing", "100000", "-o", "notes.sqlite"};
  expect_refused(build, 1, "notes.sqlite", parts);
  expect_refused(with(build, {"--force"}), 1, "notes.sqlite", parts);
  fs::create_symlink("notes.sqlite", dir_ / "n.vpe");
  expect_refused({"build", "dem.tif", "-o", "n.vpe"}, 1, "notes.sqlite", {"n.vpe", "is not a planet file"});
  expect_refused({"build", "dem.tif", "-o", "/dev/null"}, 1, "dem.tif",
                 {"/dev/null", "a planet is a database"});
}

TEST_F(Outputs, AFinishedPlanetIsReplacedByForceOnly) {
  write_dem(dir_ / "dem.tif");
  Dem flat;
  flat.height_m = [](int, int) { return 5.0; };
  write_dem(dir_ / "flat.tif", flat);
  const Words build{"build", "dem.tif", "--base-spacing", "100000", "-q", "-o", "x.vpe"};
  const auto identity = [&] { return paging::PlanetFile::open(path("x.vpe"))->meta().identity; };
  expect_made(build);
  const std::string first = identity();
  expect_made(build);  // the same again
  struct Other {
    Words words;
    Words parts;
  };
  for (const Other& other :
       {Other{{"build", "flat.tif", "--base-spacing", "100000"}, {"dem.tif", "not flat.tif"}},
        Other{{"build", "dem.tif", "flat.tif", "--base-spacing", "100000"}, {"dem.tif", "flat.tif"}},
        Other{{"build", "dem.tif", "--base-spacing", "20000"}, {"finest tiles", "--base-spacing"}},
        Other{{"build", "dem.tif", "--base-spacing", "100000", "--image", "dem.tif"},
              {"image sources are none"}},
        Other{{"build", "dem.tif", "--base-spacing", "100000", "--datum", "areoid"}, {"datum"}}}) {
    SCOPED_TRACE(other.parts.front());
    expect_refused(with(other.words, {"-q", "-o", "x.vpe"}), 1, "x.vpe",
                   with({"x.vpe", "is another planet", "--force"}, other.parts));
    EXPECT_FALSE(exists("x.vpe.part"));
  }
  const auto time = fs::last_write_time(dir_ / "dem.tif");
  fs::last_write_time(dir_ / "dem.tif", time + std::chrono::seconds(7));
  expect_refused(build, 1, "x.vpe", {"dem.tif has changed"});
  fs::last_write_time(dir_ / "dem.tif", time);
  // A damaged file is built again, as messages about it advise.
  damage_payloads(dir_ / "x.vpe", "heights");
  expect_made(build);
  EXPECT_EQ(identity(), first);
  expect_made({"build", "flat.tif", "--base-spacing", "100000", "-q", "-o", "x.vpe", "--force"});
  EXPECT_NE(identity(), first);
  // Parts and merging.
  for (const char* part : {"1/2", "2/2"}) expect_made(with(build, {"--part", part}));
  expect_made(with(build, {"--part", "2/2"}));
  expect_refused({"build", "flat.tif", "--base-spacing", "100000", "-o", "x.vpe", "--part", "1/2"}, 1,
                 "x.1-of-2.vpe", {"x.1-of-2.vpe", "not flat.tif", "--force"});
  const Words merge{"merge", "x.1-of-2.vpe", "x.2-of-2.vpe", "-q", "-o", "x.vpe"};
  expect_refused(merge, 1, "x.vpe", {"x.vpe", "flat.tif, not dem.tif", "--force"});
  expect_made(with(merge, {"--force"}));
  EXPECT_EQ(identity(), first);
  expect_made(merge);
  expect_refused({"merge", "x.1-of-2.vpe", "x.2-of-2.vpe", "-o", "x.1-of-2.vpe"}, 2, "x.1-of-2.vpe",
                 {"is also an input"});
}

TEST_F(Outputs, FollowLinksAndFillPipes) {
  fs::create_directory(dir_ / "store");
  fs::create_symlink("store/view.png", dir_ / "latest.png");
  fs::create_symlink("store/x.vpe", dir_ / "x.vpe");
  write_dem(dir_ / "dem.tif");
  expect_made(render({"-o", "latest.png"}));
  expect_made(render({"-o", "latest.png"}));
  EXPECT_TRUE(fs::is_symlink(dir_ / "latest.png"));
  EXPECT_TRUE(fs::is_regular_file(fs::symlink_status(dir_ / "store/view.png")));
  expect_made({"build", "dem.tif", "--base-spacing", "100000", "-q", "-o", "x.vpe"});
  EXPECT_TRUE(fs::is_symlink(dir_ / "x.vpe"));
  EXPECT_TRUE(exists("store/x.vpe"));
  ASSERT_EQ(::mkfifo(path("pipe.png").c_str(), 0600), 0);
  auto reader = std::async(std::launch::async, [&] { return read_text(dir_ / "pipe.png"); });
  expect_made(render({"-o", "pipe.png"}));
  EXPECT_TRUE(reader.get() == read_text(dir_ / "latest.png"));
  EXPECT_TRUE(fs::is_fifo(dir_ / "pipe.png"));
}

// Two images in one folder that share the name of their sidecar and layers.
TEST_F(Outputs, APanoramaKeepsTheSidecarOfAnother) {
  expect_made(panorama({"-o", "pano.png", "--aux-layers", "range"}));
  expect_refused(panorama({"-o", "pano.jpg"}), 1, "pano.json", {"pano.json", "'pano.png'", "recipe"});
  expect_refused(panorama({"-o", "pano.jpg", "--aux-layers", "range"}), 1, "pano.range.tif", {"pano.json"});
  EXPECT_FALSE(exists("pano.jpg"));
  expect_made(panorama({"-o", "pano.png"}));
  expect_made({"panorama", "--from-sidecar", "pano.json"});
}

TEST_F(Outputs, APanoramaRemovesOnlyItsOwnStrips) {
  fs::create_directory(dir_ / "pano.png.parts");
  const Words foreign{"raw.txt", "strip_of_mine.txt", "strip_000001.bak"};
  for (const std::string& name : foreign) write_text(dir_ / "pano.png.parts" / name, "mine");
  write_text(dir_ / "pano.png.parts/strip_000077", "of a wider panorama");
  expect_made(panorama({"-o", "pano.png"}));
  for (const std::string& name : foreign) EXPECT_TRUE(exists("pano.png.parts/" + name)) << name;
  EXPECT_FALSE(exists("pano.png.parts/strip_000077"));
  EXPECT_FALSE(exists("pano.png.parts/strip_000000"));
  for (const std::string& name : foreign) fs::remove(dir_ / "pano.png.parts" / name);
  expect_made(panorama({"-o", "pano.png"}));
  EXPECT_FALSE(exists("pano.png.parts"));
}

// A log and statistics of a stopped film replace nothing.
TEST_F(Outputs, AStoppedFilmLeavesTheFormerLog) {
  write_text(dir_ / "f.flight", small_flight());
  const Words words =
      fly({"--backend", "ray", "-q", "-o", "out", "--log", "log.flight", "--stats", "stats.csv", "--frames"});
  expect_made(with(words, {"0-3"}));
  const std::string log = read_text(dir_ / "log.flight");
  const std::string stats = read_text(dir_ / "stats.csv");
  Command command = command_for(with(words, {"0-19", "--force"}));
  command.signal = SIGTERM;
  command.when = [&] { return exists("out/frame_000004.png"); };
  const Result result = run(command);
  if (result.exit_code == 0) GTEST_SKIP() << "skipped: it ended before the signal";
  EXPECT_EQ(result.exit_code, 143);
  EXPECT_EQ(read_text(dir_ / "log.flight"), log);
  EXPECT_EQ(read_text(dir_ / "stats.csv"), stats);
  EXPECT_EQ(leftovers(), Words{});
  expect_made(with(words, {"0-19"}));
  EXPECT_NE(read_text(dir_ / "log.flight"), log);
  EXPECT_NE(read_text(dir_ / "log.flight").find(" end\n"), std::string::npos);
  EXPECT_NE(read_text(dir_ / "stats.csv"), stats);
}

}  // namespace
}  // namespace app_test
