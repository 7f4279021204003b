// Imagery by light=auto, from a labelled raster through the build to images of both backends.
#include <gtest/gtest.h>

#include "mars/sources/source.h"
#include "tests/gl/gl_fixture.h"
#include "tests/support/labelled_image.h"
#include "vpe/core/backend.h"
#include "vpe/voxel/ray_renderer.h"

namespace {

namespace core = vpe::core;
using core::Backend;
using core::Colour;
using core::Light;
using core::Mode;

class OwnLight : public test_support::GlTest, public ::testing::WithParamInterface<Backend> {
 protected:
  // Builds a planet with an image whose label has these keywords.
  std::shared_ptr<const paging::PlanetFile> build(const std::string& name, const std::string& keywords) {
    const auto image = mars::open_image(test_support::write_labelled_image(dir_.path(), name, keywords));
    paging::BuildOptions options;
    options.output = (dir_ / (name + ".vpe")).string();
    options.base_spacing_m = 100000;
    options.threads = 2;
    options.tile_k = 5;
    options.resampling_posts = 1000;
    paging::build_planet(options, test_support::FakeElevation(test_support::bumpy_height), image.get());
    return paging::PlanetFile::open(options.output);
  }

  std::unique_ptr<core::Renderer> make(std::shared_ptr<const paging::PlanetFile> planet) {
    if (GetParam() == Backend::kPolygon) return renderer(std::move(planet));
    return vpe::voxel::make_ray_renderer(std::move(planet), {std::size_t{256} << 20, 2});
  }

  static std::vector<vpe::base::Rgb> draw(core::Renderer& by, const paging::PlanetFile& planet, Mode mode,
                                          Colour colour, Light light) {
    core::DrawRequest request =
        test_support::request_for({5, 40, 400000, 30, -60, 0}, planet.radius_m(), 80, 60);
    request.settings.mode = mode;
    request.settings.colour = colour;
    request.settings.light = light;
    return by.draw(request).frame.colour;
  }
};

// Draws by automatic light, and checks that it is this light's image and not the other's.
#define EXPECT_AUTO_IS(light, by, planet, mode, colour)                                                     \
  do {                                                                                                      \
    const auto automatic = draw(by, planet, mode, colour, Light::kAuto);                                    \
    EXPECT_EQ(automatic, draw(by, planet, mode, colour, light));                                            \
    EXPECT_NE(automatic, draw(by, planet, mode, colour, (light) == Light::kOn ? Light::kOff : Light::kOn)); \
  } while (false)

TEST_P(OwnLight, PhotographsAreShownWithoutTheSun) {
  const auto planet = build("photo", test_support::kCameraKeywords);
  ASSERT_TRUE(planet->meta().image_sources.at(0).has_own_light);
  const auto by = make(planet);
  EXPECT_AUTO_IS(Light::kOff, *by, *planet, Mode::kTextured, Colour::kElevation);
  EXPECT_AUTO_IS(Light::kOff, *by, *planet, Mode::kColoured, Colour::kImage);
  // Other looks of the same planet are lit.
  EXPECT_AUTO_IS(Light::kOn, *by, *planet, Mode::kColoured, Colour::kElevation);
  EXPECT_AUTO_IS(Light::kOn, *by, *planet, Mode::kLit, Colour::kNone);
}

TEST_P(OwnLight, OtherImageryIsLit) {
  const auto planet = build("plain", "");
  ASSERT_FALSE(planet->meta().image_sources.at(0).has_own_light);
  const auto by = make(planet);
  EXPECT_AUTO_IS(Light::kOn, *by, *planet, Mode::kTextured, Colour::kElevation);
  EXPECT_AUTO_IS(Light::kOn, *by, *planet, Mode::kColoured, Colour::kImage);
}

// The label alone decides: the same pixels in another light are the same image.
TEST_P(OwnLight, TheLabelChangesNothingButTheChoice) {
  const auto photo = build("photo", test_support::kCameraKeywords);
  const auto plain = build("plain", "");
  EXPECT_EQ(photo->meta().identity, plain->meta().identity);
  const auto by_photo = make(photo);
  const auto by_plain = make(plain);
  for (const Light light : {Light::kOn, Light::kOff})
    EXPECT_EQ(draw(*by_photo, *photo, Mode::kTextured, Colour::kElevation, light),
              draw(*by_plain, *plain, Mode::kTextured, Colour::kElevation, light));
}

INSTANTIATE_TEST_SUITE_P(Backends, OwnLight, ::testing::Values(Backend::kPolygon, Backend::kRay),
                         [](const auto& of) { return of.param == Backend::kPolygon ? "Polygons" : "Rays"; });

}  // namespace
