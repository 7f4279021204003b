// What a frame states about its own geometric error.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace vpe::core {

// Bounds over the drawn tiles of one frame, against the surface S of the planet file (docs/architecture.md).
struct Certificate {
  double geometric_error_m = 0;      // largest tile error bound among the drawn tiles
  double screen_space_error_px = 0;  // largest projected bound: error * focal length / distance
  double quantisation_m = 0;         // largest displacement of a vertex by float storage
  double quantisation_px = 0;        // projected likewise, with float arithmetic and the rasteriser's grid
  double shift_bound_px = 0;  // every pixel's shift is at most this: tile error + quantisation, projected
  // The same from the ranges at which tiles appear in the image: tighter, as tiles need not show where they
  // are nearest. Absent without a range image.
  std::optional<double> image_bound_px;
  double tolerance_px = 0;  // what was asked for
  int tiles_drawn = 0;
  int tiles_missing = 0;
  int tiles_substituted = 0;
  double share_at_data_limit =
      0;  // share of surface pixels drawn from finest tiles at error 0 (estimate by tile)
  std::optional<double> nodata_share;  // share of the image that shows ground without data; absent: not known
  double resampling_max_m = 0;         // S against the sources' own posts
  double resampling_rms_m = 0;
  std::optional<double> source_accuracy_m;
  bool illustration = false;
  double exaggeration = 1;
};

// One JSON object, a line a field, ending in a newline; keys are the names of the fields and what_this_means.
// null for what is absent or not finite. The same text in every locale.
std::string to_json(const Certificate& certificate);

}  // namespace vpe::core
