// Terrain of the embedded Mars: broad relief, provinces, shields, basins and polar caps. Positions and heights
// are published values (IAU gazetteer, MOLA); shapes are simple profiles made irregular by noise.
#pragma once

#include "mars/embedded/block.h"
#include "mars/embedded/math.h"

namespace mars::embedded {

// Holds the octaves of noise that landforms and roughness share: wavelengths of 2^k metres, standard deviation
// 1. Those from kOutlineOctave on are present at every spacing.
inline constexpr int kLastOctave = 19;
inline constexpr int kOutlineOctave = 14;
struct Octaves {
  int first = kOutlineOctave;
  std::array<Lane<float>, kLastOctave + 1> n;
};

// Adds octave k.
void add_octave(const Block& block, int k, Octaves& out);

// Names the octaves that make outlines irregular by their wavelength.
struct OutlineNoise {
  explicit OutlineNoise(const Octaves& o)
      : km600(o.n[19]), km250(o.n[18]), km100(o.n[17]), km40(o.n[15]), km16(o.n[14]) {}
  const Lane<float>&km600, &km250, &km100, &km40, &km16;
};

// Sets all of Terrain, without detail shorter than 2 * spacing_m. `octaves` must contain those from
// kOutlineOctave on. Callers evaluate crater densities at one spacing always, so that the same craters exist at
// every spacing.
void terrain(const Block& block, const Octaves& octaves, double spacing_m, Terrain& out);

// Parts of terrain(), in the order in which they are applied.
void lay_provinces(const Block& block, const OutlineNoise& w, Terrain& t);
void raise_shields(const Block& block, const OutlineNoise& w, double spacing_m, Terrain& t);  // shields.cpp
void crack_noctis(const Block& block, const OutlineNoise& w, double spacing_m, Terrain& t);   // noctis.cpp
void cut_troughs(const Block& block, const OutlineNoise& w, double spacing_m, Terrain& t);    // troughs.cpp
void carve_valleys(const Block& block, double spacing_m, Terrain& t);                         // valleys.cpp
void pile_mounds(const Block& block, const OutlineNoise& w, double spacing_m, Terrain& t);    // mounds.cpp
void lay_caps(const Block& block, const OutlineNoise& w, double spacing_m, Terrain& t);       // caps.cpp

// Describes the foot of a scarp.
struct Foot {
  const PlaceFrame& frame;
  double radius_km;
};

// Part of raise_shields(), in slides.cpp. Adds landslides at the foot of a scarp: lobes that run out radially
// over the plain, with radial grooves. `distorted_km` is the distance from the middle, distorted like the
// scarp.
void spread_aprons(const Block& block, double spacing_m, const Foot& foot, const Lane<double>& distorted_km,
                   Terrain& t);

// Part of raise_shields(), in slides.cpp. Adds the aureole: lobes of ridged ground around Olympus, widest to
// the north-west.
void lay_aureole(const Block& block, const OutlineNoise& w, double spacing_m, Terrain& t);

}  // namespace mars::embedded
