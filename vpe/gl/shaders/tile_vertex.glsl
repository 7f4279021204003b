// Vertex shader of all parts of tiles: moves a vertex to the camera's coordinates and projects it.
layout(location = 0) in vec3 position;
layout(location = LOCATION_TO_CAMERA) uniform vec3 to_camera;
layout(location = LOCATION_CENTRE) uniform vec3 centre;
layout(location = LOCATION_ROTATION) uniform mat3 rotation;
layout(location = LOCATION_PROJECTION) uniform vec4 projection;
layout(location = LOCATION_NEAR) uniform float near;
layout(location = LOCATION_SKIRT) uniform float skirt;
layout(location = LOCATION_FIRST_FOOT) uniform int first_foot;
layout(location = LOCATION_STEPS) uniform vec2 steps;
layout(location = LOCATION_SNAP_FROM) uniform float snap_from;
#ifdef PLACED
layout(location = LOCATION_FACE_RIGHT) uniform vec3 face_right;
layout(location = LOCATION_FACE_UP) uniform vec3 face_up;
layout(location = LOCATION_FACE_RECT) uniform vec4 face_rect;
#elif defined(CHART)
layout(location = 1) in vec2 st;
#endif
#ifdef CHART
layout(location = LOCATION_FACE_OUT) uniform vec3 face_out;
layout(location = LOCATION_TEXEL) uniform vec2 texel;
layout(location = 0) out vec3 texture_position;
#endif
#if defined(PALETTE) || defined(HAZE)
layout(location = LOCATION_HEIGHT_TERMS) uniform vec3 height_terms;
#endif
#ifdef PALETTE
layout(location = 3) out float height;
#endif
#ifdef HAZE
layout(location = 4) out vec4 camera_position;  // and the drawn height above the sphere
#endif
#ifdef LIGHT
layout(location = 2) in vec2 packed_normal;
layout(location = LOCATION_LIGHT_SUN) uniform vec3 light_sun;
layout(location = LOCATION_LIGHT_TERMS) uniform vec2 light_terms;
layout(location = 5) out float light;

// Returns unpack_normal() of vpe/gl/tile_geometry.h.
vec3 unpack_normal(vec2 p) {
  vec3 n = vec3(p, 1.0 - abs(p.x) - abs(p.y));
  if (n.z < 0.0) n.xy = (1.0 - abs(p.yx)) * vec2(p.x >= 0.0 ? 1.0 : -1.0, p.y >= 0.0 ? 1.0 : -1.0);
  return normalize(n);
}
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
  gl_Position =
      vec4(projection.x * e.x + projection.z * e.z, projection.y * e.y + projection.w * e.z, near, -e.z);
  // The vertex is put on the rasteriser's own grid, where the rasteriser would put it anyway: one that
  // interpolates from the unrounded place (Mesa's llvmpipe) leaves the range of depths of a triangle seen
  // edge-on. Far outside the image the grid is finer than a float. A triangle that reaches behind the camera
  // is left alone: it is clipped before it is put on the grid, and a step of its far corner would be many
  // steps of a near pixel.
  float far_out = max(abs(gl_Position.x), abs(gl_Position.y));
  if (steps.x > 0.0 && gl_Position.w > snap_from && far_out < 4.0 * gl_Position.w) {
    gl_Position.xy = round(gl_Position.xy / gl_Position.w * steps) / steps * gl_Position.w;
  }
#ifdef LIGHT
  // core::light().
  light = sqrt(light_terms.x + light_terms.y * max(dot(unpack_normal(packed_normal), light_sun), 0.0));
#endif
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
