#include <gdal_priv.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "mars/raster/elevation/band_format.h"
#include "mars/raster/gdal_boundary.h"
#include "mars/raster/gdal_overviews.h"
#include "mars/raster/gdal_raster.h"
#include "mars/raster/gdal_tiles.h"
#include "mars/raster/placed_sources.h"
#include "mars/raster/product_datum.h"
#include "mars/sources/adjusted.h"
#include "mars/sources/source.h"
#include "mars/sources/stack.h"

namespace mars {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kLargestHeight_m = 1e6;  // larger values are distances from the planet's centre

template <class T>
struct HeightTile {
  std::vector<T> values;  // as stored; NaN: nodata
  std::size_t bytes() const { return sizeof(HeightTile) + values.size() * sizeof(T); }
};

// Returns the mask that rejects what either of two rejects.
PostMask both(PostMask first, PostMask second) {
  return [first = std::move(first), second = std::move(second)](std::span<const glm::dvec3> directions,
                                                                std::span<double> heights_m) {
    first(directions, heights_m);
    second(directions, heights_m);
  };
}

template <class T>
class GdalElevation final : public ElevationSource, public BoundaryAware, public Maskable {
 public:
  GdalElevation(std::shared_ptr<const GdalRaster> raster, const BandFormat& format)
      : raster_(std::move(raster)),
        grid_(raster_->grid()),
        format_(format),
        info_(raster_->info()),
        levels_{{-1, grid_, {1, 1}, 1}} {
    if (info_.is_remote && !raster_->is_placed()) {
      levels_ = raster_levels(*raster_, format.masked);
      blocks_ = std::make_shared<const BlockReader<T>>(raster_, levels_);
    }
    // Planet files store this text: it must not change.
    if (levels_.size() > 1) info_.treatment = "coarse posts from its overviews";
    info_.quantum_m = GDALDataTypeIsFloating(format.type) != 0 ? 0.0 : std::abs(format.scale);
    const double some_height_m = first_height();
    {
      const auto dataset = raster_->acquire();
      const ProductDatum product = product_datum(raster_->path(), *dataset, raster_->label());
      const bool is_radius = std::abs(some_height_m) > kLargestHeight_m;
      info_.datum = is_radius ? VerticalDatum::radius() : product.datum;
      info_.body_radius_m = body_radius_m(*dataset);
      info_.body = body_name(*dataset, raster_->label());
      if (product.by_name && !is_radius) {
        info_.notes.push_back(info_.name + ": by its name alone its heights are of datum '" +
                              to_string(info_.datum) + "' (--datum states another)");
      }
      note_bands(*dataset);
    }
    find_poles();
  }

  GdalElevation(const GdalElevation& whole, PostMask mask, int margin, const std::string& treatment)
      : raster_(whole.raster_),
        grid_(whole.grid_),
        format_(whole.format_),
        info_(whole.info_),
        levels_{whole.levels_.front()},
        blocks_(whole.blocks_),
        mask_(whole.mask_ ? both(whole.mask_, std::move(mask)) : std::move(mask)),
        mask_margin_(std::max(whole.mask_margin_, margin)) {
    info_.treatment = add_treatment(info_.treatment, treatment);
    find_poles();
  }

  std::shared_ptr<const ElevationSource> with_mask(PostMask mask, int margin,
                                                   const std::string& treatment) const override {
    return std::make_shared<const GdalElevation>(*this, std::move(mask), margin, treatment);
  }

  std::vector<SourceInfo> infos() const override { return {info_}; }

  void sample(std::span<const glm::dvec3> directions, double spacing_m,
              std::span<double> heights_m) const override {
    const std::size_t index = level_for(levels_, spacing_m / info_.resolution_m);
    const RasterLevel& level = levels_[index];
    auto cursor = make_cursor(index);
    for_pixels(raster_->georeference(), directions, [&](std::size_t start, std::span<const glm::dvec2> pixels) {
      for (std::size_t i = 0; i < pixels.size(); ++i) {
        const glm::dvec2 pixel = index == 0 ? pixels[i] : level.from_raster(pixels[i]);
        heights_m[start + i] = height(cursor, level.grid, pixel);
      }
    });
  }

  void origin(std::span<const glm::dvec3> directions, std::span<int> source_index) const override {
    auto cursor = make_cursor(0);
    for_pixels(raster_->georeference(), directions, [&](std::size_t start, std::span<const glm::dvec2> pixels) {
      for (std::size_t i = 0; i < pixels.size(); ++i) {
        source_index[start + i] = std::isnan(height(cursor, grid_, pixels[i])) ? -1 : 0;
      }
    });
  }

  double spacing_in(const Cap& cap) const override {
    return raster_->footprint().touches(cap) ? info_.resolution_m : std::numeric_limits<double>::infinity();
  }

  void visit_posts(std::size_t max_posts, const PostVisitor& visit) const override {
    visit_posts_in(max_posts, {}, visit);
  }

  void visit_posts_in(std::size_t max_posts, const WantedCap& wanted, const PostVisitor& visit) const override {
    visit_level(0, raster_->windows(), max_posts, wanted, visit);
  }

  void visit_means(std::size_t max_posts, const PostVisitor& visit) const override {
    const double posts = static_cast<double>(grid_.width) * grid_.height;
    const std::size_t index =
        level_for(levels_, std::sqrt(posts / static_cast<double>(std::max<std::size_t>(max_posts, 1))));
    if (index == 0) return visit_posts(max_posts, visit);
    const PixelGrid& grid = levels_[index].grid;
    visit_level(index, {{0, 0, grid.width, grid.height}}, max_posts, {}, visit);
  }

  void boundary_distance(std::span<const glm::dvec3> directions, double limit_posts,
                         std::span<double> posts) const override {
    auto cursor = make_cursor(0);
    const auto has_data = [&cursor](int column, int row) {
      return !std::isnan(cursor.at(column, row).values[Cursor::offset(column, row)]);
    };
    raster_boundary_distance(raster_->georeference(), boundaries_, directions, limit_posts, has_data, posts);
  }

 private:
  using Tile = HeightTile<T>;

  struct Fetch {
    const GdalElevation* source;
    std::shared_ptr<const Tile> operator()(const TileId& id) const {
      if (source->is_without_data(id)) return empty_tile();
      return source->tiles_.get(id, [this](const TileId& key) { return source->load(key); });
    }
  };
  using Cursor = TileCursor<Tile, Fetch>;
  Cursor make_cursor(std::size_t level) const { return Cursor(static_cast<int>(level), Fetch{this}); }

  // Visits a regular subset of the pixels of a level within windows of it.
  void visit_level(std::size_t index, const std::vector<PixelWindow>& windows, std::size_t max_posts,
                   const WantedCap& wanted, const PostVisitor& visit) const {
    if (max_posts == 0) return;
    double posts = 0;
    for (const PixelWindow& w : windows) posts += static_cast<double>(w.columns) * w.rows;
    const int stride =
        std::max(1, static_cast<int>(std::ceil(std::sqrt(posts / static_cast<double>(max_posts)))));
    auto cursor = make_cursor(index);
    std::map<std::pair<int, int>, bool> wanted_tiles;
    const auto is_wanted = [&](int column, int row) {
      if (!wanted) return true;
      const auto [found, is_new] = wanted_tiles.try_emplace({column / kTileSide, row / kTileSide}, true);
      if (is_new)
        found->second =
            wanted(cap_of(raster_->georeference(), levels_[index],
                          tile_window(levels_[index].grid, {0, column / kTileSide, row / kTileSide})));
      return found->second;
    };
    std::vector<glm::dvec2> pixels;
    std::vector<glm::dvec3> directions;
    std::vector<glm::dvec3> kept;
    std::vector<double> heights_m;
    for (const PixelWindow& w : windows) {
      for (int r = std::min(stride, w.rows) / 2; r < w.rows; r += stride) {
        const int row = w.row + r;
        pixels.clear();
        kept.clear();
        heights_m.clear();
        for (int c = std::min(stride, w.columns) / 2; c < w.columns; c += stride) {
          const int column = w.column + c;
          if (!is_wanted(column, row)) continue;
          const double stored = cursor.at(column, row).values[cursor.offset(column, row)];
          if (std::isnan(stored)) continue;
          pixels.push_back(levels_[index].to_raster({column, row}));
          heights_m.push_back(metres(stored));
        }
        directions.resize(pixels.size());
        raster_->georeference().to_directions(pixels, directions);
        for (std::size_t i = 0; i < directions.size(); ++i) {
          if (!std::isfinite(directions[i].x)) continue;
          heights_m[kept.size()] = heights_m[i];
          kept.push_back(directions[i]);
        }
        if (!kept.empty()) visit(kept, std::span<const double>(heights_m).first(kept.size()));
      }
    }
  }

  // Adds a note if other bands could be meant.
  void note_bands(GDALDataset& dataset) {
    int bands = 0;
    for (int i = 1; i <= dataset.GetRasterCount(); ++i) {
      if (dataset.GetRasterBand(i)->GetColorInterpretation() != GCI_AlphaBand) ++bands;
    }
    if (bands < 2) return;
    const char* name = dataset.GetRasterBand(1)->GetDescription();
    info_.notes.push_back(info_.name + " has " + std::to_string(bands) + " bands; the first" +
                          (name[0] != '\0' ? " ('" + std::string(name) + "')" : "") +
                          " is taken for elevation (gdal_translate -b N makes a raster of another one)");
  }

  // Returns true if the file tells without being read that a tile has no data. Mosaics are mostly such tiles.
  bool is_without_data(const TileId& id) const {
    if (blocks_) return false;
    const PixelWindow window = tile_window(grid_, id);
    const bool wraps = grid_.wraps && window.columns < kTileStride;
    return !overlaps(raster_->windows(), window) &&
           !(wraps && overlaps(raster_->windows(), {0, window.row, 1, window.rows}));
  }

  static std::shared_ptr<const Tile> empty_tile() {
    static const auto tile = std::make_shared<const Tile>(Tile{std::vector<T>(
        static_cast<std::size_t>(kTileStride) * kTileStride, std::numeric_limits<T>::quiet_NaN())});
    return tile;
  }

  std::shared_ptr<const Tile> load(const TileId& id) const {
    auto tile = std::make_shared<Tile>();
    tile->values.resize(static_cast<std::size_t>(kTileStride) * kTileStride);
    const RasterLevel& level = levels_[static_cast<std::size_t>(id.level)];
    const PixelWindow window = tile_window(level.grid, id);
    const auto read = [&](const PixelWindow& part, int stride, T* values) {
      if (blocks_) return blocks_->read(static_cast<std::size_t>(id.level), part, stride, values);
      raster_->read(1, level.overview, part, stride, values);
    };
    read(window, kTileStride, tile->values.data());
    std::vector<T> first_column;
    if (grid_.wraps && window.columns < kTileStride) {
      first_column.resize(static_cast<std::size_t>(window.rows));
      read({0, window.row, 1, window.rows}, 1, first_column.data());
    }
    apply_mask(window, kTileStride, tile->values);
    if (!first_column.empty()) apply_mask({0, window.row, 1, window.rows}, 1, first_column);
    complete_tile(window, first_column.empty() ? nullptr : first_column.data(), tile->values.data());
    mark_nodata(tile->values);
    if (mask_) drop_masked(id, tile->values);
    return tile;
  }

  // Removes the posts that mask_ rejects and their neighbours. Tests the pixels of a margin around the tile
  // too, so that all tiles remove the same posts.
  void drop_masked(const TileId& id, std::span<T> values) const {
    const int column = std::max(0, id.column * kTileSide - mask_margin_);
    const int row = std::max(0, id.row * kTileSide - mask_margin_);
    const PixelWindow window{column, row,
                             std::min(grid_.width, (id.column + 1) * kTileSide + 1 + mask_margin_) - column,
                             std::min(grid_.height, (id.row + 1) * kTileSide + 1 + mask_margin_) - row};
    std::vector<T> stored(static_cast<std::size_t>(window.columns) * static_cast<std::size_t>(window.rows));
    raster_->read(1, -1, window, window.columns, stored.data());
    apply_mask(window, window.columns, stored);
    mark_nodata(stored);
    std::vector<glm::dvec2> pixels;
    std::vector<double> heights_m;
    for (int r = 0; r < window.rows; ++r) {
      for (int c = 0; c < window.columns; ++c) {
        const double value = stored[static_cast<std::size_t>(r) * static_cast<std::size_t>(window.columns) +
                                    static_cast<std::size_t>(c)];
        if (std::isnan(value)) continue;
        pixels.emplace_back(window.column + c, window.row + r);
        heights_m.push_back(metres(value));
      }
    }
    std::vector<glm::dvec3> directions(pixels.size());
    raster_->georeference().to_directions(pixels, directions);
    mask_(directions, heights_m);
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      if (!std::isnan(heights_m[i])) continue;
      drop_around(static_cast<int>(pixels[i].x) - id.column * kTileSide,
                  static_cast<int>(pixels[i].y) - id.row * kTileSide, values);
    }
  }

  // Removes a post and its neighbours, at a position relative to the tile.
  void drop_around(int column, int row, std::span<T> values) const {
    for (int r = std::max(0, row - mask_margin_); r <= std::min(kTileStride - 1, row + mask_margin_); ++r) {
      for (int c = std::max(0, column - mask_margin_); c <= std::min(kTileStride - 1, column + mask_margin_);
           ++c) {
        values[static_cast<std::size_t>(r * kTileStride + c)] = static_cast<T>(kNaN);
      }
    }
  }

  void mark_nodata(std::span<T> values) const {
    const T nodata = format_.nodata_value ? static_cast<T>(*format_.nodata_value) : static_cast<T>(kNaN);
    for (T& value : values) {
      // Rejects infinities, and the special pixels of ISIS other than its nodata value.
      if (value == nodata || !(std::abs(value) < static_cast<T>(1e30))) value = static_cast<T>(kNaN);
    }
    if (!format_.special_values.any()) return;
    for (T& value : values) {
      if (format_.special_values.has(static_cast<double>(value))) value = static_cast<T>(kNaN);
    }
  }

  // Sets pixels that the mask or alpha band hides to NaN, in a window whose rows are `stride` apart.
  void apply_mask(const PixelWindow& window, int stride, std::span<T> values) const {
    if (!format_.masked) return;
    std::vector<unsigned char> mask(static_cast<std::size_t>(window.columns) *
                                    static_cast<std::size_t>(window.rows));
    raster_->read_mask(1, -1, window, window.columns, mask.data());
    for (int row = 0; row < window.rows; ++row) {
      for (int column = 0; column < window.columns; ++column) {
        const auto at = [&](int width) {
          return static_cast<std::size_t>(row) * static_cast<std::size_t>(width) +
                 static_cast<std::size_t>(column);
        };
        if (mask[at(window.columns)] == 0) values[at(stride)] = static_cast<T>(kNaN);
      }
    }
  }

  double metres(double stored) const { return format_.offset + format_.scale * stored; }

  double height(Cursor& cursor, const PixelGrid& grid, const glm::dvec2& pixel) const {
    PixelNeighbourhood place;
    if (!locate(grid, pixel.x, pixel.y, place)) return kNaN;
    const T* p = cursor.at(place.column, place.row).values.data() + Cursor::offset(place.column, place.row);
    const double v00 = p[0], v10 = p[1], v01 = p[kTileStride], v11 = p[kTileStride + 1];
    const double fx = place.fx, fy = place.fy;
    if (place.pole != Pole::kNone) {
      const double row = along_row(v00, v10, fx);
      const double pole = pole_[place.pole == Pole::kFirst ? 0 : 1];
      if (std::isnan(row) || std::isnan(pole)) return metres(place.pole_share < 0.5 ? row : pole);
      return metres(row * (1 - place.pole_share) + pole * place.pole_share);
    }
    const double stored = (v00 * (1 - fx) + v10 * fx) * (1 - fy) + (v01 * (1 - fx) + v11 * fx) * fy;
    if (!std::isnan(stored)) return metres(stored);
    if (std::isnan(fy < 0.5 ? (fx < 0.5 ? v00 : v10) : (fx < 0.5 ? v01 : v11))) return kNaN;
    double sum = 0;
    double weights = 0;
    const auto add = [&](double value, double weight) {
      if (std::isnan(value)) return;
      sum += value * weight;
      weights += weight;
    };
    add(v00, (1 - fx) * (1 - fy));
    add(v10, fx * (1 - fy));
    add(v01, (1 - fx) * fy);
    add(v11, fx * fy);
    return metres(sum / weights);
  }

  static double along_row(double left, double right, double fx) {
    const double value = left * (1 - fx) + right * fx;
    return std::isnan(value) ? (fx < 0.5 ? left : right) : value;
  }

  // The mean of a row of an overview does as well as that of the polar row, which lies all over the file.
  void find_poles() {
    const RasterLevel& level = levels_.back();
    for (const bool first : {true, false}) {
      if (first ? level.grid.has_first_pole() : level.grid.has_last_pole()) {
        pole_[first ? 0 : 1] =
            row_mean(level, first ? level.grid.first_polar_row() : level.grid.last_polar_row());
      }
    }
  }

  double row_mean(const RasterLevel& level, int row) const {
    const int width = level.grid.width;
    std::vector<T> values(static_cast<std::size_t>(width));
    raster_->read(1, level.overview, {0, row, width, 1}, width, values.data());
    apply_mask({0, row, width, 1}, width, values);
    mark_nodata(values);
    double sum = 0;
    int count = 0;
    for (const T value : values) {
      if (std::isnan(value)) continue;
      sum += value;
      ++count;
    }
    return count == 0 ? kNaN : sum / count;
  }

  // Returns the first valid height found. Reads no more than it needs. Throws SourceError if there is none.
  double first_height() const {
    if (levels_.size() > 1) {
      const PixelGrid& grid = levels_.back().grid;
      if (const auto found = first_height(levels_.size() - 1, {{0, 0, grid.width, grid.height}})) return *found;
    }
    if (const auto found = first_height(0, raster_->windows())) return *found;
    throw source_error(raster_->path(), "holds no elevation", "every pixel is nodata or not a number",
                       "check its nodata value with gdalinfo -stats");
  }

  std::optional<double> first_height(std::size_t level, const std::vector<PixelWindow>& windows) const {
    auto cursor = make_cursor(level);
    for (const PixelWindow& w : windows) {
      for (int row = w.row; row < w.row + w.rows; row = (row / kTileSide + 1) * kTileSide) {
        for (int column = w.column; column < w.column + w.columns;
             column = (column / kTileSide + 1) * kTileSide) {
          const Tile& tile = cursor.at(column, row);
          const PixelWindow window = tile_window(levels_[level].grid, {0, column / kTileSide, row / kTileSide});
          for (int r = 0; r < window.rows; ++r) {
            const T* line = tile.values.data() + std::ptrdiff_t{r} * kTileStride;
            const T* found =
                std::find_if(line, line + window.columns, [](T value) { return !std::isnan(value); });
            if (found != line + window.columns) return metres(*found);
          }
        }
      }
    }
    return std::nullopt;
  }

  std::shared_ptr<const GdalRaster> raster_;
  PixelGrid grid_;
  BandFormat format_;
  SourceInfo info_;
  std::vector<RasterLevel> levels_;  // remote rasters: also the overviews, for posts that are farther apart
  std::shared_ptr<const BlockReader<T>> blocks_;  // of remote rasters, else null
  PostMask mask_;                                 // empty: all posts are used
  int mask_margin_ = 0;
  mutable TileCache<Tile> tiles_;
  mutable TileCache<BoundaryTile> boundaries_;
  std::array<double, 2> pole_{kNaN, kNaN};  // stored values at the first and at the last pole
};

}  // namespace

std::shared_ptr<const ElevationSource> open_elevation(const std::string& path) {
  return open_elevation(path, {});
}

std::shared_ptr<const ElevationSource> open_elevation(const std::string& path,
                                                      const PlacementOptions& placement) {
  auto raster = std::make_unique<GdalRaster>(path, placement);
  const BandFormat format = band_format(*raster);
  if (format.fits_float) return std::make_shared<GdalElevation<float>>(std::move(raster), format);
  return std::make_shared<GdalElevation<double>>(std::move(raster), format);
}

}  // namespace mars
