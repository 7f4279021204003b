// How costs grow, each as a law: measurements over a size, the fitted exponent, and the exponent aimed at.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "vpe/report/growth.h"
#include "vpe/report/interleaved_timing.h"
#include "vpe/report/plots/plot.h"
#include "vpe/report/table.h"

namespace vpe::report {

struct LawSample {
  double x = 0;
  std::vector<double> y;  // one for each round; a single one for counts
};

struct Law {
  std::string axis;                      // the varied size, such as "image"; laws of one axis share a plot
  std::string what;                      // the measured case, such as "rays, exact"
  std::string x_name;                    // with its unit, such as "pixels"
  std::string y_name;                    // with its unit at the end, such as "frame_s"
  std::optional<double> least_exponent;  // aim, both ends included
  std::optional<double> most_exponent;
  std::vector<LawSample> samples;
};

// Returns interleaved timings as samples at their x. Throws std::invalid_argument if the numbers of both
// differ.
std::vector<LawSample> timed_samples(std::span<const double> x, std::span<const Timing> timings);

struct LawFit {
  Growth growth;
  // false: the medians over the rounds are fitted (three x and more), so that the interval includes deviations
  // from a power. true: two x cannot show such deviations, so all rounds are fitted, each divided by its own
  // mean, and the interval includes only the scatter.
  bool of_rounds = false;
  std::optional<bool> holds;   // the exponent meets the aim; nullopt without an aim
  std::optional<bool> surely;  // the whole interval meets it, or the whole interval misses it
};

// Fits a law. Returns nullopt if no power can be fitted: fewer than two different x, or values that are not
// finite and positive.
std::optional<LawFit> fit(const Law& law);

// Returns a row for each law: axis, what, x, y, exponent, half_width, factor, points, least, most, holds,
// surely.
Table law_table(std::span<const Law> laws);

// Returns a row for each sample: axis, what, x_name, x, y_name, median, least, most, rounds.
Table sample_table(std::span<const Law> laws);

// Plots the medians of all laws of an axis that have this y, with their exponents in the legend.
Plot law_plot(std::span<const Law> laws, const std::string& axis, const std::string& y_name);

// Returns (axis, y_name) of all plots, in the order of the laws.
std::vector<std::pair<std::string, std::string>> law_plots(std::span<const Law> laws);

// Returns the exponent with its interval: "0.030 +- 0.050".
std::string exponent_text(const Growth& growth);

}  // namespace vpe::report
