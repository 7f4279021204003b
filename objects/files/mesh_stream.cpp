#include "objects/files/mesh_stream.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <stdexcept>
#include <type_traits>

namespace objects {

namespace {

constexpr std::array<std::uint8_t, 8> kMagic = {'v', 'p', 'e', 'm', 'e', 's', 'h', '\n'};
constexpr std::uint32_t kVersion = 1;

static_assert(sizeof(glm::vec3) == 12 && sizeof(glm::vec2) == 8 && sizeof(glm::uvec3) == 12 &&
              sizeof(Rgba) == 4);

// Without gaps, so that no byte of it is unset.
struct StoredMaterial {
  Rgba colour;
  std::int32_t texture = -1;
  std::uint8_t alpha = 0;
  std::uint8_t cutoff = 0;
  std::uint8_t double_sided = 0;
  std::uint8_t unused = 0;
};
static_assert(sizeof(StoredMaterial) == 12);

class Writer {
 public:
  explicit Writer(const std::function<void(std::span<const std::uint8_t>)>& sink) : sink_(sink) {}

  template <class T>
  void value(const T& x) {
    static_assert(std::is_trivially_copyable_v<T>);
    sink_({reinterpret_cast<const std::uint8_t*>(&x), sizeof(T)});
  }
  template <class T>
  void array(const std::vector<T>& values) {
    static_assert(std::is_trivially_copyable_v<T>);
    value(std::uint64_t{values.size()});
    if (!values.empty())
      sink_({reinterpret_cast<const std::uint8_t*>(values.data()), values.size() * sizeof(T)});
  }
  void text(const std::string& words) {
    const std::size_t size = std::min(words.size(), MeshStreamLimits::kLongestText_bytes);
    value(std::uint64_t{size});
    if (size > 0) sink_({reinterpret_cast<const std::uint8_t*>(words.data()), size});
  }

 private:
  const std::function<void(std::span<const std::uint8_t>)>& sink_;
};

class Reader {
 public:
  explicit Reader(std::span<const std::uint8_t> bytes) : rest_(bytes) {}

  template <class T>
  T value() {
    static_assert(std::is_trivially_copyable_v<T>);
    T x{};
    std::memcpy(&x, take(1, sizeof(T)).data(), sizeof(T));
    return x;
  }
  template <class T>
  std::vector<T> array(std::uint64_t most) {
    static_assert(std::is_trivially_copyable_v<T>);
    const auto count = value<std::uint64_t>();
    if (count > most) throw std::runtime_error("a list of the model's stream is too long");
    const std::span<const std::uint8_t> bytes = take(count, sizeof(T));
    std::vector<T> values(count);
    if (count > 0) std::memcpy(values.data(), bytes.data(), bytes.size());
    return values;
  }
  std::string text() {
    const std::vector<char> words = array<char>(MeshStreamLimits::kLongestText_bytes);
    return {words.begin(), words.end()};
  }
  bool at_end() const { return rest_.empty(); }

 private:
  std::span<const std::uint8_t> take(std::uint64_t count, std::size_t size) {
    if (count > rest_.size() / size) throw std::runtime_error("the model's stream ends early");
    const std::span<const std::uint8_t> bytes = rest_.first(count * size);
    rest_ = rest_.subspan(count * size);
    return bytes;
  }

  std::span<const std::uint8_t> rest_;
};

void write_mesh(const Mesh& mesh, Writer& out) {
  out.array(mesh.positions_m);
  out.array(mesh.normals);
  out.array(mesh.uvs);
  out.array(mesh.colours);
  out.array(mesh.triangles);
  out.array(mesh.materials);
  std::vector<StoredMaterial> table;
  for (const Material& m : mesh.material_table) {
    table.push_back({m.colour, m.texture, static_cast<std::uint8_t>(m.alpha), m.cutoff,
                     static_cast<std::uint8_t>(m.double_sided ? 1 : 0), 0});
  }
  out.array(table);
  out.value(std::uint64_t{mesh.textures.size()});
  for (const Texture& t : mesh.textures) {
    out.value(std::int32_t{t.width});
    out.value(std::int32_t{t.height});
    out.array(t.texels);
  }
}

Mesh read_mesh(Reader& in) {
  Mesh mesh;
  mesh.positions_m = in.array<glm::vec3>(MeshLimits::kMostVertices);
  mesh.normals = in.array<glm::vec3>(MeshLimits::kMostVertices);
  mesh.uvs = in.array<glm::vec2>(MeshLimits::kMostVertices);
  mesh.colours = in.array<Rgba>(MeshLimits::kMostVertices);
  mesh.triangles = in.array<glm::uvec3>(MeshLimits::kMostTriangles);
  mesh.materials = in.array<std::uint16_t>(MeshLimits::kMostTriangles);
  for (const StoredMaterial& m : in.array<StoredMaterial>(MeshLimits::kMostMaterials)) {
    if (m.alpha > static_cast<std::uint8_t>(AlphaMode::kBlend) || m.double_sided > 1)
      throw std::runtime_error("a material of the model's stream is damaged");
    mesh.material_table.push_back(
        {m.colour, m.texture, static_cast<AlphaMode>(m.alpha), m.cutoff, m.double_sided == 1});
  }
  const auto textures = in.value<std::uint64_t>();
  if (textures > MeshLimits::kMostTextures)
    throw std::runtime_error("the model's stream has too many textures");
  for (std::uint64_t n = 0; n < textures; ++n) {
    const auto width = in.value<std::int32_t>();
    const auto height = in.value<std::int32_t>();
    mesh.textures.push_back({width, height, in.array<Rgba>(MeshLimits::kMostTexels)});
  }
  return mesh;
}

}  // namespace

void write_mesh_stream(const MeshStream& stream,
                       const std::function<void(std::span<const std::uint8_t>)>& sink) {
  Writer out(sink);
  out.value(kMagic);
  out.value(kVersion);
  out.text(stream.error);
  out.text(stream.advice);
  const std::size_t notes = std::min(stream.notes.size(), MeshStreamLimits::kMostNotes);
  out.value(std::uint64_t{notes});
  for (std::size_t n = 0; n < notes; ++n) out.text(stream.notes[n]);
  if (stream.error.empty()) write_mesh(stream.mesh, out);
}

MeshStream read_mesh_stream(std::span<const std::uint8_t> bytes, bool allows_points) {
  Reader in(bytes);
  if (in.value<std::array<std::uint8_t, 8>>() != kMagic)
    throw std::runtime_error("what the reader of models sent is not a model's stream");
  if (in.value<std::uint32_t>() != kVersion)
    throw std::runtime_error("the reader of models has another version than this program");
  MeshStream stream;
  stream.error = in.text();
  stream.advice = in.text();
  const auto notes = in.value<std::uint64_t>();
  if (notes > MeshStreamLimits::kMostNotes) throw std::runtime_error("the model's stream has too many notes");
  for (std::uint64_t n = 0; n < notes; ++n) stream.notes.push_back(in.text());
  if (stream.error.empty()) stream.mesh = read_mesh(in);
  if (!in.at_end()) throw std::runtime_error("the model's stream has bytes after its end");
  if (stream.error.empty()) {
    const bool is_points = allows_points && stream.mesh.triangles.empty();
    if (const std::string reason = is_points ? check_points(stream.mesh) : check(stream.mesh); !reason.empty())
      throw std::runtime_error(reason);
  }
  return stream;
}

}  // namespace objects
