#include "vpe/voxel/paint/paint_tiles.h"

#include <algorithm>
#include <cmath>

namespace vpe::voxel {

namespace {

using paging::ColourSource;

// From this level on a tile lies between two knots of the warp.
constexpr int kKnotLevel = 5;

bool of_posts(ColourSource s) {
  return s == ColourSource::kElevation || s == ColourSource::kSlope || s == ColourSource::kAspect ||
         s == ColourSource::kDifference;
}

void set_axes(mars::Face face, PaintTile& out) {
  const mars::FaceAxes& axes = mars::face_axes(face);
  const glm::dvec3* const all[3] = {&axes.right, &axes.up, &axes.out};
  for (int n = 0; n < 3; ++n) {
    for (int c = 0; c < 3; ++c) {
      if ((*all[n])[c] == 0.0) continue;
      out.axis[n] = c;
      out.sign[n] = (*all[n])[c];
    }
  }
}

// Returns where a square lies in the grid of a tile that contains it.
WindowAxis window(std::int32_t index, int square_level, std::int32_t tile_index, int tile_level,
                  int intervals) {
  const double span = std::ldexp(1.0, tile_level - square_level);
  return {static_cast<float>((index * span - tile_index) * intervals), static_cast<float>(span * intervals)};
}

}  // namespace

PaintNeeds paint_needs(const paging::ShadingParams& shading) {
  return {shading.lit || of_posts(shading.colour_source) || of_posts(shading.hue),
          shading.colour_source == ColourSource::kImage};
}

PaintTiles::PaintTiles(const paging::PlanetFile& planet, PaintSources& sources,
                       const paging::ShadingParams& shading, std::size_t limit_bytes)
    : planet_(planet),
      sources_(sources),
      needs_(paint_needs(shading)),
      max_level_(planet.meta().finest_level),
      image_below_(0),
      limit_(limit_bytes) {
  for (int side = planet.meta().tile.intervals(); side < paging::kImageIntervals; side *= 2) ++image_below_;
  for (int side = planet.meta().tile.intervals(); side > paging::kImageIntervals; side /= 2) --image_below_;
  if (needs_.image) max_level_ = std::max(max_level_, planet.meta().finest_image_level + image_below_);
  max_level_ = std::clamp(max_level_, 0, lod::kMaxLevel);
}

PaintTile PaintTiles::make(const lod::TileKey& square, int level) const {
  PaintTile out;
  set_axes(square.face, out);
  out.face = square.face;
  out.level = level;
  const mars::ChartRect rect = lod::chart_rect(square);
  out.u0 = rect.u0;
  out.v0 = rect.v0;
  out.per_u = 1.0 / (rect.u1 - rect.u0);
  out.per_v = 1.0 / (rect.v1 - rect.v0);
  const lod::TileKey stored = planet_.tree().deepest(lod::ancestor(square, level)).key;
  if (needs_.posts || planet_.has_nodata(stored)) {
    out.ground = sources_.posts(stored);
    const lod::TileKey& at = out.ground->key;
    const int n = out.ground->side - 1;
    out.ground_x = window(square.i, square.level, at.i, at.level, n);
    out.ground_y = window(square.j, square.level, at.j, at.level, n);
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

void PaintTiles::hold(const void* tile, std::size_t bytes) {
  if (tile != nullptr && held_.insert(tile).second) held_bytes_ += bytes;
}

bool PaintTiles::trim() {
  if (held_bytes_ <= limit_) return false;
  squares_.clear();
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
  return made;
}

}  // namespace vpe::voxel
