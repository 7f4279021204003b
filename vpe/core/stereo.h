// Two eyes in one image.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "vpe/core/image/image.h"
#include "vpe/core/view.h"

namespace vpe::core {

enum class StereoLayout : std::uint8_t {
  kSideBySide,  // left eye on the left
  kOverUnder,   // left eye above
  kAnaglyph,    // for red glass before the left eye, cyan before the right
};

// "sbs", "ou", "anaglyph"; nothing for other words.
std::optional<StereoLayout> parse_stereo(std::string_view name);
const char* to_string(StereoLayout layout);

// Both images in full size, so that sbs is twice as wide and ou twice as high. Red-cyan is made by Dubois's
// matrix for such glasses in the rounding of ffmpeg's stereo3d (arcd; within 1/255 of it), on the stored
// values. Throws ImageError when the images differ in size or the result has a side over kMaxImageSide_px.
RgbImage combine_stereo(const RgbImage& left, const RgbImage& right, StereoLayout layout);

// Red-cyan in place of the left eye's pixels; both as long as each other.
void mix_red_cyan(std::span<base::Rgb> left, std::span<const base::Rgb> right);

// The view of an eye that is aside_m to the right (negative: left) along the view's right axis, the axes
// parallel. With a convergence distance the principal point moves so that what is at that distance in front
// of the middle between both eyes is at the same pixel in each; without, what is infinitely far.
View eye_aside(const View& view, double aside_m, std::optional<double> convergence_m);

// Eyes apart by this part of the distance of what is nearest show depth without strain.
inline constexpr double kNearestToBase = 30.0;
// The base for a range image: its smallest finite range / kNearestToBase; nothing when it is all sky.
std::optional<double> comfortable_base_m(std::span<const float> range_m);

}  // namespace vpe::core
