#include "objects/draw/composer.h"

#include <algorithm>
#include <memory>

#include "objects/draw/square_painter.h"

namespace objects {

LevelRule level_rule(const vpe::core::DrawRequest& request, bool exact) {
  LevelRule rule;
  rule.camera_m = request.view.camera.position_m;
  rule.focal_px = vpe::core::focal_px(request.view);
  rule.stretch = vpe::core::corner_stretch(request.view);
  const vpe::core::SettingsValues& settings = request.settings;
  // A disc in place of the shape is off by half of its size.
  const bool is_smooth = settings.smooth_edges || settings.samples > 1;
  rule.least_ray_px =
      std::min(is_smooth ? kSmoothRayDiameter_px : kHardRayDiameter_px, 2 * settings.lod_tolerance_px);
  if (!exact) rule.tolerance_px = request.settings.lod_tolerance_px * request.coarsening;
  return rule;
}

ComposedObjects compose(const Scene& scene, const ImageLight& light, const LevelRule& rule,
                        vpe::base::ThreadPool& pool, vpe::core::Frame& frame,
                        std::span<const std::uint8_t> only, std::span<const PlacedPoster> posters) {
  ComposedObjects out;
  if ((scene.is_empty() && posters.empty()) || frame.width <= 0) return out;
  const SeenPosters seen_posters(posters, light.request.view, light.request.settings.gamma);
  out.clear_m = scene.clear_distance_m(rule.camera_m, rule.tolerance_px / (rule.focal_px * rule.stretch));
  out.clear_m = std::min(out.clear_m, seen_posters.clear_m());
  if (scene.is_empty() && seen_posters.is_empty()) return out;
  const ObjectRays rays(scene, rule);
  const SunGrid before_sun =
      is_lit(light.request.settings) && !frame.colour.empty() ? SunGrid(rays, light.request.sun) : SunGrid();
  const ViewRays view_rays(light.request.view);
  const bool shows_volumes = has_volumes(scene);
  const VolumeLights volume_lights =
      shows_volumes && !before_sun.is_empty()
          ? VolumeLights(rays, before_sun, light, cone_of_view(light.request.view, view_rays), pool)
          : VolumeLights();
  SquarePainter::Image image{rays, before_sun, view_rays, light, only, 1, 1 / rule.focal_px, nullptr, nullptr};
  if (!seen_posters.is_empty()) image.posters = &seen_posters;
  std::vector<DomePainter> domes;
  for (std::uint32_t n = 0; n < seen_posters.size() && !frame.colour.empty(); ++n) {
    if (DomePainter::knows(seen_posters, n))
      domes.emplace_back(seen_posters, n, light.request.view, view_rays, light.request.settings.gamma);
  }
  image.domes = domes;
  if (shows_volumes) image.volume_lights = &volume_lights;
  const vpe::core::SettingsValues& settings = light.request.settings;
  if (only.empty() && (settings.samples > 1 || settings.smooth_edges)) image.samples = 8;

  const int columns = (frame.width + kSquare_px - 1) / kSquare_px;
  const int rows = (frame.height + kSquare_px - 1) / kSquare_px;
  std::vector<std::unique_ptr<SquarePainter>> squares(static_cast<std::size_t>(columns) *
                                                      static_cast<std::size_t>(rows));
  pool.run(squares.size(), [&](std::size_t n) {
    const int x = static_cast<int>(n) % columns * kSquare_px;
    const int y = static_cast<int>(n) / columns * kSquare_px;
    const PixelSquare square{x, y, std::min(x + kSquare_px, frame.width),
                             std::min(y + kSquare_px, frame.height)};
    auto painter = std::make_unique<SquarePainter>(image, frame, square);
    if (!painter->may_show()) return;
    painter->see();
    squares[n] = std::move(painter);
  });
  const SquarePainter::Seen seen = [&](int x, int y) -> const SeenPixel* {
    if (x < 0 || y < 0 || x >= frame.width || y >= frame.height) return nullptr;
    const auto& square = squares[static_cast<std::size_t>(y / kSquare_px) * static_cast<std::size_t>(columns) +
                                 static_cast<std::size_t>(x / kSquare_px)];
    return square ? &square->at(x, y) : nullptr;
  };
  pool.run(squares.size(), [&](std::size_t n) {
    if (squares[n]) squares[n]->paint(seen, frame);
  });
  std::vector<std::uint32_t> instances;
  for (const auto& square : squares) {
    if (!square) continue;
    const SquarePainter::Drawn& drawn = square->drawn();
    instances.insert(instances.end(), drawn.instances.begin(), drawn.instances.end());
    out.pixels += drawn.counts.pixels;
    out.covered += drawn.counts.covered;
    out.shaded += drawn.counts.shaded;
    out.geometric_error_m = std::max(out.geometric_error_m, drawn.counts.geometric_error_m);
    out.screen_space_error_px = std::max(out.screen_space_error_px, drawn.counts.screen_space_error_px);
  }
  std::sort(instances.begin(), instances.end());
  instances.erase(std::unique(instances.begin(), instances.end()), instances.end());
  out.objects = static_cast<std::int64_t>(instances.size());
  out.is_see_through = seen_posters.is_see_through() || std::ranges::any_of(instances, [&](std::uint32_t n) {
                         return scene.models()[scene.instance(n).model]->is_see_through();
                       });
  return out;
}

}  // namespace objects
