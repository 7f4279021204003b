// Addresses of tiles in the quadtree: six faces, level 0 has one tile for each face, children are 2 x 2.
//
// Typical usage:
//   const TileKey key = tile_at(mars::chart_point(direction), 12);
//   const std::int64_t id = pack(key);  // the primary key in planet files
//   const TileKey up = parent(key);
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

inline constexpr int kMaxLevel = 26;  // limit of 63-bit keys; tiles of 128 posts 0.1 mm apart on Mars

// Column i runs along the face's right axis, row j along its up axis; 0 <= i, j < 2^level.
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

// Returns true if the quadtree has a tile of this key.
bool is_valid(const TileKey& key);

// Returns the position of the tile's first corner in Morton order over all faces: face (3 bits) | Morton code
// of (i, j), j above i, shifted to the top of 54 bits. The tiles of a subtree have the positions
// [morton_position(key), morton_position(key) + morton_extent(key.level)). For disjoint tiles the order is
// total.
std::int64_t morton_position(const TileKey& key);
std::int64_t morton_extent(int level);

// Returns face (3 bits) | level (5 bits) | Morton code of (i, j), shifted to the top of 54 bits so that the
// ascending keys of one face and level are in Morton order. The result is a positive 63-bit number.
std::int64_t pack(const TileKey& key);

// Returns the exact inverse of pack(), or nullopt for a number that no tile has.
std::optional<TileKey> unpack(std::int64_t packed);

TileKey parent(const TileKey& key);                         // key.level > 0
TileKey child(const TileKey& key, int index);               // index = column + 2 row, 0..3
TileKey ancestor(const TileKey& key, int level);            // 0 <= level <= key.level
bool contains(const TileKey& outer, const TileKey& inner);  // true if outer is inner or an ancestor of it

// The tile of the same level across an edge.
struct Neighbour {
  TileKey key;
  Edge edge;  // the edge of `key` that is shared
  // True if positions along the edge (west/east edges run along j, south/north along i) run in opposite
  // directions.
  bool reversed = false;
};

// Returns the neighbour across an edge, also over the edges of the cube. Uses integers only. Applied twice it
// returns to the first tile, with the same `reversed`.
Neighbour neighbour(const TileKey& key, Edge edge);

// Returns the tile of a level that contains a chart point. Right and upper borders belong to the next tile, at
// the face's far border to the last; points outside [-1, 1] are clamped. Exact: agrees with chart_rect().
TileKey tile_at(const mars::ChartPoint& point, int level);

// Returns the chart rectangle of a tile, exactly.
mars::ChartRect chart_rect(const TileKey& key);

// Returns a cap around a tile: unit centre direction and the angle to its farthest corner, rounded up by 1e-15
// rad. On a sphere of any radius the arc of this angle is at most kCapPerSide nominal sides.
inline constexpr double kCapPerSide = 0.83;
mars::Cap bounding_cap(const TileKey& key);

// Returns the tile's nominal side: the length of a quarter great circle / 2^level.
double nominal_side_m(int level, double radius_m);

// Returns "face/level/i/j", for example "+x/4/3/12".
std::string to_string(const TileKey& key);

struct TileKeyHash {
  std::size_t operator()(const TileKey& key) const {
    const auto x = static_cast<std::uint64_t>(pack(key)) * 0x9e3779b97f4a7c15ULL;
    return static_cast<std::size_t>(x ^ (x >> 29));
  }
};

}  // namespace lod
