#include "vpe/app/report/feature_probe.h"

#include <sys/resource.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string_view>

#include "paging/surface/surface.h"
#include "vpe/app/cli/json_output.h"
#include "vpe/app/cli/processor_time.h"
#include "vpe/app/cli/subprocess.h"
#include "vpe/app/planet/planet_argument.h"
#include "vpe/report/interleaved_timing.h"

namespace vpe::app {
namespace {

// Not ru_maxrss: on Linux that of a process counts what its parent held when it was started.
double peak_mb() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    constexpr std::string_view kKey = "VmHWM:";
    if (line.starts_with(kKey)) return std::stod(line.substr(kKey.size())) * 1024e-6;  // given in KiB
  }
  rusage used{};
  ::getrusage(RUSAGE_SELF, &used);
  return static_cast<double>(used.ru_maxrss) * 1024e-6;
}

}  // namespace

core::View feature_view(const std::string& pose, const std::string& size,
                        const std::shared_ptr<const paging::PlanetFile>& planet) {
  const auto numbers = parse_numbers(pose);
  if (!numbers || numbers->size() != 5 || !mars::is_valid({(*numbers)[0], (*numbers)[1]}) ||
      !((*numbers)[2] > 0)) {
    throw UsageError("--pose '" + pose +
                     "': expected LON,LAT,HEIGHT,YAW,PITCH (degrees, metres above the terrain)");
  }
  const mars::LonLat place{(*numbers)[0], (*numbers)[1]};
  const double ground_m = paging::Surface(planet, std::size_t{8} << 20).at(mars::direction(place)).height_m;
  const Size pixels = parse_size(size);
  core::View view;
  view.camera =
      mars::to_camera({place.lon_deg, place.lat_deg, ground_m + (*numbers)[2], (*numbers)[3], (*numbers)[4], 0},
                      planet->radius_m());
  view.width = pixels.width;
  view.height = pixels.height;
  return view;
}

void run_probe(const ProbeRequest& order) {
  const FeatureScene* scene = find_scene(order.scene);
  if (scene == nullptr) throw UsageError("there is no scene '" + order.scene + "'");
  Common common;
  common.memory_mb = order.memory_mb;
  common.threads = order.threads;
  common.quiet = true;
  const auto planet = open_planet(order.planet, common);
  RenderOptions options;
  options.backend = order.backend;
  const std::unique_ptr<core::Renderer> renderer = make_renderer(options, common, planet);
  const core::DrawRequest request = scene_request(*scene, feature_view(order.pose, order.size, planet));
  ScenePainter painter(*scene, planet, order.statistics_file);
  core::FrameStats stats = painter.paint(*renderer, request);
  const report::Clock clock = report::wall_clock();
  const double finished_s = clock();
  std::vector<double> frames_s;
  std::vector<double> processors_s;
  for (int frame = 0; frame < order.frames; ++frame) {
    const double begin_s = clock();
    const double before_s = processor_s();
    stats = painter.paint(*renderer, request);
    frames_s.push_back(clock() - begin_s);
    processors_s.push_back(processor_s() - before_s);
  }
  print_json({{"finished_s", finished_s},
              {"peak_mb", peak_mb()},
              {"frame_s", report::median(std::move(frames_s))},
              {"processor_s", report::median(std::move(processors_s))},
              {"resident_mb", static_cast<double>(stats.bytes_resident) * 1e-6}});
}

report::SceneCost probe(const ProbeRequest& order) {
  const double begin_s = report::wall_clock()();
  Subprocess child({order.program,
                    "report",
                    "features",
                    "--probe",
                    order.scene,
                    "--backend",
                    order.backend,
                    "--pose",
                    order.pose,
                    "--size",
                    order.size,
                    "--memory",
                    std::to_string(order.memory_mb),
                    "--threads",
                    std::to_string(order.threads),
                    "--frames",
                    std::to_string(order.frames),
                    "--statistics",
                    order.statistics_file,
                    "--",
                    order.planet});
  if (!child.finish()) {
    throw std::runtime_error(order.program + " could not draw the scene '" + order.scene +
                             "': " + child.stderr_text());
  }
  const nlohmann::json json = nlohmann::json::parse(child.output(), nullptr, false);
  if (!json.is_object() || !json.contains("finished_s")) {
    throw std::runtime_error(order.program + " did not print what it measured of the scene '" + order.scene +
                             "': give one of the same version");
  }
  report::SceneCost cost;
  cost.startup_s = json["finished_s"].get<double>() - begin_s;
  cost.peak_mb = json["peak_mb"].get<double>();
  cost.frame_s = json["frame_s"].get<double>();
  cost.processor_s = json["processor_s"].get<double>();
  cost.resident_mb = json["resident_mb"].get<double>();
  return cost;
}

}  // namespace vpe::app
