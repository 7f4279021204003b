// Height of the camera over the drawn ground, and the near plane that it allows.
#pragma once

#include <optional>

#include "paging/planet/planet_file.h"
#include "vpe/core/view.h"
#include "vpe/gl/tile_streamer.h"

namespace vpe::gl {

// Finds the ground below the camera from the posts of the finest tile there, as they are drawn. While those are
// not resident, bounds from the tile tree replace them.
//
// Thread rule: the context's thread. `streamer` and `planet` must outlive it.
//
// Typical usage, once a frame:
//
//   if (const auto page = clearance.needed_page(view)) streamer.request(*page, urgency);
//   clearance.update(view);
//   const double near_m = clearance.near_plane_m(cover, view);
class CameraClearance {
 public:
  CameraClearance(const paging::PlanetFile& planet, const TileStreamer& streamer)
      : planet_(planet), streamer_(streamer) {}

  // Returns the page of the posts below the camera, or nullopt if the near plane does not depend on them, or if
  // they cannot be read.
  std::optional<PageKey> needed_page(const core::View& view) const;

  // Returns true if the camera is certain to be above what is drawn under it, which may be higher than the
  // reference surface. cover: the tiles to draw.
  bool is_above_ground(const lod::Selection& cover, const core::View& view) const;

  // Finds the clearance of the camera of a frame.
  void update(const core::View& view);

  // Returns the distance of the camera from the ground below or above it, metres. A lower bound while the posts
  // are not resident.
  double clearance_m() const { return clearance_m_; }

  // Returns the distance of the near plane, metres: 0.003 or more, on bodies smaller than Mars 1e-9 radii or more.
  // cover: the tiles to draw.
  double near_plane_m(const lod::Selection& cover, const core::View& view) const;

 private:
  double camera_height_m(const core::View& view) const;
  const lod::TileInfo& finest_tile(const core::View& view) const;
  std::optional<double> ground_m(const core::View& view) const;

  const paging::PlanetFile& planet_;
  const TileStreamer& streamer_;
  double clearance_m_ = 0;
};

}  // namespace vpe::gl
