// Which of many ways are not beaten: the Pareto front of cost and error.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace vpe::report {

struct CostAndError {
  double cost = 0;  // as time
  double error = 0;
};

// Indices of the points that no other beats: none costs no more and errs no more, and is better in one of
// both. Of equal points the first. By rising cost. Points that are not finite are never on it.
std::vector<std::size_t> pareto_front(std::span<const CostAndError> points);

// The smallest cost on the front at an error no larger than this; infinite where there is none.
double cost_at_error(std::span<const CostAndError> points, double error);

}  // namespace vpe::report
