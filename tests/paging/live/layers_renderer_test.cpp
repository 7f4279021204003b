// Renderers that go over from one choice of image layers and one ground to another draw what new ones draw.
#include <gtest/gtest.h>

#include "mars/sources/layered_image.h"
#include "paging/planet/planet_look.h"
#include "paging/planet/planet_user.h"
#include "tests/gl/gl_fixture.h"
#include "tests/paging/live/live_fixture.h"
#include "vpe/core/backend.h"
#include "vpe/voxel/ray_renderer.h"

namespace {

namespace core = vpe::core;
using core::Backend;
using test_support::Planet;
using test_support::Random;

// Gives colours of the whole planet that are a function of the place.
class TintedImage : public mars::ImageSource {
 public:
  TintedImage(std::string name, double resolution_m, glm::dvec3 tint)
      : name_(std::move(name)), resolution_m_(resolution_m), tint_(tint) {}
  std::vector<mars::SourceInfo> infos() const override {
    mars::SourceInfo info;
    info.name = name_;
    info.resolution_m = resolution_m_;
    return {info};
  }
  void sample(std::span<const glm::dvec3> directions, double, std::span<vpe::base::Rgb> colours,
              std::span<std::uint8_t> alpha) const override {
    for (std::size_t n = 0; n < directions.size(); ++n) {
      const double wave = 0.6 + 0.3 * std::sin(40 * directions[n].x) * std::cos(50 * directions[n].z);
      const auto byte = [&](double tint) { return static_cast<std::uint8_t>(255 * tint * wave); };
      colours[n] = {byte(tint_.x), byte(tint_.y), byte(tint_.z)};
      alpha[n] = 255;
    }
  }
  double spacing_in(const mars::Cap&) const override { return resolution_m_; }

 private:
  std::string name_;
  double resolution_m_;
  glm::dvec3 tint_;
};

class LayersRenderer : public test_support::GlTest, public ::testing::WithParamInterface<Backend> {
 protected:
  void SetUp() override {
    const auto image = mars::stack_images_apart(
        {{"fine", std::make_shared<TintedImage>("fine.tif", 8000, glm::dvec3(1, 0.5, 0.4))},
         {"wide", std::make_shared<TintedImage>("wide.tif", 30000, glm::dvec3(0.4, 0.7, 1))}});
    const paging::BuildOptions options = test_support::live_options(dir_ / "planet.vpe");
    paging::build_planet(
        options, test_support::FakeElevation(test_support::whole_quanta, test_support::fine_at_places(20000)),
        image.get());
    planet_ = paging::PlanetFile::open(options.output);
  }

  std::unique_ptr<core::Renderer> make(const Planet& planet) {
    constexpr std::size_t kMemory = std::size_t{256} << 20;
    if (GetParam() == Backend::kPolygon) return renderer(planet, kMemory);
    return vpe::voxel::make_ray_renderer(planet, {kMemory, 2});
  }

  Planet planet_;
};

TEST_P(LayersRenderer, AnyWayThroughGroundsAndLayersEndsAlike) {
  Random random(90210);
  const mars::LonLat place = test_support::live_places()[1];
  const paging::ReliefPatcher patcher(planet_);
  core::DrawRequest request = test_support::request_for({place.lon_deg - 1, place.lat_deg, 60000, 90, -25, 0},
                                                        planet_->radius_m(), 96, 72);
  request.settings.mode = core::Mode::kTextured;
  const std::vector<std::string> layers{"", "wide", "wide;fine@0.5", "fine;wide@0.3 gamma=2", "wide;fine@0"};
  const auto ground = [&](int n) -> Planet {
    if (n == 0) return planet_;
    return patcher.with(std::vector<relief::ReliefSpec>{test_support::crater_at(place, 25000, 4000, 600.0 * n)},
                        {.full_grids = true, .threads = 2});
  };
  const auto walked = make(planet_);
  Planet shown = planet_;
  core::DrawResult before;
  int changes = 0;
  // Layers that are chosen after a patch and stay when it is gone, then anything.
  struct Step {
    int ground = 0;
    int layers = 0;
  };
  std::vector<Step> steps{{1, 2}, {0, 2}, {2, 2}, {0, 2}, {0, 0}};
  while (steps.size() < 14) {
    const int at = random.integer(0, 1) == 0 ? random.integer(0, 2) : steps.back().ground;
    steps.push_back({at, random.integer(0, 4)});
  }
  int at = 0;
  for (const Step& step : steps) {
    if (step.ground != at) {
      shown = ground(step.ground);
      paging::change_planet(*walked, shown);
      at = step.ground;
    }
    request.settings.image_layers = layers[static_cast<std::size_t>(step.layers)];
    SCOPED_TRACE(testing::Message() << step.ground << " '" << request.settings.image_layers << "'");
    core::DrawResult result = walked->draw(request);
    const core::DrawResult fresh = make(shown)->draw(request);
    EXPECT_TRUE(result.frame.colour == fresh.frame.colour);
    EXPECT_TRUE(result.frame.range_m == fresh.frame.range_m);
    changes += result.frame.colour == before.frame.colour ? 0 : 1;
    before = std::move(result);
  }
  EXPECT_GT(changes, 8);
}

TEST_P(LayersRenderer, LayersThatAreNotThereEndAnImageAlone) {
  core::DrawRequest request =
      test_support::request_for({20, 0, 600000, 90, -40, 0}, planet_->radius_m(), 48, 36);
  request.settings.mode = core::Mode::kTextured;
  const auto draw = make(planet_);
  const core::DrawResult first = draw->draw(request);
  request.settings.image_layers = "viking";
  EXPECT_THROW(draw->draw(request), paging::PlanetError);
  request.settings.image_layers = "";
  EXPECT_TRUE(draw->draw(request).frame.colour == first.frame.colour);
}

INSTANTIATE_TEST_SUITE_P(Backends, LayersRenderer, ::testing::Values(Backend::kPolygon, Backend::kRay),
                         [](const auto& of) { return std::string(core::to_string(of.param)); });

}  // namespace
