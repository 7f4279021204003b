#include "vpe/overlay/number_format.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>

#include "vpe/base/number.h"

namespace vpe::overlay {

namespace {

constexpr double kBitsOff = 1e-9;
constexpr std::array<double, 4> kRound{1, 2, 5, 10};

double power_of_ten(int exponent) {
  return exponent < 0 ? 1.0 / std::pow(10.0, -exponent) : std::pow(10.0, exponent);
}

std::string degrees_text(double value, double step, const char* positive, const char* negative) {
  const std::string number = number_text(std::abs(value), decimals_of(step));
  const bool nothing = std::abs(value) < kBitsOff;
  return number + "\u00b0" + (nothing ? "" : value > 0 ? positive : negative);
}

}  // namespace

double round_below(double x) {
  const int exponent = static_cast<int>(std::floor(std::log10(x) + kBitsOff));
  const double unit = power_of_ten(exponent);
  double best = unit;
  for (const double r : kRound) {
    if (r * unit <= x * (1 + kBitsOff)) best = r * unit;
  }
  return best;
}

double round_above(double x) {
  const int exponent = static_cast<int>(std::floor(std::log10(x) + kBitsOff));
  const double unit = power_of_ten(exponent);
  for (const double r : kRound) {
    if (r * unit >= x * (1 - kBitsOff)) return r * unit;
  }
  return 10 * unit;
}

std::vector<double> round_values(double low, double high, int most) {
  std::vector<double> values;
  if (!(high > low)) return values;
  double step = round_above((high - low) / most);
  for (;;) {
    const auto first = static_cast<std::int64_t>(std::ceil(low / step - kBitsOff));
    const auto last = static_cast<std::int64_t>(std::floor(high / step + kBitsOff));
    if (last > first || step < (high - low) * 1e-3) {
      for (std::int64_t k = first; k <= last; ++k) values.push_back(static_cast<double>(k) * step);
      return values;
    }
    step = round_below(step * 0.6);
  }
}

int decimals_of(double step) {
  for (int n = 0; n < 9; ++n) {
    const double scaled = step * power_of_ten(n);
    if (std::abs(scaled - std::round(scaled)) <= 1e-6 * scaled) return n;
  }
  return 9;
}

std::string number_text(double value, int decimals) {
  // Not by printf: its point is the locale's.
  const double unit = power_of_ten(decimals);
  const auto all = static_cast<std::int64_t>(std::llround(std::abs(value) * unit));
  const auto part = static_cast<std::int64_t>(unit);
  std::string text = all != 0 && value < 0 ? "\u2212" : "";
  text += std::to_string(all / part);
  if (decimals > 0) {
    std::string rest = std::to_string(all % part);
    rest.insert(0, static_cast<std::size_t>(decimals) - rest.size(), '0');
    text += "." + rest;
  }
  return text;
}

std::string length_text(double metres, double step) {
  if (std::max(std::abs(metres), step) >= 1000) {
    return number_text(metres / 1000, decimals_of(step / 1000)) + " km";
  }
  return number_text(metres, decimals_of(step)) + " m";
}

std::string distance_text(double metres) {
  // What is rounded up to the next unit is said in it.
  constexpr double kHundred_m = 99.5;
  constexpr double kKilometre_m = 995;
  constexpr double kTenKilometres_m = 9950;
  if (metres < kHundred_m) return number_text(metres, 0) + " m";
  if (metres < kKilometre_m) return number_text(10 * std::round(metres / 10), 0) + " m";
  return number_text(metres / 1000, metres < kTenKilometres_m ? 1 : 0) + " km";
}

std::string name_text(const std::string& name, double distance_m) {
  return name + " \u00b7 " + distance_text(distance_m);
}

std::string longitude_text(double lon_deg, double step) {
  if (std::abs(lon_deg) > 180 - kBitsOff) return "180\u00b0";
  return degrees_text(lon_deg, step, "E", "W");
}

std::string latitude_text(double lat_deg, double step) { return degrees_text(lat_deg, step, "N", "S"); }

std::string time_text(double time_s) {
  const auto hundredths = static_cast<std::int64_t>(std::floor(std::max(time_s, 0.0) * 100 + 1e-6));
  const std::int64_t seconds = hundredths / 100;
  char text[64];
  std::snprintf(text, sizeof text, "T+%02lld:%02d:%02d.%02d", static_cast<long long>(seconds / 3600),
                static_cast<int>(seconds / 60 % 60), static_cast<int>(seconds % 60),
                static_cast<int>(hundredths % 100));
  return text;
}

}  // namespace vpe::overlay
