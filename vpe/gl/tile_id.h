// IDs of tiles' parts as colours, to read back what is drawn at each pixel of an image. Pure; no OpenGL.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace vpe::gl {

// By triangle (TileDraw::by_triangle) those of the surface that are thinner than 3 steps of the rasteriser's grid count as ribbons.
enum class TilePart : std::uint8_t { kSurface, kRibbon, kSkirt };
inline constexpr std::size_t kTileParts = 3;

// Identifies a part of a drawn tile.
struct TileId {
  std::size_t tile;  // index into the drawn tiles, below 2^22
  TilePart part;
};

inline constexpr std::uint32_t kNoTile = 0;  // packed: sky

// Packs an ID to 24 bits, never kNoTile.
constexpr std::uint32_t pack(TileId id) {
  return static_cast<std::uint32_t>(id.tile * kTileParts + static_cast<std::size_t>(id.part) + 1);
}

// Undoes pack(). Undefined for kNoTile.
constexpr TileId unpack(std::uint32_t packed) {
  return {(packed - 1) / kTileParts, static_cast<TilePart>((packed - 1) % kTileParts)};
}

// Returns the colour of a packed ID, red the lowest 8 bits.
constexpr std::array<std::uint8_t, 3> id_colour(std::uint32_t packed) {
  return {static_cast<std::uint8_t>(packed), static_cast<std::uint8_t>(packed >> 8U),
          static_cast<std::uint8_t>(packed >> 16U)};
}

// Returns the packed ID of a colour.
constexpr std::uint32_t id_of_colour(std::uint8_t red, std::uint8_t green, std::uint8_t blue) {
  return red | static_cast<std::uint32_t>(green) << 8U | static_cast<std::uint32_t>(blue) << 16U;
}

}  // namespace vpe::gl
