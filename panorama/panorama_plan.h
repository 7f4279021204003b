// The plan of a panorama: its map, from the user's options, and the Views that draw it piece by piece.
//
// A panorama is cut into strips of whole columns, and strips into pieces. Every piece is a part of an ordinary
// core::View, of a facet or of the round image. Any Renderer that draws the projection can draw it, and the
// memory that is needed at once is bounded. Pieces depend on the map alone: equal maps have equal pieces. All
// functions are pure and may be called from any thread.
//
// Typical usage:
//   const PanoramaPlan plan = plan_panorama(options);
//   for (const Strip& strip : strips_of(plan.map)) {
//     for (const Piece& piece : pieces_of(plan.map, viewpoint, strip, margin_px)) draw(piece.view);
//   }
#pragma once

#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "panorama/projection.h"
#include "panorama/viewpoint.h"
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
  static constexpr int kTile_px = 256;  // strips are whole tiles wide, except the last one
  static constexpr std::int64_t kStripPixels = std::int64_t{1} << 22;  // about; at least a tile wide
  static constexpr std::int64_t kPiecePixels = std::int64_t{1} << 21;  // about
  static constexpr int kMaxPieceSide_px = 8192;                        // OpenGL draws that much anywhere
};

// Reports options that cannot be fulfilled; what() says what is allowed.
class PlanError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// Describes a range of azimuths, clockwise. Equal ends mean the full circle.
struct Arc {
  double from_deg = 0;  // azimuth of the image's left edge
  double to_deg = 0;    // of its right edge
};

struct PlanOptions {
  MapKind kind = MapKind::kCylinder;
  // For kFacets. More facets: less off-axis magnification in their corners, more Views to draw.
  int facets = PlanLimits::kDefaultFacets;
  // Azimuth of facet 0's middle; of the left edge of other kinds that show the full circle.
  double yaw_deg = 0;
  std::optional<Arc> arc;  // absent: the full circle from the left edge on
  // Limits of elevation; for facets in their middle columns. Absent: -+kDefaultFlatElevation_deg, for
  // kEquirectangular -+90. A wider range adds rows, and on flat kinds ever more towards +-90.
  std::optional<double> lowest_deg;
  std::optional<double> highest_deg;
  // Resolution; at most one of the two: columns of the image, or degrees a column on the horizon (the mean over
  // a facet). Both absent: kDefaultWidth_px columns. Time and memory grow with the square of the resolution.
  std::optional<std::int64_t> width_px;
  std::optional<double> degrees_per_pixel;
};

struct PanoramaPlan {
  PanoramaMap map;
  std::vector<std::string> rounded;  // one sentence for each value that differs from the options
};

// Returns the plan for the options. The full circle has a whole number of columns. The numbers of rows above
// and below the horizon are whole, too: each is rounded to the nearest, or towards the horizon where the zenith
// or nadir would be passed. Facets have whole columns, and their pixel centres are the mosaic's. Throws
// PlanError.
PanoramaPlan plan_panorama(const PlanOptions& options);

// Describes a part of the image and the View that draws it. `view` draws `margin_px` more on each side; without
// the margin the piece covers [x, x + width) x [y, y + height) of the image.
struct Piece {
  vpe::core::View view;
  std::int64_t x = 0;
  std::int64_t y = 0;
  int width = 0;
  int height = 0;
  int margin_px = 0;
};

// Describes columns of the image, with all of its rows.
struct Strip {
  std::int64_t x = 0;
  int width = 0;
};

// Return the strips of an image, from left to right without gaps.
std::vector<Strip> strips_of(std::int64_t width_px, std::int64_t height_px);
std::vector<Strip> strips_of(const PanoramaMap& map);

// Returns a View of the full circle of a round map of plan_panorama(), with column 0 at t = 0 (projection.h).
vpe::core::View round_view(const PanoramaMap& map, const Viewpoint& viewpoint);

// Returns the pieces of one strip, without gaps or overlaps. Pieces of facets get `margin_px`, for filters that
// read neighbouring pixels; round images get no margin.
std::vector<Piece> pieces_of(const PanoramaMap& map, const Viewpoint& viewpoint, const Strip& strip,
                             int margin_px);

}  // namespace panorama
