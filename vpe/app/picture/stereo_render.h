// Stereo images: two views of one scene in one image.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "vpe/app/cli/program.h"
#include "vpe/core/frame.h"
#include "vpe/core/stereo.h"

namespace vpe::app {

// Values of the options that add_method_options() adds: how the second eye is drawn.
struct StereoMethod {
  std::string name = "full";  // "reproject": the second eye is carried from the first (carried_drawer.h)
  // Widest gap between carried pixels that is filled, pixels; 0: both eyes are drawn in full. Smaller: more is drawn.
  double gap_px = 2;

  bool carries() const { return name == "reproject" && gap_px > 0; }
};

// Values of the options that add_stereo_options() adds.
struct StereoArguments {
  std::string layout;  // empty: no stereo
  // Distance between both eyes; 0: the distance of the nearest ground / core::kNearestToBase. Smaller: less
  // depth; larger: more depth, harder to fuse.
  double eye_base_m = 0;
  double convergence_m = 0;  // 0: parallel views
  StereoMethod method;
  std::string map;          // file of the second eye with drawn pixels in red; empty: none
  std::string differences;  // file of the differences from the second eye drawn in full; empty: none
};

// Says which image of a pair is drawn. The middle is drawn for its ranges alone.
enum class Eye : std::uint8_t { kMiddle, kLeft, kRight };

// Adds --stereo and --eye-base.
void add_eye_options(CLI::App& command, StereoArguments& arguments);
// Adds --stereo-method and --stereo-gap.
void add_method_options(CLI::App& command, StereoMethod& method);
// Adds --stereo, --eye-base, --convergence, those of add_method_options(), --stereo-map and --stereo-differences.
void add_stereo_options(CLI::App& command, StereoArguments& arguments);

// Throws UsageError for options that need --stereo and stand without it.
void check_stereo(const StereoArguments& arguments);

struct StereoImage {
  core::RgbImage image;
  double eye_base_m = 0;
  core::DrawResult left;  // without the pixels
  core::DrawResult right;
};

// Draws the request for both eyes, the left one first, each as a request of its own. `draw` makes a finished image of one
// request, overlays included. Without an eye base, this first draws the range from the middle. Throws std::runtime_error
// when that shows sky alone.
StereoImage draw_stereo(const StereoArguments& arguments, const core::DrawRequest& request,
                        const std::function<core::DrawResult(const core::DrawRequest&, Eye)>& draw);

}  // namespace vpe::app
