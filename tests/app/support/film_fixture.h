// Small films: a flight of 24 frames at two a second, in three segments as a video.
#pragma once

#include <map>

#include "tests/app/support/app_fixture.h"

namespace app_test {

class FilmTest : public AppTest {
 protected:
  static constexpr int kFrames = 24;
  static constexpr int kSegment = 8;

  void SetUp() override { write_text(dir_ / "f.flight", film_flight()); }

  // Four poses, four seconds apart; what is said of the last one moves nothing before the second.
  static std::string film_flight(const std::string& last = "lon=-40 lat=-5 alt=400000",
                                 const std::string& more = "");

  // 24 frames straight down, once around the equator.
  static std::string round_flight();
  // Spoils the meshes of the face about longitude 0 in a copy of planet(). Of round_flight(), the frames that
  // look down on it need them, the eight in the middle do not.
  static void damage_a_face(const std::filesystem::path& planet);

  Words fly_words(const std::string& output, const Words& more = {}) const;
  Command fly_command(const std::string& output, const Words& more = {}) const;
  Result fly(const std::string& output, const Words& more = {}) const;

  // Runs with --json and expects success and these counts.
  void expect_counts(const std::string& output, int made, int kept, const Words& more = {}) const;

  // Names and bytes of everything in a folder but manifests.
  std::map<std::string, std::string> files(const std::string& folder) const;
  // Of frames k only.
  static std::string frame_name(int k);

  // A hash of every decoded frame with its time, by ffmpeg.
  std::string decoded(const std::string& film) const;
  static bool has_ffmpeg();
};

}  // namespace app_test
