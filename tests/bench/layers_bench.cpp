// Compares frames with 10^5 vertices of draped lines (overlay.layers) with bare frames, in alternating rounds, by both backends.
// docs/measurements/rendering.md has the figures.
//
//   layers_bench PLANET LON,LAT [ROUNDS [VERTICES [BACKEND [VIEW]]]]
//
// BACKEND and VIEW select rows by a part of their name.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "mars/geodesy/pose.h"
#include "mars/geodesy/sphere.h"
#include "mars/geodesy/sun.h"
#include "paging/planet/planet_file.h"
#include "paging/surface/surface.h"
#include "tests/bench/compare_rounds.h"
#include "vpe/app/cli/parsing.h"
#include "vpe/app/cli/program.h"
#include "vpe/app/picture/frame_overlays.h"
#include "vpe/app/picture/image_options.h"
#include "vpe/overlay/overlay.h"

namespace {

namespace core = vpe::core;

struct LayerCase {
  const char* what;
  double height_m;  // of the camera above the ground
  double pitch_deg;
  double reach_deg;  // of the lines about the place
};

// Seconds that the clock on the wall and all processors have counted.
struct Spent {
  double wall_ms = 0;
  double processor_ms = 0;
};

Spent spent_by(const std::function<void()>& work) {
  const auto start = std::chrono::steady_clock::now();
  const std::clock_t begun = std::clock();
  work();
  return {std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count(),
          1e3 * static_cast<double>(std::clock() - begun) / CLOCKS_PER_SEC};
}

// Lines of 100 vertices that wind about a place.
mars::FeatureLayer winding_lines(mars::LonLat about, double reach_deg, int vertices) {
  mars::FeatureLayer layer;
  layer.name = "winding";
  for (int line = 0; 100 * line < vertices; ++line) {
    mars::Feature feature;
    feature.number = line;
    mars::Shape shape{mars::ShapeKind::line, {{}}};
    const double turn = 2.399963 * line;
    const double away_deg = reach_deg * std::sqrt((line + 0.5) * 100 / vertices);
    const glm::dvec2 middle(about.lon_deg + away_deg * std::cos(turn),
                            about.lat_deg + away_deg * std::sin(turn));
    for (int n = 0; n < 100; ++n) {
      const double a = 0.06 * n;
      shape.rings[0].push_back(
          middle + 0.03 * reach_deg *
                       glm::dvec2(std::cos(a) + 0.3 * std::sin(5 * a), std::sin(a) + 0.3 * std::cos(7 * a)));
    }
    feature.shapes = {shape};
    layer.features.push_back(feature);
  }
  return layer;
}

}  // namespace

int main(int argc, char** argv) {
  const auto place = argc > 2 ? vpe::app::parse_numbers(argv[2]) : std::nullopt;
  if (!place || place->size() != 2 || argc > 7) {
    std::fprintf(stderr, "usage: layers_bench PLANET LON,LAT [ROUNDS [VERTICES [BACKEND [VIEW]]]]\n");
    return 2;
  }
  const int rounds = argc > 3 ? std::atoi(argv[3]) : 7;
  const int vertices = argc > 4 ? std::atoi(argv[4]) : 100'000;
  const auto planet = paging::PlanetFile::open(argv[1]);
  const mars::LonLat about{(*place)[0], (*place)[1]};
  const double ground_m = paging::Surface(planet, std::size_t{16} << 20).at(mars::direction(about)).height_m;
  std::printf("%d vertices, 1280x720, medians of %d rounds in turns\n\n", vertices, rounds);
  std::printf(
      "| view | bare frame, ms | with lines / bare | processors, ms | with lines / bare | of it draping and drawing, ms |\n"
      "|---|---|---|---|---|---|\n");
  const auto wanted = [&](const char* name, int argument) {
    return argc <= argument || std::strstr(name, argv[argument]) != nullptr;
  };
  for (const core::Backend backend : {core::Backend::kPolygon, core::Backend::kRay}) {
    const char* const name = backend == core::Backend::kRay ? "ray" : "polygon";
    if (!wanted(name, 5)) continue;
    vpe::app::RenderOptions options;
    options.backend = backend;
    const vpe::app::Common common;
    const auto renderer = vpe::app::make_renderer(options, common, planet);
    for (const LayerCase& one :
         {LayerCase{"near, oblique", 2000, -15, 0.08}, LayerCase{"down from 60 km", 60e3, -90, 0.5},
          LayerCase{"globe", 6e6, -90, 40}}) {
      if (!wanted(one.what, 6)) continue;
      core::DrawRequest request;
      request.view.camera = mars::to_camera({about.lon_deg, about.lat_deg - (one.pitch_deg > -60 ? 0.12 : 0.0),
                                             ground_m + one.height_m, 0, one.pitch_deg, 0},
                                            planet->radius_m());
      request.settings.mode = core::Mode::kColoured;
      request.sun = mars::sun_direction(about, 315, 35);
      core::DrawRequest lined = request;
      lined.settings.layers = "lines";
      lined.want_range = true;
      vpe::app::FrameOverlays overlays(planet);
      overlays.use_layers({{"lines",
                            {std::make_shared<const vpe::overlay::GroundFeatures>(
                                winding_lines(about, one.reach_deg, vertices), mars::FeatureStyle{})}}});
      std::vector<double> wall_ms, wall_ratio, processor_ms, processor_ratio, overlay_ms;
      // The first round loads and does not count.
      for (int round = 0; round <= rounds; ++round) {
        const Spent bare = spent_by([&] { (void)renderer->draw(request); });
        core::DrawResult result;
        const Spent frame = spent_by([&] { result = renderer->draw(lined); });
        const Spent overlay = spent_by([&] {
          vpe::overlay::composite(overlays.layer(lined, {result.frame.range_m, result.certificate, {}}, 0),
                                  result.frame.colour);
        });
        if (round == 0) continue;
        wall_ms.push_back(bare.wall_ms);
        wall_ratio.push_back((frame.wall_ms + overlay.wall_ms) / bare.wall_ms);
        processor_ms.push_back(bare.processor_ms);
        processor_ratio.push_back((frame.processor_ms + overlay.processor_ms) / bare.processor_ms);
        overlay_ms.push_back(overlay.processor_ms);
      }
      std::printf("| %s, %s | %.0f | %.2f | %.0f | %.2f | %.0f |\n", name, one.what, bench::median_of(wall_ms),
                  bench::median_of(wall_ratio), bench::median_of(processor_ms),
                  bench::median_of(processor_ratio), bench::median_of(overlay_ms));
      std::fflush(stdout);
    }
  }
  return 0;
}
