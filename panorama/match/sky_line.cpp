#include "panorama/match/sky_line.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "panorama/match/sky_cells.h"
#include "panorama/match/sky_edge.h"

namespace panorama {

namespace {

using vpe::core::RgbImage;

constexpr int kLeastSide_px = 16;
// The path's gain at an edge is its contrast, up to this; and its loss for each row of contrast above.
constexpr double kMostContrast = 16;
constexpr double kLossAbove = 0.4;
// Loss for each row between neighbours, up to that of a step from a near ridge to a far one.
constexpr double kStepLoss = 0.8;
constexpr double kMostStepLoss = 24;

// The path's loss at each cell; rows out of the data cost as much as an edge that is not there.
std::vector<double> losses(const SkyCells& cells, const std::vector<float>& contrast, double least) {
  std::vector<double> out(contrast.size(), 0.0);
  for (int c = 0; c < cells.columns; ++c) {
    const int first = cells.first_row[static_cast<std::size_t>(c)];
    double above = 0;
    for (int row = 0; row < cells.rows; ++row) {
      if (row - kSkyWindow >= first) {
        const double seen = static_cast<double>(contrast[cells.at(c, row - kSkyWindow)]);
        above += kLossAbove * std::max(0.0, std::min(seen, kMostContrast) - least);
      }
      const double here = static_cast<double>(contrast[cells.at(c, row)]);
      out[cells.at(c, row)] = above - std::min(here, kMostContrast);
    }
  }
  return out;
}

// The row of least loss in each column, for the path as a whole.
std::vector<int> best_path(const SkyCells& cells, const std::vector<double>& loss) {
  const auto rows = static_cast<std::size_t>(cells.rows);
  const auto columns = static_cast<std::size_t>(cells.columns);
  std::vector<int> from(loss.size());
  std::vector<double> total(rows);
  for (std::size_t r = 0; r < rows; ++r) total[r] = loss[cells.at(0, static_cast<int>(r))];
  std::vector<double> reach(rows);
  std::vector<int> origin(rows);
  for (int c = 1; c < cells.columns; ++c) {
    const auto least = static_cast<std::size_t>(std::min_element(total.begin(), total.end()) - total.begin());
    for (std::size_t r = 0; r < rows; ++r) {
      reach[r] = total[r];
      origin[r] = static_cast<int>(r);
    }
    for (std::size_t r = 1; r < rows; ++r) {
      if (reach[r - 1] + kStepLoss < reach[r]) {
        reach[r] = reach[r - 1] + kStepLoss;
        origin[r] = origin[r - 1];
      }
    }
    for (std::size_t r = rows - 1; r-- > 0;) {
      if (reach[r + 1] + kStepLoss < reach[r]) {
        reach[r] = reach[r + 1] + kStepLoss;
        origin[r] = origin[r + 1];
      }
    }
    for (std::size_t r = 0; r < rows; ++r) {
      if (total[least] + kMostStepLoss < reach[r]) {
        reach[r] = total[least] + kMostStepLoss;
        origin[r] = static_cast<int>(least);
      }
      const std::size_t n = cells.at(c, static_cast<int>(r));
      from[n] = origin[r];
      total[r] = reach[r] + loss[n];
    }
  }
  std::vector<int> path(columns);
  path.back() = static_cast<int>(std::min_element(total.begin(), total.end()) - total.begin());
  for (std::size_t c = columns - 1; c > 0; --c) path[c - 1] = from[cells.at(static_cast<int>(c), path[c])];
  return path;
}

}  // namespace

SkyLine find_sky_line(const RgbImage& image, const SkyLineOptions& options) {
  if (image.width < kLeastSide_px || image.height < kLeastSide_px)
    throw std::invalid_argument("a photograph must have at least 16 x 16 pixels");
  if (image.pixels.size() != static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height))
    throw std::invalid_argument("the photograph's pixels do not fit its size");
  if (options.nodata_level < 0 || options.nodata_level > 254)
    throw std::invalid_argument("nodata_level must be within 0..254");
  if (!(options.least_contrast >= 2) || !(options.least_contrast <= 50))
    throw std::invalid_argument("least_contrast must be within 2..50");

  const SkyCells cells = sky_cells(image, options.nodata_level);
  const std::vector<float> contrast = sky_contrast(cells);
  const std::vector<int> path = best_path(cells, losses(cells, contrast, options.least_contrast));
  SkyLine out;
  out.columns = cells.columns;
  out.noise = cells.brightness_noise;
  for (int c = 0; c < cells.columns; ++c) {
    const auto n = static_cast<std::size_t>(c);
    // Gain is limited, so the path may run beside the middle of a strong edge.
    int row = path[n];
    for (int k = std::max(0, path[n] - kSkyWindow + 1); k < std::min(cells.rows, path[n] + kSkyWindow); ++k) {
      if (contrast[cells.at(c, k)] > contrast[cells.at(c, row)]) row = k;
    }
    if (row < cells.first_row[n] + kLeastSkyRows || row + kSkyWindow > cells.end_row[n]) {
      ++out.columns_without_sky;
      continue;
    }
    const double seen = static_cast<double>(contrast[cells.at(c, row)]);
    if (seen < options.least_contrast) {
      ++out.columns_without_edge;
      continue;
    }
    const double weight = std::min(1.0, seen / (3 * options.least_contrast));
    out.points.push_back({(c + 0.5) * cells.size_px, sky_edge_row(image, cells.size_px, c, row), weight});
  }
  return out;
}

}  // namespace panorama
