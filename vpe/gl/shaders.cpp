#include "vpe/gl/shaders.h"

namespace vpe::gl {

const char* const kTileVertexShader = R"glsl(
#version 450 core
layout(location = 0) in vec3 position;
layout(location = 1) in vec2 st;
layout(location = 0) uniform vec3 to_eye;
layout(location = 1) uniform vec3 centre;
layout(location = 2) uniform mat3 rotation;
layout(location = 3) uniform vec4 lens;
layout(location = 4) uniform float near;
layout(location = 5) uniform float skirt;
layout(location = 6) uniform int first_foot;
layout(location = 7) uniform vec3 face_out;
layout(location = 8) uniform vec2 texel;
layout(location = 0) out vec3 texture_position;
void main() {
  vec3 p = position;
  vec3 from_centre = centre + p;
  if (gl_VertexID >= first_foot) p -= skirt * normalize(from_centre);
  vec3 e = rotation * (p + to_eye);
  // Infinite reversed depth: 1 at the near plane, 0 at infinity.
  gl_Position = vec4(lens.x * e.x + lens.z * e.z, lens.y * e.y + lens.w * e.z, near, -e.z);
  // Texture coordinates are gnomonic: a ratio of two functions that are linear on the flat triangle.
  float depth = dot(face_out, from_centre) * 1e-6;
  texture_position = vec3((st * texel.x + texel.y) * depth, depth);
}
)glsl";

const char* const kTileFragmentShader = R"glsl(
#version 450 core
layout(location = 0) in vec3 texture_position;
layout(location = 9) uniform vec4 flat_colour;
layout(binding = 0) uniform sampler2D surface;
layout(location = 0) out vec4 colour;
void main() {
  if (flat_colour.a > 0.0) {
    colour = vec4(flat_colour.rgb, 1.0);
  } else {
    colour = vec4(texture(surface, texture_position.xy / texture_position.z).rgb, 1.0);
  }
}
)glsl";

const char* const kSkyVertexShader = R"glsl(
#version 450 core
layout(location = 0) uniform mat3 to_body;
layout(location = 1) uniform vec4 lens;
layout(location = 0) out vec3 ray;
void main() {
  vec2 corner = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);
  gl_Position = vec4(corner, 0.0, 1.0);
  // On the plane e.z = -1: clip = lens.xy * e.xy - lens.zw.
  ray = to_body * vec3((corner + lens.zw) / lens.xy, -1.0);
}
)glsl";

// A thin exponential atmosphere of dust over a black sky: optical depth from the height where the ray passes
// lowest and a bounded air mass. A picture, not radiometry.
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
  float disc = smoothstep(0.99999, 0.999995, dot(d, sun));
  c = mix(c, vec3(1.0, 0.98, 0.94), disc * exp(-0.3 * depth));
  colour = vec4(c, 1.0);
}
)glsl";

const char* const kFullScreenVertexShader = R"glsl(
#version 450 core
void main() {
  gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.0, 1.0);
}
)glsl";

// Smooths stair steps where one surface ends before another. Reversed depth near / z is a linear function of the
// picture position on every plane, at any slant: its second difference is an edge of the geometry, never of a
// texture, which stays as sharp as it is. There the colour is averaged along the edge.
const char* const kEdgeFragmentShader = R"glsl(
#version 450 core
layout(binding = 0) uniform sampler2D picture;
layout(binding = 1) uniform sampler2D depth;
layout(location = 0) out vec4 colour;
float luma(vec3 c) { return dot(c, vec3(0.30, 0.59, 0.11)); }
void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  ivec2 last = textureSize(depth, 0) - 1;
  float c = texelFetch(depth, at, 0).r;
  float w = texelFetch(depth, max(at - ivec2(1, 0), ivec2(0)), 0).r;
  float e = texelFetch(depth, min(at + ivec2(1, 0), last), 0).r;
  float s = texelFetch(depth, max(at - ivec2(0, 1), ivec2(0)), 0).r;
  float n = texelFetch(depth, min(at + ivec2(0, 1), last), 0).r;
  float bend = abs(w + e - 2.0 * c) + abs(s + n - 2.0 * c);
  vec3 own = texelFetch(picture, at, 0).rgb;
  if (bend <= 0.02 * max(max(w, e), max(s, n))) {
    colour = vec4(own, 1.0);
    return;
  }
  vec2 texel = 1.0 / vec2(last + 1);
  vec2 here = (vec2(at) + 0.5) * texel;
  float nw = luma(texture(picture, here + vec2(-0.5, 0.5) * texel).rgb);
  float ne = luma(texture(picture, here + vec2(0.5, 0.5) * texel).rgb);
  float sw = luma(texture(picture, here + vec2(-0.5, -0.5) * texel).rgb);
  float se = luma(texture(picture, here + vec2(0.5, -0.5) * texel).rgb);
  // Along the edge: at right angles to the gradient of brightness.
  vec2 along = vec2(nw + ne - sw - se, nw + sw - ne - se);
  float size = length(along);
  if (size < 1e-3) {
    colour = vec4(own, 1.0);
    return;
  }
  // The flatter the edge, the longer its steps.
  along /= max(abs(along.x), abs(along.y));
  float reach = 1.0 / max(min(abs(along.x), abs(along.y)), 0.2);
  vec2 step_ = along * reach * texel;
  vec3 sum = 0.25 * (texture(picture, here - 0.25 * step_).rgb + texture(picture, here + 0.25 * step_).rgb +
                     texture(picture, here - 0.75 * step_).rgb + texture(picture, here + 0.75 * step_).rgb);
  colour = vec4(mix(own, sum, 0.75), 1.0);
}
)glsl";

}  // namespace vpe::gl
