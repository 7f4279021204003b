// Times views of panoramas: the places of their pixels, against places computed pixel by pixel, and whole images.
//   view_bench [ROUNDS]
//   view_bench count pixels|rows
// Prints for each kind of image, for 1280 x 720 pixels and a field of view of 60 degrees, the processor time of one thread. "count"
// finds the places of one view of each kind, for `valgrind --tool=callgrind --toggle-collect=*counted_places*`.
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include "panorama/viewer/render_view.h"
#include "panorama/viewer/view_places.h"
#include "panorama/viewer/viewer.h"
#include "tests/bench/compare_rounds.h"

namespace {

constexpr int kTile_px = 256;

// Serves levels of one tile, shown everywhere.
class PatternTiles : public panorama::TileSource {
 public:
  explicit PatternTiles(const panorama::PanoramaMap& map) : tile_(std::make_shared<panorama::Tile>()) {
    for (std::int64_t side = 1; map.width_px / side > kTile_px; side *= 2)
      levels_.push_back({map.width_px / side, map.height_px / side, kTile_px, kTile_px});
    tile_->width_px = tile_->height_px = kTile_px;
    for (int n = 0; n < kTile_px * kTile_px; ++n) {
      const auto value = static_cast<std::uint8_t>(n * 37 % 251);
      tile_->pixels.push_back({value, value, value});
    }
  }
  const std::vector<panorama::ImageLevel>& levels() const override { return levels_; }
  std::shared_ptr<const panorama::Tile> read(int /*level*/, std::int64_t /*column*/,
                                             std::int64_t /*row*/) const override {
    return tile_;
  }

 private:
  std::vector<panorama::ImageLevel> levels_;
  std::shared_ptr<panorama::Tile> tile_;
};

vpe::core::View bench_view() { return panorama::view_of(33.0, -5.0, 60.0, 1280, 720); }

// Return the sum of the first places of rows. They have names of their own for callgrind.
__attribute__((noinline)) double counted_places_by_pixel(const panorama::PanoramaMap& map,
                                                         const vpe::core::View& view,
                                                         std::vector<glm::dvec2>& row) {
  double sum_px = 0;
  for (int y = 0; y < view.height; ++y) {
    for (std::size_t x = 0; x < row.size(); ++x)
      row[x] =
          map.place(panorama::to_direction(vpe::core::pixel_ray(view, static_cast<double>(x) + 0.5, y + 0.5)));
    sum_px += row.front().x;
  }
  return sum_px;
}

__attribute__((noinline)) double counted_places_by_rows(const panorama::PanoramaMap& map,
                                                        const vpe::core::View& view,
                                                        std::vector<glm::dvec2>& row) {
  double sum_px = 0;
  const panorama::ViewPlaces places(map, view);
  for (int y = 0; y < view.height; ++y) {
    places.row(y, row);
    sum_px += row.front().x;
  }
  return sum_px;
}

void bench_map(const panorama::PanoramaMap& map, int rounds) {
  const vpe::core::View view = bench_view();
  const panorama::TiledImage image(std::make_unique<PatternTiles>(map), std::size_t{64} << 20);
  std::vector<glm::dvec2> row(static_cast<std::size_t>(view.width));
  double sum_px = 0;
  const auto exact = [&] { sum_px += counted_places_by_pixel(map, view, row); };
  const auto by_rows = [&] { sum_px += counted_places_by_rows(map, view, row); };
  panorama::RenderViewOptions options;
  options.threads = 1;
  const auto whole = [&] { sum_px += panorama::render_view(image, map, view, options).pixels.front().r; };
  const std::string name = to_string(map.kind);
  bench::compare_rounds(name + ": places pixel by pixel; by rows", exact, by_rows, rounds);
  bench::compare_rounds(name + ": an image; its places pixel by pixel", whole, exact, rounds);
  if (sum_px == 0.5) std::abort();  // the work is not left out
}

}  // namespace

int main(int argc, char** argv) {
  const bool counts = argc == 3 && std::strcmp(argv[1], "count") == 0;
  const bool by_rows = counts && std::strcmp(argv[2], "rows") == 0;
  const int rounds = argc == 2 ? std::atoi(argv[1]) : 7;
  if (argc > 3 || (argc == 3 && !by_rows && (!counts || std::strcmp(argv[2], "pixels") != 0)) || rounds < 1) {
    std::fprintf(stderr, "usage: view_bench [ROUNDS]\n       view_bench count pixels|rows\n");
    return 2;
  }
  if (!counts) std::printf("| work | first, ms | second / first |\n|---|---|---|\n");
  const vpe::core::View view = bench_view();
  std::vector<glm::dvec2> row(static_cast<std::size_t>(view.width));
  for (const panorama::PanoramaMap& map : {panorama::cylinder_map(6000, 2000, 6000, -180.0, 1200.0),
                                           panorama::equirectangular_map(6000, 3000, 6000, -180.0, 1500.0),
                                           panorama::faceted_map(8, 750, 2000, 0.0, 1200.0)}) {
    if (counts) {
      std::printf("%s: %g\n", std::string(to_string(map.kind)).c_str(),
                  by_rows ? counted_places_by_rows(map, view, row) : counted_places_by_pixel(map, view, row));
    } else {
      bench_map(map, rounds);
    }
  }
  return 0;
}
