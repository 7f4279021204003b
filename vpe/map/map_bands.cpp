#include "vpe/map/map_bands.h"

#include <algorithm>
#include <array>
#include <stdexcept>

namespace vpe::map {
namespace {

struct BandRow {
  MapBand band;
  const char* name;
  const char* unit;
  const char* meaning;
};

constexpr std::array kBandRows{
    BandRow{MapBand::elevation, "elevation", "m", "height above the zero of the datum"},
    BandRow{MapBand::slope, "slope", "deg", "slope of the facet of the reference surface"},
    BandRow{MapBand::aspect, "aspect", "deg", "direction of steepest descent, clockwise from north"},
    BandRow{MapBand::shade, "shade", "", "cosine of incidence under a light at one place of each sky"},
    BandRow{MapBand::sun, "sun", "", "cosine of incidence of the sun, 0 in shadow"},
    BandRow{MapBand::sun_hours, "sun_hours", "h", "time in the sol during which the sun's centre is seen"},
    BandRow{MapBand::colour, "colour", "", "imagery without light, 1 to 255"},
    BandRow{MapBand::source, "source", "", "number of the source, as in the metadata"},
    BandRow{MapBand::source_spacing, "source_spacing", "m", "post spacing of the source where it is finest"},
    BandRow{MapBand::post_spacing, "post_spacing", "m", "post spacing of the planet file"},
    BandRow{MapBand::synthetic, "synthetic", "", "1 where the height is made up, 0 where it is measured"},
    BandRow{MapBand::error, "error", "m", "largest known difference from the posts of the source"}};

const BandRow& row_of(MapBand band) {
  return *std::ranges::find_if(kBandRows, [&](const BandRow& row) { return row.band == band; });
}

}  // namespace

std::string band_names() {
  std::string names;
  for (const BandRow& row : kBandRows) names += (names.empty() ? "" : ",") + std::string(row.name);
  return names;
}

MapBand band_named(std::string_view name) {
  for (const BandRow& row : kBandRows)
    if (name == row.name) return row.band;
  throw std::invalid_argument("no band is called '" + std::string(name) + "'; there are " + band_names());
}

std::vector<MapBand> parse_bands(std::string_view names) {
  std::vector<MapBand> bands;
  while (true) {
    const std::size_t comma = names.find(',');
    const MapBand band = band_named(names.substr(0, comma));
    if (std::ranges::find(bands, band) != bands.end())
      throw std::invalid_argument("band '" + std::string(row_of(band).name) + "' is named twice");
    bands.push_back(band);
    if (comma == std::string_view::npos) return bands;
    names.remove_prefix(comma + 1);
  }
}

std::vector<MapChannel> channels_of(MapBand band) {
  const BandRow& row = row_of(band);
  if (band != MapBand::colour) return {{row.name, row.unit, row.meaning}};
  std::vector<MapChannel> channels;
  for (const char* name : {"red", "green", "blue"}) channels.push_back({name, row.unit, row.meaning});
  return channels;
}

bool has_no_mean(MapBand band) {
  return band == MapBand::source || band == MapBand::synthetic || band == MapBand::aspect;
}

}  // namespace vpe::map
