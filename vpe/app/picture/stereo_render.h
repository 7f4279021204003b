// An image for two eyes.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "vpe/app/cli/program.h"
#include "vpe/core/frame.h"
#include "vpe/core/stereo.h"

namespace vpe::app {

struct StereoArguments {
  std::string layout;        // empty: one eye
  double eye_base_m = 0;     // 0: what is nearest / core::kNearestToBase
  double convergence_m = 0;  // 0: parallel
};

// --stereo, --eye-base.
void add_eye_options(CLI::App& command, StereoArguments& arguments);
// The same and --convergence.
void add_stereo_options(CLI::App& command, StereoArguments& arguments);

// Wrong combinations; throws UsageError.
void check_stereo(const StereoArguments& arguments);

struct StereoImage {
  core::RgbImage image;
  double eye_base_m = 0;
  core::DrawResult left;  // without the pixels
  core::DrawResult right;
};

// Draws the request from both eyes, each a request of its own; `draw` makes a finished image of one, overlays
// included. Without a base it draws the range from the middle first. Throws std::runtime_error when that shows
// sky alone.
StereoImage draw_stereo(const StereoArguments& arguments, const core::DrawRequest& request,
                        const std::function<core::DrawResult(const core::DrawRequest&)>& draw);

}  // namespace vpe::app
