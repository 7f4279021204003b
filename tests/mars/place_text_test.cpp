#include "mars/geodesy/place_text.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>

#include "vpe/base/number.h"

namespace mars {
namespace {

// Measures in degrees of latitude, far from the poles.
double apart_deg(LonLat a, LonLat b) {
  return std::max(std::abs(std::remainder(a.lon_deg - b.lon_deg, 360.0)), std::abs(a.lat_deg - b.lat_deg));
}

TEST(PlaceText, OnePlaceInManyNotations) {
  const LonLat place{137.4417, -4.5895};
  for (const char* text : {
           "137.4417,-4.5895",
           "137.4417, -4.5895",
           " 137.4417   -4.5895\n",
           "137.4417\t-4.5895",
           "+137.4417;-4.5895",
           "137,4417; -4,5895",
           "137,4417;\xe2\x88\x92"
           "4,5895",
           "-222.5583, -4.5895",
           "137.4417 E 4.5895 S",
           "137.4417E,4.5895S",
           "4.5895 S, 137.4417 E",
           "4.5895s 222.5583w",
           "E 137.4417 S 4.5895",
           "S4.5895 E137.4417",
           "4.5895 S, 137.4417",
           "137.4417, 4.5895 South",
           "-4.5895, 222.5583 West",
           "lon 137.4417 lat -4.5895",
           "latitude: -4.5895, longitude: 137.4417",
           "lat=-4.5895 lon=-222.5583",
           "[137.4417, -4.5895]",
           "(137.4417\u00b0, -4.5895\u00b0)",
           "137.4417\u00b0 -4.5895\u00b0",
           "137 26 30.12, -4 35 22.2",
           "137 26 30.12 -4 35 22.2",
           "137:26:30.12 E, 4:35:22.2 S",
           "137 26.502 E 4 35.37 S",
           "137\u00b026'30.12\"E 4\u00b035'22.2\"S",
           "137\u00b0 26\u2032 30.12\u2033 -4\u00b0 35\u2032 22.2\u2033",
           "S 4\u00b0 35\u2019 22.2\u201d E 137\u00b0 26\u2019 30.12\u201d",
           "4d35'22.2\"S 137d26'30.12\"E",
           "137 deg 26 min 30.12'' E, 4 deg 35.37 min S",
       }) {
    std::string fault;
    const auto read = parse_place(text, fault);
    ASSERT_TRUE(read.has_value()) << text << ": " << fault;
    EXPECT_LT(apart_deg(*read, place), 1e-9) << text << ": " << place_text(*read);
  }
}

TEST(PlaceText, AmbiguousTextIsRejectedWithTheExpectedForm) {
  const auto fault_of = [](std::string_view text) {
    std::string fault;
    EXPECT_FALSE(parse_place(text, fault).has_value()) << text;
    EXPECT_TRUE(fault.starts_with("expected ")) << text << ": " << fault;
    return fault;
  };
  const auto has = [](const std::string& text, const char* part) {
    return text.find(part) != std::string::npos;
  };
  EXPECT_TRUE(has(fault_of(""), "longitude and latitude"));
  EXPECT_TRUE(has(fault_of("Gale crater"), "longitude and latitude"));
  EXPECT_TRUE(has(fault_of("137.4"), "longitude and latitude"));
  EXPECT_TRUE(has(fault_of("137,44 -4,58"), "comma"));
  EXPECT_TRUE(has(fault_of("1, 2, 3"), "comma"));
  EXPECT_TRUE(has(fault_of("137.4 E -4.5"), "comma"));
  EXPECT_TRUE(has(fault_of("-4.5, 137.4"), "longitude comes first"));
  EXPECT_FALSE(has(fault_of("97 N, 137.4 E"), "longitude comes first"));
  EXPECT_TRUE(has(fault_of("361, 0"), "-360 to 360"));
  EXPECT_TRUE(has(fault_of("-4.5 S, 137 E"), "sign"));
  EXPECT_TRUE(has(fault_of("10 E, 20 W"), "two longitudes"));
  EXPECT_TRUE(has(fault_of("10 N, 20 S"), "two latitudes"));
  EXPECT_TRUE(has(fault_of("lon 10 N, 20"), "E or W"));
  EXPECT_TRUE(has(fault_of("10 60 0, 5"), "below 60"));
  EXPECT_TRUE(has(fault_of("10.5 30 E, 5 N"), "last number"));
  EXPECT_TRUE(has(fault_of("10 -30, 5"), "sign"));
  EXPECT_TRUE(has(fault_of("10' 5\u00b0, 5"), "degrees, then minutes"));
  EXPECT_TRUE(has(fault_of("1 2 3 4, 5"), "degrees, then minutes"));
  EXPECT_TRUE(has(fault_of("10 E W, 5"), "one letter"));
  EXPECT_TRUE(has(fault_of("1.2.3, 5"), "number"));
  EXPECT_TRUE(has(fault_of("4d35m22s, 137"), "longitude and latitude"));  // seconds or south?
  fault_of("nan, 0");
  fault_of("1e2 0");
  EXPECT_TRUE(has(fault_of("10 20,30"), "minutes in both"));
  EXPECT_TRUE(has(fault_of("1e300, 0"), "-360 to 360"));
  fault_of(std::string(100000, '1'));
}

TEST(PlaceText, MinusZeroDegreesAreMinus) {
  std::string fault;
  EXPECT_EQ(parse_place("-0 30, -0 15 0", fault)->lon_deg, -0.5);
  EXPECT_EQ(parse_place("-0 30, -0 15 0", fault)->lat_deg, -0.25);
  EXPECT_EQ(parse_place("360, 90", fault)->lon_deg, 0);
  EXPECT_EQ(parse_place("-180, 0", fault)->lon_deg, 180);
}

TEST(PlaceText, PlainNumbersMayHaveExponents) {
  std::string fault;
  const auto read = parse_place(" -1e1 , +5e0 ", fault);
  ASSERT_TRUE(read.has_value()) << fault;
  EXPECT_EQ(read->lon_deg, -10);
  EXPECT_EQ(read->lat_deg, 5);
}

TEST(PlaceText, OneCoordinate) {
  std::string fault;
  for (const char* text : {"222.5", "137.5 W", "-137.5", "137 30 W", "W 137\u00b030'", "2225e-1", " 222.5\t"}) {
    const auto lon = parse_coordinate(text, Axis::kLongitude, fault);
    ASSERT_TRUE(lon.has_value()) << text << ": " << fault;
    EXPECT_EQ(*lon, -137.5) << text;
  }
  EXPECT_EQ(parse_coordinate("4 30 S", Axis::kLatitude, fault), -4.5);
  EXPECT_EQ(parse_coordinate("lat -4.5", Axis::kLatitude, fault), -4.5);
  for (const char* text : {"", "a", "4 S", "10, 20", "361", "nan", "4,5", "10 60"}) {
    fault.clear();
    EXPECT_FALSE(parse_coordinate(text, Axis::kLongitude, fault).has_value()) << text;
    EXPECT_TRUE(fault.starts_with("expected ")) << text << ": " << fault;
  }
  EXPECT_FALSE(parse_coordinate("90.5", Axis::kLatitude, fault).has_value());
  EXPECT_FALSE(parse_coordinate("4 E", Axis::kLatitude, fault).has_value());
}

TEST(PlaceText, ShowsHowItWasUnderstood) {
  EXPECT_EQ(place_text({-74.2, -13.5}), "74.200000\u00b0 W (285.800000\u00b0 E), 13.500000\u00b0 S");
  EXPECT_EQ(place_text({137.4417, 4}), "137.441700\u00b0 E, 4.000000\u00b0 N");
}

LonLat any_place() {
  return {normalize_lon_deg(*rc::gen::inRange(-1'800'000'000, 1'800'000'000) / 1e7),
          *rc::gen::inRange(-900'000'000, 900'000'001) / 1e7};
}

std::string in_seconds(double degrees) {
  const auto tenths = std::llround(std::abs(degrees) * 36e6);  // of a thousandth of a second
  return std::to_string(tenths / 36'000'000) + " " + std::to_string(tenths / 600'000 % 60) + " " +
         vpe::base::format_display(static_cast<double>(tenths % 600'000) / 1e4, 4);
}

RC_GTEST_PROP(PlaceText, EveryPlaceReadsBackFromEveryNotation, ()) {
  const LonLat place = any_place();
  const double east = place.lon_deg < 0 ? place.lon_deg + 360 : place.lon_deg;
  const std::string lon = vpe::base::format_number(place.lon_deg);
  const std::string lat = vpe::base::format_number(place.lat_deg);
  const std::string letter_ns = place.lat_deg < 0 ? "S" : "N";
  const std::string letter_ew = place.lon_deg < 0 ? "W" : "E";
  const std::string lat_size = vpe::base::format_number(std::abs(place.lat_deg));
  std::string outside = place_text(place);
  if (const auto open = outside.find(" ("); open != std::string::npos)
    outside.erase(open, outside.find(')') - open + 1);
  const std::vector<std::pair<std::string, double>> texts{
      {lon + "," + lat, 1e-12},
      {lon + " " + lat, 1e-12},
      {vpe::base::format_number(east) + ", " + lat, 1e-12},
      {"lat " + lat + " lon " + lon, 1e-12},
      {lat_size + letter_ns + " " + vpe::base::format_number(std::fmod(360 - east, 360)) + "W", 1e-12},
      {in_seconds(place.lon_deg) + letter_ew + " " + in_seconds(place.lat_deg) + letter_ns, 2e-8},
      {letter_ns + in_seconds(place.lat_deg) + letter_ew + in_seconds(place.lon_deg), 2e-8},
      {outside, 5.1e-7}};
  for (const auto& [text, error_deg] : texts) {
    std::string fault;
    const auto read = parse_place(text, fault);
    if (!read) RC_FAIL(text + ": " + fault);
    if (!(apart_deg(*read, place) <= error_deg)) RC_FAIL(text + " was read as " + place_text(*read));
  }
}

RC_GTEST_PROP(PlaceText, AnyTextIsAPlaceOrAReason, ()) {
  const auto piece =
      rc::gen::element<std::string>("1", "59", "-", "+", ".", ",", ";", " ", "E", "w", "N", "S", "lon", "lat",
                                    "\u00b0", "'", "\"", "90", "360", "deg", "\xe2", "\xff", ":", "min", "0.5");
  std::string text;
  for (const std::string& next : *rc::gen::container<std::vector<std::string>>(piece)) text += next;
  std::string fault;
  const auto read = parse_place(text, fault);
  if (read)
    RC_ASSERT(is_valid(*read) && read->lon_deg > -180 && read->lon_deg <= 180);
  else
    RC_ASSERT(fault.starts_with("expected "));
}

}  // namespace
}  // namespace mars
