// The explore window over a small planet, and hands on it.
#pragma once

#include <memory>

#include "tests/paging/planet_fixture.h"
#include "tests/window/window_fixture.h"
#include "vpe/app/picture/image_options.h"
#include "vpe/app/window_painter.h"
#include "vpe/window/explore_window.h"

namespace vpe::window {

// One planet for all tests, colours from its elevation.
inline std::shared_ptr<const paging::PlanetFile> planet() {
  static const test_support::TempDir folder;
  static const auto file = test_support::build_fake(
      folder / "p.vpe", test_support::FakeElevation(test_support::bumpy_height), 60'000);
  return file;
}

class ExploreWindowTest : public HandsTest<ExploreWindow> {
 protected:
  void open(int width = 960, int height = 540, Backend backend = Backend::kRays) {
    ExploreSetup setup = std::move(extra_);
    setup.folder = folder_.path();
    setup.bookmarks = folder_ / "bookmarks";
    setup.planet = planet_;
    setup.surface = std::make_shared<const paging::Surface>(planet_, std::size_t{32} << 20);
    setup.backend = backend;
    setup.display.width = width;
    setup.display.height = height;
    setup.display.scale = width > 2000 ? 2 : 1;
    setup.sun = app::sun_for;
    app::Common common;
    common.memory_mb = 256;
    setup.make_painter = [common, file = planet_] {
      return std::make_unique<app::WindowPainter>(file, common);
    };
    window_ = std::make_unique<ExploreWindow>(std::move(setup));
    take_hold();
  }

  ExploreSetup extra_;  // what a test wants besides
  std::shared_ptr<const paging::PlanetFile> planet_ = planet();
};

}  // namespace vpe::window
