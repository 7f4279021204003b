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

class LongHorizon : public AppTest {};

// The nest of shared DEMs, 1 m about the rover; $VPE_GALE_PLANET is one that is built already.
TEST_F(LongHorizon, OfTheNavcamMosaic) {
  VPE_NEED_SHARED(reference_path, "pano-navcam1051/dem_skyline.csv");
  VPE_NEED_SHARED(pano_path, "pano-navcam1051/pano.json");
  std::string planet;
  if (const char* ready = std::getenv("VPE_GALE_PLANET")) {
    planet = ready;
  } else {
    VPE_NEED_SHARED(globe, "mola8/mola8_topo.lbl");
    VPE_NEED_SHARED(crater, "gale-mola128/gale_megt128.lbl");
    VPE_NEED_SHARED(ctx, "gale-ctx20/gale_ctx20_mosaic.tif");
    VPE_NEED_SHARED(hirise, "gale-hirise1/missionDEM.tif");
    planet = path("gale.vpe");
    Command build = command_for({"build", globe.string(), crater.string(), ctx.string(), hirise.string(),
                                 "--datum", "areoid", "--level", "bend", "--mask-blunders", "--base-spacing",
                                 "20000", "--region", "136,-6.3,139.2,-3.0", "-q", "-o", planet});
    build.limit_s = 1200;
    const Result built = run(build);
    ASSERT_EQ(built.exit_code, 0) << built.err;
  }
  const json rover = parse_json(read_text(pano_path))["rover"];
  std::ostringstream place;
  place.precision(12);
  place << rover["lon_deg_east"].get<double>() << "," << rover["lat_deg"].get<double>();
  std::ostringstream height;
  height << rover["camera_height_above_ground_m_approx"].get<double>();
  const Result result = vpe({"horizon", planet, "--at", place.str(), "--height", height.str(), "--step", "0.5",
                             "-o", "s.csv", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const json summary = parse_json(result.out);
  const auto ours = read_skyline(dir_ / "s.csv");
  const auto theirs = read_skyline(reference_path);
  ASSERT_EQ(ours.size(), 720U);

  // Left out: 150 to 240, where the reference is known to be 3 degrees too high, and two arcs more where it is
  // up to 1.1 degrees above both S and the photograph, in straight lines from ridge to ridge.
  double worst = 0;
  int compared = 0;
  for (const Sight& s : theirs) {
    if (s.azimuth_deg >= 360) continue;
    const double a = s.azimuth_deg;
    if ((a >= 150 && a < 245) || (a > 71.5 && a < 84)) continue;
    ++compared;
    const double difference = std::abs(at(ours, a) - s.elevation_deg);
    EXPECT_LE(difference, 0.5) << a;
    worst = std::max(worst, difference);
  }
  RecordProperty("worst_deg", std::to_string(worst));
  EXPECT_GT(compared, 500);

  // There the photograph decides: edges read off it. MOLA's posts are 463 m apart, 0.3 degrees at 80 km and
  // more at the foot of Mount Sharp.
  for (const Sight& s : {Sight{79.2, 2.06}, {80.9, 2.26}, {83.7, 2.87}, {243.2, 2.35}, {246.7, 2.52}})
    EXPECT_NEAR(at(ours, s.azimuth_deg), s.elevation_deg, 0.35) << s.azimuth_deg;
  EXPECT_NEAR(summary["highest"]["azimuth_deg"].get<double>(), 119, 2);
  EXPECT_NEAR(summary["highest"]["elevation_deg"].get<double>(), 11.7, 0.2);
  std::printf("worst difference %.3f degrees over %d azimuths\n", worst, compared);
}

}  // namespace
}  // namespace app_test
