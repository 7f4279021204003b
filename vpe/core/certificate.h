// The certificate of a frame: its statement about its own geometric error.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>

namespace mars {
struct SourceInfo;
}

namespace vpe::core {

// Holds bounds over the drawn tiles of one frame, against the reference surface of the planet file
// (docs/design/numbers-and-errors.md).
struct Certificate {
  double geometric_error_m = 0;      // largest geometric error among the drawn tiles
  double screen_space_error_px = 0;  // largest screen-space error: geometric error * focal length / distance
  double quantisation_m = 0;         // largest displacement of a vertex by float storage
  double quantisation_px = 0;        // the same in the image, with float arithmetic and the rasteriser's grid
  double shift_bound_px = 0;         // bound of all pixel shifts: geometric error + quantisation, in the image
  // The same bound from the ranges at which tiles appear in the image. It is tighter, because a tile need not
  // be visible where it is nearest. Absent without a range image.
  std::optional<double> image_bound_px;
  // Part of shift_bound_px: by how much pixels may be off because rays are thinned where they lie (rays.fovea); 0
  // where each pixel has its own. Outside of the middle a ridge narrower than two pixels may be missing.
  double thinning_px = 0;
  // The bound of the middle, where rays are not thinned. Absent if all of the image has one density.
  std::optional<double> middle_bound_px;
  // Largest distance in the image between a pixel's centre and the ray whose range it has (rays.sample=nearest); 0 where each pixel has
  // its own ray. shift_bound_px includes by how much ground may rise over that distance.
  double sample_distance_px = 0;
  // Describes an image of smooth patches (rays.mode=perturbation): the largest distance between the patches and the
  // reference surface, and the part of shift_bound_px that this is. 0 in other modes.
  double smoothing_m = 0;
  double smoothing_px = 0;
  // Describes an image of carried pixels (vpe/warp): part of shift_bound_px, by how much carried pixels may be off
  // because of that; and the shares of pixels that were carried, lie between carried ones, and were drawn. Absent where all
  // pixels were drawn.
  struct Carried {
    double added_px = 0;
    double carried_share = 0;
    double between_share = 0;
    double drawn_share = 0;
  };
  std::optional<Carried> carried;
  // Describes the objects of an image; shift_bound_px includes them. Absent without any.
  struct Objects {
    std::int64_t drawn = 0;            // different ones
    double geometric_error_m = 0;      // largest distance between a drawn level of detail and its model
    double screen_space_error_px = 0;  // the same in the image
  };
  std::optional<Objects> objects;
  double tolerance_px = 0;  // of the request
  int tiles_drawn = 0;
  int tiles_missing = 0;
  int tiles_substituted = 0;
  // Share of surface pixels drawn from finest tiles at error 0 (estimated by tile).
  double share_at_data_limit = 0;
  std::optional<double> nodata_share;  // share of the image that shows nodata ground; absent: unknown
  double resampling_max_m = 0;         // reference surface against the posts of the sources
  double resampling_rms_m = 0;
  std::optional<double> source_accuracy_m;  // of the least accurate source; absent: unknown
  bool illustration = false;                // some elevations are invented, not data
  std::string synthetic;                    // mars::synthetic_statement() of the sources
  bool is_below_ground = false;             // the camera is; nothing is claimed about the image
  double exaggeration = 1;
  // Largest length in the image of what is one pixel long at its middle: 1 / cos^2 of the angle to the farthest
  // corner of a perspective image, else 1. Bounds in pixels are of the middle.
  double corner_stretch = 1;
};

// Describes what every backend states alike: the tolerance of the request and the errors of the planet file.
struct DataStatement {
  double tolerance_px = 0;
  double resampling_max_m = 0;
  double resampling_rms_m = 0;
  bool illustration = false;
};

// Copies the statement into the certificate, and the accuracy of the least accurate source (nullopt if no
// source states one).
void state_data(Certificate& certificate, const DataStatement& data, std::span<const mars::SourceInfo> sources);

// Returns one JSON object: what_this_means, then the fields in their order. Some keys keep their names of
// earlier versions (docs/design/numbers-and-errors.md), so that readers of old files work. Absent values are
// null; dump() writes null for values that are not finite, and the same text in every locale.
nlohmann::ordered_json to_json(const Certificate& certificate);

}  // namespace vpe::core
