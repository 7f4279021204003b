// Fragment shader where a pixel of the view covers more of the image: the same means as panorama/viewer/sampler.cpp. Variants
// have fewer levels and samples: those that no pixel of a part needs more of.
#version 450 core
#ifndef kLevels
#define kLevels 4
#define kSamples 16
#endif
layout(location = 0) uniform vec4 place[4];
layout(location = 4) uniform vec4 reduction;  // pixels of the image to one of each level
layout(location = 5) uniform vec4 per_octave;  // 1 / log2 of the ratio of a level's reduction to the next one's
layout(binding = 0) uniform sampler2D level_0;
layout(binding = 1) uniform sampler2D level_1;
layout(binding = 2) uniform sampler2D level_2;
layout(binding = 3) uniform sampler2D level_3;
layout(location = 0) in vec2 at;
layout(location = 0) out vec4 colour;

// Without a branch: those of a GPU's lanes that are drawn together, and of llvmpipe's, take both sides.
vec3 mixed(vec4 weights, vec2 p) {
#if kLevels == 1
  return textureLod(level_0, p * place[0].xy + place[0].zw, 0.0).rgb;
#else
  vec3 sum = weights.x * textureLod(level_0, p * place[0].xy + place[0].zw, 0.0).rgb +
             weights.y * textureLod(level_1, p * place[1].xy + place[1].zw, 0.0).rgb;
#if kLevels > 2
  sum += weights.z * textureLod(level_2, p * place[2].xy + place[2].zw, 0.0).rgb;
#endif
#if kLevels > 3
  sum += weights.w * textureLod(level_3, p * place[3].xy + place[3].zw, 0.0).rgb;
#endif
  return sum;
#endif
}

// Returns how much of each level a width of samples takes: of the coarsest whose pixels are at most as wide, and of the next.
vec4 weights_of(float thin_px) {
#if kLevels == 1
  return vec4(1.0, 0.0, 0.0, 0.0);
#else
  vec4 octaves = log2(max(vec4(thin_px) / reduction, vec4(1e-6))) * per_octave;
  vec4 rise = clamp(octaves, 0.0, 1.0);  // 1 where the next level begins
#if kLevels == 2
  return vec4(1.0 - rise.x, rise.x, 0.0, 0.0);
#elif kLevels == 3
  return vec4(1.0 - rise.x, rise.x - rise.y, rise.y, 0.0);
#else
  return vec4(1.0 - rise.x, rise.x - rise.y, rise.y - rise.z, rise.z);
#endif
#endif
}

void main() {
  vec2 across = dFdx(at);
  vec2 down = dFdy(at);
  float across_px = length(across);
  float down_px = length(down);
  float longest_px = max(across_px, down_px);
  float area_px = abs(across.x * down.y - across.y * down.x);
  float thin_px = max(max(longest_px > 0.0 ? area_px / longest_px : 0.0, longest_px / 16.0), 1.0);
  vec4 weights = weights_of(thin_px);
#if kSamples == 1
  colour = vec4(mixed(weights, at), 1.0);
#else
  float samples = clamp(ceil(longest_px / thin_px - 1e-3), 1.0, float(kSamples));
  vec2 longer = across_px > down_px ? across : down;
#if kSamples == 2
  // One sample lies in the middle, two at a quarter from it.
  vec2 off = samples > 1.5 ? 0.25 * longer : vec2(0.0);
  colour = vec4(0.5 * (mixed(weights, at - off) + mixed(weights, at + off)), 1.0);
#else
  vec3 sum = vec3(0.0);
  for (float n = 0.5; n < samples; n += 1.0) sum += mixed(weights, at + longer * (n / samples - 0.5));
  colour = vec4(sum / samples, 1.0);
#endif
#endif
}
