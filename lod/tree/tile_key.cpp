#include "lod/tree/tile_key.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "mars/geodesy/sphere.h"

namespace lod {

namespace {

constexpr int kMortonBits = 54;
constexpr int kLevelBits = 5;
constexpr std::int64_t kMortonMask = (std::int64_t{1} << kMortonBits) - 1;
static_assert(2 * kMaxLevel <= kMortonBits && kMaxLevel < (1 << kLevelBits));

// Moves bit n to bit 2n.
std::uint64_t spread(std::uint32_t x) {
  std::uint64_t v = x;
  v = (v | (v << 16)) & 0x0000ffff0000ffffULL;
  v = (v | (v << 8)) & 0x00ff00ff00ff00ffULL;
  v = (v | (v << 4)) & 0x0f0f0f0f0f0f0f0fULL;
  v = (v | (v << 2)) & 0x3333333333333333ULL;
  return (v | (v << 1)) & 0x5555555555555555ULL;
}

std::uint32_t gather(std::uint64_t v) {
  v &= 0x5555555555555555ULL;
  v = (v | (v >> 1)) & 0x3333333333333333ULL;
  v = (v | (v >> 2)) & 0x0f0f0f0f0f0f0f0fULL;
  v = (v | (v >> 4)) & 0x00ff00ff00ff00ffULL;
  v = (v | (v >> 8)) & 0x0000ffff0000ffffULL;
  return static_cast<std::uint32_t>(v | (v >> 16));
}

std::int64_t morton(const TileKey& key) {
  const std::uint64_t code =
      spread(static_cast<std::uint32_t>(key.i)) | (spread(static_cast<std::uint32_t>(key.j)) << 1);
  return static_cast<std::int64_t>(code << (kMortonBits - 2 * key.level));
}

std::int32_t tiles_per_side(int level) { return std::int32_t{1} << level; }

struct Vector {
  std::int64_t x, y, z;
};

Vector integer(const glm::dvec3& axis) {
  return {static_cast<std::int64_t>(axis.x), static_cast<std::int64_t>(axis.y),
          static_cast<std::int64_t>(axis.z)};
}

std::int64_t dot(const Vector& a, const Vector& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

struct IntegerAxes {
  Vector right, up, out;
};

IntegerAxes integer_axes(mars::Face face) {
  const mars::FaceAxes& axes = mars::face_axes(face);
  return {integer(axes.right), integer(axes.up), integer(axes.out)};
}

mars::Face face_towards(const Vector& out) {
  if (out.x != 0) return out.x > 0 ? mars::Face::kPlusX : mars::Face::kMinusX;
  if (out.y != 0) return out.y > 0 ? mars::Face::kPlusY : mars::Face::kMinusY;
  return out.z > 0 ? mars::Face::kPlusZ : mars::Face::kMinusZ;
}

bool runs_along_j(Edge edge) { return edge == Edge::kWest || edge == Edge::kEast; }

std::int32_t column_at(double u, int level) {
  const std::int32_t last = tiles_per_side(level) - 1;
  auto i = static_cast<std::int32_t>(mars::face_parameter(u) * static_cast<double>(tiles_per_side(level)));
  i = std::clamp(i, 0, last);
  // The parameter is exact on lines and monotonic, so between them it can only be rounded up to the next one.
  if (i > 0 && u < mars::face_line(i, level)) --i;
  return i;
}

}  // namespace

bool is_valid(const TileKey& key) {
  if (static_cast<int>(key.face) >= mars::kFaces || key.level < 0 || key.level > kMaxLevel) return false;
  const std::int32_t n = tiles_per_side(key.level);
  return key.i >= 0 && key.i < n && key.j >= 0 && key.j < n;
}

std::int64_t morton_position(const TileKey& key) {
  return (static_cast<std::int64_t>(key.face) << kMortonBits) | morton(key);
}

std::int64_t morton_extent(int level) { return std::int64_t{1} << (kMortonBits - 2 * level); }

std::int64_t pack(const TileKey& key) {
  const std::int64_t high = (static_cast<std::int64_t>(key.face) << kLevelBits) | key.level;
  return (high << kMortonBits) | morton(key);
}

std::optional<TileKey> unpack(std::int64_t packed) {
  const std::int64_t face = packed >> (kMortonBits + kLevelBits);
  const auto level = static_cast<std::int32_t>((packed >> kMortonBits) & ((1 << kLevelBits) - 1));
  if (packed < 0 || face >= mars::kFaces || level > kMaxLevel) return std::nullopt;
  const std::int64_t code = packed & kMortonMask;
  if (code % morton_extent(level) != 0) return std::nullopt;
  const auto bits = static_cast<std::uint64_t>(code / morton_extent(level));
  return TileKey{static_cast<mars::Face>(face), level, static_cast<std::int32_t>(gather(bits)),
                 static_cast<std::int32_t>(gather(bits >> 1))};
}

TileKey parent(const TileKey& key) { return {key.face, key.level - 1, key.i >> 1, key.j >> 1}; }

TileKey child(const TileKey& key, int index) {
  return {key.face, key.level + 1, 2 * key.i + (index & 1), 2 * key.j + (index >> 1)};
}

TileKey ancestor(const TileKey& key, int level) {
  const int shift = key.level - level;
  return {key.face, level, key.i >> shift, key.j >> shift};
}

bool contains(const TileKey& outer, const TileKey& inner) {
  return outer.level <= inner.level && ancestor(inner, outer.level) == outer;
}

Neighbour neighbour(const TileKey& key, Edge edge) {
  const std::int32_t n = tiles_per_side(key.level);
  TileKey next = key;
  switch (edge) {
    case Edge::kWest: --next.i; break;
    case Edge::kEast: ++next.i; break;
    case Edge::kSouth: --next.j; break;
    case Edge::kNorth: ++next.j; break;
  }
  if (next.i >= 0 && next.i < n && next.j >= 0 && next.j < n) {
    const auto opposite = static_cast<Edge>(static_cast<int>(edge) ^ 1);
    return {next, opposite, false};
  }

  // Crosses the cube's edge. Cell centres are in half cells on the cube [-n, n]^3. The coordinate that leaves
  // the face is clamped to the edge and becomes the new face's out axis; the old out coordinate moves half a
  // cell inwards.
  const IntegerAxes from = integer_axes(key.face);
  const std::int64_t a = std::clamp<std::int64_t>(2 * std::int64_t{next.i} + 1 - n, -n, n);
  const std::int64_t b = std::clamp<std::int64_t>(2 * std::int64_t{next.j} + 1 - n, -n, n);
  const std::int64_t c = n - 1;
  const Vector centre{from.right.x * a + from.up.x * b + from.out.x * c,
                      from.right.y * a + from.up.y * b + from.out.y * c,
                      from.right.z * a + from.up.z * b + from.out.z * c};
  const Vector& axis = runs_along_j(edge) ? from.right : from.up;
  const std::int64_t sign = edge == Edge::kEast || edge == Edge::kNorth ? 1 : -1;
  const mars::Face face = face_towards({axis.x * sign, axis.y * sign, axis.z * sign});
  const IntegerAxes to = integer_axes(face);

  Neighbour result;
  result.key = {face, key.level, static_cast<std::int32_t>((dot(to.right, centre) + n - 1) / 2),
                static_cast<std::int32_t>((dot(to.up, centre) + n - 1) / 2)};
  const std::int64_t towards_right = dot(to.right, from.out);
  const std::int64_t towards_up = dot(to.up, from.out);
  if (towards_right != 0) {
    result.edge = towards_right > 0 ? Edge::kEast : Edge::kWest;
  } else {
    result.edge = towards_up > 0 ? Edge::kNorth : Edge::kSouth;
  }
  const Vector& old_along = runs_along_j(edge) ? from.up : from.right;
  const Vector& new_along = runs_along_j(result.edge) ? to.up : to.right;
  result.reversed = dot(old_along, new_along) < 0;
  return result;
}

TileKey tile_at(const mars::ChartPoint& point, int level) {
  return {point.face, level, column_at(point.u, level), column_at(point.v, level)};
}

mars::ChartRect chart_rect(const TileKey& key) {
  return {key.face, mars::face_line(key.i, key.level), mars::face_line(key.i + 1, key.level),
          mars::face_line(key.j, key.level), mars::face_line(key.j + 1, key.level)};
}

mars::Cap bounding_cap(const TileKey& key) {
  const mars::ChartRect rect = chart_rect(key);
  const std::array<glm::dvec3, 4> corners{
      mars::chart_direction(rect.face, rect.u0, rect.v0), mars::chart_direction(rect.face, rect.u1, rect.v0),
      mars::chart_direction(rect.face, rect.u0, rect.v1), mars::chart_direction(rect.face, rect.u1, rect.v1)};
  mars::Cap cap;
  cap.centre = glm::normalize(corners[0] + corners[1] + corners[2] + corners[3]);
  for (const glm::dvec3& corner : corners) {
    cap.radius_rad = std::max(cap.radius_rad, mars::angle_between_rad(cap.centre, corner));
  }
  cap.radius_rad += 1e-15;
  return cap;
}

double nominal_side_m(int level, double radius_m) { return std::ldexp(radius_m * mars::kPi / 2.0, -level); }

std::string to_string(const TileKey& key) {
  constexpr std::array<const char*, mars::kFaces> kNames{"+x", "+y", "-x", "-y", "+z", "-z"};
  const auto face = static_cast<std::size_t>(key.face);
  return std::string(face < kNames.size() ? kNames[face] : "?") + "/" + std::to_string(key.level) + "/" +
         std::to_string(key.i) + "/" + std::to_string(key.j);
}

}  // namespace lod
