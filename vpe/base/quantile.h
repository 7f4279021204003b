// Medians and quantiles.
//
// Several rules exist for ranks that fall between two values. Each has its own function, so that a caller
// states its rule and its results never change to another one.
//
//   rule                      element of the sorted values          median of 1 2 3 4
//   median_upper()            n / 2                                 3
//   median_mean()             mean of the two in the middle         2.5
//   quantile_floor()          floor(share * (n - 1))                2
//   quantile_round()          round(share * (n - 1)), half up       3
//   sorted_quantile_rank()    ceil(share * n) - 1                   2
//
// All return NaN for no values. `share` is 0 to 1; shares outside are clamped. The values must not be NaN.
#pragma once

#include <span>

namespace vpe::base {

// Returns the upper median: of an even count the larger of the two values in the middle. Reorders the values.
double median_upper(std::span<double> values);

// Returns the median: of an even count the mean of the two values in the middle. Sorts the values.
double median_mean(std::span<double> values);

// Returns the value at rank share * (n - 1), counted from 0 and rounded down. Reorders the values.
double quantile_floor(std::span<double> values, double share);

// Returns the value at rank share * (n - 1), counted from 0 and rounded to the nearest. Reorders the values.
double quantile_round(std::span<double> values, double share);

// Returns the smallest value that is not exceeded by at least the given share of the values ("nearest rank").
// Expects the values in ascending order, so that several quantiles of the same values cost one sort.
double sorted_quantile_rank(std::span<const double> sorted, double share);

}  // namespace vpe::base
