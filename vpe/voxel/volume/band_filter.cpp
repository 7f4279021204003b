#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <utility>

#include "vpe/voxel/volume/band_volume.h"
#include "vpe/voxel/volume/cube_share.h"

namespace vpe::voxel {

namespace {

// Heights that go on beyond the border of their grid.
class ReflectedHeights {
 public:
  ReflectedHeights(const VolumeHeights& grid, int margin)
      : margin_(margin), columns_(grid.columns + 2 * margin) {
    const int rows = grid.rows + 2 * margin;
    heights_.resize(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows));
    // Rows of the grid first, which those beyond it follow from.
    for (int j = 0; j < grid.rows; ++j) {
      const float* row =
          grid.heights.data() + static_cast<std::size_t>(j) * static_cast<std::size_t>(grid.columns);
      extend(
          grid.columns, [&](int i) -> double& { return at(i, j); },
          [&](int i) { return static_cast<double>(row[i]); });
    }
    for (int i = -margin; i < grid.columns + margin; ++i)
      extend(
          grid.rows, [&](int j) -> double& { return at(i, j); }, [&](int j) { return at(i, j); });
  }

  // Takes places from -margin to the last one and a margin.
  double& at(int i, int j) {
    return heights_[static_cast<std::size_t>(j + margin_) * static_cast<std::size_t>(columns_) +
                    static_cast<std::size_t>(i + margin_)];
  }

 private:
  template <class To, class From>
  void extend(int count, const To& to, const From& from) {
    for (int n = 0; n < count; ++n) to(n) = from(n);
    const int last = count - 1;
    for (int n = 1; n <= margin_; ++n) {
      // Places that a reflection at one end takes beyond the other one have been set before.
      to(-n) = 2 * to(0) - to(n);
      to(last + n) = 2 * to(last) - to(last - n);
    }
  }

  int margin_;
  int columns_;
  std::vector<double> heights_;
};

// The densities of a row of columns before they are rounded, 0 to 1: 1 below those of a column, 0 above.
class Profiles {
 public:
  void clear() {
    first_.clear();
    begin_.assign(1, 0);
    values_.clear();
  }
  void add(int first, const std::vector<float>& values) {
    first_.push_back(first);
    values_.insert(values_.end(), values.begin(), values.end());
    begin_.push_back(values_.size());
  }
  int first(int n) const { return first_[static_cast<std::size_t>(n)]; }
  int end(int n) const {
    const auto at = static_cast<std::size_t>(n);
    return first_[at] + static_cast<int>(begin_[at + 1] - begin_[at]);
  }
  const float* values(int n) const { return values_.data() + begin_[static_cast<std::size_t>(n)]; }

 private:
  std::vector<int> first_;
  std::vector<std::size_t> begin_{0};
  std::vector<float> values_;
};

// Adds up weighted columns.
class ProfileSum {
 public:
  void begin(int first, int end) {
    first_ = first;
    const auto levels = static_cast<std::size_t>(std::max(end - first, 0));
    sum_.assign(levels, 0.0F);
    falls_.assign(levels + 1, 0.0F);
    full_ = 0;
  }
  void add(float weight, const Profiles& row, int n) {
    const auto full = static_cast<std::size_t>(row.first(n) - first_);
    const auto count = static_cast<std::size_t>(row.end(n) - row.first(n));
    full_ += weight;
    falls_[full] += weight;
    const float* const values = row.values(n);
    float* const sum = sum_.data() + full;
    for (std::size_t k = 0; k < count; ++k) sum[k] += weight * values[k];
  }
  // Adds what is full below the columns, after the last of them.
  void finish() {
    float full = full_;
    for (std::size_t k = 0; k < sum_.size(); ++k) {
      full -= falls_[k];
      sum_[k] += full;
    }
  }
  int first() const { return first_; }
  const std::vector<float>& values() const { return sum_; }

 private:
  int first_ = 0;
  std::vector<float> sum_;
  std::vector<float> falls_;  // weight of the columns whose own densities begin there
  float full_ = 0;
};

void check_band(const VolumeHeights& grid, const BandSpec& spec) {
  const auto require = [](bool is_met, const std::string& problem) {
    if (!is_met) throw std::invalid_argument("a band of voxels: " + problem);
  };
  require(spec.sigma >= 0.5 && spec.sigma <= 4, "expected a sigma of 0.5 to 4 voxels");
  require(spec.box_radius >= 1 && spec.box_radius <= 4, "expected a radius of the box of 1 to 4 voxels");
  require(
      grid.columns >= 2 && grid.rows >= 2 && grid.columns <= kMostVolumeSide && grid.rows <= kMostVolumeSide,
      "expected 2 to " + std::to_string(kMostVolumeSide) + " columns and rows");
  require(grid.heights.size() == static_cast<std::size_t>(grid.columns) * static_cast<std::size_t>(grid.rows),
          "the heights must fill the grid");
  constexpr float kMost = kMostBandLevel - 200;
  require(std::all_of(grid.heights.begin(), grid.heights.end(), [](float h) { return std::abs(h) <= kMost; }),
          "a height is not finite, or farther than " + std::to_string(kMostBandLevel - 200) +
              " levels from the middle");
}

// Half of a Gaussian from its middle; one weight without it.
std::vector<float> band_kernel(const BandSpec& spec) {
  if (spec.filter != VolumeFilter::kGaussian) return {1.0F};
  constexpr double kReach = 4;  // of sigma
  std::vector<double> kernel(static_cast<std::size_t>(std::ceil(kReach * spec.sigma)) + 1);
  double sum = 0;
  for (std::size_t n = 0; n < kernel.size(); ++n) {
    const double x = static_cast<double>(n) / spec.sigma;
    kernel[n] = std::exp(-0.5 * x * x);
    sum += n == 0 ? kernel[n] : 2 * kernel[n];
  }
  std::vector<float> out;
  for (const double weight : kernel) out.push_back(static_cast<float>(weight / sum));
  return out;
}

// Adds the column of a post, smoothed along z.
void add_column(ReflectedHeights& heights, int i, int j, const BandSpec& spec, const std::vector<float>& kernel,
                std::vector<float>& raw, std::vector<float>& smoothed, Profiles& out) {
  const double height = heights.at(i, j);
  smoothed.clear();
  if (spec.filter == VolumeFilter::kNone) {
    out.add(static_cast<int>(std::ceil(height)), smoothed);
    return;
  }
  const double x_slope = 0.5 * (heights.at(i + 1, j) - heights.at(i - 1, j));
  const double y_slope = 0.5 * (heights.at(i, j + 1) - heights.at(i, j - 1));
  const double length = std::sqrt(1 + x_slope * x_slope + y_slope * y_slope);
  // Voxels farther away are all ground or all air.
  const double half = spec.filter == VolumeFilter::kBox
                          ? spec.box_radius * length
                          : 0.5 * (1 + std::abs(x_slope) + std::abs(y_slope)) + 1e-3 * length;
  const int from = static_cast<int>(std::floor(height - half));
  const int to = static_cast<int>(std::ceil(height + half)) + 1;
  const auto reach = static_cast<int>(kernel.size()) - 1;
  // raw[0] is level from - 2 reach.
  raw.assign(static_cast<std::size_t>(to - from + 4 * reach), 0.0F);
  std::fill_n(raw.begin(), 2 * reach, 1.0F);
  const glm::dvec3 normal{-x_slope / length, -y_slope / length, 1 / length};
  for (int k = from; k < to; ++k) {
    const double depth = (height - k) / length;
    raw[static_cast<std::size_t>(k - from + 2 * reach)] = static_cast<float>(
        spec.filter == VolumeFilter::kBox ? std::clamp(0.5 + depth / (2 * spec.box_radius), 0.0, 1.0)
                                          : cube_share_below(normal, depth));
  }
  const auto count = static_cast<std::size_t>(to - from + 2 * reach);
  const float* const middle = raw.data() + reach;
  smoothed.resize(count);
  for (std::size_t k = 0; k < count; ++k) smoothed[k] = kernel[0] * middle[k];
  for (std::ptrdiff_t m = 1; m <= reach; ++m) {
    const float weight = kernel[static_cast<std::size_t>(m)];
    const float* const above = middle + m;
    const float* const below = middle - m;
    for (std::size_t k = 0; k < count; ++k) smoothed[k] += weight * (above[k] + below[k]);
  }
  out.add(from - reach, smoothed);
}

// Sums the columns n - reach to n + reach that `column` names as a row and a place in it.
template <class Column>
void sum_columns(const std::vector<float>& kernel, const Column& column, ProfileSum& sum) {
  const int reach = static_cast<int>(kernel.size()) - 1;
  int first = kMostBandLevel * 2;
  int end = -first;
  for (int m = -reach; m <= reach; ++m) {
    const auto [row, n] = column(m);
    first = std::min(first, row->first(n));
    end = std::max(end, row->end(n));
  }
  sum.begin(first, end);
  for (int m = -reach; m <= reach; ++m) {
    const auto [row, n] = column(m);
    sum.add(kernel[static_cast<std::size_t>(std::abs(m))], *row, n);
  }
  sum.finish();
}

}  // namespace

BandVolume make_band_volume(const VolumeHeights& grid, const BandSpec& spec) {
  check_band(grid, spec);
  const std::vector<float> kernel = band_kernel(spec);
  const int reach = static_cast<int>(kernel.size()) - 1;
  ReflectedHeights heights(grid, reach + 1);
  std::vector<float> raw;
  std::vector<float> smoothed;
  ProfileSum sum;
  Profiles along_z;
  std::vector<Profiles> along_x(static_cast<std::size_t>(grid.rows + 2 * reach));
  for (int j = -reach; j < grid.rows + reach; ++j) {
    along_z.clear();
    for (int i = -reach; i < grid.columns + reach; ++i)
      add_column(heights, i, j, spec, kernel, raw, smoothed, along_z);
    Profiles& row = along_x[static_cast<std::size_t>(j + reach)];
    for (int i = 0; i < grid.columns; ++i) {
      sum_columns(
          kernel, [&](int m) { return std::pair(&along_z, i + reach + m); }, sum);
      row.add(sum.first(), sum.values());
    }
  }
  BandColumns columns;
  std::vector<std::uint8_t> densities;
  for (int j = 0; j < grid.rows; ++j) {
    for (int i = 0; i < grid.columns; ++i) {
      sum_columns(
          kernel, [&](int m) { return std::pair(&along_x[static_cast<std::size_t>(j + reach + m)], i); }, sum);
      densities.clear();
      for (const float share : sum.values())
        densities.push_back(static_cast<std::uint8_t>(255 * std::clamp(share, 0.0F, 1.0F) + 0.5F));
      columns.add(sum.first(), densities);
    }
  }
  return {grid.columns, grid.rows, spec.threshold, std::move(columns)};
}

}  // namespace vpe::voxel
