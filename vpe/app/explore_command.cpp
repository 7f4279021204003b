#include <CLI/CLI.hpp>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <sstream>
#include <string>
#include <utility>

#include "relief/files/relief_file.h"
#include "vpe/app/cli/examples.h"
#include "vpe/app/cli/program.h"
#include "vpe/app/commands.h"
#include "vpe/app/picture/comparison.h"
#include "vpe/app/picture/image_options.h"
#include "vpe/app/picture/pose_option.h"
#include "vpe/app/places/named_places.h"
#include "vpe/app/planet/latitude_option.h"
#include "vpe/app/planet/planet_argument.h"
#include "vpe/base/number.h"
#include "vpe/explore/screens/placed_screen.h"
#ifdef VPE_HAS_WINDOW
#include "mars/embedded/data_files.h"
#include "vpe/app/cli/output.h"
#include "vpe/app/cli/shell_word.h"
#include "vpe/app/command_job.h"
#include "vpe/app/film/film_plan.h"
#include "vpe/app/panorama/panorama_painter.h"
#include "vpe/app/picture/backend_choice.h"
#include "vpe/app/scene/model_ball.h"
#include "vpe/app/scene/scene_sight.h"
#include "vpe/app/window_painter.h"
#include "vpe/core/appearance/gazetteer.h"
#include "vpe/explore/command_words.h"
#include "vpe/explore/drawing/project.h"
#include "vpe/explore/files/hotspots.h"
#include "vpe/explore/files/preferences.h"
#include "vpe/explore/screens/screens_file.h"
#include "vpe/gl/context.h"
#include "vpe/window/explore_window.h"
#include "vpe/window/panels/overlay_bar.h"
#endif

namespace vpe::app {

namespace {

struct ExploreArguments {
  std::string planet;
  std::string earlier;  // planet of --compare
  std::string pose;
  std::string latitude;
  std::string size;
  double fov_deg = 50;
  double scale = 0;
  std::string log;
  std::string flight;
  std::string hotspots;
  std::string reliefs;
  std::string screens;
  double head_scale = 0;  // 0: that of the file
  bool print_settings = false;
  bool restores_overlays = true;  // those of the last session
  bool names_backend = false;     // else that of the last session
  bool names_fov = false;         // else that of a project
  StereoMethod stereo;
  RenderOptions image;
};

#ifdef VPE_HAS_WINDOW

bool sets(const RenderOptions& options, const std::string& key) {
  for (const std::string& assignment : options.set)
    if (assignment.starts_with(key + "=")) return true;
  return false;
}

// Returns the planet's path as a session file records it: absolute, or empty for the embedded Mars.
std::string recorded_path(const std::string& planet) {
  return planet.empty() ? planet : std::filesystem::absolute(planet).lexically_normal().string();
}

// Draws over images what the last session drew, except what the command line decides.
void restore_overlays(const std::string& overlays, const RenderOptions& options, core::Settings& settings) {
  std::istringstream lines(overlays);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t sign = line.find('=');
    const std::string key = line.substr(0, sign);
    // A file of names may be gone by now.
    if (sign != std::string::npos && key.starts_with("overlay.") && !sets(options, key))
      (void)settings.set(key, line.substr(sign + 1));
  }
}

// Names places of Mars in the search box and over images.
void add_places(const paging::PlanetMeta& meta, window::ExploreSetup& setup) {
  if (meta.body != "Mars") return;
  setup.places_file = mars::find_data_file(mars::kPlacesFile);
  if (!setup.places_file.empty()) setup.places = read_places_of("");
}

// Returns a command as a line for a shell.
std::string shell_line(const std::vector<std::string>& words) {
  std::string line = "vpe";
  for (const std::string& word : words) line += " " + shell_word(word);
  return line;
}

// Returns a command that draws the view of a session.
std::string command_line(const std::string& file, const paging::PlanetFile& planet,
                         const vpe::explore::Session& session) {
  vpe::explore::MakeOptions options;
  options.planet = file;
  options.output = "view.png";
  std::vector<std::string> words = vpe::explore::image_words(session, options);
  if (session.settings().values().colour == core::Colour::kDifference && planet.earlier())
    words.insert(words.end(), {"--compare", std::filesystem::absolute(planet.earlier()->path()).string()});
  return shell_line(words);
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);)
    if (!line.empty()) lines.push_back(line);
  return lines;
}

// Holds the project that is opened first.
struct OpenedProject {
  std::filesystem::path file;
  vpe::explore::Project project;
};

// Reads the project that is given in place of a planet, and fills in what the command line does not say. Throws
// for a bad project.
std::optional<OpenedProject> open_project(ExploreArguments& arguments) {
  if (!vpe::explore::is_project_file(arguments.planet)) return std::nullopt;
  OpenedProject opened{std::filesystem::absolute(arguments.planet), {}};
  vpe::explore::ParsedProject parsed = vpe::explore::load_project(arguments.planet);
  std::string wrong;
  for (const std::string& error : parsed.errors) wrong += (wrong.empty() ? "" : "\n     ") + error;
  if (!wrong.empty()) throw std::runtime_error(wrong);
  opened.project = std::move(*parsed.project);
  arguments.planet = opened.project.planet.string();
  arguments.restores_overlays = false;
  if (arguments.flight.empty()) {
    arguments.flight = opened.project.flight.string();
  } else {
    opened.project.flight_text.reset();
  }
  if (arguments.hotspots.empty()) arguments.hotspots = opened.project.hotspots.string();
  if (!arguments.names_fov) arguments.fov_deg = opened.project.fov_deg;
  std::vector<std::string> settings;
  for (const auto& [key, value] : opened.project.settings) settings.push_back(key + "=" + value);
  arguments.image.set.insert(arguments.image.set.begin(), settings.begin(), settings.end());
  return opened;
}

void apply(OpenedProject opened, const ExploreArguments& arguments, window::ExploreSetup& setup) {
  vpe::explore::Project& project = opened.project;
  if (!setup.session.start) setup.session.start = project.pose;
  if (!arguments.names_backend) setup.drawn_by = project.drawn_by;
  setup.panels = project.panels;
  setup.session.interest.insert(setup.session.interest.begin(), project.regions.begin(), project.regions.end());
  setup.project_file = opened.file;
  setup.project = std::move(project);
}

// Returns everything except the planet. Throws for wrong usage before any work.
window::ExploreSetup make_setup(const ExploreArguments& arguments, const Common& common,
                                const vpe::explore::Preferences& preferences,
                                const vpe::explore::LastSession& last) {
  window::ExploreSetup setup;
  setup.preferences = preferences;
  setup.log = arguments.log;
  setup.flight_file = arguments.flight;
  check_outputs({{"--log", arguments.log, FileKind::kFlightLog}},
                {arguments.planet, arguments.flight, arguments.hotspots});
  if (!arguments.flight.empty() && std::filesystem::exists(arguments.flight))
    setup.flight = read_flight(arguments.flight);
  setup.bookmarks = vpe::explore::explore_files().bookmarks;
  setup.preferences_file = vpe::explore::explore_files().preferences;
  setup.state = vpe::explore::explore_files().session.parent_path();
  if (!arguments.reliefs.empty()) (void)relief::read_relief_file(arguments.reliefs);
  if (!arguments.screens.empty()) {
    setup.screens = vpe::explore::read_screens_file(arguments.screens);
    if (arguments.head_scale > 0) setup.screens->scale = arguments.head_scale;
  }
  if (!arguments.hotspots.empty()) {
    const vpe::explore::ParsedHotspots parsed = vpe::explore::load_hotspots(arguments.hotspots);
    std::string wrong;
    for (const auto& error : parsed.errors)
      wrong += (wrong.empty() ? "" : "\n     ") + scripts::to_string(error);
    if (!wrong.empty()) throw std::runtime_error(wrong);
    setup.hotspots = parsed.hotspots;
  }
  setup.open_overlook = [common, budget_ms = preferences.draw_budget_ms,
                         invert_wheel = preferences.invert_wheel](const std::filesystem::path& panorama) {
    window::OverlookSetup overlook =
        overlook_setup({panorama.string(), {}, {}}, memory_bytes(common) / 4, common.threads);
    overlook.budget_ms = budget_ms;
    overlook.invert_wheel = invert_wheel;
    return overlook;
  };
  setup.session.mouse = vpe::explore::mouse_choices(preferences);
  setup.panels = last.panels;
  setup.side_px = last.side_px;
  if (arguments.scale <= 0) setup.letters = last.letters;
  setup.session.settings = make_settings(arguments.image);
  if (arguments.restores_overlays) restore_overlays(last.overlays, arguments.image, setup.session.settings);
  setup.session.interest = parse_interest(arguments.image);
  setup.session.fov_deg = arguments.fov_deg;
  if (!sets(arguments.image, "lod.frame_ms")) {
    const std::string error =
        setup.session.settings.set("lod.frame_ms", base::format_number(preferences.draw_budget_ms));
    if (!error.empty()) throw std::logic_error(error);
  }
  if (!arguments.pose.empty()) setup.session.start = parse_pose("--pose", arguments.pose).pose;
  const vpe::explore::LastSession fresh;
  setup.display.scales_size = arguments.size.empty() && last.window_width_px == fresh.window_width_px &&
                              last.window_height_px == fresh.window_height_px;
  setup.display.width = last.window_width_px;
  setup.display.height = last.window_height_px;
  if (!arguments.size.empty()) {
    const Size size = parse_size(arguments.size);
    setup.display.width = size.width;
    setup.display.height = size.height;
  }
  setup.display.scale = arguments.scale > 0 ? arguments.scale : preferences.ui_scale;
  setup.display.instead =
      "set DISPLAY to an X server, or work without a window: 'vpe render' draws an image, 'vpe fly' a flight, "
      "'vpe panorama' a panorama, and 'xvfb-run vpe explore' runs this command on a virtual display";
  setup.drawn_by = arguments.names_backend ? core::drawn_by(arguments.image.backend) : last.drawn_by;
  setup.has_gpu = gl::has_gpu();
  setup.suits_rays = [](const core::DrawRequest& request) {
    return suits_rays(for_window_rays(request, true));
  };
  setup.as_drawn = as_drawn;
  setup.sun = sun_for;
  setup.threads = common.threads;
  setup.model_ball = model_ball;
  setup.open_planet = [common](const std::string& file) { return open_planet(file, common); };
  setup.builds_first = [](const std::string& file) { return file.empty() || is_raster_argument(file); };
  setup.start_job = [common](const std::vector<std::string>& words) {
    std::vector<std::string> all = words;
    if (common.memory_mb != Common{}.memory_mb) {
      all.emplace_back("--memory");
      all.push_back(std::to_string(common.memory_mb));
    }
    if (common.threads > 0) {
      all.emplace_back("--threads");
      all.push_back(std::to_string(common.threads));
    }
    return std::make_unique<CommandJob>("/proc/self/exe", all);
  };
  setup.recent = lines_of(last.recent);
  return setup;
}

// Screens and the view of the session share the memory.
Common common_of(Common common, const ExploreArguments& arguments) {
  if (!arguments.screens.empty()) common.memory_mb /= 2;
  return common;
}

window::ShownPlanet shown_planet(std::shared_ptr<const paging::PlanetFile> planet, const Common& common,
                                 const StereoMethod& stereo) {
  constexpr std::size_t kSurfaceShare = 8;
  auto surface = std::make_shared<const paging::Surface>(planet, memory_bytes(common) / kSurfaceShare);
  return {planet, surface,
          [planet, common, stereo] { return std::make_unique<WindowPainter>(planet, common, stereo); },
          scene_sight(surface), scene_sight};
}

// Writes the session file; the scale of letters only if the command line does not say one. Returns "", or what went wrong; there is no file if there is no folder for it.
std::string keep_session(const window::ExploreWindow& shown, const std::string& planet,
                         const std::filesystem::path& file, bool keeps_letters,
                         vpe::explore::LastSession& last) {
  last.panels = shown.state().panels;
  last.side_px = shown.state().side_px;
  if (keeps_letters) last.letters = shown.state().letters;
  last.overlays.clear();
  for (const std::string& overlay : window::overlays_on(shown.session().settings()))
    last.overlays += (last.overlays.empty() ? "" : "\n") + overlay;
  last.recent.clear();
  for (const std::string& recent : shown.recent()) last.recent += (last.recent.empty() ? "" : "\n") + recent;
  last.planet = planet;
  last.pose = shown.session().pose();
  last.drawn_by = shown.state().drawn_by;
  const auto [width, height] = shown.display().size();
  last.window_width_px = width;
  last.window_height_px = height;
  return file.empty() ? "" : vpe::explore::save(last, file);
}

void explore(const ExploreArguments& given, const Common& common) {
  const vpe::explore::ExploreFiles files = vpe::explore::explore_files();
  const vpe::explore::Preferences preferences = vpe::explore::read_preferences(files.preferences);
  if (given.print_settings) {
    std::fputs(vpe::explore::to_text(preferences).c_str(), stdout);
    return;
  }
  ExploreArguments arguments = given;
  std::optional<OpenedProject> project = open_project(arguments);
  vpe::explore::LastSession last;
  try {
    last = vpe::explore::read_session(files.session);
  } catch (const std::exception& e) {
    if (!common.quiet) std::fprintf(stderr, "vpe: note: %s\n", e.what());
  }
  window::check_display(make_setup(arguments, common, preferences, last).display);
  std::string file = recorded_path(arguments.planet);
  const bool may_be_coarse = arguments.planet.empty() && arguments.earlier.empty();
  auto planet = may_be_coarse ? coarse_embedded_planet(common) : nullptr;
  bool is_coarse = planet != nullptr;
  if (!is_coarse) planet = with_earlier(open_planet(arguments.planet, common), arguments.earlier, common);
  bool is_first = true;
  ExploreArguments here = arguments;
  std::optional<core::Settings> settings;
  while (planet != nullptr) {
    note_illustration(planet->meta(), common.quiet);
    make_interest_planetocentric(here.image.interest, here.latitude, planet->meta());
    window::ExploreSetup setup = make_setup(here, common, preferences, last);
    if (const ParsedPose named = here.pose.empty() ? ParsedPose{} : parse_pose("--pose", here.pose);
        !named.name.empty()) {
      setup.session.start = resolve(named, planet, setup.session.settings.values().exaggeration);
    } else if (!here.pose.empty()) {
      mars::Pose& start = *setup.session.start;
      start.lat_deg =
          planetocentric({start.lon_deg, start.lat_deg}, here.latitude, planet->meta(), common.quiet).lat_deg;
    }
    if (project) apply(*std::exchange(project, std::nullopt), here, setup);
    setup.planet_file = file;
    setup.reliefs_file = here.reliefs;
    if (!here.hotspots.empty()) setup.hotspots_file = std::filesystem::absolute(here.hotspots);
    if (is_first && !setup.session.start && last.planet == file) setup.session.start = last.pose;
    if (settings) setup.session.settings = *settings;
    is_first = false;
    const Common shared = common_of(common, given);
    static_cast<window::ShownPlanet&>(setup) = shown_planet(planet, shared, arguments.stereo);
    if (std::exchange(is_coarse, false)) {
      setup.make_finer = [common = shared, stereo = arguments.stereo](
                             const std::stop_token& stop,
                             const window::TellProgress& tell) -> std::optional<window::ShownPlanet> {
        auto complete = build_embedded_planet(common, stop, tell);
        if (complete == nullptr) return std::nullopt;
        return shown_planet(std::move(complete), common, stereo);
      };
    }
    add_places(planet->meta(), setup);
    setup.greets = here.pose.empty() && here.flight.empty();
    setup.command_line = [&file, planet](const vpe::explore::Session& session) {
      return command_line(file, *planet, session);
    };
    setup.display.title =
        "vpe - " + planet->meta().body + (planet->meta().illustration ? " (finest ground is synthetic)" : "");
    const auto keep = [&, keeps_letters = here.scale <= 0](const window::ExploreWindow& shown) {
      return keep_session(shown, file, files.session, keeps_letters, last);
    };
    setup.keep_session = [keep](const window::ExploreWindow& shown) { (void)keep(shown); };
    window::ExploreWindow shown(std::move(setup));
    shown.run();
    if (const std::string message = shown.exit_message(); !message.empty())
      std::fprintf(stderr, "vpe: note: %s\n", message.c_str());
    if (const std::string message = shown.drawings_message(); !message.empty())
      std::fprintf(stderr, "vpe: note: %s\n", message.c_str());
    if (const std::string message = shown.objects_message(); !message.empty())
      std::fprintf(stderr, "vpe: note: %s\n", message.c_str());
    if (const std::string message = shown.reliefs_message(); !message.empty())
      std::fprintf(stderr, "vpe: note: %s\n", message.c_str());
    for (const std::vector<std::string>& words : shown.unfinished())
      std::fprintf(stderr, "vpe: note: stopped with the window; this continues it: %s\n",
                   shell_line(words).c_str());
    // Flights, logs, hotspots and regions belong to one planet; the appearance stays for the next.
    here.pose = here.log = here.flight = here.hotspots = here.reliefs = "";
    here.image.interest.clear();
    here.names_backend = false;
    here.size = "";
    shown.session().leave_flight();
    here.fov_deg = shown.session().screen().fov_deg;
    settings = shown.session().settings();
    const std::string error = keep(shown);
    if (!error.empty() && !common.quiet) std::fprintf(stderr, "vpe: note: %s\n", error.c_str());
    planet = shown.next_planet();
    file = recorded_path(shown.next_planet_file());
    if (const std::filesystem::path next = shown.next_project(); !next.empty()) {
      here = ExploreArguments{};
      here.planet = next.string();
      here.screens = given.screens;
      here.head_scale = given.head_scale;
      here.print_settings = false;
      settings.reset();
      project = open_project(here);
    }
  }
}

#else

void explore(const ExploreArguments&, const Common&) {
  throw std::runtime_error(
      "this program was built without windows; install libglfw3-dev and libimgui-dev and build it again, or "
      "work without a window: 'vpe render' draws an image, 'vpe fly' a flight, 'vpe panorama' a panorama");
}

#endif

}  // namespace

void add_explore(CLI::App& program, Common& common) {
  auto arguments = std::make_shared<ExploreArguments>();
  CLI::App* command = add_command(program, "explore", "Fly over a planet in a window", common, false);
  command->add_option("PLANET", arguments->planet,
                      "Planet file, DEM, or project of this command, *.vpeproj (default: the embedded Mars)");
  command->add_option(
      "--compare", arguments->earlier,
      "Planet file or DEM: shown left of a line that the mouse drags, with PLANET on its right");
  command->add_option(
      "--pose", arguments->pose,
      "LON,LAT,ALT,YAW,PITCH,ROLL of the camera at the start: degrees; ALT in metres above the sphere; or the name of "
      "a place of Mars (default: a view of the whole planet)");
  add_latitude_option(*command, arguments->latitude);
  command->add_option("--size", arguments->size, "WIDTHxHEIGHT of the window, pixels (default: the last size)");
  command->add_option("--fov", arguments->fov_deg, "Vertical field of view, degrees")
      ->check(number_within(5, 120))
      ->capture_default_str();
  command->add_option("--scale", arguments->scale, "Scale of text and panels (default: the monitor's scale)")
      ->check(number_within(0.5, 4));
  command->add_option("--flight", arguments->flight, "Flight file to play and edit; edits are saved to it");
  command->add_option(
      "--reliefs", arguments->reliefs,
      "File of reliefs, *.relief.toml, that change the ground of the view; edited in the panel Ground");
  command->add_option(
      "--screens", arguments->screens,
      "File of screens, *.screens.toml: each gets a window that shows the world through it, for the head "
      "that the head tracker follows");
  command
      ->add_option(
          "--head-scale", arguments->head_scale,
          "Metres of the world for a metre of the head, with --screens: 1 for a walker, 10000 on a table "
          "(default: that of the file)")
      ->check(number_within(vpe::explore::ScreenLimits::kLeastScale, vpe::explore::ScreenLimits::kMostScale));
  command->add_option("--hotspots", arguments->hotspots, "File of hotspots: places with a panorama to open");
  command->add_option(
      "--log", arguments->log,
      "Record the session as a flight, with zoom, backend, stereo and window size; panoramas as comments");
  command->add_flag("--print-settings", arguments->print_settings, "Print the preferences in effect and exit");
  add_method_options(*command, arguments->stereo);
  add_render_options(*command, arguments->image);
  add_examples(*command,
               {{"the whole planet", "vpe explore mars.vpe"},
                {"before and after, on both sides of a line", "vpe explore after.vpe --compare before.vpe"},
                {"begin at a place, in ray casting, with shadows",
                 "vpe explore mars.vpe --pose -59.2,-13.7,8000,90,-10 --backend ray --set shadows=on"},
                {"try a crater and a dam on the ground, and save them",
                 "vpe explore mars.vpe --reliefs works.relief.toml"},
                {"continue a project that Ctrl+S has saved in the window", "vpe explore work.vpeproj"},
                {"the ground on a table, for a head that a webcam tracks",
                 "vpe explore mars.vpe --screens table.screens.toml"},
                {"record the session as a flight", "vpe explore mars.vpe --log session.flight"}});
  command->callback([arguments, command, &common] {
    arguments->names_backend = command->count("--backend") > 0;
    arguments->names_fov = command->count("--fov") > 0;
    if (arguments->head_scale > 0 && arguments->screens.empty())
      throw UsageError("--head-scale is for --screens FILE: without screens the head's place moves nothing");
    explore(*arguments, common);
  });
}

}  // namespace vpe::app
