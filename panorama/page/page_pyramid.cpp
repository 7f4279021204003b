#include "panorama/page/page_pyramid.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace panorama {

namespace {

using vpe::base::Rgb;

// A pixel of the source along one axis, with its share of a mean.
struct Share {
  std::int64_t at = 0;
  float weight = 0;
};

// One axis of an image: columns or rows of the map's image, and of a level of the source.
struct Axis {
  double side_px = 0;        // of the map's image
  double turn_px = 0;        // of a closed image; 0: it ends at its edges
  double origin_px = 0;      // of the map's image in the source's level 0
  double scale = 1;          // pixels of the source's level to one of its level 0
  std::int64_t last_px = 0;  // of the source's level
};

// Adds the pixels of the source that [begin, end) of the map's image covers.
void add_shares(const Axis& axis, double begin, double end, std::vector<Share>& shares) {
  const double from = (axis.origin_px + begin) * axis.scale;
  const double to = (axis.origin_px + end) * axis.scale;
  // What rounding alone lets reach into a pixel does not count.
  constexpr double kNothing_px = 1e-6;
  for (auto at = static_cast<std::int64_t>(std::floor(from + kNothing_px));
       static_cast<double>(at) < to - kNothing_px; ++at) {
    const double overlap = std::min(to, static_cast<double>(at + 1)) - std::max(from, static_cast<double>(at));
    shares.push_back({std::clamp(at, std::int64_t{0}, axis.last_px), static_cast<float>(overlap)});
  }
}

// Returns the shares of the pixels that make [begin, end) of the map's image, also beyond its edges. Their sum
// is 1.
std::vector<Share> shares_of(const Axis& axis, double begin, double end) {
  std::vector<Share> shares;
  if (axis.turn_px > 0.0) {
    const double shift = std::floor(begin / axis.turn_px) * axis.turn_px;
    begin -= shift;
    end -= shift;
    if (end > axis.turn_px) add_shares(axis, 0.0, std::min(end - axis.turn_px, axis.side_px), shares);
  }
  const double inner_begin = std::max(begin, 0.0);
  const double inner_end = std::min(end, axis.side_px);
  if (inner_end > inner_begin) add_shares(axis, inner_begin, inner_end, shares);
  if (shares.empty()) {
    const double edge = begin < 0.0 ? 0.0 : axis.side_px - 1.0;
    add_shares(axis, edge, edge + 1.0, shares);
  }
  float sum = 0.0F;
  for (const Share& share : shares) sum += share.weight;
  for (Share& share : shares) share.weight /= sum;
  return shares;
}

// Returns the shares of `count` pixels of a level from `first` on.
std::vector<std::vector<Share>> all_shares(const Axis& axis, int level, std::int64_t first,
                                           std::int64_t count) {
  const double side = std::ldexp(1.0, level);
  std::vector<std::vector<Share>> all;
  all.reserve(static_cast<std::size_t>(count));
  for (std::int64_t n = first; n < first + count; ++n)
    all.push_back(shares_of(axis, static_cast<double>(n) * side, static_cast<double>(n + 1) * side));
  return all;
}

// Returns the level of the source to read from: the smallest whose pixels are those of the wanted level, or at
// most about half as large. In between, means would be blurred unevenly.
int source_level(const std::vector<ImageLevel>& levels, int wanted) {
  const double side = std::ldexp(1.0, wanted);
  int best = 0;
  for (std::size_t n = 1; n < levels.size(); ++n) {
    const double across =
        side * static_cast<double>(levels[n].width_px) / static_cast<double>(levels[0].width_px);
    const double down =
        side * static_cast<double>(levels[n].height_px) / static_cast<double>(levels[0].height_px);
    constexpr double kHalf = 1.9;
    if ((across == 1.0 && down == 1.0) || std::min(across, down) >= kHalf) best = static_cast<int>(n);
  }
  return best;
}

// Reads rows of a level of the source. Keeps the tile that it used last.
class RowReader {
 public:
  RowReader(const TiledImage& image, int level)
      : image_(image), level_(level), size_(image.levels()[static_cast<std::size_t>(level)]) {}

  // Adds the means along a row, times a weight, to sums of three numbers a pixel.
  void add_row(std::int64_t y, float weight, const std::vector<std::vector<Share>>& columns,
               std::vector<float>& sums) {
    std::size_t n = 0;
    for (const std::vector<Share>& shares : columns) {
      for (const Share& share : shares) {
        const Rgb& pixel = at(share.at, y);
        const float part = weight * share.weight;
        sums[n] += part * static_cast<float>(pixel.r);
        sums[n + 1] += part * static_cast<float>(pixel.g);
        sums[n + 2] += part * static_cast<float>(pixel.b);
      }
      n += 3;
    }
  }

 private:
  const Rgb& at(std::int64_t x, std::int64_t y) {
    const std::int64_t column = x / size_.tile_width_px;
    const std::int64_t row = y / size_.tile_height_px;
    if (tile_ == nullptr || column != column_ || row != row_) {
      tile_ = image_.tile(level_, column, row);
      column_ = column;
      row_ = row;
    }
    const std::int64_t place =
        (y - row * size_.tile_height_px) * tile_->width_px + x - column * size_.tile_width_px;
    return tile_->pixels[static_cast<std::size_t>(place)];
  }

  const TiledImage& image_;
  int level_;
  ImageLevel size_;
  std::shared_ptr<const Tile> tile_;
  std::int64_t column_ = 0;
  std::int64_t row_ = 0;
};

std::uint8_t rounded_byte(float value) {
  return static_cast<std::uint8_t>(std::clamp(std::lround(value), 0L, 255L));
}

// Returns whether the image goes on at its other side.
bool goes_round(const PanoramaMap& map) { return static_cast<double>(map.width_px) > map.turn_px - 1.0; }

}  // namespace

std::int64_t PagePyramid::all_tiles() const {
  std::int64_t count = 0;
  for (int level = 0; level < levels; ++level) count += columns(level) * rows(level);
  return count;
}

PagePyramid pyramid_of(const PanoramaMap& map) {
  PagePyramid pyramid{map.width_px, map.height_px, 1};
  while (pyramid.columns(pyramid.levels - 1) > 1 || pyramid.rows(pyramid.levels - 1) > 1) ++pyramid.levels;
  return pyramid;
}

vpe::core::RgbImage read_page_pixels(const PageImage& from, int level, const PageRectangle& rectangle) {
  const std::vector<ImageLevel>& levels = from.image.levels();
  const int source = source_level(levels, level);
  const ImageLevel& size = levels[static_cast<std::size_t>(source)];
  const PanoramaMap& map = from.map;
  const Axis across{static_cast<double>(map.width_px), goes_round(map) ? map.turn_px : 0.0,
                    static_cast<double>(from.origin.x_px),
                    static_cast<double>(size.width_px) / static_cast<double>(levels[0].width_px),
                    size.width_px - 1};
  const Axis down{static_cast<double>(map.height_px), 0.0, static_cast<double>(from.origin.y_px),
                  static_cast<double>(size.height_px) / static_cast<double>(levels[0].height_px),
                  size.height_px - 1};
  const auto columns = all_shares(across, level, rectangle.x, rectangle.width_px);
  const auto rows = all_shares(down, level, rectangle.y, rectangle.height_px);
  vpe::core::RgbImage out{static_cast<int>(rectangle.width_px), static_cast<int>(rectangle.height_px), {}};
  out.pixels.reserve(columns.size() * rows.size());
  RowReader reader(from.image, source);
  std::vector<float> sums(3 * columns.size());
  for (const std::vector<Share>& shares : rows) {
    std::fill(sums.begin(), sums.end(), 0.0F);
    for (const Share& share : shares) reader.add_row(share.at, share.weight, columns, sums);
    for (std::size_t n = 0; n < sums.size(); n += 3)
      out.pixels.push_back({rounded_byte(sums[n]), rounded_byte(sums[n + 1]), rounded_byte(sums[n + 2])});
  }
  return out;
}

vpe::core::RgbImage read_page_tile(const PageImage& from, const PagePyramid& pyramid, int level,
                                   std::int64_t column, std::int64_t row) {
  const std::int64_t x = column * kPageTile_px;
  const std::int64_t y = row * kPageTile_px;
  const std::int64_t width_px = std::min(kPageTile_px, pyramid.level_width_px(level) - x);
  const std::int64_t height_px = std::min(kPageTile_px, pyramid.level_height_px(level) - y);
  return read_page_pixels(
      from, level,
      {x - kPageBorder_px, y - kPageBorder_px, width_px + 2 * kPageBorder_px, height_px + 2 * kPageBorder_px});
}

}  // namespace panorama
