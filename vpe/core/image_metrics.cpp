#include "vpe/core/image_metrics.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "vpe/base/quantile.h"

namespace vpe::core {

namespace {

constexpr int kWindow = 11;
constexpr double kSigma_px = 1.5;

void require_size(std::size_t a, std::size_t b, const char* what) {
  if (a != b)
    throw std::invalid_argument(std::string(what) + ": images of " + std::to_string(a) + " and " +
                                std::to_string(b) + " pixels");
}

void require_sides(std::size_t pixels, int width, int height, const char* what) {
  if (width < 1 || height < 1 || pixels != static_cast<std::size_t>(width) * static_cast<std::size_t>(height)) {
    throw std::invalid_argument(std::string(what) + ": " + std::to_string(pixels) + " pixels are not " +
                                std::to_string(width) + "x" + std::to_string(height));
  }
}

std::array<double, kWindow> gaussian() {
  std::array<double, kWindow> weights{};
  double sum = 0;
  for (int k = 0; k < kWindow; ++k) {
    constexpr int kMiddle = kWindow / 2;
    const double x = k - kMiddle;
    weights[static_cast<std::size_t>(k)] = std::exp(-x * x / (2 * kSigma_px * kSigma_px));
    sum += weights[static_cast<std::size_t>(k)];
  }
  for (double& w : weights) w /= sum;
  return weights;
}

// Returns the means under the windows that lie inside the image: kWindow - 1 fewer columns and rows.
std::vector<double> windowed(const std::vector<double>& values, std::size_t width, std::size_t height) {
  static const std::array<double, kWindow> kWeights = gaussian();
  const std::size_t columns = width - kWindow + 1;
  const std::size_t rows = height - kWindow + 1;
  std::vector<double> across(columns * height);
  for (std::size_t y = 0; y < height; ++y) {
    for (std::size_t x = 0; x < columns; ++x) {
      double sum = 0;
      for (std::size_t k = 0; k < kWindow; ++k) sum += kWeights[k] * values[y * width + x + k];
      across[y * columns + x] = sum;
    }
  }
  std::vector<double> means(columns * rows);
  for (std::size_t y = 0; y < rows; ++y) {
    for (std::size_t x = 0; x < columns; ++x) {
      double sum = 0;
      for (std::size_t k = 0; k < kWindow; ++k) sum += kWeights[k] * across[(y + k) * columns + x];
      means[y * columns + x] = sum;
    }
  }
  return means;
}

std::vector<double> luma(std::span<const base::Rgb> colours) {
  std::vector<double> values;
  values.reserve(colours.size());
  for (const base::Rgb& c : colours) values.push_back(0.299 * c.r + 0.587 * c.g + 0.114 * c.b);
  return values;
}

std::vector<double> product(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<double> values(a.size());
  for (std::size_t k = 0; k < a.size(); ++k) values[k] = a[k] * b[k];
  return values;
}

bool is_ground(float range_m) { return range_m > 0.0F && std::isfinite(range_m); }

Spread spread_of(std::vector<double> values) {
  Spread spread;
  if (values.empty()) return spread;
  std::sort(values.begin(), values.end());
  spread.count = static_cast<std::int64_t>(values.size());
  spread.median = base::sorted_quantile_rank(values, 0.5);
  spread.p99 = base::sorted_quantile_rank(values, 0.99);
  spread.max = values.back();
  return spread;
}

}  // namespace

double colour_rms(std::span<const base::Rgb> a, std::span<const base::Rgb> b) {
  require_size(a.size(), b.size(), "colour_rms");
  if (a.empty()) return 0;
  std::int64_t sum = 0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    const int r = a[k].r - b[k].r;
    const int g = a[k].g - b[k].g;
    const int blue = a[k].b - b[k].b;
    sum += r * r + g * g + blue * blue;
  }
  return std::sqrt(static_cast<double>(sum) / (3.0 * static_cast<double>(a.size())));
}

double structural_similarity(std::span<const base::Rgb> a, std::span<const base::Rgb> b, int width,
                             int height) {
  constexpr double kC1 = (0.01 * 255) * (0.01 * 255);
  constexpr double kC2 = (0.03 * 255) * (0.03 * 255);
  require_size(a.size(), b.size(), "structural_similarity");
  require_sides(a.size(), width, height, "structural_similarity");
  if (width < kWindow || height < kWindow)
    throw std::invalid_argument("structural_similarity: both sides must be at least 11 pixels");
  const auto w = static_cast<std::size_t>(width);
  const auto h = static_cast<std::size_t>(height);
  const std::vector<double> x = luma(a);
  const std::vector<double> y = luma(b);
  const std::vector<double> mean_x = windowed(x, w, h);
  const std::vector<double> mean_y = windowed(y, w, h);
  const std::vector<double> mean_xx = windowed(product(x, x), w, h);
  const std::vector<double> mean_yy = windowed(product(y, y), w, h);
  const std::vector<double> mean_xy = windowed(product(x, y), w, h);
  double sum = 0;
  for (std::size_t k = 0; k < mean_x.size(); ++k) {
    const double both = mean_x[k] * mean_y[k];
    const double squares = mean_x[k] * mean_x[k] + mean_y[k] * mean_y[k];
    const double variances = mean_xx[k] + mean_yy[k] - squares;
    sum += (2 * both + kC1) * (2 * (mean_xy[k] - both) + kC2) / ((squares + kC1) * (variances + kC2));
  }
  return sum / static_cast<double>(mean_x.size());
}

Spread range_error(std::span<const float> range_m, std::span<const float> reference_m) {
  require_size(range_m.size(), reference_m.size(), "range_error");
  std::vector<double> errors;
  for (std::size_t k = 0; k < range_m.size(); ++k) {
    if (!is_ground(range_m[k]) || !is_ground(reference_m[k])) continue;
    const auto truth = static_cast<double>(reference_m[k]);
    errors.push_back(std::abs(static_cast<double>(range_m[k]) - truth) / truth);
  }
  return spread_of(std::move(errors));
}

Spread skyline_shift_px(std::span<const float> range_m, std::span<const float> reference_m, int width,
                        int height) {
  require_size(range_m.size(), reference_m.size(), "skyline_shift_px");
  require_sides(range_m.size(), width, height, "skyline_shift_px");
  const auto w = static_cast<std::size_t>(width);
  const auto skyline = [&](std::span<const float> range, std::size_t x) {
    int y = 0;
    while (y < height && !is_ground(range[static_cast<std::size_t>(y) * w + x])) ++y;
    return y;
  };
  std::vector<double> shifts;
  for (std::size_t x = 0; x < w; ++x) {
    const int drawn = skyline(range_m, x);
    const int truth = skyline(reference_m, x);
    const bool inside = (drawn > 0 && drawn < height) || (truth > 0 && truth < height) || drawn != truth;
    if (inside) shifts.push_back(std::abs(drawn - truth));
  }
  return spread_of(std::move(shifts));
}

}  // namespace vpe::core
