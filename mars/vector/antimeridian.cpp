#include "mars/vector/antimeridian.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "mars/vector/ring_longitudes.h"

namespace mars {
namespace {

using Ring = std::vector<glm::dvec2>;

constexpr double kHalf_deg = 180;
constexpr double kWhole_deg = 360;
constexpr double kFlat_deg = 1e-12;
constexpr std::size_t kUnset = static_cast<std::size_t>(-1);

// Returns the number of the turn (-180 + 360 k, 180 + 360 k] that a longitude is in.
double turn_of(double lon_deg) { return std::ceil((lon_deg - kHalf_deg) / kWhole_deg); }

glm::dvec2 in_turn(glm::dvec2 p, double turn) { return {p.x - kWhole_deg * turn, p.y}; }

// Positive: counterclockwise.
double signed_area(const Ring& ring) {
  double sum = 0;
  const glm::dvec2 o = ring.front();
  for (std::size_t i = 1; i < ring.size(); ++i) {
    const glm::dvec2 a = ring[i - 1] - o;
    const glm::dvec2 b = ring[i] - o;
    sum += a.x * b.y - a.y * b.x;
  }
  return sum / 2;
}

// A ring that crosses itself may have no signed area, and yet an inside.
bool is_flat(const Ring& ring) {
  const auto [west, east] = std::ranges::minmax_element(ring, {}, &glm::dvec2::x);
  const auto [south, north] = std::ranges::minmax_element(ring, {}, &glm::dvec2::y);
  return ring.size() < 4 || east->x - west->x < kFlat_deg || north->y - south->y < kFlat_deg;
}

void turn_ring(Ring& ring, bool counterclockwise) {
  if ((signed_area(ring) > 0) != counterclockwise) std::ranges::reverse(ring);
}

bool is_inside(glm::dvec2 p, const Ring& ring) {
  bool inside = false;
  for (std::size_t i = 1; i < ring.size(); ++i) {
    const glm::dvec2 a = ring[i - 1];
    const glm::dvec2 b = ring[i];
    if ((a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x)) inside = !inside;
  }
  return inside;
}

// Returns the latitude at which an edge between two turns meets the antimeridian.
double crossing_lat(glm::dvec2 a, glm::dvec2 b, double turn_a, double turn_b) {
  const double border = kHalf_deg + kWhole_deg * std::min(turn_a, turn_b);
  const double t = b.x == a.x ? 0.0 : std::clamp((border - a.x) / (b.x - a.x), 0.0, 1.0);
  return a.y + t * (b.y - a.y);
}

// Calls begin(point) where a part begins, add(point) for its vertices, and end(point) where it ends at a border.
template <class Begin, class Add, class End>
void walk(const Ring& ring, const Begin& begin, const Add& add, const End& end) {
  double turn = turn_of(ring.front().x);
  add(in_turn(ring.front(), turn));
  for (std::size_t i = 1; i < ring.size(); ++i) {
    const double next = turn_of(ring[i].x);
    // An edge is at most 180 degrees long.
    if (next != turn) {
      const double lat = crossing_lat(ring[i - 1], ring[i], turn, next);
      const double side = next > turn ? kHalf_deg : -kHalf_deg;
      end(glm::dvec2(side, lat));
      begin(glm::dvec2(-side, lat));
    }
    turn = next;
    add(in_turn(ring[i], turn));
  }
}

void add_vertex(Ring& ring, glm::dvec2 p) {
  if (ring.empty() || ring.back() != p) ring.push_back(p);
}

std::vector<Shape> cut_line(const Ring& line) {
  std::vector<Ring> parts(1);
  walk(
      line, [&](glm::dvec2 p) { parts.push_back({p}); }, [&](glm::dvec2 p) { add_vertex(parts.back(), p); },
      [&](glm::dvec2 p) { add_vertex(parts.back(), p); });
  std::vector<Shape> shapes;
  for (Ring& part : parts) {
    if (part.size() >= 2) shapes.push_back({ShapeKind::line, {std::move(part)}});
  }
  if (shapes.empty()) {
    const glm::dvec2 p = in_turn(line.front(), turn_of(line.front().x));
    shapes.push_back({ShapeKind::line, {{p, p}}});
  }
  return shapes;
}

// Cuts a polygon. Rings become chains between the two sides of the antimeridian. Where the antimeridian is inside the
// polygon, between crossings that are paired by their latitudes, chains are joined along each of its sides.
class PolygonCutter {
 public:
  explicit PolygonCutter(const Shape& shape) {
    for (std::size_t i = 0; i < shape.rings.size(); ++i) {
      const Ring& ring = shape.rings[i];
      if (ring.size() < 4) continue;
      add_ring(ring, i == 0);
      const RingPole pole = pole_of(ring);
      if (pole == RingPole::south) south_ = !south_;
      if (pole == RingPole::north) north_ = !north_;
    }
  }

  std::vector<Shape> cut() {
    pair_crossings();
    for (std::size_t i = 0; i < chains_.size(); ++i) {
      if (!chains_[i].used) join_from(i);
    }
    std::vector<Shape> shapes;
    for (Ring& ring : outlines_) {
      if (is_flat(ring)) continue;
      turn_ring(ring, true);
      shapes.push_back({ShapeKind::polygon, {std::move(ring)}});
    }
    for (Ring& hole : holes_) place_hole(hole, shapes);
    return shapes;
  }

 private:
  // A part of a ring between two crossings. Ends have numbers: twice that of the crossing, and 1 more on the side of 180.
  struct Chain {
    Ring vertices;
    std::size_t first = kUnset;
    std::size_t last = kUnset;
    bool used = false;
  };

  struct Crossing {
    double lat = 0;
    std::size_t number = 0;
  };

  struct Link {
    std::size_t other = kUnset;
    double pole_lat = 0;  // 0: along the antimeridian
  };

  void add_ring(const Ring& ring, bool is_outline) {
    std::vector<Chain> chains(1);
    walk(
        ring,
        [&](glm::dvec2 p) {
          chains.push_back({{p}, 2 * (crossings_.size() - 1) + (p.x > 0 ? 1 : 0)});
        },
        [&](glm::dvec2 p) { add_vertex(chains.back().vertices, p); },
        [&](glm::dvec2 p) {
          crossings_.push_back({p.y, crossings_.size()});
          add_vertex(chains.back().vertices, p);
          chains.back().last = 2 * (crossings_.size() - 1) + (p.x > 0 ? 1 : 0);
        });
    if (chains.size() == 1) {
      (is_outline ? outlines_ : holes_).push_back(std::move(chains[0].vertices));
      return;
    }
    // The last chain goes on in the first one.
    Chain& end = chains.back();
    for (std::size_t i = 1; i < chains[0].vertices.size(); ++i) add_vertex(end.vertices, chains[0].vertices[i]);
    end.last = chains[0].last;
    for (std::size_t i = 1; i < chains.size(); ++i) chains_.push_back(std::move(chains[i]));
  }

  void link(std::size_t a, std::size_t b, double pole_lat) {
    links_[a] = {b, pole_lat};
    links_[b] = {a, pole_lat};
  }

  void pair_crossings() {
    links_.resize(2 * crossings_.size());
    chain_at_.assign(links_.size(), kUnset);
    for (std::size_t i = 0; i < chains_.size(); ++i) {
      chain_at_[chains_[i].first] = i;
      chain_at_[chains_[i].last] = i;
    }
    std::vector<Crossing> sorted = crossings_;
    std::ranges::stable_sort(sorted, {}, &Crossing::lat);
    if (sorted.empty()) {
      if (south_ && north_) {
        outlines_.push_back(
            {{-kHalf_deg, -90}, {kHalf_deg, -90}, {kHalf_deg, 90}, {-kHalf_deg, 90}, {-kHalf_deg, -90}});
      }
      return;
    }
    std::size_t begin = 0;
    std::size_t end = sorted.size();
    if (south_) link_across(sorted[begin++], -90);
    if ((end - begin) % 2 != 0) link_across(sorted[--end], 90);
    for (; begin < end; begin += 2) {
      for (const std::size_t side : {std::size_t{0}, std::size_t{1}})
        link(2 * sorted[begin].number + side, 2 * sorted[begin + 1].number + side, 0);
    }
  }

  // From one side of the antimeridian to the other one, along a pole.
  void link_across(const Crossing& crossing, double pole_lat) {
    link(2 * crossing.number, 2 * crossing.number + 1, pole_lat);
  }

  void join_from(std::size_t start) {
    Ring ring;
    std::size_t index = start;
    std::size_t entered = chains_[start].first;
    do {
      Chain& chain = chains_[index];
      chain.used = true;
      if (chain.first != entered) std::ranges::reverse(chain.vertices);
      for (const glm::dvec2 p : chain.vertices) add_vertex(ring, p);
      const std::size_t left = chain.first == entered ? chain.last : chain.first;
      const Link& next = links_[left];
      if (next.pole_lat != 0) {
        for (const std::size_t end : {left, next.other})
          add_vertex(ring, {end % 2 == 1 ? kHalf_deg : -kHalf_deg, next.pole_lat});
      }
      entered = next.other;
      index = chain_at_[entered];
    } while (!chains_[index].used);
    add_vertex(ring, ring.front());
    outlines_.push_back(std::move(ring));
  }

  static void place_hole(Ring& hole, std::vector<Shape>& shapes) {
    if (is_flat(hole)) return;
    turn_ring(hole, shapes.empty());
    if (shapes.empty()) shapes.push_back({ShapeKind::polygon, {}});
    std::size_t best = 0;
    std::size_t most = 0;
    for (std::size_t s = 0; s < shapes.size() && shapes.size() > 1; ++s) {
      const auto inside = static_cast<std::size_t>(
          std::ranges::count_if(hole, [&](glm::dvec2 p) { return is_inside(p, shapes[s].rings.front()); }));
      if (inside > most) {
        most = inside;
        best = s;
      }
    }
    shapes[best].rings.push_back(std::move(hole));
  }

  std::vector<Ring> outlines_;
  std::vector<Ring> holes_;
  std::vector<Chain> chains_;
  std::vector<Crossing> crossings_;
  std::vector<Link> links_;
  std::vector<std::size_t> chain_at_;
  bool south_ = false;  // the pole is inside
  bool north_ = false;
};

}  // namespace

std::vector<Shape> cut_at_antimeridian(const Shape& shape) {
  if (shape.rings.empty() || shape.rings.front().empty()) return {};
  if (shape.kind == ShapeKind::point) {
    const glm::dvec2 p = shape.rings[0][0];
    return {Shape{ShapeKind::point, {{in_turn(p, turn_of(p.x))}}}};
  }
  if (shape.kind == ShapeKind::line) return cut_line(shape.rings.front());
  std::vector<Shape> shapes = PolygonCutter(shape).cut();
  if (!shapes.empty()) return shapes;
  // Without area it has no parts.
  const Ring& outline = shape.rings.front();
  Ring ring;
  for (const glm::dvec2 p : outline) ring.push_back(in_turn(p, turn_of(outline.front().x)));
  for (glm::dvec2& p : ring) p.x = std::clamp(p.x, -kHalf_deg, kHalf_deg);
  return {Shape{ShapeKind::polygon, {std::move(ring)}}};
}

}  // namespace mars
