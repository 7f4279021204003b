// Wraps an elevation source so that a function changes its heights.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>

#include "mars/sources/source.h"

namespace mars {

// Changes heights in place; NaN stays NaN. The result at a place depends on the place and its height alone, not
// on the batch. Any thread may call it.
using HeightAdjustment =
    std::function<void(std::span<const glm::dvec3> directions, std::span<double> heights_m)>;

// Returns the source with its heights adjusted. Its infos get the datum, and the treatment is appended to them
// unless it is empty. Boundaries and origins stay as they are.
std::shared_ptr<const ElevationSource> adjusted(std::shared_ptr<const ElevationSource> source,
                                                HeightAdjustment adjustment, const VerticalDatum& datum,
                                                const std::string& treatment);

// Joins two treatments: "a" and "b" give "a; b".
std::string add_treatment(const std::string& before, const std::string& treatment);

// Sets heights that must not be used to NaN, by place and height alone.
using PostMask = HeightAdjustment;

// Optional interface of a source that has posts of its own and can leave some of them out.
class Maskable {
 public:
  virtual ~Maskable() = default;

  // Returns the same source without the posts that the mask rejects and without their neighbours up to `margin`
  // posts away. Its boundary distances take these posts for nodata. Returns null if this source cannot be
  // masked.
  virtual std::shared_ptr<const ElevationSource> with_mask(PostMask mask, int margin,
                                                           const std::string& treatment) const = 0;
};

}  // namespace mars
