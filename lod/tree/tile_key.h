// Quadtree addressing: six faces, level 0 = one tile a face, children 2 x 2.
#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "mars/geodesy/cube.h"
#include "mars/sources/source.h"

namespace lod {

inline constexpr int kMaxLevel = 26;  // 63-bit keys; 128-post tiles of 0.1 mm posts on Mars

// Tile column i runs along the face's right axis, row j along its up axis; 0 <= i, j < 2^level.
struct TileKey {
  mars::Face face = mars::Face::kPlusX;
  std::int32_t level = 0;
  std::int32_t i = 0;
  std::int32_t j = 0;

  auto operator<=>(const TileKey&) const = default;
};

// Edges in the order west, east, south, north of the face's own axes (right = east).
enum class Edge : std::uint8_t { kWest, kEast, kSouth, kNorth };
inline constexpr std::array<Edge, 4> kEdges{Edge::kWest, Edge::kEast, Edge::kSouth, Edge::kNorth};

bool is_valid(const TileKey& key);

// Position of the tile's first corner along the Z curve through all faces: face (3 bits) | Morton code of
// (i, j), j above i, shifted to the top of 54 bits. The tiles of a subtree are the positions
// [z_position(key), z_position(key) + z_extent(key.level)); of disjoint tiles the order is total.
std::int64_t z_position(const TileKey& key);
std::int64_t z_extent(int level);

// face (3 bits) | level (5 bits) | Morton code of (i, j), shifted to the top of 54 bits so that ascending
// keys of one face and level run in Morton order. Positive 63-bit number; unpack() is the exact inverse and
// returns nothing for a number that no tile has.
std::int64_t pack(const TileKey& key);
std::optional<TileKey> unpack(std::int64_t packed);

TileKey parent(const TileKey& key);                         // key.level > 0
TileKey child(const TileKey& key, int index);               // index = column + 2 row, 0..3
TileKey ancestor(const TileKey& key, int level);            // 0 <= level <= key.level
bool contains(const TileKey& outer, const TileKey& inner);  // outer is inner or an ancestor of it

// The tile of the same level across an edge, also over cube edges, and the edge of it that is shared. In
// integers; applied twice it leads back, with the same `reversed`.
// `reversed`: positions along the edge (west/east edges run along j, south/north along i) run the other way.
struct Neighbour {
  TileKey key;
  Edge edge;
  bool reversed = false;
};
Neighbour neighbour(const TileKey& key, Edge edge);

// Tile of a level that holds a chart point (right and upper borders belong to the next tile, at the face's
// far border to the last; points outside [-1, 1] are clamped). Exact: agrees with chart_rect().
TileKey tile_at(const mars::ChartPoint& point, int level);

// Chart rectangle of a tile, exact.
mars::ChartRect chart_rect(const TileKey& key);

// Cap around a tile: unit centre direction and the angle to its farthest corner, rounded up by 1e-15 rad. On a
// sphere of any radius the angle's arc is at most kCapPerSide nominal sides.
inline constexpr double kCapPerSide = 0.83;
mars::Cap bounding_cap(const TileKey& key);

// Length of a quarter great circle / 2^level: the tile's nominal side.
double nominal_side_m(int level, double radius_m);

// "face/level/i/j", e.g. "+x/4/3/12".
std::string to_string(const TileKey& key);

struct TileKeyHash {
  std::size_t operator()(const TileKey& key) const {
    const auto x = static_cast<std::uint64_t>(pack(key)) * 0x9e3779b97f4a7c15ULL;
    return static_cast<std::size_t>(x ^ (x >> 29));
  }
};

}  // namespace lod
