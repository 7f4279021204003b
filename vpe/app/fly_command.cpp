#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "paging/surface.h"
#include "scripts/log.h"
#include "scripts/path.h"
#include "scripts/stats.h"
#include "vpe/app/frame_sink.h"
#include "vpe/app/interrupt.h"
#include "vpe/app/output.h"
#include "vpe/app/picture_options.h"
#include "vpe/app/planet_argument.h"
#include "vpe/app/program.h"
#include "vpe/app/progress.h"
#include "vpe/app/report.h"
#include "vpe/app/video.h"
#include "vpe/core/image.h"
#include "vpe/core/number.h"

namespace vpe::app {

namespace fs = std::filesystem;

namespace {

struct FlyArguments {
  std::string flight;
  std::string planet;
  std::string output;
  std::string frames;
  std::string size;
  std::string log;
  std::string stats;
  PictureOptions picture;
};

scripts::Flight read_flight(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in)
    throw std::runtime_error(path + ": cannot open the flight: " + std::strerror(errno) + "; check the name");
  std::ostringstream text;
  text << in.rdbuf();
  scripts::ParsedFlight parsed = scripts::parse_flight(text.str(), path);
  if (parsed.flight) return *parsed.flight;
  std::string all;
  for (const scripts::FlightError& e : parsed.errors)
    all += (all.empty() ? "" : "\n     ") + scripts::to_string(e);
  throw std::runtime_error(all);
}

struct FrameRange {
  std::int64_t first = 0;
  std::int64_t last = 0;
  std::int64_t step = 1;
};

// "A-B", "A-BxN" or "A"; both ends included.
FrameRange parse_frames(const std::string& text, std::int64_t count) {
  FrameRange range{0, count - 1, 1};
  if (text.empty()) return range;
  std::string_view rest = text;
  std::optional<std::int64_t> first;
  std::optional<std::int64_t> last;
  std::optional<std::int64_t> step = 1;
  if (const std::size_t x = rest.find('x'); x != std::string_view::npos) {
    step = core::parse_integer(rest.substr(x + 1));
    rest = rest.substr(0, x);
  }
  const std::size_t dash = rest.find('-');
  first = core::parse_integer(rest.substr(0, dash));
  last = dash == std::string_view::npos ? first : core::parse_integer(rest.substr(dash + 1));
  if (!first || !last || !step || *step < 1 || *first < 0 || *last < *first || *last >= count) {
    throw UsageError("--frames '" + text + "': expected A-B or A-BxN within 0-" + std::to_string(count - 1));
  }
  return {*first, *last, *step};
}

void fly(FlyArguments& arguments, const Common& common) {
  scripts::Flight flight = read_flight(arguments.flight);
  if (!arguments.size.empty()) {
    const Size size = parse_size(arguments.size);
    flight.view.width = size.width;
    flight.view.height = size.height;
  }
  core::Settings base = make_settings(arguments.picture);
  const std::int64_t count = scripts::frame_count(flight.view.fps, scripts::duration_s(flight));
  if (count == 0) throw std::runtime_error(arguments.flight + ": the flight is shorter than one frame");
  const FrameRange range = parse_frames(arguments.frames, count);
  const bool film = check_film_output(arguments.output);
  if (!arguments.log.empty()) check_output(arguments.log);
  if (!arguments.stats.empty()) check_stats_output(arguments.stats);

  // ffmpeg is started first: a planet may be minutes of work.
  const InterruptGuard guard;
  std::optional<VideoWriter> video;
  if (film) video.emplace(arguments.output, flight.view.width, flight.view.height, flight.view.fps);
  const auto planet = open_planet(arguments.planet, common);
  note_illustration(planet->meta(), common.quiet);
  const auto terrain = [surface = std::make_shared<paging::Surface>(planet, std::size_t{16} << 20)](
                           mars::LonLat place) { return surface->at(mars::direction(place)).height_m; };
  const scripts::Path path(flight, planet->radius_m(), terrain, base.values().exaggeration);
  if (const auto lowest = scripts::lowest_clearance(path, flight.view.fps, terrain);
      lowest && lowest->height_m < 0 && !common.quiet) {
    std::fprintf(stderr, "vpe: warning: %s passes %.0f m under the terrain at %.2f s\n",
                 arguments.flight.c_str(), -lowest->height_m, lowest->time_s);
  }

  const auto renderer = make_renderer(arguments.picture, common, planet);
  std::optional<scripts::StatsWriter> stats;
  if (!arguments.stats.empty()) stats.emplace(arguments.stats);
  std::optional<scripts::FlightLog> log;
  if (!arguments.log.empty()) log.emplace(arguments.log, flight.view);
  if (!film) make_folder(arguments.output);

  const auto write = [&](std::int64_t index, const core::Frame& frame) {
    if (video) {
      video->add(frame);
      return;
    }
    char name[32];
    std::snprintf(name, sizeof name, "frame_%06lld.png", static_cast<long long>(index));
    core::write_image((fs::path(arguments.output) / name).string(), frame.colour, frame.width, frame.height);
  };
  FrameSink sink(write, 3);
  ProgressLine line(common.quiet);
  const auto start = std::chrono::steady_clock::now();
  std::int64_t done = 0;
  double worst_px = 0;
  std::int64_t triangles = 0;
  const std::int64_t total = (range.last - range.first) / range.step + 1;
  for (std::int64_t k = range.first; k <= range.last; k += range.step) {
    InterruptGuard::check();
    const double t = scripts::frame_time(flight.view.fps, k);
    core::Settings settings = base;
    path.apply_settings(t, settings);
    const scripts::FlightState state = path.at(t);
    core::DrawRequest request;
    request.view.eye = state.eye;
    request.view.width = flight.view.width;
    request.view.height = flight.view.height;
    request.view.fov_deg = flight.view.fov_deg;
    request.settings = settings.values();
    // The sun stands still: its azimuth and elevation are those at the ground below the flight's start.
    request.sun = sun_for(request.settings, path.at(0.0).pose);
    core::DrawResult result = renderer->draw(request);
    if (log) log->frame(t, state.pose, state.look, settings);
    if (stats) stats->row(k, t, result.stats, result.certificate);
    worst_px = std::max(worst_px, result.certificate.shift_bound_px);
    triangles += result.stats.triangles;
    sink.push(k, std::move(result.frame));
    ++done;
    line.show("frame " + std::to_string(done) + " of " + std::to_string(total),
              static_cast<double>(done) / static_cast<double>(total));
  }
  sink.finish();
  if (video) video->close();
  if (log) log->end(scripts::duration_s(flight));
  if (stats) stats->close();
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (common.json) {
    nlohmann::json json{{"output", arguments.output},
                        {"frames", done},
                        {"seconds", seconds},
                        {"shift_bound_px", worst_px},
                        {"mean_triangles", triangles / std::max<std::int64_t>(done, 1)},
                        {"illustration", planet->meta().illustration}};
    print_json(json);
  } else if (!common.quiet) {
    std::printf("%s: %lld frames, %.1f frames/s, geometry within %.2f px\n", arguments.output.c_str(),
                static_cast<long long>(done), static_cast<double>(done) / seconds, worst_px);
  }
}

}  // namespace

void add_fly(CLI::App& program, Common& common) {
  auto arguments = std::make_shared<FlyArguments>();
  CLI::App* command =
      add_command(program, "fly", "Draw a scripted flight as a video or as frames", common, true);
  command->add_option("FLIGHT", arguments->flight, "Flight file")->required();
  command->add_option("PLANET", arguments->planet, "Planet file or DEM; the embedded Mars when left out");
  command->add_option("-o,--output", arguments->output, "Video (.mp4) or folder for PNG frames")->required();
  command->add_option("--frames", arguments->frames, "A-B or A-BxN: only these frames");
  command->add_option("--size", arguments->size, "WIDTHxHEIGHT instead of the flight's own");
  command->add_option("--log", arguments->log, "Write what was flown as a flight");
  command->add_option("--stats", arguments->stats, "Write one row of figures a frame (.csv, .jsonl)");
  add_picture_options(*command, arguments->picture);
  command->callback([arguments, &common] { fly(*arguments, common); });
}

}  // namespace vpe::app
