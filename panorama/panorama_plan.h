// What a panorama consists of: its map from wishes, and the Views that draw it piece by piece.
//
// A panorama is cut into strips of whole columns, strips into pieces. Every piece is a part of an ordinary
// core::View, of a facet or of the round image, so any Renderer that draws the projection can make it, and
// what is held at once is bounded. How it is cut depends on the map alone: the same map, the same pieces.
// All functions are pure and may be called from any thread.
#pragma once

#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "mars/geodesy/pose.h"
#include "panorama/projection.h"
#include "vpe/core/view.h"

namespace panorama {

struct PlanLimits {
  static constexpr int kDefaultFacets = 8;
  static constexpr double kMaxFlatElevation_deg = 89;  // kCylinder, kFacets; kEquirectangular: 90
  static constexpr double kDefaultFlatElevation_deg = 45;
  static constexpr double kMinSpan_deg = 0.1;  // of azimuth and of elevation
  static constexpr double kMaxYaw_deg = 720;
  static constexpr std::int64_t kDefaultWidth_px = 4096;
  static constexpr std::int64_t kMaxHeight_px = 65536;
  static constexpr int kTile_px = 256;  // strips are whole tiles wide, but for the last one
  static constexpr std::int64_t kStripPixels = std::int64_t{1} << 22;  // about; at least a tile wide
  static constexpr std::int64_t kPiecePixels = std::int64_t{1} << 21;  // about
  static constexpr int kMaxPieceSide_px = 8192;                        // OpenGL draws that much anywhere
};

// A wish that cannot be fulfilled; says what is allowed.
class PlanError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct Arc {
  double from_deg = 0;  // azimuth of the image's left edge
  double to_deg = 0;    // of its right edge, to the right of it; the same: a whole turn
};

struct PlanOptions {
  MapKind kind = MapKind::kCylinder;
  int facets = PlanLimits::kDefaultFacets;  // kFacets
  double yaw_deg = 0;                       // facet 0's middle; of a whole turn by rays its left edge
  std::optional<Arc> arc;                   // left out: a whole turn from the left edge on
  // Of facets: in their middle columns. Left out: +-kDefaultFlatElevation_deg; +-90 for kEquirectangular.
  std::optional<double> lowest_deg;
  std::optional<double> highest_deg;
  // One of them at most: columns of the image, or of the horizon (mean over a facet). Both left out:
  // kDefaultWidth_px.
  std::optional<std::int64_t> width_px;
  std::optional<double> degrees_per_pixel;
};

struct PanoramaPlan {
  PanoramaMap map;
  std::vector<std::string> rounded;  // what is not quite as asked for
};

// Columns of the turn are whole, rows above and below the horizon too (each rounded to the nearest; towards the
// horizon where the zenith or nadir would be passed), and facets have whole columns: their pixel centres are
// the mosaic's. Throws PlanError.
PanoramaPlan plan_panorama(const PlanOptions& options);

// `view` draws the piece with `margin_px` more on each side; without it the piece covers
// [x, x + width) x [y, y + height) of the image.
struct Piece {
  vpe::core::View view;
  std::int64_t x = 0;
  std::int64_t y = 0;
  int width = 0;
  int height = 0;
  int margin_px = 0;
};

struct Strip {
  std::int64_t x = 0;
  int width = 0;  // all of the image's rows
};

// Who looks: the camera, with yaw counted from `north`'s convention of mars::to_camera (at a pole along the pose's
// own meridian). Yaw, pitch and roll of the pose are not used.
struct PoseOnSphere {
  mars::Pose pose;
  double radius_m = mars::kMarsRadius_m;
};

// Left to right without gaps, of an image of this size; of a map's image.
std::vector<Strip> strips_of(std::int64_t width_px, std::int64_t height_px);
std::vector<Strip> strips_of(const PanoramaMap& map);
// The whole turn of a round map of plan_panorama() as a View, column 0 at the start of the turn.
vpe::core::View round_view(const PanoramaMap& map, const PoseOnSphere& stand);
// Of one strip, without gaps or overlaps. Of a facet, margin_px gives filters that look at neighbouring pixels
// what they need; round images get none.
std::vector<Piece> pieces_of(const PanoramaMap& map, const PoseOnSphere& stand, const Strip& strip,
                             int margin_px);

}  // namespace panorama
