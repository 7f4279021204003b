#include "vpe/gl/residency.h"

#include <array>

namespace vpe::gl {

namespace {

// Bytes that Mesa without a GPU (22.3) takes for the objects themselves, measured by residency_test: the two
// buffers of a mesh, a texture. Small tiles take as much for these as for their triangles.
constexpr std::size_t kMeshObjectBytes = 1600;
constexpr std::size_t kBufferBytes = 600;
constexpr std::size_t kTextureObjectBytes = 2400;

// Mesa keeps textures in rows of a multiple of these bytes, and in blocks of these rows.
constexpr std::size_t kRowBytes = 64;
constexpr std::size_t kBlockHeight = 4;

std::size_t round_up(std::size_t n, std::size_t step) { return (n + step - 1) / step * step; }

}  // namespace

GpuMesh upload(const TileGeometry& geometry) {
  GpuMesh mesh;
  mesh.positions = Buffer::make();
  mesh.indices = Buffer::make();
  mesh.short_indices = geometry.positions_m.size() <= 65536;
  const auto store = [](const Buffer& buffer, const auto& values) {
    const std::size_t bytes = values.size() * sizeof(values[0]);
    glNamedBufferStorage(buffer.name(), static_cast<GLsizeiptr>(bytes), values.data(), 0);
    return bytes;
  };
  std::size_t vertex_bytes = store(mesh.positions, geometry.positions_m);
  if (!geometry.charts.empty()) {
    mesh.charts = Buffer::make();
    vertex_bytes += store(mesh.charts, geometry.charts) + kBufferBytes;
  }
  if (!geometry.normals.empty()) {
    mesh.normals = Buffer::make();
    vertex_bytes += store(mesh.normals, geometry.normals) + kBufferBytes;
  }
  const std::size_t index_bytes =
      mesh.short_indices
          ? store(mesh.indices, std::vector<std::uint16_t>(geometry.indices.begin(), geometry.indices.end()))
          : store(mesh.indices, geometry.indices);
  check_gl("upload a mesh");
  mesh.centre_m = geometry.centre_m;
  mesh.first_foot = geometry.surface_vertices;
  mesh.ranges = geometry.ranges;
  mesh.frame = geometry.frame;
  mesh.pieces = geometry.pieces;
  mesh.quantisation_m = geometry.quantisation_m;
  mesh.longest_edge_m = geometry.longest_edge_m;
  mesh.bytes = vertex_bytes + index_bytes + kMeshObjectBytes + mesh.pieces.size() * sizeof(MeshPiece);
  return mesh;
}

GpuTexture upload(const ShadedTile& tile) {
  GpuTexture out;
  out.texture = Texture2D::make();
  out.intervals = tile.intervals;
  out.light = tile.channels == 1;
  out.brightest = tile.brightest;
  out.nodata = tile.nodata;
  out.nodata_image = tile.nodata_image;
  const bool facets = tile.intervals == 0;
  const auto count = static_cast<GLsizei>(tile.texels.size() / static_cast<std::size_t>(tile.channels));
  const GLsizei width = facets ? kFacetRow : tile.intervals + 1;
  const GLsizei height = facets ? (count + kFacetRow - 1) / kFacetRow : tile.intervals + 1;
  const GLenum format = out.light ? GL_RED : GL_RGBA;
  const GLuint name = out.texture.name();
  glTextureStorage2D(name, 1, out.light ? GL_R8 : GL_RGBA8, width, height);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  const GLsizei whole = facets ? count / kFacetRow : height;
  if (whole > 0) glTextureSubImage2D(name, 0, 0, 0, width, whole, format, GL_UNSIGNED_BYTE, tile.texels.data());
  if (whole < height) {
    glTextureSubImage2D(name, 0, 0, whole, count - whole * width, 1, format, GL_UNSIGNED_BYTE,
                        &tile.texels[4 * static_cast<std::size_t>(whole * width)]);
  }
  if (out.light) {
    constexpr std::array<GLint, 4> kGrey{GL_RED, GL_RED, GL_RED, GL_ONE};
    glTextureParameteriv(name, GL_TEXTURE_SWIZZLE_RGBA, kGrey.data());
  }
  const GLint filter = facets ? GL_NEAREST : GL_LINEAR;
  glTextureParameteri(name, GL_TEXTURE_MIN_FILTER, filter);
  glTextureParameteri(name, GL_TEXTURE_MAG_FILTER, filter);
  glTextureParameteri(name, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTextureParameteri(name, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  check_gl("upload a texture");
  out.bytes = round_up(static_cast<std::size_t>(tile.channels * width), kRowBytes) *
                  round_up(static_cast<std::size_t>(height), kBlockHeight) +
              kTextureObjectBytes;
  return out;
}

}  // namespace vpe::gl
