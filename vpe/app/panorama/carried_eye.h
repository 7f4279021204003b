// The right eye of a round panorama, carried from the left one strip by strip (vpe/warp/carry_round.h).
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "panorama/panorama_plan.h"
#include "panorama/stereo_pieces.h"
#include "vpe/base/parallel.h"
#include "vpe/core/pixel_renderer.h"
#include "vpe/warp/carry_round.h"

namespace vpe::app {

// Holds the right eye's image of a strip.
struct RightEye {
  core::Frame frame;  // ranges are NaN where pixels were not carried
  // Holds the largest bounds of the certificates of the pixels that were drawn, and missing tiles; no frame.
  core::DrawResult drawn;
  std::vector<std::string> failures;
  double added_px = 0;  // largest bound of what carrying adds
};

// Copies the image of a piece to its place in a frame whose first column is column 0 of the piece's coordinates.
void copy_into(core::Frame& frame, const panorama::Piece& piece, const core::Frame& image);

// Carries strips of one panorama. Any thread may use it.
//
// Typical usage:
//   const CarriedEye eye(map, viewpoint, eyes);
//   for (const Piece& piece : eye.left_pieces(eye.columns_for(strip))) copy_into(left, piece, draw(piece));
//   const RightEye right = eye.carry(left, strip, renderer, request, pool, show);
class CarriedEye {
 public:
  // `eyes` has a carried_gap_px. Keeps a reference to the map.
  CarriedEye(const panorama::PanoramaMap& map, const panorama::Viewpoint& viewpoint,
             const panorama::EyePair& eyes);

  // Returns the columns of the left eye's image that a strip of the right eye's needs: the strip, and what lies on its right;
  // beyond the end of a full circle its beginning.
  std::vector<panorama::Strip> columns_for(const panorama::Strip& strip) const;
  // Returns the pieces of these columns; x is counted from the first of them.
  std::vector<panorama::Piece> left_pieces(const std::vector<panorama::Strip>& columns) const;
  // Returns the pieces of a strip of the right eye's image; x is counted from the strip's first column.
  std::vector<panorama::Piece> right_pieces(const panorama::Strip& strip) const;

  // Carries the left eye's image of columns_for(strip), and draws what is left. `request` has settings, sun and interest.
  // Reports the share that is done in `show`. Throws what the renderer throws.
  RightEye carry(const core::Frame& left, const panorama::Strip& strip, core::PixelRenderer& renderer,
                 const core::DrawRequest& request, base::ThreadPool& pool,
                 const std::function<void(double)>& show) const;

 private:
  const panorama::PanoramaMap& map_;
  panorama::Viewpoint viewpoint_;
  panorama::EyePair eyes_;
  std::vector<panorama::StereoBand> bands_;
  std::vector<warp::RoundRow> rows_;
  double nearest_m_ = 0;
};

// Keeps columns of the left eye's image between strips. Side by side, the left image is finished before most of the right
// one is begun, and what the right one is carried from would be drawn twice. For one thread at a time.
//
// Typical usage:
//   const core::Frame left = columns.join(eye.columns_for(strip), draw);
//   columns.keep(wanted_later);
class LeftColumns {
 public:
  using Draw = std::function<core::Frame(const panorama::Strip&)>;  // returns the colours and ranges of columns

  // Returns the columns of all strips beside each other. Draws those that are not kept, and keeps them. Strips do not
  // overlap and are not empty. Throws what `draw` throws.
  core::Frame join(const std::vector<panorama::Strip>& strips, const Draw& draw);
  // Drops what no column of these strips needs.
  void keep(const std::vector<panorama::Strip>& wanted);
  // Returns how many columns are kept.
  std::int64_t kept() const;

 private:
  struct Block {
    panorama::Strip strip;
    core::Frame frame;
  };
  std::vector<Block> blocks_;  // without overlaps
};

}  // namespace vpe::app
