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
layout(triangle_strip, max_vertices = 6) out;
layout(location = LOCATION_STEPS) uniform vec2 steps;
void interpolate(int from, int to, float share);

const float kSliver_steps = 1.5;

// A corner of what is drawn, on the edge between two corners of the triangle.
struct Corner {
  vec4 p;
  int from;
  int to;
  float share;
};

float near() { return gl_in[0].gl_Position.z; }

vec4 on_grid(vec4 p) {
  if (max(abs(p.x), abs(p.y)) < 4.0 * p.w) p.xy = round(p.xy / p.w * steps) / steps * p.w;
  return p;
}

Corner whole(int k) { return Corner(on_grid(gl_in[k].gl_Position), k, k, 0.0); }

Corner cut(int front, int behind) {
  vec4 p = gl_in[front].gl_Position;
  vec4 q = gl_in[behind].gl_Position;
  float share = (near() - q.w) / (p.w - q.w);
  return Corner(on_grid(vec4(mix(q.xy, p.xy, share), near(), near())), behind, front, share);
}

void draw(Corner corner[3]) {
  vec2 at[3];
  for (int k = 0; k < 3; ++k) at[k] = corner[k].p.xy / corner[k].p.w * steps;
  vec3 opposite = vec3(distance(at[1], at[2]), distance(at[2], at[0]), distance(at[0], at[1]));
  float longest = max(max(opposite.x, opposite.y), opposite.z);
  int k = opposite.x == longest ? 0 : opposite.y == longest ? 1 : 2;
  int a = (k + 1) % 3;
  int b = (k + 2) % 3;
  vec2 base = at[b] - at[a];
  vec2 side = at[k] - at[a];
  if (longest > 0.0 && abs(base.x * side.y - base.y * side.x) < kSliver_steps * longest) {
    float share = clamp(dot(base, side) / (longest * longest), 0.0, 1.0);
    corner[k].p.z = near() * corner[k].p.w * mix(1.0 / corner[a].p.w, 1.0 / corner[b].p.w, share);
  }
  for (int n = 0; n < 3; ++n) {
    gl_Position = corner[n].p;
    interpolate(corner[n].from, corner[n].to, corner[n].share);
    EmitVertex();
  }
  EndPrimitive();
}

void main() {
  bvec3 in_front =
      greaterThan(vec3(gl_in[0].gl_Position.w, gl_in[1].gl_Position.w, gl_in[2].gl_Position.w), vec3(near()));
  int count = int(in_front.x) + int(in_front.y) + int(in_front.z);
  if (count == 0) return;
  if (count == 3) {
    draw(Corner[3](whole(0), whole(1), whole(2)));
    return;
  }
  int k = 0;  // the corner that is alone on its side
  while (in_front[k] != (count == 1)) ++k;
  int a = (k + 1) % 3;
  int b = (k + 2) % 3;
  if (count == 1) {
    draw(Corner[3](whole(k), cut(k, a), cut(k, b)));
  } else {
    Corner first = whole(a);
    Corner last = cut(b, k);
    draw(Corner[3](first, whole(b), last));
    draw(Corner[3](first, last, cut(a, k)));
  }
}
