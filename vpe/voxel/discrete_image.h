// Paints images of the discrete caster (rays.mode=discrete): the mean of a pixel's rays, and levels of colours that go by
// rays.ratio and, with rays.blend, fade into each other (Cohen-Or 1996, section 2).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "vpe/base/parallel.h"
#include "vpe/base/rgb.h"
#include "vpe/core/frame.h"
#include "vpe/voxel/paint/image_painter.h"

namespace vpe::voxel {

// Returns how much of the next coarser level ground at a range shows, 0 to 1: none where its own level begins, all where that
// ends. level_range_m is ImagePainter::level_range_m(). Pure.
double coarser_share(float range_m, double level_range_m);

// Copies the ranges of the rays that are nearest to the middle of their pixels. `rays_m` holds rows of rays as cast_discretely()
// writes them.
void take_middle_rays(std::span<const float> rays_m, int width, int rays, std::span<float> range_m);

// Paints all rays of the request's image and sets each pixel to the mean of its own. Of rays of a pixel that follow each other and
// show one voxel the first is painted. Unless `wanted` is empty, only the pixels where it is not 0 are set; it must be empty for
// several rays a pixel. Returns the number of pixels whose first ray has no data. Appends what was absent to `absent`. See
// ImagePainter::paint() for `reading` and errors.
std::int64_t paint_discrete(const core::DrawRequest& request, std::span<const float> rays_m,
                            std::span<const std::uint8_t> wanted, ImagePainter& painter, base::ThreadPool& pool,
                            ImagePainter::Reading& reading, std::vector<AbsentPage>& absent,
                            std::span<base::Rgb> colour);

}  // namespace vpe::voxel
