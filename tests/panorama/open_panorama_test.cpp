// Descriptions of images, and their contradictions.
#include "panorama/metadata/open_panorama.h"

#include <cmath>
#include <cstdio>
#include <fstream>

#include "panorama/metadata/gpano.h"
#include "tests/panorama/test_images.h"
#include "vpe/base/file.h"

namespace {

namespace fs = std::filesystem;
using panorama::describe;
using panorama::MapKind;
using panorama::PanoramaDescription;
using panorama_test::message_of;

const panorama::PanoramaMap kMap = panorama::cylinder_map(360, 60, 360, 15.0, 30.0);

// A cylinder of 360 x 60 with GPano inside.
fs::path image_with_gpano(const test_support::TempDir& folder, const std::string& name) {
  const fs::path path = folder / name;
  vpe::core::write_image(path, panorama_test::pixels(360, 60), 360, 60);
  panorama::write_xmp(path, panorama::to_xmp(panorama::gpano_of(kMap)));
  return path;
}

void write(const fs::path& path, const std::string& text) { vpe::base::write_file(path, text); }

std::string said(const fs::path& path) {
  return message_of([&] { describe(path); });
}

TEST(OpenPanorama, FindsGPanoInside) {
  const test_support::TempDir folder;
  for (const char* name : {"a.png", "b.jpg"}) {
    const fs::path path = image_with_gpano(folder, name);
    const PanoramaDescription d = describe(path);
    EXPECT_EQ(d.image, path);
    EXPECT_LT(panorama::largest_difference_px(d.map, kMap), 1e-9);
    EXPECT_TRUE(d.heading_is_known);
    EXPECT_FALSE(d.viewpoint);
    ASSERT_EQ(d.sources.size(), 1U);
    EXPECT_SAYS(d.sources[0], "GPano", name);
  }
}

TEST(OpenPanorama, JsonComesFirstAndAgrees) {
  const test_support::TempDir folder;
  const fs::path path = image_with_gpano(folder, "a.png");
  panorama::Sidecar sidecar{"a.png", kMap, panorama::RecordedViewpoint{137.0, -4.5, {}, 2.0, {}, {}}};
  sidecar.map.horizon_px += 0.4;  // what GPano rounds
  write(folder / "a.json", panorama::to_text(sidecar));
  for (const fs::path& given : {path, folder / "a.json"}) {
    const PanoramaDescription d = describe(given);
    EXPECT_EQ(d.image, path);
    EXPECT_DOUBLE_EQ(d.map.horizon_px, 30.4);
    EXPECT_EQ(d.sources.size(), 2U);
    EXPECT_SAYS(d.sources[0], "a.json");
    ASSERT_TRUE(d.viewpoint);
    EXPECT_EQ(d.viewpoint->lon_deg, 137.0);
  }
}

TEST(OpenPanorama, ContradictionsNameBoth) {
  const test_support::TempDir folder;
  const fs::path path = image_with_gpano(folder, "a.png");
  panorama::Sidecar sidecar{"a.png", kMap, {}};
  sidecar.map.turn_azimuth_deg += 5.0;
  write(folder / "a.json", panorama::to_text(sidecar));
  EXPECT_SAYS(said(path), "a.json", "GPano in", "5", "remove");
  sidecar.map = panorama::cylinder_map(361, 60, 361, 15.0, 30.0);
  write(folder / "a.json", panorama::to_text(sidecar));
  EXPECT_SAYS(said(path), "a.json", "a.png", "361x60", "360x60");
  sidecar = {"other.png", kMap, {}};
  write(folder / "a.json", panorama::to_text(sidecar));
  EXPECT_SAYS(said(path), "a.json", "other.png");
  fs::remove(folder / "a.json");
  // GPano of another size than the file's.
  panorama::GPano gpano = panorama::gpano_of(kMap);
  gpano.cropped_height_px = 61;
  panorama::write_xmp(path, panorama::to_xmp(gpano));
  EXPECT_SAYS(said(path), "GPano in", "a.png", "360x61", "360x60");
}

TEST(OpenPanorama, NothingFoundSaysWhatToGive) {
  const test_support::TempDir folder;
  vpe::core::write_image(folder / "a.png", panorama_test::pixels(20, 10), 20, 10);
  EXPECT_SAYS(said(folder / "a.png"), "a.png", "a.json", "projection", "GPano");
  write(folder / "b.bin", "nothing known");
  EXPECT_SAYS(said(folder / "b.bin"), "b.bin", "neither PNG, JPEG nor TIFF");
  write(folder / "empty.png", "");
  EXPECT_SAYS(said(folder / "empty.png"), "empty.png");
  EXPECT_SAYS(said(folder / "none.png"), "none.png");
  EXPECT_SAYS(said(folder / "none.json"), "none.json");
  EXPECT_SAYS(said(folder.path()), "cannot read");
  write(folder / "c.json",
        "{\"projection\": \"cylinder\", \"width\": 1, \"height\": 1, \"azimuth_deg_at_left\": 0, "
        "\"columns_per_turn\": 1, \"horizon_row\": 0}");
  EXPECT_SAYS(said(folder / "c.json"), "c.json", "names no image");
  write(folder / "a.json", "{\"projection\": ");
  EXPECT_SAYS(said(folder / "a.png"), "a.json", "JSON");
  // A JSON never names images in other folders.
  panorama::Sidecar sidecar{"../../a.png", panorama::cylinder_map(20, 10, 20, 0, 5), {}};
  write(folder / "d.json", panorama::to_text(sidecar));
  write(folder / "a.json", panorama::to_text({"a.png", sidecar.map, {}}));
  EXPECT_EQ(describe(folder / "d.json").image, folder / "a.png");
}

TEST(OpenPanorama, CutImagesAreMessages) {
  const test_support::TempDir folder;
  const fs::path path = image_with_gpano(folder, "a.png");
  fs::resize_file(path, fs::file_size(path) - 20);
  EXPECT_SAYS(said(path), "a.png", "cut short");
}

const std::string kParms =
    "GROUP = SURFACE_PROJECTION_PARMS\n MAP_PROJECTION_TYPE = CYLINDRICAL\n MAP_RESOLUTION = (1.0, 1.0)\n"
    " START_AZIMUTH = 90.0\n ZERO_ELEVATION_LINE = 31.0\nEND_GROUP\nEND\n";

TEST(OpenPanorama, FindsLabelsBesideAndInside) {
  const test_support::TempDir folder;
  vpe::core::write_image(folder / "a.png", panorama_test::pixels(360, 60), 360, 60);
  for (const char* name : {"a.lbl", "a.LBL"}) {
    write(folder / name, "PDS_VERSION_ID = PDS3\n" + kParms);
    const PanoramaDescription d = describe(folder / "a.png");
    EXPECT_SAYS(d.sources.at(0), name);
    EXPECT_EQ(d.map.kind, MapKind::kEquirectangular);
    EXPECT_NEAR(d.map.to_direction(0.5, 30.5).azimuth_deg, 90.0, 1e-9);
    EXPECT_NEAR(d.map.to_direction(0.5, 30.5).elevation_deg, 0.0, 1e-9);
    fs::remove(folder / name);
  }
  write(folder / "a.LBL", "PDS_VERSION_ID = PDS3\n" + kParms);
  panorama::write_xmp(folder / "a.png", panorama::to_xmp(panorama::gpano_of(kMap)));
  EXPECT_SAYS(said(folder / "a.png"), "a.LBL", "GPano in", "contradicts");

  write(folder / "raw.img",
        "PDS_VERSION_ID = PDS3\nOBJECT = IMAGE\n LINES = 60\n LINE_SAMPLES = 360\nEND_OBJECT\n" + kParms +
            std::string(360 * 60, '\1'));
  const PanoramaDescription raw = describe(folder / "raw.img");
  EXPECT_EQ(raw.format, panorama::ImageFileFormat::kOther);
  EXPECT_EQ(raw.map.width_px, 360);
  EXPECT_SAYS(raw.sources.at(0), "label in", "raw.img");
  write(folder / "no_size.img", "PDS_VERSION_ID = PDS3\n" + kParms);
  EXPECT_SAYS(said(folder / "no_size.img"), "no_size.img", "size");
}

TEST(OpenPanorama, HeadingMayBeUnknown) {
  const test_support::TempDir folder;
  const fs::path path = image_with_gpano(folder, "a.png");
  panorama::GPano gpano = panorama::gpano_of(kMap);
  gpano.heading_deg.reset();
  panorama::write_xmp(path, panorama::to_xmp(gpano));
  EXPECT_FALSE(describe(path).heading_is_known);
}

TEST(OpenPanorama, TheNavcamMosaicOpens) {
  VPE_NEED_SHARED(path, "pano-navcam1051/N_L000_1051_ILT048CYL_S_2470_UNCORM1.jpg");
  const PanoramaDescription d = describe(path);
  EXPECT_EQ(d.map.kind, MapKind::kEquirectangular);
  EXPECT_EQ(d.format, panorama::ImageFileFormat::kJpeg);
  EXPECT_EQ(d.map.width_px, 7696);
  EXPECT_EQ(d.map.height_px, 1800);
  EXPECT_TRUE(d.map.is_full_turn());
  EXPECT_DOUBLE_EQ(360.0 / d.map.turn_px, 0.046777);
  EXPECT_NEAR(std::remainder(d.map.to_direction(0.5, 0.5).azimuth_deg, 360.0), 0.0, 1e-9);
  EXPECT_NEAR(d.map.to_direction(0.5, 0.5).elevation_deg, 17.7171, 1e-9);
  EXPECT_NEAR(d.map.to_direction(0.0, 1800.0).elevation_deg, -66.48, 0.03);
  ASSERT_TRUE(d.viewpoint);
  EXPECT_EQ(d.viewpoint->lon_deg, 137.37024);
  EXPECT_EQ(d.viewpoint->lat_deg, -4.66798364);
  EXPECT_EQ(d.viewpoint->ground_m, -4446.783203);
  EXPECT_EQ(d.viewpoint->height_m, 1.97);
  EXPECT_EQ(d.viewpoint->datum, mars::VerticalDatum::areoid());

  // Places that were measured in the image, by pixel centres.
  VPE_NEED_SHARED(targets, "pano-navcam1051/azel_targets_N_L000_1051_ILT048CYL_S_2470_UNCORM1_sol1051.csv");
  std::ifstream lines(targets);
  std::string line;
  std::getline(lines, line);
  int count = 0;
  while (std::getline(lines, line)) {
    double sample = 0, row = 0, azimuth_deg = 0, elevation_deg = 0;
    char name[64];
    ASSERT_EQ(
        std::sscanf(line.c_str(), "%lf,%lf,%63[^,],%lf,%lf", &sample, &row, name, &azimuth_deg, &elevation_deg),
        5);
    EXPECT_NEAR(d.map.to_direction(sample + 0.5, row + 0.5).azimuth_deg, azimuth_deg, 0.01) << name;
    EXPECT_NEAR(d.map.to_direction(sample + 0.5, row + 0.5).elevation_deg, elevation_deg, 0.01) << name;
    ++count;
  }
  EXPECT_EQ(count, 3);
}

TEST(OpenPanorama, TheNavcamGraticuleLiesOnItsPixels) {
  VPE_NEED_SHARED(path, "pano-navcam1051/N_L000_1051_ILT048CYL_S_2470_UNCORM1.jpg");
  const panorama::PanoramaMap map = describe(path).map;
  const vpe::core::RgbImage image = vpe::core::read_image(path);
  const auto mean_of_column = [&](int column) {
    double sum = 0;
    for (int row = 0; row < image.height; ++row) {
      sum += image
                 .pixels[static_cast<std::size_t>(row) * static_cast<std::size_t>(image.width) +
                         static_cast<std::size_t>((column + image.width) % image.width)]
                 .r;
    }
    return sum / image.height;
  };
  // Lines of 10 degrees that are drawn over no ground: the brightest of five columns is the one that the map
  // names.
  for (const double azimuth_deg : {0.0, 30.0, 60.0, 90.0, 240.0, 270.0, 300.0, 330.0}) {
    const auto at = map.to_pixel({azimuth_deg, 0.0});
    ASSERT_TRUE(at);
    const int column = static_cast<int>(at->x);
    const double bright = mean_of_column(column);
    for (const int beside : {-2, -1, 1, 2})
      EXPECT_GT(bright, mean_of_column(column + beside) + 5.0) << azimuth_deg;
  }
}

}  // namespace
