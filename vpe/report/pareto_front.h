// The Pareto front of cost and error: the configurations that no other one beats.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace vpe::report {

struct CostAndError {
  double cost = 0;  // such as a time
  double error = 0;
};

// Returns the indices of the points that no other point beats, by rising cost. A point beats another if neither
// its cost nor its error is larger and one of them is smaller. Of equal points the first is on the front.
// Points that are not finite are never on it.
std::vector<std::size_t> pareto_front(std::span<const CostAndError> points);

// Returns the smallest cost of a finite point whose error is at most `error`; infinity if there is none.
double cost_at_error(std::span<const CostAndError> points, double error);

}  // namespace vpe::report
