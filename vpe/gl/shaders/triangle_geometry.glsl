// Geometry shader of surfaces: cuts off the part of a triangle behind the near plane and puts the corners on the
// rasteriser's grid. (The vertex shader does so where it can, but does not know a vertex's triangles.)
//
// Two triangles that share an edge must put its ends on the same points of the grid, or a pixel between them stays
// empty. So the fixed stages must not clip one of them: they put its corners on the grid from places that were not
// rounded before. A cut edge is computed from the end behind to the one in front, in both of its triangles as in ribbons.
//
// A sliver thinner than a step or two has no trustworthy depth across: a rasteriser may cover pixels beside it,
// where its plane is anywhere. The corner opposite to its longest edge takes the depth of that edge beside it,
// which moves the sliver by its height in the image, and leaves no slope of depth across.
layout(triangles) in;
layout(triangle_strip, max_vertices = 4) out;
layout(location = LOCATION_STEPS) uniform vec2 steps;
void interpolate(int from, int to, float share);

const float kSliver_steps = 1.5;
#ifdef THIN
// Thinner triangles are told apart: less is certain of what they show (TileDrawer::surface_snap_px()).
const float kThin_steps = 3.0;
layout(location = 6) flat out float thin;

// Returns how thick the triangle of three points is, steps.
float thickness(vec2 a, vec2 b, vec2 c) {
  float longest = max(max(distance(a, b), distance(b, c)), distance(c, a));
  return longest > 0.0 ? abs((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x)) / longest : 0.0;
}
#endif

vec4 on_grid(vec4 p) {
  if (max(abs(p.x), abs(p.y)) < 4.0 * p.w) p.xy = round(p.xy / p.w * steps) / steps * p.w;
  return p;
}

// Stages of this kind execute all branches for all triangles on a CPU, so cut and whole ones share one way: each corner lies
// on the edge from `behind` to `front`, which are one corner of the triangle where nothing is cut.
void main() {
  float near = gl_in[0].gl_Position.z;
  bvec3 in_front =
      greaterThan(vec3(gl_in[0].gl_Position.w, gl_in[1].gl_Position.w, gl_in[2].gl_Position.w), vec3(near));
  int count = int(in_front.x) + int(in_front.y) + int(in_front.z);
  if (count == 0) return;
  // The corner that is alone on its side, and those after it.
  bool lone = count == 1;
  int k = in_front.x == lone ? 0 : in_front.y == lone ? 1 : 2;
  if (count == 3) k = 0;
  int a = k == 2 ? 0 : k + 1;
  int b = a == 2 ? 0 : a + 1;
  ivec4 front = count == 3 ? ivec4(0, 1, 2, 2) : lone ? ivec4(k) : ivec4(a, b, a, b);
  ivec4 behind = count == 3 ? ivec4(0, 1, 2, 2) : lone ? ivec4(k, a, b, b) : ivec4(a, b, k, k);
  int corners = count == 2 ? 4 : 3;
  vec4 corner[4];
  vec4 share = vec4(0.0);
  vec2 at[4];
  for (int n = 0; n < 4; ++n) {
    vec4 p = gl_in[front[n]].gl_Position;
    vec4 q = gl_in[behind[n]].gl_Position;
    if (front[n] != behind[n]) {
      share[n] = (near - q.w) / (p.w - q.w);
      p = vec4(mix(q.xy, p.xy, share[n]), near, near);
    }
    corner[n] = on_grid(p);
    at[n] = corner[n].xy / corner[n].w * steps;
  }
  vec3 opposite = vec3(distance(at[1], at[2]), distance(at[2], at[0]), distance(at[0], at[1]));
  float longest = max(max(opposite.x, opposite.y), opposite.z);
  int apex = opposite.x == longest ? 0 : opposite.y == longest ? 1 : 2;
  int left = apex == 2 ? 0 : apex + 1;
  int right = left == 2 ? 0 : left + 1;
  vec2 base = at[right] - at[left];
  vec2 side = at[apex] - at[left];
  if (longest > 0.0 && abs(base.x * side.y - base.y * side.x) < kSliver_steps * longest) {
    float along = clamp(dot(base, side) / (longest * longest), 0.0, 1.0);
    corner[apex].z = near * corner[apex].w * mix(1.0 / corner[left].w, 1.0 / corner[right].w, along);
  }
#ifdef THIN
  float least = thickness(at[0], at[1], at[2]);
  if (corners == 4) least = min(least, thickness(at[1], at[2], at[3]));
#endif
  for (int n = 0; n < corners; ++n) {
    gl_Position = corner[n];
#ifdef THIN
    thin = least < kThin_steps ? 1.0 : 0.0;
#endif
    interpolate(behind[n], front[n], share[n]);
    EmitVertex();
  }
  EndPrimitive();
}
