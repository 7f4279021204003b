// vpe overlook.
#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <glm/geometric.hpp>
#include <optional>

#include "panorama/viewer/head_offset.h"
#include "panorama/viewer/view_ranges.h"
#include "panorama/viewer/viewer.h"
#include "vpe/app/cli/examples.h"
#include "vpe/app/cli/figures.h"
#include "vpe/app/cli/interrupt.h"
#include "vpe/app/cli/json_output.h"
#include "vpe/app/cli/output.h"
#include "vpe/app/cli/parsing.h"
#include "vpe/app/cli/program.h"
#include "vpe/app/cli/progress.h"
#include "vpe/app/panorama/commands.h"
#include "vpe/app/panorama/open_stereo.h"
#include "vpe/app/panorama/overlook_places.h"
#include "vpe/app/panorama/panorama_page.h"
#include "vpe/app/panorama/panorama_viewer.h"
#include "vpe/app/picture/image_options.h"
#include "vpe/app/picture/stereo_render.h"
#include "vpe/app/planet/planet_argument.h"
#include "vpe/base/heap.h"
#include "vpe/base/number.h"
#include "vpe/core/stereo.h"
#include "vpe/overlay/overlay.h"
#include "vpe/warp/carry.h"

namespace vpe::app {

namespace {

struct OverlookArguments {
  std::string panorama;
  std::string right;
  std::string stereo_layout;
  std::string stereo;
  StereoMethod method;
  double eye_base_m = 0;
  std::optional<std::string> view;
  double fov_deg = panorama::ViewerLimits::kDefaultFov_deg;
  std::string size = "1280x720";
  std::string output;
  std::vector<std::string> direction;
  std::vector<std::string> at_pixel;
  double scale = 0;
  bool compass = false;
  std::string graphics = "auto";
  double roll_deg = 0;
  std::string head;
  double head_scale = 1;
  PageArguments page;
};

struct Pair {
  double first = 0;
  double second = 0;
};

// Returns an angle for messages, to a thousandth of a degree.
std::string shown(double degrees) { return base::format_rounded(degrees, 3); }

Pair parse_pair(const std::string& option, const std::string& text, const char* expected) {
  const auto numbers = parse_numbers(text);
  if (!numbers || numbers->size() != 2)
    throw UsageError(option + " '" + text + "': expected " + std::string(expected));
  return {(*numbers)[0], (*numbers)[1]};
}

panorama::Direction parse_direction(const std::string& option, const std::string& text) {
  const Pair pair = parse_pair(option, text, "AZIMUTH,ELEVATION (degrees, clockwise from north and up)");
  if (std::abs(pair.second) > 90.0)
    throw UsageError(option + " '" + text + "': the second number is an elevation and must be within -90..90");
  return {pair.first, pair.second};
}

// Returns the head's place, metres to the right, up and backwards of the panorama's; zero without a text.
glm::dvec3 parse_head_place(const std::string& text) {
  if (text.empty()) return glm::dvec3(0);
  const auto numbers = parse_numbers(text);
  if (!numbers || numbers->size() != 3)
    throw UsageError("--head '" + text +
                     "': expected RIGHT,UP,BACK in metres from the panorama's place, as 0.5,0,-1");
  return {(*numbers)[0], (*numbers)[1], (*numbers)[2]};
}

PanoramaFiles files_of(const OverlookArguments& arguments) {
  PanoramaFiles files{arguments.panorama, arguments.right, {}};
  if (!arguments.stereo_layout.empty()) files.layout = panorama::parse_pair_layout(arguments.stereo_layout);
  if (arguments.method.name == "reproject")
    files.second = SecondLookOptions{.eye_base_m = arguments.eye_base_m, .gap_px = arguments.method.gap_px};
  return files;
}

// Refuses options that contradict each other.
void check_eyes(const OverlookArguments& arguments) {
  const bool is_carried = arguments.method.name == "reproject";
  if (is_carried && (!arguments.right.empty() || !arguments.stereo_layout.empty()))
    throw UsageError(
        "--stereo-method reproject makes the right eye of the left one's image; leave --right and "
        "--stereo-layout out");
  if (!is_carried && arguments.eye_base_m > 0)
    throw UsageError("--eye-base is for --stereo-method reproject; images of two eyes have their own");
  if (parse_head_place(arguments.head) == glm::dvec3(0)) return;
  if (!arguments.stereo.empty())
    throw UsageError("--head and --stereo: a head moves in views for one eye; leave one out");
  if (arguments.output.empty()) throw UsageError("--head is for -o; in a window a head tracker moves the head");
}

StereoPanorama open_panorama(const OverlookArguments& arguments, const Common& common) {
  // The rest of the memory is for the view.
  StereoPanorama panorama(files_of(arguments), memory_bytes(common) / 4 * 3, common.threads);
  if (arguments.method.name == "reproject" && panorama.description().pair != panorama::PairLayout::kNone)
    throw UsageError("--stereo-method reproject: '" + panorama.description().image.string() +
                     "' is for two eyes already; leave it out");
  if (!arguments.head.empty() && !panorama::has_ranges(panorama.description())) {
    throw UsageError(
        "--head: '" + panorama.description().image.string() +
        "' has no ranges, from which a view from beside its place could be made; make it with --aux-layers "
        "range");
  }
  if (!arguments.stereo.empty() && !panorama.is_pair()) {
    throw UsageError(
        "--stereo " + arguments.stereo + ": '" + panorama.description().image.string() +
        "' is for one eye; give the other eye's image with --right, --stereo-layout if it holds both, or "
        "--stereo-method reproject if it has the layer range");
  }
  return panorama;
}

panorama::Viewer make_viewer(const OverlookArguments& arguments, const panorama::PanoramaMap& map,
                             const Size& size, bool quiet) {
  panorama::Viewer viewer(map, size.width, size.height);
  viewer.set_fov(arguments.fov_deg);
  if (std::abs(viewer.fov_deg() - arguments.fov_deg) > 1e-9 && !quiet) {
    std::fprintf(stderr,
                 "vpe: note: the field of view is %s degrees, not %s: a pixel of the image is drawn at most %g "
                 "wide\n",
                 shown(viewer.fov_deg()).c_str(), shown(arguments.fov_deg).c_str(),
                 panorama::ViewerLimits::kMaxMagnification);
  }
  viewer.set_roll(arguments.roll_deg);
  if (!arguments.view) return viewer;
  const panorama::Direction wanted = parse_direction("--view", *arguments.view);
  viewer.look_at(wanted.azimuth_deg, wanted.elevation_deg);
  if (std::abs(viewer.pitch_deg() - wanted.elevation_deg) > 1e-9 && !quiet) {
    std::fprintf(stderr, "vpe: note: the view looks up %s degrees, not %s, to stay within the image\n",
                 shown(viewer.pitch_deg()).c_str(), shown(wanted.elevation_deg).c_str());
  }
  return viewer;
}

overlay::Layer compass_of(const core::View& view) {
  core::Overlays overlays;
  overlays.compass = core::CompassStrip::kBottom;
  overlay::Scene scene;
  scene.view = view;
  scene.frame = panorama::kViewerFrame;
  return overlay::draw(overlays, scene);
}

core::RgbImage draw_view(StereoPanorama& panorama, const core::View& view, const OverlookArguments& arguments,
                         const Common& common) {
  const InterruptGuard guard;
  ProgressLine progress(common.quiet);
  const auto copying = [&](const std::string& what, double fraction) {
    InterruptGuard::check();
    progress.show(what, fraction);
  };
  if (arguments.graphics == "on") panorama.set_context(gl::Context::create());
  const overlay::Layer layer = arguments.compass ? compass_of(view) : overlay::Layer();
  const auto finish = [&layer](core::RgbImage& image) { overlay::composite(layer, image.pixels); };
  core::RgbImage image = panorama.draw(view, core::parse_stereo(arguments.stereo), copying, finish);
  InterruptGuard::check();
  return image;
}

nlohmann::json describe_view(const panorama::Viewer& viewer, int width, int height) {
  return {{"yaw_deg", viewer.yaw_deg()},
          {"pitch_deg", viewer.pitch_deg()},
          {"roll_deg", viewer.roll_deg()},
          {"fov_deg", viewer.fov_deg()},
          {"width", width},
          {"height", height}};
}

void overlook(const OverlookArguments& arguments, const Common& common) {
  constexpr int kTightMemory_mb = 512;
  if (common.memory_mb < kTightMemory_mb) base::keep_heap_compact();
  // Wrong usage and files that cannot be written are reported before any work.
  const Size size = parse_size(arguments.size);
  if (arguments.view) (void)parse_direction("--view", *arguments.view);
  check_eyes(arguments);
  std::vector<panorama::Direction> directions;
  for (const std::string& text : arguments.direction)
    directions.push_back(parse_direction("--direction", text));
  std::vector<Pair> pixels;
  for (const std::string& text : arguments.at_pixel)
    pixels.push_back(parse_pair("--at-pixel", text, "X,Y (pixels of the image, centres at .5)"));
  check_outputs({{"-o", arguments.output, FileKind::kImage}}, {arguments.panorama, arguments.right});
  if (arguments.compass && !core::overlays_refused().empty())
    throw UsageError("--compass: " + std::string(core::overlays_refused()));
  check_page(arguments.page);
  const bool in_window =
      arguments.output.empty() && directions.empty() && pixels.empty() && arguments.page.folder.empty();
  if (in_window) check_window();

  StereoPanorama panorama = open_panorama(arguments, common);
  const panorama::PanoramaDescription& description = panorama.description();
  if (!description.heading_is_known && arguments.compass) {
    throw UsageError("--compass: '" + description.image.string() +
                     "' does not say where north is; leave it out, or describe the image in a JSON beside it");
  }
  if (!description.heading_is_known && !common.quiet) {
    std::fprintf(stderr, "vpe: note: '%s' does not say where north is; azimuths are counted from its middle\n",
                 description.image.c_str());
  }
  nlohmann::json json{{"picture", description.image.string()},
                      {"projection", panorama::to_string(description.map.kind)},
                      {"described_by", description.sources}};

  std::vector<panorama::ProbeResult> places;
  for (const Pair& pixel : pixels) places.push_back(probe_pixel(description, pixel.first, pixel.second));
  for (const panorama::Direction& direction : directions)
    places.push_back(probe_direction(description, direction));
  for (const panorama::ProbeResult& place : places) json["places"].push_back(to_json(place));

  if (in_window) {
    PanoramaViewerRequest request{files_of(arguments),
                                  {},
                                  arguments.fov_deg,
                                  core::parse_stereo(arguments.stereo),
                                  size,
                                  arguments.graphics == "off",
                                  arguments.scale,
                                  arguments.head_scale};
    if (arguments.view) request.direction = parse_direction("--view", *arguments.view);
    const panorama::Viewer viewer = view_panorama(request, common);
    json["view"] = describe_view(viewer, viewer.size().x, viewer.size().y);
  }
  if (!arguments.output.empty()) {
    const panorama::Viewer viewer = make_viewer(arguments, description.map, size, common.quiet);
    core::View view = viewer.view();
    const glm::dvec3 head_m = parse_head_place(arguments.head);
    view.camera.position_m = panorama::head_offset(viewer.yaw_deg(), head_m);
    const core::RgbImage image = draw_view(panorama, view, arguments, common);
    core::write_image(arguments.output, image.pixels, image.width, image.height);
    json["output"] = arguments.output;
    json["view"] = describe_view(viewer, image.width, image.height);
    if (head_m != glm::dvec3(0)) {
      const double asked_m = glm::length(head_m);
      json["head"] = {
          {"moved_m", panorama.moved_m()}, {"asked_m", asked_m}, {"filled_share", panorama.filled_share()}};
      if (!common.quiet) {
        std::fprintf(
            stderr,
            "vpe: the head is %s from the panorama's place; %.1f %% of the pixels are not in the panorama\n",
            length_text(panorama.moved_m()).c_str(), 100 * panorama.filled_share());
        if (panorama.moved_m() < asked_m * (1 - 1e-9))
          std::fprintf(stderr,
                       "vpe: note: a head moves at most by a quarter of the nearest range that it sees\n");
      }
    }
    if (const SecondLook* second = panorama.second(); second != nullptr && !arguments.stereo.empty()) {
      json["second_eye"] = {{"eye_base_m", second->eye_base_m()}, {"filled_share", panorama.filled_share()}};
      if (!common.quiet)
        std::fprintf(stderr, "vpe: eyes %s apart; %.1f %% of the right eye's pixels are not in the panorama\n",
                     length_text(second->eye_base_m()).c_str(), 100 * panorama.filled_share());
    }
  }
  if (!arguments.page.folder.empty())
    json["page"] = write_page_of(arguments.page, files_of(arguments), {}, common);
  if (common.json) {
    print_json(json);
    return;
  }
  if (!places.empty()) std::printf("%s\n", csv_header(places.front()).c_str());
  for (const panorama::ProbeResult& place : places) std::printf("%s\n", csv_line(place).c_str());
}

}  // namespace

void add_overlook(CLI::App& program, Common& common) {
  using Limits = panorama::ViewerLimits;
  auto arguments = std::make_shared<OverlookArguments>();
  CLI::App* command = add_command(
      program, "overlook", "Panorama viewer: look around in a panorama, or print what it shows", common, true);
  command->add_option("PANO", arguments->panorama, "Image of a panorama, or the JSON that describes one")
      ->required();
  command->add_option(
      "--view", arguments->view,
      "YAW,PITCH: direction of the view, degrees clockwise from north and up (default: the image's middle)");
  command->add_option("--fov", arguments->fov_deg, "Vertical field of view, degrees")
      ->check(number_within(Limits::kMinFov_deg, Limits::kMaxFov_deg))
      ->capture_default_str();
  command
      ->add_option("--roll", arguments->roll_deg,
                   "Tilt of the view written with -o to its right, degrees; in a window the head's counts")
      ->check(number_within(-180, 180))
      ->capture_default_str();
  command->add_option(
      "--head", arguments->head,
      "RIGHT,UP,BACK: the view written with -o from beside the panorama's place, metres, by its layer range");
  command
      ->add_option(
          "--head-scale", arguments->head_scale,
          "Metres of the world for a metre of the tracked head, in a window, by the layer range; 0: it only turns")
      ->check(number_within(0, 1e8))
      ->capture_default_str();
  command
      ->add_option(
          "--graphics", arguments->graphics,
          "Draw views by OpenGL (on) or exactly, on the CPU (off) (default: auto, by OpenGL in a window if "
          "this machine can, exactly with -o)")
      ->check(CLI::IsMember({"auto", "on", "off"}))
      ->capture_default_str();
  command
      ->add_option("--size", arguments->size, "WIDTHxHEIGHT of the view of one eye, or of the window, pixels")
      ->capture_default_str();
  command->add_option("-o,--output", arguments->output,
                      "View to write (.png, .jpg); without it and --direction a window opens");
  // --at is the former name; elsewhere it is a place.
  command
      ->add_option("--direction,--at", arguments->direction,
                   "AZIMUTH,ELEVATION: print what is there (degrees; repeatable)")
      ->expected(1)
      ->allow_extra_args(false)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  command
      ->add_option("--at-pixel", arguments->at_pixel,
                   "X,Y: print what is at a pixel of the image (centres at .5; repeatable)")
      ->expected(1)
      ->allow_extra_args(false)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  command->add_option("--right", arguments->right, "The right eye's panorama; PANO is the left eye's");
  command
      ->add_option(
          "--stereo-layout", arguments->stereo_layout,
          "Eyes that the image holds: left and right (sbs), left above right (ou), one (none) (default: as its "
          "JSON says)")
      ->check(CLI::IsMember({"sbs", "ou", "none"}));
  command
      ->add_option("--stereo", arguments->stereo,
                   "Draw both eyes: side by side (sbs), left above right (ou), red-cyan (anaglyph)")
      ->check(CLI::IsMember({"sbs", "ou", "anaglyph"}));
  command
      ->add_option(
          "--stereo-method", arguments->method.name,
          "full: each eye has an image; reproject: make the right eye's view of the left one's and the "
          "layer range")
      ->check(CLI::IsMember({"full", "reproject"}))
      ->capture_default_str();
  command
      ->add_option(
          "--stereo-gap", arguments->method.gap_px,
          "With --stereo-method reproject: widest gap between pixels that is filled by what lies between "
          "them, pixels; wider ones are filled by what is behind them")
      ->check(number_within(0.5, warp::CarryLimits::kMaxGap_px))
      ->capture_default_str();
  command
      ->add_option(
          "--eye-base", arguments->eye_base_m,
          "With --stereo-method reproject: distance of the eyes, metres (default: a thirtieth of the nearest "
          "range in the first view)")
      ->check(number_within(1e-6, 1e6));
  command
      ->add_option("--scale", arguments->scale, "Size of the window's letters (default: that of the monitor)")
      ->check(number_within(0.5, 4));
  command->add_flag("--compass", arguments->compass,
                    "Draw marks of azimuth along the view's lower edge; a window always has them");
  add_page_options(*command, arguments->page);
  add_examples(*command,
               {{"in a window", "vpe overlook rim.png"},
                {"a view to azimuth 119, 5 degrees up, as a file",
                 "vpe overlook rim.png --view 119,5 --fov 40 -o look.png"},
                {"both eyes, of an image for one with ranges",
                 "vpe overlook rim.png --view 119,-5 --stereo anaglyph --stereo-method reproject -o both.png"},
                {"as a web page, in a folder", "vpe overlook rim.png --html rim-page"},
                {"what is in a direction", "vpe overlook rim.png --direction 119,-3 --json"}});
  command->callback([arguments, &common] { overlook(*arguments, common); });
}

}  // namespace vpe::app
