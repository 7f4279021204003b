// One image, its ranges and its certificate.
#include <cmath>

#include "mars/geodesy/mars_time.h"
#include "tests/app/support/app_fixture.h"
#include "vpe/base/number.h"
#include "vpe/core/frame.h"
#include "vpe/core/image/image.h"
#include "vpe/gl/context.h"

namespace app_test {
namespace {

using nlohmann::json;

class Render : public AppTest {
 protected:
  Result render(const Words& more, const std::string& pose, const std::string& output = "x.png",
                const std::string& size = "96x54") const {
    Words words{"render", planet().string(), "--pose", pose, "-o", output, "--size", size};
    words.insert(words.end(), more.begin(), more.end());
    return vpe(words);
  }
};

TEST_F(Render, ImageRangeAndCertificate) {
  const Result result =
      render({"--range", "r.tif", "--certificate", "c.json", "--json", "--fov", "60", "--backend", "polygon"},
             "-74,-13.5,300000,0,-30,0");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const json report = parse_json(result.out);
  EXPECT_EQ(report["output"], "x.png");
  EXPECT_EQ(report["backend"], "polygon");
  EXPECT_EQ(report["certificate"], parse_json(read_text(dir_ / "c.json")));
  const json& c = report["certificate"];
  EXPECT_GT(c["shift_bound_px"], 0);
  EXPECT_GT(c["picture_bound_px"], 0);
  EXPECT_LE(c["picture_bound_px"], c["shift_bound_px"]);
  EXPECT_LE(c["shift_bound_px"], 1.01);  // the default tolerance and the quantisation
  EXPECT_EQ(c["tolerance_px"], 1);
  EXPECT_EQ(c["tiles_missing"], 0);
  EXPECT_EQ(c["illustration"], false);
  EXPECT_EQ(c["share_without_data"], 0);
  EXPECT_TRUE(c["source_accuracy_m"].is_null());
  EXPECT_GT(report["stats"]["triangles"], 0);
  EXPECT_EQ(report["stats"]["tiles_drawn"], c["tiles_drawn"]);

  const auto image = vpe::core::read_image(dir_ / "x.png");
  EXPECT_EQ(image.width, 96);
  EXPECT_EQ(image.height, 54);
  const auto range = vpe::core::read_tiff(dir_ / "r.tif");
  ASSERT_EQ(range.width, 96);
  ASSERT_EQ(range.height, 54);
  // The upper edge looks at the horizontal, 23 degrees above the horizon; the lower one 60 degrees down.
  int sky = 0;
  for (int x = 0; x < 96; ++x) {
    EXPECT_EQ(range.pixels[static_cast<std::size_t>(x)], vpe::core::kSkyRange);
    const float near = range.pixels[static_cast<std::size_t>(53 * 96 + x)];
    EXPECT_GT(near, 290e3F);
    EXPECT_LT(near, 600e3F);
  }
  for (const float r : range.pixels) {
    sky += std::isinf(r) ? 1 : 0;
    if (!std::isinf(r)) {
      EXPECT_GT(r, 290e3F);
      EXPECT_LT(r, 1.6e6F);  // somewhat more than the horizon's distance
    }
  }
  EXPECT_GT(sky, 96 * 54 / 8);
  EXPECT_LT(sky, 96 * 54 / 2);
}

TEST_F(Render, AutoChoosesTheBackend) {
  const auto backend = [&](Words more, const std::string& pose, const std::string& file = "x.png") {
    more.emplace_back("--json");
    const Result result = render(more, pose, file);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    const json report = parse_json(result.out);
    EXPECT_LE(report["certificate"]["shift_bound_px"], 1.01);
    return report["backend"].get<std::string>();
  };
  const std::string far = "-74,-13.5,60000,20,-20,0";
  const std::string down = "-74,-13.5,60000,20,-90,0";
  EXPECT_EQ(backend({}, down), "polygon");
  EXPECT_EQ(backend({"--set", "mode=wireframe"}, far), "polygon");
  EXPECT_EQ(backend({"--explain-lod", "e.json"}, far), "polygon");
  EXPECT_EQ(backend({"--backend", "auto"}, far, "a.png"), vpe::gl::has_gpu() ? "polygon" : "ray");
  if (vpe::gl::has_gpu()) GTEST_SKIP() << "skipped: triangles are drawn wherever there is a GPU";
  EXPECT_EQ(backend({"--backend", "ray", "--set", "rays.mode=multires"}, far, "b.png"), "ray");
  EXPECT_EQ(read_text(dir_ / "a.png"), read_text(dir_ / "b.png"));
  // Where there is no OpenGL at all.
  Command command = command_for({"render", planet().string(), "--pose", far, "-o", "c.png", "--size", "96x54"});
  command.environment["__EGL_VENDOR_LIBRARY_FILENAMES"] = path("none.json");
  EXPECT_EQ(run(command).exit_code, 0);
}

TEST_F(Render, StraightDownTheRangeIsTheAltitudeOverTheTerrain) {
  const json answer = parse_json(vpe({"query", planet().string(), "31,1", "--json"}).out)[0];
  const double ground = answer["elevation_m"].get<double>();
  // An odd size has a middle pixel.
  const auto middle_m = [&](Words more, const std::string& pose) {
    more.insert(more.end(), {"--range", "r.tif", "--tolerance", "0"});
    EXPECT_EQ(render(more, pose, "x.png", "33x33").exit_code, 0);
    return vpe::core::read_tiff(dir_ / "r.tif").pixels.at(16 * 33 + 16);
  };
  EXPECT_NEAR(middle_m({}, "31,1,100000,0,-90,0"), 100000 - ground, 1);
  EXPECT_NEAR(middle_m({"--height", "100000"}, "31,1,0,-90,0"), 100000, 1);
  // The sagitta is not exaggerated, and small beside ten times the heights.
  EXPECT_NEAR(middle_m({"--set", "exaggeration=10"}, "31,1,100000,0,-90,0"), 100000 - 10 * ground, 1300);
}

TEST_F(Render, SameImageAgainAndInOtherFormats) {
  ASSERT_EQ(render({}, "286,-13.5,300000,20,-40,5", "a.png").exit_code, 0);
  ASSERT_EQ(render({"--threads", "1"}, "-74,-13.5,300000,20,-40,5", "b.png").exit_code, 0);
  EXPECT_EQ(read_text(dir_ / "a.png"), read_text(dir_ / "b.png"));
  ASSERT_EQ(render({}, "-74,-13.5,300000,20,-40,5", "c.JPG").exit_code, 0);
  EXPECT_EQ(read_text(dir_ / "c.JPG").substr(0, 3), "\xFF\xD8\xFF");
  ASSERT_EQ(render({"--set", "mode=wireframe"}, "-74,-13.5,300000,20,-40,5", "Bild mit Ü.png").exit_code, 0);
  EXPECT_NE(read_text(dir_ / "Bild mit Ü.png"), read_text(dir_ / "a.png"));
  EXPECT_EQ(leftovers(), Words{});
}

TEST_F(Render, TheSunOfADateOrASeason) {
  const auto pixels_of = [&](const Words& more) {
    Words words{"--set", "mode=lit"};
    words.insert(words.end(), more.begin(), more.end());
    const Result result = render(words, "-74,-13.5,300000,0,-90,0", "s.png");
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return vpe::core::read_image(dir_ / "s.png").pixels;
  };
  const auto brightness = [](const std::vector<vpe::base::Rgb>& pixels) {
    double sum = 0;
    for (const vpe::base::Rgb& p : pixels) sum += p.r;
    return sum / static_cast<double>(pixels.size());
  };
  const auto noon = pixels_of({"--sun", "Ls0,12:00"});
  const auto evening = pixels_of({"--sun", "Ls0,17:30"});
  const auto night = pixels_of({"--sun", "ls0,00:00"});
  EXPECT_GT(brightness(noon), 1.3 * brightness(evening));
  EXPECT_GT(brightness(evening), 1.3 * brightness(night));
  EXPECT_EQ(pixels_of({"--set", "sun=Ls0,17:30"}), evening);
  EXPECT_EQ(pixels_of({"--sun", "Ls0,12:00", "--set", "sun=Ls0,17:30"}), evening);
  EXPECT_EQ(pixels_of({"--sun", "local"}), pixels_of({}));

  // By date, and by that sun's azimuth and elevation at the ground below the camera.
  const mars::LonLat below{-74, -13.5};
  const mars::MarsTime time = mars::mars_time(1795176000);  // 2026-11-20T12:00Z
  const mars::SunPosition at =
      mars::sun_position(below, mars::direction({time.subsolar_lon_deg, time.subsolar_lat_deg}));
  const auto dated = pixels_of({"--sun", "2026-11-20T14:00+02:00"});
  const auto put = pixels_of({"--set", "sun.azimuth=" + vpe::base::format_number(at.azimuth_deg), "--set",
                              "sun.elevation=" + vpe::base::format_number(at.elevation_deg)});
  ASSERT_EQ(dated.size(), put.size());
  for (std::size_t n = 0; n < put.size(); ++n) ASSERT_NEAR(dated[n].r, put[n].r, 1) << n;
  EXPECT_GT(brightness(dated), 1.3 * brightness(night));
}

TEST_F(Render, ExplainsTheLevelOfEveryDrawnTile) {
  const std::string pose = "-74,-13.5,300000,20,-40,5";
  const auto explain = [&](Words more) {
    more.insert(more.end(), {"--explain-lod", "e.json", "--json"});
    const Result result = render(more, pose);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    json out = parse_json(read_text(dir_ / "e.json"));
    // The explained tiles are those that were drawn.
    const json stats = parse_json(result.out)["stats"];
    EXPECT_EQ(out["tiles"].size(), stats["tiles_drawn"]);
    EXPECT_EQ(out["triangles"], stats["triangles"]);
    return out;
  };
  const json plain = explain({});
  EXPECT_EQ(plain["rule"], "error");
  EXPECT_EQ(plain["tolerance_px"], 1);
  ASSERT_FALSE(plain["tiles"].empty());
  for (const json& tile : plain["tiles"]) {
    EXPECT_TRUE(tile["reason"] == "finest there" || tile["reason"] == "within tolerance") << tile.dump();
    EXPECT_EQ(tile["shift_levels"], 0);
    EXPECT_GT(tile["post_spacing_m"], 0);
    EXPECT_GE(tile["lod"], 0);
  }
  // A coarse region over the whole planet.
  const json coarse = explain({"--interest", "0,0,1e8,-3"});
  EXPECT_LT(coarse["triangles"], plain["triangles"]);
  for (const json& tile : coarse["tiles"]) EXPECT_EQ(tile["interest"]["levels"], -3);
  // The metric distance: the same level everywhere when the scale is 0. Levels count from 0, the numbers of the
  // metric from 1.
  const json flat = explain(
      {"--set", "lod.metric=distance", "--set", "lod.distance.scale=0", "--set", "lod.distance.offset=1.9"});
  EXPECT_EQ(flat["rule"], "distance");
  for (const json& tile : flat["tiles"]) {
    EXPECT_EQ(tile["lod"], 0);  // (int) 1.9 - 1
    EXPECT_EQ(tile["wanted_lod"], 0);
    EXPECT_EQ(tile["distance"]["weighted"], 1.9);
  }
  const json spent = explain({"--tolerance", "0", "--set", "lod.triangles=5000"});
  EXPECT_EQ(spent["budget_spent"], true);
  EXPECT_LE(spent["triangles"], 5000);
  EXPECT_NE(spent.dump().find("budget spent"), std::string::npos);
}

TEST_F(Render, ADamagedTileIsNamed) {
  // Tolerance 0 draws grids of posts, larger tolerances draw meshes.
  const std::vector<std::pair<std::string, std::string>> cases{{"heights", "0"}, {"mesh", "20"}};
  for (const auto& [table, tolerance] : cases) {
    SCOPED_TRACE(table);
    std::filesystem::copy_file(planet(), dir_ / "damaged.vpe",
                               std::filesystem::copy_options::overwrite_existing);
    damage_payloads(dir_ / "damaged.vpe", table);
    for (const char* pose : {"0,0,9e6,0,-90,0", "180,0,9e6,0,-90,0", "0,90,9e6,0,-90,0", "0,-90,9e6,0,-90,0"}) {
      const Result result = vpe({"render", "damaged.vpe", "--pose", pose, "-o", "x.png", "--size", "64x64",
                                 "--tolerance", tolerance, "--backend", "polygon"});
      EXPECT_EQ(result.exit_code, 1) << "signal " << result.signal;
      EXPECT_TRUE(says(result.err, {"damaged.vpe", "damaged", "build"}));
      EXPECT_FALSE(exists("x.png"));
    }
  }
  EXPECT_EQ(leftovers(), Words{});
}

}  // namespace
}  // namespace app_test
