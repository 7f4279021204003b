#include "vpe/overlay/number_format.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>

#include "vpe/base/nice_ticks.h"

namespace vpe::overlay {

namespace {

constexpr double kRounding = 1e-9;

std::string degrees_text(double value, double step, const char* positive, const char* negative) {
  const std::string number = number_text(std::abs(value), base::step_decimals(step));
  const bool is_zero = std::abs(value) < kRounding;
  return number + "\u00b0" + (is_zero ? "" : value > 0 ? positive : negative);
}

}  // namespace

std::string number_text(double value, int decimals) {
  // printf would use the locale's decimal point.
  const double unit = base::power_of_ten(decimals);
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

std::string scale_length_text(double metres, double step) {
  if (std::max(std::abs(metres), step) >= 1000) {
    return number_text(metres / 1000, base::step_decimals(step / 1000)) + " km";
  }
  return number_text(metres, base::step_decimals(step)) + " m";
}

std::string distance_text(double metres) {
  // Limits at which rounding reaches the next unit or format.
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
  if (std::abs(lon_deg) > 180 - kRounding) return "180\u00b0";
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

std::string solar_time_text(double true_time_h, double solar_longitude_deg) {
  const auto minutes = static_cast<int>(std::lround(true_time_h * 60)) % (24 * 60);
  const double tenths = std::fmod(std::round(solar_longitude_deg * 10), 3600.0);
  char text[48];
  std::snprintf(text, sizeof text, "LTST %02d:%02d, Ls %.1f\u00b0", minutes / 60, minutes % 60, tenths / 10);
  return text;
}

}  // namespace vpe::overlay
