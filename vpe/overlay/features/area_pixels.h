// Fills of areas over parts of an image, pixel by pixel.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "vpe/base/parallel.h"
#include "vpe/overlay/features/feature_scale.h"
#include "vpe/overlay/overlay.h"

namespace vpe::overlay {

// Describes a part of an image that a view draws: pixel (x, y) of the view is at begin + y * stride + x.
struct PixelBlock {
  std::span<base::Rgb> colour;
  std::span<const float> range_m;  // NaN where it is not known
  std::size_t begin = 0;
  std::size_t stride = 0;
};

// Answers about the ground. Any number of threads may ask.
struct GroundAnswers {
  // Returns the outward normal of the ground, as drawn, at a point.
  std::function<glm::dvec3(const glm::dvec3& point_m)> normal;
  // Returns the distance along a unit ray to the ground; infinity where it meets none.
  std::function<double(const glm::dvec3& from_m, const glm::dvec3& ray)> cast;
};

// Lays the fills of all layers over a block, upper layers over lower ones. A pixel has the share of four places in it, which
// lie on the plane of the ground at its middle. So it depends on its own ray and range alone: not on the division of the image
// into blocks, nor on threads. Throws what the answers throw.
void fill_pixels(const std::vector<SceneLayer>& layers, const core::View& view, const FeatureScale& scale,
                 const GroundAnswers& ground, base::ThreadPool& pool, const PixelBlock& block);

}  // namespace vpe::overlay
