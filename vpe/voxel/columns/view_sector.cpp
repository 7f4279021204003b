#include "vpe/voxel/columns/view_sector.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "vpe/voxel/columns/sector_rings.h"

namespace vpe::voxel {

namespace {

// Steps nearer than this to V have no usable direction.
constexpr double kNearest_px = 0.01;
// Pixels beyond a sector or the image that are also cast, so that a nearest sample always exists; or a spacing, if that is wider.
constexpr double kMargin_px = 1.0;
// Bounds of the error of a diagonal's place in the image, and that share of the distance of V.
constexpr double kRounding_px = 1e-3;
constexpr double kRounding = 1e-14;

}  // namespace

SectorPlan::SectorPlan(const core::View& view, const glm::dvec3& up, double spacing_px, int most_rings)
    : view_(view),
      part_(core::drawn_part(view)),
      up_(up),
      focal_(core::focal_px(view)),
      cx_(0.5 * view.width + view.principal_offset_px.x),
      cy_(0.5 * view.height + view.principal_offset_px.y),
      spacing_(spacing_px),
      margin_px_(std::max(kMargin_px, spacing_px)) {
  const mars::Axes& axes = view.camera.axes;
  vw_ = glm::dot(up, axes.forward);
  vx_ = cx_ * vw_ + focal_ * glm::dot(up, axes.right);
  vy_ = cy_ * vw_ - focal_ * glm::dot(up, axes.up);
  // (vx, vy, vw) and its negative are the same point of the image.
  if (vw_ < 0) {
    vw_ = -vw_;
    vx_ = -vx_;
    vy_ = -vy_;
  }
  for (const bool upright : {true, false}) {
    for (const bool forward : {true, false}) add(upright, forward, most_rings);
  }
}

SectorPlan::Side SectorPlan::side_of(double x, double y) const {
  const double qx = x * vw_ - vx_;
  const double qy = y * vw_ - vy_;
  const bool upright = std::abs(qx) <= std::abs(qy);
  Side side{upright, upright ? qy >= 0 : qx >= 0};
  const Rings& rings = rings_of(side);
  const double t = upright ? y : x;
  // Steps beyond those of all rings belong to the nearest one.
  const auto is_nearer = [&](const ViewSector& sector) {
    return side.forward ? t < sector.first_step : t > sector.first_step + sector.steps;
  };
  while (side.ring + 1 < rings.count && is_nearer(*sector_of(side))) ++side.ring;
  return side;
}

int SectorPlan::steps_alike(Side side, int step, int most) const {
  const Rings& rings = rings_of(side);
  // Towards larger steps rings lie farther from V, or nearer to it.
  const int last = side.forward ? 0 : rings.count - 1;
  const ViewSector* sector = sector_of(side);
  if (sector == nullptr || side.ring == last) return most;
  return std::clamp(sector->first_step + sector->steps - step, 1, std::max(1, most));
}

SectorPlan::Span SectorPlan::upright_span(int row) const {
  const double y = part_.y + row + 0.5;
  const auto is_upright = [&](int k) { return side_of(part_.x + k + 0.5, y).upright; };
  if (vw_ == 0.0) return is_upright(0) ? Span{0, part_.width} : Span{0, 0};
  const double half = std::abs(y * vw_ - vy_);
  const auto pixel = [&](double x) {
    return static_cast<int>(std::clamp(std::floor(x - part_.x), 0.0, static_cast<double>(part_.width)));
  };
  Span span{pixel((vx_ - half) / vw_), pixel((vx_ + half) / vw_)};
  // Agrees with side_of() exactly, whatever the rounding above.
  while (span.begin > 0 && is_upright(span.begin - 1)) --span.begin;
  while (span.begin < part_.width && !is_upright(span.begin) && part_.x + span.begin + 0.5 < vx_ / vw_)
    ++span.begin;
  span.end = std::max(span.end, span.begin);
  while (span.end < part_.width && is_upright(span.end)) ++span.end;
  while (span.end > span.begin && !is_upright(span.end - 1)) --span.end;
  return span;
}

void SectorPlan::add(bool upright, bool forward, int most_rings) {
  const int t0 = upright ? part_.y : part_.x;
  const int t_count = upright ? part_.height : part_.width;
  const double s_min = (upright ? part_.x : part_.y) - margin_px_;
  const double s_max = (upright ? part_.x + part_.width : part_.y + part_.height) + margin_px_;
  const double vt = upright ? vy_ : vx_;
  const double vs = upright ? vx_ : vy_;
  std::vector<Reach> reach;
  const double first_centre = (upright ? part_.x : part_.y) + 0.5;
  const double last_centre = first_centre + (upright ? part_.width : part_.height) - 1;
  int first = -1;
  for (int k = 0; k < t_count; ++k) {
    const double t = t0 + k + 0.5;
    const double q = t * vw_ - vt;  // times vw
    if ((q >= 0) != forward || std::abs(q) <= kNearest_px * vw_ || q == 0) continue;
    // |s vw - vs| <= |q| + margin
    const double half = std::abs(q) + 2 * margin_px_ * vw_;
    double low = s_min;
    double high = s_max;
    if (vw_ > 0) {
      low = std::max(low, (vs - half) / vw_);
      high = std::min(high, (vs + half) / vw_);
    } else if (std::abs(vs) > half) {
      continue;
    }
    if (!(low < high)) {
      if (first >= 0) break;
      continue;
    }
    if (first < 0) first = k;
    // Without what the margins add, which next to V are many lines at the reference.
    Reach& pixels = reach.emplace_back(Reach{first_centre, last_centre});
    if (vw_ > 0) {
      const double slack = kRounding_px + kRounding * std::abs(vs / vw_);
      pixels.low = std::max(first_centre, (vs - std::abs(q)) / vw_ - slack);
      pixels.high = std::min(last_centre, (vs + std::abs(q)) / vw_ + slack);
    }
  }
  if (reach.empty()) return;
  const int count = static_cast<int>(reach.size());
  std::vector<int> ends{count};
  if (vw_ > 0 && most_rings > 1) {
    std::vector<RingRow> rows;
    for (int n = 0; n < count; ++n) {
      const int k = forward ? count - 1 - n : n;
      const Reach& r = reach[static_cast<std::size_t>(k)];
      const double distance_px = std::abs(t0 + first + k + 0.5 - vt / vw_);
      rows.push_back({distance_px, (r.low - vs / vw_) / distance_px, (r.high - vs / vw_) / distance_px});
    }
    ends = ring_ends(rows, most_rings);
  }
  Rings& rings = rings_[upright ? 1 : 0][forward ? 1 : 0];
  rings.first = static_cast<int>(sectors_.size());
  int begin = 0;
  for (const int end : ends) {
    const int from = forward ? count - end : begin;
    add_ring(upright, forward, t0 + first + from,
             std::span(reach).subspan(static_cast<std::size_t>(from), static_cast<std::size_t>(end - begin)));
    begin = end;
  }
  rings.count = static_cast<int>(sectors_.size()) - rings.first;
}

void SectorPlan::add_ring(bool upright, bool forward, int first_step, std::span<const Reach> reach) {
  const double s_min = (upright ? part_.x : part_.y) - margin_px_;
  const double s_max = (upright ? part_.x + part_.width : part_.y + part_.height) + margin_px_;
  const double vt = upright ? vy_ : vx_;
  const double vs = upright ? vx_ : vy_;
  ViewSector sector;
  sector.upright = upright;
  sector.forward = forward;
  sector.first_step = first_step;
  sector.steps = static_cast<int>(reach.size());
  sector.reference = forward ? sector.first_step + sector.steps - 0.5 : sector.first_step + 0.5;
  sector.spacing = spacing_;
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (int k = 0; k < sector.steps; ++k) {
    const double t = sector.first_step + k + 0.5;
    const double lean = (sector.reference - t) / (t * vw_ - vt);
    const ViewSector::Map map{1.0 + lean * vw_, -lean * vs};
    sector.maps.push_back(map);
    const Reach& r = reach[static_cast<std::size_t>(k)];
    if (r.low > r.high) continue;
    low = std::min(low, map.scale * r.low + map.shift);
    high = std::max(high, map.scale * r.high + map.shift);
  }
  if (!(low <= high)) return;
  // A pixel has a line on either side.
  low -= spacing_;
  high += spacing_;
  // Where lines are parallel and upright they go through pixel centres.
  sector.first_line = std::floor(low - 0.5) + 0.5;
  sector.lines = static_cast<int>(std::ceil((high - sector.first_line) / spacing_)) + 1;
  sector.origin = 0.5 * (s_min + s_max);
  for (const ViewSector::Map& map : sector.maps) {
    sector.line_scale.push_back(static_cast<float>(map.scale / spacing_));
    sector.line_shift.push_back(
        static_cast<float>((map.scale * sector.origin + map.shift - sector.first_line) / spacing_));
  }
  // Slopes rise away from the nadir, and towards the zenith.
  sectors_.push_back(std::move(sector));
  ViewSector& made = sectors_.back();
  const SectorLine middle = line(made, made.lines / 2);
  const double begin = middle.a0 / middle.b0;
  const double last = made.steps - 1;
  const double end = (middle.a0 + middle.a1 * last) / (middle.b0 + middle.b1 * last);
  if (end < begin) made.rising = false;
}

SectorPlan::Window SectorPlan::window(const ViewSector& sector, const core::SubRectangle& pixels) {
  // Pixels beside a sector's steps take the nearest step, and positions among the lines are rounded to float.
  constexpr int kMargin = 2;
  const int t0 = sector.upright ? pixels.y : pixels.x;
  const int t_count = sector.upright ? pixels.height : pixels.width;
  const double s0 = (sector.upright ? pixels.x : pixels.y) + 0.5;
  const double s1 = s0 + (sector.upright ? pixels.width : pixels.height) - 1.0;
  Window window;
  window.first_step = std::clamp(t0 - kMargin - sector.first_step, 0, sector.steps);
  window.end_step = std::clamp(t0 + t_count + kMargin - sector.first_step, 0, sector.steps);
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (int k = window.first_step; k < window.end_step; ++k) {
    const ViewSector::Map& map = sector.maps[static_cast<std::size_t>(k)];
    for (const double s : {s0, s1}) {
      const double line = (map.scale * s + map.shift - sector.first_line) / sector.spacing;
      low = std::min(low, line);
      high = std::max(high, line);
    }
  }
  if (!(low <= high)) return window;
  const double last = sector.lines;
  window.first_line = static_cast<int>(std::clamp(std::floor(low) - kMargin, 0.0, last));
  window.end_line = static_cast<int>(std::clamp(std::ceil(high) + kMargin + 1, 0.0, last));
  // Groups of the lines of the whole sector: one line alone would visit the tiles behind the camera too.
  window.first_line = window.first_line / kMaxLanes * kMaxLanes;
  window.end_line = std::min((window.end_line + kMaxLanes - 1) / kMaxLanes * kMaxLanes, sector.lines);
  return window;
}

SectorLine SectorPlan::line(const ViewSector& sector, int index) const {
  const mars::Axes& axes = view_.camera.axes;
  const double s_ref = sector.first_line + sector.spacing * index;
  const double vt = sector.upright ? vy_ : vx_;
  const double vs = sector.upright ? vx_ : vy_;
  // ds / dt along the line.
  const double lean = (s_ref * vw_ - vs) / (sector.reference * vw_ - vt);
  const auto ray = [&](double t) {
    const double s = s_ref + (t - sector.reference) * lean;
    const double x = sector.upright ? s : t;
    const double y = sector.upright ? t : s;
    return (x - cx_) * axes.right + (cy_ - y) * axes.up + focal_ * axes.forward;
  };
  const glm::dvec3 far = ray(sector.reference);
  SectorLine out;
  out.azimuth = glm::normalize(far - glm::dot(far, up_) * up_);
  // The step must not carry the direction past the vertical, which lies beyond the sector's steps.
  const double t_first = sector.first_step + 0.5;
  const double t_last = t_first + sector.steps - 1;
  const glm::dvec3 begin = ray(sector.rising ? t_first : t_last);
  const glm::dvec3 step = (sector.upright ? (lean * axes.right - axes.up) : (axes.right - lean * axes.up)) *
                          (sector.rising ? 1.0 : -1.0);
  out.a0 = glm::dot(begin, up_);
  out.a1 = glm::dot(step, up_);
  out.b0 = glm::dot(begin, out.azimuth);
  out.b1 = glm::dot(step, out.azimuth);
  // Steps at which the line is in the drawn part, with a margin.
  const double s_min = (sector.upright ? part_.x : part_.y) - margin_px_;
  const double s_max = (sector.upright ? part_.x + part_.width : part_.y + part_.height) + margin_px_;
  double low = 0;
  double high = sector.steps - 1;
  if (lean != 0) {
    const double a = (s_min - s_ref) / lean + sector.reference - t_first;
    const double b = (s_max - s_ref) / lean + sector.reference - t_first;
    low = std::max(low, std::min(a, b));
    high = std::min(high, std::max(a, b));
  } else if (s_ref < s_min || s_ref > s_max) {
    high = -1;
  }
  if (!(low <= high)) return out;
  const int k0 = static_cast<int>(std::ceil(low));
  const int k1 = static_cast<int>(std::floor(high)) + 1;
  if (k1 <= k0) return out;
  out.row_begin = sector.rising ? k0 : sector.steps - k1;
  out.row_end = sector.rising ? k1 : sector.steps - k0;
  return out;
}

}  // namespace vpe::voxel
