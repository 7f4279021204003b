// Fragment shader where a pixel of the image covers at least one of the view.
#version 450 core
layout(location = 0) uniform vec4 place[4];  // of each level: scale and offset from `at` to texture coordinates
layout(binding = 0) uniform sampler2D finest;
layout(location = 0) in vec2 at;
layout(location = 0) out vec4 colour;

void main() { colour = textureLod(finest, at * place[0].xy + place[0].zw, 0.0); }
