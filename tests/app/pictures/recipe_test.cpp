// What images of vpe render say of themselves: the recipe in PNG files, and the metadata of ranges.
#include <gdal_priv.h>
#include <png.h>

#include <cmath>
#include <memory>

#include "tests/app/support/app_fixture.h"
#include "vpe/core/image/image.h"

namespace app_test {
namespace {

using nlohmann::json;

// Returns a text of a PNG file, as libpng reads it.
std::string png_text_of(const std::filesystem::path& path, const std::string& keyword) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"), std::fclose);
  png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  std::string found;
  png_init_io(png, file.get());
  png_set_user_limits(png, 100000, 100000);
  png_read_info(png, info);
  png_textp texts = nullptr;
  int count = 0;
  png_get_text(png, info, &texts, &count);
  for (int n = 0; n < count; ++n) {
    if (texts[n].key == keyword) found = texts[n].text;
  }
  png_destroy_read_struct(&png, &info, nullptr);
  return found;
}

class Recipe : public AppTest {
 protected:
  Result render(const Words& more) const {
    Words words{"render", planet().string()};
    words.insert(words.end(), more.begin(), more.end());
    return vpe(words);
  }
};

TEST_F(Recipe, IsInThePngAndMakesTheSameFileAgain) {
  const std::vector<Words> images{
      {"--pose", "286,-13.5,20000,20,-10,5", "--tolerance", "2", "--sun", "Ls90,15:00"},
      {"--pose", "-74,-13.5", "--height", "3000", "--backend", "polygon", "--set", "exaggeration=3",
       "--interest", "-74,-13,100000,1", "--cull-from", "-74,-13.5,30000"},
      {"--pose", "-74,-13.5,3000000", "--fov", "40", "--set", "overlay.title=Äußerstes", "--backend", "ray"},
      {"--pose", "-74,-13.5,30000", "--stereo", "sbs"}};
  for (const Words& image : images) {
    Words words = image;
    words.insert(words.end(), {"-o", "a.png", "--size", "96x54"});
    const Result made = render(words);
    ASSERT_EQ(made.exit_code, 0) << made.err;
    const json text = parse_json(png_text_of(dir_ / "a.png", "vpe"));
    EXPECT_EQ(text.at("planet").at("identity"),
              parse_json(vpe({"info", planet().string(), "--json"}).out)["identity"]);
    EXPECT_TRUE(text.at("recipe").at("pose").get<std::string>().starts_with("-74,-13.5,")) << text;
    EXPECT_TRUE(text.at("certificate").is_object());
    EXPECT_TRUE(png_text_of(dir_ / "a.png", "Software").starts_with("vpe "));
    const Result again = render({"--from-image", "a.png", "-o", "b.png"});
    ASSERT_EQ(again.exit_code, 0) << again.err;
    EXPECT_EQ(read_text(dir_ / "a.png"), read_text(dir_ / "b.png")) << image[1];
  }
}

TEST_F(Recipe, OtherFilesAndOptionsBesideItAreRefused) {
  ASSERT_EQ(render({"--pose", "0,0,300000", "-o", "a.png", "--size", "9x9"}).exit_code, 0);
  const std::string p = planet().string();
  expect_failure({"render", p, "--from-image", "a.png", "-o", "b.png", "--fov", "50"}, 2,
                 {"--fov and --from-image"});
  expect_failure({"render", p, "--from-image", "none.png", "-o", "b.png"}, 1, {"none.png"});
  write_text(dir_ / "text.png", "no image");
  expect_failure({"render", p, "--from-image", "text.png", "-o", "b.png"}, 1, {"text.png", "no complete PNG"});
  const std::vector<vpe::base::Rgb> pixels(9);
  vpe::core::write_image(dir_ / "bare.png", pixels, 3, 3);
  expect_failure({"render", p, "--from-image", "bare.png", "-o", "b.png"}, 1, {"bare.png", "no recipe"});
  Dem other;
  other.height_m = [](int x, int y) { return 10.0 * x + y; };
  write_dem(dir_ / "other.tif", other);
  ASSERT_EQ(
      vpe({"build", "other.tif", "--datum", "areoid", "--base-spacing", "90000", "-o", "other.vpe"}).exit_code,
      0);
  expect_failure({"render", "other.vpe", "--from-image", "a.png", "-o", "b.png"}, 1,
                 {"a.png", "identity", "other.vpe"});
  EXPECT_FALSE(exists("b.png"));
}

TEST_F(Recipe, RangesHaveUnitCameraAndTheValueOfTheSky) {
  ASSERT_EQ(render({"--pose", "-74,-13.5,300000,10,-30,5", "-o", "a.png", "--size", "96x54", "--fov", "60",
                    "--range", "r.tif"})
                .exit_code,
            0);
  GDALAllRegister();
  const std::unique_ptr<GDALDataset> file(GDALDataset::Open(path("r.tif").c_str()));
  ASSERT_NE(file, nullptr);
  EXPECT_STREQ(file->GetMetadataItem("TIFFTAG_SOFTWARE"),
               vpe({"--version"}).out.substr(0, vpe({"--version"}).out.find('\n')).c_str());
  GDALRasterBand* band = file->GetRasterBand(1);
  EXPECT_STREQ(band->GetUnitType(), "m");
  EXPECT_STREQ(band->GetDescription(), "range");
  int has_nodata = 0;
  const double nodata = band->GetNoDataValue(&has_nodata);
  EXPECT_TRUE(has_nodata != 0 && std::isinf(nodata) && nodata > 0);
  const auto item = [&](const char* key) { return std::string(file->GetMetadataItem(key)); };
  EXPECT_EQ(item("camera_lon_deg"), "-74");
  EXPECT_EQ(item("camera_alt_m"), "300000");
  EXPECT_EQ(item("camera_roll_deg"), "5");
  EXPECT_NEAR(std::stod(item("focal_px")), 27 / std::tan(M_PI / 6), 1e-9);
  EXPECT_EQ(item("principal_point_px"), "48,27");
  EXPECT_EQ(item("planet_radius_m"), "3396190");
  // It is known as the program's own, and replaced.
  EXPECT_EQ(render({"--pose", "0,0,300000", "-o", "a.png", "--size", "9x9", "--range", "r.tif"}).exit_code, 0);
  // The values are those of the contract.
  EXPECT_TRUE(std::isinf(vpe::core::read_tiff(dir_ / "r.tif").pixels.front()));
}

}  // namespace
}  // namespace app_test
