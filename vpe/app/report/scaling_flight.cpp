// The flights of `vpe report scaling`.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <thread>

#include "lod/frame_budget.h"
#include "vpe/app/report/scaling_run.h"
#include "vpe/base/quantile.h"

namespace vpe::app {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double kAltitude_m = 2000;  // above the sphere: over the highest ground
constexpr double kMargin = 0.05;      // of the patch, at either end
constexpr double kAhead_s[] = {0.25, 1.0};

double seconds(Clock::duration time) { return std::chrono::duration<double>(time).count(); }

struct Flown {
  std::vector<double> frame_ms;
  std::vector<double> multiplier;
  double pages = 0;
  int incomplete = 0;
  double flown_s = 0;

  double share_over_budget() const {
    // Nobody sees that a frame is late by less than a tenth.
    const auto late =
        std::count_if(frame_ms.begin(), frame_ms.end(), [](double ms) { return ms > 1.1 * kFlightBudget_ms; });
    return static_cast<double>(late) / static_cast<double>(frame_ms.size());
  }
  double share_incomplete() const {
    return static_cast<double>(incomplete) / static_cast<double>(frame_ms.size());
  }
};

class Course {
 public:
  Course(const PatchSpec& spec, Size size, double radius_m) : size_(size), radius_m_(radius_m) {
    const mars::ChartRect rect = lod::chart_rect(spec.patch);
    const double v = (rect.v0 + rect.v1) / 2;
    const double width = rect.u1 - rect.u0;
    from_ = mars::chart_direction(spec.patch.face, rect.u0 + kMargin * width, v);
    to_ = mars::chart_direction(spec.patch.face, rect.u1 - kMargin * width, v);
    length_m_ = mars::angle_between_rad(from_, to_) * (radius_m + kAltitude_m);
  }

  // Returns the view after this distance. The course goes back and forth.
  core::View at(double distance_m) const {
    const double part = distance_m / length_m_;
    const double folded = std::abs(part - 2 * std::floor((part + 1) / 2));
    const mars::LonLat place = mars::lon_lat(mars::slerp(from_, to_, folded));
    const mars::LonLat end = mars::lon_lat(mars::slerp(from_, to_, 1.1));
    core::View view;
    view.camera = mars::to_camera(
        {place.lon_deg, place.lat_deg, kAltitude_m, mars::initial_bearing_deg(place, end), -15, 0}, radius_m_);
    view.width = size_.width;
    view.height = size_.height;
    return view;
  }

 private:
  Size size_;
  double radius_m_;
  glm::dvec3 from_{};
  glm::dvec3 to_{};
  double length_m_ = 0;
};

Flown fly(const ScalingBench& bench, const PatchSpec& spec, const Course& course, double speed_m_s) {
  const std::unique_ptr<core::Renderer> renderer = make_scaling_renderer(bench, kPolygons, spec);
  // The sun stands still: another direction would shade every tile anew.
  const core::DrawRequest first = scaling_request(kPolygons, course.at(0));
  lod::FrameBudgetOptions budget;
  budget.budget_ms = kFlightBudget_ms;
  lod::FrameBudgetState state;
  Flown flown;
  renderer->draw(first);
  // At first, tiles for everything ahead arrive. That time is not counted.
  const double start_s = bench.plan.flight_s / 4;
  const auto start = Clock::now();
  while (flown.frame_ms.empty() || seconds(Clock::now() - start) < bench.plan.flight_s) {
    bench.step();
    const auto begin = Clock::now();
    const double t = seconds(begin - start);
    core::DrawRequest request = first;
    request.view = course.at(speed_m_s * t);
    request.coarsening = state.multiplier;
    request.paging.wait = false;
    for (const double ahead_s : kAhead_s)
      request.paging.upcoming.push_back(course.at(speed_m_s * (t + ahead_s)));
    const core::DrawResult result = renderer->draw(request);
    const double ms = 1e3 * seconds(Clock::now() - begin);
    if (t >= start_s) {
      flown.frame_ms.push_back(ms);
      flown.multiplier.push_back(request.coarsening);
      flown.pages += static_cast<double>(result.stats.pages_uploaded);
      flown.incomplete += result.stats.tiles_missing > 0 ? 1 : 0;
    }
    lod::next_multiplier(budget, {request.coarsening, ms}, state);
    // A window draws no more frames than its screen shows.
    std::this_thread::sleep_until(begin + std::chrono::milliseconds(static_cast<int>(kFlightBudget_ms)));
  }
  flown.flown_s = seconds(Clock::now() - start) - start_s;
  return flown;
}

}  // namespace

FlightFigures measure_flights(const ScalingBench& bench) {
  FlightFigures out;
  out.table = {
      "scaling-flights",
      "Flights at 2 km over the deepest planet, in polygons, as a window draws them: at most a frame every "
      "33 ms, tiles arrive during the flight, and the controller draws coarser to keep to 33 ms.",
      {{"speed_m_s", "speed over the ground"},
       {"frames", "number of frames drawn"},
       {"frame_median_ms", "time of a frame, median"},
       {"frame_p95_ms", "time of a frame, 95 % quantile"},
       {"late_share", "share of frames longer than 1.1 times the budget"},
       {"pages_per_s", "meshes and textures that arrived"},
       {"pages_per_km", "meshes and textures that arrived"},
       {"incomplete_share", "share of frames with coarser tiles in place of ones not loaded yet"},
       {"coarsening_median", "factor on the tolerance, median"}},
      {}};
  report::Law pages{"speed", "polygons", "speed_m_s", "pages_per_s", {}, {}, {}};
  report::Law frames{"speed", "polygons", "speed_m_s", "frame_s", {}, {}, {}};
  const PatchSpec spec = depth_patch(bench.plan.depth_sides.back());
  const Course course(spec, bench.plan.size, bench.planets.planet(spec)->radius_m());
  for (const double speed_m_s : bench.plan.speeds_m_s) {
    Flown flown = fly(bench, spec, course, speed_m_s);
    const double per_s = flown.pages / flown.flown_s;
    const double median_ms = report::median(flown.frame_ms);
    const double p95_ms = base::quantile_floor(flown.frame_ms, 0.95);
    out.table.add({speed_m_s, static_cast<double>(flown.frame_ms.size()), median_ms, p95_ms,
                   flown.share_over_budget(), per_s, 1e3 * per_s / speed_m_s, flown.share_incomplete(),
                   report::median(flown.multiplier)});
    pages.samples.push_back({speed_m_s, {per_s}});
    frames.samples.push_back({speed_m_s, {1e-3 * median_ms}});
  }
  out.laws = {std::move(pages), std::move(frames)};
  return out;
}

}  // namespace vpe::app
