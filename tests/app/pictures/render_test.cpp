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
  EXPECT_EQ(backend({"--set", "shading=vertex"}, far), "polygon");
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

TEST_F(Render, WithoutOpenGLRaysDrawWhatNobodyNamed) {
  const auto without_gl = [&](const Words& words) {
    Command command = command_for(words);
    command.environment["__EGL_VENDOR_LIBRARY_FILENAMES"] = path("none.json");
    return run(command);
  };
  Words down{"render", planet().string(), "--pose", "-74,-13.5,60000,20,-90,0",
             "-o",     "c.png",           "--size", "96x54"};
  const Result result = without_gl(down);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_TRUE(says(result.err, {"drawn by rays, as there is no OpenGL"})) << result.err;
  EXPECT_TRUE(exists("c.png"));
  for (const Words& named : {Words{"--backend", "polygon"}, Words{"--set", "mode=wireframe"},
                             Words{"--set", "shading=vertex"}, Words{"--explain-lod", "e.json"}}) {
    Words words = down;
    words.insert(words.end(), named.begin(), named.end());
    EXPECT_EQ(without_gl(words).exit_code, 1) << named.front();
  }
  write_text(dir_ / "f.flight",
             "flight 1\nview size=32x18 fps=2\nat 0 pose lon=137 lat=0 alt=9e6 pitch=-90\n"
             "at 1 pose lon=138 lat=0 alt=9e6 pitch=-90\n");
  const Result film = without_gl({"fly", "f.flight", planet().string(), "-o", "f"});
  EXPECT_EQ(film.exit_code, 0) << film.err;
  EXPECT_TRUE(says(film.err, {"drawn by rays, as there is no OpenGL"})) << film.err;
  EXPECT_TRUE(says(without_gl({"doctor"}).out, {"drawn by rays"}));
}

TEST_F(Render, RaysRefuseWhatTheyCannotDo) {
  const std::string pose = "-74,-13.5,60000,20,-20,0";
  for (const Words& words : {Words{"--explain-lod", "e.json"}, Words{"--interest", "-74,-13.5,1e5,2"},
                             Words{"--set", "lod.metric=distance"}, Words{"--set", "lod.centre.weight=3"},
                             Words{"--set", "lod.triangles=10"}, Words{"--set", "shading=vertex"}}) {
    Words all{"--backend", "ray"};
    all.insert(all.end(), words.begin(), words.end());
    const Result result = render(all, pose, "no.png");
    EXPECT_NE(result.exit_code, 0) << words.back();
    EXPECT_TRUE(says(result.err, {"polygon"}) || says(result.err, {"triangles"})) << result.err;
    EXPECT_FALSE(exists("no.png")) << words.back();
    // Nobody named rays: triangles do it, or rays in another mode.
    const Result automatic = render(words, pose, "yes.png");
    EXPECT_EQ(automatic.exit_code, 0) << automatic.err;
  }
}

TEST_F(Render, RaysHaveLevelControlInMultires) {
  const std::string pose = "-74,-13.5,60000,20,-20,0";
  const Words rays{"--backend", "ray", "--set", "rays.mode=multires", "--set", "rays.cell=8"};
  EXPECT_EQ(render(rays, pose, "plain.png").exit_code, 0);
  for (const Words& words : {Words{"--interest", "-74,-13.5,1e6,4"}, Words{"--set", "lod.centre.weight=3"}}) {
    Words all = rays;
    all.insert(all.end(), words.begin(), words.end());
    const Result result = render(all, pose, "controlled.png");
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_NE(read_text(dir_ / "controlled.png"), read_text(dir_ / "plain.png")) << words.back();
  }
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
  EXPECT_NEAR(middle_m({"--height", "100000"}, "31,1,777,0,-90,0"), 100000, 1);
  // The sagitta is not exaggerated, and small beside ten times the heights.
  EXPECT_NEAR(middle_m({"--set", "exaggeration=10"}, "31,1,100000,0,-90,0"), 100000 - 10 * ground, 1300);
}

TEST_F(Render, PosesThatCanBeReadInTwoWaysAreToldOrRefused) {
  const Words height{"--height", "100000"};
  const Result five = render(height, "31,1,0,-90,0", "x.png", "33x33");
  EXPECT_TRUE(says(five.err, {"'31,1,0,-90,0' with --height is read as yaw 0, pitch -90, roll 0"})) << five.err;
  for (const char* pose : {"31,1,0", "31,1,0,-90"}) {
    const Result result = render(height, pose, "y.png", "33x33");
    EXPECT_EQ(result.exit_code, 2) << pose;
    EXPECT_TRUE(says(result.err, {pose, "--height", "ALT"})) << result.err;
  }
  EXPECT_EQ(render({}, "1e300,0,100000,0,-90,0", "y.png").exit_code, 2);
  EXPECT_EQ(render({}, "361,0,100000,0,-90,0", "y.png").exit_code, 2);
}

TEST_F(Render, ACameraBelowTheGroundIsRefusedUnlessAllowed) {
  const json answer = parse_json(vpe({"query", planet().string(), "31,1", "--json"}).out)[0];
  const std::string pose = "31,1," + std::to_string(answer["elevation_m"].get<double>() - 200) + ",0,-10,0";
  for (const char* backend : {"polygon", "ray"}) {
    const Result result = render({"--backend", backend}, pose, "below.png");
    EXPECT_EQ(result.exit_code, 1) << backend;
    EXPECT_TRUE(says(result.err, {pose, "200 m below the ground", "--height", "--allow-underground"}))
        << result.err;
    EXPECT_FALSE(exists("below.png"));
    const Result allowed = render({"--backend", backend, "--allow-underground", "--certificate", "c.json"},
                                  pose, std::string(backend) + ".png");
    EXPECT_EQ(allowed.exit_code, 0) << allowed.err;
    EXPECT_TRUE(says(allowed.out, {"below the ground"})) << allowed.out;
    const json certificate = parse_json(read_text(dir_ / "c.json"));
    EXPECT_TRUE(certificate["shift_bound_px"].is_null());
    EXPECT_TRUE(certificate["picture_bound_px"].is_null());
    EXPECT_EQ(certificate["below_ground"], true);
  }
  EXPECT_EQ(vpe::core::read_image(dir_ / "polygon.png").pixels, vpe::core::read_image(dir_ / "ray.png").pixels);
  EXPECT_EQ(render({"--height", "-3"}, "31,1", "y.png").exit_code, 1);
  const Result beyond = render({}, "31,1,-9000000,0,80,0", "y.png");
  EXPECT_EQ(beyond.exit_code, 2);
  EXPECT_TRUE(says(beyond.err, {"not above the planet's centre"})) << beyond.err;
}

TEST_F(Render, WideImagesSayWhatTheirCornersAre) {
  const Result result = render({"--fov", "150", "--certificate", "c.json"}, "31,1,100000,0,-40,0", "wide.png");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_TRUE(says(result.out, {"px in the corners"})) << result.out;
  const json certificate = parse_json(read_text(dir_ / "c.json"));
  const double edge = std::tan(75 * M_PI / 180);
  EXPECT_NEAR(certificate["corner_stretch"].get<double>(), 1 + edge * edge * (1 + std::pow(96.0 / 54, 2)),
              1e-6);
  EXPECT_TRUE(says(certificate["what_this_means"].get<std::string>(), {"towards its corners"}));
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

TEST_F(Render, TheSunOfADateIsToldWithANoteAtNight) {
  const std::string gale = "137.44,-4.6,100000,0,-90,0";
  const Result night = render({"--sun", "2015-07-21T12:00Z"}, gale);
  EXPECT_EQ(night.exit_code, 0) << night.err;
  EXPECT_TRUE(says(night.err, {"Sun: Ls 16.1, LTST 00:12, azimuth ", "elevation -86", "It is night there"}))
      << night.err;
  const json told = parse_json(render({"--sun", "2015-07-21T12:00Z", "--json"}, gale).out)["sun"];
  EXPECT_EQ(told["night"], true);
  EXPECT_NEAR(told["solar_longitude_deg"].get<double>(), 16.1, 0.06);
  EXPECT_NEAR(told["true_solar_time_h"].get<double>(), 0.2, 0.02);
  const Result day = render({"--sun", "Ls90,15:00"}, gale);
  EXPECT_TRUE(says(day.err, {"Sun: Ls 90.0, LTST 15:00"})) << day.err;
  EXPECT_EQ(day.err.find("night"), std::string::npos);
  EXPECT_EQ(render({"--sun", "Ls90,15:00", "-q"}, gale).err, "");
  EXPECT_EQ(render({}, gale).err.find("Sun:"), std::string::npos);
  EXPECT_TRUE(parse_json(render({"--json"}, gale).out)["sun"].is_null());
  write_text(dir_ / "f.flight",
             "flight 1\nview size=32x18 fps=2\nat 0 pose lon=137 lat=0 alt=900000 pitch=-60\n"
             "at 1 pose lon=138 lat=0 alt=900000 pitch=-60\n");
  const Result film =
      vpe({"fly", "f.flight", planet().string(), "-o", "f", "--json", "--sun", "2015-07-21T12:00Z"});
  EXPECT_TRUE(says(film.err, {"Sun: Ls 16.1", "night"})) << film.err;
  EXPECT_EQ(parse_json(film.out)["sun"]["night"], true);
  const Result panorama = vpe({"panorama", planet().string(), "--at", "137.44,-4.6", "--height", "1000", "-o",
                               "p.png", "--width", "128", "--json", "--sun", "2015-07-21T12:00Z"});
  EXPECT_TRUE(says(panorama.err, {"Sun: Ls 16.1", "night"})) << panorama.err;
  EXPECT_EQ(parse_json(panorama.out)["sun"]["night"], true);
}

TEST_F(Render, DatesAreThoseOfMars) {
  Dem dem;
  dem.radius_m = 1737400;
  write_dem(dir_ / "moon.tif", dem);
  ASSERT_EQ(vpe({"build", "moon.tif", "-o", "moon.vpe", "--base-spacing", "100000"}).exit_code, 0);
  const Result result = vpe({"render", "moon.vpe", "--pose", "0,0,1e6,0,-90,0", "-o", "x.png", "--size",
                             "32x32", "--sun", "2015-07-21T12:00Z"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_TRUE(says(result.err, {"Moon", "sun.azimuth"})) << result.err;
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

TEST_F(Render, ExplainsTheTilesThatRaysCast) {
  const std::string pose = "-74,-13.5,300000,20,-40,5";
  const auto explain = [&](Words more) {
    more.insert(more.end(),
                {"--explain-lod", "e.json", "--json", "--backend", "ray", "--set", "rays.mode=multires"});
    const Result result = render(more, pose);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    const json out = parse_json(read_text(dir_ / "e.json"));
    const json drawn = parse_json(result.out);
    EXPECT_EQ(out["tiles"].size(), drawn["stats"]["tiles_drawn"]);
    double largest_m = 0;
    double largest_px = 0;
    std::vector<int> by_level(drawn["stats"]["tiles_by_level"].size());
    for (const json& tile : out["tiles"]) {
      largest_m = std::max(largest_m, tile["error_m"].get<double>());
      largest_px = std::max(largest_px, tile["error_px"].get<double>());
      ++by_level.at(tile["lod"].get<std::size_t>());
      EXPECT_FALSE(tile.contains("mesh"));
    }
    EXPECT_EQ(largest_m, drawn["certificate"]["tile_error_m"]);
    EXPECT_EQ(largest_px, drawn["certificate"]["tile_error_px"]);
    EXPECT_EQ(by_level, drawn["stats"]["tiles_by_level"].get<std::vector<int>>());
    return out;
  };
  const json plain = explain({"--set", "rays.cell=2"});
  EXPECT_EQ(plain["rule"], "error");
  EXPECT_EQ(plain["tolerance_px"], 2);
  // The planet has one level; voxel/explain_tiles_test has the other reasons.
  for (const json& tile : plain["tiles"]) EXPECT_EQ(tile["reason"], "finest there") << tile.dump();
  const json flat = explain(
      {"--set", "lod.metric=distance", "--set", "lod.distance.scale=0", "--set", "lod.distance.offset=1.9"});
  EXPECT_EQ(flat["rule"], "distance");
  for (const json& tile : flat["tiles"]) EXPECT_EQ(tile["wanted_lod"], 0) << tile.dump();
  const json thinned = explain({"--set", "rays.fovea=0.3"});
  EXPECT_EQ(thinned["thinned_tolerance_px"], 2);
  // Contours are found over finer ground, which is not that of the image.
  if (vpe::core::overlays_refused().empty())
    (void)explain({"--set", "rays.cell=8", "--set", "overlay.contours=on"});
}

TEST_F(Render, WeightsOfABudgetNeedOne) {
  const std::string pose = "-74,-13.5,60000,20,-60,0";
  for (const Words& words :
       {Words{"--backend", "ray", "--set", "rays.mode=multires"}, Words{"--backend", "polygon"}}) {
    Words all = words;
    all.insert(all.end(), {"--set", "degrade.centre=0"});
    const Result result = render(all, pose, "no.png");
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_TRUE(says(result.err, {"degrade", "lod.triangles"})) << result.err;
    EXPECT_FALSE(exists("no.png"));
  }
  const Words capped{"--backend", "polygon", "--set", "lod.triangles=3000", "--tolerance", "0.05"};
  EXPECT_EQ(render(capped, pose, "even.png").exit_code, 0);
  Words weighed = capped;
  weighed.insert(weighed.end(), {"--set", "degrade.centre=0"});
  const Result result = render(weighed, pose, "centre.png");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(read_text(dir_ / "centre.png"), read_text(dir_ / "even.png"));
}

TEST_F(Render, TooLittleMemoryForTheToleranceIsTold) {
  write_dem(dir_ / "fine.tif");
  ASSERT_EQ(vpe({"build", "fine.tif", "-o", "fine.vpe", "--base-spacing", "20000", "-q"}).exit_code, 0);
  const auto drawn = [&](const Words& more) {
    Words words{"render", "fine.vpe",    "--pose", "20,0,9e6,0,-90,0", "-o",     "x.png", "--size",
                "64x48",  "--tolerance", "0",      "--backend",        "polygon"};
    words.insert(words.end(), more.begin(), more.end());
    return vpe(words);
  };
  const Result little = drawn({"--memory", "64"});
  EXPECT_EQ(little.exit_code, 0) << little.err;
  EXPECT_TRUE(
      says(little.err, {"coarser than --tolerance 0", "--memory 64", "111848 triangles", "--backend ray"}));
  for (const Words& more : {Words{"--memory", "1024"}, Words{"--memory", "64", "-q"},
                            Words{"--memory", "64", "--set", "lod.triangles=1000"}}) {
    const Result result = drawn(more);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(result.err.find("coarser than"), std::string::npos) << result.err;
  }
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
