// Geometry shader of skirts: a quad from two neighbouring vertices of a border and the feet below them. Parts
// that are thinner in the image than the ribbon along their border are left to the ribbon: slivers near the
// size of the rasteriser's grid have no trustworthy depth.
layout(lines_adjacency) in;
layout(triangle_strip, max_vertices = 4) out;
layout(location = LOCATION_RIBBON) uniform vec3 ribbon;
layout(location = 1) out float drop;
layout(location = 2) flat out vec2 depths;
void interpolate(int from, int to, float share);

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
    interpolate(k, k, 0.0);
    depths = all_depths;
    drop = k < 2 ? 0.0 : 1.0;
    EmitVertex();
  }
  EndPrimitive();
}
