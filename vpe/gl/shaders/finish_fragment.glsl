// Fragment shader that smooths edges and applies gamma. It follows vpe/core/image/edge_filter.cpp and apply_gamma() step by
// step. Rows are counted from the top here; those of the two textures are stored from the bottom.
layout(binding = 8) uniform sampler2D colours;
layout(binding = 9) uniform sampler2D depths;
layout(location = 0) uniform ivec2 size;  // pixels
layout(location = 1) uniform float inverse_gamma;
layout(location = 2) uniform bool smooths;
layout(location = 0) out vec4 finished;

const float EDGE_BEND = 0.02;  // core::kEdgeBend

ivec2 stored(ivec2 pixel) {
  ivec2 inside = clamp(pixel, ivec2(0), size - 1);
  return ivec2(inside.x, size.y - 1 - inside.y);
}

// 0 to 255.
vec3 colour_at(ivec2 pixel) { return 255.0 * texelFetch(colours, stored(pixel), 0).rgb; }

float depth_at(ivec2 pixel) { return texelFetch(depths, stored(pixel), 0).r; }

// A bilinear mean; pixel centres are at whole numbers.
vec3 between(vec2 place) {
  vec2 base = floor(place);
  vec2 t = place - base;
  ivec2 p = ivec2(base);
  return mix(mix(colour_at(p), colour_at(p + ivec2(1, 0)), t.x),
             mix(colour_at(p + ivec2(0, 1)), colour_at(p + ivec2(1, 1)), t.x), t.y);
}

// Brightness of the four pixels about a corner.
float luma(ivec2 p) {
  vec3 sum = colour_at(p) + colour_at(p + ivec2(1, 0)) + colour_at(p + ivec2(0, 1)) + colour_at(p + ivec2(1, 1));
  return 0.25 * dot(sum, vec3(0.30, 0.59, 0.11));
}

bool is_edge(ivec2 p) {
  float c = depth_at(p);
  float west = depth_at(p - ivec2(1, 0));
  float east = depth_at(p + ivec2(1, 0));
  float above = depth_at(p - ivec2(0, 1));
  float below = depth_at(p + ivec2(0, 1));
  float bend = abs(west + east - 2.0 * c) + abs(above + below - 2.0 * c);
  return bend > EDGE_BEND * max(max(west, east), max(above, below));
}

vec3 smoothed(ivec2 p) {
  float upper_left = luma(p - ivec2(1, 1));
  float upper_right = luma(p - ivec2(0, 1));
  float lower_left = luma(p - ivec2(1, 0));
  float lower_right = luma(p);
  // At right angles to the gradient of brightness.
  vec2 along = vec2(upper_left + upper_right - lower_left - lower_right,
                    -(upper_left + lower_left - upper_right - lower_right));
  vec3 own = colour_at(p);
  if (dot(along, along) < 0.06) return own;
  along /= max(abs(along.x), abs(along.y));
  // The flatter the edge, the longer its steps.
  along /= max(min(abs(along.x), abs(along.y)), 0.2);
  vec2 here = vec2(p);
  vec3 sum = between(here - 0.25 * along) + between(here + 0.25 * along) + between(here - 0.75 * along) +
             between(here + 0.75 * along);
  return own * 0.25 + sum * (0.75 / 4.0);
}

void main() {
  ivec2 p = ivec2(gl_FragCoord.xy);
  vec3 colour = smooths && is_edge(p) ? smoothed(p) : colour_at(p);
  vec3 share = floor(clamp(colour, 0.0, 255.0) + 0.5) / 255.0;
  if (inverse_gamma != 1.0) share = pow(share, vec3(inverse_gamma));
  finished = vec4(share, 1.0);
}
