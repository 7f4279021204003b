// Geometry shader of ribbons: widens a line of a border to some hundredths of a pixel, at the line's own depth.
// The part behind the near plane is cut off first: corners of a ribbon to behind the camera would change sides.
layout(lines) in;
layout(triangle_strip, max_vertices = 4) out;
layout(location = LOCATION_RIBBON) uniform vec3 ribbon;
void interpolate(int from, int to, float share);

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
  // Ends are extended by half the width, so that ribbons that meet at an angle leave no notch.
  vec2 along = size > 0.0 ? line / size : vec2(1.0, 0.0);
  vec2 across = vec2(-along.y, along.x);
  vec2 wide = ribbon.z / ribbon.xy;
  for (int k = 0; k < 4; ++k) {
    int n = k / 2;
    vec4 p = end[n];
    float side = (k & 1) == 0 ? 1.0 : -1.0;
    float reach = k < 2 ? -1.0 : 1.0;
    gl_Position = vec4(p.xy + (side * across + reach * along) * wide * p.w, p.zw);
    interpolate(n, 1 - n, cut[n]);
    EmitVertex();
  }
  EndPrimitive();
}
