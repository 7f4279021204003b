// Interprets requests for the ray backend: what it cannot draw, how it casts, and what an image takes. Pure.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "vpe/core/frame.h"
#include "vpe/voxel/cast/range_caster.h"
#include "vpe/voxel/smooth/smooth_form.h"

namespace vpe::voxel {

// Returns the number of pixels of a view's drawn part.
std::size_t drawn_pixels(const core::View& view);

// Returns the memory that the pixels of an image take: range, colours, and copies while it is smoothed, merged and
// written. The samples of its columns take as much as half of max_image_bytes besides; larger images are cast in
// bands.
std::size_t ray_image_bytes(const core::DrawRequest& request);

// Returns the reason why the ray backend cannot draw the request, for users, or "" if it can. Wireframes,
// markers, a cull view and inspection show meshes or tiles, which the ray backend does not draw.
std::string why_not(const core::DrawRequest& request);

// Returns the level control of a request that the ray backend does not have in any mode, or that acts in
// rays.mode=multires only; for messages, "" if there is none.
std::string_view refused_control(const core::DrawRequest& request);
std::string_view multires_control(const core::DrawRequest& request);

// Returns how the ranges of a request are cast: the mode of the settings, its level control, and cells that grow
// with the request's coarsening. In modes exact and reference a coarsening above 1 also leads to coarser cells.
RangeOptions range_options(const core::DrawRequest& request, double planet_radius_m);

// Returns true if pixels of a request's image have the ranges of the nearest columns (rays.sample): perspective images of modes
// exact and multires. With rays.sample=auto those of several samples a pixel, but not ranges without colours, which are
// those of the pixels' centres.
bool takes_nearest(const core::DrawRequest& request);

// Returns by how much ground may rise over a distance in the image: the largest distance from a point beside a ray, so far away
// from where the ray meets the ground, to the ground above or below that point. `steepest_slope` bounds the tangent of its slope.
double rise_px(double distance_px, double steepest_slope);

// Returns true for rays.mode=volume and boundary, which cast terrain volumes.
bool is_volume_mode(core::RayMode mode);

// Returns true if the request is drawn with the parts of its ground.
bool draws_ground_parts(const core::DrawRequest& request);

// Returns options that find the same tiles with few rays: those of an image with so many times fewer rows and columns. Expects
// another method than kReference.
RangeOptions for_hints(RangeOptions options, double downsampling);

// Returns the patches of a request that shows smooth ground: rays.mode=perturbation without coarsening. Coarser images are
// cast in cells of the tiles, as in the other modes.
std::optional<SmoothForm> smooth_form(const core::DrawRequest& request);

}  // namespace vpe::voxel
