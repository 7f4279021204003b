// Vertex shader of the sky: one triangle over the whole image, with the ray of each corner.
layout(location = LOCATION_TO_BODY) uniform mat3 to_body;
layout(location = LOCATION_PROJECTION) uniform vec4 projection;
layout(location = 0) out vec3 ray;

void main() {
  vec2 corner = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);
  gl_Position = vec4(corner, 0.0, 1.0);
  // On the plane e.z = -1: clip = projection.xy * e.xy - projection.zw.
  ray = to_body * vec3((corner + projection.zw) / projection.xy, -1.0);
}
