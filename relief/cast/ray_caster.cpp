#include "relief/cast/ray_caster.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "relief/cast/first_root.h"
#include "relief/cast/ray_paths.h"

namespace relief {

namespace {

// Parts that meet are both searched a little beyond their border, relative to the range and to the distance of the base's
// centre: a crossing at the border is not lost to rounding.
constexpr double kBeyondRange = 1e-10;
constexpr double kBeyondPlace = 1e-13;
// Parts of a ray over a shape of unknown form are not halved further.
constexpr double kShortest = 1e-9;
constexpr std::size_t kWaiting = 192;

bool is_apart(const Interval& offset) { return offset.low > 0 || offset.high < 0; }

// Where a ray begins in the centre of a central chart, its place there is not a number.
Interval known(const Interval& place) { return place.low <= place.high ? place : Interval{-kNoHit, kNoHit}; }

// One ray over one piece.
class PieceSearch {
 public:
  PieceSearch(const Surface& surface, const Piece& piece, const PreparedPiece& prepared, const Ray& ray,
              double tolerance, CastCounts& counts)
      : base_(surface.base()),
        piece_(piece),
        map_(prepared.map),
        is_within_(prepared.is_within_support),
        ray_(ray),
        tolerance_(tolerance),
        counts_(counts),
        height_(surface.base(), ray),
        x_(on_ray(piece.chart.x(), ray)),
        y_(on_ray(piece.chart.y(), ray)),
        w_(on_ray(piece.chart.w(), ray)) {
    speed_ = glm::length(ray.direction);
  }

  double first_hit(double s0, double s1) const {
    for (const Linear& side : piece_.chart.cuts()) cut(on_ray(side, ray_), s0, s1);
    if (!piece_.chart.is_parallel()) cut(w_, s0, s1);
    cut(piece_.chart.rect(), s0, s1);
    if (!(s0 <= s1)) return kNoHit;
    if (piece_.shape == nullptr) return bare_hit(s0, s1);
    // Where the shape is: before and behind it lies the bare base.
    double a = s0;
    double b = s1;
    if (!is_within_) cut(piece_.shape->support(), a, b);
    if (!(a <= b)) return bare_hit(s0, s1);
    if (a > s0) {
      const double hit = bare_hit(s0, a);
      if (hit < kNoHit) return hit;
      if (is_wall(a)) return a;
    }
    const double hit = map_ != nullptr ? map_hit(a, b) : shape_hit(a, b);
    if (hit < kNoHit || !(b < s1)) return hit;
    return is_wall(b) ? b : bare_hit(b, s1);
  }

 private:
  // Leaves only the part of [a, b] where f is not negative.
  static void cut(const LinearOnRay& f, double& a, double& b) {
    if (f.r == 0) {
      if (f.c < 0) b = -kNoHit;
      return;
    }
    const double s = -f.c / f.r;
    const double slack = 2 * kFormRounding * std::abs(s);
    if (f.r > 0)
      a = std::max(a, s - slack);
    else
      b = std::min(b, s + slack);
  }

  // Leaves only the part of [a, b] over a rectangle.
  void cut(const Rect& rect, double& a, double& b) const {
    const auto beyond_border = [&](const LinearOnRay& f, double border, double sign) {
      if (std::isfinite(border))
        cut(LinearOnRay{sign * (f.c - border * w_.c), sign * (f.r - border * w_.r)}, a, b);
    };
    beyond_border(x_, rect.x0_m, 1);
    beyond_border(x_, rect.x1_m, -1);
    beyond_border(y_, rect.y0_m, 1);
    beyond_border(y_, rect.y1_m, -1);
  }

  double beyond(double s) const {
    return kBeyondRange * s +
           kBeyondPlace * glm::length(ray_.origin_m + s * ray_.direction - base_.centre_m()) / speed_;
  }

  double bare_hit(double a, double b) const {
    if (is_apart(height_.over(a, b))) return kNoHit;
    ++counts_.patches;
    return first_root(BareOnRay{height_}, a, b);
  }

  // The relief ends at the border of its support in a wall if the base is on the other side of the ray there.
  bool is_wall(double s) const {
    const double height = height_.value(s);
    const double w = w_.at(s);
    const Rect rect = piece_.shape->support();
    const double x_m = std::clamp(x_.at(s) / w, rect.x0_m, rect.x1_m);
    const double y_m = std::clamp(y_.at(s) / w, rect.y0_m, rect.y1_m);
    return (height > 0) != (height - piece_.shape->height_m(x_m, y_m) > 0);
  }

  // A place from a to b where the ray is between the bounds of the ground, in their middle if it gets there. Nothing if
  // the chord of the height does not show one.
  double chord_hit(double a, double b, const Interval& ground) const {
    const double fa = height_.value(a) - middle(ground);
    const double fb = height_.value(b) - middle(ground);
    double s = std::abs(fa) < std::abs(fb) ? a : b;
    if ((fa > 0) != (fb > 0)) s = a + (b - a) * (fa / (fa - fb));
    return holds(ground, height_.value(s)) ? s : kNoHit;
  }

  double map_hit(double a, double b) const;
  double cells_hit(double a, double b, const std::array<int, 4>& cells) const;
  double patch_hit(const HeightOnRay& height, const CoordinateOnRay& x, const CoordinateOnRay& y, int i, int j,
                   double a, double b) const;
  double shape_hit(double a, double b) const;

  const Base& base_;
  const Piece& piece_;
  const HeightMap* map_;
  bool is_within_;
  const Ray& ray_;
  double tolerance_;
  CastCounts& counts_;
  HeightOnRay height_;
  LinearOnRay x_;
  LinearOnRay y_;
  LinearOnRay w_;
  double speed_ = 1;
};

double PieceSearch::map_hit(double a, double b) const {
  const MapLayout& layout = map_->layout();
  const CoordinateOnRay x(x_, w_, layout.x0_m, layout.dx_m);
  const CoordinateOnRay y(y_, w_, layout.y0_m, layout.dy_m);
  const auto column = [&](double at) { return static_cast<int>(std::clamp(at, 0.0, layout.columns - 1.5)); };
  const auto row = [&](double at) { return static_cast<int>(std::clamp(at, 0.0, layout.rows - 1.5)); };
  struct Stage {
    double a, b, xa, ya, xb, yb;
  };
  std::array<Stage, kWaiting> waiting;
  std::size_t count = 0;
  waiting[count++] = {a, b, x.at(a), y.at(a), x.at(b), y.at(b)};
  while (count > 0) {
    const Stage stage = waiting[--count];
    ++counts_.steps;
    const Interval xs = known(widened(between(stage.xa, stage.xb), x.rounding(stage.a, stage.b)));
    const Interval ys = known(widened(between(stage.ya, stage.yb), y.rounding(stage.a, stage.b)));
    const std::array<int, 4> cells{column(xs.low), column(xs.high), row(ys.low), row(ys.high)};
    const Interval ground = map_->cell_bounds_m(cells[0], cells[1], cells[2], cells[3]);
    const Interval offset = difference(height_.over(stage.a, stage.b), ground);
    if (is_apart(offset)) continue;
    if (width(ground) <= tolerance_ * stage.a) {
      const double hit = chord_hit(stage.a, stage.b, ground);
      if (hit < kNoHit) return hit;
    }
    const bool is_short = cells[1] - cells[0] <= 1 && cells[3] - cells[2] <= 1;
    const double m = split(stage.a, stage.b);
    if (is_short || count + 2 > kWaiting || !(m > stage.a && m < stage.b)) {
      const double hit = cells_hit(stage.a, stage.b, cells);
      if (hit < kNoHit) return hit;
      continue;
    }
    const double xm = x.at(m);
    const double ym = y.at(m);
    waiting[count++] = {m, stage.b, xm, ym, stage.xb, stage.yb};
    waiting[count++] = {stage.a, m, stage.xa, stage.ya, xm, ym};
  }
  return kNoHit;
}

// The first hit in at most 2 x 2 cells, in coordinates about the near end.
double PieceSearch::cells_hit(double a, double b, const std::array<int, 4>& cells) const {
  const Ray ray = moved(ray_, a);
  const HeightOnRay height(base_, ray);
  const MapLayout& layout = map_->layout();
  const LinearOnRay w = on_ray(piece_.chart.w(), ray);
  const CoordinateOnRay x(on_ray(piece_.chart.x(), ray), w, layout.x0_m, layout.dx_m);
  const CoordinateOnRay y(on_ray(piece_.chart.y(), ray), w, layout.y0_m, layout.dy_m);
  const double length = b - a;
  const double spare = beyond(a);
  std::array<double, 4> ends{0, length, length, length};
  std::size_t count = 1;
  if (cells[1] > cells[0]) {
    const double s = x.where(cells[1]);
    if (s > 0 && s < length) ends[count++] = s;
  }
  if (cells[3] > cells[2]) {
    const double s = y.where(cells[3]);
    if (s > 0 && s < length) ends[count++] = s;
  }
  if (count == 3 && ends[2] < ends[1]) std::swap(ends[1], ends[2]);
  ends[count] = length;
  for (std::size_t n = 0; n < count; ++n) {
    const double m = 0.5 * (ends[n] + ends[n + 1]);
    const int i = std::clamp(static_cast<int>(x.at(m)), cells[0], cells[1]);
    const int j = std::clamp(static_cast<int>(y.at(m)), cells[2], cells[3]);
    if (count > 1 && is_apart(difference(height.over(ends[n], ends[n + 1]), map_->cell_bounds_m(i, i, j, j))))
      continue;
    const double hit = patch_hit(height, x, y, i, j, ends[n] - spare, ends[n + 1] + spare);
    if (hit < kNoHit) return a + std::max(hit, 0.0);
  }
  return kNoHit;
}

double PieceSearch::patch_hit(const HeightOnRay& height, const CoordinateOnRay& x, const CoordinateOnRay& y,
                              int i, int j, double a, double b) const {
  ++counts_.patches;
  const Patch patch = map_->patch(i, j);
  const PatchSlopes slopes(patch);
  const PatchOnRay offset{height, x, y, static_cast<double>(i), static_cast<double>(j), patch, slopes};
  const bool is_parabola = patch.interpolation() == Interpolation::kBilinear && piece_.chart.is_parallel() &&
                           (base_.kind() == Base::Kind::kPlane || base_.kind() == Base::Kind::kQuadric);
  if (!is_parabola) return first_root(offset, a, b);
  const double t = first_parabola_root(offset.value(a), offset.value(0.5 * (a + b)), offset.value(b));
  return t < kNoRoot ? a + t * (b - a) : kNoHit;
}

// Shapes of unknown form have bounds, but none of their slope: halved until a change of sign is all that is left.
double PieceSearch::shape_hit(double a, double b) const {
  const CoordinateOnRay x(x_, w_, 0, 1);
  const CoordinateOnRay y(y_, w_, 0, 1);
  const auto value = [&](double s) { return height_.value(s) - piece_.shape->height_m(x.at(s), y.at(s)); };
  std::array<std::array<double, 2>, kWaiting> waiting;
  std::size_t count = 0;
  waiting[count++] = {a, b};
  while (count > 0) {
    const auto [from, to] = waiting[--count];
    ++counts_.steps;
    const Interval xs = known(widened(between(x.at(from), x.at(to)), x.rounding(from, to)));
    const Interval ys = known(widened(between(y.at(from), y.at(to)), y.rounding(from, to)));
    const Interval ground = piece_.shape->bounds_m({xs.low, ys.low, xs.high, ys.high});
    const Interval offset = difference(height_.over(from, to), ground);
    if (is_apart(offset)) continue;
    if (width(ground) <= tolerance_ * from) {
      const double hit = chord_hit(from, to, ground);
      if (hit < kNoHit) return hit;
    }
    const double m = split(from, to);
    const bool is_shortest = to - from <= kShortest * to + beyond(to);
    if (!is_shortest && m > from && m < to && count + 2 <= kWaiting) {
      waiting[count++] = {m, to};
      waiting[count++] = {from, m};
      continue;
    }
    double low = from;
    double high = to;
    const bool begins_above = value(low) > 0;
    if (begins_above == (value(high) > 0)) continue;
    ++counts_.patches;
    for (double s = 0.5 * (low + high); s > low && s < high; s = 0.5 * (low + high))
      ((value(s) > 0) == begins_above ? low : high) = s;
    return high;
  }
  return kNoHit;
}

}  // namespace

RayCaster::RayCaster(const Surface& surface) : surface_(surface) {
  for (const Piece& piece : surface.pieces()) {
    PreparedPiece& made = pieces_.emplace_back();
    if (piece.shape == nullptr) continue;
    made.map = dynamic_cast<const HeightMap*>(piece.shape.get());
    const Rect domain = piece.chart.rect();
    const Rect support = piece.shape->support();
    made.is_within_support = support.x0_m <= domain.x0_m && domain.x1_m <= support.x1_m &&
                             support.y0_m <= domain.y0_m && domain.y1_m <= support.y1_m;
  }
}

double RayCaster::first_hit(const Ray& ray, const RaySpan& span, unsigned pieces, CastCounts& counts) const {
  double hit = kNoHit;
  for (std::size_t n = 0; n < pieces_.size(); ++n) {
    if ((pieces >> n & 1U) == 0) continue;
    const PieceSearch search(surface_, surface_.pieces()[n], pieces_[n], ray, span.tolerance, counts);
    hit = std::min(hit, search.first_hit(span.s0, std::min(span.s1, hit)));
  }
  return hit;
}

}  // namespace relief
