// Matches the colours of an image to those of the imagery below it, at the boundary of its data.
//
// Typical usage:
//   if (const auto match = fit_colour_match(*ctx, *viking)) ctx = with_colour_match(ctx, *match);
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>

#include "mars/sources/source.h"

namespace mars {

// Holds the line for each band by which its values become those of the imagery below: gain * value + offset.
struct ColourMatch {
  std::array<double, 3> gain{1, 1, 1};
  std::array<double, 3> offset{0, 0, 0};  // in values, 0 to 255
  // Say how it was found.
  std::int64_t places = 0;
  double difference_before = 0;  // median of the absolute difference of values, largest of the bands
  double difference_after = 0;
};

struct ColourMatchOptions {
  // Places at which both are compared, about. More: slower, less noise.
  std::size_t places = 60'000;
  // Places within this many posts of the boundary count, if there are enough. Larger: less noise; smaller: nearer to what is
  // seen as a step.
  double boundary_posts = 128;
  std::size_t least_places = 200;  // fewer: there is no match
  double most_gain = 8;            // gains are within 1 / most_gain to most_gain
};

// Fits a match of an image to the imagery below it. Both are sampled at the same places near the boundary of the image's
// data, with texels of the coarser of both; where that gives too few places, anywhere in the image. For each band a line through
// the quantiles (10 to 90 per cent) of both is fitted by least squares, which shifts of one image against the other do not change.
// Values of 0 and 255 are left out, since they may be cut. Where a band hardly varies, only the offset is fitted. Numbers are
// rounded to what the treatment in infos() says. Returns nullopt if both have data at too few places. Deterministic. Throws
// SourceError on a read error.
std::optional<ColourMatch> fit_colour_match(const ImageSource& image, const ImageSource& below,
                                            const ColourMatchOptions& options = {});

// Returns the image with its colours changed by a match, rounded and cut to 0 to 255. Its infos have the match as treatment.
std::shared_ptr<const ImageSource> with_colour_match(std::shared_ptr<const ImageSource> image,
                                                     const ColourMatch& match);

// Returns the text of a match that infos() have: "colours matched to the imagery below: red 1.02 v + 3.5, ...".
std::string to_string(const ColourMatch& match);

}  // namespace mars
