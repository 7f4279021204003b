// Outputs of the geometry shaders: the values of one corner, or between those of two. Must follow the shader,
// which declares the input primitive.
#ifdef CHART
layout(location = 0) in vec3 corner_texture_position[];
layout(location = 0) out vec3 texture_position;
#endif
#ifdef PALETTE
layout(location = 3) in float corner_height[];
layout(location = 3) out float height;
#endif
#ifdef HAZE
layout(location = 4) in vec4 corner_camera_position[];
layout(location = 4) out vec4 camera_position;
#endif
#ifdef LIGHT
layout(location = 5) in float corner_light[];
layout(location = 5) out float light;
#endif
#ifdef FACETS
layout(location = LOCATION_FIRST_FACET) uniform int first_facet;
#endif

void interpolate(int from, int to, float share) {
#ifdef CHART
  texture_position = mix(corner_texture_position[from], corner_texture_position[to], share);
#endif
#ifdef PALETTE
  height = mix(corner_height[from], corner_height[to], share);
#endif
#ifdef HAZE
  camera_position = mix(corner_camera_position[from], corner_camera_position[to], share);
#endif
#ifdef LIGHT
  light = mix(corner_light[from], corner_light[to], share);
#endif
#ifdef FACETS
  gl_PrimitiveID = first_facet + gl_PrimitiveIDIn;
#endif
}
