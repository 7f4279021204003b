#include "vpe/app/surface/surface_image.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <optional>
#include <stdexcept>

#include "relief/cast/ray_caster.h"
#include "vpe/core/appearance/palette.h"

namespace vpe::app {

namespace {

constexpr double kAmbient = 0.02;
constexpr glm::dvec3 kGround{0.62, 0.60, 0.57};  // linear reflectance without a palette
// Of the range and the distance from the base's centre: shadow rays begin this far above the ground.
constexpr double kShadowLift = 1e-7;

double linear_of(double srgb) { return srgb <= 0.04045 ? srgb / 12.92 : std::pow((srgb + 0.055) / 1.055, 2.4); }

std::uint8_t srgb_byte(double linear) {
  const double c = std::clamp(linear, 0.0, 1.0);
  const double srgb = c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1 / 2.4) - 0.055;
  return static_cast<std::uint8_t>(std::lround(255 * srgb));
}

// Returns the reflectance of ground by its height.
class GroundColour {
 public:
  GroundColour(const std::string& palette, double low_m, double high_m) {
    if (palette.empty()) return;
    if (const std::string problem = core::palette_problem(palette); !problem.empty())
      throw std::runtime_error("--palette: " + problem);
    core::Appearance appearance;
    appearance.palette = palette;
    appearance.palette_low = low_m;
    appearance.palette_high = high_m;
    scale_.emplace(appearance);
  }

  glm::dvec3 operator()(double height_m) const {
    if (!scale_) return kGround;
    const glm::dvec3 srgb = (*scale_)(height_m) / 255.0;
    return {linear_of(srgb.r), linear_of(srgb.g), linear_of(srgb.b)};
  }

 private:
  std::optional<core::ColourScale> scale_;
};

core::View with_samples(core::View view, int samples) {
  view.width *= samples;
  view.height *= samples;
  view.principal_offset_px *= static_cast<double>(samples);
  return view;
}

// Casts rays towards the sun.
class Sunlight {
 public:
  Sunlight(const relief::Surface& surface, const SurfaceImageOptions& options)
      : surface_(surface),
        caster_(surface),
        towards_sun_(options.towards_sun),
        has_shadows_(options.has_shadows),
        all_((1U << surface.pieces().size()) - 1U) {}

  double on(const glm::dvec3& point_m, const glm::dvec3& normal, double range_m) const {
    const double slope = glm::dot(normal, towards_sun_);
    if (slope <= 0) return kAmbient;
    if (has_shadows_) {
      const double lift_m = kShadowLift * (range_m + glm::length(point_m - surface_.base().centre_m()));
      relief::CastCounts counts;
      const double hit = caster_.first_hit({point_m + lift_m * normal, towards_sun_},
                                           {0, relief::kFarthest_m, 0}, all_, counts);
      if (hit < relief::kNoHit) return kAmbient;
    }
    return kAmbient + (1 - kAmbient) * slope;
  }

 private:
  const relief::Surface& surface_;
  relief::RayCaster caster_;
  glm::dvec3 towards_sun_;
  bool has_shadows_;
  unsigned all_;
};

glm::dvec3 point_of(const core::View& view, int x, int y, double range_m) {
  return view.camera.position_m + range_m * core::pixel_ray(view, x + 0.5, y + 0.5);
}

}  // namespace

SurfaceImage draw_surface(const relief::Surface& surface, const core::View& view,
                          const SurfaceImageOptions& options, base::ThreadPool& pool) {
  if (options.samples < 1 || options.samples > kMostSamples)
    throw std::invalid_argument("samples of an image: expected 1 to " + std::to_string(kMostSamples));
  const core::View fine = with_samples(view, options.samples);
  const relief::CastResult found =
      relief::cast(surface, fine, {.tolerance_px = options.tolerance_px * options.samples}, pool);

  SurfaceImage image;
  image.counts = found.counts;
  image.rays = found.range_m.size();
  std::vector<double> height_m(found.range_m.size());
  pool.run(static_cast<std::size_t>(found.height), [&](std::size_t row) {
    for (int x = 0; x < found.width; ++x) {
      const std::size_t at = row * static_cast<std::size_t>(found.width) + static_cast<std::size_t>(x);
      if (found.range_m[at] < relief::kNoHit)
        height_m[at] = surface.base().height_m(point_of(fine, x, static_cast<int>(row), found.range_m[at]));
    }
  });
  for (std::size_t n = 0; n < height_m.size(); ++n) {
    const double range_m = found.range_m[n];
    if (!(range_m < relief::kNoHit)) continue;
    const bool is_first = image.hits++ == 0;
    image.least_range_m = is_first ? range_m : std::min(image.least_range_m, range_m);
    image.most_range_m = std::max(image.most_range_m, range_m);
    image.least_height_m = is_first ? height_m[n] : std::min(image.least_height_m, height_m[n]);
    image.most_height_m = is_first ? height_m[n] : std::max(image.most_height_m, height_m[n]);
  }

  const GroundColour colour(options.palette, image.least_height_m,
                            std::max(image.most_height_m, image.least_height_m + 1e-3));
  const Sunlight sun(surface, options);
  image.colours = {view.width, view.height, {}};
  image.colours.pixels.resize(static_cast<std::size_t>(view.width) * static_cast<std::size_t>(view.height));
  pool.run(static_cast<std::size_t>(view.height), [&](std::size_t row) {
    for (int x = 0; x < view.width; ++x) {
      glm::dvec3 sum{0, 0, 0};  // space is black
      for (int k = 0; k < options.samples * options.samples; ++k) {
        const int fine_x = x * options.samples + k % options.samples;
        const int fine_y = static_cast<int>(row) * options.samples + k / options.samples;
        const std::size_t at = static_cast<std::size_t>(fine_y) * static_cast<std::size_t>(found.width) +
                               static_cast<std::size_t>(fine_x);
        if (!(found.range_m[at] < relief::kNoHit)) continue;
        const glm::dvec3 point_m = point_of(fine, fine_x, fine_y, found.range_m[at]);
        sum += sun.on(point_m, surface.normal(point_m), found.range_m[at]) * colour(height_m[at]);
      }
      sum /= static_cast<double>(options.samples) * options.samples;
      image.colours.pixels[row * static_cast<std::size_t>(view.width) + static_cast<std::size_t>(x)] = {
          srgb_byte(sum.r), srgb_byte(sum.g), srgb_byte(sum.b)};
    }
  });
  return image;
}

std::vector<float> surface_ranges(const relief::Surface& surface, const core::View& view, double tolerance_px,
                                  base::ThreadPool& pool) {
  const relief::CastResult found = relief::cast(surface, view, {.tolerance_px = tolerance_px}, pool);
  std::vector<float> ranges_m;
  ranges_m.reserve(found.range_m.size());
  for (const double range_m : found.range_m) ranges_m.push_back(static_cast<float>(range_m));
  return ranges_m;
}

}  // namespace vpe::app
