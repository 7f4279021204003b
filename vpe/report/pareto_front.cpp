#include "vpe/report/pareto_front.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace vpe::report {

std::vector<std::size_t> pareto_front(std::span<const CostAndError> points) {
  std::vector<std::size_t> order;
  for (std::size_t k = 0; k < points.size(); ++k) {
    if (std::isfinite(points[k].cost) && std::isfinite(points[k].error)) order.push_back(k);
  }
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    if (points[a].cost != points[b].cost) return points[a].cost < points[b].cost;
    return points[a].error < points[b].error;
  });
  std::vector<std::size_t> front;
  double best = std::numeric_limits<double>::infinity();
  for (const std::size_t k : order) {
    if (points[k].error >= best) continue;
    best = points[k].error;
    front.push_back(k);
  }
  return front;
}

double cost_at_error(std::span<const CostAndError> points, double error) {
  double cost = std::numeric_limits<double>::infinity();
  for (const CostAndError& point : points) {
    if (point.error <= error && std::isfinite(point.cost)) cost = std::min(cost, point.cost);
  }
  return cost;
}

}  // namespace vpe::report
