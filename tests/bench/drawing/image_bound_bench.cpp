// Compares images with a bound by errors of blocks (paging/surface/tile_errors.h) with the former way, errors of whole tiles:
// what the closer bound costs, and what it states.
//
//   image_bound_bench PLANET.vpe [ROUNDS [WIDTHxHEIGHT]]
//   image_bound_bench PLANET.vpe count         # measures the tiles of one image alone, for callgrind
//
// A round draws, in turns, the first image with ranges of a new renderer both ways, and further ones. The linker leads calls of
// TileErrors::find() here (tests/bench/CMakeLists.txt), so one program has both ways. docs/measurements/error-and-time.md has
// the figures.
#include <cstdio>
#include <cstring>
#include <exception>

#include "paging/surface/tile_errors.h"
#include "tests/bench/drawing/compare_ways.h"
#include "tests/bench/drawing/places.h"
#include "vpe/base/number.h"
#include "vpe/gl/polygon_renderer.h"

namespace {

bool knows_blocks = true;  // false: the former way

}  // namespace

// The function, and what the linker leads its callers to. As members do, they take their object first.
paging::TileErrors::Pointer find_blocks(
    paging::TileErrors* errors, const lod::SelectedTile& tile,
    double exaggeration) __asm__("__real__ZN6paging10TileErrors4findERKN3lod12SelectedTileEd");
paging::TileErrors::Pointer find_either(
    paging::TileErrors* errors, const lod::SelectedTile& tile,
    double exaggeration) __asm__("__wrap__ZN6paging10TileErrors4findERKN3lod12SelectedTileEd");
paging::TileErrors::Pointer find_either(paging::TileErrors* errors, const lod::SelectedTile& tile,
                                        double exaggeration) {
  return knows_blocks ? find_blocks(errors, tile, exaggeration) : nullptr;
}

namespace {

namespace core = vpe::core;
namespace gl = vpe::gl;
using Planet = std::shared_ptr<const paging::PlanetFile>;

constexpr std::size_t kMemory = std::size_t{512} << 20;

void compare(const std::shared_ptr<gl::Context>& context, const Planet& planet, const char* name,
             const core::DrawRequest& request, int rounds) {
  double former_px = 0, now_px = 0;
  const auto draw = [&](bool by_blocks, core::Renderer& renderer) {
    knows_blocks = by_blocks;
    (by_blocks ? now_px : former_px) = renderer.draw(request).certificate.image_bound_px.value();
  };
  gl::RendererOptions options;
  options.memory_bytes = kMemory;
  const auto fresh = [&] { return gl::make_polygon_renderer(context, planet, options); };
  const bench::WayTimes first =
      bench::compare_ways([&] { draw(false, *fresh()); }, [&] { draw(true, *fresh()); }, rounds);
  const auto kept = fresh();
  const bench::WayTimes further =
      bench::compare_ways([&] { draw(false, *kept); }, [&] { draw(true, *kept); }, rounds);
  std::printf("| %s | %.3f; %.3f | %.0f | %.2f (%.2f..%.2f) | %.0f | %.2f (%.2f..%.2f) |\n", name, former_px,
              now_px, first.former_ms, first.ratio, first.least, first.most, further.former_ms, further.ratio,
              further.least, further.most);
  std::fflush(stdout);
}

void run(const Planet& planet, int rounds, int width, int height) {
  const std::shared_ptr<gl::Context> context = gl::Context::create();
  const paging::Surface surface(planet, std::size_t{64} << 20);
  std::printf("%s, %dx%d, %d rounds in turns, processor time\n\n", context->info().renderer.c_str(), width,
              height, rounds);
  std::puts(
      "| view | stated px, former; now | first image, former, ms | now / former | further image, former, ms | now / former "
      "|\n|---|---|---|---|---|---|");
  for (const bench::PlaceOfView& place : bench::kPlaces)
    compare(context, planet, place.name, bench::request_at(place, surface, width, height), rounds);
}

// Measures all tiles of the oblique view by blocks.
void count(const Planet& planet) {
  const paging::Surface surface(planet, std::size_t{64} << 20);
  const core::DrawRequest request = bench::request_at(bench::kPlaces[1], surface, 640, 360);
  lod::SelectScratch scratch;
  lod::Selection selection;
  lod::select({}, planet->tree(), lod::select_view(request.view), scratch, selection);
  paging::TileErrors errors(planet);
  int measured = 0;
  for (const lod::SelectedTile& tile : selection.tiles) measured += errors.find(tile, 1) ? 1 : 0;
  std::printf("%d of %zu tiles have errors by block\n", measured, selection.tiles.size());
}

}  // namespace

int main(int argc, char** argv) try {
  const bool counts = argc == 3 && std::strcmp(argv[2], "count") == 0;
  const auto rounds = argc > 2 && !counts ? vpe::base::parse_integer(argv[2]) : 5;
  int width = 640, height = 360;
  char rest = 0;
  if (argc < 2 || argc > 4 || !rounds || *rounds < 1 || *rounds > 10'000 ||
      (argc > 3 && std::sscanf(argv[3], "%dx%d%c", &width, &height, &rest) != 2)) {
    std::fputs(
        "usage: image_bound_bench PLANET.vpe [ROUNDS [WIDTHxHEIGHT]]\n"
        "       image_bound_bench PLANET.vpe count\n",
        stderr);
    return 2;
  }
  const Planet planet = paging::PlanetFile::open(argv[1]);
  if (counts) {
    count(planet);
  } else {
    run(planet, static_cast<int>(*rounds), width, height);
  }
  return 0;
} catch (const std::exception& e) {
  std::fprintf(stderr, "image_bound_bench: %s\n", e.what());
  return 1;
}
