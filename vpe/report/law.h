// How costs grow, each as a law: what was measured over what, the exponent of it, and the exponent asked for.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "vpe/report/growth.h"
#include "vpe/report/interleaved_timing.h"
#include "vpe/report/plot.h"
#include "vpe/report/table.h"

namespace vpe::report {

struct LawSample {
  double x = 0;
  std::vector<double> y;  // one for each round; one alone for what is counted
};

struct Law {
  std::string axis;                      // what is varied, as in "image"; laws of one axis stand in one plot
  std::string what;                      // what is measured, as in "rays, exact"
  std::string x_name;                    // with its unit, as in "pixels"
  std::string y_name;                    // with its unit at the end, as in "frame_s"
  std::optional<double> least_exponent;  // asked for, both ends allowed
  std::optional<double> most_exponent;
  std::vector<LawSample> samples;
};

// Times of contestants that ran in turns, as samples at their x. Throws std::invalid_argument for different
// numbers of both.
std::vector<LawSample> timed_samples(std::span<const double> x, std::span<const Timing> timings);

struct LawFit {
  Growth growth;
  // Of three x and more the medians over the rounds are fitted, so that the interval counts what is no power.
  // Two x say nothing of that: all rounds are fitted, each divided by its own mean, and the interval holds the
  // scatter alone.
  bool of_rounds = false;
  std::optional<bool> holds;   // the exponent is as asked for; nothing when nothing is asked for
  std::optional<bool> surely;  // so is, or so is not, all of its interval
};

// Nothing where no power can be fitted: fewer than two different x, or values that are not finite and positive.
std::optional<LawFit> fit(const Law& law);

// A row a law: axis, what, x, y, exponent, half_width, factor, points, least, most, holds, surely.
Table law_table(std::span<const Law> laws);

// A row a sample: axis, what, x_name, x, y_name, median, least, most, rounds.
Table sample_table(std::span<const Law> laws);

// Medians of all laws of an axis that have this y, with their exponents in the legend.
Plot law_plot(std::span<const Law> laws, const std::string& axis, const std::string& y_name);

// (axis, y_name) of all plots, in the order of the laws.
std::vector<std::pair<std::string, std::string>> law_plots(std::span<const Law> laws);

// "0.03 +- 0.05"
std::string exponent_text(const Growth& growth);

}  // namespace vpe::report
