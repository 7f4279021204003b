// Vertex shader of a part of a panorama. Corners come in clip coordinates, computed in double.
#version 450 core
layout(location = 0) in vec3 corner;    // clip x, y, w
layout(location = 1) in vec2 position;  // pixels of the image from the part's upper left corner
layout(location = 0) out vec2 at;

void main() {
  gl_Position = vec4(corner.xy, 0.0, corner.z);
  at = position;
}
