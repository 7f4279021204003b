#include "vpe/app/picture/stereo_render.h"

#include <CLI/CLI.hpp>
#include <optional>
#include <stdexcept>

#include "vpe/base/number.h"
#include "vpe/warp/carry.h"

namespace vpe::app {

namespace {

constexpr double kMinBase_m = 1e-6;
constexpr double kMaxBase_m = 1e7;
constexpr double kMinConvergence_m = 1e-3;
constexpr double kMaxConvergence_m = 1e12;

double base_of_view(core::DrawRequest request,
                    const std::function<core::DrawResult(const core::DrawRequest&, Eye)>& draw) {
  request.want_range = true;
  static_cast<core::Overlays&>(request.settings) = {};
  const auto base_m = core::comfortable_base_m(draw(request, Eye::kMiddle).frame.range_m);
  if (!base_m)
    throw std::runtime_error(
        "--stereo: the view shows only sky; set the distance between the eyes with --eye-base");
  return *base_m;
}

core::RgbImage take_image(core::DrawResult& result) {
  core::RgbImage image{result.frame.width, result.frame.height, std::move(result.frame.colour)};
  result.frame = {};
  return image;
}

}  // namespace

void add_eye_options(CLI::App& command, StereoArguments& arguments) {
  command
      .add_option("--stereo", arguments.layout,
                  "Draw a stereo pair: sbs: side by side; ou: left eye above right eye; anaglyph: red-cyan")
      ->check(CLI::IsMember({"sbs", "ou", "anaglyph"}));
  command
      .add_option(
          "--eye-base", arguments.eye_base_m,
          "Distance between the eyes, metres (default: a thirtieth of the distance to the nearest terrain)")
      ->check(number_within(kMinBase_m, kMaxBase_m));
}

void add_method_options(CLI::App& command, StereoMethod& method) {
  command
      .add_option(
          "--stereo-method", method.name,
          "full: draw both eyes; reproject: draw the left eye, carry its pixels to the right one, and draw what "
          "is left by rays")
      ->check(CLI::IsMember({"full", "reproject"}))
      ->capture_default_str();
  command
      .add_option(
          "--stereo-gap", method.gap_px,
          "With --stereo-method reproject: widest gap between carried pixels that is filled, pixels; the error "
          "that this adds is less by one; 0: draw both eyes")
      ->check(number_within(0, warp::CarryLimits::kMaxGap_px))
      ->capture_default_str();
}

void add_stereo_options(CLI::App& command, StereoArguments& arguments) {
  add_eye_options(command, arguments);
  command
      .add_option("--convergence", arguments.convergence_m,
                  "Distance at which the eyes' images coincide, metres (default: infinity)")
      ->check(number_within(kMinConvergence_m, kMaxConvergence_m));
  add_method_options(command, arguments.method);
  command.add_option(
      "--stereo-map", arguments.map,
      "With --stereo-method reproject: also write the right eye's image with the drawn pixels in red (.png, .jpg)");
  command.add_option(
      "--stereo-differences", arguments.differences,
      "With --stereo-method reproject: also write how far the right eye's image is from the one that is "
      "drawn in full (.png, .jpg)");
}

void check_stereo(const StereoArguments& arguments) {
  if (arguments.layout.empty() && (arguments.eye_base_m > 0 || arguments.convergence_m > 0))
    throw UsageError("--eye-base and --convergence need --stereo sbs, ou or anaglyph");
  if (arguments.layout.empty() && arguments.method.name == "reproject")
    throw UsageError("--stereo-method reproject needs --stereo sbs, ou or anaglyph");
  if ((!arguments.map.empty() || !arguments.differences.empty()) &&
      (arguments.layout.empty() || !arguments.method.carries()))
    throw UsageError(
        "--stereo-map and --stereo-differences show a carried eye: give --stereo and --stereo-method reproject");
}

StereoImage draw_stereo(const StereoArguments& arguments, const core::DrawRequest& request,
                        const std::function<core::DrawResult(const core::DrawRequest&, Eye)>& draw) {
  StereoImage drawn;
  drawn.eye_base_m = arguments.eye_base_m > 0 ? arguments.eye_base_m : base_of_view(request, draw);
  std::optional<double> convergence_m;
  if (arguments.convergence_m > 0) convergence_m = arguments.convergence_m;
  const auto draw_eye = [&](double aside_m, Eye which) {
    core::DrawRequest eye = request;
    eye.view = core::eye_view(request.view, aside_m, convergence_m);
    if (const std::string error = core::check(eye.view); !error.empty())
      throw UsageError("--stereo with eyes " + base::format_number(drawn.eye_base_m) + " m apart: " + error);
    return draw(eye, which);
  };
  drawn.left = draw_eye(-0.5 * drawn.eye_base_m, Eye::kLeft);
  const core::RgbImage left = take_image(drawn.left);
  drawn.right = draw_eye(0.5 * drawn.eye_base_m, Eye::kRight);
  const core::RgbImage right = take_image(drawn.right);
  drawn.image = core::combine_stereo(left, right, *core::parse_stereo(arguments.layout));
  return drawn;
}

}  // namespace vpe::app
