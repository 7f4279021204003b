#include "vpe/app/planet/info/relief_map.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "mars/geodesy/sun.h"
#include "paging/planet/planet_look.h"
#include "paging/shading/terrain_shader.h"
#include "vpe/app/planet/info/polar_map.h"
#include "vpe/core/appearance/nodata_pattern.h"
#include "vpe/core/image/image.h"

namespace vpe::app {

namespace {

constexpr int kWidest_px = 1440;
constexpr int kWidestInset_px = 440;
constexpr int kPngCompression = 9;
constexpr double kSlack = 0.97;  // of sides that are foretold to fit

// Says how a map is laid out.
struct ReliefLayout {
  int height_per_width_percent = 50;
  double footprint_share = 0;  // width of a pixel's ground times columns, in radii of the planet
  // Returns the place of (x, y), each 0 to 1 from the upper left corner, and the azimuth at it that points to the left edge's
  // upper end; nullopt outside of the map.
  std::optional<LitPlace> (*place)(double x, double y) = nullptr;
};

std::optional<LitPlace> plain_place(double x, double y) { return LitPlace{{360 * x - 180, 90 - 180 * y}, 315}; }
std::optional<LitPlace> north_place(double x, double y) {
  return polar_place(Pole::kNorth, 2 * x - 1, 2 * y - 1);
}
std::optional<LitPlace> south_place(double x, double y) {
  return polar_place(Pole::kSouth, 2 * x - 1, 2 * y - 1);
}

core::RgbImage paint_relief(const paging::TerrainShader& shader, const paging::PlanetFile& planet,
                            const paging::ShadingParams& base, const ReliefLayout& layout, int width,
                            base::ThreadPool& pool) {
  core::RgbImage image{width, width * layout.height_per_width_percent / 100, {}};
  const auto columns = static_cast<std::size_t>(width);
  image.pixels.resize(columns * static_cast<std::size_t>(image.height), {255, 255, 255});
  const double footprint_m = layout.footprint_share / width * planet.radius_m();
  const auto byte = [](double value) {
    return static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0, 255.0)));
  };
  pool.run(static_cast<std::size_t>(image.height), [&](std::size_t y) {
    paging::TerrainShader::Cursor cursor;
    paging::ShadingParams params = base;
    for (std::size_t x = 0; x < columns; ++x) {
      const auto at =
          layout.place((static_cast<double>(x) + 0.5) / width, (static_cast<double>(y) + 0.5) / image.height);
      if (!at) continue;
      params.sun = mars::sun_direction(at->place, at->light_azimuth_deg, 45);
      const auto colour = shader.colour_at(mars::direction(at->place), footprint_m, params, cursor);
      const std::uint8_t grey = byte(core::nodata_grey(static_cast<double>(x + y) / width, 1.0 / width));
      image.pixels[y * columns + x] =
          colour ? base::Rgb{byte(colour->x), byte(colour->y), byte(colour->z)} : base::Rgb{grey, grey, grey};
    }
  });
  return image;
}

std::vector<std::uint8_t> fitting_png(const paging::TerrainShader& shader, const paging::PlanetFile& planet,
                                      const paging::ShadingParams& params, const ReliefLayout& layout,
                                      int width, std::size_t most_bytes, base::ThreadPool& pool) {
  for (;;) {
    const core::RgbImage image = paint_relief(shader, planet, params, layout, width, pool);
    std::vector<std::uint8_t> png = core::encode_png(image.pixels, image.width, image.height, kPngCompression);
    if (png.size() <= most_bytes || width <= 16) return png;
    const double factor = std::sqrt(static_cast<double>(most_bytes) / static_cast<double>(png.size()));
    width = std::max(16, static_cast<int>(kSlack * factor * width) / 2 * 2);
  }
}

}  // namespace

ReliefImages relief_images(const std::shared_ptr<const paging::PlanetFile>& planet, const ReliefLook& look,
                           const ReliefLimits& limits, std::size_t budget_bytes, base::ThreadPool& pool) {
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
  const auto png = [&](const ReliefLayout& layout, int width, std::size_t most_bytes) {
    return fitting_png(shader, *planet, params, layout, width, most_bytes, pool);
  };
  const double across = 4 * std::tan(0.5 * (90 - kPolarLat_deg) * mars::kRadiansPerDegree);
  ReliefImages images;
  images.whole = png({50, 2 * mars::kPi, plain_place}, kWidest_px, limits.whole_bytes);
  images.north = png({100, across, north_place}, kWidestInset_px, limits.inset_bytes);
  images.south = png({100, across, south_place}, kWidestInset_px, limits.inset_bytes);
  return images;
}

}  // namespace vpe::app
