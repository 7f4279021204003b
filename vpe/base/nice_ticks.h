// Round numbers for scales: steps of 1, 2 or 5 times a power of ten, and ticks at their multiples.
#pragma once

#include <vector>

namespace vpe::base {

// Accepts a step although rounding has put it on the wrong side of the limit by this relative difference.
inline constexpr double kNiceSlack = 1e-9;

// Returns 10^exponent. Results down to 1e-22 are the doubles nearest to the power, on every platform.
double power_of_ten(int exponent);

// Returns the largest nice step that is not above x. Expects x > 0 and finite; returns x otherwise.
double nice_step_below(double x);

// Returns the smallest nice step that is not below x. Expects x > 0 and finite; returns x otherwise. Never
// returns less than x with slack 0.
double nice_step_above(double x, double slack = kNiceSlack);

// Returns the number of decimals that distinguishes multiples of a step: 0 for 20, 1 for 0.5. At most 9.
// Expects step > 0.
int step_decimals(double step);

// Holds the ticks of a scale.
struct NiceTicks {
  std::vector<double> values;  // ascending
  int decimals = 0;            // number of decimals that distinguish the values
};

// Returns the multiples, within [low, high], of the smallest nice step that gives at most `most` of them. Use
// it where ticks must not crowd. Returns none for a range that is empty or not finite, and for most < 2.
NiceTicks nice_ticks(double low, double high, int most);

// Returns multiples of a nice step within [low, high]: at least 2, and at most `most` + 1 or 5 if that is more.
// Use it where a scale needs two labels to be understood. Returns none for a range that is empty or not finite,
// and for most < 1.
std::vector<double> nice_ticks_two_or_more(double low, double high, int most);

}  // namespace vpe::base
