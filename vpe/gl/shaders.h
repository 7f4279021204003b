// Programs of the polygon backend: sources in GLSL and locations of uniforms.
//
// The GLSL itself lies in vpe/gl/shaders/. The tables below number the uniforms for C++ and GLSL alike: the
// location of a uniform is its place in the table, tile_uniform("near") in C++ and LOCATION_NEAR in GLSL.
#pragma once

#include <array>
#include <compare>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>

#include "vpe/gl/tile_id.h"

namespace vpe::gl {

// Uniforms of the programs that draw tiles.
inline constexpr auto kTileUniforms = std::to_array<std::string_view>({
    "to_camera",      // vec3: tile centre - camera, rounded from double
    "centre",         // vec3: tile centre (body-fixed), for the local vertical
    "rotation",       // mat3: body-fixed -> right, up, backward
    "projection",     // vec4: clip x scale, y scale, x shift, y shift
    "near",           // float: distance of the near plane, m
    "steps",          // vec2: steps of the rasteriser in half the image's sides; 0 = no snapping
    "snap_from",      // float: depth from which no vertex shares a triangle with one behind the near plane
    "skirt",          // float: depth of skirts, m
    "first_foot",     // int: first vertex that is the foot of a skirt
    "ribbon",         // vec3: half the image's sides, half a ribbon's width; pixels
    "face_out",       // vec3: axis of the tile's cube face
    "face_right",     // vec3: axis of the face; PLACED only
    "face_up",        // vec3: axis of the face; PLACED only
    "face_rect",      // vec4: the tile's least u and v, 1 / its sides; PLACED only
    "texel",          // vec2: scale and shift from tile coordinates to texture coordinates
    "first_facet",    // int: facet of the first primitive
    "flat_colour",    // vec4: alpha > 0: this colour instead of the texture, else a factor on it
    "tint",           // vec4: this colour takes the share alpha
    "thin_tint",      // vec4: the tint of thin triangles; THIN only
    "tile_sides",     // vec3: the tile's sides in u and v; log2 of the most periods of stripes in a unit of the
                      // chart; NODATA only
    "tile_phase",     // uint: u + v at the tile's southwest corner, its fraction in 2^-32; NODATA only
    "height_terms",   // vec3: |centre|^2 - radius^2, radius, 1 / exaggeration
    "palette_terms",  // vec2: palette coordinate = height * x + y
    "light_sun",      // vec3: towards the sun, body-fixed; LIGHT only
    "light_terms",    // vec2: ambient and diffuse light; LIGHT only
    "haze",           // vec4: colour by day, extinction per metre
    "up",             // vec3: the vertical at the camera, in camera coordinates
    "sun",            // vec3: towards the sun, in camera coordinates
    "air",            // vec4: planet's radius, camera's height, height of the air's top, 1 / its scale height
});

// Uniforms of the program that draws the sky.
inline constexpr auto kSkyUniforms = std::to_array<std::string_view>({
    "to_body",     // mat3: right, up, backward -> body-fixed
    "projection",  // vec4: clip x scale, y scale, x shift, y shift
    "up",          // vec3: local vertical at the camera
    "altitude",    // vec2: camera above the sphere, radius; m
    "sun",         // vec3: towards the sun
    "air",         // vec4: optical depths of colours and of the sun straight up, scale height, lowest height; m
    "zenith",      // vec3: colour of thin air
    "dust",        // vec3: colour of thick air
    "glow",        // vec3: colour of thick air before the sun
    "disc",        // vec3: colour of the sun
});

// Returns the place of a name in a table. A name that the table does not have is a compile error.
consteval int uniform_location(std::span<const std::string_view> table, std::string_view name) {
  for (std::size_t n = 0; n < table.size(); ++n) {
    if (table[n] == name) return static_cast<int>(n);
  }
  throw "no such uniform";
}
consteval int tile_uniform(std::string_view name) { return uniform_location(kTileUniforms, name); }
consteval int sky_uniform(std::string_view name) { return uniform_location(kSkyUniforms, name); }

// Describes what the programs of a tile do. They hold nothing that an appearance does not use.
struct TileFeatures {
  bool texture = false;       // colours come from a texture: baked colours, or light times a colour
  bool facets = false;        // colours come from a table with one colour for each triangle
  bool palette = false;       // colours come from the height of what is drawn
  bool nodata = false;        // nodata ground is striped and has alpha 0
  bool nodata_image = false;  // the stripes are over the image
  bool haze = false;
  bool placed = false;  // texture coordinates come from positions, not from vertices: within 1e-7 of the face
  bool light = false;   // colours are multiplied with light of the vertices
  bool by_triangle = false;  // of surfaces: corners are put on the rasteriser's grid triangle by triangle
  bool thin = false;  // of surfaces by triangle: nothing but the tint is drawn, another one for thin triangles
  auto operator<=>(const TileFeatures&) const = default;
};

struct ShaderSources {
  std::string vertex;
  std::string geometry;  // empty: no such stage
  std::string fragment;
};

// Returns the sources of the program that draws one part of tiles.
ShaderSources tile_shaders(TilePart part, const TileFeatures& features);

// Returns the sources of the program that draws the sky. It needs three vertices and no attributes.
ShaderSources sky_shaders();

}  // namespace vpe::gl
