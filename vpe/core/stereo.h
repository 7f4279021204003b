// Stereo pairs: the views of two eyes, and both images combined into one.
//
// Typical usage:
//   const RgbImage left = draw(eye_view(view, -base_m / 2, convergence_m));
//   const RgbImage right = draw(eye_view(view, base_m / 2, convergence_m));
//   const RgbImage pair = combine_stereo(left, right, StereoLayout::kAnaglyph);
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

// Describes the two eyes of an image.
struct StereoPair {
  StereoLayout layout = StereoLayout::kSideBySide;
  double eye_base_m = 0;     // > 0
  double convergence_m = 0;  // where both images coincide; 0: infinitely far
};

// Returns the layout named "sbs", "ou" or "anaglyph", or nullopt for other words.
std::optional<StereoLayout> parse_stereo(std::string_view name);
const char* to_string(StereoLayout layout);

// Combines both images in full size: kSideBySide is twice as wide, kOverUnder twice as high. The anaglyph uses
// Dubois's matrix for red-cyan glasses with the rounding of ffmpeg's stereo3d (arcd; within 1/255 of it), on
// the stored values. Throws ImageError if the images differ in size or a side of the result exceeds
// kMaxImageSide_px.
RgbImage combine_stereo(const RgbImage& left, const RgbImage& right, StereoLayout layout);

// Replaces the left eye's pixels by the red-cyan anaglyph. Both spans must have the same length.
void mix_red_cyan(std::span<base::Rgb> left, std::span<const base::Rgb> right);

// Returns a distance of convergence as eye_view() takes it: 0 stands for infinity.
inline std::optional<double> convergence_at(double convergence_m) {
  return convergence_m > 0 ? std::optional(convergence_m) : std::nullopt;
}

// Returns the view of an eye that is shifted by aside_m along the view's right axis (negative: to the left),
// with parallel axes. With a convergence distance the principal point moves, so that objects at that distance
// in front of the middle between both eyes are at the same pixel in each; without, objects at infinity are.
View eye_view(const View& view, double aside_m, std::optional<double> convergence_m);

// A base of the nearest distance divided by this shows depth without strain.
inline constexpr double kNearestToBase = 30.0;

// Returns the base for a range image: its smallest finite range / kNearestToBase, or nullopt if it is all sky.
std::optional<double> comfortable_base_m(std::span<const float> range_m);

// Returns the base for a camera this high above the ground, at least 1 m, when the ground below is the nearest.
double base_for_height_m(double height_m);

}  // namespace vpe::core
