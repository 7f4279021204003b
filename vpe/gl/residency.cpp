#include "vpe/gl/residency.h"

namespace vpe::gl {

namespace {

// What Mesa without a GPU (22.3) takes for the objects themselves, measured by residency_test: the two
// buffers of a mesh, a texture. Small tiles take as much for these as for their triangles.
constexpr std::size_t kMeshObjectBytes = 1600;
constexpr std::size_t kTextureObjectBytes = 2400;

// It keeps textures in blocks of this many texels.
constexpr std::size_t kBlockWidth = 16;
constexpr std::size_t kBlockHeight = 4;

std::size_t round_up(std::size_t n, std::size_t step) { return (n + step - 1) / step * step; }

}  // namespace

GpuMesh upload(const TileGeometry& geometry) {
  GpuMesh mesh;
  mesh.vertices = Buffer::make();
  mesh.indices = Buffer::make();
  mesh.short_indices = geometry.vertices.size() <= 65536;
  const std::size_t vertex_bytes = geometry.vertices.size() * sizeof(TileVertex);
  glNamedBufferStorage(mesh.vertices.name(), static_cast<GLsizeiptr>(vertex_bytes), geometry.vertices.data(),
                       0);
  std::size_t index_bytes = geometry.indices.size() * sizeof(std::uint32_t);
  if (mesh.short_indices) {
    const std::vector<std::uint16_t> narrow(geometry.indices.begin(), geometry.indices.end());
    index_bytes = narrow.size() * sizeof(std::uint16_t);
    glNamedBufferStorage(mesh.indices.name(), static_cast<GLsizeiptr>(index_bytes), narrow.data(), 0);
  } else {
    glNamedBufferStorage(mesh.indices.name(), static_cast<GLsizeiptr>(index_bytes), geometry.indices.data(), 0);
  }
  check_gl("upload a mesh");
  mesh.centre_m = geometry.centre_m;
  mesh.first_foot = geometry.surface_vertices;
  mesh.ranges = geometry.ranges;
  mesh.quantisation_m = geometry.quantisation_m;
  mesh.longest_edge_m = geometry.longest_edge_m;
  mesh.bytes = vertex_bytes + index_bytes + kMeshObjectBytes;
  return mesh;
}

GpuTexture upload(const ShadedTile& tile) {
  GpuTexture out;
  out.texture = Texture2D::make();
  out.intervals = tile.intervals;
  out.gaps = tile.gaps;
  const GLsizei side = tile.intervals + 1;
  const GLuint name = out.texture.name();
  glTextureStorage2D(name, 1, GL_RGBA8, side, side);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
  glTextureSubImage2D(name, 0, 0, 0, side, side, GL_RGBA, GL_UNSIGNED_BYTE, tile.rgba.data());
  glTextureParameteri(name, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTextureParameteri(name, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glTextureParameteri(name, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTextureParameteri(name, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  check_gl("upload a texture");
  const auto texels = static_cast<std::size_t>(side);
  out.bytes = 4 * round_up(texels, kBlockWidth) * round_up(texels, kBlockHeight) + kTextureObjectBytes;
  return out;
}

}  // namespace vpe::gl
