// GLSL sources of the polygon backend.
#pragma once

#include <compare>
#include <string>

#include "vpe/gl/tile_id.h"

namespace vpe::gl {

// What the programs that draw tiles are made with: nothing that an appearance does not use is in them.
struct TilePaint {
  bool texture = false;  // baked colours, or light times a colour
  bool facets = false;   // a baked colour for each triangle
  bool palette = false;  // colour of the height of what is drawn
  bool nodata = false;   // ground without data is striped and has alpha 0
  bool haze = false;
  bool placed = false;  // texture coordinates from positions, not from vertices: within 1e-7 of the face
  auto operator<=>(const TilePaint&) const = default;
};

struct TileShaders {
  std::string vertex;
  std::string geometry;  // empty for surfaces
  std::string fragment;
};
TileShaders tile_shaders(TilePart part, const TilePaint& paint);

extern const char* const kSkyVertexShader;
extern const char* const kSkyFragmentShader;

// Uniform locations of the programs that draw tiles.
enum TileUniform : int {
  kToEye = 0,       // vec3: tile centre - camera, rounded from double
  kCentre = 1,      // vec3: tile centre (body-fixed), for the local vertical
  kRotation = 2,    // mat3: body-fixed -> right, up, backward
  kLens = 3,        // vec4: clip x scale, y scale, x shift, y shift
  kNear = 4,        // float
  kSkirt = 5,       // float: depth of skirts, m
  kFirstFoot = 6,   // int: first vertex that is the foot of a skirt
  kFaceOut = 7,     // vec3: the face's axis
  kTexel = 8,       // vec2: scale and shift from tile coordinates to texture coordinates
  kFlatColour = 9,  // vec4: alpha > 0: this colour instead of the texture, else a factor on it
  kRibbon = 10,     // vec3: half the image's sides, half a ribbon's width; pixels
  kSteps = 11,      // vec2: steps of the rasteriser in half the image's sides; 0 = vertices stay where they are
  kTileSides = 12,  // vec3: of the tile in its face's chart, u and v; log2 of how fine its stripes get, in
                    // periods to a unit of the chart. with_nodata() only, as the next
  kTilePhase = 13,  // uint: u + v at the tile's southwest corner, its fraction in 2^-32
  kTint = 14,       // vec4: this colour takes the share alpha
  kSnapFrom = 15,   // float: depth from which no vertex shares a triangle with one behind the near plane
  kHeightTerms = 16,   // vec3: |centre|^2 - radius^2, radius, 1 / exaggeration
  kPaletteTerms = 17,  // vec2: palette coordinate = height * x + y
  kHaze = 18,          // vec4: colour by day, extinction per metre
  kUp = 20,            // vec3: the vertical at the camera, in camera coordinates
  kAir = 21,           // vec4: planet's radius, camera's height, height of air's top, 1 / its scale
  kSun = 22,           // vec3: towards the sun, in camera coordinates
  kFaceRight = 23,     // vec3: of the face; placed only, as the next
  kFaceUp = 24,        // vec3
  kFaceRect = 25,      // vec4: the tile's least u and v, 1 / its sides
  kFirstFacet = 19,    // int: facet of the first primitive
};

// Uniform locations of the sky program.
enum SkyUniform : int {
  kSkyRotation = 0,    // mat3: right, up, backward -> body-fixed
  kSkyProjection = 1,  // vec4
  kSkyUp = 2,          // vec3: local vertical at the camera
  kSkyAltitude = 3,    // vec2: camera above the sphere, radius; m
  kSkySun = 4,         // vec3: towards the sun
};

}  // namespace vpe::gl
