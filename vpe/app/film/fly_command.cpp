#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>

#include "mars/geodesy/place_text.h"
#include "mars/sources/synthetic.h"
#include "objects/scene/track.h"
#include "paging/surface/surface.h"
#include "vpe/app/cli/examples.h"
#include "vpe/app/cli/interrupt.h"
#include "vpe/app/cli/json_output.h"
#include "vpe/app/cli/output.h"
#include "vpe/app/cli/program.h"
#include "vpe/app/film/commands.h"
#include "vpe/app/film/film_palette.h"
#include "vpe/app/film/film_session.h"
#include "vpe/app/picture/backend_choice.h"
#include "vpe/app/picture/carried_drawer.h"
#include "vpe/app/picture/image_options.h"
#include "vpe/app/picture/layer_check.h"
#include "vpe/app/picture/stereo_render.h"
#include "vpe/app/picture/sun_statement.h"
#include "vpe/app/picture/view_palette.h"
#include "vpe/app/planet/flight_ground.h"
#include "vpe/app/planet/planet_argument.h"
#include "vpe/base/number.h"
#include "vpe/core/appearance/layer_list.h"
#include "vpe/gl/context.h"

namespace vpe::app {

namespace fs = std::filesystem;

namespace {

constexpr double kMostReuse_px = 16;

// Returns the first of the words, separated by commas.
std::string list_of(const std::vector<std::string>& words) {
  constexpr std::size_t kMostWords = 8;
  std::string text;
  for (std::size_t n = 0; n < std::min(kMostWords, words.size()); ++n) text += (n > 0 ? ", " : "") + words[n];
  return words.size() > kMostWords ? text + " and " + std::to_string(words.size() - kMostWords) + " more"
                                   : text;
}

struct FlyArguments {
  std::string flight;
  std::string planet;
  std::string output;
  std::string frames;
  std::string part;
  std::string size;
  std::string log;
  std::string stats;
  bool force = false;
  bool allow_underground = false;
  bool join = false;
  StereoMethod stereo;
  double reuse_px = 0;  // 0: every frame is drawn in full
  RenderOptions image;
};

scripts::Flight flight_of(const FlyArguments& arguments) {
  scripts::Flight flight = read_flight(arguments.flight);
  if (!arguments.size.empty()) {
    const Size size = parse_size(arguments.size);
    flight.view.width = size.width;
    flight.view.height = size.height;
  }
  return flight;
}

// Throws std::runtime_error if the images of both eyes cannot have half the size of the film.
void require_halves(const std::string& file, const scripts::Flight& flight) {
  const auto has = [&](core::StereoLayout layout) {
    return std::ranges::any_of(flight.views, [layout](const scripts::ViewCommand& command) {
      return command.view.eyes && command.view.eyes->layout == layout;
    });
  };
  const auto refuse = [&](const char* eyes, const char* side, int side_px) {
    throw std::runtime_error(file + ": eyes=" + eyes + " has half the " + side + " for each eye, which " +
                             std::to_string(side_px) + " pixels do not allow: give an even one with --size");
  };
  if (has(core::StereoLayout::kSideBySide) && flight.view.width % 2 != 0)
    refuse("sbs", "width", flight.view.width);
  if (has(core::StereoLayout::kOverUnder) && flight.view.height % 2 != 0)
    refuse("ou", "height", flight.view.height);
}

// Returns the memory of the film's renderer: where pixels are carried, what carries them has a part of it.
int renderer_memory_mb(const FlyArguments& arguments, const Common& common, const scripts::Flight& flight) {
  const bool has_pairs = std::ranges::any_of(flight.views, [](const scripts::ViewCommand& command) {
    return command.view.eyes && command.view.eyes->layout;
  });
  return (arguments.stereo.carries() && has_pairs) || arguments.reuse_px > 0
             ? common.memory_mb - carrying_memory_mb(common.memory_mb)
             : common.memory_mb;
}

// Returns the files that the film reads, also those that settings of the flight name.
std::vector<fs::path> inputs_of(const FlyArguments& arguments, const scripts::Flight& flight,
                                core::Settings settings) {
  std::vector<fs::path> inputs{arguments.flight, arguments.planet};
  const auto add = [&] {
    inputs.emplace_back(settings.values().names);
    inputs.emplace_back(settings.values().palette);
    inputs.emplace_back(settings.values().scene);
    for (const core::LayerFile& layer : core::parse_layer_list(settings.values().layers))
      inputs.emplace_back(layer.path);
  };
  add();
  for (const scripts::SetCommand& set : flight.sets) {
    if (set.key.find("names") == std::string::npos && set.key != "palette" && set.key != "scene") continue;
    if (settings.set(set.key, set.text).empty()) add();
  }
  for (const scripts::PatchCommand& patch : flight.patches) inputs.emplace_back(patch.file);
  return inputs;
}

void check_film_files(const FlyArguments& arguments, const FilmRequest& request,
                      const std::vector<fs::path>& inputs) {
  std::vector<Output> outputs{{"--log", arguments.log, FileKind::kFlightLog},
                              {"--stats", arguments.stats, FileKind::kStatistics}};
  if (request.is_video) {
    outputs.push_back({"-o", request.output, FileKind::kVideo});
    outputs.push_back({"-o", manifest_of_video(request.output, {}, {}), FileKind::kManifest});
  } else {
    check_frame_files(request.output, request.range);
    check_kind(manifest_of_folder(request.output, request.frames, request.shard), FileKind::kManifest);
  }
  check_outputs(outputs, inputs);
}

FilmRequest film_request(const FlyArguments& arguments, const scripts::Flight& flight,
                         const core::Settings& settings) {
  const std::int64_t count = scripts::frame_count(flight.view.fps, scripts::duration_s(flight));
  if (count == 0) throw std::runtime_error(arguments.flight + ": the flight is shorter than one frame");
  FilmRequest request;
  request.output = arguments.output;
  request.format = {flight.view.width, flight.view.height, flight.view.fps};
  request.frames = arguments.frames;
  request.range = parse_frames(arguments.frames, count);
  request.shard = parse_shard(arguments.part);
  if (arguments.join && (!arguments.part.empty() || arguments.force))
    throw UsageError("--join joins all parts and draws nothing; leave --part and --force out");
  request.remake = arguments.force;
  request.is_video = check_film_output(arguments.output);
  check_film_files(arguments, request, inputs_of(arguments, flight, settings));
  return request;
}

// Throws std::runtime_error with time and place if the flight passes below the ground.
void require_above_ground(const std::string& flight, const FilmPlan& plan,
                          const scripts::ChangingTerrainHeight& terrain) {
  std::optional<scripts::Clearance> lowest;
  try {
    lowest = scripts::lowest_clearance(plan.path(), plan.view().fps, terrain);
  } catch (const paging::PlanetError& e) {
    // Frames that need the damaged tile will report it themselves.
    std::fprintf(stderr, "vpe: warning: cannot check whether %s stays above the terrain: %s\n", flight.c_str(),
                 e.what());
  }
  if (!lowest || lowest->height_m >= 0) return;
  throw std::runtime_error(flight + ": the camera passes " + base::format_rounded(-lowest->height_m, 2) +
                           " m below the ground at " + base::format_rounded(lowest->time_s, 3) + " s, " +
                           mars::place_text(lowest->place) +
                           "; raise the flight there (--allow-underground draws such frames in one colour)");
}

// Returns why there is no OpenGL, or nullopt if there is.
std::optional<std::string> opengl_problem() {
  try {
    if (!gl::has_gpu()) (void)gl::Context::create();
    return std::nullopt;
  } catch (const gl::ContextError& e) {
    return e.what();
  }
}

// Reports a bad gazetteer and bad vector files before the first frame.
void load_names(FrameOverlays& overlays, core::Settings settings, const scripts::Flight& flight) {
  overlays.load(settings.values());
  for (const scripts::SetCommand& set : flight.sets) {
    if (settings.set(set.key, set.text).empty()) overlays.load(settings.values());
  }
}

// Throws std::runtime_error if frames are missing that --join must not draw. Else notes what is missing of parts, and
// parts that have nothing to do.
void check_parts(const FlyArguments& arguments, const FilmSession& session, const Shard& shard, bool quiet) {
  const FilmCount n = count(session.frames());
  const std::string missing = session.missing_from_parts();
  if (arguments.join && n.done() < n.all) {
    throw std::runtime_error(
        arguments.output + ": " +
        (missing.empty() ? missing_text(session.kind(), session.frames(), std::nullopt) : missing) +
        "; make them with --part, or leave --join out to make them here");
  }
  if (quiet) return;
  if (!missing.empty()) {
    std::fprintf(stderr, "vpe: note: %s: %s; they are made now (--join would only name them)\n",
                 arguments.output.c_str(), missing.c_str());
  }
  if (shard.of > session.groups()) {
    const std::string groups = std::to_string(session.groups());
    std::fprintf(stderr, "vpe: note: %s has %s %s, so %s of %s parts have nothing to do; %s parts are enough\n",
                 arguments.output.c_str(), groups.c_str(),
                 session.kind().is_video
                     ? ("segments of " + std::to_string(session.kind().group_size) + " frames").c_str()
                     : "frames",
                 std::to_string(shard.of - session.groups()).c_str(), std::to_string(shard.of).c_str(),
                 groups.c_str());
  }
}

// Returns the backend that draws all frames, or "mixed".
std::string backend_text(const FilmPlan& plan, std::span<const FilmFrame> frames, core::Backend preferred) {
  std::set<std::string_view> names;
  for (const FilmFrame& frame : frames) names.insert(core::to_string(plan.at(frame.index).backend));
  if (names.empty()) return std::string(core::to_string(preferred));
  return names.size() > 1 ? "mixed" : std::string(*names.begin());
}

// Returns what changes the ground in a flight.
std::vector<std::string> names_of(const scripts::Path& path) {
  return path.ground() ? path.ground()->names() : std::vector<std::string>();
}

void report(const FlyArguments& arguments, const Common& common, const FilmSession& session, double seconds,
            bool illustration, const std::optional<SunStatement>& sun, const FilmPlan& plan) {
  const std::vector<FilmFrame>& frames = session.frames();
  if (common.json) {
    nlohmann::json summary = summary_json(frames, seconds);
    summary["output"] = arguments.output;
    summary["backend"] = backend_text(plan, frames, *arguments.image.backend);
    summary["illustration"] = illustration;
    summary["ground"] = names_of(plan.path());
    summary["sun"] = to_json(sun);
    summary["manifest"] =
        session.manifest().empty() ? nlohmann::json() : nlohmann::json(session.manifest().string());
    print_json(summary);
  }
  if (count(frames).failed > 0)
    throw std::runtime_error(failure_text(session.kind(), arguments.output, frames));
  if (common.json || common.quiet) return;
  std::printf("%s: %s\n", arguments.output.c_str(), summary_text(frames, seconds).c_str());
  if (session.is_left_unjoined()) {
    std::printf("When all parts exist, the same command without --part joins them.\n");
  }
}

// Throws if the flight moves an object that the scene of that time does not have.
void require_known_objects(const std::string& file, const scripts::Flight& flight, const scripts::Path& path,
                           const core::Settings& base) {
  std::map<std::string, objects::SceneFile> scenes;
  for (const scripts::ObjectCommand& command : flight.objects) {
    core::Settings settings = base;
    path.apply_settings(command.time_s, settings);
    const std::string& name = settings.values().scene;
    if (name.empty())
      throw std::runtime_error(file + ": the flight moves the object \"" + command.name + "\" at " +
                               base::format_number(command.time_s) +
                               " s, but there is no scene then; give --scene FILE");
    if (!scenes.contains(name)) scenes[name] = objects::read_scene_file(name);
    static_cast<void>(objects::track_target(scenes[name], {command.name, {}, {}}));
  }
}

// Returns what changes the ground of the planet in the flight; null if nothing does.
std::unique_ptr<FlightGround> ground_of(const FlyArguments& arguments, const Common& common,
                                        const scripts::Flight& flight,
                                        const std::shared_ptr<const paging::PlanetFile>& planet) {
  scripts::GroundTracks tracks;
  try {
    tracks = scripts::GroundTracks(flight, planet->radius_m());
  } catch (const std::runtime_error& e) {
    throw std::runtime_error(arguments.flight + ": " + e.what());
  }
  if (tracks.empty()) return nullptr;
  if (!common.quiet) {
    std::fprintf(stderr, "vpe: note: %s changes the ground of the planet (%s): an illustration\n",
                 arguments.flight.c_str(), list_of(tracks.names()).c_str());
  }
  return std::make_unique<FlightGround>(planet, std::move(tracks), arguments.flight, common);
}

// Returns what of the film's ground is made up, for its metadata.
std::string statement_of(const paging::PlanetMeta& meta, const FlightGround* ground) {
  std::string text = mars::synthetic_statement(meta.sources);
  if (ground == nullptr) return text;
  return text + (text.empty() ? "" : " ") +
         "The flight changes the ground: " + list_of(ground->tracks().names()) + ".";
}

struct PlannedFilm {
  core::Backend backend;
  FilmPlan plan;
};

// Returns true if rays can draw every frame as triangles would: nothing that the flight sets, however briefly,
// is about triangles or changes the tolerance. Sampling frames would miss short settings.
bool film_suits_rays(const FilmPlan& plan, const scripts::Flight& flight, const core::Settings& base) {
  if (!flight.interests.empty()) return false;
  core::DrawRequest request = plan.at(0).request;
  return std::all_of(flight.sets.begin(), flight.sets.end(), [&](const scripts::SetCommand& set) {
    core::Settings settings = base;
    plan.path().apply_settings(set.time_s, settings);
    request.settings = settings.values();
    return set.key != "lod.tolerance" && suits_rays(request);
  });
}

// Returns the plans of the film by its possible backends, the preferred one first: the backend of --backend, or
// the one that suits most frames, then the other. It draws all frames whose backend the flight does not name. Parts
// of a film may be made on different machines and must be alike, so polygons are preferred there.
std::vector<PlannedFilm> plan_film(const FlyArguments& arguments, const Common& common,
                                   const scripts::Flight& flight, const core::Settings& base,
                                   const std::shared_ptr<const paging::PlanetFile>& planet,
                                   const scripts::TerrainHeight& terrain, const ChangedPlanet& changed) {
  const RenderOptions& image = arguments.image;
  const std::int64_t count = scripts::frame_count(flight.view.fps, scripts::duration_s(flight));
  std::optional<std::vector<FilmPalette>> palettes;  // the same for every backend
  const std::map<std::string, std::string> stamps =
      ground_file_stamps(scripts::GroundTracks(flight, planet->radius_m()).files());
  const auto plan_of = [&](const BackendChoice& chosen) {
    PlannedFilm film{
        chosen.backend,
        FilmPlan(
            {version(), planet->meta().identity, chosen.backend, renderer_memory_mb(arguments, common, flight)},
            flight.view, scripts::Path(flight, planet->radius_m(), terrain, base.values().exaggeration),
            chosen.settings, parse_interest(image),
            {image.backend ? std::nullopt : std::optional(base), terrain,
             arguments.stereo.carries() ? std::optional(arguments.stereo.gap_px) : std::nullopt,
             arguments.reuse_px > 0 ? std::optional(arguments.reuse_px) : std::nullopt, stamps})};
    if (!palettes) palettes = film_palettes(film.plan, count, planet, common, changed);
    film.plan.take_palettes(*palettes);
    return film;
  };
  if (image.backend) return {plan_of({*image.backend, base})};
  std::vector<PlannedFilm> films{plan_of({core::Backend::kPolygon, base})};
  const FilmPlan& plan = films.front().plan;
  bool is_all_named = true;
  for (std::int64_t k = 0; k < count && is_all_named; ++k) is_all_named = plan.at(k).names_backend;
  if (is_all_named) return films;
  if (!film_suits_rays(plan, flight, base)) return films;
  if (const auto problem = opengl_problem()) {
    // Frames that triangles made elsewhere are found all the same.
    note_rays_instead(*problem, common.quiet);
    films.insert(films.begin(), plan_of(*rays_instead(image, base, {})));
    return films;
  }
  constexpr std::int64_t kMostSamples = 100;
  const std::int64_t samples = std::min(count, kMostSamples);
  std::vector<core::DrawRequest> images;
  for (std::int64_t k = 0; k < samples; ++k) images.push_back(plan.at(k * count / samples).request);
  const BackendChoice rays = choose_backend(image, base, images, planet->radius_m(), false);
  if (rays.backend != core::Backend::kRay) return films;
  films.push_back(plan_of(rays));
  if (arguments.part.empty() && !gl::has_gpu()) std::swap(films[0], films[1]);
  return films;
}

// Returns the plan of which an earlier run stored frames, else the preferred plan: a film that was begun by one
// backend is continued by it.
const PlannedFilm& select_plan(FilmSession& session, const std::vector<PlannedFilm>& films, int threads) {
  for (const PlannedFilm& film : films) {
    session.find_stored(film.plan, threads);
    if (count(session.frames()).kept > 0) return film;
  }
  if (films.size() > 1) session.find_stored(films.front().plan, threads);
  return films.front();
}

void fly(FlyArguments& arguments, const Common& common) {
  parse_interest(arguments.image);  // throws for wrong usage before any work
  const scripts::Flight flight = flight_of(arguments);
  require_halves(arguments.flight, flight);
  const core::Settings base = make_settings(arguments.image);
  const FilmRequest request = film_request(arguments, flight, base);

  const InterruptGuard guard;
  FilmSession session(request);  // reports a missing ffmpeg before the planet is built, which may take minutes
  const auto planet = open_planet(arguments.planet, common);
  const paging::PlanetMeta& meta = planet->meta();
  note_illustration(meta, common.quiet);
  require_layers(base.values(), *planet);
  require_layers(flight, *planet);
  const auto terrain = [surface = std::make_shared<paging::Surface>(planet, std::size_t{16} << 20)](
                           mars::LonLat place, double exaggeration) {
    return surface->at(mars::direction(place), exaggeration).height_m;
  };
  const std::unique_ptr<FlightGround> ground = ground_of(arguments, common, flight, planet);
  ChangedPlanet changed;
  if (ground) changed = [&](const scripts::GroundState& state) { return ground->planet(state); };
  const std::vector<PlannedFilm> films = plan_film(arguments, common, flight, base, planet, terrain, changed);
  const PlannedFilm& film = select_plan(session, films, common.threads);
  const FilmPlan& plan = film.plan;
  check_parts(arguments, session, request.shard, common.quiet);
  const bool is_named = arguments.image.backend.has_value();
  arguments.image.backend = film.backend;
  require_budget(base.values(), film.backend);
  const core::DrawRequest first = plan.at(0).request;
  require_known_sun(first.settings, meta.body);
  const auto sun = sun_statement(first.settings, mars::lon_lat(first.view.camera.position_m));
  if (!common.quiet) print_sun(sun);
  if (!common.quiet && needs_view_palette(base.values(), *planet)) {
    std::fprintf(stderr, "vpe: %s\n", palette_text(first.settings).c_str());
  }
  require_known_objects(arguments.flight, flight, plan.path(), base);
  if (!arguments.allow_underground) {
    require_above_ground(arguments.flight, plan, [&](mars::LonLat place, double exaggeration, double time_s) {
      return ground ? ground->height_m(place, exaggeration, time_s) : terrain(place, exaggeration);
    });
  }

  FrameOverlays overlays(planet);
  load_names(overlays, base, flight);
  FilmReports reports;
  if (!arguments.stats.empty()) reports.stats.emplace(arguments.stats);
  if (!arguments.log.empty())
    reports.log.emplace(arguments.log, flight.view, scripts::LineFile::Mode::kWhole,
                        scripts::version_of(flight));
  if (reports.log) reports.log->objects(flight.objects);
  if (reports.log) reports.log->ground(flight.reliefs, flight.patches);
  auto start = std::chrono::steady_clock::now();
  bool is_begun = false;
  Common rest = common;
  rest.memory_mb = renderer_memory_mb(arguments, common, flight);
  const auto renderer = [&](core::Backend backend) {
    RenderOptions options = arguments.image;
    options.backend = backend;
    std::unique_ptr<core::Renderer> made;
    try {
      made = make_renderer(options, rest, planet);
    } catch (const gl::ContextError& e) {
      if (is_named || flight.views.empty()) throw;
      throw std::runtime_error(std::string(e.what()) + "; --backend ray draws all frames by rays");
    }
    if (!is_begun) start = std::chrono::steady_clock::now();  // the rate counts drawing and encoding only
    is_begun = true;
    return made;
  };
  const auto carried = [&](core::Renderer& first_images, CarriedDrawerOptions options) {
    options.memory_bytes =
        std::size_t{1048576} * static_cast<std::size_t>(carrying_memory_mb(common.memory_mb));
    options.threads = common.threads;
    return std::make_unique<CarriedDrawer>(first_images, planet, options);
  };
  session.make(plan, reports, arguments.image, {renderer, carried, changed}, overlays, common.quiet);
  if (!common.quiet) print_failures(reports.failures);
  if (ground && !common.quiet && count(session.frames()).made > 0 && ground->is_coarser()) {
    std::fprintf(
        stderr,
        "vpe: note: the ground that %s changes has coarser posts than it asks for, since a patch has a limit of "
        "tiles; spacing= in its reliefs says what they are\n",
        arguments.flight.c_str());
  }
  if (reports.log) reports.log->end(scripts::duration_s(flight));
  if (reports.stats) reports.stats->close();
  const bool illustration = meta.illustration || ground;
  session.finish({version(), meta.identity, illustration, statement_of(meta, ground.get()),
                  fs::path(arguments.flight).filename().string(), flight.view.fps, flight.view.width,
                  flight.view.height, arguments.frames, request.shard, plan.palettes(), names_of(plan.path())});
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  report(arguments, common, session, seconds, illustration, sun, plan);
}

}  // namespace

void add_fly(CLI::App& program, Common& common) {
  auto arguments = std::make_shared<FlyArguments>();
  CLI::App* command =
      add_command(program, "fly",
                  "Draw a scripted flight as a video or as frames; continues an interrupted run", common, true);
  command->add_option("FLIGHT", arguments->flight, "Flight file")->required();
  command->add_option("PLANET", arguments->planet, "Planet file or DEM (default: the embedded Mars)");
  command->add_option("-o,--output", arguments->output, "Video (.mp4), or folder for PNG frames")->required();
  command->add_option("--frames", arguments->frames,
                      "A-B or A-BxN: draw only frames A to B, or every N-th of them");
  command->add_option(
      "--part", arguments->part,
      "k/n: draw only the k-th of n parts; auto/n: take k from the variables of SLURM or MPI; auto: k and n");
  command->add_flag(
      "--join", arguments->join,
      "Draw nothing: join the parts of a video, or check those of a folder; names missing frames");
  command->add_flag("--force", arguments->force, "Draw every frame again, also those of an earlier run");
  command->add_option(
      "--size", arguments->size,
      "WIDTHxHEIGHT of all frames, pixels (default: the size of the first view in the flight). With eyes=sbs or "
      "eyes=ou in the flight, each eye has half of it; the vertical field of view stays");
  command->add_option("--log", arguments->log, "Write the flown poses as a flight");
  command->add_option("--stats", arguments->stats, "Write one row of figures per frame (.csv, .jsonl)");
  command->add_flag("--allow-underground", arguments->allow_underground,
                    "Draw frames below the ground in one colour, instead of failing before the first frame");
  add_method_options(*command, arguments->stereo);
  command
      ->add_option("--reuse", arguments->reuse_px,
                   "Let frames take pixels of the last key frame (every " + std::to_string(kKeyFrames) +
                       "th) where these are off by this many pixels at most; 0: draw every frame in full")
      ->check(number_within(0, kMostReuse_px))
      ->capture_default_str();
  add_render_options(*command, arguments->image);
  add_examples(*command, {{"a video; the same command continues a stopped one",
                           "vpe fly valles.flight mars.vpe -o film.mp4"},
                          {"a quick look: every 45th frame, small",
                           "vpe fly valles.flight mars.vpe -o preview --frames 0-299x45 --size 480x270"},
                          {"frames that take what they can from the last key frame",
                           "vpe fly valles.flight mars.vpe -o film.mp4 --reuse 0.5"},
                          {"one of four machines", "vpe fly valles.flight mars.vpe -o film.mp4 --part 1/4"}});
  command->callback([arguments, &common] { fly(*arguments, common); });
}

}  // namespace vpe::app
