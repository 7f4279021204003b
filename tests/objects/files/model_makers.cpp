#include "tests/objects/files/model_makers.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <sstream>

#include "vpe/base/file.h"
#include "vpe/core/image/image.h"

namespace objects::test_support {

namespace {

// Corner n has x from bit 0, y from bit 1, z from bit 2.
constexpr std::array<std::array<std::uint16_t, 3>, 12> kFaces = {{{0, 2, 1},
                                                                  {1, 2, 3},
                                                                  {4, 5, 6},
                                                                  {5, 7, 6},
                                                                  {0, 1, 4},
                                                                  {1, 5, 4},
                                                                  {2, 6, 3},
                                                                  {3, 6, 7},
                                                                  {0, 4, 2},
                                                                  {2, 4, 6},
                                                                  {1, 3, 5},
                                                                  {3, 7, 5}}};

glm::vec3 corner(unsigned n) {
  return kBox *
         glm::vec3(static_cast<float>(n & 1), static_cast<float>((n >> 1) & 1), static_cast<float>(n >> 2));
}

template <class T>
void put(std::string& bytes, const T& value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof(T));
}

}  // namespace

void write_text(const std::filesystem::path& path, std::string_view text) { vpe::base::write_file(path, text); }

std::string box_obj(bool with_materials) {
  std::ostringstream out;
  if (with_materials) out << "mtllib box.mtl\nusemtl body\n";
  for (unsigned n = 0; n < 8; ++n)
    out << "v " << corner(n).x << " " << corner(n).y << " " << corner(n).z << "\n";
  if (with_materials) out << "vt 0 0\nvt 1 0\nvt 0 1\n";
  for (const auto& f : kFaces) {
    out << "f";
    for (std::size_t n = 0; n < 3; ++n)
      out << " " << f[n] + 1 << (with_materials ? "/" + std::to_string(n + 1) : std::string());
    out << "\n";
  }
  return out.str();
}

std::string box_ply(bool is_binary) {
  std::ostringstream head;
  head << "ply\nformat " << (is_binary ? "binary_little_endian" : "ascii")
       << " 1.0\nelement vertex 8\nproperty float x\nproperty float y\nproperty float z\n"
       << "property uchar red\nproperty uchar green\nproperty uchar blue\n"
       << "element face 12\nproperty list uchar int vertex_indices\nend_header\n";
  std::string bytes = head.str();
  for (unsigned n = 0; n < 8; ++n) {
    const std::array<int, 3> colour = {static_cast<int>(10 * n), 200, 255};
    if (is_binary) {
      put(bytes, corner(n));
      for (const int c : colour) put(bytes, static_cast<std::uint8_t>(c));
      continue;
    }
    std::ostringstream line;
    line << corner(n).x << " " << corner(n).y << " " << corner(n).z;
    for (const int c : colour) line << " " << c;
    bytes += line.str() + "\n";
  }
  for (const auto& f : kFaces) {
    if (is_binary) {
      put(bytes, std::uint8_t{3});
      for (const std::uint16_t n : f) put(bytes, std::int32_t{n});
    } else {
      bytes += "3 " + std::to_string(f[0]) + " " + std::to_string(f[1]) + " " + std::to_string(f[2]) + "\n";
    }
  }
  return bytes;
}

std::string box_stl(bool is_binary) {
  std::string bytes = is_binary ? std::string(80, ' ') : "solid box\n";
  if (is_binary) put(bytes, std::uint32_t{kFaces.size()});
  for (const auto& f : kFaces) {
    const glm::vec3 normal(0, 0, 0);
    if (is_binary) {
      put(bytes, normal);
      for (const std::uint16_t n : f) put(bytes, corner(n));
      put(bytes, std::uint16_t{0});
      continue;
    }
    std::ostringstream out;
    out << "facet normal 0 0 0\nouter loop\n";
    for (const std::uint16_t n : f)
      out << "vertex " << corner(n).x << " " << corner(n).y << " " << corner(n).z << "\n";
    out << "endloop\nendfacet\n";
    bytes += out.str();
  }
  return is_binary ? bytes : bytes + "endsolid box\n";
}

Json box_gltf() {
  std::string bytes;
  for (unsigned n = 0; n < 8; ++n) put(bytes, corner(n));
  for (const auto& f : kFaces)
    for (const std::uint16_t n : f) put(bytes, n);
  return {
      {"asset", {{"version", "2.0"}}},
      {"scene", 0},
      {"scenes", {{{"nodes", {0}}}}},
      {"nodes", {{{"mesh", 0}}}},
      {"meshes", {{{"primitives", {{{"attributes", {{"POSITION", 0}}}, {"indices", 1}}}}}}},
      {"accessors",
       {{{"bufferView", 0}, {"componentType", 5126}, {"count", 8}, {"type", "VEC3"}},
        {{"bufferView", 1}, {"componentType", 5123}, {"count", 36}, {"type", "SCALAR"}}}},
      {"bufferViews",
       {{{"buffer", 0}, {"byteOffset", 0}, {"byteLength", 96}},
        {{"buffer", 0}, {"byteOffset", 96}, {"byteLength", 72}}}},
      {"buffers",
       {{{"byteLength", bytes.size()}, {"uri", "data:application/octet-stream;base64," + base64(bytes)}}}},
  };
}

std::string glb_of(Json document) {
  std::string body;
  for (unsigned n = 0; n < 8; ++n) put(body, corner(n));
  for (const auto& f : kFaces)
    for (const std::uint16_t n : f) put(body, n);
  document["buffers"][0].erase("uri");
  std::string json = document.dump();
  json.resize((json.size() + 3) / 4 * 4, ' ');
  std::string bytes = "glTF";
  put(bytes, std::uint32_t{2});
  put(bytes, static_cast<std::uint32_t>(28 + json.size() + body.size()));
  put(bytes, static_cast<std::uint32_t>(json.size()));
  bytes += "JSON" + json;
  put(bytes, static_cast<std::uint32_t>(body.size()));
  bytes += std::string("BIN\0", 4) + body;
  return bytes;
}

Json square_gltf(const std::string& image) {
  const std::array<float, 20> numbers = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 0, 1, 1, 1, 1, 0, 0, 0};
  const std::array<std::uint16_t, 6> indices = {0, 1, 2, 0, 2, 3};
  std::string bytes;
  put(bytes, numbers);
  put(bytes, indices);
  Json document = box_gltf();
  document["accessors"] = {{{"bufferView", 0}, {"componentType", 5126}, {"count", 4}, {"type", "VEC3"}},
                           {{"bufferView", 1}, {"componentType", 5126}, {"count", 4}, {"type", "VEC2"}},
                           {{"bufferView", 2}, {"componentType", 5123}, {"count", 6}, {"type", "SCALAR"}}};
  document["bufferViews"] = {{{"buffer", 0}, {"byteOffset", 0}, {"byteLength", 48}},
                             {{"buffer", 0}, {"byteOffset", 48}, {"byteLength", 32}},
                             {{"buffer", 0}, {"byteOffset", 80}, {"byteLength", 12}}};
  document["buffers"][0] = {{"byteLength", bytes.size()},
                            {"uri", "data:application/octet-stream;base64," + base64(bytes)}};
  document["meshes"][0]["primitives"][0] = {
      {"attributes", {{"POSITION", 0}, {"TEXCOORD_0", 1}}}, {"indices", 2}, {"material", 0}};
  document["images"] = {{{"uri", image}}};
  document["textures"] = {{{"source", 0}}};
  document["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
  return document;
}

std::vector<std::uint8_t> four_colours_png() {
  const std::array<Rgba, 4> pixels = {
      Rgba{255, 0, 0, 255}, {0, 255, 0, 255}, {0, 0, 255, 255}, {255, 255, 255, 128}};
  return vpe::core::encode_png(pixels, 2, 2);
}

std::vector<std::uint8_t> png_that_claims(std::uint32_t width, std::uint32_t height) {
  std::vector<std::uint8_t> bytes = four_colours_png();
  const auto put_big = [&](std::size_t at, std::uint32_t value) {
    for (std::size_t n = 0; n < 4; ++n) bytes[at + n] = static_cast<std::uint8_t>(value >> (24 - 8 * n));
  };
  put_big(16, width);
  put_big(20, height);
  put_big(29, static_cast<std::uint32_t>(::crc32(0, bytes.data() + 12, 17)));
  return bytes;
}

std::string base64(std::string_view bytes) {
  constexpr std::string_view kLetters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t n = 0; n < bytes.size(); n += 3) {
    std::uint32_t word = 0;
    for (std::size_t k = 0; k < 3; ++k)
      word = word << 8 | (n + k < bytes.size() ? static_cast<std::uint8_t>(bytes[n + k]) : 0U);
    for (std::size_t k = 0; k < 4; ++k)
      text += n + k > bytes.size() ? '=' : kLetters[(word >> (18 - 6 * k)) & 63];
  }
  return text;
}

double volume_m3(const Mesh& mesh) {
  double sum = 0;
  for (const glm::uvec3& t : mesh.triangles)
    sum += glm::dot(glm::dvec3(mesh.positions_m[t.x]),
                    glm::cross(glm::dvec3(mesh.positions_m[t.y]), glm::dvec3(mesh.positions_m[t.z])));
  return sum / 6;
}

Bounds bounds_of(const Mesh& mesh) {
  Bounds bounds{mesh.positions_m.at(0), mesh.positions_m.at(0)};
  for (const glm::vec3& p : mesh.positions_m) bounds = {glm::min(bounds.low, p), glm::max(bounds.high, p)};
  return bounds;
}

std::size_t vertex_at(const Mesh& mesh, const glm::vec3& place) {
  const auto nearest = std::min_element(mesh.positions_m.begin(), mesh.positions_m.end(),
                                        [&](const glm::vec3& a, const glm::vec3& b) {
                                          return glm::distance(a, place) < glm::distance(b, place);
                                        });
  return static_cast<std::size_t>(nearest - mesh.positions_m.begin());
}

}  // namespace objects::test_support
