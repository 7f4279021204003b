// Memory of the process on a flight that does not wait stays within --memory and flat.
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>

#include "tests/gl/gl_fixture.h"
#include "tests/support/sanitized.h"
#include "vpe/base/heap.h"

namespace {

using test_support::build_fake;
using test_support::bumpy_height;
using test_support::FakeElevation;

constexpr double kMegabyte = 1 << 20;

// Returns the resident memory of this process, as the kernel counts it (VmRSS).
double resident_mb() {
  std::ifstream in("/proc/self/statm");
  double all = 0, resident = 0;
  in >> all >> resident;
  return resident * static_cast<double>(sysconf(_SC_PAGESIZE)) / kMegabyte;
}

struct Flight {
  mars::LonLat from;
  double bearing_deg = 0;
  double speed_m_s = 0;
  double duration_s = 0;
  double fps = 0;
  double least_height_m = 0;  // above the ground
  int width = 0;
  int height = 0;
  int wait_every = 0;  // one frame in this many waits for its tiles; 0 = none
  int passes = 1;      // how often the whole way is flown

  int frames() const { return static_cast<int>(std::lround(duration_s * fps)); }  // of one pass
  mars::LonLat place(double t, double radius_m) const {
    return mars::destination(from, bearing_deg, speed_m_s * t / radius_m);
  }
};

// Returns altitudes at whole seconds. The highest ground within 10 s, averaged over 10 s each way, is smooth
// and never below the ground.
std::vector<double> altitudes(const Flight& flight, const paging::Surface& surface) {
  constexpr int kReach = 10;
  const int count = static_cast<int>(flight.duration_s) + 2;
  std::vector<double> ground, highest, out;
  for (int s = -2 * kReach; s < count + 2 * kReach; ++s) {
    ground.push_back(surface.at(mars::direction(flight.place(s, surface.planet_radius_m()))).height_m);
  }
  for (auto at = ground.begin(); at + 2 * kReach != ground.end(); ++at) {
    highest.push_back(*std::max_element(at, at + 2 * kReach + 1));
  }
  for (int s = 0; s < count; ++s) {
    double sum = 0;
    for (int k = 0; k <= 2 * kReach; ++k) sum += highest[static_cast<std::size_t>(s + k)];
    out.push_back(sum / (2 * kReach + 1) + flight.least_height_m);
  }
  return out;
}

// Returns a view ahead and a little down. The camera sways to both sides, and climbs and sinks by up to four
// times its least height.
vpe::core::View view_at(const Flight& flight, const std::vector<double>& altitude_m, double t,
                        double radius_m) {
  const mars::LonLat at = flight.place(t, radius_m);
  const double yaw = mars::initial_bearing_deg(at, flight.place(t + 1, radius_m));
  const auto second = static_cast<std::size_t>(t);
  const double part = t - std::floor(t);
  const double rise = flight.least_height_m * 2 * (1 - std::cos(t * 2 * mars::kPi / 97));
  const double alt = altitude_m[second] * (1 - part) + altitude_m[second + 1] * part + rise;
  const mars::Pose pose{at.lon_deg, at.lat_deg, alt, yaw + 40 * std::sin(t / 17), -12 + 8 * std::sin(t / 29),
                        0};
  return test_support::request_for(pose, radius_m, flight.width, flight.height).view;
}

struct LineFit {
  double slope = 0;
  double slope_error = 0;  // standard error, as if residuals were independent
  double spread = 0;       // standard deviation of the residuals
};
LineFit fit_line(const std::vector<glm::dvec2>& points) {
  glm::dvec2 mean(0);
  for (const glm::dvec2& p : points) mean += p / static_cast<double>(points.size());
  double xx = 0, xy = 0, squares = 0;
  for (const glm::dvec2& p : points) {
    xx += (p.x - mean.x) * (p.x - mean.x);
    xy += (p.x - mean.x) * (p.y - mean.y);
  }
  const double slope = xy / xx;
  for (const glm::dvec2& p : points) squares += std::pow(p.y - mean.y - slope * (p.x - mean.x), 2);
  const double spread = std::sqrt(squares / (static_cast<double>(points.size()) - 2));
  return {slope, spread / std::sqrt(xx), spread};
}

// Returns by how much memory grows from the first pass to the last at equal places, on average over the samples from
// `from_s` on. Between equal views it is free of what the driver takes for the triangles of a view.
double growth_mb(const std::vector<std::vector<glm::dvec2>>& passes, double from_s) {
  double sum = 0;
  int count = 0;
  for (std::size_t k = 0; k < passes.front().size(); ++k) {
    if (passes.front()[k].x < from_s) continue;
    sum += passes.back()[k].y - passes.front()[k].y;
    ++count;
  }
  return sum / count;
}

class FlightMemory : public test_support::GlTest {
 protected:
  // Returns the memory of the process with this context after one frame of a tiny planet, in the mode and size
  // of the flight.
  double base_mb(const Flight& flight) {
    vpe::base::keep_heap_compact();  // as `vpe` does
    const auto tiny = build_fake(dir_ / "tiny.vpe", FakeElevation(bumpy_height), 500000);
    const auto draw = renderer(tiny);
    draw->draw(request({view_at(flight, std::vector<double>(10, 1e6), 0, tiny->radius_m())}));
    return resident_mb();
  }

  // Returns a request for views[0] with the other views upcoming.
  static vpe::core::DrawRequest request(std::vector<vpe::core::View> views) {
    vpe::core::DrawRequest out;
    out.view = views[0];
    out.settings.mode = vpe::core::Mode::kColoured;
    out.sun = glm::normalize(glm::dvec3(1, 0.3, 0.2));
    out.paging.wait = false;
    out.paging.upcoming.assign(views.begin() + 1, views.end());
    return out;
  }

  // Flies, and expects the process to stay within base + 1.15 x memory_mb, and flat from flat_from_s on. On one pass a
  // line through the samples rises or falls by less than 5 % of the memory; on several, the last has as much memory
  // as the first at equal places to 5 % on average.
  void fly(const Flight& flight, const std::string& file, double base, int memory_mb, double flat_from_s) {
    const auto planet = paging::PlanetFile::open(file);
    const double radius = planet->radius_m();
    std::vector<double> altitude_m;
    {
      const paging::Surface surface(planet, std::size_t{4} << 20);
      altitude_m = altitudes(flight, surface);
    }
    const auto draw =
        vpe::gl::make_polygon_renderer(context_, planet, {static_cast<std::size_t>(memory_mb) << 20, 2, {}});
    const auto start = std::chrono::steady_clock::now();
    const double last = flight.frames() / flight.fps;
    const int per_sample = std::max(1, static_cast<int>(flight.fps * flight.duration_s / 120));
    double highest_mb = 0, held_mb = 0;
    std::int64_t uploaded = 0, evicted = 0, wanted = 0, missing = 0;
    std::vector<glm::dvec2> samples, uncounted;
    std::vector<std::vector<glm::dvec2>> passes(static_cast<std::size_t>(flight.passes));
    for (int drawn = 0; drawn < flight.frames() * flight.passes; ++drawn) {
      const int n = drawn % flight.frames();
      const double t = n / flight.fps;
      const auto view = [&](double ahead) {
        return view_at(flight, altitude_m, std::min(t + ahead, last), radius);
      };
      vpe::core::DrawRequest frame = request({view(0), view(0.25), view(1)});
      frame.paging.wait = flight.wait_every > 0 && n % flight.wait_every == 0;
      const auto result = draw->draw(frame);
      ASSERT_TRUE(result.failures.empty()) << result.failures[0];
      held_mb = std::max(held_mb, static_cast<double>(result.stats.bytes_resident) / kMegabyte);
      uploaded += result.stats.pages_uploaded;
      evicted += result.stats.pages_evicted;
      missing += result.stats.tiles_missing;
      wanted += result.stats.tiles_missing + result.stats.tiles_drawn - result.stats.tiles_substituted;
      if (n % per_sample != per_sample - 1) continue;
      const double now_mb = resident_mb();
      highest_mb = std::max(highest_mb, now_mb - base);
      passes[static_cast<std::size_t>(drawn / flight.frames())].emplace_back(t, now_mb - base);
      if (t >= flat_from_s) {
        samples.emplace_back(t, now_mb - base);
        uncounted.emplace_back(t, now_mb - base - static_cast<double>(result.stats.bytes_resident) / kMegabyte);
      }
      if (n / per_sample % 12 == 0) {
        std::printf("%5.0f s of flight: %4.0f MB above base, %4.0f MB counted\n", t, now_mb - base,
                    static_cast<double>(result.stats.bytes_resident) / kMegabyte);
        std::fflush(stdout);
      }
    }
    const LineFit line = fit_line(samples);
    const double fitted_s = samples.back().x - samples.front().x;
    const double counted_rise = line.slope * fitted_s - fit_line(uncounted).slope * fitted_s;
    std::printf("base %.0f MB; at most %.1f MB above it, %.1f MB counted\n", base, highest_mb, held_mb);
    std::printf("from %.0f s on %+.4f +- %.4f MB/s: %+.1f MB in all, %+.1f MB of it counted; spread %.1f MB\n",
                flat_from_s, line.slope, line.slope_error, line.slope * fitted_s, counted_rise, line.spread);
    std::printf("%lld pages uploaded, %lld evicted, %.1f %% of the tiles missing; %.0f s for %d frames\n",
                static_cast<long long>(uploaded), static_cast<long long>(evicted),
                100.0 * static_cast<double>(missing) / static_cast<double>(wanted),
                std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(),
                flight.frames() * flight.passes);
    if (flight.passes > 1) {
      std::printf("%d passes: %+.1f MB from the first to the last at equal places\n", flight.passes,
                  growth_mb(passes, flat_from_s));
    }
    EXPECT_GT(evicted, 0);  // else the flight does not test the bound
    EXPECT_LE(held_mb, memory_mb);
    if (test_support::kIsSanitized) return;
    EXPECT_LE(highest_mb, 1.15 * memory_mb);
    const double change_mb = flight.passes > 1 ? growth_mb(passes, flat_from_s) : line.slope * fitted_s;
    EXPECT_LE(std::abs(change_mb), 0.05 * memory_mb);
  }
};

TEST_F(FlightMemory, StaysWithinTheBudgetAndFlat) {
  const Flight flight{{20, 3}, 80, 40000, 60, 4, 8000, 160, 90, 10};
  const double base = base_mb(flight);
  const auto near_route = [](const mars::Cap& cap) {
    return std::abs(cap.centre.z) < 0.15 + cap.radius_rad ? 8000.0 : 1e9;
  };
  build_fake(dir_ / "p.vpe", FakeElevation(bumpy_height, near_route), 100000);
  fly(flight, dir_ / "p.vpe", base, 64, 20);
}

// Needs the largest planet file at hand. Its way leads from plains of a thousand triangles a view over a canyon of 170 000, for
// which the driver needs up to 20 MB more.
using LongFlight = FlightMemory;
TEST_F(LongFlight, TenMinutesTwiceAtTenKilometresASecond) {
  const char* file = std::getenv("VPE_LARGE_PLANET");
  if (file == nullptr || *file == '\0') GTEST_SKIP() << "skipped: $VPE_LARGE_PLANET names no planet file";
  const Flight flight{{-130, 5}, 100, 10000, 600, 10, 3000, 640, 360, 0, 2};
  fly(flight, file, base_mb(flight), 256, 120);
}

}  // namespace
