#include "objects/files/level_stream.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <utility>

#include "objects/files/mesh_stream.h"

namespace objects {

namespace {

// Another number for levels that are made in another way: kept ones are then made anew.
constexpr std::array<char, 8> kLevelMark{'V', 'P', 'E', 'L', 'V', 'L', '0', '3'};

template <class T>
T take_value(std::span<const std::uint8_t>& bytes) {
  if (bytes.size() < sizeof(T)) throw std::runtime_error("the levels of the model end early");
  T value;
  std::memcpy(&value, bytes.data(), sizeof(T));
  bytes = bytes.subspan(sizeof(T));
  return value;
}

std::vector<std::uint8_t> coarse_bytes(Mesh mesh) {
  // Textures are those of the finest level.
  for (Material& m : mesh.material_table) m.texture = -1;
  std::vector<std::uint8_t> out;
  write_mesh_stream({std::move(mesh), {}, {}, {}}, [&](std::span<const std::uint8_t> piece) {
    out.insert(out.end(), piece.begin(), piece.end());
  });
  return out;
}

}  // namespace

void write_level_stream(std::span<const MeshLevel> levels,
                        const std::function<void(std::span<const std::uint8_t>)>& sink) {
  const auto put = [&](const auto& value) {
    sink({reinterpret_cast<const std::uint8_t*>(&value), sizeof(value)});
  };
  put(kLevelMark);
  put(std::uint64_t{levels.size() - 1});
  for (const MeshLevel& level : levels.subspan(1)) {
    const std::vector<std::uint8_t> mesh = coarse_bytes(level.mesh);
    put(level.geometric_error_m);
    put(std::uint64_t{mesh.size()});
    sink(mesh);
  }
}

std::vector<MeshLevel> read_level_stream(std::span<const std::uint8_t> bytes, Mesh&& finest) {
  if (take_value<std::array<char, 8>>(bytes) != kLevelMark)
    throw std::runtime_error("these are no levels of a model, or those of another version");
  const auto count = take_value<std::uint64_t>(bytes);
  if (count > kMostCoarseLevels) throw std::runtime_error("the model has too many levels");
  std::vector<MeshLevel> levels(1);
  for (std::uint64_t n = 0; n < count; ++n) {
    MeshLevel level;
    level.geometric_error_m = take_value<double>(bytes);
    if (!(level.geometric_error_m > levels.back().geometric_error_m &&
          level.geometric_error_m < std::numeric_limits<double>::infinity()))
      throw std::runtime_error("the errors of the model's levels do not ascend");
    const auto size = take_value<std::uint64_t>(bytes);
    if (size > bytes.size()) throw std::runtime_error("the levels of the model end early");
    MeshStream stream = read_mesh_stream(bytes.first(static_cast<std::size_t>(size)));
    bytes = bytes.subspan(static_cast<std::size_t>(size));
    if (!stream.error.empty() || stream.mesh.material_table.size() != finest.material_table.size() ||
        !stream.mesh.textures.empty())
      throw std::runtime_error("a level of the model has other materials than the model");
    level.mesh = std::move(stream.mesh);
    level.mesh.material_table = finest.material_table;
    level.tree = TriangleTree(level.mesh);
    levels.push_back(std::move(level));
  }
  if (!bytes.empty()) throw std::runtime_error("the levels of the model have bytes after their end");
  levels.front().tree = TriangleTree(finest);
  levels.front().mesh = std::move(finest);
  return levels;
}

}  // namespace objects
