// Names of bands.
#include "vpe/map/map_bands.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace {

using vpe::map::MapBand;

TEST(MapBands, NamesAreBands) {
  const auto all = vpe::map::parse_bands(vpe::map::band_names());
  EXPECT_EQ(all.size(), 12U);
  EXPECT_EQ(all.front(), MapBand::elevation);
  EXPECT_EQ(vpe::map::band_named("sun_hours"), MapBand::sun_hours);
  for (const MapBand band : all) {
    for (const auto& channel : vpe::map::channels_of(band)) {
      EXPECT_FALSE(channel.name.empty());
      EXPECT_FALSE(channel.meaning.empty());
    }
  }
}

TEST(MapBands, ColourHasThreeChannels) {
  const auto channels = vpe::map::channels_of(MapBand::colour);
  ASSERT_EQ(channels.size(), 3U);
  EXPECT_EQ(channels[0].name, "red");
  EXPECT_EQ(channels[2].name, "blue");
  EXPECT_EQ(vpe::map::channels_of(MapBand::slope)[0].unit, "deg");
}

TEST(MapBands, WrongListsAreRefused) {
  for (const char* text : {"", "height", "elevation,", ",slope", "slope,slope", "elevation slope"})
    EXPECT_THROW(vpe::map::parse_bands(text), std::invalid_argument) << text;
  try {
    vpe::map::band_named("height");
    FAIL();
  } catch (const std::invalid_argument& e) {
    EXPECT_NE(std::string(e.what()).find("elevation,slope"), std::string::npos) << e.what();
  }
}

TEST(MapBands, DirectionsAndClassesHaveNoMean) {
  EXPECT_TRUE(vpe::map::has_no_mean(MapBand::aspect));
  EXPECT_TRUE(vpe::map::has_no_mean(MapBand::source));
  EXPECT_FALSE(vpe::map::has_no_mean(MapBand::elevation));
}

}  // namespace
