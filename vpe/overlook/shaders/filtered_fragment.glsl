// Fragment shader where a pixel of the view covers more of the image: the same means as panorama/viewer/sampler.cpp.
#version 450 core
layout(location = 0) uniform vec4 place[4];
layout(location = 4) uniform vec4 reduction;  // pixels of the image to one of each level
layout(location = 5) uniform int levels;
layout(binding = 0) uniform sampler2D level_0;
layout(binding = 1) uniform sampler2D level_1;
layout(binding = 2) uniform sampler2D level_2;
layout(binding = 3) uniform sampler2D level_3;
layout(location = 0) in vec2 at;
layout(location = 0) out vec4 colour;

const float kMostSamples = 16.0;

vec3 between_pixels(int level, vec2 p) {
  vec2 t = p * place[level].xy + place[level].zw;
  if (level == 0) return textureLod(level_0, t, 0.0).rgb;
  if (level == 1) return textureLod(level_1, t, 0.0).rgb;
  if (level == 2) return textureLod(level_2, t, 0.0).rgb;
  return textureLod(level_3, t, 0.0).rgb;
}

vec3 between_levels(int level, float share, vec2 p) {
  vec3 here = between_pixels(level, p);
  if (share <= 0.0) return here;
  return mix(here, between_pixels(level + 1, p), share);
}

void main() {
  vec2 across = dFdx(at);
  vec2 down = dFdy(at);
  float across_px = length(across);
  float down_px = length(down);
  float longest_px = max(across_px, down_px);
  float area_px = abs(across.x * down.y - across.y * down.x);
  float thin_px = max(max(longest_px > 0.0 ? area_px / longest_px : 0.0, longest_px / kMostSamples), 1.0);
  int level = 0;
  while (level + 1 < levels && reduction[level + 1] <= thin_px) ++level;
  float share = 0.0;
  if (level + 1 < levels && thin_px > reduction[level])
    share = log(thin_px / reduction[level]) / log(reduction[level + 1] / reduction[level]);
  float samples = clamp(ceil(longest_px / thin_px - 1e-3), 1.0, kMostSamples);
  if (samples < 1.5) {
    colour = vec4(between_levels(level, share, at), 1.0);
    return;
  }
  vec2 longer = across_px > down_px ? across : down;
  vec3 sum = vec3(0.0);
  for (float n = 0.5; n < samples; n += 1.0) sum += between_levels(level, share, at + longer * (n / samples - 0.5));
  colour = vec4(sum / samples, 1.0);
}
