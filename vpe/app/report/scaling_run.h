// What `vpe report scaling` measures: one cost after the other against one size after the other.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "vpe/app/picture/image_options.h"
#include "vpe/app/report/scaling_planets.h"
#include "vpe/gl/context.h"
#include "vpe/report/law.h"

namespace vpe::app {

struct ScalingPlan {
  std::vector<int> grid_sides;   // posts a side, 2^n + 1
  std::vector<int> depth_sides;  // the same; the last one is the planet of images, threads and flights
  std::vector<Size> sizes;
  std::vector<int> threads;
  std::vector<double> speeds_m_s;
  Size size{640, 360};  // of grid, depth and flights
  Size thread_size{1280, 720};
  int rounds = 7;
  int build_rounds = 3;
  double flight_s = 6;                              // a quarter of it before anything counts
  std::size_t memory_bytes = std::size_t{1} << 30;  // of each renderer
};

// As it is run without options; with --full; with --short.
ScalingPlan usual_scaling();
ScalingPlan full_scaling();
ScalingPlan short_scaling();

// All that a step needs. One thread, that of the context.
struct ScalingBench {
  const ScalingPlan& plan;
  const ScalingPlanets& planets;
  std::shared_ptr<gl::Context> context;
  std::function<void()> step;  // called before every image that is measured; may throw
};

std::vector<report::Law> measure_grid(const ScalingBench& bench);
std::vector<report::Law> measure_depth(const ScalingBench& bench);
std::vector<report::Law> measure_image(const ScalingBench& bench);
std::vector<report::Law> measure_threads(const ScalingBench& bench);

struct FlightFigures {
  report::Table table;
  std::vector<report::Law> laws;
};
// Straight over the ground, as a window would: the camera is where the clock says, nothing waits for tiles, the
// controller holds kFlightBudget_ms by drawing coarser.
inline constexpr double kFlightBudget_ms = 33;
FlightFigures measure_flights(const ScalingBench& bench);

// How an image is drawn.
struct Configuration {
  std::string name;
  bool polygons = false;
  core::RayMode rays = core::RayMode::kExact;
};
inline const Configuration kPolygons{"polygons", true, core::RayMode::kExact};
inline const Configuration kExactRays{"rays, exact", false, core::RayMode::kExact};
inline const Configuration kMultiresRays{"rays, multires", false, core::RayMode::kMultires};

std::unique_ptr<core::Renderer> make_configuration(const ScalingBench& bench,
                                                   const Configuration& configuration, const PatchSpec& spec,
                                                   int threads = 0);
core::DrawRequest configuration_request(const Configuration& configuration, const core::View& view);

// A camera over the middle of a patch, so high over the ground there, looking down by so much.
struct Look {
  std::string name;
  double height_m = 0;
  double pitch_deg = 0;
};
inline const Look kNear{"from 500 m", 500, -10};
inline const Look kFar{"from 20 km", 20000, -60};
core::View look_at(std::shared_ptr<const paging::PlanetFile> planet, const PatchSpec& spec, const Look& look,
                   Size size);

}  // namespace vpe::app
