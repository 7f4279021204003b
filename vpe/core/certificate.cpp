#include "vpe/core/certificate.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "mars/sources/source.h"
#include "mars/sources/synthetic.h"
#include "vpe/base/number.h"

namespace vpe::core {

namespace {

std::string meaning(const Certificate& c) {
  std::string text =
      "shift_bound_px: no surface pixel of this picture is off by more than this against the exact surface of "
      "the planet file; picture_bound_px: the same, tighter, where the picture's ranges are known. "
      "Where ridges are lower by as much, single pixels show what lies behind them. "
      "resampling_*: that surface against the posts of its own sources. source_accuracy_m: the sources "
      "against the planet, one sigma, null where unknown.";
  if (c.corner_stretch > 1) {
    text += " Pixels are those of the picture's middle; towards its corners they are stretched, up to " +
            base::format_rounded(c.corner_stretch, 2) + " times.";
  }
  if (c.thinning_px > 0) {
    text +=
        " Outside of the picture's middle (rays.fovea) rays are two pixels apart: thinning_px is the part of "
        "shift_bound_px that this adds, and what is narrower than two pixels may be missing there. "
        "middle_bound_px: shift_bound_px of the middle.";
  }
  if (c.sample_distance_px > 0) {
    text +=
        " A pixel has the range of a ray up to sample_distance_px from its centre (rays.sample=nearest); shift_bound_px "
        "includes by how much the ground may rise over that distance.";
  }
  if (c.smoothing_m > 0) {
    text +=
        " The ground is drawn as smooth patches through the posts of the exact surface (rays.mode=perturbation): "
        "smoothing_m is the largest distance between both, smoothing_px the part of shift_bound_px that this is.";
  }
  if (c.carried) {
    text +=
        " Pixels were carried from the picture of the other eye: carrying_px is the part of shift_bound_px that this "
        "adds; beside that, silhouettes are up to two pixels off. *_share: shares of pixels that were carried, that "
        "lie between carried ones, and that were drawn.";
  }
  if (c.objects) {
    text +=
        " objects_error_px: the largest error of a drawn object against its model, which shift_bound_px includes.";
  }
  if (c.is_below_ground) text += " The camera is below the ground: nothing is claimed about the picture.";
  if (c.nodata_share.value_or(0) > 0) text += " Where no source has data the picture is striped or grey.";
  if (!c.synthetic.empty()) text += " " + c.synthetic;
  if (c.tiles_missing > 0 || c.tiles_substituted > 0) {
    text += " Missing or substituted tiles are not covered by the bounds.";
  }
  return text;
}

}  // namespace

void state_data(Certificate& certificate, const DataStatement& data,
                std::span<const mars::SourceInfo> sources) {
  certificate.tolerance_px = data.tolerance_px;
  certificate.resampling_max_m = data.resampling_max_m;
  certificate.resampling_rms_m = data.resampling_rms_m;
  certificate.illustration = data.illustration;
  certificate.synthetic = mars::synthetic_statement(sources);
  certificate.source_accuracy_m.reset();
  for (const mars::SourceInfo& source : sources) {
    if (source.accuracy_m)
      certificate.source_accuracy_m = std::max(certificate.source_accuracy_m.value_or(0.0), *source.accuracy_m);
  }
}

nlohmann::ordered_json to_json(const Certificate& c) {
  nlohmann::ordered_json json;
  json["what_this_means"] = meaning(c);
  json["tile_error_m"] = c.geometric_error_m;
  json["tile_error_px"] = c.screen_space_error_px;
  json["quantisation_m"] = c.quantisation_m;
  json["quantisation_px"] = c.quantisation_px;
  json["shift_bound_px"] = c.shift_bound_px;
  json["picture_bound_px"] = nullptr;
  if (c.image_bound_px) json["picture_bound_px"] = *c.image_bound_px;
  if (c.thinning_px > 0) {
    json["thinning_px"] = c.thinning_px;
    json["middle_bound_px"] = nullptr;
    if (c.middle_bound_px) json["middle_bound_px"] = *c.middle_bound_px;
  }
  if (c.sample_distance_px > 0) json["sample_distance_px"] = c.sample_distance_px;
  if (c.smoothing_m > 0) {
    json["smoothing_m"] = c.smoothing_m;
    json["smoothing_px"] = c.smoothing_px;
  }
  if (c.carried) {
    json["carrying_px"] = c.carried->added_px;
    json["carried_share"] = c.carried->carried_share;
    json["between_share"] = c.carried->between_share;
    json["drawn_share"] = c.carried->drawn_share;
  }
  if (c.objects) {
    json["objects_drawn"] = c.objects->drawn;
    json["objects_error_m"] = c.objects->geometric_error_m;
    json["objects_error_px"] = c.objects->screen_space_error_px;
  }
  json["tolerance_px"] = c.tolerance_px;
  json["tiles_drawn"] = c.tiles_drawn;
  json["tiles_missing"] = c.tiles_missing;
  json["tiles_substituted"] = c.tiles_substituted;
  json["share_at_data_limit"] = c.share_at_data_limit;
  json["share_without_data"] = nullptr;
  if (c.nodata_share) json["share_without_data"] = *c.nodata_share;
  json["resampling_max_m"] = c.resampling_max_m;
  json["resampling_rms_m"] = c.resampling_rms_m;
  json["source_accuracy_m"] = nullptr;
  if (c.source_accuracy_m) json["source_accuracy_m"] = *c.source_accuracy_m;
  json["illustration"] = c.illustration;
  json["exaggeration"] = c.exaggeration;
  json["corner_stretch"] = c.corner_stretch;
  json["below_ground"] = c.is_below_ground;
  return json;
}

}  // namespace vpe::core
