#include "vpe/app/panorama/panorama_plan.h"

#include "panorama/image/tile_codec.h"
#include "panorama/metadata/sidecar.h"
#include "vpe/app/cli/digest.h"
#include "vpe/app/panorama/panorama_files.h"
#include "vpe/app/picture/fingerprint.h"

namespace vpe::app {

PanoramaPlan plan_panorama(const PanoramaRequest& request) {
  PanoramaPlan plan;
  try {
    panorama::PanoramaPlan planned = panorama::plan_panorama(request.map);
    plan.map = planned.map;
    plan.rounded = std::move(planned.rounded);
  } catch (const panorama::PlanError& e) {
    throw UsageError(e.what());
  }
  plan.format = panorama_format(request.output);
  plan.size = request.stereo ? panorama::size_of_pair(plan.map, request.stereo->layout)
                             : panorama::ImageSize{plan.map.width_px, plan.map.height_px};
  plan.is_red_cyan = request.stereo && request.stereo->layout == core::StereoLayout::kAnaglyph;
  // GPano describes one image only.
  plan.has_gpano = plan.map.kind != panorama::MapKind::kFacets && (!request.stereo || plan.is_red_cyan);
  plan.strips = panorama::strips_of(plan.size.width_px, plan.size.height_px);
  return plan;
}

StripLayout layout_of(const PanoramaPlan& plan, const panorama::Strip& strip, std::size_t layers) {
  const auto tiles = [](std::int64_t px) { return (px + panorama::kTile_px - 1) / panorama::kTile_px; };
  StripLayout layout;
  layout.in_tiles = plan.format == PanoramaFormat::kTiff;
  layout.tiles_across = tiles(strip.width);
  layout.tiles_down = tiles(plan.size.height_px);
  layout.bands = (plan.size.height_px + StripLayout::kBandRows - 1) / StripLayout::kBandRows;
  layout.layers = layers;
  return layout;
}

std::string fingerprint_of(const PanoramaRequest& request, const PanoramaPlan& plan,
                           const core::DrawRequest& draw_request, double radius_m) {
  core::DrawRequest first = draw_request;
  const panorama::Viewpoint viewpoint = panorama::viewpoint_of(request.camera, radius_m);
  first.view = panorama::pieces_of(plan.map, viewpoint, plan.strips.front(), 0).front().view;
  Digest digest;
  const RenderBasis basis{version(), request.identity, request.backend, request.memory_mb};
  digest.add(fingerprint_of(basis, first, request.settings));
  digest.add(panorama::to_text(panorama::Sidecar{"", plan.map, std::nullopt}));
  digest.add(static_cast<std::int64_t>(plan.format == PanoramaFormat::kTiff));
  for (const panorama::Plane layer : request.layers) digest.add(panorama::info_of(layer).name);
  if (!request.layers_checksum.empty()) digest.add("layers").add(request.layers_checksum);
  if (request.stereo) digest.add(recipe_json(request)["stereo"].dump());
  return digest.hex();
}

}  // namespace vpe::app
