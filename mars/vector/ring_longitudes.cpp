#include "mars/vector/ring_longitudes.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace mars {
namespace {

using Ring = std::vector<glm::dvec2>;

constexpr double kTurn_deg = 360;
constexpr double kSame_deg = 1e-9;

// Returns the number of turns to add to a longitude so that it comes within half a turn of another one.
double turns_to(double near_deg, double lon_deg, double turns) {
  // Rounding must not decide at half a turn.
  if (std::abs(lon_deg + kTurn_deg * turns - near_deg) <= kTurn_deg / 2 + kSame_deg) return turns;
  return std::round((near_deg - lon_deg) / kTurn_deg);
}

void unwrap_ring(Ring& ring) {
  double turns = turns_to(0, ring.front().x, 0);
  double before = ring.front().x + kTurn_deg * turns;
  for (glm::dvec2& p : ring) {
    turns = turns_to(before, p.x, turns);
    if (turns != 0) p.x += kTurn_deg * turns;
    before = p.x;
  }
}

bool is_full_turn(glm::dvec2 a, glm::dvec2 b) { return std::abs(std::abs(b.x - a.x) - kTurn_deg) <= kSame_deg; }

bool has_full_turn(const Ring& ring) {
  return std::adjacent_find(ring.begin(), ring.end(), is_full_turn) != ring.end();
}

// Returns the ring with its edges of a full turn divided in three.
Ring with_turns_divided(const Ring& ring) {
  Ring divided;
  divided.reserve(ring.size() + 4);
  for (std::size_t i = 0; i < ring.size(); ++i) {
    if (i > 0 && is_full_turn(ring[i - 1], ring[i])) {
      for (const double t : {1.0 / 3, 2.0 / 3}) divided.push_back(ring[i - 1] + t * (ring[i] - ring[i - 1]));
    }
    divided.push_back(ring[i]);
  }
  return divided;
}

// Appends the first vertex where the last one is another place.
void close(Ring& ring) {
  const glm::dvec2 first = ring.front();
  const glm::dvec2 last = ring.back();
  const bool is_same = first.y == last.y && std::abs(std::remainder(last.x - first.x, kTurn_deg)) <= kSame_deg;
  if (ring.size() < 2 || !is_same) ring.push_back(first);
}

// Makes the last vertex repeat the first one to the bit, up to full turns.
void close_exactly(Ring& ring) {
  const double turns = std::round((ring.back().x - ring.front().x) / kTurn_deg);
  ring.back() = {ring.front().x + kTurn_deg * turns, ring.front().y};
}

double area_deg2(const Ring& ring) {
  double sum = 0;
  for (std::size_t i = 1; i < ring.size(); ++i)
    sum += (ring[i].x - ring[i - 1].x) * (ring[i].y + ring[i - 1].y - 2 * ring.front().y) / 2;
  return std::abs(sum);
}

bool is_closed(const Ring& ring) { return std::abs(ring.back().x - ring.front().x) <= kSame_deg; }

bool has_one_longitude(const Ring& ring) {
  return std::ranges::all_of(ring, [&](glm::dvec2 p) { return std::abs(p.x - ring.front().x) <= kSame_deg; });
}

bool has_one_place(const Ring& ring) {
  return has_one_longitude(ring) &&
         std::ranges::all_of(ring, [&](glm::dvec2 p) { return p.y == ring.front().y; });
}

void unwrap_as(ShapeKind kind, Ring& ring) {
  if (kind == ShapeKind::polygon) close(ring);
  const bool may_be_whole = has_full_turn(ring);
  Ring written;
  if (may_be_whole) written = with_turns_divided(ring);
  unwrap_ring(ring);
  if (may_be_whole) {
    unwrap_ring(written);
    const bool is_polygon = kind == ShapeKind::polygon;
    const bool is_lost = is_polygon ? has_one_longitude(ring) || !is_closed(ring) : has_one_place(ring);
    if (is_lost && (!is_polygon || (is_closed(written) && area_deg2(written) > kSame_deg)))
      ring = std::move(written);
  }
  if (kind == ShapeKind::polygon) close_exactly(ring);
}

double middle_lon_deg(const Ring& ring) {
  const auto [low, high] = std::ranges::minmax_element(ring, {}, &glm::dvec2::x);
  return (low->x + high->x) / 2;
}

}  // namespace

void unwrap_longitudes(Shape& shape) {
  for (Ring& ring : shape.rings) {
    if (!ring.empty()) unwrap_as(shape.kind, ring);
  }
  if (shape.rings.size() < 2 || shape.rings.front().empty()) return;
  const double middle = middle_lon_deg(shape.rings.front());
  for (std::size_t i = 1; i < shape.rings.size(); ++i) {
    if (shape.rings[i].empty()) continue;
    const double turns = std::round((middle - middle_lon_deg(shape.rings[i])) / kTurn_deg);
    if (turns == 0) continue;
    for (glm::dvec2& p : shape.rings[i]) p.x += kTurn_deg * turns;
  }
}

RingPole pole_of(const Ring& ring) {
  if (ring.empty()) return RingPole::none;
  const double turns = std::round((ring.back().x - ring.front().x) / kTurn_deg);
  if (std::fmod(turns, 2) == 0) return RingPole::none;
  double sum = 0;
  for (std::size_t i = 1; i < ring.size(); ++i)
    sum += (ring[i].x - ring[i - 1].x) * (ring[i].y + ring[i - 1].y) / 2;
  return sum / turns > 0 ? RingPole::north : RingPole::south;
}

}  // namespace mars
