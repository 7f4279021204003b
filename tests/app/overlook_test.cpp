// vpe overlook, as a user runs it.
#include <cmath>

#include "panorama/image/xmp_file.h"
#include "panorama/metadata/gpano.h"
#include "panorama/metadata/sidecar.h"
#include "tests/app/support/app_fixture.h"
#include "tests/panorama/big_tiff_file.h"
#include "tests/support/sanitized.h"
#include "vpe/core/image/image.h"

namespace app_test {
namespace {

namespace fs = std::filesystem;
using panorama::PanoramaMap;

// Red where it is more east than west, green where more north than south, blue above the horizon.
vpe::base::Rgb wheel(const panorama::Direction& d) {
  const double a = d.azimuth_deg * mars::kRadiansPerDegree;
  return {static_cast<std::uint8_t>(std::lround(127.5 + 127.5 * std::sin(a))),
          static_cast<std::uint8_t>(std::lround(127.5 + 127.5 * std::cos(a))),
          static_cast<std::uint8_t>(d.elevation_deg > 0 ? 255 : 0)};
}

std::vector<vpe::base::Rgb> wheel_image(const PanoramaMap& map) {
  std::vector<vpe::base::Rgb> pixels;
  for (std::int64_t y = 0; y < map.height_px; ++y) {
    for (std::int64_t x = 0; x < map.width_px; ++x)
      pixels.push_back(wheel(map.to_direction(static_cast<double>(x) + 0.5, static_cast<double>(y) + 0.5)));
  }
  return pixels;
}

vpe::base::Rgb middle(const vpe::core::RgbImage& image, double at = 0.5) {
  return image.pixels[static_cast<std::size_t>(image.height / 2 + 2) * static_cast<std::size_t>(image.width) +
                      static_cast<std::size_t>(at * image.width)];
}

class Overlook : public AppTest {
 protected:
  const PanoramaMap map_ = panorama::cylinder_map(720, 300, 720, 0.0, 150.0);

  void write_wheel(const std::string& name) const {
    vpe::core::write_image(dir_ / name, wheel_image(map_), 720, 300);
    write_text((dir_ / name).replace_extension(".json"), panorama::to_text({name, map_, {}}));
  }
  vpe::core::RgbImage view(const Words& more) const {
    Words words{"overlook", "a.png", "-o", "v.png", "--size", "160x90"};
    words.insert(words.end(), more.begin(), more.end());
    const Result result = vpe(words);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return vpe::core::read_image(dir_ / "v.png");
  }
};

TEST_F(Overlook, LooksInTheGivenDirection) {
  write_wheel("a.png");
  for (const auto& [yaw, red, green] :
       {std::tuple("0", 128, 255), {"90", 255, 128}, {"180", 128, 0}, {"-90", 0, 128}, {"3690", 255, 128}}) {
    const vpe::core::RgbImage image = view({"--view", std::string(yaw) + ",0", "--fov", "30"});
    EXPECT_NEAR(middle(image).r, red, 3) << yaw;
    EXPECT_NEAR(middle(image).g, green, 3) << yaw;
  }
  // East is right of north, up is up.
  const vpe::core::RgbImage north = view({"--view", "0,0", "--fov", "60"});
  EXPECT_GT(middle(north, 0.9).r, 200);
  EXPECT_LT(middle(north, 0.1).r, 60);
  EXPECT_EQ(north.pixels[5].b, 255);
  EXPECT_EQ(north.pixels.back().b, 0);
}

TEST_F(Overlook, GPanoOfBothKinds) {
  const PanoramaMap sphere = panorama::equirectangular_map(720, 360, 720, 0.0, 180.0);
  for (const PanoramaMap& map : {map_, sphere}) {
    for (const char* name : {"g.png", "g.jpg"}) {
      vpe::core::write_image(dir_ / name, wheel_image(map), 720, static_cast<int>(map.height_px));
      panorama::write_xmp(dir_ / name, panorama::to_xmp(panorama::gpano_of(map)));
      const Result result =
          vpe({"overlook", name, "--view", "0,0", "-o", "v.png", "--size", "160x90", "--json"});
      ASSERT_EQ(result.exit_code, 0) << result.err;
      const auto json = parse_json(result.out);
      EXPECT_EQ(json["projection"], to_string(map.kind));
      EXPECT_EQ(json["view"]["fov_deg"], 60);
      const vpe::core::RgbImage image = vpe::core::read_image(dir_ / "v.png");
      EXPECT_NEAR(middle(image, 0.9).r, 128 + 127 * std::sin(0.69), 12) << name;
      // Across 360 degrees, where the image's edges meet, colours go on as elsewhere.
      for (int x = 60; x < 100; ++x) {
        const std::size_t at = static_cast<std::size_t>(47 * 160 + x);
        EXPECT_LT(std::abs(image.pixels[at + 1].r - image.pixels[at].r), 8) << name << x;
      }
    }
  }
}

TEST_F(Overlook, SaysWhatIsThere) {
  write_wheel("a.png");
  std::vector<float> range;
  for (int n = 0; n < 720 * 300; ++n) range.push_back(n < 720 * 150 ? NAN : static_cast<float>(n % 720));
  vpe::core::write_tiff(dir_ / "a.range.tif", range, 720, 300);
  auto json = parse_json(read_text(dir_ / "a.json"));
  json["planes"] = {{"range", {{"file", "a.range.tif"}}}};
  write_text(dir_ / "a.json", json.dump());
  const Result result = vpe({"overlook", "a.png", "--direction", "90.25,-10", "--direction", "-0.25,5",
                             "--at-pixel", "180.5,200", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto places = parse_json(result.out)["places"];
  ASSERT_EQ(places.size(), 3U);
  EXPECT_NEAR(places[0]["azimuth_deg"].get<double>(), 90.25, 1e-9);  // --at-pixel first
  EXPECT_EQ(places[0]["range_m"], 180.0);
  EXPECT_NEAR(places[1]["x"].get<double>(), 180.5, 1e-9);
  EXPECT_NEAR(places[1]["elevation_deg"].get<double>(), -10.0, 1e-9);
  EXPECT_EQ(places[1]["range_m"], 180.0);
  EXPECT_NEAR(places[2]["azimuth_deg"].get<double>(), 359.75, 1e-9);
  EXPECT_TRUE(places[2]["range_m"].is_null());  // the sky
  const Result text = vpe({"overlook", "a.png", "--direction", "90.25,-10", "--direction", "0,5"});
  EXPECT_EQ(text.out,
            "x,y,azimuth_deg,elevation_deg,range_m\n180.500,170.206,90.250000,-10.000000,180.000\n"
            "0.000,139.975,0.000000,5.000000,\n");
  // The former name of --direction.
  EXPECT_EQ(vpe({"overlook", "a.png", "--at", "90.25,-10", "--at", "0,5"}).out, text.out);
}

TEST_F(Overlook, Pairs) {
  // The right eye's image is turned by 90 degrees, to tell them apart.
  write_wheel("a.png");
  const PanoramaMap other = panorama::cylinder_map(720, 300, 720, 90.0, 150.0);
  vpe::core::write_image(dir_ / "r.png", wheel_image(other), 720, 300);
  write_text(dir_ / "r.json", panorama::to_text({"r.png", map_, {}}));
  const vpe::core::RgbImage left = view({"--view", "0,0"});
  const vpe::core::RgbImage beside = view({"--view", "0,0", "--right", "r.png", "--stereo", "sbs"});
  ASSERT_EQ(beside.width, 320);
  EXPECT_NEAR(middle(beside, 0.25).g, 255, 3);
  EXPECT_NEAR(middle(beside, 0.75).r, 255, 3);
  // The same out of one file, over and under, which its JSON says; and side by side, which the command line
  // says.
  std::vector<vpe::base::Rgb> both = wheel_image(map_);
  const std::vector<vpe::base::Rgb> right = wheel_image(other);
  both.insert(both.end(), right.begin(), right.end());
  vpe::core::write_image(dir_ / "ou.png", both, 720, 600);
  auto json = parse_json(panorama::to_text({"ou.png", map_, {}}));
  json["stereo"] = "ou";
  write_text(dir_ / "ou.json", json.dump());
  const auto of_pair = [&](const Words& more) {
    Words words{"overlook", "ou.png", "--view", "0,0", "-o", "v.png", "--size", "160x90"};
    words.insert(words.end(), more.begin(), more.end());
    const Result result = vpe(words);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return vpe::core::read_image(dir_ / "v.png");
  };
  EXPECT_EQ(of_pair({}).pixels, left.pixels);
  EXPECT_EQ(of_pair({"--stereo", "sbs"}).pixels, beside.pixels);
  const vpe::core::RgbImage over = of_pair({"--stereo", "ou"});
  EXPECT_EQ(over.height, 180);
  EXPECT_TRUE(std::equal(left.pixels.begin(), left.pixels.end(), over.pixels.begin()));
  EXPECT_EQ(of_pair({"--stereo", "anaglyph"}).width, 160);
  expect_failure({"overlook", "a.png", "-o", "v.png", "--stereo", "sbs"}, 2,
                 {"--stereo sbs", "a.png", "--right"});
  expect_failure({"overlook", "ou.png", "-o", "w.png", "--stereo-layout", "none"}, 1,
                 {"ou.png", "720x600", "720x300"});
}

TEST_F(Overlook, NotesWhatIsNotAsAsked) {
  write_wheel("a.png");
  const Result high = vpe({"overlook", "a.png", "--view", "10,80", "-o", "v.png", "--size", "64x36"});
  EXPECT_EQ(high.exit_code, 0);
  EXPECT_TRUE(says(high.err, {"note", "not 80"}));
  const Result narrow = vpe({"overlook", "a.png", "--fov", "0.01", "-o", "v.png", "--size", "64x36", "--json"});
  EXPECT_TRUE(says(narrow.err, {"note", "not 0.01", "16 wide"}));
  EXPECT_GT(parse_json(narrow.out)["view"]["fov_deg"].get<double>(), 0.5);
  EXPECT_EQ(vpe({"overlook", "a.png", "--view", "10,80", "-q", "-o", "v.png", "--size", "64x36"}).err, "");
}

TEST_F(Overlook, WrongUsageIsToldBeforeAnyWork) {
  expect_failure({"overlook"}, 2, {"PANO is required"});
  for (const char* bad : {"", "1,2,3", "nan,0", "0,91"})
    expect_failure({"overlook", "no.png", "-o", "v.png", "--view", bad}, 2,
                   {"--view '" + std::string(bad) + "'"});
  for (const char* bad : {"0", "180", "nan"})
    expect_failure({"overlook", "no.png", "-o", "v.png", "--fov", bad}, 2, {"--fov", bad, "120"});
  expect_failure({"overlook", "no.png", "--direction", "0"}, 2, {"--direction '0'", "AZIMUTH,ELEVATION"});
  expect_failure({"overlook", "no.png", "--direction", "nan,0"}, 2, {"--direction 'nan,0'"});
  expect_failure({"overlook", "no.png", "--at-pixel", "1"}, 2, {"--at-pixel '1'", "X,Y"});
  expect_failure({"overlook", "no.png", "-o", "v.png", "--size", "0x5"}, 2, {"--size", "0x5"});
  expect_failure({"overlook", "no.png", "-o", "v.png", "--stereo", "cross"}, 2, {"--stereo", "cross"});
  expect_failure({"overlook", "no.png", "-o", "v.gif"}, 1, {"v.gif", ".png"});
  expect_failure({"overlook", "no.png", "-o", "v.png"}, 1, {"no.png", "No such file"});
}

// The advice is the same in a build without windows.
TEST_F(Overlook, WithoutADisplayItSaysWhatToDo) {
  write_wheel("a.png");
  Command command = command_for({"overlook", "a.png"});
  command.environment["DISPLAY"] = "";
  const Result result = run(command);
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_TRUE(says(result.err, {"window", "--view YAW,PITCH -o", "--direction"})) << result.err;
  EXPECT_EQ(result.out, "");
}

TEST_F(Overlook, BadPanoramas) {
  vpe::core::write_image(dir_ / "plain.png", wheel_image(map_), 720, 300);
  expect_failure({"overlook", "plain.png", "-o", "v.png"}, 1, {"plain.png", "directions", "plain.json"});
  write_wheel("a.png");
  expect_failure({"overlook", "a.png", "--direction", "0,80"}, 1,
                 {"--direction 0,80", "a.png", "does not show it", "-52.622"});
  expect_failure({"overlook", "a.png", "--at-pixel", "720.5,3"}, 1, {"--at-pixel 720.5,3", "720x300"});
  auto json = parse_json(read_text(dir_ / "a.json"));
  json["planes"] = {{"range", "gone.tif"}};
  write_text(dir_ / "a.json", json.dump());
  expect_failure({"overlook", "a.png", "--direction", "0,0"}, 1, {"gone.tif", "cannot read"});
  json["width"] = 721;
  write_text(dir_ / "a.json", json.dump());
  expect_failure({"overlook", "a.png", "-o", "v.png"}, 1, {"a.json", "721"});
  write_wheel("cut.png");
  fs::resize_file(dir_ / "cut.png", fs::file_size(dir_ / "cut.png") - 40);
  expect_failure({"overlook", "cut.png", "-o", "v.png"}, 1, {"cut.png", "cannot"});
  write_wheel("cut.jpg");
  fs::resize_file(dir_ / "cut.jpg", fs::file_size(dir_ / "cut.jpg") / 2);
  expect_failure({"overlook", "cut.jpg", "-o", "v.png"}, 1, {"cut.jpg", "cannot read"});
  EXPECT_FALSE(exists("v.png"));
}

// 6 GB unpacked.
TEST_F(Overlook, LargeImagesWithinTheirMemory) {
  panorama_test::SharedTiles::write(dir_ / "big.tif", 100'000, 20'000);
  write_text(
      dir_ / "big.json",
      panorama::to_text({"big.tif", panorama::equirectangular_map(100'000, 20'000, 100'000, 0.0, 1e4), {}}));
  for (const char* fov : {"120", "20", "1"}) {
    const Result result = vpe({"overlook", "big.tif", "--view", "200,0", "--fov", fov, "-o", "v.png", "--size",
                               "640x360", "--memory", "256", "--direction", "200,-3"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(result.err, "");  // no copies were made
    if (!test_support::kIsSanitized) {
      EXPECT_LT(result.peak_bytes, std::int64_t{256} << 20);
    }
  }
}

// A header that claims a million pixels each way.
TEST_F(Overlook, AHugeClaimIsRefused) {
  write_wheel("a.png");
  std::string bytes = read_text(dir_ / "a.png");
  const std::string side{'\x00', '\x0F', '\x42', '\x40'};
  bytes.replace(16, 8, side + side);
  write_text(dir_ / "a.png", bytes);
  auto json = parse_json(panorama::to_text({"a.png", map_, {}}));
  json["width"] = json["height"] = 1'000'000;
  json["columns_per_turn"] = 1'000'000;
  json.erase("focal_px");
  json["horizon_row"] = 500'000;
  write_text(dir_ / "a.json", json.dump());
  expect_failure({"overlook", "a.png", "-o", "v.png"}, 1, {"a.png", "cannot"});
}

}  // namespace
}  // namespace app_test
