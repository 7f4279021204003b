#include "vpe/app/report/feature_probe.h"

#include <sys/resource.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string_view>

#include "paging/surface/surface.h"
#include "vpe/app/cli/json_output.h"
#include "vpe/app/cli/parsing.h"
#include "vpe/app/cli/subprocess.h"
#include "vpe/app/planet/planet_argument.h"
#include "vpe/report/interleaved_timing.h"
#include "vpe/report/processor_time.h"

namespace vpe::app {
namespace {

// Returns the largest memory of this process. Avoids ru_maxrss where it can: on Linux that includes what the
// parent held when it started the process.
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

void run_probe(const ProbeRequest& request) {
  const FeatureScene* scene = find_scene(request.scene);
  if (scene == nullptr) throw UsageError("there is no scene '" + request.scene + "'");
  Common common;
  common.memory_mb = request.memory_mb;
  common.threads = request.threads;
  common.quiet = true;
  const auto planet = open_planet(request.planet, common);
  RenderOptions options;
  options.backend = request.backend;
  const std::unique_ptr<core::Renderer> renderer = make_renderer(options, common, planet);
  const core::DrawRequest draw_request =
      scene_request(*scene, feature_view(request.pose, request.size, planet));
  ScenePainter painter(*scene, planet, request.statistics_file);
  core::FrameStats stats = painter.paint(*renderer, draw_request);
  const report::Clock clock = report::wall_clock();
  const double finished_s = clock();
  std::vector<double> frames_s;
  std::vector<double> processors_s;
  for (int frame = 0; frame < request.frames; ++frame) {
    const double begin_s = clock();
    const double before_s = report::processor_s();
    stats = painter.paint(*renderer, draw_request);
    frames_s.push_back(clock() - begin_s);
    processors_s.push_back(report::processor_s() - before_s);
  }
  print_json({{"finished_s", finished_s},
              {"peak_mb", peak_mb()},
              {"frame_s", report::median(std::move(frames_s))},
              {"processor_s", report::median(std::move(processors_s))},
              {"resident_mb", static_cast<double>(stats.bytes_resident) * 1e-6}});
}

report::SceneCost probe(const ProbeRequest& request) {
  const double begin_s = report::wall_clock()();
  Subprocess child({request.program,
                    "report",
                    "features",
                    "--probe",
                    request.scene,
                    "--backend",
                    std::string(core::to_string(request.backend)),
                    "--pose",
                    request.pose,
                    "--size",
                    request.size,
                    "--memory",
                    std::to_string(request.memory_mb),
                    "--threads",
                    std::to_string(request.threads),
                    "--frames",
                    std::to_string(request.frames),
                    "--statistics",
                    request.statistics_file,
                    "--",
                    request.planet});
  if (!child.finish()) {
    throw std::runtime_error(request.program + " could not draw the scene '" + request.scene +
                             "': " + child.stderr_text());
  }
  const nlohmann::json object = nlohmann::json::parse(child.output(), nullptr, false);
  if (!object.is_object() || !object.contains("finished_s")) {
    throw std::runtime_error(request.program + " did not print measurements of the scene '" + request.scene +
                             "': give one of the same version");
  }
  report::SceneCost cost;
  cost.startup_s = object["finished_s"].get<double>() - begin_s;
  cost.peak_mb = object["peak_mb"].get<double>();
  cost.frame_s = object["frame_s"].get<double>();
  cost.processor_s = object["processor_s"].get<double>();
  cost.resident_mb = object["resident_mb"].get<double>();
  return cost;
}

}  // namespace vpe::app
