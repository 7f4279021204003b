// Files that belong to a panorama: auxiliary layers beside it, and pairs of eyes in it.
#include "panorama/metadata/auxiliary_files.h"

#include <cmath>

#include "panorama/image/raster_plane.h"
#include "panorama/metadata/open_panorama.h"
#include "tests/panorama/test_images.h"
#include "vpe/base/file.h"

namespace {

namespace fs = std::filesystem;
using panorama::AuxiliaryFiles;
using panorama::PairLayout;
using panorama::RasterPlane;
using panorama::read_auxiliary_files;
using panorama_test::message_of;

TEST(AuxiliaryFiles, AreRead) {
  const AuxiliaryFiles none = read_auxiliary_files(R"({"projection": "cylinder"})");
  EXPECT_EQ(none.pair, PairLayout::kNone);
  EXPECT_TRUE(none.planes.empty());
  const AuxiliaryFiles all = read_auxiliary_files(
      R"({"stereo": "ou", "planes": {"range": "a.range.tif", "lonlat": {"file": "a.lonlat.tif", "unit": "deg"}}})");
  EXPECT_EQ(all.pair, PairLayout::kOverUnder);
  ASSERT_EQ(all.planes.size(), 2U);
  EXPECT_EQ(all.planes[0].name, "lonlat");
  EXPECT_EQ(all.planes[0].file, "a.lonlat.tif");
  EXPECT_EQ(all.planes[1].file, "a.range.tif");
}

TEST(AuxiliaryFiles, BadOnesAreNamed) {
  const auto said = [](const std::string& json) { return message_of([&] { read_auxiliary_files(json); }); };
  EXPECT_SAYS(said(R"({"stereo": "cross"})"), "stereo", "cross", "sbs");
  EXPECT_SAYS(said(R"({"stereo": 3})"), "stereo", "3");
  EXPECT_SAYS(said(R"({"planes": ["a.tif"]})"), "planes", "object");
  EXPECT_SAYS(said(R"({"planes": {"range": "../../etc/passwd"}})"), "planes.range", "same folder");
  EXPECT_SAYS(said(R"({"planes": {"range": 5}})"), "planes.range", "5");
  EXPECT_SAYS(said("["), "JSON");
}

// A sphere of 360 x 180 for each eye, both in one image.
TEST(AuxiliaryFiles, APairIsDescribedByOneEye) {
  const test_support::TempDir folder;
  const auto camera = panorama::equirectangular_map(360, 180, 360, 0.0, 90.0);
  vpe::core::write_image(folder / "ou.png", panorama_test::pixels(360, 360), 360, 360);
  std::string json = panorama::to_text({"ou.png", camera, {}});
  json.insert(json.find('{') + 1, R"("stereo": "ou",)");
  vpe::base::write_file(folder / "ou.json", json);
  const auto described = panorama::describe(folder / "ou.png");
  EXPECT_EQ(described.pair, PairLayout::kOverUnder);
  EXPECT_EQ(described.map.height_px, 180);
  // The command line knows better, and then the sizes must fit to that.
  EXPECT_SAYS(message_of([&] { panorama::describe(folder / "ou.png", PairLayout::kNone); }), "360x360",
              "360x180");

  // The whole image's size is as good, where the projection allows it.
  vpe::core::write_image(folder / "sbs.png", panorama_test::pixels(720, 60), 720, 60);
  vpe::base::write_file(folder / "sbs.json",
                        panorama::to_text({"sbs.png", panorama::cylinder_map(720, 60, 360, 0.0, 30.0), {}}));
  EXPECT_EQ(panorama::describe(folder / "sbs.png").map.width_px, 720);
  const auto sbs = panorama::describe(folder / "sbs.png", PairLayout::kSideBySide);
  EXPECT_EQ(sbs.map.width_px, 360);
  EXPECT_TRUE(sbs.map.is_full_turn());
}

TEST(RasterPlane, ValuesOfEveryKind) {
  const test_support::TempDir folder;
  std::vector<float> values;
  for (int n = 0; n < 300 * 70; ++n) values.push_back(n == 5 ? NAN : static_cast<float>(n) + 0.25F);
  vpe::core::write_tiff(folder / "rows.tif", values, 300, 70);
  const auto rows = (folder / "rows.tif").string();
  const auto tiled = (folder / "tiled.tif").string();
  const auto pair = (folder / "pair.tif").string();
  panorama_test::output_of("gdal_translate", {"-q", "-co", "TILED=YES", "-co", "COMPRESS=DEFLATE", "-co",
                                              "PREDICTOR=3", "-co", "BIGTIFF=YES", rows, tiled});
  panorama_test::output_of("gdal_translate", {"-q", "-ot", "Float64", "-b", "1", "-b", "1", "-co", "TILED=YES",
                                              "-co", "INTERLEAVE=PIXEL", rows, pair});
  for (const std::string& path : {rows, tiled, pair}) {
    const RasterPlane plane(path, 300, 70);
    for (const auto& [x, y] : {std::pair(0, 0), {299, 69}, {256, 0}, {255, 69}, {17, 64}}) {
      const std::vector<double> at = plane.at(x, y);
      ASSERT_EQ(at.size(), path == pair ? 2U : 1U);
      for (const double value : at) EXPECT_EQ(value, y * 300 + x + 0.25) << path;
    }
    EXPECT_TRUE(std::isnan(plane.at(5, 0)[0]));
  }
}

TEST(AuxiliaryFiles, DeepNestingIsNoDanger) {
  const std::string deep = std::string(1'000'000, '[') + std::string(1'000'000, ']');
  for (const std::string& json : {"{\"stereo\": " + deep + "}", "{\"planes\": {\"range\": " + deep + "}}",
                                  "{\"planes\": " + deep + "}", deep}) {
    const std::string message = message_of([&] { panorama::read_auxiliary_files(json); });
    EXPECT_FALSE(message.empty());
    EXPECT_LT(message.size(), 1000U);
  }
}

TEST(RasterPlane, BadOnesAreNamed) {
  const test_support::TempDir folder;
  vpe::core::write_tiff(folder / "a.tif", std::vector<float>(64, 1.0F), 8, 8);
  EXPECT_SAYS(message_of([&] { RasterPlane(folder / "a.tif", 8, 9); }), "a.tif", "8x8", "8x9");
  EXPECT_SAYS(message_of([&] { RasterPlane(folder / "none.tif", 8, 8); }), "none.tif");
  panorama_test::output_of("gdal_translate",
                           {"-q", "-ot", "Byte", (folder / "a.tif").string(), (folder / "byte.tif").string()});
  EXPECT_SAYS(message_of([&] { RasterPlane(folder / "byte.tif", 8, 8); }), "byte.tif", "floating point",
              "gdal_translate");
  std::vector<float> noise;
  test_support::Random random(3);
  for (int n = 0; n < 200 * 200; ++n) noise.push_back(static_cast<float>(random.uniform(0, 1)));
  vpe::core::write_tiff(folder / "cut.tif", noise, 200, 200);
  // Its directory is at the end: without it, nothing; with pixels missing, the pixel.
  fs::resize_file(folder / "cut.tif", fs::file_size(folder / "cut.tif") / 2);
  EXPECT_SAYS(message_of([&] { RasterPlane(folder / "cut.tif", 200, 200).at(150, 190); }), "cut.tif",
              "cannot read");
}

}  // namespace
