#include "vpe/gl/shaders.h"

#include <string_view>

namespace vpe::gl {

namespace {

constexpr std::string_view kVersion = "#version 450 core\n";

constexpr std::string_view kVertexShader = R"glsl(
layout(location = 0) in vec3 position;
layout(location = 0) uniform vec3 to_camera;
layout(location = 1) uniform vec3 centre;
layout(location = 2) uniform mat3 rotation;
layout(location = 3) uniform vec4 projection;
layout(location = 4) uniform float near;
layout(location = 5) uniform float skirt;
layout(location = 6) uniform int first_foot;
layout(location = 11) uniform vec2 steps;
layout(location = 15) uniform float snap_from;
#ifdef PLACED
layout(location = 23) uniform vec3 face_right;
layout(location = 24) uniform vec3 face_up;
layout(location = 25) uniform vec4 face_rect;
#elif defined(CHART)
layout(location = 1) in vec2 st;
#endif
#ifdef CHART
layout(location = 7) uniform vec3 face_out;
layout(location = 8) uniform vec2 texel;
layout(location = 0) out vec3 texture_position;
#endif
#if defined(PALETTE) || defined(HAZE)
layout(location = 16) uniform vec3 height_terms;
#endif
#ifdef PALETTE
layout(location = 3) out float height;
#endif
#ifdef HAZE
layout(location = 4) out vec4 camera_position;
#endif
void main() {
  vec3 p = position;
  vec3 from_centre = centre + p;
#if defined(PALETTE) || defined(HAZE)
  // |from_centre| - radius without the difference of two radii.
  float drawn_height = (dot(p, 2.0 * centre + p) + height_terms.x) / (length(from_centre) + height_terms.y);
#endif
#ifdef PALETTE
  height = drawn_height * height_terms.z;
#endif
  if (gl_VertexID >= first_foot) p -= skirt * normalize(from_centre);
  vec3 e = rotation * (p + to_camera);
#ifdef HAZE
  camera_position = vec4(e, drawn_height);
#endif
  // Infinite reversed depth: 1 at the near plane, 0 at infinity.
  gl_Position = vec4(projection.x * e.x + projection.z * e.z, projection.y * e.y + projection.w * e.z, near, -e.z);
  // Onto the rasteriser's own grid, where it would put the vertex anyway: one that interpolates from where the vertex
  // was (Mesa's llvmpipe) leaves the range of depths of a triangle seen on its edge. Far outside the image the grid
  // is finer than a float. A triangle that reaches behind the camera is left alone: it is cut before it is put on the grid,
  // and a step of its far corner would be many of a near pixel.
  float far_out = max(abs(gl_Position.x), abs(gl_Position.y));
  if (steps.x > 0.0 && gl_Position.w > snap_from && far_out < 4.0 * gl_Position.w) {
    gl_Position.xy = round(gl_Position.xy / gl_Position.w * steps) / steps * gl_Position.w;
  }
#ifdef CHART
  // Texture coordinates are gnomonic: a ratio of two functions that are linear on the flat triangle.
  float depth = dot(face_out, from_centre) * 1e-6;
#ifdef PLACED
  vec2 uv = vec2(dot(face_right, from_centre), dot(face_up, from_centre)) / dot(face_out, from_centre);
  vec2 st = (uv - face_rect.xy) * face_rect.zw;
#endif
  texture_position = vec3((st * texel.x + texel.y) * depth, depth);
#endif
}
)glsl";

// The colour of ground, without and with its nodata, in air.
constexpr std::string_view kPaint = R"glsl(
layout(location = 9) uniform vec4 flat_colour;
layout(location = 14) uniform vec4 tint;
#if defined(TEXTURE) || defined(FACETS)
layout(binding = 0) uniform sampler2D surface;
#endif
#ifdef CHART
layout(location = 0) in vec3 texture_position;
#endif
#ifdef PALETTE
layout(location = 3) in float height;
layout(location = 17) uniform vec2 palette_terms;
layout(binding = 1) uniform sampler2D palette;
#endif
#ifdef HAZE
layout(location = 4) in vec4 camera_position;  // and height
layout(location = 18) uniform vec4 haze;
layout(location = 20) uniform vec3 up;
layout(location = 22) uniform vec3 sun;
layout(location = 21) uniform vec4 air;  // planet's radius, camera's height, height of air's top, 1 / its scale
// core::air_m(), with the same points and weights. Triangles far away are chords deep below the ground: the way ends at
// the height between their corners.
const vec3 kPoints = vec3(0.033765242898423987, 0.169395306766867743, 0.380690406958401546);
const vec3 kWeights = vec3(0.0856622461895851725, 0.1803807865240693038, 0.2339569672863455237);
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
  float off = camera_position.w * (2.0 * air.x + camera_position.w) - (inner + range * (2.0 * r * sine + range));
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
layout(location = 0) out vec4 colour;
#ifdef NODATA
void show_nodata(inout vec4 colour, bool has_data);
#endif
void paint() {
#if defined(FACETS)
  colour = texelFetch(surface, ivec2(gl_PrimitiveID & 255, gl_PrimitiveID >> 8), 0);
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
  ivec2 size = textureSize(surface, 0);
  bool has_data = texelFetch(surface, clamp(ivec2(at * vec2(size)), ivec2(0), size - 1), 0).a > 0.5;
#endif
  show_nodata(colour, has_data);
#endif
#ifdef HAZE
  // core::haze_colour() over the ground.
  float day = smoothstep(-0.15, 0.3, dot(normalize(up * (air.x + air.y) + camera_position.xyz), sun));
  colour.rgb = mix(haze.rgb * (0.08 + 0.92 * day), colour.rgb, exp(-haze.a * air_length()));
#endif
  colour.rgb = mix(colour.rgb, tint.rgb, tint.a);
}
)glsl";

constexpr std::string_view kFragmentShader = R"glsl(
void main() { paint(); }
)glsl";

// Stripes across the face's chart, along u + v = constant. Each octave of periods halves the one before: as the
// camera comes nearer, a dark stripe grows in the middle of each bright one while the old ones get thinner, so
// that centres stay where they are on the ground and half of it is dark at any distance.
constexpr std::string_view kNodataPattern = R"glsl(
layout(location = 8) uniform vec2 texel;
layout(location = 12) uniform vec3 tile_sides;
layout(location = 13) uniform uint tile_phase;
const float kLeastPeriod = 12.0;  // pixels
const float kBright = 150.0 / 255.0;
const float kDark = 60.0 / 255.0;
// Share of a pixel `wide` at distance `away` from the middle of a stripe of half width `reach`.
float stripe(float away, float reach, float wide) {
  return clamp((reach - away) / wide + 0.5, 0.0, min(1.0, 2.0 * reach / wide));
}
void show_nodata(inout vec4 colour, bool has_data) {
  vec2 at = texture_position.xy / texture_position.z;
  float along = dot((at - texel.y) / texel.x, tile_sides.xy);
  float pixel = length(vec2(dFdx(along), dFdy(along)));
  if (has_data) return;
  float detail = clamp(-log2(kLeastPeriod * pixel), 0.0, tile_sides.z);
  float octave = floor(detail);
  float grown = detail - octave;
  float periods = exp2(octave);
  float wide = max(pixel * periods, 1e-6);
  float phase = fract(float(tile_phase << uint(octave)) * exp2(-32.0) + along * periods);
  float away = min(phase, 1.0 - phase);
  float dark = stripe(away, 0.25 - 0.125 * grown, wide) + stripe(0.5 - away, 0.125 * grown, wide);
  dark = mix(dark, 0.5, smoothstep(0.25, 0.5, wide));
  colour = vec4(vec3(mix(kBright, kDark, dark)), 0.0);
}
)glsl";

// What geometry stages hand on of a corner, or between two.
constexpr std::string_view kHandOn = R"glsl(
#ifdef CHART
layout(location = 0) in vec3 corner_texture_position[];
layout(location = 0) out vec3 texture_position;
#endif
#ifdef PALETTE
layout(location = 3) in float corner_height[];
layout(location = 3) out float height;
#endif
#ifdef HAZE
layout(location = 4) in vec4 corner_camera_position[];
layout(location = 4) out vec4 camera_position;
#endif
#ifdef FACETS
layout(location = 19) uniform int first_facet;
#endif
void hand_on(int from, int to, float share) {
#ifdef CHART
  texture_position = mix(corner_texture_position[from], corner_texture_position[to], share);
#endif
#ifdef PALETTE
  height = mix(corner_height[from], corner_height[to], share);
#endif
#ifdef HAZE
  camera_position = mix(corner_camera_position[from], corner_camera_position[to], share);
#endif
#ifdef FACETS
  gl_PrimitiveID = first_facet + gl_PrimitiveIDIn;
#endif
}
)glsl";

// From two neighbouring vertices of a border and the feet below them. What is thinner in the image than the
// ribbon along its border is left to the ribbon: slivers near the size of the grid that rasterisers snap to
// have no trustworthy depth.
constexpr std::string_view kSkirtGeometryShader = R"glsl(
layout(triangle_strip, max_vertices = 4) out;
layout(location = 10) uniform vec3 ribbon;
layout(location = 1) out float drop;
layout(location = 2) flat out vec2 depths;
void main() {
  float nearest_w = min(min(gl_in[0].gl_Position.w, gl_in[1].gl_Position.w),
                        min(gl_in[2].gl_Position.w, gl_in[3].gl_Position.w));
  vec2 all_depths = vec2(0.0, 1.0);
  if (nearest_w > 0.0) {
    vec2 at[4];
    all_depths = vec2(1.0, 0.0);
    for (int k = 0; k < 4; ++k) {
      vec4 p = gl_in[k].gl_Position;
      at[k] = p.xy * ribbon.xy / p.w;
      all_depths = vec2(min(all_depths.x, p.z / p.w), max(all_depths.y, p.z / p.w));
    }
    vec2 along = at[1] - at[0];
    float size = length(along);
    vec2 across = size > 0.0 ? vec2(-along.y, along.x) / size : vec2(0.0);
    float thin = ribbon.z * 0.66;
    if (max(abs(dot(at[2] - at[0], across)), abs(dot(at[3] - at[1], across))) < thin) return;
    if (max(size, length(at[3] - at[2])) < thin) return;
  }
  for (int k = 0; k < 4; ++k) {
    gl_Position = gl_in[k].gl_Position;
    hand_on(k, k, 0.0);
    depths = all_depths;
    drop = k < 2 ? 0.0 : 1.0;
    EmitVertex();
  }
  EndPrimitive();
}
)glsl";

// Pixels are covered up to a grid step outside of a skirt, where its depth, extrapolated, can stand before the
// ground it hangs from. It is taken back to the nearest part of the skirt.
constexpr std::string_view kSkirtFragmentShader = R"glsl(
layout(location = 1) in float drop;
layout(location = 2) flat in vec2 depths;
void main() {
  vec2 steps = vec2(dFdx(drop), dFdy(drop));
  vec2 slope = vec2(dFdx(gl_FragCoord.z), dFdy(gl_FragCoord.z));
  float back = clamp(drop, 0.0, 1.0) - drop;
  float depth = gl_FragCoord.z + (back == 0.0 ? 0.0 : back * dot(slope, steps) / dot(steps, steps));
  gl_FragDepth = clamp(depth, depths.x, depths.y);
  paint();
}
)glsl";

// Widens a line to a ribbon some hundredths of a pixel across, at the line's own depth. What is behind the near
// plane is cut off first: the corners of a ribbon to behind the camera would change sides on the way.
constexpr std::string_view kRibbonGeometryShader = R"glsl(
layout(triangle_strip, max_vertices = 4) out;
layout(location = 10) uniform vec3 ribbon;
void main() {
  vec4 end[2];
  float cut[2];
  float near = gl_in[0].gl_Position.z;
  for (int k = 0; k < 2; ++k) {
    vec4 p = gl_in[k].gl_Position;
    vec4 q = gl_in[1 - k].gl_Position;
    cut[k] = 0.0;
    if (p.w < near) {
      if (q.w <= near) return;
      cut[k] = (near - p.w) / (q.w - p.w);
    }
    end[k] = mix(p, q, cut[k]);
    if (cut[k] > 0.0) end[k].w = near;
  }
  vec2 line = (end[1].xy / end[1].w - end[0].xy / end[0].w) * ribbon.xy;
  float size = length(line);
  // Ends reach over by half the width, so that ribbons that meet at an angle leave no notch.
  vec2 along = size > 0.0 ? line / size : vec2(1.0, 0.0);
  vec2 across = vec2(-along.y, along.x);
  vec2 wide = ribbon.z / ribbon.xy;
  for (int k = 0; k < 4; ++k) {
    int n = k / 2;
    vec4 p = end[n];
    float side = (k & 1) == 0 ? 1.0 : -1.0;
    float reach = k < 2 ? -1.0 : 1.0;
    gl_Position = vec4(p.xy + (side * across + reach * along) * wide * p.w, p.zw);
    hand_on(n, 1 - n, cut[n]);
    EmitVertex();
  }
  EndPrimitive();
}
)glsl";

}  // namespace

TileShaders tile_shaders(TilePart part, const TilePaint& paint) {
  std::string defines(kVersion);
  const auto define = [&](bool is, const char* name) {
    if (is) defines.append("#define ").append(name).append("\n");
  };
  define(paint.texture, "TEXTURE");
  define(paint.facets, "FACETS");
  define(paint.palette, "PALETTE");
  define(paint.nodata, "NODATA");
  define(paint.haze, "HAZE");
  define(paint.placed, "PLACED");
  define(paint.texture || paint.nodata, "CHART");
  TileShaders out;
  const auto join = [&](std::initializer_list<std::string_view> parts) {
    std::string text = defines;
    for (const std::string_view p : parts) text += p;
    return text;
  };
  out.vertex = join({kVertexShader});
  out.fragment = join({kPaint, paint.nodata ? kNodataPattern : std::string_view(),
                       part == TilePart::kSkirt ? kSkirtFragmentShader : kFragmentShader});
  if (part != TilePart::kSurface)
    out.geometry = join({part == TilePart::kSkirt ? "layout(lines_adjacency) in;" : "layout(lines) in;",
                         kHandOn, part == TilePart::kSkirt ? kSkirtGeometryShader : kRibbonGeometryShader});
  return out;
}

const char* const kSkyVertexShader = R"glsl(
#version 450 core
layout(location = 0) uniform mat3 to_body;
layout(location = 1) uniform vec4 projection;
layout(location = 0) out vec3 ray;
void main() {
  vec2 corner = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);
  gl_Position = vec4(corner, 0.0, 1.0);
  // On the plane e.z = -1: clip = projection.xy * e.xy - projection.zw.
  ray = to_body * vec3((corner + projection.zw) / projection.xy, -1.0);
}
)glsl";

// A thin exponential atmosphere of dust over a black sky: optical depth from the height where the ray passes
// lowest and a bounded air mass. An image, not radiometry.
const char* const kSkyFragmentShader = R"glsl(
#version 450 core
layout(location = 0) in vec3 ray;
layout(location = 2) uniform vec3 up;
layout(location = 3) uniform vec2 altitude;
layout(location = 4) uniform vec3 sun;
layout(location = 0) out vec4 colour;
const float kScaleHeight = 11.0e3;
const float kZenithDepth = 0.25;
void main() {
  vec3 d = normalize(ray);
  float slope = dot(d, up);
  float h = max(altitude.x, 0.0);
  float r = altitude.y;
  // Height of the lowest point of the ray ahead; written without the difference of two radii.
  float lowest = h;
  if (slope < 0.0) {
    float drop = slope * slope * (r + h) / (1.0 + sqrt(max(1.0 - slope * slope, 0.0)));
    lowest = max(h - drop, -8.0e3);
  }
  float limb = sqrt(3.14159265 * r / (2.0 * kScaleHeight));
  float mass = 1.0 / (max(slope, 0.0) + 1.0 / limb);
  if (slope < 0.0) mass = mix(limb, 2.0 * limb, clamp((h - lowest) / kScaleHeight, 0.0, 1.0));
  float depth = kZenithDepth * exp(-lowest / kScaleHeight) * mass;
  float day = smoothstep(-0.15, 0.3, dot(sun, normalize(up * (r + h) + d * max(-slope, 0.0) * (r + h))));
  float glow = pow(max(dot(d, sun), 0.0), 24.0);
  vec3 dust = mix(vec3(0.83, 0.68, 0.53), vec3(0.93, 0.86, 0.80), glow);
  vec3 zenith = vec3(0.62, 0.48, 0.37);
  float veil = 1.0 - exp(-depth);
  vec3 air = mix(zenith, dust, clamp(depth * 0.5, 0.0, 1.0));
  vec3 c = air * veil * (0.08 + 0.92 * day);
  // 1 - cosine, which a cosine in float would lose.
  vec3 off = d - sun;
  float disc = 1.0 - smoothstep(5e-6, 1e-5, 0.5 * dot(off, off));
  c = mix(c, vec3(1.0, 0.98, 0.94), disc * exp(-0.3 * depth));
  colour = vec4(c, 1.0);
}
)glsl";

}  // namespace vpe::gl
