// Compares tiles whose textures have a texel a pixel with the former way, a texel for each post at least, in images by
// triangles of a planet with imagery.
//
//   small_textures_bench PLANET.vpe [ROUNDS [WIDTHxHEIGHT [MODE]]]   # textured, coloured, or slope: coloured by slope
//   small_textures_bench PLANET.vpe count former|now      # makes textures of one image alone, for callgrind
//
// A round draws the first image of a new renderer both ways, in turns. Colours are compared with exact rays, one in each
// pixel and the mean of 8 x 8. The linker leads calls of paging::least_intervals() here (tests/bench/CMakeLists.txt), so one
// program has both ways. docs/measurements/error-and-time.md has the figures.
#include <atomic>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <exception>

#include "paging/shading/texel_block.h"
#include "tests/bench/drawing/compare_ways.h"
#include "tests/bench/drawing/places.h"
#include "vpe/base/number.h"
#include "vpe/gl/polygon_renderer.h"
#include "vpe/gl/tile_needs.h"
#include "vpe/voxel/ray_renderer.h"

namespace {

std::atomic<bool> keeps_posts = false;  // the former way

}  // namespace

// The function, and what the linker leads its callers to.
int least_intervals_now(const lod::TileKey& tile,
                        int post_intervals) __asm__("__real__ZN6paging15least_intervalsERKN3lod7TileKeyEi");
int least_intervals_either(const lod::TileKey& tile,
                           int post_intervals) __asm__("__wrap__ZN6paging15least_intervalsERKN3lod7TileKeyEi");
int least_intervals_either(const lod::TileKey& tile, int post_intervals) {
  return keeps_posts ? post_intervals : least_intervals_now(tile, post_intervals);
}

namespace {

namespace core = vpe::core;
namespace gl = vpe::gl;
using Planet = std::shared_ptr<const paging::PlanetFile>;

constexpr std::size_t kMemory = std::size_t{512} << 20;

// Returns the root mean square of the difference of colours, in steps of 8 bits.
double rms(const core::Frame& a, const core::Frame& b) {
  double sum = 0;
  for (std::size_t n = 0; n < a.colour.size(); ++n) {
    for (const auto channel : {&vpe::base::Rgb::r, &vpe::base::Rgb::g, &vpe::base::Rgb::b}) {
      const double off = a.colour[n].*channel - b.colour[n].*channel;
      sum += off * off;
    }
  }
  return std::sqrt(sum / (3.0 * static_cast<double>(a.colour.size())));
}

core::Frame by_rays(core::Renderer& renderer, core::DrawRequest request, int samples) {
  request.settings.samples = samples;
  return renderer.draw(request).frame;
}

void compare(const std::shared_ptr<gl::Context>& context, const Planet& planet, core::Renderer& rays,
             const char* name, core::DrawRequest request, int rounds) {
  const core::Frame one = by_rays(rays, request, 1);
  const core::Frame many = by_rays(rays, request, 8);
  request.want_range = false;
  gl::RendererOptions options;
  options.memory_bytes = kMemory;
  for (const double tolerance_px : {1.0, 0.5, 0.125}) {
    request.settings.lod_tolerance_px = tolerance_px;
    core::DrawResult former, now;
    const auto draw = [&](bool formerly, core::DrawResult& out) {
      keeps_posts = formerly;
      out = gl::make_polygon_renderer(context, planet, options)->draw(request);
    };
    const bench::WayTimes times =
        bench::compare_ways([&] { draw(true, former); }, [&] { draw(false, now); }, rounds);
    std::printf(
        "| %s, %g px | %.2f; %.2f | %.2f; %.2f (%.2f) | %.2f (%.2f..%.2f) | %.0f; %.0f, %.2f |\n", name,
        tolerance_px, rms(former.frame, one), rms(now.frame, one), rms(former.frame, many),
        rms(now.frame, many), rms(one, many), times.ratio, times.least, times.most,
        1e-6 * static_cast<double>(former.stats.bytes_resident),
        1e-6 * static_cast<double>(now.stats.bytes_resident),
        static_cast<double>(now.stats.bytes_resident) / static_cast<double>(former.stats.bytes_resident));
    std::fflush(stdout);
  }
}

// Returns whether MODE is one.
bool set_mode(const char* mode, core::DrawRequest& request) {
  if (std::strcmp(mode, "textured") == 0) return true;
  request.settings.mode = core::Mode::kColoured;
  if (std::strcmp(mode, "slope") == 0) request.settings.colour = core::Colour::kSlope;
  return std::strcmp(mode, "coloured") == 0 || request.settings.colour == core::Colour::kSlope;
}

void run(const Planet& planet, int rounds, int width, int height, const char* mode) {
  const std::shared_ptr<gl::Context> context = gl::Context::create();
  const auto rays = vpe::voxel::make_ray_renderer(planet, {.memory_bytes = kMemory});
  const paging::Surface surface(planet, std::size_t{64} << 20);
  std::printf("%s, %dx%d, %s, %d rounds in turns; former; now\n\n", context->info().renderer.c_str(), width,
              height, mode, rounds);
  std::puts(
      "| view, tolerance | RMS to rays | RMS to 8 x 8 rays a pixel (of one ray) | processor time, now / former | MB, now / "
      "former |\n|---|---|---|---|---|");
  for (const bench::PlaceOfView& place : bench::kPlaces) {
    core::DrawRequest request = bench::request_at(place, surface, width, height);
    set_mode(mode, request);
    compare(context, planet, *rays, place.name, request, rounds);
  }
}

// Makes the textures of the image from orbit at a tolerance of 0.125 px.
void count(const Planet& planet, bool formerly) {
  const paging::Surface surface(planet, std::size_t{64} << 20);
  const core::DrawRequest request = bench::request_at(bench::kPlaces[0], surface, 640, 360);
  lod::SelectOptions options;
  options.tolerance_px = 0.125;
  lod::SelectScratch scratch;
  lod::Selection selection;
  lod::select(options, planet->tree(), lod::select_view(request.view), scratch, selection);
  const paging::TerrainShader shader(planet, kMemory);
  const gl::NeedOptions needs{gl::material(request.settings, request.sun, true, nullptr), kMemory};
  keeps_posts = formerly;
  std::size_t bytes = 0, textures = 0;
  const auto wanted = gl::tile_needs(selection.tiles, request.view, *planet, shader, needs);
  for (std::size_t n = 0; n < wanted.size(); ++n) {
    if (wanted[n].texture <= 0) continue;
    bytes += shader.shade(selection.tiles[n].key, wanted[n].texture, needs.material.shading).bytes();
    ++textures;
  }
  std::printf("%zu textures, %.2f MB\n", textures, 1e-6 * static_cast<double>(bytes));
}

}  // namespace

int main(int argc, char** argv) try {
  const bool counts = argc > 2 && std::strcmp(argv[2], "count") == 0;
  const bool formerly = counts && argc == 4 && std::strcmp(argv[3], "former") == 0;
  const bool now = counts && argc == 4 && std::strcmp(argv[3], "now") == 0;
  const auto rounds = argc > 2 && !counts ? vpe::base::parse_integer(argv[2]) : 7;
  int width = 640, height = 360;
  char rest = 0;
  const char* const mode = argc > 4 ? argv[4] : "textured";
  core::DrawRequest any;
  if (argc < 2 || argc > 5 || !set_mode(mode, any) || (counts && !formerly && !now) || !rounds || *rounds < 1 ||
      *rounds > 10'000 ||
      (argc > 3 && !counts && std::sscanf(argv[3], "%dx%d%c", &width, &height, &rest) != 2)) {
    std::fputs(
        "usage: small_textures_bench PLANET.vpe [ROUNDS [WIDTHxHEIGHT [textured|coloured|slope]]]\n"
        "       small_textures_bench PLANET.vpe count former|now\n",
        stderr);
    return 2;
  }
  const Planet planet = paging::PlanetFile::open(argv[1]);
  if (planet->meta().finest_image_level < 0) throw std::runtime_error("the planet has no imagery");
  if (counts) {
    count(planet, formerly);
  } else {
    run(planet, static_cast<int>(*rounds), width, height, mode);
  }
  return 0;
} catch (const std::exception& e) {
  std::fprintf(stderr, "small_textures_bench: %s\n", e.what());
  return 1;
}
