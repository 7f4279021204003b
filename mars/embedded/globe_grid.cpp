#include "mars/embedded/globe_grid.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "mars/embedded/math.h"

namespace mars::embedded {

namespace {

// Returns atan(t) in degrees for 0 <= t <= 1.
[[gnu::always_inline]] inline double small_atan_deg(double t) {
  // Halving the angle twice brings it below 11.25 degrees, where the series needs 11 terms.
  t = t / (1.0 + std::sqrt(1.0 + t * t));
  t = t / (1.0 + std::sqrt(1.0 + t * t));
  const double tt = t * t;
  double sum = 0.0;
  for (int k = 11; k >= 0; --k) sum = 1.0 / (2.0 * k + 1.0) - tt * sum;
  return t * sum * (4.0 * 180.0 / kPi);
}

// Returns the angle of (x, y) from the x axis in degrees, -180..180; 0 at the origin.
[[gnu::always_inline]] inline double angle_deg(double y, double x) {
  const double ax = x < 0.0 ? -x : x;
  const double ay = y < 0.0 ? -y : y;
  const double longer = std::max(ax, ay);
  const double t = std::min(ax, ay) / (longer > 0.0 ? longer : 1.0);
  double angle = small_atan_deg(t);
  angle = ay > ax ? 90.0 - angle : angle;
  angle = x < 0.0 ? 180.0 - angle : angle;
  return y < 0.0 ? -angle : angle;
}

// Lines that are filtered at once: neighbouring meridians, which share cache lines.
constexpr std::size_t kTogether = 16;

// Turns samples on closed lines into the coefficients of the cubic B-splines through them. Sample k of line l is
// lines[k * kTogether + l].
void prefilter(std::vector<double>& lines) {
  constexpr double kPole = -0.26794919243112270647;  // sqrt(3) - 2
  const std::size_t n = lines.size() / kTogether;
  // Recursions start a few posts before their line begins: after 40 posts the start weighs less than rounding.
  const std::size_t lead = std::min<std::size_t>(n, 40);
  std::array<double, kTogether> sum{};
  const auto step = [&](std::size_t k, double own, bool store) {
    double* at = lines.data() + k * kTogether;
    for (std::size_t l = 0; l < kTogether; ++l) {
      sum[l] = own * at[l] + kPole * sum[l];
      if (store) at[l] = sum[l];
    }
  };
  for (std::size_t k = n - lead; k < n; ++k) step(k, 1.0, false);
  for (std::size_t k = 0; k < n; ++k) step(k, 1.0, true);
  sum.fill(0.0);
  for (std::size_t k = lead; k-- > 0;) step(k, -kPole, false);
  for (std::size_t k = n; k-- > 0;) step(k, -kPole, true);
  for (double& x : lines) x *= 6.0;
}

struct Weights {
  double w[4];
};

[[gnu::always_inline]] inline Weights weights(double t) {
  const double s = 1.0 - t;
  return {{s * s * s / 6.0, (4.0 - 6.0 * t * t + 3.0 * t * t * t) / 6.0,
           (4.0 - 6.0 * s * s + 3.0 * s * s * s) / 6.0, t * t * t / 6.0}};
}

[[gnu::always_inline]] inline Weights slopes(double t) {
  const double s = 1.0 - t;
  return {{-0.5 * s * s, -2.0 * t + 1.5 * t * t, 2.0 * s - 1.5 * s * s, 0.5 * t * t}};
}

}  // namespace

void grid_places(const Block& block, int width, GridPlaces& out) {
  const double per_degree = width / 360.0;
  with_simd(block.simd, [&] {
    for (std::size_t i = 0; i < block.padded; ++i) {
      const double x = block.x[i], y = block.y[i], z = block.z[i];
      const double lon = angle_deg(y, x);
      const double lat = angle_deg(z, std::sqrt(x * x + y * y));
      const double east = lon < 0.0 ? lon + 360.0 : lon;
      out.column[i] = east * per_degree - 0.5;
      out.row[i] = (90.0 - lat) * per_degree - 0.5;
    }
  });
}

void grid_cells(const Block& block, const GridPlaces& places, int width, int finer, GridCells& out) {
  const double scale = 1.0 / finer;
  const double last = 0.5 * width - 1.0;
  std::int32_t any = 0;
  with_simd(block.simd, [&] {
    for (std::size_t i = 0; i < block.padded; ++i) {
      const double x = (places.column[i] + 0.5) * scale - 0.5;
      const double y = (places.row[i] + 0.5) * scale - 0.5;
      out.column[i] = floor_int(x);
      out.row[i] = floor_int(y);
      out.x[i] = x - out.column[i];
      out.y[i] = y - out.row[i];
      out.beyond[i] = std::max(-y, y - last);
      any |= static_cast<std::int32_t>(out.beyond[i] > 0.0);
    }
  });
  out.touches_pole = any != 0;
  out.few = 0;
  for (std::size_t i = 0; i < block.padded; ++i) {
    int k = 0;
    while (k < out.few && (out.few_column[k] != out.column[i] || out.few_row[k] != out.row[i])) ++k;
    if (k == GridCells::kFew) {
      out.few = 0;
      return;
    }
    if (k == out.few) {
      out.few_column[k] = out.column[i];
      out.few_row[k] = out.row[i];
      ++out.few;
    }
    out.few_index[i] = k;
  }
}

GlobeSpline GlobeSpline::near(std::span<const float> posts, int width) {
  GlobeSpline spline;
  spline.width_ = width;
  spline.coefficients_.assign(posts.begin(), posts.end());
  spline.find_pole_values();
  return spline;
}

GlobeSpline GlobeSpline::through(std::span<const float> posts, int width) {
  GlobeSpline spline = near(posts, width);
  const auto columns = static_cast<std::size_t>(width);
  const std::size_t rows = columns / 2;
  std::vector<double> lines(columns * kTogether);
  std::vector<float>& c = spline.coefficients_;
  for (std::size_t first = 0; first < rows; first += kTogether) {
    const std::size_t count = std::min(kTogether, rows - first);
    for (std::size_t l = 0; l < count; ++l) {
      for (std::size_t i = 0; i < columns; ++i)
        lines[i * kTogether + l] = static_cast<double>(c[(first + l) * columns + i]);
    }
    prefilter(lines);
    for (std::size_t l = 0; l < count; ++l) {
      for (std::size_t i = 0; i < columns; ++i)
        c[(first + l) * columns + i] = static_cast<float>(lines[i * kTogether + l]);
    }
  }
  // A meridian and the opposite one are a closed line through both poles.
  for (std::size_t first = 0; first < columns / 2; first += kTogether) {
    const std::size_t count = std::min(kTogether, columns / 2 - first);
    for (std::size_t j = 0; j < rows; ++j) {
      const float* row = c.data() + j * columns + first;
      for (std::size_t l = 0; l < count; ++l) {
        lines[j * kTogether + l] = static_cast<double>(row[l]);
        lines[(columns - 1 - j) * kTogether + l] = static_cast<double>(row[l + columns / 2]);
      }
    }
    prefilter(lines);
    for (std::size_t j = 0; j < rows; ++j) {
      float* row = c.data() + j * columns + first;
      for (std::size_t l = 0; l < count; ++l) {
        row[l] = static_cast<float>(lines[j * kTogether + l]);
        row[l + columns / 2] = static_cast<float>(lines[(columns - 1 - j) * kTogether + l]);
      }
    }
  }
  spline.find_pole_values();
  return spline;
}

void GlobeSpline::find_pole_values() {
  const int height = width_ / 2;
  for (int side = 0; side < 2; ++side) {
    double sum = 0.0;
    for (int i = 0; i < width_; ++i) sum += static_cast<double>(at(i, side == 0 ? 0 : height - 1));
    pole_[side] = sum / width_;
  }
}

GlobeSpline::Neighbours GlobeSpline::neighbours(std::int32_t column, std::int32_t row) const {
  Neighbours c;
  for (int b = 0; b < 4; ++b) {
    for (int a = 0; a < 4; ++a)
      c[static_cast<std::size_t>(4 * b + a)] = static_cast<double>(at(column + a - 1, row + b - 1));
  }
  return c;
}

template <class Evaluate>
void GlobeSpline::for_each(const Block& block, const GridCells& cells, const Evaluate& evaluate) const {
  for (int k = 0; k < cells.few; ++k) {
    const Neighbours c = neighbours(cells.few_column[k], cells.few_row[k]);
    with_simd(block.simd, [&] {
      for (std::size_t i = 0; i < block.padded; ++i) evaluate(c, i, cells.few_index[i] == k);
    });
  }
  if (cells.few > 0) return;
  Neighbours c{};
  for (std::size_t i = 0; i < block.padded; ++i) {
    if (i == 0 || cells.column[i] != cells.column[i - 1] || cells.row[i] != cells.row[i - 1])
      c = neighbours(cells.column[i], cells.row[i]);
    evaluate(c, i, true);
  }
}

void GlobeSpline::evaluate(const Block& block, const GridCells& cells, Values& out) const {
  for_each(block, cells, [&cells, &out](const Neighbours& c, std::size_t i, bool own) {
    const Weights wx = weights(cells.x[i]);
    const Weights wy = weights(cells.y[i]);
    const Weights dx = slopes(cells.x[i]);
    const Weights dy = slopes(cells.y[i]);
    double value = 0.0, by_column = 0.0, by_row = 0.0;
    for (std::size_t b = 0; b < 4; ++b) {
      double across = 0.0, steep = 0.0;
      for (std::size_t a = 0; a < 4; ++a) {
        across += wx.w[a] * c[4 * b + a];
        steep += dx.w[a] * c[4 * b + a];
      }
      value += wy.w[b] * across;
      by_column += wy.w[b] * steep;
      by_row += dy.w[b] * across;
    }
    out.value[i] = own ? value : out.value[i];
    out.by_column[i] = own ? by_column : out.by_column[i];
    out.by_row[i] = own ? by_row : out.by_row[i];
  });
  if (!cells.touches_pole) return;
  for (std::size_t i = 0; i < block.padded; ++i) {
    // Within the last circle of posts the meridians agree on one value at the pole.
    if (!(cells.beyond[i] > 0.0)) continue;
    const double share = ramp(0.0, 0.5, cells.beyond[i]);
    out.value[i] = mix(out.value[i], pole_[cells.row[i] < 0 ? 0 : 1], share);
    out.by_column[i] *= 1.0 - share;
    out.by_row[i] *= 1.0 - share;
  }
}

void GlobeSpline::evaluate(const Block& block, const GridCells& cells, Lane<float>& out) const {
  Lane<double> sums;
  for_each(block, cells, [&cells, &sums](const Neighbours& c, std::size_t i, bool own) {
    const Weights wx = weights(cells.x[i]);
    const Weights wy = weights(cells.y[i]);
    double value = 0.0;
    for (std::size_t b = 0; b < 4; ++b) {
      double across = 0.0;
      for (std::size_t a = 0; a < 4; ++a) across += wx.w[a] * c[4 * b + a];
      value += wy.w[b] * across;
    }
    sums[i] = own ? value : sums[i];
  });
  for (std::size_t i = 0; i < block.padded; ++i) {
    if (cells.touches_pole && cells.beyond[i] > 0.0)
      sums[i] = mix(sums[i], pole_[cells.row[i] < 0 ? 0 : 1], ramp(0.0, 0.5, cells.beyond[i]));
    out[i] = static_cast<float>(sums[i]);
  }
}

}  // namespace mars::embedded
