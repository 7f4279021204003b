#include "vpe/app/picture/stereo_render.h"

#include <CLI/CLI.hpp>
#include <optional>
#include <stdexcept>

#include "vpe/base/number.h"

namespace vpe::app {

namespace {

constexpr double kMinBase_m = 1e-6;
constexpr double kMaxBase_m = 1e7;
constexpr double kMinConvergence_m = 1e-3;
constexpr double kMaxConvergence_m = 1e12;

double base_of_view(core::DrawRequest request,
                    const std::function<core::DrawResult(const core::DrawRequest&)>& draw) {
  request.want_range = true;
  static_cast<core::Overlays&>(request.settings) = {};
  const auto base_m = core::comfortable_base_m(draw(request).frame.range_m);
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

void add_stereo_options(CLI::App& command, StereoArguments& arguments) {
  add_eye_options(command, arguments);
  command
      .add_option("--convergence", arguments.convergence_m,
                  "Distance at which the eyes' images coincide, metres (default: infinity)")
      ->check(number_within(kMinConvergence_m, kMaxConvergence_m));
}

void check_stereo(const StereoArguments& arguments) {
  if (arguments.layout.empty() && (arguments.eye_base_m > 0 || arguments.convergence_m > 0))
    throw UsageError("--eye-base and --convergence need --stereo sbs, ou or anaglyph");
}

StereoImage draw_stereo(const StereoArguments& arguments, const core::DrawRequest& request,
                        const std::function<core::DrawResult(const core::DrawRequest&)>& draw) {
  StereoImage drawn;
  drawn.eye_base_m = arguments.eye_base_m > 0 ? arguments.eye_base_m : base_of_view(request, draw);
  std::optional<double> convergence_m;
  if (arguments.convergence_m > 0) convergence_m = arguments.convergence_m;
  const auto draw_eye = [&](double aside_m) {
    core::DrawRequest eye = request;
    eye.view = core::eye_view(request.view, aside_m, convergence_m);
    if (const std::string error = core::check(eye.view); !error.empty())
      throw UsageError("--stereo with eyes " + base::format_number(drawn.eye_base_m) + " m apart: " + error);
    return draw(eye);
  };
  drawn.left = draw_eye(-0.5 * drawn.eye_base_m);
  const core::RgbImage left = take_image(drawn.left);
  drawn.right = draw_eye(0.5 * drawn.eye_base_m);
  const core::RgbImage right = take_image(drawn.right);
  drawn.image = core::combine_stereo(left, right, *core::parse_stereo(arguments.layout));
  return drawn;
}

}  // namespace vpe::app
