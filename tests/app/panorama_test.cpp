// vpe panorama by rays, as a user runs it.
#include <cmath>
#include <csignal>
#include <cstring>

#include "mars/geodesy/pose.h"
#include "panorama/metadata/open_panorama.h"
#include "panorama/panorama_plan.h"
#include "tests/app/support/app_fixture.h"
#include "tests/app/support/tiff_numbers.h"
#include "tests/paging/planet_fixture.h"
#include "vpe/core/image/image.h"

namespace app_test {
namespace {

namespace fs = std::filesystem;

class Panorama : public AppTest {
 protected:
  Words words(const std::string& output, const Words& more = {}) const {
    Words all{"panorama", planet().string(), "--at", "10,5", "--height", "4000", "-o", output, "-q"};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
  Result make(const std::string& output, const Words& more = {}) const {
    const Result result = vpe(words(output, more));
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return result;
  }
  // Wide enough for three strips.
  static Words wide() { return {"--width", "18000", "--elevation=-3.2,-1.8"}; }
};

TEST_F(Panorama, EveryFormatHasTheSameImageAndItsDescription) {
  const Words more{"--width", "700", "--elevation=-30,20", "--yaw", "30"};
  make("p.png", more);
  make("q.tif", more);
  make("r.jpg", more);
  const vpe::core::RgbImage png = vpe::core::read_image(dir_ / "p.png");
  const std::vector<std::uint8_t> tiff = read_numbers<std::uint8_t>(dir_ / "q.tif", 3);
  ASSERT_EQ(tiff.size(), png.pixels.size() * 3);
  EXPECT_EQ(std::memcmp(tiff.data(), png.pixels.data(), tiff.size()), 0);
  EXPECT_EQ(vpe::core::read_image(dir_ / "r.jpg").width, 700);
  for (const std::string name : {"p.png", "q.tif", "r.jpg"}) {
    const auto described = panorama::describe(dir_ / name);
    EXPECT_EQ(described.sources.size(), 2U) << name;  // JSON and GPano, which have to agree
    EXPECT_EQ(described.map.kind, panorama::MapKind::kCylinder);
    EXPECT_EQ(described.map.width_px, 700);
    EXPECT_NEAR(described.map.to_direction(0, 0).azimuth_deg, 30, 1e-9);
    ASSERT_TRUE(described.viewpoint);
    EXPECT_NEAR(*described.viewpoint->height_m, 4000, 1e-9);
    EXPECT_NEAR(*described.viewpoint->ground_m + 4000, *described.viewpoint->alt_m, 1e-6);
  }
  EXPECT_EQ(leftovers(), Words{});
  EXPECT_FALSE(exists("p.png.parts"));
  const auto sidecar = parse_json(read_text(dir_ / "p.json"));
  EXPECT_EQ(sidecar["vpe"]["command"][0], "panorama");
  EXPECT_EQ(sidecar["vpe"]["recipe"]["settings"]["exaggeration"], "1");
}

// A datum on an ellipsoid: planetographic latitudes lie up to 20 km from planetocentric ones.
TEST_F(Panorama, LatitudesMayBePlanetographic) {
  write_dem(dir_ / "x.tif");
  vpe({"build", "x.tif", "-o", "e.vpe", "--base-spacing", "100000", "--datum", "ellipsoid:3396190,3376200"});
  const double centric_deg = std::atan(std::pow(3376.2 / 3396.19, 2)) * 180 / M_PI;
  const auto at = [](const char* option, double lat_deg, const char* after) -> Words {
    std::ostringstream text;
    text.precision(17);
    text << "10," << lat_deg << after;
    return {option, text.str()};
  };
  const auto run = [&](const std::string& output, double lat_deg, const Words& more) {
    Words all{"panorama", "e.vpe", "--height", "4000", "-o", output, "--backend", "polygon", "--width", "400"};
    for (const Words& part : {at("--at", lat_deg, ""), at("--interest", lat_deg, ",50000,1"), more})
      all.insert(all.end(), part.begin(), part.end());
    return vpe(all);
  };
  const Result graphic = run("g.png", 45, {"--latitude", "planetographic"});
  ASSERT_EQ(graphic.exit_code, 0) << graphic.err;
  EXPECT_FALSE(says(graphic.err, {"note: latitudes"}));
  ASSERT_EQ(run("c.png", centric_deg, {"--latitude", "planetocentric"}).exit_code, 0);
  EXPECT_NEAR(panorama::describe(dir_ / "g.png").viewpoint->lat_deg, centric_deg, 1e-9);
  EXPECT_TRUE(vpe::core::read_image(dir_ / "g.png").pixels == vpe::core::read_image(dir_ / "c.png").pixels);
  const auto interest = [&](const char* sidecar) {
    const auto all = parse_json(read_text(dir_ / sidecar))["vpe"]["recipe"]["interest"];
    return all.at(0).get<std::string>().substr(0, 15);
  };
  EXPECT_EQ(interest("g.json"), interest("c.json"));
  const Result plain = run("n.png", 45, {});
  EXPECT_TRUE(says(plain.err, {"note: latitudes", "up to 20 km", "--latitude"})) << plain.err;
  EXPECT_NEAR(panorama::describe(dir_ / "n.png").viewpoint->lat_deg, 45, 1e-12);
  // A recipe has planetocentric latitudes.
  const Result again = vpe({"panorama", "--from-sidecar", "g.json", "-o", "a.png"});
  ASSERT_EQ(again.exit_code, 0) << again.err;
  EXPECT_FALSE(says(again.err, {"note: latitudes"}));
  EXPECT_NEAR(panorama::describe(dir_ / "a.png").viewpoint->lat_deg, centric_deg, 1e-9);
  expect_failure({"panorama", "--from-sidecar", "g.json", "--latitude", "planetographic"}, 2,
                 {"--latitude and --from-sidecar"});
  // Images of render likewise; also where a configuration file asks for planetographic latitudes.
  Words render{"render", "e.vpe", "--pose", "10,45,30000", "--latitude", "planetographic", "--size", "60x40"};
  const Words region = at("--interest", 45, ",50000,1");
  render.insert(render.end(), region.begin(), region.end());
  render.insert(render.end(), {"-o", "r.png", "--backend", "polygon"});
  ASSERT_EQ(vpe(render).exit_code, 0);
  expect_failure({"render", "e.vpe", "--from-image", "r.png", "-o", "s.png", "--latitude", "planetographic"}, 2,
                 {"--latitude and --from-image"});
  write_text(dir_ / "c.toml", "[render]\nlatitude = \"planetographic\"\n");
  const Result same = vpe({"render", "e.vpe", "--from-image", "r.png", "-o", "s.png", "--config", "c.toml"});
  ASSERT_EQ(same.exit_code, 0) << same.err;
  EXPECT_EQ(read_text(dir_ / "s.png"), read_text(dir_ / "r.png"));
  for (const char* command : {"panorama", "explore"}) {
    expect_failure({command, "e.vpe", "--latitude", "geodetic"}, 2,
                   {"--latitude", "expected planetocentric, planetographic", "'geodetic'"});
  }
}

TEST_F(Panorama, FacetsAndEquirectangularDescribeThemselves) {
  make("f.png", {"--projection", "facets", "--facets", "5", "--width", "500", "--yaw", "10"});
  const auto facets = panorama::describe(dir_ / "f.png");
  EXPECT_EQ(facets.sources.size(), 1U);
  EXPECT_EQ(facets.map.kind, panorama::MapKind::kFacets);
  EXPECT_EQ(facets.map.facets, 5);
  EXPECT_NEAR(facets.map.to_direction(50, 0).azimuth_deg, 10, 1e-9);
  make("e.png", {"--projection", "equirectangular", "--width", "400", "--set", "colour=none"});
  const auto whole = panorama::describe(dir_ / "e.png");
  EXPECT_EQ(whole.sources.size(), 2U);
  EXPECT_EQ(whole.map.height_px, 200);
  // The thin air at the zenith is darker than the ground at the nadir, and both are one place.
  const vpe::core::RgbImage image = vpe::core::read_image(dir_ / "e.png");
  EXPECT_LT(image.pixels.front().r, image.pixels.back().r);
  EXPECT_NEAR(image.pixels.front().r, image.pixels[200].r, 2);
  EXPECT_NEAR(image.pixels.back().r, image.pixels[image.pixels.size() - 200].r, 2);
}

// One sample a pixel leaves stair steps, and the filter of edges needs plane images.
TEST_F(Panorama, RoundImagesHaveFourSamplesUnlessANumberIsNamed) {
  const auto pixels = [&](const Words& more) {
    Words all{"--width", "400", "--elevation=-20,10"};
    all.insert(all.end(), more.begin(), more.end());
    make("p.png", all);
    return vpe::core::read_image(dir_ / "p.png").pixels;
  };
  const auto one = pixels({"--set", "samples=1"});
  EXPECT_EQ(pixels({}), pixels({"--set", "samples=4"}));
  EXPECT_EQ(pixels({"--set", "rays.mode=discrete"}),
            pixels({"--set", "rays.mode=discrete", "--set", "rays.vertical=4"}));
  EXPECT_NE(pixels({}), one);
  EXPECT_EQ(pixels({"--set", "edges=hard"}), one);
  const Words facets{"--projection", "facets"};
  EXPECT_EQ(pixels(facets), pixels({"--projection", "facets", "--set", "samples=1"}));
}

TEST_F(Panorama, AtAPoleItIsTheOneOfItsMeridian) {
  make("n.png", {"--width", "360", "--elevation=-20,10"});
  const auto at_pole = [&](const std::string& name, const std::string& lon) {
    const Result result = vpe({"panorama", planet().string(), "--at", lon + ",90", "--height", "3000", "-o",
                               name, "--width", "360", "--elevation=-20,10", "-q", "--aux-layers", "lonlat"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
  };
  at_pole("a.png", "0");
  at_pole("b.png", "90");
  // North of the limit along the meridian of longitude 0 looks down that of 180.
  const std::vector<double> a = read_numbers<double>(dir_ / "a.lonlat.tif", 2);
  const std::vector<double> b = read_numbers<double>(dir_ / "b.lonlat.tif", 2);
  const std::size_t rows = a.size() / 720;
  const std::size_t low = (rows - 3) * 360;
  for (const std::size_t column : {1U, 100U, 200U, 358U}) {
    // Columns look to the right, clockwise from above: longitudes fall.
    const double lon_deg = 180.0 - (static_cast<double>(column) + 0.5);
    EXPECT_NEAR(std::remainder(a[2 * (low + column)] - lon_deg, 360.0), 0, 1e-6) << column;
    EXPECT_NEAR(std::remainder(b[2 * (low + column)] - lon_deg - 90, 360.0), 0, 1e-6) << column;
  }
}

TEST_F(Panorama, ResumedAfterASignalItIsTheSame) {
  for (const std::string name : {"p.tif", "p.png", "p.jpg"}) {
    Words more = wide();
    more.insert(more.end(), {"--aux-layers", "range,elevation"});
    make(name, more);
    const std::string panorama_image = read_text(dir_ / name);
    const std::string range = read_text(dir_ / "p.range.tif");
    const std::string sidecar = read_text(dir_ / "p.json");
    for (const char* file : {"p.range.tif", "p.elevation.tif", "p.json"}) fs::remove(dir_ / file);
    fs::remove(dir_ / name);

    Command command = command_for(words(name, more));
    command.signal = SIGINT;
    command.when = [&] { return exists(name + ".parts/strip_000000"); };
    const Result stopped = run(command);
    ASSERT_TRUE(stopped.signalled);
    EXPECT_EQ(stopped.exit_code, 130) << stopped.err;
    EXPECT_TRUE(says(stopped.err, {"strips of", name, "are kept", "same command"}));
    EXPECT_FALSE(exists(name));
    EXPECT_FALSE(exists("p.json"));
    EXPECT_FALSE(exists("p.range.tif"));

    // Kept strips of other settings are not taken.
    fs::create_directory(dir_ / "other");
    fs::copy(dir_ / (name + ".parts"), dir_ / "other" / (name + ".parts"));
    Words other = wide();
    other.insert(other.end(), {"--aux-layers", "range,elevation", "--set", "sun.elevation=10", "--json"});
    EXPECT_EQ(parse_json(make("other/" + name, other).out)["strips_kept"], 0);
    fs::remove_all(dir_ / "other");

    more.push_back("--json");
    const auto report = parse_json(make(name, more).out);
    EXPECT_GE(report["strips_kept"], 1);
    EXPECT_EQ(report["strips_kept"].get<int>() + report["strips_made"].get<int>(), 3);
    EXPECT_EQ(read_text(dir_ / name), panorama_image);
    EXPECT_EQ(read_text(dir_ / "p.range.tif"), range);
    EXPECT_FALSE(exists(name + ".parts"));
    auto is = parse_json(read_text(dir_ / "p.json"));
    auto was = parse_json(sidecar);
    is["vpe"].erase("command");
    was["vpe"].erase("command");
    EXPECT_EQ(is, was);
    fs::remove(dir_ / "p.json");  // it would be refused as that of another image
  }
}

TEST_F(Panorama, FromItsSidecarItHasTheSameBytes) {
  make("p.png", {"--width", "300", "--from", "300", "--to", "20.5", "--elevation=-20,10", "--set", "samples=2",
                 "--set", "exaggeration=1.7", "--sun", "2026-11-20T12:00Z", "--aux-layers",
                 "range,lonlat,elevation,slope,incidence"});
  const Result again =
      vpe({"panorama", "--from-sidecar", "p.json", "-o", "q.png", "-q", "--memory", "300", "--threads", "3"});
  ASSERT_EQ(again.exit_code, 0) << again.err;
  for (const std::string end :
       {".png", ".range.tif", ".lonlat.tif", ".elevation.tif", ".slope.tif", ".incidence.tif"})
    EXPECT_TRUE(read_text(dir_ / ("p" + end)) == read_text(dir_ / ("q" + end))) << end;
  EXPECT_EQ(parse_json(read_text(dir_ / "p.json"))["vpe"]["recipe"],
            parse_json(read_text(dir_ / "q.json"))["vpe"]["recipe"]);
  // Under its own name, in its folder.
  const std::string bytes = read_text(dir_ / "p.png");
  fs::remove(dir_ / "p.png");
  ASSERT_EQ(vpe({"panorama", "--from-sidecar", path("p.json"), "-q"}).exit_code, 0);
  EXPECT_TRUE(read_text(dir_ / "p.png") == bytes);

  expect_failure({"panorama", "--from-sidecar", "p.json", "--width=5"}, 2, {"--width and --from-sidecar"});
  // Defaults of a configuration file do not count.
  write_text(dir_ / "c.toml", "[panorama]\nwidth = 77\nbackend = \"polygon\"\n");
  fs::remove(dir_ / "q.png");
  const Result by_file =
      vpe({"panorama", "--from-sidecar", "p.json", "-o", "q.png", "-q", "--config", "c.toml"});
  ASSERT_EQ(by_file.exit_code, 0) << by_file.err;
  EXPECT_TRUE(read_text(dir_ / "q.png") == bytes);

  // Another planet is not taken for the same.
  Dem dem;
  dem.height_m = [](int, int) { return 100; };
  write_dem(dir_ / "flat.tif", dem);
  ASSERT_EQ(vpe({"build", "flat.tif", "-o", "flat.vpe", "--base-spacing", "100000", "-q"}).exit_code, 0);
  expect_failure({"panorama", "flat.vpe", "--from-sidecar", "p.json", "-o", "z.png"}, 1,
                 {"p.json", "identity", "flat.vpe", "name the right planet"});
  EXPECT_FALSE(exists("z.png"));
}

// Sidecars of earlier versions have former names of the backend and of settings.
TEST_F(Panorama, FormerSidecarsAndOptionsStillWork) {
  make("p.png",
       {"--width", "100", "--elevation=-20,10", "--aux-layers", "range", "--set", "rays.mode=reference"});
  const std::string bytes = read_text(dir_ / "p.png");
  auto json = parse_json(read_text(dir_ / "p.json"));
  auto& recipe = json["vpe"]["recipe"];
  EXPECT_EQ(recipe["backend"], "ray");
  EXPECT_EQ(recipe["settings"]["rays.mode"], "reference");
  recipe["backend"] = "voxel";
  recipe["settings"]["rays.mode"] = "plain";
  recipe["settings"]["lod.rule"] = "error";  // former name
  recipe["settings"].erase("lod.metric");
  write_text(dir_ / "old.json", json.dump());
  ASSERT_EQ(vpe({"panorama", "--from-sidecar", "old.json", "-o", "q.png", "-q"}).exit_code, 0);
  EXPECT_TRUE(read_text(dir_ / "q.png") == bytes);
  const auto made = parse_json(read_text(dir_ / "q.json"))["vpe"]["recipe"];
  EXPECT_EQ(made["backend"], "ray");
  EXPECT_EQ(made["settings"]["rays.mode"], "reference");
  EXPECT_EQ(made["settings"]["lod.metric"], "error");
  ASSERT_EQ(vpe({"panorama", "--again", "p.json", "-o", "r.png", "-q"}).exit_code, 0);  // former name
  EXPECT_TRUE(read_text(dir_ / "r.png") == bytes);
  expect_failure({"panorama", "--again", "p.json", "--planes", "range"}, 2,  // former name
                 {"--aux-layers and --from-sidecar"});
  make("s.png",
       {"--width", "100", "--elevation=-20,10", "--planes", "range", "--backend", "voxel"});  // former name
  EXPECT_TRUE(exists("s.range.tif"));
  recipe["backend"] = "scanline";
  write_text(dir_ / "bad.json", json.dump());
  expect_failure({"panorama", "--from-sidecar", "bad.json", "-o", "z.png"}, 1, {"bad.json", "'scanline'"});
}

TEST_F(Panorama, DamagedDescriptionsAreNotMadeAgain) {
  make("p.png", {"--width", "100"});
  const std::string good = read_text(dir_ / "p.json");
  const auto expect = [&](const std::string& text, const Words& parts) {
    write_text(dir_ / "x.json", text);
    Words all = parts;
    all.push_back("x.json");
    expect_failure({"panorama", "--from-sidecar", "x.json", "-o", "z.png"}, 1, all);
  };
  expect("", {"not well-formed JSON", "vpe panorama"});
  expect(good.substr(0, good.size() / 2), {"not well-formed JSON"});
  expect("[1, 2]", {"\"vpe\""});
  expect("{\"image\": \"p.png\"}", {"\"recipe\""});
  auto json = parse_json(good);
  auto changed = json;
  changed["vpe"]["recipe"].erase("eye");
  expect(changed.dump(), {"eye", "missing"});
  changed = json;
  changed["vpe"]["recipe"]["eye"]["lat_deg"] = 91;
  expect(changed.dump(), {"eye", "latitudes"});
  changed = json;
  changed["vpe"]["recipe"]["settings"]["exaggeration"] = "much";
  expect(changed.dump(), {"exaggeration"});
  changed = json;
  changed["vpe"]["recipe"]["plan"]["projection"] = 7;
  expect(changed.dump(), {"projection", "wrong type"});
  // Whole numbers are those that fit.
  for (const nlohmann::json& number : {nlohmann::json(8.5), nlohmann::json(1e300), nlohmann::json(1LL << 40),
                                       nlohmann::json(~0ULL), nlohmann::json(true)}) {
    changed = json;
    changed["vpe"]["recipe"]["memory_mb"] = number;
    expect(changed.dump(), {"memory_mb", "wrong type"});
  }
  changed = json;
  changed["vpe"]["recipe"]["plan"]["width"] = 1e300;
  expect(changed.dump(), {"width", "wrong type"});
  changed = json;
  changed["vpe"]["recipe"]["planes"] = "range,colour";
  expect(changed.dump(), {"'colour'"});
  expect_failure({"panorama", "--from-sidecar", "none.json"}, 1, {"none.json", "No such file"});
  EXPECT_FALSE(exists("z.png"));
}

TEST_F(Panorama, BadInputIsReportedBeforeAnyWork) {
  const auto refuse = [&](int code, const Words& more, const Words& parts,
                          const std::string& output = "x.png") {
    expect_failure(words(output, more), code, parts);
    EXPECT_FALSE(exists(output));
    EXPECT_FALSE(exists("x.json"));
  };
  refuse(2, {"--projection", "facets", "--facets", "0"}, {"0 facets: must be 3 to 64"});
  refuse(2, {"--projection", "facets", "--facets", "1000000"}, {"1000000 facets: must be 3 to 64"});
  refuse(2, {"--facets", "8"}, {"--facets", "cylinder", "--projection facets"});
  refuse(2, {"--projection", "mercator"}, {"'mercator'", "facets, cylinder or equirectangular"});
  refuse(2, {"--backend", "polygon", "--projection", "cylinder"}, {"planes only", "--backend ray"});
  refuse(2, {"--width", "0"}, {"width of 0"});
  refuse(2, {"--width", "2000000"}, {"must be 1 to 1000000"});
  refuse(2, {"--width", "1000000"}, {"rows high"});
  refuse(2, {"--elevation", "10"}, {"--elevation '10'", "MIN,MAX"});
  refuse(2, {"--elevation=-95,20"}, {"elevations -95 to 20"});
  refuse(2, {"--elevation=20,10"}, {"must be at least"});
  refuse(2, {"--from", "10"}, {"--from and --to"});
  refuse(2, {"--from", "0", "--to", "400"}, {"0.1 to 360"});
  refuse(2, {"--aux-layers", "range,depth"}, {"'depth'", "range, lonlat, elevation, slope, incidence"});
  refuse(2, {"--set", "nonsense=1"}, {"nonsense"});
  refuse(1, {}, {"x.bmp", ".tif, .png or .jpg"}, "x.bmp");
  refuse(1, {}, {"no folder", "none"}, "none/x.png");
  refuse(1, {"--width", "66000", "--elevation=-5,5"}, {"x.jpg", "65500", ".tif"}, "x.jpg");
  refuse(1, {"--width", "1000000", "--elevation=-5,5", "--memory", "64"}, {"x.png", "--memory", ".tif"});
  fs::create_directory(dir_ / "d.range.tif");
  refuse(1, {"--aux-layers", "range"}, {"d.range.tif", "folder"}, "d.png");
  expect_failure({"panorama", planet().string(), "-o", "x.png"}, 2, {"--at"});
  expect_failure({"panorama", planet().string(), "--at", "1,2", "-o", "x.png"}, 2, {"--height", "--altitude"});
  expect_failure({"panorama", planet().string(), "--at", "1,92", "--height", "2", "-o", "x.png"}, 2,
                 {"latitude"});
  expect_failure({"panorama", planet().string(), "--at", "nowhere", "--height", "2", "-o", "x.png"}, 2,
                 {"LON,LAT"});
  // Hills of 3 km rise here: so low is under ground.
  expect_failure({"panorama", planet().string(), "--at", "90,0", "--altitude", "0", "-o", "x.png", "-q"}, 1,
                 {"m above the ground", "--height, --altitude"});
  expect_failure({"panorama", planet().string(), "--at", "30,0", "--height", "0", "-o", "x.png", "-q"}, 1,
                 {"0 m above the ground"});
  write_text(dir_ / "mine.json", "{\"image\": \"mine.jpg\"}");
  refuse(1, {}, {"mine.json", "did not write it", "mine.png"}, "mine.png");
  EXPECT_TRUE(exists("mine.json"));
  fs::create_directory(dir_ / "locked");
  fs::permissions(dir_ / "locked", fs::perms::owner_read | fs::perms::owner_exec);
  if (::access((dir_ / "locked").c_str(), W_OK) != 0) refuse(1, {}, {"locked", "permissions"}, "locked/x.png");
}

// A planet of constant height with posts 20 m apart around the camera: the reference surface is the sphere
// within 2e-5 m there.
class PanoramaSphere : public Panorama {};

TEST_F(PanoramaSphere, LayersAreThoseOfTheSphere) {
  const double kLon_deg = 20;
  const double kLat_deg = 30;
  const double kHeight_m = 50;
  const glm::dvec3 below = mars::direction({kLon_deg, kLat_deg});
  const test_support::FakeElevation flat([](const glm::dvec3&) { return 0.0; },
                                         test_support::fine_around(below, 1e-4, 20));
  test_support::build_fake(dir_ / "flat.vpe", flat, 1e6);
  for (const std::string projection : {"cylinder", "equirectangular", "facets"}) {
    const Result result = vpe({"panorama", "flat.vpe", "--at", "20,30", "--height", "50", "-o", "s.png",
                               "--width", "320", "--elevation=-60,-10", "--projection", projection, "-q",
                               "--aux-layers", "range,lonlat,elevation,slope,incidence"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const panorama::PanoramaMap map = panorama::describe(dir_ / "s.png").map;
    const auto range = read_numbers<float>(dir_ / "s.range.tif");
    const auto lonlat = read_numbers<double>(dir_ / "s.lonlat.tif", 2);
    const auto elevation = read_numbers<float>(dir_ / "s.elevation.tif");
    const auto slope = read_numbers<float>(dir_ / "s.slope.tif");
    const auto incidence = read_numbers<float>(dir_ / "s.incidence.tif");
    ASSERT_EQ(range.size(), static_cast<std::size_t>(map.width_px * map.height_px));
    const double radius_m = mars::kMarsRadius_m;
    const mars::LocalFrame frame = mars::local_frame({kLon_deg, kLat_deg});
    const glm::dvec3 camera_m = below * (radius_m + kHeight_m);
    constexpr double kSagitta_m = 2e-5;
    double worst = 0;
    for (std::size_t n = 0; n < range.size(); n += 7) {
      const auto d = map.to_direction(static_cast<double>(n % 320) + 0.5, static_cast<double>(n / 320) + 0.5);
      const mars::SinCos a = mars::sin_cos_deg(d.azimuth_deg);
      const mars::SinCos e = mars::sin_cos_deg(d.elevation_deg);
      const glm::dvec3 ray = frame.east * (e.cos * a.sin) + frame.north * (e.cos * a.cos) + frame.up * e.sin;
      // |camera + t ray| = radius, without cancellation.
      const double b = glm::dot(camera_m, ray);
      const double c = kHeight_m * (2 * radius_m + kHeight_m);
      const double t = c / (-b + std::sqrt(b * b - c));
      const glm::dvec3 hit = camera_m + ray * t;
      const double sine = -glm::dot(glm::normalize(hit), ray);
      const double off = std::abs(range[n] - t) / (1e-6 / sine * t + kSagitta_m / sine);
      worst = std::max(worst, off);
      ASSERT_LE(off, 1) << n << ": " << range[n] << " " << t;
      const glm::dvec3 place = mars::direction({lonlat[2 * n], lonlat[2 * n + 1]});
      ASSERT_LT(glm::length(place - glm::normalize(hit)) * radius_m,
                1e-6 / sine * t + kSagitta_m / sine + 1e-7);
      ASSERT_LE(std::abs(elevation[n]), kSagitta_m);
      ASSERT_LT(slope[n], 0.001);
      ASSERT_NEAR(incidence[n], std::asin(sine) / mars::kRadiansPerDegree, 0.002);
    }
    RecordProperty("worst_share_of_bound_" + projection, std::to_string(worst));
  }
}

TEST_F(Panorama, LayersAreNanInTheSky) {
  make("p.png",
       {"--width", "300", "--elevation=-20,40", "--aux-layers", "range,lonlat,elevation,slope,incidence"});
  const auto range = read_numbers<float>(dir_ / "p.range.tif");
  const auto lonlat = read_numbers<double>(dir_ / "p.lonlat.tif", 2);
  const auto incidence = read_numbers<float>(dir_ / "p.incidence.tif");
  EXPECT_TRUE(std::isnan(range.front()));
  EXPECT_TRUE(std::isnan(lonlat.front()));
  EXPECT_FALSE(std::isnan(range.back()));
  for (std::size_t n = 0; n < range.size(); ++n) {
    ASSERT_EQ(std::isnan(range[n]), std::isnan(lonlat[2 * n + 1]));
    ASSERT_EQ(std::isnan(range[n]), std::isnan(incidence[n]));
  }
}

TEST_F(Panorama, OfManyStripsIsThatOfPieces) {
  // The same directions from a View of its own.
  make("w.png", wide());
  make("a.png", {"--degrees-per-pixel", "0.02", "--from", "200", "--to", "220", "--elevation=-3.2,-1.8"});
  const vpe::core::RgbImage wide_image = vpe::core::read_image(dir_ / "w.png");
  const vpe::core::RgbImage arc = vpe::core::read_image(dir_ / "a.png");
  ASSERT_EQ(arc.width, 1000);
  ASSERT_EQ(arc.height, wide_image.height);
  int different = 0;
  for (int y = 0; y < arc.height; ++y) {
    for (int x = 0; x < arc.width; ++x) {
      const vpe::base::Rgb a = arc.pixels[static_cast<std::size_t>(y * arc.width + x)];
      const vpe::base::Rgb b = wide_image.pixels[static_cast<std::size_t>(y * wide_image.width + x + 10000)];
      different += std::abs(a.r - b.r) > 2 || std::abs(a.g - b.g) > 2 || std::abs(a.b - b.b) > 2;
    }
  }
  // Outlines may fall to the other side by rounding.
  EXPECT_LT(different, arc.width * arc.height / 10000);
}

// Most of the time is drawing.
class LongPanorama : public Panorama {};

TEST_F(LongPanorama, MemoryIsBounded) {
  const Words more{"--width", "100000", "--elevation=-4,8", "--memory", "256", "--aux-layers", "range"};
  const Result result = run([&] {
    Command command = command_for(words("p.tif", more));
    command.limit_s = 1500;
    return command;
  }());
  ASSERT_EQ(result.exit_code, 0) << result.err;
  RecordProperty("peak_bytes", std::to_string(result.peak_bytes));
  EXPECT_LT(result.peak_bytes, std::int64_t{256 + 64} << 20);
  const auto described = panorama::describe(dir_ / "p.tif");
  EXPECT_EQ(described.map.width_px, 100000);
}

}  // namespace
}  // namespace app_test
