// The planet file of real MOLA data against the data themselves.
#include <gtest/gtest.h>

#include "paging/build/builder.h"
#include "paging/surface/surface.h"
#include "tests/support/support.h"

namespace {

using test_support::Random;
using test_support::TempDir;

TEST(LongRealData, QueryAgreesWithBilinearSampling) {
  VPE_NEED_SHARED(dem, "mola8/mola8_topo.lbl");
  TempDir dir;
  const auto source = mars::open_elevation(dem.string());
  paging::BuildOptions options;
  options.output = (dir / "mola8.vpe").string();
  const paging::BuildSummary built = paging::build_planet(options, *source, nullptr);
  const paging::Surface surface(paging::PlanetFile::open(options.output), std::size_t{256} << 20);

  Random random(71);
  std::vector<glm::dvec3> places{{0, 0, 1}, {0, 0, -1}};
  for (int n = 0; n < 10000; ++n) {
    if (n % 20 == 0) {
      places.push_back(mars::direction({n % 40 == 0 ? 180.0 : -180.0, random.uniform(-90, 90)}));
    } else if (n % 20 == 1) {
      places.push_back(mars::direction({random.uniform(-180, 180), n % 40 == 1 ? 89.99 : -89.99}));
    } else {
      places.push_back(random.direction());
    }
  }
  std::vector<double> direct(places.size());
  source->sample(places, 1.0, direct);
  double worst = 0;
  for (std::size_t n = 0; n < places.size(); ++n) {
    worst = std::max(worst, std::abs(surface.at(places[n]).height_m - direct[n]));
  }
  RecordProperty("worst_m", std::to_string(worst));
  std::printf("worst of %zu places: %.2f m; stated resampling error: maximum %.2f m, RMS %.2f m\n",
              places.size(), worst, built.meta.resampling.max_m, built.meta.resampling.rms_m);
  EXPECT_LE(worst, built.meta.resampling.max_m);

  // Known elevations (nearest sample of the source), within the stated error.
  const struct {
    mars::LonLat place;
    double elevation_m;
  } known[] = {{{226.875, 17.375}, 21128}, {{226.2, 18.65}, 19963}, {{70, -42.5}, -6200},
               {{62.19, -32.81}, -8130},   {{137.8, -5.4}, -1591},  {{137.4417, -4.5895}, -4476},
               {{312.05, 22.27}, -3635}};
  for (const auto& k : known) {
    EXPECT_NEAR(surface.at(mars::direction(k.place)).height_m, k.elevation_m, built.meta.resampling.max_m)
        << k.place.lon_deg << " " << k.place.lat_deg;
  }
}

}  // namespace
