#include "tests/app/support/film_fixture.h"

#include <sqlite3.h>

#include <cstdio>

namespace app_test {

namespace fs = std::filesystem;

std::string FilmTest::film_flight(const std::string& last, const std::string& more) {
  return "flight 1\nview size=64x48 fov=50 fps=2\n"
         "at 0 set mode=coloured sun.azimuth=200 sun.elevation=40\n"
         "at 0 pose lon=-74 lat=-13 alt=500000 yaw=20 pitch=-40\n"
         "at 4 pose lon=-60 lat=-10 alt=400000 yaw=60 pitch=-30\n"
         "at 8 pose lon=-50 lat=-10 alt=400000 yaw=60 pitch=-30\n" +
         more + "at 12 pose " + last + " yaw=60 pitch=-30\n";
}

std::string FilmTest::round_flight() {
  return "flight 1\nview size=64x48 fov=40 fps=1\nat 0 set mode=lit\n"
         "at 0 pose lon=0 lat=0 alt=300000 pitch=-90\nat 8 pose lon=120 lat=0 alt=300000 pitch=-90\n"
         "at 16 pose lon=240 lat=0 alt=300000 pitch=-90\nat 24 pose lon=360 lat=0 alt=300000 pitch=-90\n";
}

void FilmTest::damage_a_face(const fs::path& planet) {
  sqlite3* file = nullptr;
  ASSERT_EQ(sqlite3_open(planet.c_str(), &file), SQLITE_OK);
  const int code =
      sqlite3_exec(file, "UPDATE mesh SET data = x'00' WHERE key IN (SELECT key FROM node WHERE face = 0)",
                   nullptr, nullptr, nullptr);
  EXPECT_EQ(code, SQLITE_OK) << sqlite3_errmsg(file);
  EXPECT_GT(sqlite3_total_changes(file), 0);
  sqlite3_close(file);
}

Words FilmTest::fly_words(const std::string& output, const Words& more) const {
  Words words{"fly", "f.flight", planet().string(), "-o", output};
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

Command FilmTest::fly_command(const std::string& output, const Words& more) const {
  return command_for(fly_words(output, more));
}

Result FilmTest::fly(const std::string& output, const Words& more) const {
  return run(fly_command(output, more));
}

void FilmTest::expect_counts(const std::string& output, int made, int kept, const Words& more) const {
  Words words = more;
  words.emplace_back("--json");
  const Result result = fly(output, words);
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const nlohmann::json json = parse_json(result.out);
  EXPECT_EQ(json["made"], made);
  EXPECT_EQ(json["kept"], kept);
  EXPECT_EQ(json["failed"], 0);
  EXPECT_EQ(json["frames"], made + kept);
}

std::map<std::string, std::string> FilmTest::files(const std::string& folder) const {
  std::map<std::string, std::string> out;
  for (const auto& entry : fs::directory_iterator(dir_ / folder)) {
    const std::string name = entry.path().filename().string();
    if (!name.starts_with("manifest.") && entry.is_regular_file()) out[name] = read_text(entry.path());
  }
  return out;
}

std::string FilmTest::frame_name(int k) {
  char name[32];
  std::snprintf(name, sizeof name, "frame_%06d.png", k);
  return name;
}

std::string FilmTest::decoded(const std::string& film) const {
  Command command;
  command.program = find_program("ffmpeg");
  command.arguments = {"-v", "error", "-i", "file:" + path(film), "-f", "framemd5", "-"};
  const Result result = run(command);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.err, "");
  return result.out;
}

bool FilmTest::has_ffmpeg() { return !find_program("ffmpeg").empty() && !find_program("ffprobe").empty(); }

}  // namespace app_test
