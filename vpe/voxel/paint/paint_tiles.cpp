#include "vpe/voxel/paint/paint_tiles.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

namespace vpe::voxel {

namespace {

using paging::ColourSource;

// From this level on a tile lies between two knots of the warp.
constexpr int kKnotLevel = 5;

bool of_posts(ColourSource s) {
  return s == ColourSource::kElevation || s == ColourSource::kSlope || s == ColourSource::kAspect ||
         s == ColourSource::kDifference;
}

void set_chart_square(const lod::TileKey& square, ChartSquare& out) {
  const mars::ChartRect rect = lod::chart_rect(square);
  out.u0 = rect.u0;
  out.v0 = rect.v0;
  out.per_u = 1.0 / (rect.u1 - rect.u0);
  out.per_v = 1.0 / (rect.v1 - rect.v0);
  out.face = square.face;
  const mars::FaceAxes& axes = mars::face_axes(square.face);
  const glm::dvec3* const all[3] = {&axes.right, &axes.up, &axes.out};
  for (int n = 0; n < 3; ++n) {
    for (int c = 0; c < 3; ++c) {
      if ((*all[n])[c] == 0.0) continue;
      out.axis[n] = c;
      out.sign[n] = (*all[n])[c];
    }
  }
}

// Returns where a square lies in the grid of a tile that contains it: first line and lines across.
std::pair<double, double> exact_window(std::int32_t index, int square_level, std::int32_t tile_index,
                                       int tile_level, int intervals) {
  const double span = std::ldexp(1.0, tile_level - square_level);
  return {(index * span - tile_index) * intervals, span * intervals};
}

WindowAxis window(std::int32_t index, int square_level, std::int32_t tile_index, int tile_level,
                  int intervals) {
  const auto [first, span] = exact_window(index, square_level, tile_index, tile_level, intervals);
  return {static_cast<float>(first), static_cast<float>(span)};
}

}  // namespace

PaintNeeds paint_needs(const paging::ShadingParams& shading) {
  const bool image = paging::shows_image(shading.colour_source);
  if (shading.flat) return {.image = image, .facets = true};
  const bool at_posts = shading.colour_source == ColourSource::kImageAtPosts;
  return {.posts = shading.lit || of_posts(shading.colour_source) || of_posts(shading.hue),
          .image = image && !at_posts,
          .post_colours = at_posts};
}

PaintTiles::PaintTiles(const paging::PlanetFile& planet, const paging::TerrainShader& shader,
                       PaintSources& sources, MadeTiles& made, const paging::ShadingParams& shading,
                       std::size_t limit_bytes)
    : planet_(planet),
      shader_(shader),
      sources_(sources),
      made_(made),
      shading_(shading),
      needs_(paint_needs(shading)),
      max_level_(planet.meta().finest_level),
      image_below_(0),
      limit_(limit_bytes) {
  for (int side = planet.meta().tile.intervals(); side < paging::kImageIntervals; side *= 2) ++image_below_;
  for (int side = planet.meta().tile.intervals(); side > paging::kImageIntervals; side /= 2) --image_below_;
  if (needs_.image || needs_.post_colours)
    max_level_ = std::max(max_level_, planet.meta().finest_image_level + image_below_);
  max_level_ = std::clamp(max_level_, 0, lod::kMaxLevel);
}

PaintTile PaintTiles::make(const lod::TileKey& square, int level) const {
  PaintTile out;
  set_chart_square(square, out);
  out.level = level;
  const lod::TileKey stored = planet_.tree().deepest(lod::ancestor(square, level)).key;
  if (needs_.posts || (!needs_.facets && planet_.has_nodata(stored))) {
    out.ground = sources_.posts(stored);
    const lod::TileKey& at = out.ground->key;
    const int n = out.ground->side - 1;
    out.ground_x = window(square.i, square.level, at.i, at.level, n);
    out.ground_y = window(square.j, square.level, at.j, at.level, n);
  }
  if (needs_.post_colours) {
    const int image_level = std::clamp(level - image_below_, 0, std::max(planet_.meta().finest_image_level, 0));
    out.colours = made_.colours(planet_, shader_, stored, image_level, shading_);
    out.ground_x = window(square.i, square.level, stored.i, stored.level, planet_.meta().tile.intervals());
    out.ground_y = window(square.j, square.level, stored.j, stored.level, planet_.meta().tile.intervals());
  }
  if (needs_.image) {
    const auto key = planet_.image_key(lod::ancestor(square, std::max(level - image_below_, 0)));
    if (!key) throw paging::PlanetError(planet_.path() + ": has no image; use --set mode=coloured");
    const PaintSources::Texels texels = sources_.texels(*key);
    out.image = texels.tile;
    out.image_x = window(square.i, square.level, texels.key.i, texels.key.level, paging::kImageIntervals);
    out.image_y = window(square.j, square.level, texels.key.j, texels.key.level, paging::kImageIntervals);
  }
  return out;
}

FacetSquare PaintTiles::make_facets(const lod::TileKey& square, const lod::TileKey& stored) const {
  FacetSquare out;
  set_chart_square(square, out);
  out.tile = made_.facets(planet_, shader_, stored, shading_);
  const int n = out.tile->side - 1;
  const lod::GridLines lines = lod::grid_lines(stored, n);
  std::tie(out.first_x, out.span_x) = exact_window(square.i, square.level, stored.i, stored.level, n);
  std::tie(out.first_y, out.span_y) = exact_window(square.j, square.level, stored.j, stored.level, n);
  const auto line = [](double first, const std::vector<double>& at) {
    const double number = std::floor(first);
    const auto k = static_cast<std::size_t>(number);
    return FacetSquare::Line{number, at[k], at[k + 1] - at[k]};
  };
  out.west = line(out.first_x, lines.u);
  out.south = line(out.first_y, lines.v);
  return out;
}

void PaintTiles::hold(const void* tile, std::size_t bytes) {
  if (tile != nullptr && held_.insert(tile).second) held_bytes_ += bytes;
}

bool PaintTiles::trim() {
  if (held_bytes_ <= limit_) return false;
  squares_.clear();
  facet_squares_.clear();
  held_.clear();
  held_bytes_ = 0;
  return true;
}

const PaintTile& PaintTiles::find(const glm::dvec3& point, int level) {
  const int side_level = std::max({level, level - image_below_, kKnotLevel});
  const lod::TileKey square = lod::tile_at(mars::chart_point(point), side_level);
  // At levels coarser than the knots' one square belongs to tiles of several levels. Keys of squares so coarse
  // have free low bits.
  const std::int64_t name = lod::pack(square) + (level < kKnotLevel ? level + 1 : 0);
  if (const auto at = squares_.find(name); at != squares_.end()) return at->second;
  const PaintTile& made = squares_.emplace(name, make(square, level)).first->second;
  if (made.ground) hold(made.ground.get(), made.ground->bytes());
  if (made.image) hold(made.image.get(), made.image->texels.capacity() * sizeof(base::Rgb));
  if (made.colours) hold(made.colours.get(), made.colours->bytes());
  return made;
}

const FacetSquare& PaintTiles::find_facets(const glm::dvec3& point) {
  const mars::ChartPoint place = mars::chart_point(point);
  const lod::TileKey stored = planet_.tree().deepest(lod::tile_at(place, lod::kMaxLevel)).key;
  const lod::TileKey square = stored.level < kKnotLevel ? lod::tile_at(place, kKnotLevel) : stored;
  const std::int64_t name = lod::pack(square);
  if (const auto at = facet_squares_.find(name); at != facet_squares_.end()) return at->second;
  const FacetSquare& made = facet_squares_.emplace(name, make_facets(square, stored)).first->second;
  hold(made.tile.get(), made.tile->bytes());
  return made;
}

}  // namespace vpe::voxel
