// The embedded Mars: an analytic illustration of the published landforms, for use without any data.
//
// embedded_elevation() and embedded_image() are functions of the direction and of the wanted
// spacing alone, defined everywhere and at every spacing down to 1/16 m. The spacing is rounded down to a power
// of two and decides which wavelengths and sizes of craters and rocks take part: about twice the spacing and
// more. Values are equal to the bit on every machine and compiler: they are made with integers and IEEE + - * /
// sqrt only.
//
// Continuous, but for the steps of single precision in its noises: at most kEmbeddedStep_m, reached on the
// walls of Valles Marineris; a millimetre elsewhere.
//
// It is no data: SourceInfo::illustration is true. Positions and heights of the named landforms follow the IAU
// gazetteer and MOLA (heights and widths within 10 %, places within 0.2 degrees); the broad relief is a fit to
// MOLA with a resolution of about 500 km, the broad albedo one to the Viking mosaic with 250 km; everything
// smaller is made up.
//
// Cost: 0.15 .. 0.4 us a post on one 2020s core for compact batches of some thousand directions, such as tiles;
// directions scattered over the planet cost 20 .. 35 us each.
#pragma once

#include <memory>
#include <span>

#include "mars/geodesy/sphere.h"
#include "mars/sources/source.h"

namespace mars {

// Returns the source of elevation, or of colour. finest_m > 0: with posts and texels of that spacing everywhere, for
// planets that go deep in some region.
std::shared_ptr<const ElevationSource> embedded_elevation(double finest_m = 0);
std::shared_ptr<const ImageSource> embedded_image(double finest_m = 0);

inline constexpr double kEmbeddedStep_m = 0.05;

// Waypoints of the demonstration flight along the floor of Coprates Chasma into Melas Chasma, westwards,
// about 660 km. Within kDemoHalfWidth_m of it the embedded Mars asks for its finest posts.
std::span<const LonLat> demo_path();
inline constexpr double kDemoHalfWidth_m = 12000.0;

// Post (texel) spacings that spacing_in() names: anywhere; over Valles Marineris, Olympus Mons, Gale and Jezero;
// and along the demonstration flight.
struct EmbeddedSpacings {
  double plain_m;
  double landmark_m;
  double demo_m;
};
inline constexpr EmbeddedSpacings kEmbeddedPosts{3700.0, 250.0, 60.0};
inline constexpr EmbeddedSpacings kEmbeddedTexels{2600.0, 300.0, 80.0};

// The finest of the spacings wanted anywhere in the cap; conservative.
double embedded_spacing_in(const Cap& cap, const EmbeddedSpacings& spacings);

}  // namespace mars
