// Fragment shader that takes the depths of an image at the corners of cells (vpe/gl/target.h).
layout(binding = 9) uniform sampler2D depths;
layout(location = 0) uniform ivec2 size;   // of the image, pixels
layout(location = 1) uniform ivec2 cells;
layout(location = 0) out float depth;

void main() {
  ivec2 corner = ivec2(gl_FragCoord.xy);  // from the top
  ivec2 pixel = min(size * corner / cells, size - 1);
  depth = texelFetch(depths, ivec2(pixel.x, size.y - 1 - pixel.y), 0).r;
}
