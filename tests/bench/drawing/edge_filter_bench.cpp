// Compares the filter of edges (vpe/core/image/edge_filter.h) with its former code, on images by rays.
//
//   edge_filter_bench PLANET.vpe [ROUNDS [WIDTHxHEIGHT]]
//
// One thread. Both filter the same images in turns, and must give equal bits. docs/measurements/films.md has the figures.
// For counts of instructions run it for one round under `valgrind --tool=callgrind`, with --toggle-collect of
// bench::smooth_edges_formerly* or of vpe::core::smooth_edges*: two rounds of five images.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/bench/drawing/compare_ways.h"
#include "tests/bench/drawing/former_edge_filter.h"
#include "tests/bench/drawing/places.h"
#include "vpe/base/number.h"
#include "vpe/core/image/edge_filter.h"
#include "vpe/core/ray_lengths.h"
#include "vpe/voxel/ray_renderer.h"

namespace {

namespace core = vpe::core;
using vpe::base::Rgb;

// Returns the share of pixels, but for those of the border, that the filter takes for edges.
double edges_percent(const std::vector<float>& depth, int width, int height) {
  std::size_t edges = 0;
  for (int y = 1; y + 1 < height; ++y) {
    for (int x = 1; x + 1 < width; ++x) {
      const float* const at =
          &depth[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)];
      const float west = at[-1], east = at[1], north = at[-width], south = at[width];
      const float bend = std::abs(west + east - 2 * *at) + std::abs(north + south - 2 * *at);
      edges += bend > core::kEdgeBend * std::max({west, east, north, south}) ? 1 : 0;
    }
  }
  return 100.0 * static_cast<double>(edges) / static_cast<double>(depth.size());
}

// Filters an image by both codes in turns, and prints a row.
void compare(const std::string& name, const core::Frame& frame, const std::vector<float>& inverse_depth,
             int rounds) {
  vpe::base::ThreadPool pool(1);
  std::vector<Rgb> former, now;
  bool is_former = true;
  const bench::WayTimes times = bench::compare_ways(
      [&] { bench::smooth_edges_formerly(former, inverse_depth, frame.width, frame.height, pool); },
      [&] { core::smooth_edges(now, inverse_depth, frame.width, frame.height, pool); }, rounds,
      [&] {
        (is_former ? former : now) = frame.colour;
        is_former = !is_former;
      });
  if (former != now) throw std::runtime_error(name + ": the filters give other bits");
  std::printf("| %s | %.2f | %.2f | %.2f | %.2f (%.2f..%.2f) |\n", name.c_str(),
              edges_percent(inverse_depth, frame.width, frame.height), times.former_ms, times.now_ms,
              times.ratio, times.least, times.most);
}

void run(const char* file, int rounds, int width, int height) {
  const auto planet = paging::PlanetFile::open(file);
  const paging::Surface surface(planet, std::size_t{64} << 20);
  const auto renderer = vpe::voxel::make_ray_renderer(planet, {.memory_bytes = std::size_t{512} << 20});
  vpe::base::ThreadPool pool(1);
  std::printf("%dx%d, %d rounds in turns, processor time of one thread\n\n", width, height, rounds);
  std::puts("| view | edges, % of pixels | former, ms | now, ms | now / former |\n|---|---|---|---|---|");
  core::Frame frame;
  std::vector<float> inverse_depth;
  for (const bench::PlaceOfView& place : bench::kPlaces) {
    const core::DrawRequest request = bench::request_at(place, surface, width, height);
    frame = renderer->draw(request).frame;
    inverse_depth.resize(frame.range_m.size());
    core::inverse_depths(request.view, frame.range_m, pool, inverse_depth);
    compare(place.name, frame, inverse_depth, rounds);
  }
  for (std::size_t n = 0; n < inverse_depth.size(); ++n)
    inverse_depth[n] = n % static_cast<std::size_t>(width) / 16 % 2 == 0 ? 0.5F : 0.4F;
  compare("the last one behind bars of 16 pixels", frame, inverse_depth, rounds);
}

}  // namespace

int main(int argc, char** argv) try {
  const auto rounds = argc > 2 ? vpe::base::parse_integer(argv[2]) : 15;
  int width = 1280, height = 720;
  char rest = 0;
  if (argc < 2 || argc > 4 || !rounds || *rounds < 1 || *rounds > 10'000 ||
      (argc > 3 && std::sscanf(argv[3], "%dx%d%c", &width, &height, &rest) != 2) || width < 1 || height < 1) {
    std::fputs("usage: edge_filter_bench PLANET.vpe [ROUNDS [WIDTHxHEIGHT]]\n", stderr);
    return 2;
  }
  run(argv[1], static_cast<int>(*rounds), width, height);
  return 0;
} catch (const std::exception& e) {
  std::fprintf(stderr, "edge_filter_bench: %s\n", e.what());
  return 1;
}
