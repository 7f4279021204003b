// Photographs that are put back where they were taken, and kiosks beside hotspots, as a user makes them.
#include <numbers>

#include "tests/app/posters/poster_scene_fixture.h"

namespace app_test {
namespace {

class PutBack : public PosterSceneTest {};

// What was drawn in other colours is a photograph here, so that ground that shows through would be told.
TEST_F(PutBack, APhotographCoversTheImageOfItsOwnCamera) {
  const std::string pose = "10.01,4.99,2500,35,-18,6";
  for (const std::string backend : {"ray", "polygon"}) {
    const RgbImage taken =
        draw("photo.png", pose, {"--backend", backend, "--set", "palette=grey", "--fov", "42"});
    const RgbImage ground = draw("ground.png", pose, {"--backend", backend, "--fov", "42"});
    for (const std::string distance : {"1", "300"}) {
      write_scene(
          "[[picture]]\nfile = \"photo.png\"\nform = \"photograph\"\nlon = 10.01\nlat = 4.99\n"
          "altitude = 2500\nyaw = 35\npitch = -18\nroll = 6\nfov = 42\ndistance_m = " +
          distance + "\n");
      const RgbImage back = draw_scene("back.png", pose, {"--backend", backend, "--fov", "42"});
      ASSERT_EQ(back.pixels.size(), taken.pixels.size());
      double sum = 0;
      int most = 0;
      double from_ground = 0;
      for (std::size_t n = 0; n < back.pixels.size(); ++n) {
        const int steps = steps_between(back.pixels[n], taken.pixels[n]);
        sum += steps;
        most = std::max(most, steps);
        from_ground += steps_between(back.pixels[n], ground.pixels[n]);
      }
      const auto count = static_cast<double>(back.pixels.size());
      EXPECT_LT(sum / count, 0.05) << backend << distance;
      EXPECT_LE(most, 3) << backend << distance;
      EXPECT_GT(from_ground / count, 10) << backend << distance;
    }
  }
}

// Half of it shows the ground through it.
TEST_F(PutBack, AnOpacityMixesItWithTheGround) {
  const std::string pose = "10,5,2500,35,-18,0";
  write_plain("photo.png", {255, 0, 255}, 320, 240);
  write_scene(
      "[[picture]]\nfile = \"photo.png\"\nform = \"photograph\"\nlon = 10\nlat = 5\naltitude = 2500\nyaw = 35\n"
      "pitch = -18\nfov = 60\ndistance_m = 10\nopacity = 0.25\n");
  const RgbImage ground = draw("ground.png", pose, {});
  const RgbImage mixed = draw_scene("mixed.png", pose);
  int most = 0;
  for (std::size_t n = 0; n < ground.pixels.size(); ++n) {
    const Rgb g = ground.pixels[n];
    const auto mix = [](int of_photo, int of_ground) {
      return static_cast<std::uint8_t>(std::lround(0.25 * of_photo + 0.75 * of_ground));
    };
    most = std::max(most, steps_between(mixed.pixels[n], {mix(255, g.r), mix(0, g.g), mix(255, g.b)}));
  }
  EXPECT_LE(most, 1);
}

class Kiosks : public PosterSceneTest {
 protected:
  static constexpr const char* kPose = "10,4.99,2400,0,-20,0";
  int objects_drawn() const { return parse_json(read_text(dir_ / "c.json"))["objects_drawn"].get<int>(); }
};

TEST_F(Kiosks, StandBesideTheHotspotsOfAFile) {
  write_text(dir_ / "spots.txt",
             "# two lookouts\nspot \"West\" 9.99 5.05 2 west.json\nspot \"East\" 10.01 5.05 2 east.json\n");
  write_scene("[[kiosk]]\nhotspots = \"spots.txt\"\nsize_m = 900\nbeside_m = 500\n");
  const Words words{"--certificate", "c.json"};
  const RgbImage by_file = draw_scene("file.png", kPose, words);
  EXPECT_EQ(objects_drawn(), 2);
  // Degrees of 500 m to the north.
  const std::string lat = std::to_string(5.05 + 500 / 3396190.0 * 180 / std::numbers::pi);
  write_scene("[[kiosk]]\nname = \"West\"\nlon = 9.99\nlat = " + lat +
              "\nsize_m = 900\n[[kiosk]]\nname = \"East\"\nlon = 10.01\nlat = " + lat + "\nsize_m = 900\n");
  const RgbImage by_place = draw_scene("place.png", kPose, words);
  EXPECT_EQ(objects_drawn(), 2);
  const RgbImage without = draw("without.png", kPose, {});
  int different = 0;
  int kiosk = 0;
  for (std::size_t n = 0; n < without.pixels.size(); ++n) {
    different += steps_between(by_file.pixels[n], by_place.pixels[n]) > 2 ? 1 : 0;
    kiosk += steps_between(by_file.pixels[n], without.pixels[n]) > 30 ? 1 : 0;
  }
  EXPECT_LE(different, 10);  // a place of six digits is rounded
  EXPECT_GT(kiosk, 300);
  // The file is read again when it has changed, and a hotspot without a kiosk is none.
  write_text(dir_ / "spots.txt", "spot \"West\" 9.99 5.05 2 west.json\n");
  write_scene("[[kiosk]]\nhotspots = \"spots.txt\"\nsize_m = 900\nbeside_m = 500\n");
  (void)draw_scene("one.png", kPose, words);
  EXPECT_EQ(objects_drawn(), 1);
}

}  // namespace
}  // namespace app_test
