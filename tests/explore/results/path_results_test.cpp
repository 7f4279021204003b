// Results of paths and drawings: JSON, features that GDAL reads back, text; the ground along them; the edited path.
#include "vpe/explore/results/path_results.h"

#include <gdal_priv.h>
#include <gtest/gtest.h>
#include <ogrsf_frmts.h>

#include <cmath>
#include <memory>
#include <stdexcept>

#include "tests/explore/terrain_fixture.h"
#include "vpe/base/file.h"
#include "vpe/explore/results/drawing_results.h"
#include "vpe/explore/results/measure_path.h"
#include "vpe/explore/results/place_report.h"
#include "vpe/explore/results/polygon_results.h"
#include "vpe/explore/results/result_files.h"

namespace vpe::explore {
namespace {

using nlohmann::json;

const std::vector<mars::LonLat> kOverTheRidge{{-35.15, 20}, {-34.85, 20}};

class PathResults : public test_support::GroundTest<test_support::RidgeGround> {
 protected:
  const paging::PlanetMeta& meta() const { return surface().planet().meta(); }
  test_support::TempDir folder_;
};

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

// Opens the first layer of a file with GDAL alone.
class ReadBack {
 public:
  explicit ReadBack(const std::filesystem::path& file) {
    GDALAllRegister();
    dataset_.reset(GDALDataset::Open(file.c_str(), GDAL_OF_VECTOR));
    if (dataset_ == nullptr) throw std::runtime_error("GDAL does not open " + file.string());
    for (const auto& feature : dataset_->GetLayer(0)) features_.emplace_back(feature->Clone());
  }
  std::size_t size() const { return features_.size(); }
  const OGRFeature& operator[](std::size_t n) const { return *features_.at(n); }
  double number(std::size_t n, const char* field) const {
    const int index = features_.at(n)->GetFieldIndex(field);
    return index < 0 ? std::nan("") : features_.at(n)->GetFieldAsDouble(index);
  }
  std::string text(std::size_t n, const char* field) const { return features_.at(n)->GetFieldAsString(field); }
  bool is_set(std::size_t n, const char* field) const {
    const int index = features_.at(n)->GetFieldIndex(field);
    return index >= 0 && features_.at(n)->IsFieldSetAndNotNull(index);
  }

 private:
  std::unique_ptr<GDALDataset> dataset_;
  std::vector<OGRFeatureUniquePtr> features_;
};

TEST_F(PathResults, OfAProfileComeBackFromEachFormat) {
  const Profile profile = make_profile(surface(), kOverTheRidge, {.step_m = 700, .most_points = 0});
  const GroundAlong ground = ground_of_profile(surface(), profile.points);
  const std::vector<double> limits_deg{5, 40};
  const json result = profile_json(profile, ground, meta(), limits_deg);
  EXPECT_EQ(result["length_m"], profile.length_m);
  EXPECT_EQ(result["nodata_share"], 0);
  EXPECT_EQ(result["synthetic_share"], 0);
  EXPECT_EQ(result["radius_m"], meta().radius_m);
  EXPECT_TRUE(result["datum"].is_string());
  EXPECT_GT(result["post_spacing_m"], 0);
  EXPECT_EQ(result["points"].size(), profile.points.size());
  const mars::FeatureLayer layer = profile_layer(result, kOverTheRidge);
  for (const char* name : {"p.geojson", "p.gpkg"}) {
    write_result(folder_ / name, layer, result_info("profile: test", meta()), to_csv(profile));
    const ReadBack read(folder_ / name);
    ASSERT_EQ(read.size(), profile.points.size() + 1) << name;
    EXPECT_EQ(read.text(0, "part"), "path");
    EXPECT_EQ(wkbFlatten(read[0].GetGeometryRef()->getGeometryType()), wkbLineString);
    EXPECT_EQ(read.number(0, "highest_m"), profile.highest_m);
    EXPECT_EQ(read.number(0, "nodata_share"), 0);
    bool has_steep = false;
    for (std::size_t n = 0; n < profile.points.size(); ++n) {
      const paging::ProfilePoint& p = profile.points[n];
      EXPECT_EQ(read.text(n + 1, "part"), "point");
      EXPECT_EQ(read.number(n + 1, "elevation_m"), p.height_m);
      const OGRPoint* at = read[n + 1].GetGeometryRef()->toPoint();
      EXPECT_NEAR(at->getX(), p.place.lon_deg, 1e-9);
      EXPECT_NEAR(at->getY(), p.place.lat_deg, 1e-9);
      EXPECT_EQ(read.is_set(n + 1, "steeper_than_deg"), steepness(p, limits_deg) > 0);
      has_steep = has_steep || steepness(p, limits_deg) == 1;
    }
    EXPECT_TRUE(has_steep);
  }
  write_result(folder_ / "p.csv", layer, {}, to_csv(profile));
  const auto bytes = base::read_file(folder_ / "p.csv", 1 << 20);
  EXPECT_EQ(std::string(bytes.begin(), bytes.end()), to_csv(profile));
  try {
    write_result(folder_ / "p.shp", layer, {}, "");
    FAIL() << "an extension that is no format was taken";
  } catch (const std::runtime_error& e) {
    EXPECT_TRUE(has(e.what(), "p.shp") && has(e.what(), ".gpkg")) << e.what();
  }
}

TEST_F(PathResults, OfALineOfSightHaveItsPoints) {
  const SightPoint from{kOverTheRidge[0], 2};
  const SightPoint to{kOverTheRidge[1], 0};
  LineOfSight sight = line_of_sight(surface(), from, to);
  ASSERT_TRUE(sight.obstruction);
  const json result = sight_json(sight, from, to, ground_along(surface(), kOverTheRidge), meta());
  write_result(folder_ / "s.gpkg", sight_layer(result), result_info("sight: test", meta()), "");
  const ReadBack read(folder_ / "s.gpkg");
  ASSERT_EQ(read.size(), 5U);
  EXPECT_EQ(read.text(0, "part"), "line");
  EXPECT_EQ(read.number(0, "visible"), 0);
  EXPECT_EQ(read.number(0, "from_height_m"), 2);
  EXPECT_EQ(read.text(4, "part"), "obstacle");
  EXPECT_EQ(read.number(4, "distance_m"), sight.obstruction->distance_m);
  EXPECT_NEAR(read[4].GetGeometryRef()->toPoint()->getX(), sight.obstruction->place.lon_deg, 1e-9);
  // With an object that has a name, and without any obstacle.
  sight.obstruction->object = "Tower";
  EXPECT_EQ(sight_json(sight, from, to, {}, meta())["obstacle"]["object"], "Tower");
  sight.obstruction.reset();
  sight.needed_height_m = std::numeric_limits<double>::infinity();
  const json free = sight_json(sight, from, to, {}, meta());
  EXPECT_TRUE(free["obstacle"].is_null());
  EXPECT_TRUE(free["needed_height_m"].is_null());
  EXPECT_TRUE(free["post_spacing_m"].is_null());
  EXPECT_EQ(sight_layer(free).features.size(), 4U);
}

TEST_F(PathResults, GroundAlongCountsWhatItMeets) {
  const GroundAlong one = ground_along(surface(), std::vector<mars::LonLat>{{-35, 20}});
  EXPECT_EQ(one.points, 1);
  const GroundAlong all = ground_along(surface(), kOverTheRidge);
  EXPECT_GT(all.points, 2);
  EXPECT_LE(all.points, kMostGroundPoints);
  EXPECT_EQ(all.nodata_share(), 0);
  EXPECT_EQ(all.sources.size(), 1U);
  EXPECT_LE(all.finest_spacing_m, all.coarsest_spacing_m);
  EXPECT_EQ(GroundAlong().nodata_share(), 0);
  // By hand: one of four points is nodata, one made up.
  paging::PlanetMeta own = meta();
  own.sources.front().illustration = true;
  GroundAlong mixed;
  paging::PlaceAnswer answer = paging::query(surface(), {-35, 20});
  mixed.add(answer, own);
  mixed.add(answer, meta());
  mixed.add(answer, meta());
  answer.nodata = true;
  answer.source.reset();
  mixed.add(answer, meta());
  EXPECT_EQ(mixed.nodata_share(), 0.25);
  EXPECT_EQ(mixed.synthetic_share(), 0.25);
  const std::string text = text_of_lines(ground_lines(mixed, meta()));
  EXPECT_TRUE(has(text, "Datum: ") && has(text, "Posts: ") && has(text, "Error: ") &&
              has(text, "Nodata: 25 %") && has(text, "Synthetic: 25 %"))
      << text;
}

Drawing drawing_of(DrawingKind kind, std::vector<mars::LonLat> places) {
  Drawing drawing;
  drawing.kind = kind;
  drawing.name = "Rim";
  drawing.vertices = std::move(places);
  return drawing;
}

TEST_F(PathResults, OfDrawingsHaveWhatWasMeasured) {
  for (const DrawingKind kind : {DrawingKind::kPoint, DrawingKind::kLine, DrawingKind::kPolygon}) {
    std::vector<mars::LonLat> places{{-35.1, 19.9}, {-34.9, 19.9}, {-34.9, 20.1}, {-35.1, 20.1}};
    if (kind != DrawingKind::kPolygon) places.resize(least_vertices(kind));
    const Drawing drawing = drawing_of(kind, places);
    const SphereMeasures sphere = sphere_measures(drawing, meta().radius_m);
    const auto ground = ground_measures(surface(), drawing);
    ASSERT_TRUE(ground);
    const DrawingResults results{drawing, sphere, *ground, ground_along(surface(), places), meta()};
    const json values = drawing_json(results);
    EXPECT_EQ(values["name"], "Rim");
    EXPECT_EQ(values["highest_m"].is_number(), true);
    for (const char* key : {"datum", "radius_m", "post_spacing_m", "nodata_share", "synthetic_share"})
      EXPECT_TRUE(values.contains(key)) << key;
    const mars::FeatureLayer layer = drawing_layer(results);
    ASSERT_EQ(layer.features.size(), 1U);
    write_result(folder_ / "d.gpkg", layer, result_info("measure: test", meta()), "");
    const ReadBack read(folder_ / "d.gpkg");
    EXPECT_EQ(read.text(0, "name"), "Rim");
    EXPECT_EQ(read.number(0, "highest_m"), values["highest_m"].get<double>());
    const std::string text = drawing_text(results);
    EXPECT_TRUE(has(text, "Rim\n") && has(text, "odata")) << text;
    std::string lines = text_of_lines(drawing_ground_lines(results));
    EXPECT_TRUE(has(lines, "Datum") && has(lines, "Posts") && has(lines, "Error") && has(lines, "Synthetic"))
        << lines;
    if (kind != DrawingKind::kPolygon) continue;
    ASSERT_TRUE(ground->statistics && ground->statistics->over_rim);
    EXPECT_EQ(values["sphere_area_m2"], ground->statistics->sphere_area_m2);
    EXPECT_EQ(read.number(0, "over_rim_below_m3"), ground->statistics->over_rim->below_m3);
    EXPECT_EQ(read.number(0, "slope_mean_deg"), ground->statistics->mean_slope_deg);
    EXPECT_EQ(elevation_error_m(*ground->statistics, meta()), values["elevation_error_m"].get<double>());
  }
}

TEST_F(PathResults, InfoNamesCommandAndDatum) {
  const mars::FeatureFileInfo info = result_info("profile: the ground", meta());
  EXPECT_EQ(info.radius_m, meta().radius_m);
  EXPECT_TRUE(has(info.description, "vpe profile: the ground. ") &&
              has(info.description, paging::describe_datum(meta())))
      << info.description;
}

TEST_F(PathResults, WhatIsHereNamesGroundAndName) {
  const std::vector<core::Place> names{
      {"Far", 100, 20, 0}, {"Land", -35, 20, 2e6}, {"Crater", -35.02, 20, 5000}};
  const PlaceReport here = what_is_here(surface(), {-35, 20}, names);
  EXPECT_EQ(here.kind, GroundKind::kMeasured);
  ASSERT_TRUE(here.name);
  EXPECT_EQ(here.name->name, "Crater");
  EXPECT_TRUE(here.name->is_inside);
  EXPECT_NEAR(here.ground.at.elevation_m, 800, 25);  // of the ridge, between posts
  const std::string text = text_of_lines(place_lines(here));
  for (const char* part : {"Name: in Crater", "Place: -35.00000, 20.00000",
                           "Elevation: ", "Slope: ", "Source: ", "Posts: ", "Ground: measured"})
    EXPECT_TRUE(has(text, part)) << part << " in\n" << text;
  EXPECT_FALSE(what_is_here(surface(), {-35, 20}, {}).name);
}

TEST(NearestName, IsTheSmallestAroundOrElseTheNearest) {
  const double radius_m = mars::kMarsRadius_m;
  const double degree_m = radius_m * mars::kRadiansPerDegree;
  const std::vector<core::Place> names{
      {"Large", 0, 0, 4 * degree_m}, {"Small", 0, 0, degree_m}, {"Point", 5, 0, 0}};
  const auto at = [&](double lon_deg) { return *nearest_name(names, {lon_deg, 0}, radius_m); };
  EXPECT_EQ(at(0.2).name, "Small");
  EXPECT_EQ(at(1).name, "Large");
  EXPECT_TRUE(at(1).is_inside);
  EXPECT_EQ(at(3).name, "Large");  // 1 degree from its circle, and 2 from the point
  EXPECT_FALSE(at(3).is_inside);
  EXPECT_NEAR(at(3).distance_m, degree_m, 1);
  EXPECT_EQ(at(4).name, "Point");
  EXPECT_NEAR(at(4).distance_m, degree_m, 1);
  EXPECT_FALSE(nearest_name({}, {0, 0}, radius_m));
}

TEST(MeasurePath, EditsAreUndoneOneByOne) {
  MeasurePath path;
  UndoHistory history;
  history.join(path);
  path.add({190, 10});
  path.add({20, 95});
  ASSERT_EQ(path.places().size(), 1U);
  EXPECT_EQ(path.places()[0].lon_deg, -170);
  EXPECT_EQ(history.undo_text(), "measure point A");
  path.go_on_to({1, 2}, {50, 50});
  ASSERT_EQ(path.places().size(), 2U);
  path.set_heights(5, 3);
  path.set_heights(5, 3);  // no step
  path.erase(7);
  path.erase(0);
  EXPECT_EQ(path.places().size(), 1U);
  EXPECT_EQ(history.undo(), "remove point A");
  EXPECT_EQ(history.undo(), "heights of the line of sight");
  EXPECT_EQ(path.from_height_m(), 2);
  EXPECT_EQ(history.redo(), "heights of the line of sight");
  EXPECT_EQ(path.to_height_m(), 3);
  path.clear();
  path.clear();
  EXPECT_TRUE(path.places().empty());
  path.go_on_to({1, 2}, {50, 50});
  ASSERT_EQ(path.places().size(), 2U);
  EXPECT_EQ(path.places()[0].lon_deg, 50);
  path.begin_at({3, 4});
  ASSERT_EQ(path.places().size(), 1U);
  EXPECT_EQ(history.undo(), "measure from here");
  EXPECT_EQ(history.undo(), "profile to here");
  EXPECT_EQ(history.undo(), "clear the path");
  EXPECT_EQ(path.places().size(), 2U);
  path.begin_at({std::nan(""), 0});
  path.go_on_to({0, 0}, {0, 91});  // the path has a last point
  EXPECT_EQ(path.places().size(), 3U);
}

TEST(MeasurePath, PointNamesContinueAfterZ) {
  EXPECT_EQ(path_point_name(0), "A");
  EXPECT_EQ(path_point_name(25), "Z");
  EXPECT_EQ(path_point_name(26), "AA");
  EXPECT_EQ(path_point_name(27), "AB");
  EXPECT_EQ(path_point_name(26 + 26 * 26), "AAA");
}

}  // namespace
}  // namespace vpe::explore
