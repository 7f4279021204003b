#include <array>
#include <cmath>
#include <sstream>

#include "mars/geodesy/place_text.h"
#include "tests/fuzz/targets.h"
#include "vpe/app/cli/program.h"
#include "vpe/app/places/places.h"

namespace fuzz {
namespace {

std::string text_of(std::span<const std::uint8_t> bytes) { return {bytes.begin(), bytes.end()}; }

Bytes place_bytes(const std::string& text) { return {text.begin(), text.end()}; }

void check_lon_lat(const mars::LonLat& place) {
  require(place.lon_deg > -180 && place.lon_deg <= 180, "longitudes are normal");
  require(std::abs(place.lat_deg) <= 90, "latitudes have limits");
}

bool is_near(const mars::LonLat& a, const mars::LonLat& b) {
  return std::abs(std::remainder(a.lon_deg - b.lon_deg, 360.0)) < 1e-6 &&
         std::abs(a.lat_deg - b.lat_deg) < 1e-6;
}

// What is written without brackets is read again.
void check_round_trip(const mars::LonLat& place) {
  std::string text = mars::place_text(place);
  const std::size_t open = text.find('(');
  if (open != std::string::npos) text.erase(open, text.find(')') - open + 1);
  std::string fault;
  const auto again = mars::parse_place(text, fault);
  require(again && is_near(*again, place), "a place survives being written");
}

void run_place(std::span<const std::uint8_t> bytes) {
  const std::string text = text_of(bytes);
  std::string fault;
  const auto place = mars::parse_place(text, fault);
  require(place || fault.starts_with("expected "), "a place or a fault");
  if (place) {
    check_lon_lat(*place);
    check_round_trip(*place);
    std::string none;
    const auto padded = mars::parse_place(" " + text + "\n", none);
    require(text.size() + 2 > mars::kLongestPlaceText || (padded && is_near(*padded, *place)),
            "blanks around mean nothing");
  }
  const std::array limits{360.0, 90.0};
  for (const mars::Axis axis : {mars::Axis::kLongitude, mars::Axis::kLatitude}) {
    std::string why;
    const auto degrees = mars::parse_coordinate(text, axis, why);
    require(degrees || why.starts_with("expected "), "a coordinate or a fault");
    require(!degrees || std::abs(*degrees) <= limits[static_cast<std::size_t>(axis)],
            "coordinates have limits");
  }
}

std::vector<Bytes> place_seeds() {
  std::vector<Bytes> seeds;
  for (const char* text :
       {"137.4417, -4.5895", "-1e1,+5", "137,4417; -4,5895", "4.5895 S, 222.5583 W",
        "E 137 26 30.12 S 4 35 22.2", "137\u00b026'30.12\"E 4\u00b035'22.2\"S",
        "latitude: -4.5895, longitude: 137.4417", "[137 deg 26 min 30.12'' E, 4 deg 35.37 min S]",
        "137:26:30.12 E, 4:35:22.2 S", "137\u00b0 26\u2032 30.12\u2033 \u22124\u00b0 35\u2032 22.2\u2033",
        "360,90", "-360 -90", "4d35'22.2\"S"})
    seeds.push_back(place_bytes(text));
  return seeds;
}

void run_places(std::span<const std::uint8_t> bytes) {
  std::istringstream in(text_of(bytes));
  try {
    const vpe::app::PlaceTable table = vpe::app::read_places(in);
    require(table.cells.size() == table.places.size(), "cells for each place");
    for (const auto& row : table.cells) require(row.size() == table.columns.size(), "a cell for each column");
    for (const mars::LonLat& place : table.places) check_lon_lat(place);
  } catch (const vpe::app::UsageError& error) {
    require(std::string(error.what()).find("standard input, line ") == 0, "the line is named");
  }
}

std::vector<Bytes> places_seeds() {
  std::vector<Bytes> seeds;
  for (const char* text : {"137.4,-4.5\n# none\n\n4.6S,222.6W\n", "lon,lat\n137.4,-4.5\n-74,13\n",
                           "name,lat,lon\n\"Bradbury, \"\"Landing\"\"\",-4.5895,137.4417\n",
                           "Latitude;Longitude;x\r\n-4,5;137,4;1\r\n", "x\ty\tid\n1\t2\t3\n",
                           "\xEF\xBB\xBFlng,lat_deg\n222.6 W,4.6 S\n", "lat 4 lon 5\nlat 6 lon 7\n"})
    seeds.push_back(place_bytes(text));
  return seeds;
}

}  // namespace

const Target kPlace{"place", run_place, place_seeds};
const Target kTable{"table", run_places, places_seeds};

}  // namespace fuzz
