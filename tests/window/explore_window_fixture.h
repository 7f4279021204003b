// Fixture for tests of the explore window with a small planet.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include "tests/paging/planet_fixture.h"
#include "tests/window/window_fixture.h"
#include "vpe/app/picture/image_options.h"
#include "vpe/app/scene/scene_sight.h"
#include "vpe/app/window_painter.h"
#include "vpe/window/explore_window.h"

namespace vpe::window {

// Returns the planet of all tests; its colours come from elevation.
inline std::shared_ptr<const paging::PlanetFile> planet() {
  static const test_support::TempDir folder;
  static const auto file = test_support::build_fake(
      folder / "p.vpe", test_support::FakeElevation(test_support::bumpy_height), 60'000);
  return file;
}

class ExploreWindowTest : public WindowTest<ExploreWindow> {
 protected:
  void open(int width = 960, int height = 540, std::optional<core::Backend> backend = core::Backend::kRay) {
    ExploreSetup setup = std::exchange(extra_, {});
    setup.folder = folder_.path();
    setup.bookmarks = folder_ / "bookmarks";
    setup.state = folder_ / "state";
    setup.planet = planet_;
    setup.surface = std::make_shared<const paging::Surface>(planet_, std::size_t{32} << 20);
    setup.open_scene = app::scene_sight(setup.surface);
    setup.drawn_by = core::drawn_by(backend);
    setup.display.width = width;
    setup.display.height = height;
    setup.display.scale = width > 2000 ? 2 : 1;
    setup.sun = app::sun_for;
    setup.as_drawn = app::as_drawn;
    app::Common common;
    common.memory_mb = 256;
    setup.make_painter = [common, file = painted_ ? painted_ : planet_, wrap = wrap_painter_,
                          change_s = change_s_] {
      std::unique_ptr<Painter> painter =
          std::make_unique<app::WindowPainter>(file, common, app::StereoMethod{}, change_s);
      return wrap ? wrap(std::move(painter)) : std::move(painter);
    };
    window_ = std::make_unique<ExploreWindow>(std::move(setup));
    opening_message_ = window_->state().message;
    focus();
  }

  // Returns how far right the view begins.
  double left() { return window_->display().size().first - window_->session().view().width; }
  mars::LonLat under(double x, double y) {
    const auto place = window_->session().place_at({x - left(), y});
    if (!place) throw std::runtime_error("there is no ground");
    return *place;
  }
  // Returns where a place is in the window.
  glm::dvec2 seen(mars::LonLat place) {
    const glm::dvec3 up = mars::direction(place);
    const explore::TerrainQuery& ground = window_->session().ground();
    return core::project(window_->session().view(), up * (ground.radius_m + ground.height_m(up))).xy +
           glm::dvec2(left(), 0);
  }

  // Enters a text in a field; beside it are buttons and the label.
  void enter(const std::string& label, const std::string& text) {
    ASSERT_TRUE(waits_for(label)) << label;
    const WidgetPlace field = place_of(label);
    click(field.x0 + 15, (field.y0 + field.y1) / 2);
    with_control("a");
    glfwSetClipboardString(window_->display().handle(), text.c_str());
    with_control("v");
    key("Return");
    settle();
  }
  void drag(glm::dvec2 from, glm::dvec2 by, int button = 1) {
    move(from.x, from.y);
    robot_->press(button);
    iterate(2);
    for (int n = 1; n <= 5; ++n) move(from.x + by.x * n / 5, from.y + by.y * n / 5);
    robot_->release(button);
    iterate(3);
  }

  // Returns the colour of the image at a place of the window.
  glm::dvec3 colour_at(glm::dvec2 xy) {
    const core::RgbImage& image = window_->image();
    const double scale = static_cast<double>(image.width) / window_->session().view().width;
    const auto x = static_cast<int>((xy.x - left()) * scale);
    const auto y = static_cast<int>(xy.y * scale);
    const base::Rgb colour = image.pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                                          static_cast<std::size_t>(x)];
    return {colour.r, colour.g, colour.b};
  }

  ExploreSetup extra_;                                                              // options of a test
  std::function<std::unique_ptr<Painter>(std::unique_ptr<Painter>)> wrap_painter_;  // may be empty
  double change_s_ = app::WindowPainter::kChange_s;  // how long images wait for tiles of another appearance
  std::string opening_message_;  // of the window that was opened last; messages go away after a while
  std::shared_ptr<const paging::PlanetFile> planet_ = planet();
  std::shared_ptr<const paging::PlanetFile> painted_;  // the same planet with other storage, or null
};

}  // namespace vpe::window
