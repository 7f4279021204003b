// The skyline of Curiosity's stop of sol 1051 against another program's, and against the photograph.
#include <cmath>
#include <cstdlib>
#include <sstream>

#include "tests/app/support/app_fixture.h"

namespace app_test {
namespace {

using nlohmann::json;

struct Sight {
  double azimuth_deg;
  double elevation_deg;
};

// The first two columns of a CSV.
std::vector<Sight> read_skyline(const std::filesystem::path& path) {
  std::istringstream lines(read_text(path));
  std::string line;
  std::getline(lines, line);
  std::vector<Sight> out;
  while (std::getline(lines, line)) {
    char comma = 0;
    Sight s{};
    std::istringstream(line) >> s.azimuth_deg >> comma >> s.elevation_deg;
    out.push_back(s);
  }
  return out;
}

double at(const std::vector<Sight>& skyline, double azimuth_deg) {
  const auto n = static_cast<std::size_t>(azimuth_deg / 0.5);
  const double t = azimuth_deg / 0.5 - static_cast<double>(n);
  return skyline[n].elevation_deg * (1 - t) + skyline[(n + 1) % skyline.size()].elevation_deg * t;
}

class LongHorizon : public AppTest {
 protected:
  // Builds a planet of the nested shared DEMs, 1 m around the rover, and returns its path.
  std::string build_nest(const std::vector<std::string>& treatment) {
    std::vector<std::string> words{"build"};
    for (const char* name :
         {"mola8/mola8_topo.lbl", "gale-mola128/gale_megt128.lbl", "gale-ctx20/gale_ctx20_mosaic.tif",
          "gale-hirise5/gale_hirise5_dtm.tif", "gale-hirise1/missionDEM.tif"})
      words.push_back(test_support::shared_data(name).string());
    const std::string planet = path("gale.vpe");
    for (const char* word :
         {"--datum", "areoid", "--base-spacing", "20000", "--region", "136,-6.3,139.2,-3.0", "-q", "-o"})
      words.push_back(word);
    words.push_back(planet);
    words.insert(words.end(), treatment.begin(), treatment.end());
    Command build = command_for(words);
    build.limit_s = 1200;
    const Result built = run(build);
    EXPECT_EQ(built.exit_code, 0) << built.err;
    return planet;
  }

  // Every half degree, from the rover's camera; the summary too.
  std::vector<Sight> skyline(const std::string& planet, json& summary) {
    const json rover = parse_json(read_text(test_support::shared_data("pano-navcam1051/pano.json")))["rover"];
    std::ostringstream place;
    place.precision(12);
    place << rover["lon_deg_east"].get<double>() << "," << rover["lat_deg"].get<double>();
    std::ostringstream height;
    height << rover["camera_height_above_ground_m_approx"].get<double>();
    const Result result = vpe({"horizon", planet, "--at", place.str(), "--height", height.str(), "--step",
                               "0.5", "-o", "s.csv", "--json"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    summary = parse_json(result.out);
    return read_skyline(dir_ / "s.csv");
  }
};

// The rasters unchanged, as in the reference.
TEST_F(LongHorizon, OfTheNavcamMosaicIsTheReference) {
  VPE_NEED_SHARED(reference_path, "pano-navcam1051/dem_skyline.csv");
  json summary;
  const auto ours = skyline(build_nest({}), summary);
  ASSERT_EQ(ours.size(), 720U);
  double worst = 0;
  int compared = 0;
  for (const Sight& s : read_skyline(reference_path)) {
    if (s.azimuth_deg >= 360 || (s.azimuth_deg >= 150 && s.azimuth_deg <= 240)) continue;
    ++compared;
    const double difference = std::abs(at(ours, s.azimuth_deg) - s.elevation_deg);
    EXPECT_LE(difference, 0.5) << s.azimuth_deg;
    worst = std::max(worst, difference);
  }
  EXPECT_GT(compared, 530);
  EXPECT_NEAR(summary["highest"]["azimuth_deg"].get<double>(), 119, 2);
  EXPECT_NEAR(summary["highest"]["elevation_deg"].get<double>(), 11.7, 0.2);
  std::printf("worst difference %.3f degrees over %d azimuths\n", worst, compared);
}

// Without the outliers at the CTX mosaic's edges, which stand a degree above the ground in two arcs (72 to 84
// and 240 to 245 degrees), the skyline is the photograph's: edges read off it. MOLA's posts are 463 m apart,
// 0.3 degrees at 80 km and more at the foot of Mount Sharp. $VPE_GALE_PLANET is one that is built already.
TEST_F(LongHorizon, OfTheNavcamMosaicIsThePhotographs) {
  VPE_NEED_SHARED(pano_path, "pano-navcam1051/pano.json");
  const char* ready = std::getenv("VPE_GALE_PLANET");
  json summary;
  const auto ours =
      skyline(ready != nullptr ? ready : build_nest({"--align", "edges", "--reject-outliers"}), summary);
  ASSERT_EQ(ours.size(), 720U);
  for (const Sight& s : {Sight{79.2, 2.06}, {80.9, 2.26}, {83.7, 2.87}, {243.2, 2.35}, {246.7, 2.52}})
    EXPECT_NEAR(at(ours, s.azimuth_deg), s.elevation_deg, 0.35) << s.azimuth_deg;
  EXPECT_NEAR(summary["highest"]["azimuth_deg"].get<double>(), 119, 2);
  EXPECT_NEAR(summary["highest"]["elevation_deg"].get<double>(), 11.7, 0.2);
}

}  // namespace
}  // namespace app_test
