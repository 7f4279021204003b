#include "vpe/core/stereo.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

namespace vpe::core {

namespace {

// Parts of 65536: red, green and blue of the result from red, green, blue of the left and of the right eye.
constexpr std::array<std::array<int, 6>, 3> kDuboisRedCyan{{{29891, 32800, 11559, -2849, -5763, -102},
                                                            {-2627, -2479, -1033, 24804, 48080, -1209},
                                                            {-997, -1350, -358, -4729, -7403, 80373}}};

std::uint8_t mix(const std::array<int, 6>& weights, const base::Rgb& l, const base::Rgb& r) {
  const int sum = weights[0] * l.r + weights[1] * l.g + weights[2] * l.b + weights[3] * r.r + weights[4] * r.g +
                  weights[5] * r.b;
  return static_cast<std::uint8_t>(std::clamp(sum / 65536, 0, 255));
}

}  // namespace

const char* to_string(StereoLayout layout) {
  switch (layout) {
    case StereoLayout::kSideBySide: return "sbs";
    case StereoLayout::kOverUnder: return "ou";
    case StereoLayout::kAnaglyph: return "anaglyph";
  }
  return "";
}

std::optional<StereoLayout> parse_stereo(std::string_view name) {
  for (const auto layout : {StereoLayout::kSideBySide, StereoLayout::kOverUnder, StereoLayout::kAnaglyph}) {
    if (name == to_string(layout)) return layout;
  }
  return std::nullopt;
}

RgbImage combine_stereo(const RgbImage& left, const RgbImage& right, StereoLayout layout) {
  if (left.width != right.width || left.height != right.height) {
    throw ImageError("the left eye's image has " + std::to_string(left.width) + "x" +
                     std::to_string(left.height) + " pixels, the right eye's " + std::to_string(right.width) +
                     "x" + std::to_string(right.height) + "; both must be equal");
  }
  const bool beside = layout == StereoLayout::kSideBySide;
  RgbImage both{beside ? 2 * left.width : left.width,
                layout == StereoLayout::kOverUnder ? 2 * left.height : left.height,
                {}};
  if (std::max(both.width, both.height) > kMaxImageSide_px) {
    throw ImageError("both eyes together have " + std::to_string(both.width) + "x" +
                     std::to_string(both.height) + " pixels, but a side may have at most " +
                     std::to_string(kMaxImageSide_px) + "; make them smaller");
  }
  if (layout == StereoLayout::kAnaglyph) {
    both.pixels = left.pixels;
    mix_red_cyan(both.pixels, right.pixels);
    return both;
  }
  both.pixels.reserve(static_cast<std::size_t>(both.width) * static_cast<std::size_t>(both.height));
  const auto width = static_cast<std::ptrdiff_t>(beside ? left.width : left.width * left.height);
  const auto rows = static_cast<std::ptrdiff_t>(left.pixels.size()) / width;
  for (std::ptrdiff_t row = 0; row < rows; ++row) {
    for (const RgbImage* eye : {&left, &right}) {
      const auto begin = eye->pixels.begin() + row * width;
      both.pixels.insert(both.pixels.end(), begin, begin + width);
    }
  }
  return both;
}

void mix_red_cyan(std::span<base::Rgb> left, std::span<const base::Rgb> right) {
  for (std::size_t n = 0; n < left.size(); ++n) {
    const base::Rgb l = left[n];
    const base::Rgb& r = right[n];
    left[n] = {mix(kDuboisRedCyan[0], l, r), mix(kDuboisRedCyan[1], l, r), mix(kDuboisRedCyan[2], l, r)};
  }
}

View eye_view(const View& view, double aside_m, std::optional<double> convergence_m) {
  View eye = view;
  eye.camera.position_m += aside_m * view.camera.axes.right;
  // An eye on the right sees a point straight ahead to the left, so the principal point moves right.
  if (convergence_m) eye.principal_offset_px.x += focal_px(view) * aside_m / *convergence_m;
  return eye;
}

std::optional<double> comfortable_base_m(std::span<const float> range_m) {
  double nearest_m = HUGE_VAL;
  for (const float range : range_m) {
    if (range > 0.0F) nearest_m = std::min(nearest_m, static_cast<double>(range));
  }
  if (!std::isfinite(nearest_m)) return std::nullopt;
  return nearest_m / kNearestToBase;
}

double base_for_height_m(double height_m) { return std::max(height_m, 1.0) / kNearestToBase; }

}  // namespace vpe::core
