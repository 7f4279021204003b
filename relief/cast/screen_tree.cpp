#include "relief/cast/screen_tree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace relief {

ScreenRays::ScreenRays(const Surface& surface, const vpe::core::View& view)
    : surface_(surface),
      caster_(surface),
      axes_{view.camera.position_m, view.camera.axes.right, view.camera.axes.up, view.camera.axes.forward},
      first_(surface.base().first(), axes_),
      second_(surface.base().second(), axes_),
      focal_px_(vpe::core::focal_px(view)) {
  for (const Piece& piece : surface.pieces()) {
    PieceForms forms{{piece.chart.x(), axes_}, {piece.chart.y(), axes_}, {piece.chart.w(), axes_}, {}};
    // The borders of a parallel chart show in its coordinates.
    for (const Linear& side : piece.chart.is_parallel() ? piece.chart.cuts() : piece.chart.sides())
      forms.sides.emplace_back(side, axes_);
    pieces_.push_back(std::move(forms));
  }
  const vpe::core::SubRectangle part = vpe::core::drawn_part(view);
  width_ = part.width;
  height_ = part.height;
  left_px_ = part.x - (0.5 * view.width + view.principal_offset_px.x);
  top_px_ = part.y - (0.5 * view.height + view.principal_offset_px.y);
}

Tangents ScreenRays::tangents(int x0, int x1, int y0, int y1) const {
  return {(left_px_ + x0 + 0.5) / focal_px_, (left_px_ + x1 - 0.5) / focal_px_,
          -(top_px_ + y1 - 0.5) / focal_px_, -(top_px_ + y0 + 0.5) / focal_px_};
}

Ray ScreenRays::ray(double x, double y) const {
  return {axes_.origin_m, x * axes_.right + y * axes_.up + axes_.forward};
}

namespace {

// Bundles are halved in depth while that is longer than this many times their width.
constexpr double kLengthToWidth = 4;
// Bundles that end nearer than this are not halved in depth.
constexpr double kShallow_m = 1e-6;

// The coordinates of one piece over a bundle.
struct PieceBundle {
  LinearOnBundle x;
  LinearOnBundle y;
  LinearOnBundle w;
  std::array<LinearOnBundle, 6> sides;
  std::size_t side_count = 0;
  // Rates at the corners, of central charts.
  std::array<double, 4> xs;
  std::array<double, 4> ys;
  std::array<double, 4> ws;
};

// A square of pixels and its rays.
struct Bundle {
  int level = 0;  // 0: the tile
  int x = 0;      // in squares of this level
  int y = 0;
  Tangents tangents;
  QuadraticOnBundle first;
  QuadraticOnBundle second;
  std::array<PieceBundle, kMaxPieces> pieces;
};

class TileSearch {
 public:
  TileSearch(const ScreenRays& rays, const CastOptions& options, int x0, int y0, std::span<double> range_m)
      : rays_(rays), options_(options), x0_(x0), y0_(y0), range_m_(range_m) {
    for (int level = 0; level <= kTileLevels; ++level)
      done_[static_cast<std::size_t>(level)].assign(std::size_t{1} << (2 * level), false);
  }

  CastCounts run() {
    const unsigned pieces = (1U << rays_.surface().pieces().size()) - 1U;
    if (const std::optional<Bundle> tile = bundle(0, 0, 0, pieces)) {
      const Tangents& t = tile->tangents;
      const double x = std::max(std::abs(t.x0), std::abs(t.x1));
      const double y = std::max(std::abs(t.y0), std::abs(t.y1));
      visit(*tile, options_.near_m / std::sqrt(1 + x * x + y * y), options_.far_m, pieces);
    }
    return counts_;
  }

 private:
  std::size_t index(int level, int x, int y) const { return static_cast<std::size_t>((y << level) + x); }

  std::optional<Bundle> bundle(int level, int x, int y, unsigned pieces) const;
  std::optional<Interval> ground(const Bundle& b, std::size_t n, double s0, double s1) const;
  unsigned met(const Bundle& b, double s0, double s1, unsigned pieces);
  void visit(const Bundle& b, double s0, double s1, unsigned pieces);
  void cast_pixel(int x, int y, double s0, double s1, unsigned pieces);

  const ScreenRays& rays_;
  const CastOptions& options_;
  int x0_;
  int y0_;
  std::span<double> range_m_;
  CastCounts counts_;
  // Masks of finished squares, one for each level; squares beyond the image are never asked for.
  std::array<std::vector<bool>, kTileLevels + 1> done_;
};

// Returns nothing for a square beyond the image.
std::optional<Bundle> TileSearch::bundle(int level, int x, int y, unsigned pieces) const {
  const int side = kTileSide >> level;
  const int left = x0_ + x * side;
  const int top = y0_ + y * side;
  if (left >= rays_.width() || top >= rays_.height()) return std::nullopt;
  std::optional<Bundle> made(std::in_place);
  Bundle& b = *made;
  b.level = level;
  b.x = x;
  b.y = y;
  b.tangents =
      rays_.tangents(left, std::min(left + side, rays_.width()), top, std::min(top + side, rays_.height()));
  const Tangents& t = b.tangents;
  b.first = rays_.first().bundle(t);
  if (rays_.surface().base().kind() == Base::Kind::kEllipsoid) b.second = rays_.second().bundle(t);
  for (std::size_t n = 0; n < rays_.surface().pieces().size(); ++n) {
    if ((pieces >> n & 1U) == 0) continue;
    const ScreenRays::PieceForms& forms = rays_.piece(n);
    PieceBundle& piece = b.pieces[n];
    piece.x = forms.x.bundle(t);
    piece.y = forms.y.bundle(t);
    piece.side_count = std::min(forms.sides.size(), piece.sides.size());
    for (std::size_t k = 0; k < piece.side_count; ++k) piece.sides[k] = forms.sides[k].bundle(t);
    if (rays_.surface().pieces()[n].chart.is_parallel()) continue;
    piece.w = forms.w.bundle(t);
    for (std::size_t corner = 0; corner < 4; ++corner) {
      const double tx = (corner & 1) != 0 ? t.x1 : t.x0;
      const double ty = (corner & 2) != 0 ? t.y1 : t.y0;
      piece.xs[corner] = forms.x.rate(tx, ty);
      piece.ys[corner] = forms.y.rate(tx, ty);
      piece.ws[corner] = forms.w.rate(tx, ty);
    }
  }
  return made;
}

// Returns bounds of the relief of a piece over a bundle; nothing if the bundle is not in its domain.
std::optional<Interval> TileSearch::ground(const Bundle& b, std::size_t n, double s0, double s1) const {
  const Piece& piece = rays_.surface().pieces()[n];
  const PieceBundle& forms = b.pieces[n];
  for (std::size_t k = 0; k < forms.side_count; ++k)
    if (forms.sides[k].over(s0, s1).high < 0) return std::nullopt;
  if (piece.shape == nullptr) return Interval{0, 0};
  const Rect& domain = piece.chart.rect();
  Interval x{domain.x0_m, domain.x1_m};
  Interval y{domain.y0_m, domain.y1_m};
  if (piece.chart.is_parallel()) {
    x = common(x, forms.x.over(s0, s1));
    y = common(y, forms.y.over(s0, s1));
  } else if (forms.w.over(s0, s1).low > 0) {
    // Ratios of functions of first degree have their extremes at the corners.
    Interval xs{kEndless_m, -kEndless_m};
    Interval ys = xs;
    double least_w = kEndless_m;
    double size = 0;
    for (const double s : {s0, s1}) {
      for (std::size_t corner = 0; corner < 4; ++corner) {
        const double w = forms.w.c + s * forms.ws[corner];
        const double cx = forms.x.c + s * forms.xs[corner];
        const double cy = forms.y.c + s * forms.ys[corner];
        const double inverse = 1 / w;
        xs = {std::min(xs.low, cx * inverse), std::max(xs.high, cx * inverse)};
        ys = {std::min(ys.low, cy * inverse), std::max(ys.high, cy * inverse)};
        least_w = std::min(least_w, w);
        size = std::max(size, s * (std::abs(forms.xs[corner]) + std::abs(forms.ys[corner])));
      }
    }
    const double slack = 4 * kFormRounding * (std::abs(forms.x.c) + std::abs(forms.y.c) + size) / least_w;
    x = common(x, widened(xs, slack));
    y = common(y, widened(ys, slack));
  }
  if (x.low > x.high || y.low > y.high) return std::nullopt;
  const Rect rect{x.low, y.low, x.high, y.high};
  const HeightMap* map = rays_.caster().piece(n).map;
  return map != nullptr ? map->coarse_bounds_m(rect) : piece.shape->bounds_m(rect);
}

// Returns which pieces the bundle may meet from depth s0 to s1.
unsigned TileSearch::met(const Bundle& b, double s0, double s1, unsigned pieces) {
  ++counts_.bundles;
  const Base& base = rays_.surface().base();
  const Interval second = base.kind() == Base::Kind::kEllipsoid ? b.second.over(s0, s1) : Interval{};
  const Interval height = base.height_of(b.first.over(s0, s1), second);
  unsigned found = 0;
  for (std::size_t n = 0; pieces >> n != 0; ++n) {
    if ((pieces >> n & 1U) == 0) continue;
    const std::optional<Interval> relief = ground(b, n, s0, s1);
    if (relief && height.low <= relief->high && height.high >= relief->low) found |= 1U << n;
  }
  return found;
}

void TileSearch::visit(const Bundle& b, double s0, double s1, unsigned pieces) {
  const std::size_t level = static_cast<std::size_t>(b.level);
  if (done_[level][index(b.level, b.x, b.y)]) return;
  const unsigned left = met(b, s0, s1, pieces);
  if (left == 0) return;
  const double across = std::max(b.tangents.x1 - b.tangents.x0, b.tangents.y1 - b.tangents.y0);
  if (s1 - s0 > kLengthToWidth * across * s1 && s1 > kShallow_m) {
    const double m = split(s0, s1);
    visit(b, s0, m, left);
    visit(b, m, s1, left);
    return;
  }
  bool is_done = true;
  for (int child = 0; child < 4; ++child) {
    const int x = 2 * b.x + (child & 1);
    const int y = 2 * b.y + (child >> 1);
    if (b.level + 1 == kTileLevels) {
      cast_pixel(x, y, s0, s1, left);
    } else if (!done_[level + 1][index(b.level + 1, x, y)]) {
      const std::optional<Bundle> part = bundle(b.level + 1, x, y, left);
      if (!part) continue;
      visit(*part, s0, s1, left);
    }
    const int side = kTileSide >> (b.level + 1);
    if (x0_ + x * side < rays_.width() && y0_ + y * side < rays_.height())
      is_done = is_done && done_[level + 1][index(b.level + 1, x, y)];
  }
  done_[level][index(b.level, b.x, b.y)] = is_done;
}

void TileSearch::cast_pixel(int x, int y, double s0, double s1, unsigned pieces) {
  const int px = x0_ + x;
  const int py = y0_ + y;
  if (px >= rays_.width() || py >= rays_.height()) return;
  std::vector<bool>::reference done = done_[kTileLevels][index(kTileLevels, x, y)];
  if (done) return;
  const Tangents t = rays_.tangents(px, px + 1, py, py + 1);
  const Ray ray = rays_.ray(t.x0, t.y0);
  const double length = glm::length(ray.direction);
  const RaySpan span{std::max(s0, options_.near_m / length), std::min(s1, options_.far_m / length),
                     options_.tolerance_px * rays_.tangent_per_px()};
  if (!(span.s0 <= span.s1)) return;
  const double s = rays_.caster().first_hit(ray, span, pieces, counts_);
  if (!(s < kNoHit)) return;
  const std::size_t at =
      static_cast<std::size_t>(py) * static_cast<std::size_t>(rays_.width()) + static_cast<std::size_t>(px);
  range_m_[at] = s * length;
  done = true;
}

}  // namespace

CastCounts cast_tile(const ScreenRays& rays, const CastOptions& options, int x0, int y0,
                     std::span<double> range_m) {
  return TileSearch(rays, options, x0, y0, range_m).run();
}

}  // namespace relief
