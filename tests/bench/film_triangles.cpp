// How many triangles a film takes: a planet file's meshes against quadtrees of regular grids under the same
// selection. Section "The film" of docs/simplifiers.md.
//
//   film_triangles PLANET.vpe FLIGHT [STRIDE]
//
// A regular quadtree of 2^g intervals a tile goes down to the posts of S, where its error is 0. The grids of
// two values of g on one level of posts are the same surface, only cut into other tiles: the errors are
// measured once, over tiles of the smallest g, and a larger tile takes the largest of its parts.
#include <algorithm>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <limits>
#include <map>
#include <optional>
#include <unordered_map>

#include "lod/mesh/error_meter.h"
#include "lod/select.h"
#include "paging/surface/surface.h"
#include "scripts/path.h"
#include "tests/bench/flight.h"
#include "vpe/base/number.h"
#include "vpe/base/parallel.h"

namespace {

constexpr int kSmallestGrid = 4;  // log2 of a regular tile's intervals
constexpr double kTolerance_px = 1.0;

struct RegularTile {
  lod::ErrorTerms terms;
  double min_m = std::numeric_limits<double>::infinity();
  double max_m = -std::numeric_limits<double>::infinity();
  bool inner = false;

  void include(const RegularTile& part) {
    terms.include(part.terms);
    min_m = std::min(min_m, part.min_m);
    max_m = std::max(max_m, part.max_m);
    inner = inner || part.inner;
  }
};
using RegularTiles = std::unordered_map<lod::TileKey, RegularTile, lod::TileKeyHash>;

// Posts of a tile below (or the same), every so many that there are `intervals` a side.
lod::Posts part_of(const lod::Posts& whole, const lod::TileKey& key, int intervals) {
  const int depth = key.level - whole.key.level;
  const int step = (whole.intervals >> depth) / intervals;
  const int i0 = (key.i - (whole.key.i << depth)) * (whole.intervals >> depth);
  const int j0 = (key.j - (whole.key.j << depth)) * (whole.intervals >> depth);
  lod::Posts part{key, intervals, {}};
  for (int j = 0; j <= intervals; ++j) {
    for (int i = 0; i <= intervals; ++i) part.height_m.push_back(whole.at(i0 + i * step, j0 + j * step));
  }
  return part;
}

// Error of every regular tile of the smallest grid, one finest tile of the planet at a time.
class RegularMeter {
 public:
  explicit RegularMeter(const paging::Surface& surface)
      : surface_(surface), below_(surface.planet().meta().tile.k - kSmallestGrid) {}

  void add(const lod::TileKey& leaf) {
    const auto tile = surface_.tile(leaf);
    const lod::Posts& posts = tile->data.posts;
    const double radius = surface_.planet_radius_m();
    const lod::FinePosts fine(posts, radius);
    meters_.resize(static_cast<std::size_t>(leaf.level) + 1);
    for (int level = 0; level <= leaf.level; ++level) {
      const lod::TileKey key = lod::ancestor(leaf, level);
      std::optional<Meter>& meter = meters_[static_cast<std::size_t>(level)];
      if (!meter || meter->key != key) meter.emplace(Meter{key, meter_of(key)});
      note(key, meter->meter.measure(fine));
    }
    for (int depth = 1; depth <= below_; ++depth) {
      for (int j = 0; j < 1 << depth; ++j) {
        for (int i = 0; i < 1 << depth; ++i) {
          const lod::TileKey key{leaf.face, leaf.level + depth, (leaf.i << depth) + i, (leaf.j << depth) + j};
          const lod::Posts part = part_of(posts, key, posts.intervals >> depth);
          if (depth < below_) {
            note(key, meter_of(key).measure(lod::FinePosts(part, radius)));
          } else {
            const auto [low, high] = std::minmax_element(part.height_m.begin(), part.height_m.end());
            found_[key] = {{}, *low, *high, false};
          }
        }
      }
    }
  }

  RegularTiles take() { return std::move(found_); }

 private:
  struct Meter {
    lod::TileKey key;
    lod::ErrorMeter meter;
  };

  void note(const lod::TileKey& key, const lod::ErrorTerms& terms) {
    RegularTile& tile = found_[key];
    tile.terms.include(terms);
    tile.inner = true;
  }

  lod::ErrorMeter meter_of(const lod::TileKey& key) const {
    const auto above = surface_.tile(lod::ancestor(key, std::max(0, key.level - below_)));
    const lod::Posts posts = part_of(above->data.posts, key, 1 << kSmallestGrid);
    const lod::TileMesh mesh = lod::mesh_full(posts.intervals);
    return lod::ErrorMeter(key, mesh, lod::vertex_heights(mesh, posts), surface_.planet_radius_m());
  }

  const paging::Surface& surface_;
  int below_;  // levels of regular tiles below a finest tile
  std::vector<std::optional<Meter>> meters_;
  RegularTiles found_;
};

RegularTiles measure(const paging::Surface& surface) {
  std::vector<lod::TileKey> leaves;
  for (const lod::TileInfo& tile : surface.planet().tree().tiles()) {
    if (!tile.has_children) leaves.push_back(tile.key);
  }
  std::sort(leaves.begin(), leaves.end(),
            [](const auto& a, const auto& b) { return lod::morton_position(a) < lod::morton_position(b); });
  constexpr std::size_t kChunk = 64;
  std::vector<RegularTiles> found((leaves.size() + kChunk - 1) / kChunk);
  vpe::base::parallel_for(found.size(), 0, [&](std::size_t chunk) {
    RegularMeter meter(surface);
    const std::size_t end = std::min(leaves.size(), (chunk + 1) * kChunk);
    for (std::size_t n = chunk * kChunk; n < end; ++n) meter.add(leaves[n]);
    found[chunk] = meter.take();
  });
  RegularTiles all;
  for (RegularTiles& some : found) {
    for (const auto& [key, tile] : some) all[key].include(tile);
    some.clear();
  }
  return all;
}

// The same surfaces in tiles of twice the intervals.
RegularTiles joined(const RegularTiles& tiles) {
  RegularTiles wider;
  for (const auto& [key, tile] : tiles) {
    if (key.level > 0) wider[lod::parent(key)].include(tile);
  }
  return wider;
}

lod::TileTree regular_tree(RegularTiles tiles, int grid, const paging::PlanetMeta& meta) {
  std::vector<lod::TileKey> keys;
  for (const auto& [key, tile] : tiles) keys.push_back(key);
  std::sort(keys.begin(), keys.end(), [](const auto& a, const auto& b) { return a.level > b.level; });
  const auto triangles = static_cast<std::uint32_t>(2 << (2 * grid));
  std::vector<lod::TileInfo> infos;
  for (const lod::TileKey& key : keys) {
    const RegularTile& tile = tiles.at(key);
    infos.push_back({key, tile.min_m, tile.max_m, tile.inner, {}, {{tile.terms, triangles}}});
    if (key.level > 0) tiles.at(lod::parent(key)).include({tile.terms, tile.min_m, tile.max_m, true});
  }
  return {std::move(infos), {grid}, meta.radius_m, meta.lowest_radius_m};
}

struct Film {
  std::vector<lod::SelectView> views;
  std::vector<double> exaggeration;
};

Film film_of(const char* file, std::int64_t stride, const paging::Surface& surface) {
  const scripts::Flight flight = bench::read_flight(file);
  const scripts::Path path = bench::path_over(flight, surface);
  Film film;
  const std::int64_t count = scripts::frame_count(flight.view.fps, scripts::duration_s(flight));
  for (std::int64_t k = 0; k < count; k += stride) {
    const double t = scripts::frame_time(flight.view.fps, k);
    vpe::core::View view;
    view.camera = path.at(t).camera;
    view.fov_deg = flight.view.fov_deg;
    view.width = flight.view.width;
    view.height = flight.view.height;
    vpe::core::Settings settings;
    path.apply_settings(t, settings);
    film.views.push_back(lod::select_view(view));
    film.exaggeration.push_back(settings.values().exaggeration);
  }
  return film;
}

struct Drawn {
  std::int64_t tiles = 0;
  std::int64_t triangles = 0;
};

struct Count {
  std::vector<Drawn> frames;
  Drawn total;
  // By level; variant, full grids as -1.
  std::map<std::pair<int, int>, Drawn> kinds;
};

Count count(const lod::TileTree& tree, const Film& film) {
  Count out;
  lod::SelectScratch scratch;
  lod::Selection selection;
  for (std::size_t n = 0; n < film.views.size(); ++n) {
    lod::SelectOptions options;
    options.tolerance_px = kTolerance_px;
    options.exaggeration = film.exaggeration[n];
    lod::select(options, tree, film.views[n], scratch, selection);
    for (const lod::SelectedTile& tile : selection.tiles) {
      const bool full = lod::is_full_grid(tree[tile.index], tile.variant);
      Drawn& kind = out.kinds[{tile.key.level, full ? -1 : tile.variant}];
      ++kind.tiles;
      kind.triangles += tree[tile.index].variants[static_cast<std::size_t>(tile.variant)].triangles;
    }
    out.frames.push_back({static_cast<std::int64_t>(selection.tiles.size()), selection.triangles});
    out.total.tiles += out.frames.back().tiles;
    out.total.triangles += out.frames.back().triangles;
  }
  return out;
}

void print_row(const std::string& name, const Count& count, const Count& ours) {
  const auto frames = static_cast<double>(count.frames.size());
  std::int64_t most = 0;
  double worst = 0;
  for (std::size_t n = 0; n < count.frames.size(); ++n) {
    most = std::max(most, count.frames[n].triangles);
    const std::int64_t theirs = std::max<std::int64_t>(count.frames[n].triangles, 1);
    worst = std::max(worst, static_cast<double>(ours.frames[n].triangles) / static_cast<double>(theirs));
  }
  std::printf("| %s | %.0f | %.0f | %lld | %lld | %.3f | %.3f |\n", name.c_str(),
              static_cast<double>(count.total.tiles) / frames,
              static_cast<double>(count.total.triangles) / frames, static_cast<long long>(most),
              static_cast<long long>(count.total.triangles),
              static_cast<double>(ours.total.triangles) / static_cast<double>(count.total.triangles), worst);
  std::fflush(stdout);
}

void print_kinds(const Count& count) {
  std::printf(
      "\n| level | mesh | tiles a frame | triangles a tile | share of triangles |\n|---|---|---|---|---|\n");
  const auto frames = static_cast<double>(count.frames.size());
  for (const auto& [kind, drawn] : count.kinds) {
    const std::string mesh = kind.second < 0 ? "full grid" : std::to_string(kind.second);
    std::printf("| %d | %s | %.2f | %.0f | %.1f %% |\n", kind.first, mesh.c_str(),
                static_cast<double>(drawn.tiles) / frames,
                static_cast<double>(drawn.triangles) / static_cast<double>(drawn.tiles),
                100.0 * static_cast<double>(drawn.triangles) / static_cast<double>(count.total.triangles));
  }
}

void run(const char* planet_file, const char* flight_file, std::int64_t stride) {
  const paging::Surface surface(paging::PlanetFile::open(planet_file), std::size_t{256} << 20);
  const paging::PlanetFile& planet = surface.planet();
  const Film film = film_of(flight_file, stride, surface);
  const Count ours = count(planet.tree(), film);
  std::printf(
      "%zu frames, tolerance %g px\n\n"
      "| tiles | tiles a frame | triangles a frame | most | all frames | ours / this | in the worst frame |\n"
      "|---|---|---|---|---|---|---|\n",
      film.views.size(), kTolerance_px);
  print_row("irregular meshes", ours, ours);
  RegularTiles tiles = measure(surface);
  for (int grid = kSmallestGrid; grid <= planet.meta().tile.k; ++grid) {
    if (grid > kSmallestGrid) tiles = joined(tiles);
    const lod::TileTree tree = regular_tree(tiles, grid, planet.meta());
    print_row("regular, " + std::to_string(1 << grid) + "² cells", count(tree, film), ours);
  }
  print_kinds(ours);
}

}  // namespace

int main(int argc, char** argv) {
  const auto stride = argc == 4 ? vpe::base::parse_integer(argv[3]) : 1;
  if (argc < 3 || argc > 4 || !stride || *stride < 1) {
    std::fprintf(stderr, "usage: film_triangles PLANET.vpe FLIGHT [STRIDE]\n");
    return 2;
  }
  try {
    run(argv[1], argv[2], *stride);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "film_triangles: %s\n", e.what());
    return 1;
  }
  return 0;
}
