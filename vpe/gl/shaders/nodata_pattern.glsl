// Pattern of nodata ground: stripes across the face's chart, along u + v = constant. Each octave of periods
// halves the one before. As the camera comes nearer, a dark stripe grows in the middle of each bright one while
// the old ones get thinner, so that centres stay where they are on the ground and half of it is dark at any
// distance.
//
// Over an image the stripes are its colours times their grey over kMissing, the grey of missing imagery: that
// has plain greys. vpe/core/appearance/nodata_pattern.h has the same stripes.
layout(location = LOCATION_TEXEL) uniform vec2 texel;
layout(location = LOCATION_TILE_SIDES) uniform vec3 tile_sides;
layout(location = LOCATION_TILE_PHASE) uniform uint tile_phase;
const float kLeastPeriod = 12.0;  // pixels
const float kBright = 150.0 / 255.0;
const float kDark = 60.0 / 255.0;
const float kMissing = 128.0 / 255.0;

// Returns the share of a pixel of width `wide`, `away` from the middle of a stripe, that the stripe of half
// width `reach` covers.
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
  float grey = mix(kBright, kDark, dark);
#ifdef NODATA_IMAGE
  colour = vec4(min(colour.rgb * (grey / kMissing), 1.0), 0.0);
#else
  colour = vec4(vec3(grey), 0.0);
#endif
}
