// Refuses sources that do not fit the planet or each other: other bodies, radii taken for heights, datums that
// differ unsaid.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "mars/sources/source.h"

namespace mars {

// Largest accepted difference between the radius of a source's body and the planet's, relative.
inline constexpr double kBodyMismatch = 0.2;

// Throws SourceError if the body of a source, elevation or image, is larger or smaller than the planet by more
// than kBodyMismatch.
void check_body(const SourceInfo& info, double radius_m);

// Throws SourceError if all values of a source are radii (between half and one and a half radii of the planet),
// but its datum says otherwise, or if none is one, but its datum is kRadius. Appends a note if its relief
// exceeds the planet's radius. Looks at some hundred posts. `info` is that of the source's own values.
void check_range(const ElevationSource& source, const SourceInfo& info, double radius_m,
                 std::vector<std::string>& notes);

// A source without a vertical datum of its own is taken for heights of the others' datum only if their median
// difference where both have data is at most kDatumStep_m, and at most kDatumSpreads robust standard deviations
// (1.4826 times the median absolute deviation) of the difference. The deviation counts as kLeastSpread_m at
// least, so that sources that agree almost everywhere are not refused for a few metres. The areoid of Mars lies
// from 18.0 km below to 1.3 km above the sphere of 3396.19 km.
//
// Between its posts the base says nothing of the ground: a small layer may lie in a valley that no post met. So
// kReliefShare of the base's relief within a post (the median over the layer's places of the range of the base at the
// place and half a post to the north, south, east and west) is accepted too, divided by the root of the number of
// base posts that the layer covers, since relief averages out over many.
inline constexpr double kDatumStep_m = 50;
inline constexpr double kDatumSpreads = 3;
inline constexpr double kLeastSpread_m = 10;
inline constexpr double kReliefShare = 0.5;

// Throws SourceError if `layer` differs from the coarser `base` as said above at the places where one of them is
// `silent`: the name of a source that does not state its datum. Sources in `same` are stated to have the datum of
// all others and are not compared. The message has the difference and the ways out. Looks at about 20 000 posts
// of the layer. Both must have heights, not radii, above a sphere of radius_m or another datum of that size.
void check_silent_datums(const ElevationSource& layer, const ElevationSource& base, double radius_m,
                         const std::set<std::string>& silent, const std::set<std::string>& same);

}  // namespace mars
