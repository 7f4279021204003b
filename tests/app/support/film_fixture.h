// Fixture of small films: a flight of 24 frames at two per second; three segments as a video.
#pragma once

#include <map>

#include "tests/app/support/app_fixture.h"

namespace app_test {

class FilmTest : public AppTest {
 protected:
  static constexpr int kFrames = 24;
  static constexpr int kSegment = 8;

  void SetUp() override { write_text(dir_ / "f.flight", film_flight()); }

  // Returns a flight of four poses, four seconds apart. The last pose changes nothing before the second.
  static std::string film_flight(const std::string& last = "lon=-40 lat=-5 alt=400000",
                                 const std::string& more = "");

  // Returns a flight of 24 frames that look straight down, once around the equator.
  static std::string round_flight();
  // Damages the meshes of the cube face around longitude 0 in a copy of planet(). The frames of round_flight()
  // above that face need them, the eight frames in the middle do not.
  static void damage_a_face(const std::filesystem::path& planet);

  Words fly_words(const std::string& output, const Words& more = {}) const;
  Command fly_command(const std::string& output, const Words& more = {}) const;
  Result fly(const std::string& output, const Words& more = {}) const;

  // Runs with --json, and expects success and these counts.
  void expect_counts(const std::string& output, int made, int kept, const Words& more = {}) const;

  // Returns names and bytes of all files in a folder except manifests.
  std::map<std::string, std::string> files(const std::string& folder) const;
  // Returns the file name of frame k.
  static std::string frame_name(int k);

  // Returns a hash of every decoded frame with its time, computed by ffmpeg.
  std::string decoded(const std::string& film) const;
  static bool has_ffmpeg();
};

}  // namespace app_test
