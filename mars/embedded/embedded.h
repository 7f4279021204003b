// The embedded Mars: an analytic illustration of the published landforms, for use without any data.
//
// embedded_elevation() and embedded_image() are functions of direction and spacing alone, defined everywhere
// and at every spacing down to 1/16 m. The spacing is rounded down to a power of two. It decides which
// wavelengths and which sizes of craters and rocks are included: about twice the spacing and more. Values are
// bit-identical on every machine and compiler, because only integers and IEEE + - * / sqrt are used.
//
// The surface is continuous except for steps from single precision in its noise: at most kEmbeddedStep_m,
// reached on the walls of Valles Marineris; a millimetre elsewhere.
//
// It is no data: SourceInfo::illustration is true. Positions and heights of the named landforms follow the IAU
// gazetteer and MOLA (heights and widths within 10 %, places within 0.2 degrees). The broad relief is a fit to
// MOLA with a resolution of about 500 km, the broad albedo a fit to the Viking mosaic with 250 km; everything
// smaller is synthetic.
//
// Cost: 0.15 .. 0.4 us per post on one core of the 2020s for compact batches of several thousand directions,
// such as tiles; directions scattered over the planet cost 20 .. 35 us each.
//
// Typical usage:
//   const auto source = embedded_elevation();
//   source->sample(directions, spacing_m, heights_m);
#pragma once

#include <memory>
#include <span>

#include "mars/geodesy/sphere.h"
#include "mars/sources/source.h"

namespace mars {

// Return the source of elevation, or of colour. finest_m > 0 sets the spacing of posts or texels everywhere,
// for planets that are refined in some region; else kEmbeddedPosts or kEmbeddedTexels hold.
std::shared_ptr<const ElevationSource> embedded_elevation(double finest_m = 0);
std::shared_ptr<const ImageSource> embedded_image(double finest_m = 0);

// Bounds the steps of the surface.
inline constexpr double kEmbeddedStep_m = 0.05;

// Returns the waypoints of the demonstration flight along the floor of Coprates Chasma into Melas Chasma,
// westwards, about 660 km. Within kDemoHalfWidth_m of it the embedded Mars has its finest posts.
std::span<const LonLat> demo_path();
inline constexpr double kDemoHalfWidth_m = 12000.0;

// Holds the spacings of posts or texels that spacing_in() returns.
struct EmbeddedSpacings {
  double plain_m;     // anywhere
  double landmark_m;  // over Valles Marineris, Olympus Mons, Gale and Jezero
  double demo_m;      // along the demonstration flight
};
inline constexpr EmbeddedSpacings kEmbeddedPosts{3700.0, 250.0, 60.0};
inline constexpr EmbeddedSpacings kEmbeddedTexels{2600.0, 300.0, 80.0};

// Returns the finest of the spacings anywhere in the cap. Conservative.
double embedded_spacing_in(const Cap& cap, const EmbeddedSpacings& spacings);

}  // namespace mars
