#include "panorama/match/sky_edge.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "panorama/match/sky_cells.h"

namespace panorama {

namespace {

using vpe::core::RgbImage;

// Brightness and colour of a row of pixels over the columns [begin, end).
struct RowMean {
  double brightness = 0;
  double colour = 0;

  RowMean operator-(const RowMean& o) const { return {brightness - o.brightness, colour - o.colour}; }
  RowMean operator+(const RowMean& o) const { return {brightness + o.brightness, colour + o.colour}; }
  double times(const RowMean& o) const { return brightness * o.brightness + colour * o.colour; }
};

// The rows about an edge, from `top` down.
struct EdgeRows {
  int top = 0;
  std::vector<RowMean> means;

  int bottom() const { return top + static_cast<int>(means.size()); }
  const RowMean& at(int row) const { return means[static_cast<std::size_t>(row - top)]; }
  bool has(int row) const { return row >= top && row < bottom(); }
};

RowMean row_mean(const RgbImage& image, int begin, int end, int row) {
  RowMean mean;
  for (int x = begin; x < end; ++x) {
    const vpe::base::Rgb& p =
        image.pixels[static_cast<std::size_t>(row) * static_cast<std::size_t>(image.width) +
                     static_cast<std::size_t>(x)];
    mean.brightness += (p.r + p.g + p.b) / 3.0;
    mean.colour += p.r - p.b;
  }
  const double count = end - begin;
  return {mean.brightness / count, mean.colour / count};
}

// The first row of the lower side of the largest step between pairs of rows.
int largest_step(const EdgeRows& rows, int middle, int reach) {
  int best = middle;
  double largest = -1;
  for (int y = std::max(rows.top + 2, middle - reach); y <= std::min(rows.bottom() - 2, middle + reach); ++y) {
    const RowMean step = rows.at(y) + rows.at(y + 1) - rows.at(y - 1) - rows.at(y - 2);
    if (const double size = step.times(step); size > largest) {
      largest = size;
      best = y;
    }
  }
  return best;
}

// The mean of `count` rows from `row` on in steps of `step`; false where there is none.
bool level_of(const EdgeRows& rows, int row, int step, int count, RowMean& mean) {
  int counted = 0;
  for (int k = 0; k < count; ++k, row += step) {
    if (!rows.has(row)) break;
    mean = mean + rows.at(row);
    ++counted;
  }
  if (counted > 0) mean = {mean.brightness / counted, mean.colour / counted};
  return counted > 0;
}

}  // namespace

double sky_edge_row(const RgbImage& image, int cell_px, int column, int row) {
  constexpr int kMixed = 1;  // rows on each side of the step that can be a mixture
  const int begin = std::max(0, (column - 1) * cell_px);
  const int end = std::min(image.width, (column + 2) * cell_px);
  const int middle = row * cell_px;
  EdgeRows rows{std::max(0, middle - kSkyWindow * cell_px), {}};
  const int bottom = std::min(image.height, middle + kSkyWindow * cell_px);
  for (int y = rows.top; y < bottom; ++y) rows.means.push_back(row_mean(image, begin, end, y));

  const int best = largest_step(rows, middle, cell_px + 1);
  const int near = std::max(2, cell_px);
  RowMean above;
  RowMean below;
  if (!level_of(rows, best - 1 - kMixed, -1, near, above) || !level_of(rows, best + kMixed, 1, near, below))
    return best;
  const RowMean change = below - above;
  const double norm = change.times(change);
  if (!(norm > 0)) return best;
  double sky = 0;
  for (int y = best - kMixed; y < best + kMixed; ++y)
    sky += rows.has(y) ? std::clamp((below - rows.at(y)).times(change) / norm, 0.0, 1.0) : 0.5;
  return best - kMixed + sky;
}

}  // namespace panorama
