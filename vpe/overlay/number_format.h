// Round numbers, and numbers as a map has them.
#pragma once

#include <string>
#include <vector>

namespace vpe::overlay {

// The largest of 1, 2, 5 times a power of ten that is not above x > 0.
double round_below(double x);
// The smallest that is not below it.
double round_above(double x);

// Multiples of a round step within [low, high], at least 2 if the range has any width, at most `most` + 1.
std::vector<double> round_values(double low, double high, int most);

// Decimals that tell multiples of a step apart, at most 9.
int decimals_of(double step);

// With a true minus sign; never "-0".
std::string number_text(double value, int decimals);
// "250 m", "20 km"; `step` says how many decimals there are.
std::string length_text(double metres, double step);
// "850 m", "4.2 km", "17 km": two figures of what is nearer than 10 km, whole kilometres beyond.
std::string distance_text(double metres);
// "Gale · 17 km".
std::string name_text(const std::string& name, double distance_m);
// "74.5°W", "0°", "180°"; "13°S".
std::string longitude_text(double lon_deg, double step);
std::string latitude_text(double lat_deg, double step);
// "T+01:02:03.45"; hundredths are rounded down, but for the last bits of a frame's time.
std::string time_text(double time_s);

}  // namespace vpe::overlay
