#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>

#include "mars/raster/gdal/label_keywords.h"
#include "mars/raster/gdal_boundary.h"
#include "mars/raster/gdal_image_decode.h"
#include "mars/raster/gdal_raster.h"
#include "mars/raster/gdal_tiles.h"
#include "mars/raster/placed_sources.h"
#include "mars/raster/product_datum.h"
#include "mars/sources/own_light.h"
#include "mars/sources/source.h"
#include "mars/sources/stack.h"

namespace mars {
namespace {

constexpr int kMaxTaps = 32;  // samples along a parallel near a pole
constexpr std::size_t kTilePixels = static_cast<std::size_t>(kTileStride) * kTileStride;

struct ImageTile {
  std::vector<Pixel> pixels = std::vector<Pixel>(kTilePixels);
  std::size_t bytes() const { return sizeof(ImageTile) + pixels.size() * sizeof(Pixel); }
};

std::vector<LabelKeyword> keywords_of(const GdalRaster& raster) {
  if (!raster.label()) return label_keywords(*raster.acquire());
  return {raster.label()->values.begin(), raster.label()->values.end()};
}

class GdalImage final : public ImageSource, public BoundaryAware {
 public:
  GdalImage(std::unique_ptr<GdalRaster> raster, ImageFormat format)
      : raster_(std::move(raster)), format_(std::move(format)), info_(raster_->info()) {
    info_.quantum_m = 0;
    info_.body_radius_m = body_radius_m(*raster_->acquire());
    info_.has_own_light = says_own_light(keywords_of(*raster_));
    for (PixelGrid grid = raster_->grid();; grid = raster_->grid().reduced(static_cast<int>(grids_.size()))) {
      grids_.push_back(grid);
      if (grid.width <= 1 && grid.height <= 1) break;
    }
    poles_.resize(grids_.size());
  }

  std::vector<SourceInfo> infos() const override { return {info_}; }

  void sample(std::span<const glm::dvec3> directions, double texel_m, std::span<vpe::base::Rgb> colours,
              std::span<std::uint8_t> alpha) const override {
    const double ratio = std::clamp(texel_m / info_.resolution_m, 1.0, 1e9);
    const int level =
        std::min(static_cast<int>(std::lround(std::log2(ratio))), static_cast<int>(grids_.size()) - 1);
    const PixelGrid& grid = grids_[static_cast<std::size_t>(level)];
    const double scale = std::ldexp(1.0, -level);
    const double texel_px = ratio * scale;
    const bool poles = grid.wraps && (grid.has_first_pole() || grid.has_last_pole());
    auto cursor = make_cursor(level);
    for_pixels(raster_->georeference(), directions, [&](std::size_t start, std::span<const glm::dvec2> pixels) {
      for (std::size_t i = 0; i < pixels.size(); ++i) {
        const glm::dvec2 p = (pixels[i] + 0.5) * scale - 0.5;
        const glm::dvec3& d = directions[start + i];
        // Columns of a cylindrical map converge at the poles, where a texel covers many of them.
        const double cos_lat = poles ? std::sqrt(d.x * d.x + d.y * d.y) : 1.0;
        const int taps =
            static_cast<int>(std::clamp(texel_px / std::max(cos_lat, 1e-9), 1.0, double{kMaxTaps}));
        Sum sum;
        for (int tap = 0; tap < taps; ++tap) add(cursor, level, p.x + tap - 0.5 * (taps - 1), p.y, sum);
        const bool visible = sum.alpha * 2 >= taps;
        alpha[start + i] = visible ? 255 : 0;
        colours[start + i] = visible ? sum.colour() : vpe::base::Rgb{};
      }
    });
  }

  double spacing_in(const Cap& cap) const override {
    return raster_->footprint().touches(cap) ? info_.resolution_m : std::numeric_limits<double>::infinity();
  }

  void boundary_distance(std::span<const glm::dvec3> directions, double limit_posts,
                         std::span<double> posts) const override {
    auto cursor = make_cursor(0);
    const auto has_data = [&cursor](int column, int row) {
      return cursor.at(column, row).pixels[Cursor::offset(column, row)].alpha >= 128;
    };
    raster_boundary_distance(raster_->georeference(), boundaries_, directions, limit_posts, has_data, posts);
  }

 private:
  struct Fetch {
    const GdalImage* image;
    std::shared_ptr<const ImageTile> operator()(const TileId& id) const { return image->tile(id); }
  };
  using Cursor = TileCursor<ImageTile, Fetch>;
  Cursor make_cursor(int level) const { return Cursor(level, Fetch{this}); }

  // Accumulates weighted colours. alpha is the sum of the weights that have data.
  struct Sum {
    std::array<double, 3> weighted{};
    double alpha = 0;

    void add(const Pixel& pixel, double weight) {
      const double share = weight * pixel.alpha / 255.0;
      for (std::size_t i = 0; i < 3; ++i) weighted[i] += share * pixel.colour[i];
      alpha += share;
    }
    vpe::base::Rgb colour() const {
      const auto byte = [&](std::size_t i) {
        return static_cast<std::uint8_t>(std::lround(weighted[i] / alpha));
      };
      return {byte(0), byte(1), byte(2)};
    }
  };

  std::shared_ptr<const ImageTile> tile(const TileId& id) const {
    return tiles_.get(id, [this](const TileId& key) { return load(key); });
  }

  void add(Cursor& cursor, int level, double x, double y, Sum& sum) const {
    PixelNeighbourhood place;
    if (!locate(grids_[static_cast<std::size_t>(level)], x, y, place)) return;
    const Pixel* p = cursor.at(place.column, place.row).pixels.data() + Cursor::offset(place.column, place.row);
    const double row = 1 - place.pole_share;
    sum.add(p[0], (1 - place.fx) * (1 - place.fy) * row);
    sum.add(p[1], place.fx * (1 - place.fy) * row);
    sum.add(p[kTileStride], (1 - place.fx) * place.fy * row);
    sum.add(p[kTileStride + 1], place.fx * place.fy * row);
    if (place.pole != Pole::kNone) sum.add(pole(level, place.pole), place.pole_share);
  }

  Pixel pole(int level, Pole which) const {
    const auto index = static_cast<std::size_t>(level);
    const std::lock_guard lock(poles_mutex_);
    std::optional<Pixel>& known = poles_[index][which == Pole::kFirst ? 0 : 1];
    if (!known) {
      const PixelGrid& grid = grids_[index];
      const int row = which == Pole::kFirst ? grid.first_polar_row() : grid.last_polar_row();
      auto cursor = make_cursor(level);
      Sum sum;
      for (int column = 0; column < grid.width; ++column) {
        sum.add(cursor.at(column, row).pixels[cursor.offset(column, row)], 1);
      }
      const vpe::base::Rgb mean = sum.alpha > 0 ? sum.colour() : vpe::base::Rgb{};
      known =
          Pixel{{mean.r, mean.g, mean.b}, static_cast<std::uint8_t>(std::lround(255 * sum.alpha / grid.width))};
    }
    return *known;
  }

  std::shared_ptr<const ImageTile> load(const TileId& id) const {
    auto made = std::make_shared<ImageTile>();
    const PixelGrid& grid = grids_[static_cast<std::size_t>(id.level)];
    const PixelWindow window = tile_window(grid, id);
    const auto overview = format_.overviews.find(id.level);
    const bool stored = id.level == 0 || overview != format_.overviews.end();
    const auto fill = [&](const PixelWindow& part, int stride, Pixel* pixels) {
      if (stored) {
        decode(*raster_, format_, id.level == 0 ? -1 : overview->second, part, stride, pixels);
      } else {
        average(id.level, part, stride, pixels);
      }
    };
    fill(window, kTileStride, made->pixels.data());
    std::vector<Pixel> first_column;
    if (grid.wraps && window.columns < kTileStride) {
      first_column.resize(static_cast<std::size_t>(window.rows));
      fill({0, window.row, 1, window.rows}, 1, first_column.data());
    }
    complete_tile(window, first_column.empty() ? nullptr : first_column.data(), made->pixels.data());
    return made;
  }

  // Computes means of 2x2 pixels of the next finer level.
  void average(int level, const PixelWindow& window, int stride, Pixel* pixels) const {
    const PixelGrid& finer = grids_[static_cast<std::size_t>(level - 1)];
    auto cursor = make_cursor(level - 1);
    for (int r = 0; r < window.rows; ++r) {
      for (int c = 0; c < window.columns; ++c) {
        const int column = 2 * (window.column + c);
        const int row = 2 * (window.row + r);
        std::array<int, 3> colour{};
        int alpha = 0;
        int count = 0;
        for (int i = 0; i < 4; ++i) {
          const int x = column + (i & 1);
          const int y = row + (i >> 1);
          if (x >= finer.width || y >= finer.height) continue;
          const Pixel& p = cursor.at(x, y).pixels[cursor.offset(x, y)];
          for (std::size_t k = 0; k < 3; ++k) colour[k] += p.colour[k] * p.alpha;
          alpha += p.alpha;
          ++count;
        }
        Pixel& mean = pixels[std::ptrdiff_t{r} * stride + c];
        mean.alpha = static_cast<std::uint8_t>((alpha + count / 2) / count);
        for (std::size_t k = 0; k < 3; ++k) {
          mean.colour[k] = static_cast<std::uint8_t>(alpha == 0 ? 0 : (colour[k] + alpha / 2) / alpha);
        }
      }
    }
  }

  std::unique_ptr<GdalRaster> raster_;
  ImageFormat format_;
  SourceInfo info_;
  std::vector<PixelGrid> grids_;  // by level
  mutable TileCache<ImageTile> tiles_;
  mutable TileCache<BoundaryTile> boundaries_;
  mutable std::mutex poles_mutex_;
  mutable std::vector<std::array<std::optional<Pixel>, 2>> poles_;
};

}  // namespace

std::shared_ptr<const ImageSource> open_image(const std::string& path) { return open_image(path, {}); }

std::shared_ptr<const ImageSource> open_image(const std::string& path, const PlacementOptions& placement) {
  auto raster = std::make_unique<GdalRaster>(path, placement);
  ImageFormat format = image_format(*raster);
  return std::make_shared<GdalImage>(std::move(raster), std::move(format));
}

}  // namespace mars
