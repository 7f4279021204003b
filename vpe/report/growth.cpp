#include "vpe/report/growth.h"

#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace vpe::report {
namespace {

// Two-sided 95 % points of Student's t by degrees of freedom. The last one serves all larger ones, which makes
// their intervals too wide rather than too narrow.
constexpr std::array<double, 30> kStudent95{
    12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228, 2.201, 2.179, 2.160, 2.145, 2.131,
    2.120,  2.110, 2.101, 2.093, 2.086, 2.080, 2.074, 2.069, 2.064, 2.060, 2.056, 2.052, 2.048, 2.045, 2.042};

}  // namespace

Growth fit_growth(std::span<const double> x, std::span<const double> y) {
  if (x.size() != y.size() || x.size() < 2)
    throw std::invalid_argument("fit_growth: two points or more are needed");
  const auto n = static_cast<double>(x.size());
  double mean_x = 0;
  double mean_y = 0;
  for (std::size_t k = 0; k < x.size(); ++k) {
    if (!(x[k] > 0 && y[k] > 0) || !std::isfinite(x[k]) || !std::isfinite(y[k])) {
      throw std::invalid_argument("fit_growth: values must be finite and positive");
    }
    mean_x += std::log(x[k]) / n;
    mean_y += std::log(y[k]) / n;
  }
  double xx = 0;
  double xy = 0;
  for (std::size_t k = 0; k < x.size(); ++k) {
    const double dx = std::log(x[k]) - mean_x;
    xx += dx * dx;
    xy += dx * (std::log(y[k]) - mean_y);
  }
  if (xx < 1e-18) throw std::invalid_argument("fit_growth: all x are equal");

  Growth growth;
  growth.points = static_cast<int>(x.size());
  growth.exponent = xy / xx;
  growth.factor = std::exp(mean_y - growth.exponent * mean_x);
  if (growth.points == 2) {
    growth.half_width = std::numeric_limits<double>::infinity();
    return growth;
  }
  double squares = 0;
  for (std::size_t k = 0; k < x.size(); ++k) {
    const double off = std::log(y[k]) - mean_y - growth.exponent * (std::log(x[k]) - mean_x);
    squares += off * off;
  }
  const std::size_t freedom = x.size() - 2;
  growth.residual = std::sqrt(squares / static_cast<double>(freedom));
  const double student = kStudent95[std::min(freedom, kStudent95.size()) - 1];
  growth.half_width = student * growth.residual / std::sqrt(xx);
  return growth;
}

}  // namespace vpe::report
