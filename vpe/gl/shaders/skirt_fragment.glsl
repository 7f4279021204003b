// Fragment shader of skirts. Pixels are covered up to a grid step outside of a skirt, where its extrapolated
// depth can be in front of the ground it hangs from. The depth of the nearest part of the skirt replaces it.
layout(location = 1) in float drop;
layout(location = 2) flat in vec2 depths;

void main() {
  vec2 steps = vec2(dFdx(drop), dFdy(drop));
  vec2 slope = vec2(dFdx(gl_FragCoord.z), dFdy(gl_FragCoord.z));
  float back = clamp(drop, 0.0, 1.0) - drop;
  float depth = gl_FragCoord.z + (back == 0.0 ? 0.0 : back * dot(slope, steps) / dot(steps, steps));
  gl_FragDepth = clamp(depth, depths.x, depths.y);
  colour_ground();
}
