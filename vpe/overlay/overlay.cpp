#include "vpe/overlay/overlay.h"

#include <algorithm>
#include <stdexcept>

#include "vpe/overlay/layer_functions.h"

namespace vpe::overlay {

namespace {

// Puts the tint below what is drawn already.
void tint_synthetic(const VisibleTerrain& terrain, Layer& layer) {
  for (int y = 0; y < terrain.height(); ++y) {
    for (int x = 0; x < terrain.width(); ++x) {
      const std::size_t pixel = terrain.index(x, y);
      core::Rgba& own = layer.pixels[pixel];
      if (own.a == 255 || !terrain.is_ground(pixel)) continue;
      if (!terrain.scene().is_synthetic(terrain.point(x, y)).value_or(false)) continue;
      const unsigned below = kSyntheticTint.a * (255U - own.a) / 255U;
      const unsigned sum = own.a + below;
      const auto mix = [&](std::uint8_t top, std::uint8_t under) {
        return static_cast<std::uint8_t>((top * unsigned{own.a} + under * below) / sum);
      };
      own = {mix(own.r, kSyntheticTint.r), mix(own.g, kSyntheticTint.g), mix(own.b, kSyntheticTint.b),
             static_cast<std::uint8_t>(sum)};
    }
  }
}

}  // namespace

bool needs_range(const core::Overlays& overlays) {
  return overlays.graticule || overlays.contours || overlays.scale_bar || overlays.north_arrow ||
         !overlays.names.empty() || !overlays.layers.empty() || overlays.inspect == core::Inspect::kSynthetic;
}

bool any(const core::Overlays& overlays) {
  return needs_range(overlays) || overlays.legend || overlays.time_code != core::TimeCode::kOff ||
         !overlays.title.empty() || overlays.compass != core::CompassStrip::kOff;
}

Layer draw(const core::Overlays& overlays, const Scene& scene) {
  if (!any(overlays)) return {};
  const glm::ivec2 size = core::drawn_size(scene.view);
  std::optional<VisibleTerrain> terrain;
  if (needs_range(overlays)) terrain.emplace(scene);
  Canvas canvas(size.x, size.y);
  LabelLayout layout(canvas);
  std::vector<LineLabel> labels;
  std::optional<LayersDrawing> layers;
  if (!scene.layers.empty()) layers.emplace(layout, *terrain, overlays.hidden_lines);
  if (overlays.contours && scene.contours) {
    const std::vector<float> range_m = ranges_of_same_ground(*terrain, *scene.contours);
    Scene finer = scene;
    finer.range_m = range_m;
    finer.shift_px = scene.contours->shift_px;
    labels = draw_contours(layout, VisibleTerrain(finer), overlays.contour_m);
  } else if (overlays.contours) {
    labels = draw_contours(layout, *terrain, overlays.contour_m);
  }
  if (overlays.graticule) {
    const std::vector<LineLabel> more = draw_graticule(layout, *terrain, overlays.graticule_deg);
    labels.insert(labels.begin(), more.begin(), more.end());
  }
  if (overlays.compass != core::CompassStrip::kOff) draw_compass(layout, scene, overlays.compass);
  if (!overlays.title.empty()) draw_title(layout, overlays.title);
  if (overlays.legend) draw_legend(layout, scene);
  if (overlays.scale_bar) draw_scale_bar(layout, *terrain);
  if (overlays.north_arrow) draw_north_arrow(layout, *terrain);
  if (overlays.time_code == core::TimeCode::kFlight) draw_time(layout, scene.time_s);
  if (overlays.time_code == core::TimeCode::kSolar && scene.solar) draw_solar_time(layout, *scene.solar);
  if (layers && overlays.layers_legend) layers->draw_legend();
  if (layers) layers->draw_labels();
  if (!overlays.names.empty()) draw_names(layout, *terrain, overlays.distances);
  draw_labels(layout, labels);
  Layer layer = canvas.layer();
  if (overlays.inspect == core::Inspect::kSynthetic && scene.is_synthetic) tint_synthetic(*terrain, layer);
  return layer;
}

base::Rgb blend(const core::Rgba& over, base::Rgb below) {
  const auto mix = [&over](std::uint8_t top, std::uint8_t under) {
    const unsigned sum = top * unsigned{over.a} + under * (255U - over.a);
    return static_cast<std::uint8_t>((sum + 127U) / 255U);
  };
  return {mix(over.r, below.r), mix(over.g, below.g), mix(over.b, below.b)};
}

void composite(const Layer& layer, std::vector<base::Rgb>& image) {
  if (layer.pixels.empty()) return;
  if (layer.pixels.size() != image.size()) {
    throw std::invalid_argument("a layer of " + std::to_string(layer.pixels.size()) +
                                " pixels over an image of " + std::to_string(image.size()));
  }
  for (std::size_t n = 0; n < image.size(); ++n) {
    if (layer.pixels[n].a != 0) image[n] = blend(layer.pixels[n], image[n]);
  }
}

}  // namespace vpe::overlay
