// Colour of ground: from a texture, facets, a palette or one colour; then light, the nodata pattern, haze and tint.
// The fragment shaders of all parts of tiles call colour_ground().
layout(location = LOCATION_FLAT_COLOUR) uniform vec4 flat_colour;
layout(location = LOCATION_TINT) uniform vec4 tint;
#if defined(TEXTURE) || defined(FACETS)
layout(binding = 0) uniform sampler2D surface;
#endif
#ifdef FACETS_FROM_FIRST
layout(location = LOCATION_FIRST_FACET) uniform int first_facet;
#endif
#ifdef CHART
layout(location = 0) in vec3 texture_position;
#endif
#ifdef PALETTE
layout(location = 3) in float height;
layout(location = LOCATION_PALETTE_TERMS) uniform vec2 palette_terms;
layout(binding = 1) uniform sampler2D palette;
#endif
#ifdef HAZE
layout(location = 4) in vec4 camera_position;  // and the drawn height above the sphere
layout(location = LOCATION_HAZE) uniform vec4 haze;
layout(location = LOCATION_UP) uniform vec3 up;
layout(location = LOCATION_SUN) uniform vec3 sun;
layout(location = LOCATION_AIR) uniform vec4 air;

// Points and weights of core::air_m().
const vec3 kPoints = vec3(0.033765242898423987, 0.169395306766867743, 0.380690406958401546);
const vec3 kWeights = vec3(0.0856622461895851725, 0.1803807865240693038, 0.2339569672863455237);

// Returns core::air_m() along the ray to the ground. Triangles far away are chords deep below the ground: the
// ray ends at the height interpolated between their corners.
float air_length() {
  float range = length(camera_position.xyz);
  float sine = dot(camera_position.xyz, up) / range;
  float r = air.x + air.y;
  float inner = air.y * (2.0 * air.x + air.y);
  float half_way = -r * sine;
  float under = half_way * half_way - (inner - air.z * (2.0 * air.x + air.z));
  if (under <= 0.0) return 0.0;
  float root = sqrt(under);
  float begin = clamp(half_way - root, 0.0, range);
  float size = clamp(half_way + root, 0.0, range) - begin;
  float off =
      camera_position.w * (2.0 * air.x + camera_position.w) - (inner + range * (2.0 * r * sine + range));
  float sum = 0.0;
  for (int k = 0; k < 6; ++k) {
    float x = k < 3 ? kPoints[k] : 1.0 - kPoints[k - 3];
    float t = begin + x * size;
    float rise = inner + t * (2.0 * r * sine + t) + x * off;
    sum += kWeights[k < 3 ? k : k - 3] * exp(-rise / (sqrt(air.x * air.x + rise) + air.x) * air.w);
  }
  return size * sum;
}
#endif
#ifdef LIGHT
layout(location = 5) in float light;
#endif
#ifdef THIN
layout(location = 6) flat in float thin;
layout(location = LOCATION_THIN_TINT) uniform vec4 thin_tint;
#endif
layout(location = 0) out vec4 colour;
#ifdef NODATA
void show_nodata(inout vec4 colour, bool has_data);

#ifndef FACETS
bool has_data_at(ivec2 texel, ivec2 size) {
  return texelFetch(surface, clamp(texel, ivec2(0), size - 1), 0).a > 0.5;
}

// Returns whether the texels that span the facet have data. Texels lie at posts or on facets between them, and
// cells are split from south-west to north-east, as those of the reference surface.
bool facet_has_data(vec2 at) {
  ivec2 size = textureSize(surface, 0);
  vec2 place = at * vec2(size) - 0.5;
  ivec2 cell = ivec2(floor(place));
  vec2 rest = place - vec2(cell);
  ivec2 third = rest.x >= rest.y ? ivec2(1, 0) : ivec2(0, 1);
  return has_data_at(cell, size) && has_data_at(cell + third, size) && has_data_at(cell + 1, size);
}
#endif
#endif

void colour_ground() {
#if defined(FACETS)
  int facet = gl_PrimitiveID;
#ifdef FACETS_FROM_FIRST
  facet += first_facet;
#endif
  colour = texelFetch(surface, ivec2(facet & 255, facet >> 8), 0);
  bool has_data = colour.a > 0.5;
  colour.a = 1.0;
#elif defined(TEXTURE)
  vec2 at = texture_position.xy / texture_position.z;
  colour = vec4(texture(surface, at).rgb * flat_colour.rgb, 1.0);
  if (flat_colour.a > 0.0) colour.rgb = flat_colour.rgb;
#elif defined(PALETTE)
  colour = vec4(texture(palette, vec2(height * palette_terms.x + palette_terms.y, 0.5)).rgb, 1.0);
#else
  colour = vec4(flat_colour.rgb, 1.0);
#endif
#ifdef NODATA
#ifndef FACETS
  bool has_data = facet_has_data(at);
#endif
#ifdef LIGHT
  // Stripes over an image are without light, as in textures.
  if (has_data) colour.rgb *= light;
#endif
  show_nodata(colour, has_data);
#elif defined(LIGHT)
  colour.rgb *= light;
#endif
#ifdef HAZE
  // core::haze_colour() over the ground.
  float day = smoothstep(-0.15, 0.3, dot(normalize(up * (air.x + air.y) + camera_position.xyz), sun));
  colour.rgb = mix(haze.rgb * (0.08 + 0.92 * day), colour.rgb, exp(-haze.a * air_length()));
#endif
#ifdef THIN
  colour.rgb = thin > 0.5 ? thin_tint.rgb : tint.rgb;
#else
  colour.rgb = mix(colour.rgb, tint.rgb, tint.a);
#endif
}
