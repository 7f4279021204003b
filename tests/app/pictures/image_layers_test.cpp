// Image layers from the command line: builds, images of both backends, films, maps, and what is refused.
#include <cmath>
#include <fstream>
#include <functional>
#include <memory>

#include "tests/app/support/app_fixture.h"
#include "vpe/app/picture/layer_check.h"
#include "vpe/app/planet/layer_names.h"
#include "vpe/core/image/image.h"

namespace app_test {
namespace {

using nlohmann::json;
using vpe::core::RgbImage;

// Writes NAME.vrt over NAME.raw: three bands of bytes in degrees on the sphere of Mars. The function gives a grey value of
// longitude and latitude.
void write_grey(const std::filesystem::path& folder, const std::string& name, double west_deg, double north_deg,
                double cell_deg, int columns, int rows, const std::function<double(double, double)>& value) {
  std::string data;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const double v = value(west_deg + (column + 0.5) * cell_deg, north_deg - (row + 0.5) * cell_deg);
      data += static_cast<char>(static_cast<unsigned char>(std::lround(v)));
    }
  }
  std::ofstream(folder / (name + ".raw"), std::ios::binary) << data;
  std::string bands;
  for (int band = 1; band <= 3; ++band) {
    bands += "<VRTRasterBand dataType=\"Byte\" band=\"" + std::to_string(band) +
             "\" subClass=\"VRTRawRasterBand\"><ColorInterp>" +
             std::string(band == 1   ? "Red"
                         : band == 2 ? "Green"
                                     : "Blue") +
             "</ColorInterp><SourceFilename relativeToVRT=\"1\">" + name +
             ".raw</SourceFilename><ImageOffset>0</ImageOffset><PixelOffset>1</PixelOffset><LineOffset>" +
             std::to_string(columns) + "</LineOffset></VRTRasterBand>";
  }
  std::ofstream(folder / (name + ".vrt"))
      << "<VRTDataset rasterXSize=\"" << columns << "\" rasterYSize=\"" << rows
      << "\"><SRS>+proj=longlat +R=3396190 +no_defs</SRS><GeoTransform>" << west_deg << ", " << cell_deg
      << ", 0, " << north_deg << ", 0, " << -cell_deg << "</GeoTransform>" << bands << "</VRTDataset>";
}

double wide_value(double lon_deg, double lat_deg) {
  return 120 + 50 * std::sin(0.4 * lon_deg) * std::cos(0.5 * lat_deg) + 20 * std::sin(2.1 * lon_deg + lat_deg);
}

class ImageLayersCommand : public AppTest {
 protected:
  static void SetUpTestSuite() { built_ = std::make_unique<test_support::TempDir>(); }
  static void TearDownTestSuite() { built_.reset(); }

  void SetUp() override {
    write_dem(dir_ / "x.tif");
    write_grey(dir_.path(), "wide", -180, 90, 1, 360, 180, wide_value);
    // The same ground, darker and of less contrast.
    write_grey(dir_.path(), "inset", 10, 10, 0.1, 200, 200,
               [](double lon_deg, double lat_deg) { return 0.5 * wide_value(lon_deg, lat_deg) + 10; });
    if (!std::filesystem::exists(*built_ / "p.vpe")) {
      const Result made = build("p.vpe", {"--images-apart"});
      ASSERT_EQ(made.exit_code, 0) << made.err;
      std::filesystem::copy_file(dir_ / "p.vpe", *built_ / "p.vpe");
    } else {
      std::filesystem::copy_file(*built_ / "p.vpe", dir_ / "p.vpe");
    }
  }

  Result build(const std::string& output, const Words& more) const {
    Words words{"build",     "x.tif", "--image", "wide.vrt",       "--image",
                "inset.vrt", "-o",    output,    "--base-spacing", "100000"};
    words.insert(words.end(), more.begin(), more.end());
    return vpe(words);
  }

  // Renders straight down on the border of the inset.
  RgbImage render(const std::string& backend, const std::string& layers,
                  const std::string& planet = "p.vpe") const {
    Words words{"render",    planet,  "--pose", "10,0,900000,0,-90,0", "--size", "160x120",
                "--backend", backend, "--set",  "mode=textured",       "--set",  "light=off",
                "-o",        "x.png", "--quiet"};
    if (!layers.empty()) words.insert(words.end(), {"--set", "image.layers=" + layers});
    const Result result = vpe(words);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return vpe::core::read_image(dir_ / "x.png");
  }

  static double mean_difference(const RgbImage& a, const RgbImage& b) {
    EXPECT_EQ(a.pixels.size(), b.pixels.size());
    double sum = 0;
    for (std::size_t n = 0; n < a.pixels.size(); ++n) sum += std::abs(a.pixels[n].g - b.pixels[n].g);
    return sum / static_cast<double>(a.pixels.size());
  }

 private:
  static std::unique_ptr<test_support::TempDir> built_;
};
std::unique_ptr<test_support::TempDir> ImageLayersCommand::built_;

TEST_F(ImageLayersCommand, InfoListsThem) {
  const json info = parse_json(vpe({"info", "p.vpe", "--json"}).out);
  const json& layers = info.at("image_layers");
  ASSERT_EQ(layers.size(), 2U);
  EXPECT_EQ(layers[0]["name"], "wide");
  EXPECT_EQ(layers[1]["name"], "inset");
  EXPECT_EQ(layers[1]["source"], "inset.vrt");
  EXPECT_TRUE(says(vpe({"info", "p.vpe"}).out, {"image layer", "wide (wide.vrt, ", "inset (inset.vrt, "}));
  EXPECT_EQ(vpe({"verify", "p.vpe"}).exit_code, 0);
}

TEST_F(ImageLayersCommand, BothBackendsShowTheChosenLayers) {
  for (const char* layers :
       {"", "wide;inset", "wide", "inset", "wide low=60 high=180 gamma=1.5;inset@0.5", "inset;wide@0.7"}) {
    SCOPED_TRACE(layers);
    EXPECT_LT(mean_difference(render("ray", layers), render("polygon", layers)), 2.5);
  }
  const RgbImage plain = render("ray", "");
  EXPECT_LT(mean_difference(plain, render("ray", "wide;inset")), 1.5);
  EXPECT_GT(mean_difference(plain, render("ray", "wide")), 10);
  EXPECT_GT(mean_difference(plain, render("ray", "inset")), 10);
  EXPECT_EQ(render("ray", "wide;inset@0").pixels, render("ray", "wide").pixels);
  EXPECT_LT(mean_difference(render("ray", "inset;wide"), render("ray", "wide")), 0.5);
}

TEST_F(ImageLayersCommand, AnImageKeepsThemInItsRecipe) {
  const RgbImage first = render("ray", "wide;inset@0.5");
  std::filesystem::copy_file(dir_ / "x.png", dir_ / "first.png");
  ASSERT_EQ(vpe({"render", "p.vpe", "--from-image", "first.png", "-o", "again.png", "--quiet"}).exit_code, 0);
  EXPECT_EQ(read_text(dir_ / "first.png"), read_text(dir_ / "again.png"));
}

TEST_F(ImageLayersCommand, ColoursAreMatchedAtTheBoundary) {
  const Result made = build("matched.vpe", {"--images-apart", "--match-colour"});
  ASSERT_EQ(made.exit_code, 0) << made.err;
  EXPECT_TRUE(says(
      made.err, {"inset.vrt: colours matched to the imagery below: red ", "the median difference there was"}));
  const json info = parse_json(vpe({"info", "matched.vpe", "--json"}).out);
  EXPECT_TRUE(says(info["image_sources"].dump(), {"colours matched to the imagery below: red "}));
  // The inset shows more detail than what lies below it, and no other brightness.
  EXPECT_LT(mean_difference(render("ray", "", "matched.vpe"), render("ray", "wide", "matched.vpe")), 5);
  EXPECT_GT(mean_difference(render("ray", ""), render("ray", "wide")), 10);
}

TEST_F(ImageLayersCommand, AFlightChangesThem) {
  write_text(dir_ / "f.flight",
             "flight 1\nview fov=50 size=80x60 fps=2\nat 0 set mode=textured light=off\n"
             "at 0 pose lon=12 lat=5 alt=900000 pitch=-90\nat 1 set image.layers=\"wide;inset@0.5\"\n"
             "at 2 pose lon=12 lat=5 alt=900000 pitch=-90\n");
  for (const char* backend : {"ray", "polygon"}) {
    SCOPED_TRACE(backend);
    const std::string out = std::string("out-") + backend;
    const Words words{"fly", "f.flight", "p.vpe", "-o", out, "--backend", backend, "--json"};
    const Result made = vpe(words);
    ASSERT_EQ(made.exit_code, 0) << made.err;
    const auto frame = [&](int k) {
      return vpe::core::read_image(dir_ / out / ("frame_00000" + std::to_string(k) + ".png"));
    };
    EXPECT_EQ(frame(0).pixels, frame(1).pixels);
    EXPECT_EQ(frame(2).pixels, frame(3).pixels);
    EXPECT_GT(mean_difference(frame(1), frame(2)), 5);
    // A film that is made again keeps its frames.
    std::filesystem::remove(dir_ / out / "frame_000003.png");
    const std::string kept = read_text(dir_ / out / "frame_000002.png");
    ASSERT_EQ(vpe(words).exit_code, 0);
    EXPECT_EQ(read_text(dir_ / out / "frame_000002.png"), kept);
    EXPECT_EQ(frame(2).pixels, frame(3).pixels);
  }
}

TEST_F(ImageLayersCommand, AMapShowsThem) {
  const auto map = [&](const std::string& output, const Words& more) {
    Words words{"map",     "p.vpe",  "--box", "5,-5,15,5", "--spacing", "5000",
                "--bands", "colour", "-o",    output,      "--quiet"};
    words.insert(words.end(), more.begin(), more.end());
    return vpe(words);
  };
  for (const auto& [name, layers] :
       {std::pair{"a.tif", "wide;inset@0"}, {"b.tif", "wide"}, {"c.tif", "wide;inset"}}) {
    const Result made = map(name, {"--image-layers", layers});
    ASSERT_EQ(made.exit_code, 0) << made.err;
  }
  EXPECT_NE(read_text(dir_ / "b.tif"), read_text(dir_ / "c.tif"));
  EXPECT_EQ(map("d.tif", {"--image-layers", "x"}).exit_code, 1);
  expect_failure(
      {"map", "p.vpe", "--box", "5,-5,15,5", "--spacing", "5000", "-o", "e.tif", "--image-layers", "wide"}, 2,
      {"--image-layers", "colour"});
}

TEST_F(ImageLayersCommand, APartAndAPatchHaveThem) {
  for (const char* part : {"1/2", "2/2"})
    ASSERT_EQ(build("q.vpe", {"--images-apart", "--part", part}).exit_code, 0);
  ASSERT_EQ(vpe({"merge", "q.1-of-2.vpe", "q.2-of-2.vpe", "-o", "q.vpe"}).exit_code, 0);
  const auto identity = [&](const std::string& planet) {
    return parse_json(vpe({"info", planet, "--json"}).out).at("identity").get<std::string>();
  };
  ASSERT_EQ(build("again.vpe", {"--images-apart"}).exit_code, 0);
  EXPECT_EQ(identity("q.vpe"), identity("again.vpe"));
  write_grey(dir_.path(), "small", 40, 5, 0.05, 100, 100, wide_value);
  const Result patched = vpe({"patch", "again.vpe", "--image", "small.vrt", "-o", "patched.vpe"});
  ASSERT_EQ(patched.exit_code, 0) << patched.err;
  ASSERT_EQ(build("full.vpe", {"--image", "small.vrt", "--images-apart"}).exit_code, 0);
  EXPECT_EQ(identity("patched.vpe"), identity("full.vpe"));
  EXPECT_EQ(parse_json(vpe({"info", "patched.vpe", "--json"}).out).at("image_layers").size(), 3U);
}

TEST_F(ImageLayersCommand, WrongNamesAreRefused) {
  const auto fails = [&](const Words& more, const Words& parts, const std::string& planet = "p.vpe") {
    Words words{"render", planet, "--pose", "10,0,900000,0,-90,0", "-o", "y.png"};
    words.insert(words.end(), more.begin(), more.end());
    expect_failure(words, 2, parts);
  };
  fails({"--set", "image.layers=viking"}, {"image.layers='viking'", "its layers are wide, inset"});
  ASSERT_EQ(build("plain.vpe", {}).exit_code, 0);
  fails({"--set", "image.layers=wide"}, {"plain.vpe", "--images-apart"}, "plain.vpe");
  write_text(dir_ / "f.flight",
             "flight 1\nview size=80x60 fps=2\nat 0 pose lon=12 lat=5 alt=900000\n"
             "at 0.5 set image.layers=viking\nat 1 pose lon=12 lat=5 alt=900000\n");
  expect_failure({"fly", "f.flight", "p.vpe", "-o", "out"}, 2,
                 {"the flight at 0.5 s", "its layers are wide, inset"});

  const auto refused = [&](const Words& more, const Words& parts) {
    Words words{"build", "x.tif", "-o", "no.vpe"};
    words.insert(words.end(), more.begin(), more.end());
    expect_failure(words, 2, parts);
  };
  const Words two{"--image", "wide.vrt", "--image", "inset.vrt"};
  const auto with = [&](const char* option) {
    Words words = two;
    words.emplace_back(option);
    return words;
  };
  refused(with("--images-apart=a;a"), {"'a' stands twice"});
  refused(with("--images-apart=a;b;c"), {"3 names for 2 images"});
  refused(with("--images-apart=a@0.5"), {"'a@0.5' cannot name the layer of wide.vrt"});
  refused({"--images-apart"}, {"none is given"});
  const Result named = build("named.vpe", {"--images-apart=low ground;high@x"});
  ASSERT_EQ(named.exit_code, 0) << named.err;
  EXPECT_EQ(parse_json(vpe({"info", "named.vpe", "--json"}).out)["image_layers"][1]["name"], "high@x");
}

TEST(LayerNames, AreThoseOfFilesOrGiven) {
  using vpe::app::layer_names;
  const Words images{"a/x.tif", "b/x.img", "c.tif"};
  EXPECT_EQ(layer_names(images, "stem"), (Words{"x", "x-2", "c"}));
  EXPECT_EQ(layer_names(images, "one;two;three"), (Words{"one", "two", "three"}));
  // A patch adds images without names.
  EXPECT_EQ(layer_names(images, "one;c"), (Words{"one", "c", "c-2"}));
  EXPECT_THROW(layer_names(images, "one;;two"), std::exception);
  EXPECT_THROW(layer_names({"x low=3.tif"}, "stem"), std::exception);
}

TEST_F(ImageLayersCommand, SettingsOfAnotherPlanetLoseTheirLayers) {
  const auto planet = paging::PlanetFile::open(path("p.vpe"));
  vpe::core::SettingsValues settings;
  settings.image_layers = "wide;inset@0.5";
  EXPECT_EQ(vpe::app::leave_out_layers(settings, *planet), "");
  EXPECT_EQ(settings.image_layers, "wide;inset@0.5");
  vpe::app::require_layers(settings, *planet);
  settings.image_layers = "viking";
  EXPECT_THROW(vpe::app::require_layers(settings, *planet), std::exception);
  EXPECT_TRUE(says(vpe::app::leave_out_layers(settings, *planet), {"p.vpe", "'viking'", "wide, inset"}));
  EXPECT_EQ(settings.image_layers, "");
}

}  // namespace
}  // namespace app_test
