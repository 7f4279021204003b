#include "vpe/explore/measure/map_painter.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "mars/geodesy/sun.h"
#include "paging/planet/planet_look.h"
#include "vpe/core/appearance/palette.h"

namespace vpe::explore {

namespace {

constexpr base::Rgb kBeyondPole{40, 42, 46};
constexpr base::Rgb kNoData{0, 0, 0};

std::uint8_t byte(double value) {
  return static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0, 255.0)));
}

}  // namespace

MapPainter::MapPainter(std::shared_ptr<const paging::PlanetFile> planet, std::size_t budget_bytes)
    : planet_(std::move(planet)), shader_(planet_, budget_bytes) {}

core::RgbImage MapPainter::paint(const MapView& map, MapStyle style, base::ThreadPool& pool,
                                 std::span<const MapLayer> layers) {
  core::Appearance appearance;
  appearance.mode = style == MapStyle::kImagery ? core::Mode::kTextured : core::Mode::kColoured;
  appearance.colour = core::Colour::kElevation;
  paging::fit_to_planet(appearance, planet_->meta());
  const bool has_image = planet_->meta().finest_image_level >= 0;
  if (paging::needs_scale(appearance, has_image) && scale_ == nullptr)
    scale_ = std::make_shared<core::ColourScale>(appearance);
  const paging::ShadingParams base = paging::shading_params(appearance, {1, 0, 0}, has_image, scale_);
  const double footprint_m = map.degrees_per_px * mars::kRadiansPerDegree * planet_->radius_m();

  core::RgbImage image;
  image.width = map.width;
  image.height = map.height;
  const auto width = static_cast<std::size_t>(map.width);
  image.pixels.assign(width * static_cast<std::size_t>(map.height), kBeyondPole);
  pool.run(static_cast<std::size_t>(map.height), [&](std::size_t y) {
    paging::TerrainShader::Cursor cursor;
    paging::ShadingParams params = base;
    for (std::size_t x = 0; x < width; ++x) {
      const auto place = map.place({static_cast<double>(x) + 0.5, static_cast<double>(y) + 0.5});
      if (!place) continue;
      params.sun = mars::sun_direction(*place, 315, 45);
      const auto colour = shader_.colour_at(mars::direction(*place), footprint_m, params, cursor);
      image.pixels[y * width + x] =
          colour ? base::Rgb{byte(colour->x), byte(colour->y), byte(colour->z)} : kNoData;
    }
  });
  if (!layers.empty()) paint_map_layers(map, layers, planet_->radius_m(), image);
  return image;
}

}  // namespace vpe::explore
