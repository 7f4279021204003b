// The measurements of `vpe report scaling`: one cost after another over one size after another.
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
  std::vector<int> depth_sides;  // likewise; the last one is the planet of images, threads and flights
  std::vector<Size> sizes;
  std::vector<int> threads;
  std::vector<double> speeds_m_s;
  Size size{640, 360};  // of grid, depth and flights
  Size thread_size{1280, 720};
  int rounds = 7;                                   // more: more reliable medians
  int build_rounds = 3;                             // of small planets
  double flight_s = 6;                              // the first quarter is not counted
  std::size_t memory_bytes = std::size_t{1} << 30;  // of each renderer. Smaller: tiles are loaded again
};

// Return the plan without options, with --full, and with --short.
ScalingPlan usual_scaling();
ScalingPlan full_scaling();
ScalingPlan short_scaling();

// Everything that a measurement needs. Use it on the context's thread.
struct ScalingBench {
  const ScalingPlan& plan;
  const ScalingPlanets& planets;
  std::shared_ptr<gl::Context> context;
  std::function<void()> step;  // called before every measured image; may throw to stop
};

// Measure one axis each and return its laws.
std::vector<report::Law> measure_grid(const ScalingBench& bench);
std::vector<report::Law> measure_depth(const ScalingBench& bench);
std::vector<report::Law> measure_image(const ScalingBench& bench);
std::vector<report::Law> measure_threads(const ScalingBench& bench);

struct FlightFigures {
  report::Table table;
  std::vector<report::Law> laws;
};
// Frame time that flights keep to by drawing coarser.
inline constexpr double kFlightBudget_ms = 33;
// Flies straight over the terrain as a window would: the clock gives the camera's place, no frame waits for
// tiles, and the controller of the frame time draws coarser.
FlightFigures measure_flights(const ScalingBench& bench);

// A backend and its mode.
struct DrawMethod {
  std::string name;
  bool polygons = false;
  core::RayMode rays = core::RayMode::kExact;
};
inline const DrawMethod kPolygons{"polygons", true, core::RayMode::kExact};
inline const DrawMethod kExactRays{"rays, exact", false, core::RayMode::kExact};
inline const DrawMethod kMultiresRays{"rays, multires", false, core::RayMode::kMultires};

// Makes a renderer of the method for the planet of a patch. threads: 0 = all cores.
std::unique_ptr<core::Renderer> make_scaling_renderer(const ScalingBench& bench, const DrawMethod& method,
                                                      const PatchSpec& spec, int threads = 0);
core::DrawRequest scaling_request(const DrawMethod& method, const core::View& view);

// A camera over the middle of a patch.
struct PatchView {
  std::string name;
  double height_m = 0;   // above the terrain
  double pitch_deg = 0;  // < 0: down
};
inline const PatchView kNear{"from 500 m", 500, -10};
inline const PatchView kFarView{"from 20 km", 20000, -60};
core::View view_of(const PatchView& patch_view, std::shared_ptr<const paging::PlanetFile> planet,
                   const PatchSpec& spec, Size size);

}  // namespace vpe::app
