// A point, line or polygon that a user draws on the ground.
//
// Vertices are joined by the shorter great circle; a polygon has one more from its last vertex to its first.
// The inside of a polygon is the smaller of the two parts into which its outline divides the sphere. An outline
// that crosses itself is allowed, since a drag passes through such outlines, but has no area.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "mars/geodesy/sphere.h"
#include "vpe/base/rgb.h"

namespace vpe::explore {

enum class DrawingKind : std::uint8_t { kPoint, kLine, kPolygon };

struct DrawingLimits {
  static constexpr std::size_t kMostDrawings = 5'000;
  static constexpr std::size_t kMostVertices = 50'000;  // of one drawing
  static constexpr std::size_t kMostVerticesOfAll = 500'000;
  static constexpr std::size_t kMostNameBytes = 200;
};

struct Drawing {
  std::uint64_t id = 0;  // unique in a list of drawings, given by it
  DrawingKind kind = DrawingKind::kPoint;
  std::string name;
  base::Rgb colour{255, 214, 90};
  bool visible = true;
  std::vector<mars::LonLat> vertices;  // longitude in (-180, 180]
};

// Returns true if all but the ids are equal, coordinates bit by bit.
bool same(const Drawing& a, const Drawing& b);

// Returns "point", "line" or "polygon"; and the kind of such a word, or nullopt.
std::string_view to_string(DrawingKind kind);
std::optional<DrawingKind> drawing_kind(std::string_view word);

// Returns the least number of vertices of a kind: 1, 2 or 3.
std::size_t least_vertices(DrawingKind kind);

// Returns "#rrggbb"; and the colour of such a text, or nullopt.
std::string colour_text(base::Rgb colour);
std::optional<base::Rgb> parse_colour(std::string_view text);

// Returns what is wrong with a name, a place or a drawing and what is expected, or "". A drawing needs its
// number of vertices, all of them valid places, and no two neighbours on opposite sides of the planet.
std::string problem_of_name(std::string_view name);
std::string problem_of_place(mars::LonLat place);
std::string problem_of(const Drawing& drawing);

}  // namespace vpe::explore
