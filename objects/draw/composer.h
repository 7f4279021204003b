// Lays objects into an image of ground whose ranges are known, with their shadows: the same for every backend.
//
// Objects are drawn by rays, so that they cost what they cover (Hitchner 1992, section 3.3.2; Cohen-Or 1996, section 2).
// Ground hides them, and they hide it, by the image's ranges. Edges of objects and of their shadows are smoothed as the
// settings say for ground.
//
// Typical usage:
//   const LevelRule rule = level_rule(request, false);
//   const ComposedObjects drawn = compose(scene, {request, radius_m, &ground}, rule, pool, frame);
#pragma once

#include <cstdint>
#include <limits>
#include <span>

#include "objects/draw/object_shader.h"
#include "objects/posters/placed_poster.h"
#include "objects/scene/scene.h"
#include "vpe/base/parallel.h"
#include "vpe/core/frame.h"

namespace objects {

// States what compose() drew.
struct ComposedObjects {
  std::int64_t pixels = 0;   // that show an object
  std::int64_t covered = 0;  // those whose middle is more than half opaque
  std::int64_t shaded = 0;   // pixels of ground in the shadow of one
  std::int64_t objects = 0;  // different ones
  // Hold the largest distance between a drawn level and its model, and the same in the image, at its middle. Objects count
  // that may show, also if none of their pixels does.
  double geometric_error_m = 0;
  double screen_space_error_px = 0;
  bool is_see_through = false;  // a drawn object may be semi-transparent
  // Gives a distance from the camera within which there is no object and no image, in the view or beside it.
  double clear_m = std::numeric_limits<double>::infinity();
};

// Returns the rule of a request. exact: each object at its finest level.
LevelRule level_rule(const vpe::core::DrawRequest& request, bool exact);

// Draws the objects into the frame of the request's view, whose range_m must hold the ranges of the ground (kSkyRange:
// none), or be empty where there is no ground and no ranges are wanted. Colours, where the frame has any, must be without gamma. Pixels where `only` is 0 stay; empty: all are drawn.
// `posters` are images in the world, hidden and hiding as objects are. The result does not depend on threads. Pure but for what `light.ground` reads.
ComposedObjects compose(const Scene& scene, const ImageLight& light, const LevelRule& rule,
                        vpe::base::ThreadPool& pool, vpe::core::Frame& frame,
                        std::span<const std::uint8_t> only = {}, std::span<const PlacedPoster> posters = {});

}  // namespace objects
