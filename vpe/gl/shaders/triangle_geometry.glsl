// Geometry shader of surfaces: puts the corners of a triangle on the rasteriser's grid unless a part of it is
// behind the near plane. (The vertex shader does so where it can, but does not know a vertex's triangles.)
//
// A sliver thinner than a step or two has no trustworthy depth across: a rasteriser may cover pixels beside it,
// where its plane is anywhere. The corner opposite to its longest edge takes the depth of that edge beside it,
// which moves the sliver by its height in the image, and leaves no slope of depth across.
layout(triangles) in;
layout(triangle_strip, max_vertices = 3) out;
layout(location = LOCATION_STEPS) uniform vec2 steps;
void interpolate(int from, int to, float share);

const float kSliver_steps = 1.5;

void main() {
  float near = gl_in[0].gl_Position.z;
  bool whole = min(min(gl_in[0].gl_Position.w, gl_in[1].gl_Position.w), gl_in[2].gl_Position.w) > near;
  vec4 corner[3];
  vec2 at[3];
  for (int k = 0; k < 3; ++k) {
    vec4 p = gl_in[k].gl_Position;
    if (whole && max(abs(p.x), abs(p.y)) < 4.0 * p.w) p.xy = round(p.xy / p.w * steps) / steps * p.w;
    corner[k] = p;
    at[k] = p.xy / p.w * steps;
  }
  if (whole) {
    vec3 opposite = vec3(distance(at[1], at[2]), distance(at[2], at[0]), distance(at[0], at[1]));
    float longest = max(max(opposite.x, opposite.y), opposite.z);
    int k = opposite.x == longest ? 0 : opposite.y == longest ? 1 : 2;
    int a = (k + 1) % 3;
    int b = (k + 2) % 3;
    vec2 base = at[b] - at[a];
    vec2 side = at[k] - at[a];
    if (longest > 0.0 && abs(base.x * side.y - base.y * side.x) < kSliver_steps * longest) {
      float share = clamp(dot(base, side) / (longest * longest), 0.0, 1.0);
      corner[k].z = near * corner[k].w * mix(1.0 / corner[a].w, 1.0 / corner[b].w, share);
    }
  }
  for (int k = 0; k < 3; ++k) {
    gl_Position = corner[k];
    interpolate(k, k, 0.0);
    EmitVertex();
  }
  EndPrimitive();
}
