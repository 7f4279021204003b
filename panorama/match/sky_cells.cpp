#include "panorama/match/sky_cells.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "panorama/match/sky_line.h"

namespace panorama {

namespace {

using vpe::core::RgbImage;

constexpr double kWholeNumberNoise = 0.6;
constexpr double kMedianToSigma = 1.4826;
constexpr int kNoiseBlock = 12;
constexpr double kSmoothestShare = 0.3;

// Rows of data that a column needs before it counts as begun: more than a thin line has.
constexpr int kDataRows = 4;

double median_of(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

void find_data(SkyCells& cells, const std::vector<bool>& has_data) {
  const auto columns = static_cast<std::size_t>(cells.columns);
  cells.first_row.assign(columns, cells.rows);
  cells.end_row.assign(columns, cells.rows);
  for (int c = 0; c < cells.columns; ++c) {
    const auto runs = [&](int row) {
      for (int k = 0; k < kDataRows; ++k) {
        // A vertical line is thin as well: both neighbours must have data.
        for (int side = -2; side <= 2; side += 2) {
          const int neighbour = std::clamp(c + side, 0, cells.columns - 1);
          if (row + k >= cells.rows || !has_data[cells.at(neighbour, row + k)]) return false;
        }
      }
      return true;
    };
    const auto n = static_cast<std::size_t>(c);
    int row = 0;
    while (row < cells.rows && !runs(row)) ++row;
    cells.first_row[n] = row;
    while (row < cells.rows && has_data[cells.at(c, row)]) ++row;
    cells.end_row[n] = row;
  }
}

// Second differences along rows are free of smooth gradients.
double noise_of(const SkyCells& cells, const std::vector<float>& values) {
  std::vector<double> blocks;
  for (int row = 0; row + kNoiseBlock <= cells.rows; row += kNoiseBlock) {
    for (int column = 1; column + kNoiseBlock < cells.columns; column += kNoiseBlock) {
      std::vector<double> differences;
      for (int y = row; y < row + kNoiseBlock; ++y) {
        for (int x = column; x < column + kNoiseBlock; ++x) {
          const auto n = static_cast<std::size_t>(x);
          if (y < cells.first_row[n] || y >= cells.end_row[n]) continue;
          differences.push_back(
              std::abs(values[cells.at(x - 1, y)] - 2.0 * values[cells.at(x, y)] + values[cells.at(x + 1, y)]));
        }
      }
      if (differences.size() >= kNoiseBlock * kNoiseBlock / 2) blocks.push_back(median_of(differences));
    }
  }
  if (blocks.empty()) return kWholeNumberNoise;
  const auto nth =
      blocks.begin() + static_cast<std::ptrdiff_t>(kSmoothestShare * static_cast<double>(blocks.size()));
  std::nth_element(blocks.begin(), nth, blocks.end());
  return std::max(kWholeNumberNoise, kMedianToSigma * *nth / std::sqrt(6.0));
}

}  // namespace

SkyCells sky_cells(const RgbImage& image, int nodata_level) {
  SkyCells cells;
  cells.size_px = std::max(
      {1, (image.width + kMaxSkyColumns - 1) / kMaxSkyColumns, (image.height + kMaxSkyRows - 1) / kMaxSkyRows});
  cells.columns = image.width / cells.size_px;
  cells.rows = image.height / cells.size_px;
  const std::size_t count = static_cast<std::size_t>(cells.columns) * static_cast<std::size_t>(cells.rows);
  cells.brightness.resize(count);
  cells.colour.resize(count);
  std::vector<bool> has_data(count);
  for (int row = 0; row < cells.rows; ++row) {
    for (int column = 0; column < cells.columns; ++column) {
      int brightness = 0;
      int colour = 0;
      bool dark = false;
      for (int y = row * cells.size_px; y < (row + 1) * cells.size_px; ++y) {
        for (int x = column * cells.size_px; x < (column + 1) * cells.size_px; ++x) {
          const vpe::base::Rgb& p =
              image.pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                           static_cast<std::size_t>(x)];
          brightness += p.r + p.g + p.b;
          colour += p.r - p.b;
          dark = dark || std::max({p.r, p.g, p.b}) <= nodata_level;
        }
      }
      const auto pixels = static_cast<float>(cells.size_px * cells.size_px);
      const std::size_t n = cells.at(column, row);
      cells.brightness[n] = static_cast<float>(brightness) / (3 * pixels);
      cells.colour[n] = static_cast<float>(colour) / pixels;
      has_data[n] = !dark;
    }
  }
  find_data(cells, has_data);
  cells.brightness_noise = noise_of(cells, cells.brightness);
  cells.colour_noise = noise_of(cells, cells.colour);
  return cells;
}

namespace {

// Noise above each cell, from differences between cells a few columns apart in the rows above; at least `least`.
// Neighbouring pixels of cameras and JPEG depend on each other, so theirs would be too small.
std::vector<float> noise_above(const SkyCells& cells, const std::vector<float>& values, double least) {
  constexpr int kApart = 3;
  constexpr int kSide = 16;
  constexpr int kRows = 8;
  const double mean_to_sigma = 1 / (std::sqrt(6.0) * std::sqrt(2 / std::numbers::pi));
  const auto wide = static_cast<std::size_t>(cells.columns) + 1;
  // Sums over all cells above and to the left, and their numbers.
  std::vector<double> sums(wide * (static_cast<std::size_t>(cells.rows) + 1), 0.0);
  std::vector<double> counts(sums.size(), 0.0);
  const auto place = [&](int column, int row) {
    return static_cast<std::size_t>(row) * wide + static_cast<std::size_t>(column);
  };
  for (int row = 0; row < cells.rows; ++row) {
    double sum = 0;
    double count = 0;
    for (int c = 0; c < cells.columns; ++c) {
      bool data = c >= kApart && c + kApart < cells.columns;
      for (int x = c - kApart; data && x <= c + kApart; x += kApart) {
        const auto n = static_cast<std::size_t>(x);
        data = row >= cells.first_row[n] && row < cells.end_row[n];
      }
      if (data) {
        sum += std::abs(values[cells.at(c - kApart, row)] - 2.0 * values[cells.at(c, row)] +
                        values[cells.at(c + kApart, row)]);
        ++count;
      }
      sums[place(c + 1, row + 1)] = sums[place(c + 1, row)] + sum;
      counts[place(c + 1, row + 1)] = counts[place(c + 1, row)] + count;
    }
  }
  std::vector<float> out(values.size(), static_cast<float>(least));
  for (int row = 1; row < cells.rows; ++row) {
    for (int c = 0; c < cells.columns; ++c) {
      const int left = std::max(0, c - kSide);
      const int right = std::min(cells.columns, c + kSide + 1);
      const int top = std::max(0, row - kRows);
      const auto over = [&](const std::vector<double>& v) {
        return v[place(right, row)] - v[place(left, row)] - v[place(right, top)] + v[place(left, top)];
      };
      const double count = over(counts);
      if (count < kSide) continue;
      out[cells.at(c, row)] = static_cast<float>(std::max(least, over(sums) / count * mean_to_sigma));
    }
  }
  return out;
}

}  // namespace

std::vector<float> sky_contrast(const SkyCells& cells) {
  constexpr int kSide = 1;  // columns to each side
  std::vector<float> out(cells.brightness.size(), 0.0F);
  const double windows = std::sqrt(2.0 / (kSkyWindow * (2 * kSide + 1)));
  const std::vector<float> brightness_unit = noise_above(cells, cells.brightness, cells.brightness_noise);
  const std::vector<float> colour_unit = noise_above(cells, cells.colour, cells.colour_noise);
  std::vector<double> brightness(static_cast<std::size_t>(cells.rows) + 1);
  std::vector<double> colour(brightness.size());
  for (int c = 0; c < cells.columns; ++c) {
    int first = 0;
    int end = cells.rows;
    const int low = std::max(0, c - kSide);
    const int high = std::min(cells.columns - 1, c + kSide);
    for (int x = low; x <= high; ++x) {
      first = std::max(first, cells.first_row[static_cast<std::size_t>(x)]);
      end = std::min(end, cells.end_row[static_cast<std::size_t>(x)]);
    }
    const double share = 1.0 / (high - low + 1);
    for (int row = 0; row < cells.rows; ++row) {
      const auto n = static_cast<std::size_t>(row);
      double b = 0;
      double k = 0;
      for (int x = low; x <= high; ++x) {
        b += static_cast<double>(cells.brightness[cells.at(x, row)]);
        k += static_cast<double>(cells.colour[cells.at(x, row)]);
      }
      brightness[n + 1] = brightness[n] + share * b;
      colour[n + 1] = colour[n] + share * k;
    }
    for (int row = first + kLeastSkyRows; row + kSkyWindow <= end; ++row) {
      const auto n = static_cast<std::size_t>(row);
      // The sky grows brighter downwards, and darker towards a corner: what continues the change above is no edge.
      const auto step = [&](const std::vector<double>& sums) {
        const auto mean = [&](std::size_t begin) {
          return (sums[begin + kSkyWindow] - sums[begin]) / kSkyWindow;
        };
        const double above = mean(n - kSkyWindow);
        const double change = mean(n) - above;
        const double trend = row < first + 3 * kSkyWindow ? above - mean(n - 2 * kSkyWindow)
                                                          : (above - mean(n - 3 * kSkyWindow)) / 2;
        return std::max(0.0, std::abs(change) - std::max(0.0, change > 0 ? trend : -trend));
      };
      const std::size_t cell = cells.at(c, row);
      out[cell] = static_cast<float>(std::hypot(step(brightness) / static_cast<double>(brightness_unit[cell]),
                                                step(colour) / static_cast<double>(colour_unit[cell])) /
                                     windows);
    }
  }
  return out;
}

}  // namespace panorama
