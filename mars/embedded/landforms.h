// Terrain of the embedded Mars: broad relief, provinces, shields, basins and polar caps. Positions and heights
// are the published ones (IAU gazetteer, MOLA); shapes are simple profiles made irregular by noise.
#pragma once

#include "mars/embedded/block.h"
#include "mars/embedded/math.h"

namespace mars::embedded {

// The octaves of noise that landforms and roughness share: wavelengths of 2^k metres, standard deviation 1.
// Those from kWanderOctave on are there at every spacing.
inline constexpr int kLastOctave = 19;
inline constexpr int kWanderOctave = 14;
struct Octaves {
  int first = kWanderOctave;
  std::array<Lane<float>, kLastOctave + 1> n;
};
void add_octave(const Block& block, int k, Octaves& out);

// Names for what makes outlines wander, by wavelength.
struct Wander {
  explicit Wander(const Octaves& o)
      : km600(o.n[19]), km250(o.n[18]), km100(o.n[17]), km40(o.n[15]), km16(o.n[14]) {}
  const Lane<float>&km600, &km250, &km100, &km40, &km16;
};

// Everything of Terrain, without detail shorter than 2 * spacing_m. `octaves` needs those from kWanderOctave
// on. Crater densities are asked for at one spacing always, so that the same craters are there at every one.
void terrain(const Block& block, const Octaves& octaves, double spacing_m, Terrain& out);

// The parts of terrain(), in the order in which they are applied.
void lay_provinces(const Block& block, const Wander& w, Terrain& t);
void raise_shields(const Block& block, const Wander& w, double spacing_m, Terrain& t);  // embedded_shields.cpp
void crack_noctis(const Block& block, const Wander& w, double spacing_m, Terrain& t);   // embedded_noctis.cpp
void cut_troughs(const Block& block, const Wander& w, double spacing_m, Terrain& t);    // embedded_troughs.cpp
void carve_valleys(const Block& block, double spacing_m, Terrain& t);                   // embedded_valleys.cpp
void pile_mounds(const Block& block, const Wander& w, double spacing_m, Terrain& t);    // embedded_mounds.cpp
void lay_caps(const Block& block, const Wander& w, double spacing_m, Terrain& t);       // embedded_caps.cpp

// Parts of raise_shields(), in embedded_slides.cpp.
// Landslides at the foot of a scarp: lobes that run out radially over the plain, grooved along their way.
// `bent_km` are distances from the middle, bent as the scarp is.
struct Foot {
  const PlaceFrame& frame;
  double radius_km;
};
void spread_aprons(const Block& block, double spacing_m, const Foot& foot, const Lane<double>& bent_km,
                   Terrain& t);
// The aureole: lobes of ridged ground about Olympus, farthest to the north-west.
void lay_aureole(const Block& block, const Wander& w, double spacing_m, Terrain& t);

}  // namespace mars::embedded
