#include "vpe/app/scene/level_cache.h"

#include <xxhash.h>

#include <array>
#include <cstdio>
#include <cstring>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include "objects/files/mesh_stream.h"
#include "objects/model/mesh_levels.h"
#include "vpe/base/file.h"

namespace vpe::app {

namespace {

// Another number for levels that are made in another way.
constexpr std::array<char, 8> kLevelFileMark{'V', 'P', 'E', 'L', 'V', 'L', '0', '2'};
constexpr std::uintmax_t kMostLevelFileBytes = std::uintmax_t{4} << 30;
constexpr std::size_t kMostLevels = 32;

using Bytes = std::vector<std::uint8_t>;

Bytes stream_of(const objects::Mesh& mesh) {
  Bytes out;
  objects::write_mesh_stream({mesh, {}, {}, {}}, [&](std::span<const std::uint8_t> piece) {
    out.insert(out.end(), piece.begin(), piece.end());
  });
  return out;
}

std::string digest_name(const objects::Mesh& mesh) {
  XXH3_state_t* state = XXH3_createState();
  XXH3_128bits_reset(state);
  objects::write_mesh_stream({mesh, {}, {}, {}}, [&](std::span<const std::uint8_t> piece) {
    XXH3_128bits_update(state, piece.data(), piece.size());
  });
  const XXH128_hash_t hash = XXH3_128bits_digest(state);
  XXH3_freeState(state);
  char name[64];
  std::snprintf(name, sizeof name, "%016llx%016llx.levels", static_cast<unsigned long long>(hash.high64),
                static_cast<unsigned long long>(hash.low64));
  return name;
}

template <class T>
void put(Bytes& out, const T& value) {
  const auto* first = reinterpret_cast<const std::uint8_t*>(&value);
  out.insert(out.end(), first, first + sizeof(T));
}

template <class T>
T take(std::span<const std::uint8_t>& bytes) {
  if (bytes.size() < sizeof(T)) throw std::runtime_error("the file ends too soon");
  T value;
  std::memcpy(&value, bytes.data(), sizeof(T));
  bytes = bytes.subspan(sizeof(T));
  return value;
}

// Returns the coarse levels, or nullopt if there is no such file or it is damaged.
std::optional<std::vector<objects::Model::Level>> read_levels(const std::filesystem::path& file,
                                                              const objects::Mesh& finest) {
  try {
    const Bytes content = base::read_file(file, kMostLevelFileBytes);
    std::span<const std::uint8_t> bytes(content);
    if (take<std::array<char, 8>>(bytes) != kLevelFileMark) return std::nullopt;
    if (take<std::uint64_t>(bytes) != XXH3_64bits(bytes.data(), bytes.size())) return std::nullopt;
    const auto count = take<std::uint64_t>(bytes);
    if (count > kMostLevels) return std::nullopt;
    std::vector<objects::Model::Level> levels;
    for (std::uint64_t n = 0; n < count; ++n) {
      objects::Model::Level level;
      level.geometric_error_m = take<double>(bytes);
      const auto size = take<std::uint64_t>(bytes);
      if (size > bytes.size()) return std::nullopt;
      level.mesh = objects::read_mesh_stream(bytes.first(static_cast<std::size_t>(size))).mesh;
      bytes = bytes.subspan(static_cast<std::size_t>(size));
      if (level.mesh.material_table.size() != finest.material_table.size()) return std::nullopt;
      level.mesh.material_table = finest.material_table;
      level.tree = objects::TriangleTree(level.mesh);
      levels.push_back(std::move(level));
    }
    return levels;
  } catch (const std::runtime_error&) {
    return std::nullopt;
  }
}

void write_levels(const std::filesystem::path& file, const std::vector<objects::Model::Level>& levels) {
  Bytes body;
  put(body, static_cast<std::uint64_t>(levels.size() - 1));
  for (std::size_t n = 1; n < levels.size(); ++n) {
    objects::Mesh mesh = levels[n].mesh;
    // Textures are those of the finest level.
    for (objects::Material& m : mesh.material_table) m.texture = -1;
    const Bytes stream = stream_of(mesh);
    put(body, levels[n].geometric_error_m);
    put(body, static_cast<std::uint64_t>(stream.size()));
    body.insert(body.end(), stream.begin(), stream.end());
  }
  Bytes content;
  put(content, kLevelFileMark);
  put(content, static_cast<std::uint64_t>(XXH3_64bits(body.data(), body.size())));
  content.insert(content.end(), body.begin(), body.end());
  try {
    std::filesystem::create_directories(file.parent_path());
    base::write_file(file, content);
  } catch (const std::exception&) {
    // The next start makes them again.
  }
}

}  // namespace

std::vector<objects::Model::Level> cached_levels(objects::Mesh mesh, const std::filesystem::path& folder) {
  if (mesh.triangles.size() < kLeastCachedTriangles || folder.empty())
    return objects::make_levels(std::move(mesh));
  const std::filesystem::path file = folder / digest_name(mesh);
  if (auto coarse = read_levels(file, mesh)) {
    std::vector<objects::Model::Level> levels;
    objects::TriangleTree tree(mesh);
    levels.push_back({std::move(mesh), std::move(tree), 0});
    for (objects::Model::Level& level : *coarse) levels.push_back(std::move(level));
    return levels;
  }
  std::vector<objects::Model::Level> levels = objects::make_levels(std::move(mesh));
  write_levels(file, levels);
  return levels;
}

}  // namespace vpe::app
