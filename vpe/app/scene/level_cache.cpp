#include "vpe/app/scene/level_cache.h"

#include <xxhash.h>

#include <cstdio>
#include <cstring>
#include <stdexcept>
#include <string>
#include <utility>

#include "objects/files/level_program.h"
#include "objects/files/level_stream.h"
#include "objects/files/mesh_stream.h"
#include "vpe/base/file.h"

namespace vpe::app {

namespace {

constexpr std::uintmax_t kMostLevelFileBytes = std::uintmax_t{4} << 30;

using Bytes = std::vector<std::uint8_t>;

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

// Returns what a file holds behind its checksum; empty if there is no such file or it is damaged.
Bytes read_kept(const std::filesystem::path& file) {
  try {
    Bytes content = base::read_file(file, kMostLevelFileBytes);
    std::uint64_t sum = 0;
    if (content.size() < sizeof sum) return {};
    std::memcpy(&sum, content.data(), sizeof sum);
    content.erase(content.begin(), content.begin() + sizeof sum);
    if (sum != XXH3_64bits(content.data(), content.size())) return {};
    return content;
  } catch (const std::runtime_error&) {
    return {};
  }
}

void keep_levels(const std::filesystem::path& file, const std::vector<objects::Model::Level>& levels) {
  Bytes content(sizeof(std::uint64_t));
  objects::write_level_stream(levels, [&](std::span<const std::uint8_t> piece) {
    content.insert(content.end(), piece.begin(), piece.end());
  });
  const std::uint64_t sum = XXH3_64bits(content.data() + sizeof sum, content.size() - sizeof sum);
  std::memcpy(content.data(), &sum, sizeof sum);
  try {
    std::filesystem::create_directories(file.parent_path());
    base::write_file(file, content);
  } catch (const std::exception&) {
    // The next start makes them again.
  }
}

KeptLevels made_levels(objects::Mesh&& mesh) {
  try {
    return {objects::make_levels_apart(std::move(mesh)), ""};
  } catch (const std::runtime_error& error) {
    KeptLevels finest;
    finest.note = std::string("it has one level of detail: ") + error.what();
    objects::TriangleTree tree(mesh);
    finest.levels.push_back({std::move(mesh), std::move(tree), 0});
    return finest;
  }
}

}  // namespace

KeptLevels cached_levels(objects::Mesh mesh, const std::filesystem::path& folder, std::size_t least_triangles) {
  if (mesh.triangles.size() < least_triangles || folder.empty()) return made_levels(std::move(mesh));
  const std::filesystem::path file = folder / digest_name(mesh);
  if (const Bytes kept = read_kept(file); !kept.empty()) {
    try {
      return {objects::read_level_stream(kept, std::move(mesh)), ""};
    } catch (const std::runtime_error&) {
      // They are of another version of this program.
    }
  }
  KeptLevels made = made_levels(std::move(mesh));
  if (made.note.empty()) keep_levels(file, made.levels);
  return made;
}

}  // namespace vpe::app
