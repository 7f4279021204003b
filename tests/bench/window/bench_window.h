// The window of `vpe explore` for benchmarks and pictures, on a virtual screen.
#pragma once

#include <memory>
#include <string>

#include "vpe/app/picture/backend_choice.h"
#include "vpe/app/window_painter.h"
#include "vpe/window/explore_window.h"

namespace vpe::bench {

inline window::ExploreSetup bench_setup(const std::string& planet_file, int width, int height,
                                        const app::Common& common = {}) {
  window::ExploreSetup setup;
  setup.planet = paging::PlanetFile::open(planet_file);
  setup.surface = std::make_shared<const paging::Surface>(setup.planet, std::size_t{128} << 20);
  setup.make_painter = [planet = setup.planet, common] {
    return std::make_unique<app::WindowPainter>(planet, common);
  };
  setup.display.width = width;
  setup.display.height = height;
  setup.display.scale = width > 2000 ? 2 : 1;
  setup.suits_rays = [](const core::DrawRequest& r) { return app::suits_rays(app::for_window_rays(r, true)); };
  setup.as_drawn = app::as_drawn;
  setup.sun = app::sun_for;
  return setup;
}

}  // namespace vpe::bench
