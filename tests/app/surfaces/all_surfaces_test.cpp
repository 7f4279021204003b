// vpe query --all-surfaces against lines through all triangles of the models, by brute force.
#include "objects/files/model_file.h"
#include "tests/app/surfaces/surface_fixture.h"
#include "tests/objects/spans/line_oracle.h"
#include "tests/support/worst.h"

namespace app_test {
namespace {

namespace oracle = objects::line_oracle;

class AllSurfaces : public SurfaceTest {
 protected:
  // Compares the surfaces of one thing at random places within its reach and outside with those of its triangles.
  void compare(const Thing& thing, double reach_m, int count, std::uint64_t seed, int least_with_gaps = 0);
};

// Returns places whose verticals pass a square about that of a place, at a radius from the planet's centre.
std::vector<mars::LonLat> places_around(const mars::LonLat& middle, double radius_m, double reach_m, int count,
                                        std::uint64_t seed) {
  test_support::Random random(seed);
  std::vector<mars::LonLat> places;
  for (int n = 0; n < count; ++n) {
    const double east_m = random.uniform(-reach_m, reach_m);
    const double north_m = random.uniform(-reach_m, reach_m);
    places.push_back({middle.lon_deg + east_m / radius_m / std::cos(middle.lat_deg * kDegree) / kDegree,
                      middle.lat_deg + north_m / radius_m / kDegree});
  }
  return places;
}

void AllSurfaces::compare(const Thing& thing, double reach_m, int count, std::uint64_t seed,
                          int least_with_gaps) {
  const std::vector<mars::LonLat> places =
      places_around(thing.place, kRadius_m + thing.altitude_m, reach_m, count, seed);
  const json answers = ask(places, {"--with-objects", write_scene({thing})});
  ASSERT_EQ(answers.size(), places.size());
  float low = 1e9F;
  float high = -1e9F;
  for (const glm::vec3& p : thing.mesh.positions_m) {
    low = std::min({low, p.x, p.y, p.z});
    high = std::max({high, p.x, p.y, p.z});
  }
  const double stick_m = thing.voxels > 0 ? thing.scale * static_cast<double>(high - low) / thing.voxels : 1e-4;
  // About the object's origin, so that nothing is lost by rounding; heights count from there.
  const glm::dvec3 position_m = (kRadius_m + thing.altitude_m) * up_at(thing.place);
  const auto triangles = oracle::placed(thing.mesh, axes_of(thing), glm::dvec3(0));
  int compared = 0;
  int outside = 0;
  int many = 0;
  double worst = 0;
  for (std::size_t n = 0; n < places.size(); ++n) {
    const json& surfaces = answers[n]["surfaces"];
    const glm::dvec3 up = up_at(places[n]);
    const glm::dvec3 foot = (kRadius_m + thing.altitude_m) * up - position_m;
    const auto expected = oracle::meetings(triangles, foot, up, 1e-3 * stick_m);
    const auto around = oracle::neighbourhood(triangles, foot, up, stick_m, 1e-3 * stick_m);
    // Always: in order, each side after the other, the ground once, ends within the error of some triangle.
    int grounds = 0;
    bool is_top = true;
    std::vector<double> heights_m;
    for (std::size_t k = 0; k < surfaces.size(); ++k) {
      const json& s = surfaces[k];
      const double height_m = s["height_m"];
      EXPECT_TRUE(k == 0 || height_m <= surfaces[k - 1]["height_m"].get<double>());
      EXPECT_NEAR(s["above_ground_m"].get<double>(), height_m - answers[n]["elevation_m"].get<double>(), 1e-6);
      if (s["surface"] == "ground") {
        ++grounds;
        EXPECT_EQ(s["side"], "top");
        EXPECT_TRUE(s["object"].is_null());
        EXPECT_EQ(height_m, answers[n]["elevation_m"].get<double>());
        EXPECT_EQ(s["surface_error_m"], 0);
        continue;
      }
      EXPECT_EQ(s["object"], thing.name);
      EXPECT_EQ(s["side"], is_top ? "top" : "underside");
      is_top = !is_top;
      const double stated_m = s["surface_error_m"];
      EXPECT_LE(stated_m, 2 * stick_m);
      const double away_m = oracle::distance(triangles, foot + (height_m - thing.altitude_m) * up);
      worst = std::max(worst, away_m / stated_m);
      heights_m.push_back(height_m - thing.altitude_m);
    }
    EXPECT_EQ(grounds, 1);
    EXPECT_TRUE(is_top);
    if (!around.is_clear) continue;
    ASSERT_EQ(heights_m.size(), expected.size()) << n << " " << surfaces.dump();
    if (expected.empty()) ++outside;
    if (expected.size() > 2) ++many;
    compared += expected.empty() ? 0 : 1;
    for (std::size_t k = 0; k < heights_m.size(); ++k) {
      const std::size_t m = heights_m.size() - 1 - k;  // from the highest
      EXPECT_EQ(expected[m].is_top, k % 2 == 0);
      EXPECT_GE(heights_m[k], around.low[m] - 2 * stick_m);
      EXPECT_LE(heights_m[k], around.high[m] + 2 * stick_m);
    }
  }
  EXPECT_GE(compared, 200);
  EXPECT_GE(outside, 50);
  EXPECT_GE(many, least_with_gaps);
  test_support::record_worst("Surfaces of " + thing.name + " from its triangles, of the stated error", worst, 1,
                             "");
}

TEST_F(AllSurfaces, AnArchOnTheGround) {
  const mars::LonLat place{20.3, 11.7};
  compare({"Arch", oracle::arch(), place, ground_m(place), 30, 0, 0, 3}, 42, 1800, 101);
}

TEST_F(AllSurfaces, ASphereOverTheGround) {
  const mars::LonLat place{-120.7, -35.2};
  compare({"Balloon", oracle::uv_sphere(15, 24, 48), place, ground_m(place) + 220}, 21, 900, 102);
}

TEST_F(AllSurfaces, AnOverhangThatIsTurned) {
  const mars::LonLat place{75.1, 4.4};
  compare({"Cliff", oracle::overhang(), place, ground_m(place) + 4, 77, 14, -12, 2, 300}, 42, 6500, 103, 50);
}

TEST_F(AllSurfaces, AnOverhangFarAbove) {
  const mars::LonLat place{75.1, 64.4};
  compare({"Outpost", oracle::overhang(), place, 2.1e7, 200, 130, 65, 2, 300}, 50, 5000, 104);
}

TEST_F(AllSurfaces, AMeshHasTheSurfacesOfItsTriangles) {
  if (objects::model_reader_program().empty()) GTEST_SKIP() << "skipped: no vpe-model-reader";
  const mars::LonLat place{130.5, -20.1};
  compare({"Mesh", oracle::overhang(), place, ground_m(place) + 9, 12, -15, 10, 1, 0}, 21, 5000, 105, 50);
}

// What one place has of several objects, one of which lies in the ground and in another one.
TEST_F(AllSurfaces, AllObjectsAtAPlaceAreListedInOrder) {
  const mars::LonLat place{20.3, 11.7};
  const double foot_m = ground_m(place);
  const Thing arch{"Arch, old", oracle::arch(), place, foot_m, 0, 0, 0, 1, 96};
  const Thing stone{"Stone", objects::make_box({6, 6, 12}), place, foot_m - 1, 0, 0, 0, 1, 48};
  const Thing high{"High", oracle::uv_sphere(15, 24, 48), place, 5e6, 0, 0, 0, 1, 100};
  const std::string scene = write_scene({arch, stone, high});
  const json answer = ask({place}, {"--with-objects", scene})[0];
  EXPECT_EQ(answer["object"], "High");
  const json& surfaces = answer["surfaces"];
  ASSERT_EQ(surfaces.size(), 7U) << surfaces.dump(1);
  const std::vector<std::tuple<std::string, std::string, double>> expected{
      {"High", "top", 5e6 + 15 - foot_m}, {"High", "underside", 5e6 - 15 - foot_m},
      {"Arch, old", "top", 14},           {"Stone", "top", 11},
      {"Arch, old", "underside", 10},     {"ground", "top", 0},
      {"Stone", "underside", -1}};
  for (std::size_t n = 0; n < expected.size(); ++n) {
    const auto& [name, side, above_m] = expected[n];
    EXPECT_EQ(surfaces[n]["object"].is_null() ? "ground" : surfaces[n]["object"].get<std::string>(), name) << n;
    EXPECT_EQ(surfaces[n]["side"], side) << n;
    EXPECT_NEAR(surfaces[n]["above_ground_m"].get<double>(), above_m, 0.6) << n;
  }

  // The table says the same, a line for each surface.
  const Result csv = vpe({"query", planet().string(), "--all-surfaces", "--with-objects", scene},
                         "lon,lat,side\n20.3,11.7,left\n");
  ASSERT_EQ(csv.exit_code, 0) << csv.err;
  std::istringstream text(csv.out);
  std::string line;
  std::getline(text, line);
  EXPECT_EQ(line,
            "lon_deg,lat_deg,surface,side,height_m,above_ground_m,surface_error_m,object,elevation_m,slope_deg,"
            "aspect_deg,level,post_spacing_m,source,tile_error_m,datum,source_spacing_m,resampling_max_m,"
            "resampling_rms_m,kind,measured_m,input_side");
  for (std::size_t n = 0; n < surfaces.size(); ++n) {
    ASSERT_TRUE(std::getline(text, line)) << n;
    std::istringstream row(line);
    Words cells;
    for (std::string cell; std::getline(row, cell, ',');) cells.push_back(cell);
    ASSERT_GE(cells.size(), 22U) << line;
    EXPECT_EQ(cells[0] + "," + cells[1], "20.3,11.7");
    EXPECT_EQ(cells[2], surfaces[n]["surface"]);
    EXPECT_EQ(cells[3], surfaces[n]["side"]);
    EXPECT_NEAR(std::stod(cells[4]), surfaces[n]["height_m"].get<double>(), 0.0006);
    EXPECT_NEAR(std::stod(cells[5]), surfaces[n]["above_ground_m"].get<double>(), 0.0006);
    EXPECT_NEAR(std::stod(cells[6]), surfaces[n]["surface_error_m"].get<double>(), 6e-7);
    EXPECT_EQ(cells.back(), "left");
    if (cells[2] == "ground") {
      const Result plain = vpe({"query", planet().string(), "20.3,11.7"});
      const std::string values = plain.out.substr(plain.out.find("\n20.3,11.7,") + 11);
      EXPECT_TRUE(line.ends_with(",," + values.substr(0, values.find('\n')) + ",left")) << line;
    } else {
      EXPECT_TRUE(line.ends_with(",,,,,,,,,,,,,,left")) << line;
    }
    const bool is_quoted = line.find(",\"Arch, old\",") != std::string::npos;
    EXPECT_EQ(is_quoted, surfaces[n]["object"] == "Arch, old") << line;
  }
  EXPECT_FALSE(std::getline(text, line)) << line;
}

TEST_F(AllSurfaces, WithoutASceneTheGroundIsAlone) {
  const json answers = ask({{10, 20}, {-74, -13.5}}, {});
  const json plain = parse_json(vpe({"query", planet().string(), "--json", "10,20", "-74,-13.5"}).out);
  ASSERT_EQ(answers.size(), 2U);
  for (std::size_t n = 0; n < answers.size(); ++n) {
    json same = answers[n];
    same.erase("surfaces");
    EXPECT_EQ(same, plain[n]);
    EXPECT_EQ(answers[n]["surfaces"], json::array({{{"surface", "ground"},
                                                    {"object", nullptr},
                                                    {"side", "top"},
                                                    {"height_m", plain[n]["elevation_m"]},
                                                    {"above_ground_m", 0.0},
                                                    {"surface_error_m", 0.0}}}));
  }
}

TEST_F(AllSurfaces, WhereThereIsNoDataTheGroundHasNoHeight) {
  Dem dem;
  dem.no_data = -9999;
  dem.height_m = [](int column, int) { return column < 90 ? -9999.0 : 700.0; };  // the west has none
  write_dem(dir_ / "half.tif", dem);
  ASSERT_EQ(vpe({"build", "half.tif", "-o", "half.vpe", "--base-spacing", "100000"}).exit_code, 0);
  const Thing stone{"Stone", objects::make_box({8, 8, 8}), {-100, 10}, -5000, 0, 0, 0, 1, 8};
  const Words words{"query", "half.vpe", "--all-surfaces", "--with-objects", write_scene({stone}), "-100,10"};
  Words with_json = words;
  with_json.emplace_back("--json");
  const json surfaces = parse_json(vpe(with_json).out)[0]["surfaces"];
  ASSERT_EQ(surfaces.size(), 3U);
  EXPECT_EQ(surfaces[0]["side"], "top");
  EXPECT_NEAR(surfaces[0]["height_m"].get<double>(), -4992, 2);
  EXPECT_TRUE(surfaces[0]["above_ground_m"].is_null());
  EXPECT_EQ(surfaces[1]["side"], "underside");
  EXPECT_EQ(surfaces[2]["surface"], "ground");
  for (const char* key : {"height_m", "above_ground_m", "surface_error_m"})
    EXPECT_TRUE(surfaces[2][key].is_null()) << key;
  const Result csv = vpe(words);
  EXPECT_NE(csv.out.find("\n-100,10,ground,top,,,,,,,,0,"), std::string::npos) << csv.out;
  EXPECT_EQ(vpe({"query", "half.vpe", "--all-surfaces", "-100,10", "--fail-on-nodata"}).exit_code, 1);
}

TEST_F(AllSurfaces, BadScenesAreRefused) {
  expect_failure({"query", planet().string(), "10,20", "--all-surfaces", "--with-objects", "no.scene.toml"}, 1,
                 {"no.scene.toml"});
  write_text(dir_ / "bad.scene.toml", "version = 1\n[[object]]\nmodel = \"none\"\nlon = 1\nlat = 2\n");
  expect_failure({"query", planet().string(), "10,20", "--all-surfaces", "--with-objects", "bad.scene.toml"}, 1,
                 {"bad.scene.toml", "none"});
  expect_failure({"query", planet().string(), "10,95", "--all-surfaces"}, 2, {"10,95"});
  EXPECT_EQ(parse_json(vpe({"query", planet().string(), "--all-surfaces", "--json"}).out), json::array());
}

}  // namespace
}  // namespace app_test
