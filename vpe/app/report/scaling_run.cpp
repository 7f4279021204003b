#include "vpe/app/report/scaling_run.h"

#include <algorithm>
#include <cmath>

#include "mars/geodesy/sun.h"
#include "paging/surface/surface.h"
#include "vpe/base/parallel.h"
#include "vpe/gl/polygon_renderer.h"
#include "vpe/report/interleaved_timing.h"
#include "vpe/report/processor_time.h"
#include "vpe/voxel/ray_renderer.h"

namespace vpe::app {
namespace {

std::vector<int> doublings_to(int most) {
  std::vector<int> all;
  for (int n = 1; n < most; n *= 2) all.push_back(n);
  all.push_back(most);
  return all;
}

// The images of one method, one for each x.
class Images {
 public:
  explicit Images(const ScalingBench& bench) : bench_(bench) {}

  void add(double x, std::unique_ptr<core::Renderer> renderer, const core::DrawRequest& request) {
    shots_.push_back({x, std::move(renderer), request, {}, {}});
  }

  // Returns three laws: times of frames, their processor times, and what was counted in each frame.
  std::vector<report::Law> measure(report::Law time, report::Law count,
                                   const std::function<double(const core::DrawResult&)>& counted) {
    std::vector<std::function<void()>> cases;
    std::vector<double> x;
    for (Shot& shot : shots_) {
      x.push_back(shot.x);
      cases.emplace_back([this, &shot, &counted] {
        bench_.step();
        const double begin_s = report::processor_s();
        shot.count = counted(shot.renderer->draw(shot.request));
        shot.processor_s.push_back(report::processor_s() - begin_s);
      });
    }
    report::Law processor = time;
    processor.y_name = "processor_s";
    time.samples = report::timed_samples(x, report::time_interleaved(cases, bench_.plan.rounds));
    for (Shot& shot : shots_) {
      shot.processor_s.erase(shot.processor_s.begin());  // the untimed round
      processor.samples.push_back({shot.x, shot.processor_s});
      count.samples.push_back({shot.x, {shot.count}});
    }
    return {std::move(time), std::move(processor), std::move(count)};
  }

 private:
  struct Shot {
    double x;
    std::unique_ptr<core::Renderer> renderer;
    core::DrawRequest request;
    double count;
    std::vector<double> processor_s;  // one for each round
  };
  const ScalingBench& bench_;
  std::vector<Shot> shots_;
};

double triangles(const core::DrawResult& result) { return static_cast<double>(result.stats.triangles); }
double rays(const core::DrawResult& result) { return static_cast<double>(result.frame.colour.size()); }
double tiles(const core::DrawResult& result) { return static_cast<double>(result.stats.tiles_drawn); }

std::vector<report::Law> measure_method(Images& images, const DrawMethod& method, const std::string& axis,
                                        const std::string& what, const std::string& x_name,
                                        std::optional<double> least, std::optional<double> most) {
  const report::Law time{axis, what, x_name, "frame_s", least, most, {}};
  report::Law count = time;
  count.least_exponent.reset();
  count.most_exponent.reset();
  // Only larger images have more rays.
  const bool counts_rays = !method.polygons && axis == "image";
  count.y_name = method.polygons ? "triangles" : counts_rays ? "rays" : "tiles";
  return images.measure(time, count, method.polygons ? triangles : counts_rays ? rays : tiles);
}

void append(std::vector<report::Law>& laws, std::vector<report::Law> more) {
  std::move(more.begin(), more.end(), std::back_inserter(laws));
}

}  // namespace

ScalingPlan usual_scaling() {
  ScalingPlan plan;
  plan.grid_sides = {257, 513, 1025, 2049, 4097};
  plan.depth_sides = {513, 1025, 2049, 4097, 8193};
  plan.sizes = {{160, 90}, {320, 180}, {640, 360}, {1280, 720}, {1920, 1080}};
  plan.threads = doublings_to(base::default_threads());
  plan.speeds_m_s = {125, 250, 500, 1000, 2000, 4000, 8000};
  return plan;
}

ScalingPlan full_scaling() {
  ScalingPlan plan = usual_scaling();
  plan.grid_sides = {257, 513, 1025, 2049, 4097, 8193, 16385};
  plan.depth_sides = {513, 1025, 2049, 4097, 8193, 16385};
  plan.sizes.push_back({3840, 2160});
  return plan;
}

ScalingPlan short_scaling() {
  ScalingPlan plan;
  plan.grid_sides = {257, 513};
  plan.depth_sides = {257, 513};
  plan.sizes = {{80, 45}, {160, 90}, {320, 180}};
  plan.threads = doublings_to(std::min(2, base::default_threads()));
  plan.speeds_m_s = {1000, 4000};
  plan.size = {160, 90};
  plan.thread_size = {320, 180};
  plan.rounds = 2;
  plan.build_rounds = 1;
  plan.flight_s = 0.5;
  return plan;
}

std::unique_ptr<core::Renderer> make_scaling_renderer(const ScalingBench& bench, const DrawMethod& method,
                                                      const PatchSpec& spec, int threads) {
  const auto planet = bench.planets.planet(spec);
  if (!method.polygons) return voxel::make_ray_renderer(planet, {bench.plan.memory_bytes, threads});
  gl::RendererOptions options;
  options.memory_bytes = bench.plan.memory_bytes;
  options.threads = threads;
  return gl::make_polygon_renderer(bench.context, planet, options);
}

core::DrawRequest scaling_request(const DrawMethod& method, const core::View& view) {
  core::DrawRequest request;
  request.view = view;
  request.settings.ray_mode = method.rays;
  request.sun = mars::sun_direction(mars::lon_lat(view.camera.position_m), request.settings.sun_azimuth_deg,
                                    request.settings.sun_elevation_deg);
  return request;
}

core::View view_of(const PatchView& patch_view, std::shared_ptr<const paging::PlanetFile> planet,
                   const PatchSpec& spec, Size size) {
  const double radius_m = planet->radius_m();
  const mars::ChartRect rect = lod::chart_rect(spec.patch);
  const glm::dvec3 middle =
      mars::chart_direction(spec.patch.face, (rect.u0 + rect.u1) / 2, (rect.v0 + rect.v1) / 2);
  const double ground_m = paging::Surface(std::move(planet), std::size_t{8} << 20).at(middle).height_m;
  const mars::LonLat place = mars::lon_lat(middle);
  core::View view;
  view.camera = mars::to_camera(
      {place.lon_deg, place.lat_deg, ground_m + patch_view.height_m, 22.5, patch_view.pitch_deg, 0}, radius_m);
  view.width = size.width;
  view.height = size.height;
  return view;
}

std::vector<report::Law> measure_grid(const ScalingBench& bench) {
  std::vector<report::Law> laws;
  for (const DrawMethod& method : {kPolygons, kExactRays, kMultiresRays}) {
    Images images(bench);
    for (const int side : bench.plan.grid_sides) {
      const PatchSpec spec = grid_patch(side);
      const core::View view = view_of(kNear, bench.planets.planet(spec), spec, bench.plan.size);
      images.add(side, make_scaling_renderer(bench, method, spec), scaling_request(method, view));
    }
    append(laws, measure_method(images, method, "grid", method.name, "posts a side, all 10 m apart", {}, {}));
  }
  return laws;
}

std::vector<report::Law> measure_depth(const ScalingBench& bench) {
  constexpr double kMostGrowth = 0.1;
  std::vector<report::Law> laws;
  const PatchSpec deepest = depth_patch(bench.plan.depth_sides.back());
  for (const PatchView& patch_view : {kNear, kFarView}) {
    const core::View view = view_of(patch_view, bench.planets.planet(deepest), deepest, bench.plan.size);
    for (const DrawMethod& method : {kPolygons, kMultiresRays, kExactRays}) {
      Images images(bench);
      for (const int side : bench.plan.depth_sides)
        images.add(side, make_scaling_renderer(bench, method, depth_patch(side)),
                   scaling_request(method, view));
      const bool has_aim = method.polygons || method.rays == core::RayMode::kMultires;
      append(laws, measure_method(images, method, "depth", method.name + " " + patch_view.name,
                                  "posts a side, all of one patch of 42 km", {},
                                  has_aim ? std::optional(kMostGrowth) : std::nullopt));
    }
  }
  return laws;
}

std::vector<report::Law> measure_image(const ScalingBench& bench) {
  std::vector<report::Law> laws;
  const PatchSpec spec = depth_patch(bench.plan.depth_sides.back());
  for (const DrawMethod& method : {kPolygons, kExactRays, kMultiresRays}) {
    Images images(bench);
    for (const Size& size : bench.plan.sizes) {
      const core::View view = view_of(kNear, bench.planets.planet(spec), spec, size);
      images.add(static_cast<double>(size.width) * size.height, make_scaling_renderer(bench, method, spec),
                 scaling_request(method, view));
    }
    append(laws, measure_method(images, method, "image", method.name, "pixels", {}, {}));
  }
  return laws;
}

std::vector<report::Law> measure_threads(const ScalingBench& bench) {
  // Within a tenth of half the time with twice as many threads.
  const double least = -1 + std::log2(0.9);
  const double most = -1 + std::log2(1.1);
  std::vector<report::Law> laws;
  const PatchSpec spec = depth_patch(bench.plan.depth_sides.back());
  const core::View view = view_of(kNear, bench.planets.planet(spec), spec, bench.plan.thread_size);
  for (const DrawMethod& method : {kExactRays, kMultiresRays}) {
    Images images(bench);
    for (const int threads : bench.plan.threads)
      images.add(threads, make_scaling_renderer(bench, method, spec, threads), scaling_request(method, view));
    for (report::Law& law : measure_method(images, method, "threads", method.name, "threads", least, most)) {
      // The processor time of all threads together has no aim.
      if (law.y_name == "processor_s") law.least_exponent = law.most_exponent = {};
      laws.push_back(std::move(law));
    }
  }
  return laws;
}

}  // namespace vpe::app
