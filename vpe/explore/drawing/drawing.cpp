#include "vpe/explore/drawing/drawing.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "paging/surface/section.h"
#include "vpe/base/number.h"
#include "vpe/base/quote.h"
#include "vpe/core/json_text.h"
#include "vpe/explore/files/text_lines.h"

namespace vpe::explore {

namespace {

constexpr std::array<std::string_view, 3> kKindWords{"point", "line", "polygon"};

bool same_bits(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

std::optional<int> hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return std::nullopt;
}

}  // namespace

bool same(const Drawing& a, const Drawing& b) {
  return a.kind == b.kind && a.name == b.name && a.colour == b.colour && a.visible == b.visible &&
         std::equal(a.vertices.begin(), a.vertices.end(), b.vertices.begin(), b.vertices.end(),
                    [](mars::LonLat p, mars::LonLat q) {
                      return same_bits(p.lon_deg, q.lon_deg) && same_bits(p.lat_deg, q.lat_deg);
                    });
}

std::string_view to_string(DrawingKind kind) { return kKindWords.at(static_cast<std::size_t>(kind)); }

std::optional<DrawingKind> drawing_kind(std::string_view word) {
  const auto found = std::find(kKindWords.begin(), kKindWords.end(), word);
  if (found == kKindWords.end()) return std::nullopt;
  return static_cast<DrawingKind>(found - kKindWords.begin());
}

std::size_t least_vertices(DrawingKind kind) { return static_cast<std::size_t>(kind) + 1; }

std::string colour_text(base::Rgb colour) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string text = "#";
  for (const std::uint8_t byte : {colour.r, colour.g, colour.b}) {
    text += kDigits[byte >> 4U];
    text += kDigits[byte & 15U];
  }
  return text;
}

std::optional<base::Rgb> parse_colour(std::string_view text) {
  if (text.size() != 7 || text.front() != '#') return std::nullopt;
  std::array<std::uint8_t, 3> bytes{};
  for (std::size_t n = 0; n < bytes.size(); ++n) {
    const std::optional<int> high = hex_digit(text[1 + 2 * n]);
    const std::optional<int> low = hex_digit(text[2 + 2 * n]);
    if (!high || !low) return std::nullopt;
    bytes[n] = static_cast<std::uint8_t>(*high * 16 + *low);
  }
  return base::Rgb{bytes[0], bytes[1], bytes[2]};
}

std::string problem_of_name(std::string_view name) {
  if (name.size() > DrawingLimits::kMostNameBytes)
    return "a name has at most " + std::to_string(DrawingLimits::kMostNameBytes) + " bytes, not " +
           std::to_string(name.size());
  if (!is_one_line(name)) return "a name is one line without control characters, not " + base::quote_text(name);
  if (core::text_in_json(std::string(name)) != name)
    return "a name is UTF-8 text, not " + base::quote_text(name);
  return "";
}

std::string problem_of_place(mars::LonLat place) {
  if (mars::is_valid(place)) return "";
  return "a place has a finite longitude and a latitude from -90 to 90 degrees, not " +
         base::format_number(place.lon_deg) + ", " + base::format_number(place.lat_deg);
}

std::string problem_of(const Drawing& drawing) {
  if (std::string problem = problem_of_name(drawing.name); !problem.empty()) return problem;
  const std::size_t count = drawing.vertices.size();
  const std::size_t least = least_vertices(drawing.kind);
  if (drawing.kind == DrawingKind::kPoint && count != 1)
    return "a point has one vertex, not " + std::to_string(count);
  if (count < least)
    return "a " + std::string(to_string(drawing.kind)) + " has at least " + std::to_string(least) +
           " vertices, not " + std::to_string(count);
  if (count > DrawingLimits::kMostVertices)
    return "a drawing has at most " + std::to_string(DrawingLimits::kMostVertices) + " vertices, not " +
           std::to_string(count);
  for (const mars::LonLat place : drawing.vertices)
    if (std::string problem = problem_of_place(place); !problem.empty()) return problem;
  const std::size_t edges = drawing.kind == DrawingKind::kPolygon ? count : count - 1;
  for (std::size_t n = 0; n < edges; ++n) {
    const std::size_t next = (n + 1) % count;
    if (mars::distance_rad(drawing.vertices[n], drawing.vertices[next]) >
        mars::kPi - paging::kNearlyOpposite_rad)
      return "vertices " + std::to_string(n + 1) + " and " + std::to_string(next + 1) +
             " lie on opposite sides of the planet; place one between them";
  }
  return "";
}

}  // namespace vpe::explore
