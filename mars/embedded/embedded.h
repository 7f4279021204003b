// The embedded Mars: measured heights and colours that the program carries, and marked detail below their resolution.
//
// Down to its own resolution it is MOLA and MDIM 2.1 at eight posts a degree (mars/data): the cubic spline through the
// posts. Below it, the source "embedded-detail" adds synthetic relief, whose amplitude and kind follow from the data
// around: local relief, slope, density of pits, brightness. It is zero at the posts of the data, and zero in the mean over
// the area of a post (to about a metre), so that it adds nothing that the data could contradict.
//
// embedded_elevation() and embedded_image() are functions of direction and spacing alone, defined everywhere
// and at every spacing down to 1/16 m. The spacing is rounded down to a power of two. It decides which
// wavelengths and which sizes of craters and rocks are included: about twice the spacing and more. From 2048 m on there
// is no detail. Heights are bit-identical on every machine and compiler, because only integers and IEEE + - * / sqrt are
// used; colours are as the JPEG library decodes the mosaic.
//
// The surface is continuous except for steps from single precision in the detail: at most kEmbeddedStep_m,
// reached on the walls of Valles Marineris; a millimetre elsewhere.
//
// The sources are a sphere of plain colour with detail where the files of mars/data are missing. Their infos say so: they
// are named so, are an illustration, and have a note with the reason.
//
// Cost: 0.7 us per post with detail on one core of the 2020s for compact batches of several thousand directions,
// such as tiles; directions scattered over the planet cost up to a millisecond each.
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

struct EmbeddedOptions {
  // > 0: the spacing of posts or texels everywhere, for planets that are refined in some region; else those of
  // kEmbeddedPosts and kEmbeddedTexels.
  double finest_m = 0;
  bool detail = true;  // false: the data alone
};

// Return the source of elevation, or of colour. Opening reads the carried data once, in a fraction of a second.
std::shared_ptr<const ElevationSource> embedded_elevation(const EmbeddedOptions& options = {});
std::shared_ptr<const ImageSource> embedded_image(const EmbeddedOptions& options = {});

// Name of the source of synthetic detail in planet files and answers.
inline constexpr const char* kEmbeddedDetail = "embedded-detail";

// Deviations from the planet, one sigma: of the data between their posts, and of the surface with detail. Measured on the
// MOLA grid of 128 posts a degree at Gale (115 m and 134 m), which is rougher than most of the planet.
inline constexpr double kMeasuredAccuracy_m = 120.0;
inline constexpr double kDetailAccuracy_m = 140.0;

// Bounds the steps of the surface.
inline constexpr double kEmbeddedStep_m = 0.05;

// Returns the waypoints of the demonstration flight along the floor of Coprates Chasma into Melas Chasma,
// westwards, about 660 km. Within kDemoHalfWidth_m of it the embedded Mars has its finest posts.
std::span<const LonLat> demo_path();
inline constexpr double kDemoHalfWidth_m = 9000.0;

// Holds the spacings of posts or texels that spacing_in() returns.
struct EmbeddedSpacings {
  double plain_m;     // anywhere
  double broad_m;     // over Valles Marineris, Noctis Labyrinthus and Olympus Mons
  double landmark_m;  // within 45 km of the demonstration flight, over Gale and Jezero
  double demo_m;      // along the demonstration flight
};
inline constexpr EmbeddedSpacings kEmbeddedPosts{5300.0, 660.0, 170.0, 60.0};
inline constexpr EmbeddedSpacings kEmbeddedTexels{5300.0, 660.0, 170.0, 90.0};

// Returns the finest of the spacings anywhere in the cap. Conservative.
double embedded_spacing_in(const Cap& cap, const EmbeddedSpacings& spacings);

}  // namespace mars
