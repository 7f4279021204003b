// Time of frames that do not wait against the same frames with all tiles resident. docs/measurements/paging.md
// has the figures.
//
//   paging_bench PLANET.vpe [FLIGHT] [WIDTHxHEIGHT] [ROUNDS] [MEMORY_MB]
//
// A round flies the flight twice, each time with a new renderer. Paged: frame n shows the pose at n / 30 s at
// once, and the poses 0.25 s and 1 s ahead are upcoming. Preloaded: each pose is drawn complete first, which is
// not timed, and then drawn again, timed. Time of flight is virtual, loading is not: a frame that takes 50 ms
// gives the loaders 50 ms, not the film's 33 ms.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <numeric>
#include <string>
#include <vector>

#include "mars/geodesy/sun.h"
#include "paging/surface/surface.h"
#include "scripts/path.h"
#include "tests/bench/flight.h"
#include "vpe/base/heap.h"
#include "vpe/base/number.h"
#include "vpe/base/quantile.h"
#include "vpe/gl/polygon_renderer.h"

namespace {

using Clock = std::chrono::steady_clock;
using vpe::core::DrawRequest;
using vpe::core::DrawResult;

constexpr double kFps = 30;
constexpr double kFrame_ms = 33;
constexpr double kAhead_s[] = {0.25, 1.0};

class Film {
 public:
  Film(const scripts::Flight& flight, const paging::Surface& surface, int width, int height)
      : view_(flight.view),
        path_(bench::path_over(flight, surface)),
        width_(width),
        height_(height),
        frames_(static_cast<int>(scripts::duration_s(flight) * kFps)) {}

  int frames() const { return frames_; }

  DrawRequest at(int frame) const {
    const double t = frame / kFps;
    DrawRequest request;
    request.view = view(t);
    for (const double ahead : kAhead_s) request.paging.upcoming.push_back(view(t + ahead));
    vpe::core::Settings settings;
    path_.apply_settings(t, settings);
    request.settings = settings.values();
    const mars::Pose start = path_.at(0).pose;
    request.sun = mars::sun_direction({start.lon_deg, start.lat_deg}, request.settings.sun_azimuth_deg,
                                      request.settings.sun_elevation_deg);
    return request;
  }

 private:
  vpe::core::View view(double t) const {
    vpe::core::View out;
    out.camera = path_.at(t).camera;
    out.fov_deg = view_.fov_deg;
    out.width = width_;
    out.height = height_;
    return out;
  }

  scripts::FlightView view_;
  scripts::Path path_;
  int width_;
  int height_;
  int frames_;
};

double quantile(std::vector<double> values, double share) { return vpe::base::quantile_round(values, share); }

// Times and counts of one flight's frames.
struct Times {
  std::vector<double> frame_ms;
  double select_ms = 0, load_ms = 0, draw_ms = 0, read_ms = 0;
  int incomplete = 0;              // frames with missing tiles
  double missing = 0, wanted = 0;  // tiles, all frames together

  void add(double ms, const DrawResult& result) {
    const vpe::core::FrameStats& s = result.stats;
    frame_ms.push_back(ms);
    select_ms += s.select_ms;
    load_ms += s.load_ms;
    draw_ms += s.draw_ms;
    read_ms += s.read_ms;
    incomplete += s.tiles_missing > 0 ? 1 : 0;
    missing += s.tiles_missing;
    wanted += s.tiles_missing + s.tiles_drawn - s.tiles_substituted;
  }
  double total_ms() const { return std::accumulate(frame_ms.begin(), frame_ms.end(), 0.0); }
  double jank_ms() const {
    double sum = 0;
    for (const double ms : frame_ms) sum += std::max(0.0, ms - kFrame_ms);
    return sum;
  }
};

template <class Draw>
std::pair<double, DrawResult> timed(Draw&& draw) {
  const auto start = Clock::now();
  DrawResult result = draw();
  return {std::chrono::duration<double, std::milli>(Clock::now() - start).count(), std::move(result)};
}

Times fly_paged(const Film& film, vpe::core::Renderer& renderer) {
  Times times;
  for (int n = 0; n < film.frames(); ++n) {
    DrawRequest request = film.at(n);
    request.paging.wait = false;
    const auto [ms, result] = timed([&] { return renderer.draw(request); });
    times.add(ms, result);
  }
  return times;
}

Times fly_preloaded(const Film& film, vpe::core::Renderer& renderer) {
  Times times;
  for (int n = 0; n < film.frames(); ++n) {
    DrawRequest request = film.at(n);
    request.paging.upcoming.clear();
    renderer.draw(request);
    const auto [ms, result] = timed([&] { return renderer.draw(request); });
    times.add(ms, result);
  }
  return times;
}

void print(const char* name, const Times& t) {
  const double frames = static_cast<double>(t.frame_ms.size());
  std::printf("| %s | %.1f | %.1f | %.1f | %.0f | %.0f | %.1f | %.2f / %.2f / %.2f / %.2f | %.1f | %.1f |\n",
              name, quantile(t.frame_ms, 0.5), quantile(t.frame_ms, 0.95), quantile(t.frame_ms, 1), t.jank_ms(),
              t.total_ms(), 100 * t.select_ms / t.total_ms(), t.select_ms / frames, t.load_ms / frames,
              t.draw_ms / frames, t.read_ms / frames, 100.0 * t.incomplete / frames,
              100 * t.missing / std::max(1.0, t.wanted));
  std::fflush(stdout);
}

int run(const char* planet_file, const char* flight_file, int width, int height, int rounds, int memory_mb) {
  const auto planet = paging::PlanetFile::open(planet_file);
  const paging::Surface surface(planet, std::size_t{64} << 20);
  const Film film(bench::read_flight(flight_file), surface, width, height);
  vpe::base::keep_heap_compact();  // as `vpe` does
  const std::shared_ptr<vpe::gl::Context> context = vpe::gl::Context::create();
  std::printf("%s, %d frames of %dx%d, %d MB\n\n", context->info().renderer.c_str(), film.frames(), width,
              height, memory_mb);
  std::printf(
      "| run | median ms | p95 | longest | jank ms | total ms | select %% | select / load / draw / read, mean "
      "ms | incomplete frames %% | tiles missing %% |\n|---|---|---|---|---|---|---|---|---|---|\n");
  const vpe::gl::RendererOptions options{static_cast<std::size_t>(memory_mb) << 20, 0, {}};
  std::vector<double> jank, jank_preloaded, total, median, p95, select;
  for (int round = 0; round < rounds; ++round) {
    const Times paged = fly_paged(film, *vpe::gl::make_polygon_renderer(context, planet, options));
    print("paged", paged);
    const Times loaded = fly_preloaded(film, *vpe::gl::make_polygon_renderer(context, planet, options));
    print("preloaded", loaded);
    jank.push_back(paged.jank_ms());
    jank_preloaded.push_back(loaded.jank_ms());
    total.push_back(paged.total_ms() / loaded.total_ms());
    median.push_back(quantile(paged.frame_ms, 0.5) / quantile(loaded.frame_ms, 0.5));
    p95.push_back(quantile(paged.frame_ms, 0.95) / quantile(loaded.frame_ms, 0.95));
    select.push_back(100 * paged.select_ms / paged.total_ms());
  }
  const double allowed = 1.5 * quantile(jank_preloaded, 0.5) + 100;
  std::printf(
      "\nmedians of %d rounds, paged : preloaded: total %.2f (aim 1.2), median %.2f, p95 %.2f; jank %.0f ms : "
      "%.0f ms (aim at most %.0f); select and cull %.1f %% of the paged frames (aim below 5)\n",
      rounds, quantile(total, 0.5), quantile(median, 0.5), quantile(p95, 0.5), quantile(jank, 0.5),
      quantile(jank_preloaded, 0.5), allowed, quantile(select, 0.5));
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  const char* flight = argc > 2 ? argv[2] : "scripts/flights/valles-marineris.flight";
  int width = 640, height = 360;
  char rest = 0;
  const bool sized = argc <= 3 || std::sscanf(argv[3], "%dx%d%c", &width, &height, &rest) == 2;
  const auto rounds = argc > 4 ? vpe::base::parse_integer(argv[4]) : 5;
  const auto memory_mb = argc > 5 ? vpe::base::parse_integer(argv[5]) : 1024;
  if (argc < 2 || argc > 6 || !sized || width < 1 || height < 1 || !rounds || *rounds < 1 || !memory_mb ||
      *memory_mb < 64) {
    std::fprintf(stderr, "usage: paging_bench PLANET.vpe [FLIGHT] [WIDTHxHEIGHT] [ROUNDS] [MEMORY_MB]\n");
    return 2;
  }
  try {
    return run(argv[1], flight, width, height, static_cast<int>(*rounds), static_cast<int>(*memory_mb));
  } catch (const std::exception& e) {
    std::fprintf(stderr, "paging_bench: %s\n", e.what());
    return 1;
  }
}
