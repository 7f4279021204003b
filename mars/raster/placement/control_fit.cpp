#include "mars/raster/placement/control_fit.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <numeric>
#include <vector>

namespace mars {
namespace {

using Column = std::vector<double>;

// Share of a column that must be left beside the others, if they are to determine its coefficient.
constexpr double kIndependent = 1e-6;
// Least share of a point's own residual that its fit must leave free.
constexpr double kFree = 1e-9;

double product(const Column& a, const Column& b) {
  return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}

// Returns the monomials of the ground's coordinates, scaled to -1..1, as columns.
std::vector<Column> monomials(std::span<const ControlPoint> points, int order) {
  glm::dvec2 low(std::numeric_limits<double>::infinity());
  glm::dvec2 high = -low;
  for (const ControlPoint& p : points) {
    low = glm::min(low, p.ground);
    high = glm::max(high, p.ground);
  }
  const glm::dvec2 middle = (low + high) / 2.0;
  const glm::dvec2 half = glm::max((high - low) / 2.0, glm::dvec2(std::numeric_limits<double>::min()));
  std::vector<Column> columns;
  for (int power = 0; power <= order; ++power) {
    for (int of_y = 0; of_y <= power; ++of_y) {
      Column column;
      for (const ControlPoint& p : points) {
        const glm::dvec2 at = (p.ground - middle) / half;
        column.push_back(std::pow(at.x, power - of_y) * std::pow(at.y, of_y));
      }
      columns.push_back(std::move(column));
    }
  }
  return columns;
}

// Makes columns orthonormal, in place, by the method of Gram and Schmidt, twice for accuracy. Returns false if they
// depend on each other.
bool make_orthonormal(std::vector<Column>& columns) {
  for (std::size_t k = 0; k < columns.size(); ++k) {
    Column& column = columns[k];
    const double before = std::sqrt(product(column, column));
    for (int round = 0; round < 2; ++round) {
      for (std::size_t j = 0; j < k; ++j) {
        const double share = product(column, columns[j]);
        for (std::size_t i = 0; i < column.size(); ++i) column[i] -= share * columns[j][i];
      }
    }
    const double length = std::sqrt(product(column, column));
    if (!(length > kIndependent * before)) return false;
    for (double& value : column) value /= length;
  }
  return true;
}

Misfit misfit_of(const std::vector<glm::dvec2>& residuals) {
  Misfit misfit;
  double sum = 0;
  for (std::size_t i = 0; i < residuals.size(); ++i) {
    const double length = glm::length(residuals[i]);
    sum += length * length;
    if (length <= misfit.largest_px) continue;
    misfit.largest_px = length;
    misfit.worst = i;
  }
  misfit.rms_px = std::sqrt(sum / static_cast<double>(residuals.size()));
  return misfit;
}

// Returns true if places lie on one line: by the eigenvalues of their scatter.
bool is_line(const std::vector<glm::dvec2>& places) {
  glm::dvec2 mean(0);
  for (const glm::dvec2& p : places) mean += p / static_cast<double>(places.size());
  double xx = 0;
  double xy = 0;
  double yy = 0;
  for (const glm::dvec2& p : places) {
    const glm::dvec2 d = p - mean;
    xx += d.x * d.x;
    xy += d.x * d.y;
    yy += d.y * d.y;
  }
  const double half = (xx + yy) / 2;
  const double root = std::hypot((xx - yy) / 2, xy);
  return !(half - root > kLeastSpread * kLeastSpread * (half + root));
}

}  // namespace

std::size_t polynomial_terms(int order) { return static_cast<std::size_t>((order + 1) * (order + 2) / 2); }

std::optional<PolynomialCheck> check_polynomial(std::span<const ControlPoint> points, int order) {
  if (points.size() < polynomial_terms(order)) return std::nullopt;
  std::vector<Column> basis = monomials(points, order);
  if (!make_orthonormal(basis)) return std::nullopt;
  Column x;
  Column y;
  for (const ControlPoint& p : points) {
    x.push_back(p.pixel.x);
    y.push_back(p.pixel.y);
  }
  // What a fit leaves is what is orthogonal to its columns. Leaving point i out of the fit divides its residual by
  // 1 - h, where h is the sum of the squares of row i of the orthonormal columns (the hat matrix).
  Column free(points.size(), 1.0);
  for (const Column& column : basis) {
    const double of_x = product(x, column);
    const double of_y = product(y, column);
    for (std::size_t i = 0; i < points.size(); ++i) {
      x[i] -= of_x * column[i];
      y[i] -= of_y * column[i];
      free[i] -= column[i] * column[i];
    }
  }
  std::vector<glm::dvec2> residuals;
  for (std::size_t i = 0; i < points.size(); ++i) residuals.emplace_back(x[i], y[i]);
  PolynomialCheck check;
  check.fitted = misfit_of(residuals);
  if (*std::min_element(free.begin(), free.end()) > kFree) {
    for (std::size_t i = 0; i < points.size(); ++i) residuals[i] /= free[i];
    check.left_out = misfit_of(residuals);
  }
  return check;
}

bool are_on_one_line(std::span<const ControlPoint> points) {
  if (points.size() < 3) return true;
  std::vector<glm::dvec2> pixels;
  std::vector<glm::dvec2> grounds;
  for (const ControlPoint& p : points) {
    pixels.push_back(p.pixel);
    grounds.push_back(p.ground);
  }
  return is_line(pixels) || is_line(grounds);
}

}  // namespace mars
