// A source whose heights pass through a function.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>

#include "mars/sources/source.h"

namespace mars {

// Changes heights (NaN stays NaN) by their places alone: the same for any batch, from any thread.
using Adjust = std::function<void(std::span<const glm::dvec3> directions, std::span<double> heights_m)>;

// The source with its heights adjusted and its infos given the datum and, where it is not empty, the treatment
// (added to what has been done before). Rims and places of data stay as they are.
std::shared_ptr<const ElevationSource> adjusted(std::shared_ptr<const ElevationSource> source, Adjust adjust,
                                                const VerticalDatum& datum, const std::string& treatment);

// "a" and "b" as "a; b".
std::string add_treatment(const std::string& before, const std::string& treatment);

// Sets heights to NaN that are not to be used, by place and height alone.
using PostMask = Adjust;

// What a source may do that has posts of its own.
class Maskable {
 public:
  virtual ~Maskable() = default;

  // The same source without the posts that the mask drops and without their neighbours up to `margin` posts
  // away. Rims know of the holes. Null when this source cannot after all.
  virtual std::shared_ptr<const ElevationSource> with_mask(PostMask mask, int margin,
                                                           const std::string& treatment) const = 0;
};

}  // namespace mars
