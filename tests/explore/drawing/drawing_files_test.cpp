// Tests of drawings as GeoJSON and CSV, and of project files: round trips to the bit, bad input of every kind.
#include "vpe/explore/drawing/drawing_files.h"

#include <gtest/gtest.h>

#include <bit>
#include <nlohmann/json.hpp>

#include "tests/support/support.h"
#include "vpe/base/file.h"
#include "vpe/explore/drawing/drawings.h"
#include "vpe/explore/drawing/project.h"
#include "vpe/explore/drawing/sphere_polygon.h"

namespace vpe::explore {
namespace {

const PlanetSphere kMars{"Mars", mars::kMarsRadius_m};

std::vector<Drawing> random_drawings(std::uint64_t seed, int count) {
  test_support::Random random(seed);
  std::vector<Drawing> all;
  while (static_cast<int>(all.size()) < count) {
    Drawing d;
    d.kind = static_cast<DrawingKind>(random.integer(0, 2));
    d.name = all.size() % 3 == 0 ? "Krater \"Größe\", \\ № " + std::to_string(all.size()) : "n";
    d.colour = {static_cast<std::uint8_t>(random.integer(0, 255)), 7, 200};
    d.visible = random.integer(0, 1) == 1;
    const int vertices = d.kind == DrawingKind::kPoint ? 1 : random.integer(3, 30);
    for (int n = 0; n < vertices; ++n) d.vertices.push_back(mars::lon_lat(random.direction()));
    if (all.size() % 5 == 0) d.vertices[0] = {180, -0.0};
    if (all.size() % 7 == 0) d.vertices[0] = {-0.0, 90};
    if (problem_of(d).empty()) all.push_back(d);
  }
  return all;
}

std::vector<std::shared_ptr<const Drawing>> shared(const std::vector<Drawing>& drawings) {
  std::vector<std::shared_ptr<const Drawing>> all;
  for (const Drawing& d : drawings) all.push_back(std::make_shared<const Drawing>(d));
  return all;
}

TEST(GeoJson, ReturnsToTheBit) {
  const std::vector<Drawing> all = random_drawings(51, 200);
  const ParsedGeoJson parsed = parse_geojson(to_geojson(shared(all), kMars), "a.geojson");
  ASSERT_EQ(parsed.error, "");
  EXPECT_TRUE(parsed.notes.empty() || parsed.notes.size() == 1);
  ASSERT_TRUE(parsed.planet);
  EXPECT_EQ(parsed.planet->body, "Mars");
  EXPECT_EQ(parsed.planet->radius_m, mars::kMarsRadius_m);
  ASSERT_EQ(parsed.drawings.size(), all.size());
  for (std::size_t n = 0; n < all.size(); ++n) EXPECT_TRUE(same(parsed.drawings[n], all[n])) << n;
}

TEST(GeoJson, IsThatOfTheStandard) {
  Drawing d;
  d.kind = DrawingKind::kPolygon;
  d.name = "Rim";
  d.vertices = {{0, 0}, {1, 1}, {1, 0}};  // clockwise
  const nlohmann::json json = nlohmann::json::parse(to_geojson(shared({d}), kMars));
  EXPECT_EQ(json["type"], "FeatureCollection");
  const auto& ring = json["features"][0]["geometry"]["coordinates"][0];
  ASSERT_EQ(ring.size(), 4U);
  EXPECT_EQ(ring[0], ring[3]);
  std::vector<mars::LonLat> places;
  for (std::size_t n = 0; n < 3; ++n) places.push_back({ring[n][0], ring[n][1]});
  EXPECT_GT(signed_sphere_area(directions_of(places)), 0);  // counterclockwise
  EXPECT_EQ(to_geojson({}, kMars),
            "{\"type\": \"FeatureCollection\",\n \"planet\": {\"body\":\"Mars\",\"radius_m\":3396190.0,"
            "\"coordinates\":\"longitude east, planetocentric latitude, degrees\"},\n \"features\": [\n]}\n");
}

TEST(GeoJson, FilesOfOthersAreRead) {
  const ParsedGeoJson multi = parse_geojson(
      R"({"type":"Feature","id":3,"properties":{"name":"M","size":4},"geometry":{"type":"GeometryCollection",
      "geometries":[{"type":"MultiPoint","coordinates":[[1,2,300],[190,-4]]},
      {"type":"MultiPolygon","coordinates":[[[[0,0],[9,0],[9,9],[0,0]],[[1,1],[2,1],[2,2],[1,1]]]]}]}})",
      "m.json");
  ASSERT_EQ(multi.error, "");
  ASSERT_EQ(multi.drawings.size(), 3U);
  EXPECT_EQ(multi.drawings[0].name, "M");
  EXPECT_EQ(multi.drawings[1].vertices[0].lon_deg, -170);
  EXPECT_EQ(multi.drawings[2].vertices.size(), 3U);
  EXPECT_EQ(multi.notes,
            (std::vector<std::string>{"properties other than name, colour and visible are not read",
                                      "heights of positions are not read", "holes of polygons are not read"}));
  const ParsedGeoJson bare = parse_geojson(R"({"type":"LineString","coordinates":[[1,2],[3,4]]})", "b.json");
  EXPECT_EQ(bare.error, "");
  EXPECT_EQ(bare.drawings.size(), 1U);
  EXPECT_FALSE(bare.planet);
}

TEST(GeoJson, FaultsSayWhere) {
  const auto error = [](const std::string& text) {
    const ParsedGeoJson parsed = parse_geojson(text, "f.json");
    EXPECT_TRUE(parsed.drawings.empty());
    return parsed.error;
  };
  const auto feature = [](const std::string& geometry) {
    return R"({"type":"FeatureCollection","features":[{"type":"Feature","properties":null,"geometry":)" +
           geometry + "}]}";
  };
  EXPECT_EQ(error("{\n\n,"), "f.json:3: not JSON; a file of GeoJSON is expected");
  EXPECT_EQ(error(""), "f.json:1: not JSON; a file of GeoJSON is expected");
  EXPECT_EQ(error("[]"), "f.json: expected an object of GeoJSON, found \"[]\"");
  EXPECT_EQ(error("{}"), "f.json: expected a \"type\" of GeoJSON");
  EXPECT_NE(error(R"({"type":"Topology"})").find("type: expected Point"), std::string::npos);
  EXPECT_EQ(error(R"({"type":"FeatureCollection"})"), "f.json: features: expected a list");
  EXPECT_EQ(error(feature(R"({"type":"Point","coordinates":["a",1]})")),
            "f.json: features[0].geometry.coordinates: expected [LONGITUDE, LATITUDE] in degrees, found "
            "\"[\"a\",1]\"");
  EXPECT_NE(error(feature(R"({"type":"Point","coordinates":[0,91]})")).find("latitude from -90 to 90"),
            std::string::npos);
  EXPECT_NE(error(feature(R"({"type":"Point","coordinates":[0,1e400]})")), "");
  EXPECT_NE(error(feature(R"({"type":"LineString","coordinates":[[0,1]]})")).find("at least 2"),
            std::string::npos);
  EXPECT_NE(error(feature(R"({"type":"LineString","coordinates":[[0,0],[180,0]]})")).find("opposite sides"),
            std::string::npos);
  EXPECT_NE(error(feature(R"({"type":"Polygon","coordinates":[[[0,0],[1,0],[1,1]]]})"))
                .find("a ring of at least four"),
            std::string::npos);
  EXPECT_NE(error(feature(R"({"type":"Polygon","coordinates":[]})")).find("a list of rings"),
            std::string::npos);
  EXPECT_NE(error(R"({"type":"Feature","properties":{"colour":"red"},"geometry":null})").find("#ffd65a"),
            std::string::npos);
  EXPECT_NE(error(R"({"type":"Feature","properties":7,"geometry":null})").find("properties"),
            std::string::npos);
  EXPECT_NE(error(R"({"type":"FeatureCollection","planet":3,"features":[]})").find("planet: expected"),
            std::string::npos);
  std::string deep = R"({"type":"Point","coordinates":[1,2]})";
  for (int n = 0; n < 12; ++n) deep = R"({"type":"GeometryCollection","geometries":[)" + deep + "]}";
  EXPECT_NE(error(deep).find("collections in each other"), std::string::npos);
  EXPECT_NE(error(std::string(200'000, '[')), "");
}

// Damaged files are refused or read, and nothing else happens.
TEST(GeoJson, DamagedFilesDoNoHarm) {
  const std::string good = to_geojson(shared(random_drawings(52, 12)), kMars);
  test_support::Random random(53);
  int refused = 0;
  for (int n = 0; n < 3000; ++n) {
    std::string text = good;
    for (int k = random.integer(1, 4); k > 0; --k) {
      const auto at = static_cast<std::size_t>(random.integer(0, static_cast<int>(text.size()) - 1));
      switch (random.integer(0, 3)) {
        case 0: text[at] = static_cast<char>(random.integer(0, 255)); break;
        case 1: text.erase(at, static_cast<std::size_t>(random.integer(1, 20))); break;
        case 2: text.insert(at, 1, "[]{},:\"9-e."[random.integer(0, 10)]); break;
        default: text.resize(at + 1);
      }
    }
    const ParsedGeoJson parsed = parse_geojson(text, "f");
    refused += parsed.error.empty() ? 0 : 1;
    EXPECT_TRUE(parsed.error.empty() || parsed.drawings.empty());
    for (const Drawing& d : parsed.drawings) EXPECT_EQ(problem_of(d), "");
  }
  EXPECT_GT(refused, 1000);
}

TEST(DrawingCsv, HasAVertexALine) {
  Drawing d;
  d.kind = DrawingKind::kLine;
  d.name = "a, \"b\"";
  d.vertices = {{1.5, 2}, {-170, 0.1}};
  EXPECT_EQ(to_csv(shared({d})),
            "drawing,kind,name,colour,visible,vertex,lon_deg,lat_deg\n"
            "1,line,\"a, \"\"b\"\"\",#ffd65a,1,1,1.5,2\n1,line,\"a, \"\"b\"\"\",#ffd65a,1,2,-170,0.1\n");
  const std::string text = to_csv(shared({d}), [](mars::LonLat p) {
    return p.lon_deg > 0 ? std::optional<double>(-12.3456) : std::nullopt;
  });
  EXPECT_NE(text.find(",1.5,2,-12.346\n"), std::string::npos);
  EXPECT_NE(text.find(",-170,0.1,\n"), std::string::npos);
}

Project full_project(const std::filesystem::path& folder) {
  Project p;
  p.planet = folder / "planets/mars.vpe";
  p.pose = mars::Pose{137.4, -0.0, -3500.125, 359.9, -5, 1e-7};
  p.fov_deg = 33.3;
  p.drawn_by = core::DrawnBy::kRay;
  p.panels = false;
  p.large_map = true;
  p.map_style = MapStyle::kImagery;
  p.settings = {{"exaggeration", "2"}, {"sun.azimuth", "90"}};
  p.regions = {{10, -20, 12345.678, 2}};
  p.bookmarks = {{1, {{1, 2, 3, 4, 5, 6}, 60}, "Gale \"west\""}, {0, {{7, 8, 9, 0, 0, 0}, 40}, "other"}};
  p.drawings = random_drawings(54, 40);
  p.hotspots = "/elsewhere/spots.txt";
  scripts::Flight flight;
  scripts::Waypoint waypoint;
  waypoint.up_m = 5000;
  flight.waypoints = {waypoint};
  p.flight_text = flight;
  return p;
}

TEST(ProjectFile, ReturnsToTheBit) {
  const test_support::TempDir folder;
  const Project p = full_project(folder.path());
  const std::filesystem::path file = folder / "work.vpeproj";
  save_project(p, file);
  const ParsedProject parsed = load_project(file);
  ASSERT_TRUE(parsed.project) << parsed.errors.front();
  const Project& q = *parsed.project;
  EXPECT_EQ(q.planet, p.planet);
  EXPECT_EQ(q.hotspots, p.hotspots);
  EXPECT_TRUE(q.pose && same({*q.pose, q.fov_deg}, {*p.pose, p.fov_deg}));
  EXPECT_TRUE(std::signbit(q.pose->lat_deg));
  EXPECT_EQ(q.drawn_by, p.drawn_by);
  EXPECT_EQ(q.panels, p.panels);
  EXPECT_EQ(q.large_map, p.large_map);
  EXPECT_EQ(q.map_style, p.map_style);
  EXPECT_EQ(q.settings, p.settings);
  EXPECT_EQ(q.regions, p.regions);
  ASSERT_EQ(q.bookmarks.size(), 2U);
  EXPECT_EQ(q.bookmarks[0].name, p.bookmarks[0].name);
  EXPECT_TRUE(same(q.bookmarks[1].view, p.bookmarks[1].view));
  EXPECT_EQ(q.flight_text, p.flight_text);
  ASSERT_EQ(q.drawings.size(), p.drawings.size());
  for (std::size_t n = 0; n < p.drawings.size(); ++n) EXPECT_TRUE(same(q.drawings[n], p.drawings[n])) << n;
  EXPECT_EQ(to_text(q, folder.path()), to_text(p, folder.path()));
  // A folder that is moved keeps its planet.
  const std::string text = to_text(p, folder.path());
  EXPECT_NE(text.find("planet = \"planets/mars.vpe\"\n"), std::string::npos);
  EXPECT_NE(text.find("hotspots = \"/elsewhere/spots.txt\"\n"), std::string::npos);
  EXPECT_EQ(parse_project(text, "/moved/work.vpeproj").project->planet, "/moved/planets/mars.vpe");
}

TEST(ProjectFile, TheLeastIsItsFormat) {
  const ParsedProject parsed = parse_project("format = 1\n", "p.vpeproj");
  ASSERT_TRUE(parsed.project);
  EXPECT_TRUE(parsed.project->planet.empty());
  EXPECT_FALSE(parsed.project->pose);
  EXPECT_TRUE(is_project_file("a/b.vpeproj"));
  EXPECT_FALSE(is_project_file("b.vpe"));
}

TEST(ProjectFile, FaultsHaveTheirLines) {
  const auto errors = [](const std::string& text) {
    const ParsedProject parsed = parse_project(text, "p.vpeproj");
    EXPECT_FALSE(parsed.project) << text;
    std::string all;
    for (const std::string& error : parsed.errors) all += error + "\n";
    return all;
  };
  EXPECT_EQ(errors(""), "p.vpeproj:1: expected 'format = 1', as in every project file\n");
  EXPECT_NE(errors("format = 2\n").find("p.vpeproj:1: expected format = 1, found \"2\"; a newer vpe"),
            std::string::npos);
  EXPECT_NE(errors("format = 1\nplanet = \"a\n").find("p.vpeproj:2: not TOML"), std::string::npos);
  std::string many_parts = "view";
  for (int n = 0; n < 200'000; ++n) many_parts += ".a";
  EXPECT_EQ(errors("format = 1\n" + many_parts + " = 1\n").find("p.vpeproj:2: expected keys with fewer dots"),
            0U);
  EXPECT_NE(errors("format = 1\n\nplanets = 3\n")
                .find("p.vpeproj:3: unknown key \"planets\"; keys of a project are format, planet"),
            std::string::npos);
  EXPECT_NE(errors("format = 1\nplanet = 3\n").find(":2: planet: expected a text in quotes"),
            std::string::npos);
  EXPECT_NE(errors("format = 1\n[view]\npose = [1, 2]\n").find(":3: pose: expected [longitude"),
            std::string::npos);
  EXPECT_NE(errors("format = 1\n[view]\npose = [1, 92, 0, 0, 0, 0]\n").find(":3: pose: lat must be from -90"),
            std::string::npos);
  EXPECT_NE(errors("format = 1\n[view]\nfov_deg = nan\n").find(":3: fov_deg: expected a number"),
            std::string::npos);
  EXPECT_NE(errors("format = 1\n[view]\nmap = \"x\"\npanels = 1\n").find(":4: panels: expected true or false"),
            std::string::npos);
  EXPECT_NE(errors("format = 1\n[settings]\n\"sun.azimuth\" = \"x\"\n").find(":3: "), std::string::npos);
  EXPECT_NE(errors("format = 1\n[settings]\nsun.azimuth = \"9\"\n").find("in quotes too"), std::string::npos);
  EXPECT_NE(errors("format = 1\n[settings]\n\"sun.asimuth\" = \"9\"\n").find("did you mean"),
            std::string::npos);
  EXPECT_NE(errors("format = 1\n[[region]]\nlon_deg = 1\n").find(":2: [[region]] needs the key lat_deg"),
            std::string::npos);
  EXPECT_NE(errors("format = 1\nregion = 3\n").find("expected [[region]]"), std::string::npos);
  EXPECT_NE(errors("format = 1\n[[bookmark]]\nkey = 1\n").find("needs the key pose"), std::string::npos);
  const std::string bookmark = "[[bookmark]]\nkey = 1\npose = [0, 0, 0, 0, 0, 0]\n";
  EXPECT_NE(errors("format = 1\n" + bookmark + bookmark).find(":5: expected each key once, found 1 again"),
            std::string::npos);
  EXPECT_NE(errors("format = 1\n[[drawing]]\nkind = \"polygon\"\nvertices = [[0, 0], [1, 1]]\n")
                .find(":2: a polygon has at least 3 vertices, not 2"),
            std::string::npos);
  EXPECT_NE(
      errors("format = 1\n[[drawing]]\nkind = \"point\"\nvertices = [[0,\n 99]]\n").find("latitude from -90"),
      std::string::npos);
  EXPECT_NE(errors("format = 1\n[[drawing]]\nkind = \"point\"\ncolour = \"red\"\nvertices = [[0, 9]]\n")
                .find(":4: colour"),
            std::string::npos);
  EXPECT_NE(errors("format = 1\nflight_text = \"\"\"\nvpe flight 1\nbad\n\"\"\"\n").find("p.vpeproj:"),
            std::string::npos);
  EXPECT_NE(errors("format = 1\nflight = \"a\"\nflight_text = \"b\"\n").find("either flight or flight_text"),
            std::string::npos);
  std::string many = "format = 1\n";
  for (int n = 0; n < 100; ++n) many += "x" + std::to_string(n) + " = 1\n";
  EXPECT_EQ(parse_project(many, "p").errors.size(), ProjectLimits::kMostErrors);
}

TEST(ProjectFile, DamagedFilesDoNoHarm) {
  const std::string good = to_text(full_project("/folder"), "/folder");
  test_support::Random random(55);
  int refused = 0;
  for (int n = 0; n < 1500; ++n) {
    std::string text = good;
    for (int k = random.integer(1, 4); k > 0; --k) {
      const auto at = static_cast<std::size_t>(random.integer(0, static_cast<int>(text.size()) - 1));
      switch (random.integer(0, 2)) {
        case 0: text[at] = static_cast<char>(random.integer(0, 255)); break;
        case 1: text.erase(at, static_cast<std::size_t>(random.integer(1, 20))); break;
        default: text.insert(at, 1, "[]{},:\"9-e.=#\n"[random.integer(0, 13)]);
      }
    }
    const ParsedProject parsed = parse_project(text, "p");
    EXPECT_NE(parsed.project.has_value(), !parsed.errors.empty());
    refused += parsed.project ? 0 : 1;
    if (!parsed.project) continue;
    for (const Drawing& d : parsed.project->drawings) EXPECT_EQ(problem_of(d), "");
    EXPECT_TRUE(parse_project(to_text(*parsed.project, "/folder"), "/folder/p").project);
  }
  EXPECT_GT(refused, 300);
}

}  // namespace
}  // namespace vpe::explore
