// The bands of a map: what they hold, their names and units.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace vpe::map {

enum class MapBand {
  elevation,  // metres above the zero of the planet's datum
  slope,      // of the facet, degrees
  aspect,     // of steepest descent, degrees clockwise from north; 0 on level ground
  shade,  // cosine of incidence under a light at one azimuth and elevation of each place's own sky; at least 0
  sun,    // cosine of incidence of the sun's light; 0 where the ground hides the sun
  sun_hours,       // time in a sol during which the ground sees the sun's centre, hours of 3600 s
  colour,          // of the imagery, without light: three channels of 1 to 255
  source,          // index of the source of the nearest post
  source_spacing,  // where that source is finest, metres
  post_spacing,    // between posts of the planet file, metres
  synthetic,       // 1: the height is made up, 0: it is measured
  error            // largest known difference between the ground and the posts of its source, metres
};

// Describes one channel of a raster.
struct MapChannel {
  std::string name;
  std::string unit;     // empty: none
  std::string meaning;  // one sentence
};

// Returns a band by its name as on the command line, such as "source_spacing". Throws std::invalid_argument with all
// names.
MapBand band_named(std::string_view name);

// Parses names with commas between them. Throws std::invalid_argument for unknown names, repeated ones, and none.
std::vector<MapBand> parse_bands(std::string_view names);

// Returns all names with commas between them.
std::string band_names();

// Returns the channels of a band in their order: three of colour, else one.
std::vector<MapChannel> channels_of(MapBand band);

// Returns whether means of the values have no meaning: of classes, indices and directions.
bool has_no_mean(MapBand band);

}  // namespace vpe::map
