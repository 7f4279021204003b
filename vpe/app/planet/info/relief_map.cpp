#include "vpe/app/planet/info/relief_map.h"

#include <algorithm>
#include <cmath>

#include "mars/geodesy/sun.h"
#include "paging/planet/planet_look.h"
#include "paging/shading/terrain_shader.h"
#include "vpe/core/appearance/nodata_pattern.h"
#include "vpe/core/image/image.h"

namespace vpe::app {

namespace {

constexpr int kWidest_px = 1440;
constexpr int kPngCompression = 9;
constexpr double kSlack = 0.97;  // of sides that are foretold to fit

core::RgbImage paint_relief(const paging::TerrainShader& shader, const paging::PlanetFile& planet,
                            const paging::ShadingParams& base, int width, base::ThreadPool& pool) {
  core::RgbImage image{width, width / 2, {}};
  const auto columns = static_cast<std::size_t>(width);
  image.pixels.resize(columns * static_cast<std::size_t>(image.height));
  const double step_deg = 360.0 / width;
  const double footprint_m = step_deg * mars::kRadiansPerDegree * planet.radius_m();
  const auto byte = [](double value) {
    return static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0, 255.0)));
  };
  pool.run(static_cast<std::size_t>(image.height), [&](std::size_t y) {
    paging::TerrainShader::Cursor cursor;
    paging::ShadingParams params = base;
    for (std::size_t x = 0; x < columns; ++x) {
      const mars::LonLat place{(static_cast<double>(x) + 0.5) * step_deg - 180,
                               90 - (static_cast<double>(y) + 0.5) * step_deg};
      params.sun = mars::sun_direction(place, 315, 45);
      const auto colour = shader.colour_at(mars::direction(place), footprint_m, params, cursor);
      const std::uint8_t grey = byte(core::nodata_grey(static_cast<double>(x + y) / width, 1.0 / width));
      image.pixels[y * columns + x] =
          colour ? base::Rgb{byte(colour->x), byte(colour->y), byte(colour->z)} : base::Rgb{grey, grey, grey};
    }
  });
  return image;
}

}  // namespace

std::vector<std::uint8_t> relief_png(const std::shared_ptr<const paging::PlanetFile>& planet,
                                     const ReliefLook& look, std::size_t most_bytes, std::size_t budget_bytes,
                                     base::ThreadPool& pool) {
  core::Appearance appearance;
  appearance.mode = core::Mode::kColoured;
  appearance.colour = core::Colour::kElevation;
  appearance.palette_low = look.low_m;
  appearance.palette_high = look.high_m;
  appearance.exaggeration = look.exaggeration;
  paging::fit_to_planet(appearance, planet->meta());
  const paging::TerrainShader shader(planet, budget_bytes);
  const paging::ShadingParams params = paging::shading_params(
      appearance, {1, 0, 0}, false, std::make_shared<const core::ColourScale>(appearance));
  int width = kWidest_px;
  for (;;) {
    const core::RgbImage image = paint_relief(shader, *planet, params, width, pool);
    std::vector<std::uint8_t> png = core::encode_png(image.pixels, image.width, image.height, kPngCompression);
    if (png.size() <= most_bytes || width <= 16) return png;
    const double factor = std::sqrt(static_cast<double>(most_bytes) / static_cast<double>(png.size()));
    width = std::max(16, static_cast<int>(kSlack * factor * width) / 2 * 2);
  }
}

}  // namespace vpe::app
