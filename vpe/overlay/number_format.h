// Text of numbers on maps: lengths, distances, coordinates and times.
#pragma once

#include <string>

namespace vpe::overlay {

// Returns a number with U+2212 as minus sign, never "-0". Halves round away from zero, unlike
// base::format_display(), which rounds the exact binary value.
std::string number_text(double value, int decimals);

// Returns a length for a scale, as "250 m" or "20 km". `step` determines the number of decimals.
std::string scale_length_text(double metres, double step);

// Returns a distance as "850 m", "4.2 km", "17 km": two digits below 10 km, whole kilometres above.
std::string distance_text(double metres);

// Returns "Gale · 17 km".
std::string name_text(const std::string& name, double distance_m);

// Return "74.5°W", "0°", "180°" and "13°S". `step` determines the number of decimals.
std::string longitude_text(double lon_deg, double step);
std::string latitude_text(double lat_deg, double step);

// Returns "T+01:02:03.45". Hundredths are rounded down, after allowing for rounding errors of a frame's time.
std::string time_text(double time_s);

// Returns "LTST 14:32, Ls 90.1°", with minutes and tenths of a degree rounded.
std::string solar_time_text(double true_time_h, double solar_longitude_deg);

}  // namespace vpe::overlay
