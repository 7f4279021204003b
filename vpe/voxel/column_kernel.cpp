#include <algorithm>
#include <cmath>
#include <limits>

#include "vpe/voxel/columns.h"

// One binary for every x86-64: this file is compiled once for each of these (the last is the baseline).
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SSE4 | HWY_AVX3_DL)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "vpe/voxel/column_kernel.cpp"
// clang-format off
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>
#include <hwy/cache_control.h>
#include <hwy/contrib/math/math-inl.h>
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace vpe::voxel::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

// Path of each lane through a lattice: position, sigma, z and w R^2 / |E| are affine in the line number k.
struct Paths {
  alignas(64) double position[kMaxLanes];
  alignas(64) double turn[kMaxLanes];  // positions a line, in [0, 1]
  alignas(64) double sigma0[kMaxLanes];
  alignas(64) double sigma1[kMaxLanes];
  alignas(64) double base0[kMaxLanes];
  alignas(64) double base1[kMaxLanes];
  alignas(64) double depth0[kMaxLanes];
  alignas(64) double depth1[kMaxLanes];
  alignas(64) double x0[kMaxLanes];  // (x, y) = (x0 + xk k, y0 + yk k)
  alignas(64) double xk[kMaxLanes];
  alignas(64) double y0[kMaxLanes];
  alignas(64) double yk[kMaxLanes];
  alignas(64) double from[kMaxLanes];  // lines that the path is inside the lattice at
  alignas(64) double to[kMaxLanes];
  alignas(64) double kind[kMaxLanes];  // 2 * family + (1 where k grows outward); -1: not in the lattice
};

// Smallest magnitude that is divided by.
constexpr double kTiny = 1e-290;
constexpr double kHuge = 1e30;

double away_from_zero(double x) { return std::abs(x) < kTiny ? (x < 0 ? -kTiny : kTiny) : x; }

// Cuts [from, to] to where 0 <= p + q k <= n.
void cut(double p, double q, double n, double& from, double& to) {
  const double inverse = 1.0 / away_from_zero(q);
  const double a = -p * inverse;
  const double b = (n - p) * inverse;
  from = std::max(from, std::min(a, b));
  to = std::min(to, std::max(a, b));
}

void find_paths(const LatticeFrame& f, const ColumnEye& eye, const ColumnGroup& group, Paths& out) {
  const double scale = eye.radius_m * eye.radius_m / eye.distance_m;
  const double n = f.intervals;
  for (int lane = 0; lane < kMaxLanes; ++lane) {
    const double ax = group.azimuth[0][lane];
    const double ay = group.azimuth[1][lane];
    const double az = group.azimuth[2][lane];
    const double nx = group.normal[0][lane] * f.du;
    const double ny = group.normal[1][lane] * f.dv;
    const double nc = group.normal[0][lane] * f.u0 + group.normal[1][lane] * f.v0 + group.normal[2][lane];
    // x = x0 + xk k, y = y0 + yk k; outward is where the cross product p' x p points along the normal.
    const bool diagonal = nx * ny >= 0;
    const bool columns = std::abs(nx) <= std::abs(ny);
    const double below = away_from_zero(diagonal ? nx + ny : (columns ? ny : nx));
    const double first = -nc / below;
    const double m = diagonal ? ny / below : (columns ? -nx / below : -ny / below);
    const double x0 = !diagonal && columns ? 0.0 : first;
    const double xk = !diagonal && columns ? 1.0 : m;
    const double y0 = !diagonal && !columns ? 0.0 : first;
    const double yk = diagonal ? m - 1.0 : (columns ? m : 1.0);
    const bool grows = diagonal || columns ? below < 0 : below > 0;
    const double u = f.u0 + f.du * x0;
    const double v = f.v0 + f.dv * y0;
    const double du = f.du * xk;
    const double dv = f.dv * yk;
    const double s0 = ax * u + ay * v + az;
    const double s1 = ax * du + ay * dv;
    double from = -kHuge;
    double to = kHuge;
    cut(x0, xk, n, from, to);
    cut(y0, yk, n, from, to);
    const double foot = -s0 / away_from_zero(s1);
    if (s1 > 0) {
      from = std::max(from, foot);
    } else {
      to = std::min(to, foot);
    }
    const bool inside = from < to && group.row[lane] < group.row_end[lane];
    out.position[lane] = diagonal ? x0 : (columns ? y0 : x0);
    out.turn[lane] = m;
    out.sigma0[lane] = s0 * scale;
    out.sigma1[lane] = s1 * scale;
    out.x0[lane] = x0;
    out.xk[lane] = xk;
    out.y0[lane] = y0;
    out.yk[lane] = yk;
    out.from[lane] = from;
    out.to[lane] = to;
    const double family = diagonal ? 2.0 : (columns ? 0.0 : 1.0);
    out.kind[lane] = inside ? 2.0 * family + (grows ? 1.0 : 0.0) : -1.0;
  }
}

// Heights along the paths, against the reference of their posts.
void find_bases(const LatticeFrame& f, const DepthPlane& plane, const ColumnEye& eye, const glm::dvec3& up,
                Paths& out) {
  const double scale = eye.radius_m * eye.radius_m / eye.distance_m;
  for (int lane = 0; lane < kMaxLanes; ++lane) {
    const double x0 = out.x0[lane];
    const double xk = out.xk[lane];
    const double y0 = out.y0[lane];
    const double yk = out.yk[lane];
    const double w = plane.w0 + plane.wx * x0 + plane.wy * y0;
    const double wk = plane.wx * xk + plane.wy * yk;
    const double along = up.x * (f.u0 + f.du * x0) + up.y * (f.v0 + f.dv * y0) + up.z;
    out.base0[lane] = (along - eye.distance_m * w) * scale;
    out.base1[lane] = (up.x * f.du * xk + up.y * f.dv * yk - eye.distance_m * wk) * scale;
    out.depth0[lane] = w * scale;
    out.depth1[lane] = wk * scale;
  }
}

// 1 / x to the last bit or two; x finite and not tiny.
template <class D>
hn::Vec<D> reciprocal(D d, hn::Vec<D> x) {
  if constexpr (sizeof(hn::TFromD<D>) == 4) {
    const auto guess = hn::ApproximateReciprocal(x);
    // One step of Newton's method doubles its bits.
    const auto error = hn::NegMulAdd(x, guess, hn::Set(d, 1.0F));
    const auto better = hn::MulAdd(guess, error, guess);
#if HWY_TARGET <= HWY_AVX3
    return better;
#else
    return hn::MulAdd(better, hn::NegMulAdd(x, better, hn::Set(d, 1.0F)), better);
#endif
  } else {
    return hn::Div(hn::Set(d, 1.0), x);
  }
}

// Rows as vectors of D see them.
template <class D, RowKind kKind>
class RowModel {
 public:
  using T = hn::TFromD<D>;
  using V = hn::Vec<D>;
  RowModel(const Rows& rows, const ColumnGroup& group, int lane0)
      : rows_(rows), count_(hn::Set(D(), static_cast<T>(rows.count))) {
    if constexpr (kKind == RowKind::kEven) {
      centre_ = hn::Set(D(), static_cast<T>(rows.centre));
      step_ = hn::Set(D(), static_cast<T>(rows.step));
      per_step_ = hn::Set(D(), static_cast<T>(1.0 / rows.step));
    }
    if constexpr (kKind == RowKind::kFan) {
      a0_ = load(group.fan_a0 + lane0);
      a1_ = load(group.fan_a1 + lane0);
      b0_ = load(group.fan_b0 + lane0);
      b1_ = load(group.fan_b1 + lane0);
    }
  }

  // row: whole numbers in [0, count].
  V slope(V row) const {
    const D d;
    if constexpr (kKind == RowKind::kEven) return hn::Mul(hn::Sub(row, centre_), step_);
    if constexpr (kKind == RowKind::kTable) return table(row);
    if constexpr (kKind == RowKind::kFan) {
      // Beyond the last row the direction may point anywhere.
      const V last = hn::Min(row, hn::Sub(count_, hn::Set(d, T(1))));
      return hn::Div(hn::MulAdd(a1_, last, a0_), hn::MulAdd(b1_, last, b0_));
    }
  }

  // Rows whose slope is at most this one.
  V count_up_to(V slope_now) const {
    const D d;
    const V one = hn::Set(d, T(1));
    V n;
    if constexpr (kKind == RowKind::kEven) {
      n = hn::Add(hn::Floor(hn::MulAdd(slope_now, per_step_, centre_)), one);
    } else if constexpr (kKind == RowKind::kFan) {
      const V above = hn::NegMulAdd(slope_now, b1_, a1_);
      const V row = hn::Div(hn::MulSub(slope_now, b0_, a0_), above);
      n = hn::Add(hn::Floor(row), one);
      n = hn::IfThenElse(hn::Le(above, hn::Zero(d)), count_, n);
    } else {
      const V first = hn::Set(d, static_cast<T>(rows_.first_elevation));
      const V per = hn::Set(d, static_cast<T>(1.0 / rows_.elevation_step));
      n = hn::Floor(hn::Mul(hn::Sub(hn::Atan(d, slope_now), first), per));
      n = hn::Min(hn::Max(n, hn::Zero(d)), count_);
      // The guess is within one row.
      n = hn::IfThenElse(hn::Le(table(n), slope_now), hn::Add(n, one), n);
      n = hn::Min(n, count_);
      const V before = hn::Max(hn::Sub(n, one), hn::Zero(d));
      n = hn::IfThenElse(hn::Gt(table(before), slope_now), before, n);
    }
    return hn::Min(n, count_);
  }

 private:
  static V load(const double* from) {
    T values[kMaxLanes];
    for (std::size_t k = 0; k < hn::Lanes(D()); ++k) values[k] = static_cast<T>(from[k]);
    return hn::LoadU(D(), values);
  }
  V table(V row) const {
    const D d;
    const hn::RebindToSigned<D> di;
    if constexpr (sizeof(T) == 4) {
      return hn::GatherIndex(d, rows_.slope, hn::ConvertTo(di, row));
    } else {
      return hn::GatherIndex(d, rows_.slope_exact, hn::ConvertTo(di, row));
    }
  }

  const Rows& rows_;
  V count_;
  V centre_, step_, per_step_;
  V a0_, a1_, b0_, b1_;
};

// How the posts of all lanes that matter are read: from a window of 32 or 64 about them, or each by itself.
enum class Reach { kNear, kWide, kAny };

// Lanes that go through one lattice the same way.
template <class D, RowKind kKind>
class Walk {
 public:
  using T = hn::TFromD<D>;
  using V = hn::Vec<D>;
  using M = hn::Mask<D>;
  using DI = hn::RebindToSigned<D>;
  using VI = hn::Vec<DI>;

  Walk(const LatticeLines<T>& lines, Family family, int intervals, const Paths& paths, int kind, int lane0,
       const ColumnEye& eye, const Rows& rows, ColumnGroup& group)
      : lines_(lines),
        family_(family),
        n_(intervals),
        lane0_(lane0),
        group_(group),
        model_(rows, group, lane0) {
    const D d;
    position_ = load(paths.position);
    turn_ = load(paths.turn);
    // A limit keeps 0 times it from becoming NaN.
    const V limit = hn::Set(d, T(1e30));
    per_turn_ = hn::Min(hn::Div(hn::Set(d, T(1)), turn_), limit);
    per_rest_ = hn::Min(hn::Div(hn::Set(d, T(1)), hn::Sub(hn::Set(d, T(1)), turn_)), limit);
    sigma0_ = load(paths.sigma0);
    sigma1_ = load(paths.sigma1);
    base0_ = load(paths.base0);
    base1_ = load(paths.base1);
    depth0_ = load(paths.depth0);
    depth1_ = load(paths.depth1);
    per_distance_ = hn::Set(d, static_cast<T>(1.0 / eye.distance_m));
    row_ = load(group.row);
    end_ = load(group.row_end);
    active_ = hn::Eq(load(paths.kind), hn::Set(d, static_cast<T>(kind)));
    started_ = hn::MaskFromVec(hn::Zero(d));
    seen_x_ = hn::Zero(d);
    seen_h_ = hn::Zero(d);
    aim();
  }

  bool any() const { return !hn::AllFalse(D(), alive_); }

  // Lanes whose path begins at the eye's foot inside this lattice, at line `foot` with post value `height`.
  void start_at_foot(T foot, T height, const Paths& paths) {
    const D d;
    const V at = hn::Set(d, foot);
    const V from = load(paths.from);
    const V to = load(paths.to);
    const V near = hn::Set(d, sizeof(T) == 8 ? T(1e-9) : T(1e-4));
    started_ = hn::And(
        active_, hn::Or(hn::Lt(hn::Abs(hn::Sub(from, at)), near), hn::Lt(hn::Abs(hn::Sub(to, at)), near)));
    seen_x_ = at;
    seen_h_ = hn::Set(d, height);
  }

  // From line `first` to line `last`, outward; stays in whole blocks where it can.
  void run(int first, int last) {
    const bool up = last > first;
    bool fresh = true;
    for (int k = first; k != last && any();) {
      const int next = up ? std::min(last, (floor_block(k) + 1) * kBlockLines)
                          : std::max(last, floor_block(k - 1) * kBlockLines);
      const int low = std::min(k, next);
      const int high = std::max(k, next);
      if (hidden(low, high)) {
        fresh = true;
      } else {
        if (fresh) enter(k);
        fresh = false;
        const bool all = settled(low, high);
        const Reach reach = all ? reach_of_all() : reach_of_some();
        if (reach == Reach::kNear) {
          block<Reach::kNear>(up, all, k, next);
        } else if (reach == Reach::kWide) {
          block<Reach::kWide>(up, all, k, next);
        } else {
          block<Reach::kAny>(up, false, k, next);
        }
      }
      k = next;
    }
  }

  template <Reach kReach>
  void block(bool up, bool all, int first, int last) {
    if (kReach != Reach::kAny && all) {
      up ? fast<true, kReach>(first, last) : fast<false, kReach>(first, last);
    } else {
      up ? careful<true, kReach>(first, last) : careful<false, kReach>(first, last);
    }
  }

  void store() const {
    alignas(64) T rows[kMaxLanes];
    hn::Store(row_, D(), rows);
    for (std::size_t k = 0; k < hn::Lanes(D()); ++k) {
      const auto lane = static_cast<std::size_t>(lane0_) + k;
      group_.row[lane] = static_cast<float>(rows[k]);
    }
  }

 private:
  template <typename S>
  V load(const S* from) const {
    alignas(64) T values[kMaxLanes];
    for (std::size_t k = 0; k < hn::Lanes(D()); ++k)
      values[k] = static_cast<T>(from[lane0_ + static_cast<int>(k)]);
    return hn::Load(D(), values);
  }

  static int floor_block(int k) { return k >= 0 ? k / kBlockLines : -((kBlockLines - 1 - k) / kBlockLines); }

  // The line z = slope sigma of the next row, subtracted from all that comes.
  void aim() {
    slope_ = model_.slope(row_);
    base_s0_ = hn::NegMulAdd(slope_, sigma0_, base0_);
    base_s1_ = hn::NegMulAdd(slope_, sigma1_, base1_);
    alive_ = hn::And(active_, hn::Lt(row_, end_));
  }

  V position_at(int k) const { return hn::MulAdd(turn_, hn::Set(D(), static_cast<T>(k)), position_); }
  V rest_at(V x) const { return hn::MulAdd(base_s1_, x, base_s0_); }

  struct Extent {
    T low;
    T high;
  };
  Extent extent(V position) const {
    const D d;
    const V far = hn::Set(d, T(1e30));
    return {hn::GetLane(hn::MinOfLanes(d, hn::IfThenElse(alive_, position, far))),
            hn::GetLane(hn::MaxOfLanes(d, hn::IfThenElse(alive_, position, hn::Neg(far))))};
  }

  // Whether nothing between two lines of one block can reach any lane's next row.
  bool hidden(int low, int high) {
    const D d;
    at_low_ = extent(position_at(low));
    at_high_ = extent(position_at(high));
    const T last = static_cast<T>(n_);
    const int c0 = static_cast<int>(std::clamp(std::min(at_low_.low, at_high_.low), T(0), last)) / kBlockLines;
    const int c1 =
        static_cast<int>(std::clamp(std::max(at_low_.high, at_high_.high), T(0), last)) / kBlockLines;
    const T* maxima = lines_.maxima(floor_block(low));
    T highest = maxima[c0];
    for (int c = c0 + 1; c <= c1; ++c) highest = std::max(highest, maxima[c]);
    const V a = rest_at(hn::Set(d, static_cast<T>(low)));
    const V b = rest_at(hn::Set(d, static_cast<T>(high)));
    const V top = hn::Add(hn::Max(a, b), hn::Set(d, highest));
    return hn::AllFalse(d, hn::And(alive_, hn::Ge(top, hn::Zero(d))));
  }

  T first_position(int k) const {
    return family_ == Family::kDiagonals ? static_cast<T>(std::max(0, k)) : T(0);
  }
  T last_position(int k) const {
    return static_cast<T>(family_ == Family::kDiagonals ? n_ + std::min(0, k) : n_);
  }

  // What is read of one line at each lane's position.
  struct Line {
    V whole;
    V part;
    V low;
    V high;
  };

  // Any position: reads are kept within the lattice's rows.
  Line gather(int k) const {
    const D d;
    const DI di;
    Line line;
    const V y = position_at(k);
    line.whole = hn::Floor(y);
    line.part = hn::Sub(y, line.whole);
    const V safe = hn::Min(hn::Max(line.whole, hn::Set(d, T(-1))), hn::Set(d, static_cast<T>(n_)));
    const VI index = hn::ConvertTo(di, safe);
    const T* at = lines_.line(k);
    line.low = hn::GatherIndex(d, at, index);
    line.high = hn::GatherIndex(d, at + 1, index);
    return line;
  }

  // Positions of all lanes that matter are in [from, from + 28] or [from, from + 60]; others read anything.
  template <Reach kReach>
  Line window(int k, T from) const {
    const D d;
    const DI di;
    Line line;
    const V y = position_at(k);
    line.whole = hn::Floor(y);
    line.part = hn::Sub(y, line.whole);
    const int base = std::max(static_cast<int>(from) - 1, -1);
    const T* at = lines_.line(k) + base;
#if HWY_TARGET <= HWY_AVX3
    if constexpr (sizeof(T) == 4) {
      const __m512 a = _mm512_loadu_ps(at);
      const __m512 b = _mm512_loadu_ps(at + 16);
      const __m512i low = _mm512_sub_epi32(_mm512_cvttps_epi32(line.whole.raw), _mm512_set1_epi32(base));
      const __m512i high = _mm512_add_epi32(low, _mm512_set1_epi32(1));
      line.low = V{_mm512_permutex2var_ps(a, low, b)};
      line.high = V{_mm512_permutex2var_ps(a, high, b)};
      if constexpr (kReach == Reach::kWide) {
        const __m512 c = _mm512_loadu_ps(at + 32);
        const __m512 e = _mm512_loadu_ps(at + 48);
        const __m512i half = _mm512_set1_epi32(32);
        const __mmask16 low_far = _mm512_test_epi32_mask(low, half);
        const __mmask16 high_far = _mm512_test_epi32_mask(high, half);
        line.low = V{_mm512_mask_blend_ps(low_far, line.low.raw, _mm512_permutex2var_ps(c, low, e))};
        line.high = V{_mm512_mask_blend_ps(high_far, line.high.raw, _mm512_permutex2var_ps(c, high, e))};
      }
      return line;
    }
#endif
    const VI index = hn::ConvertTo(di, hn::Sub(line.whole, hn::Set(d, static_cast<T>(base))));
    const VI safe = hn::Min(hn::Max(index, hn::Zero(di)), hn::Set(di, kReadAhead - 2));
    line.low = hn::GatherIndex(d, at, safe);
    line.high = hn::GatherIndex(d, at + 1, safe);
    return line;
  }

  template <Reach kReach>
  Line read(int k, T from) const {
    if constexpr (kReach == Reach::kAny) {
      return gather(k);
    } else {
      return window<kReach>(k, from);
    }
  }

  // The one edge between two lines, `lower` having the smaller number.
  struct Crossing {
    V x;
    V height;
    M other;  // an edge along the lines' normal, not a diagonal of the family's cells
  };
  Crossing between(int k, const Line& lower, const Line& upper) const {
    const D d;
    const V one = hn::Set(d, T(1));
    Crossing c;
    c.other = hn::Ne(lower.whole, upper.whole);
    const V numerator = hn::IfThenElse(c.other, hn::Sub(one, lower.part), lower.part);
    const V factor = hn::IfThenElse(c.other, per_turn_, per_rest_);
    const V s = hn::Min(hn::Max(hn::Mul(numerator, factor), hn::Zero(d)), one);
    const V a = hn::IfThenElse(c.other, lower.high, lower.low);
    const V b = hn::IfThenElse(c.other, upper.low, upper.high);
    c.height = hn::MulAdd(s, hn::Sub(b, a), a);
    c.x = hn::Add(hn::Set(d, static_cast<T>(k)), s);
    return c;
  }

  static V height_on(const Line& line) { return hn::MulAdd(line.part, hn::Sub(line.high, line.low), line.low); }

  M on_line(int k, const Line& line) const {
    const D d;
    return hn::And(hn::Ge(line.whole, hn::Set(d, first_position(k))),
                   hn::Lt(line.whole, hn::Set(d, last_position(k))));
  }

  M in_front(V x) const { return hn::Gt(hn::MulAdd(sigma1_, x, sigma0_), hn::Zero(D())); }

  // Whether all lanes that are alive are inside at both lines, have begun and are near each other.
  bool settled(int low, int high) const {
    const D d;
    if (at_low_.low < first_position(low) || at_low_.high >= last_position(low)) return false;
    if (at_high_.low < first_position(high) || at_high_.high >= last_position(high)) return false;
    const M ready = hn::And(started_, hn::And(in_front(hn::Set(d, static_cast<T>(low))),
                                              in_front(hn::Set(d, static_cast<T>(high)))));
    return hn::AllFalse(d, hn::AndNot(ready, alive_));
  }

  // A path's first event: what lies before it is not of this lattice, so a row is resolved at the event itself.
  void begin(M who, V x, V height) {
    const D d;
    seen_x_ = hn::IfThenElse(who, x, seen_x_);
    seen_h_ = hn::IfThenElse(who, hn::Sub(height, hn::Set(d, T(1))), seen_h_);
    started_ = hn::Or(started_, who);
  }

  void event(M who, V x, V height) {
    const D d;
    const V rest = hn::Add(height, rest_at(x));
    const M reached = hn::And(hn::And(who, alive_), hn::Ge(rest, hn::Zero(d)));
    if (HWY_UNLIKELY(!hn::AllFalse(d, reached))) resolve(reached, x, height, rest);
  }

  void enter(int k) {
    const D d;
    const Line line = gather(k);
    const V x = hn::Set(d, static_cast<T>(k));
    const M here = hn::And(active_, hn::And(on_line(k, line), in_front(x)));
    const V height = height_on(line);
    begin(here, x, height);
    event(here, x, height);
    seen_x_ = hn::IfThenElse(here, x, seen_x_);
    seen_h_ = hn::IfThenElse(here, height, seen_h_);
  }

  static Reach reach_for(T width) {
    return width <= 28 ? Reach::kNear : (width <= 60 ? Reach::kWide : Reach::kAny);
  }

  // A window of its own for each line.
  Reach reach_of_all() const {
    return reach_for(std::max(at_low_.high - at_low_.low, at_high_.high - at_high_.low));
  }

  // One for the whole block: lanes come and go.
  Reach reach_of_some() {
    const T last = static_cast<T>(n_);
    from_ = std::clamp(std::min(at_low_.low, at_high_.low), T(-1), last);
    return reach_for(std::clamp(std::max(at_low_.high, at_high_.high), T(-1), last) - from_);
  }

  // Lanes may come and go.
  template <bool kUp, Reach kReach>
  void careful(int first, int last) {
    const D d;
    const auto read = [&](int k) { return this->template read<kReach>(k, from_); };
    Line line = read(first);
    for (int k = first; k != last; k += kUp ? 1 : -1) {
      const int next_k = kUp ? k + 1 : k - 1;

      const Line next = read(next_k);
      const int low_k = kUp ? k : next_k;
      const Line& lower = kUp ? line : next;
      const Line& upper = kUp ? next : line;
      const Crossing c = between(low_k, lower, upper);
      // Both ends of the edge must be posts of this lattice.
      const V one = hn::Set(d, T(1));
      const V low_post = hn::IfThenElse(c.other, hn::Add(lower.whole, one), lower.whole);
      const V high_post = hn::Add(lower.whole, one);
      M here = hn::And(hn::Ge(low_post, hn::Set(d, first_position(low_k))),
                       hn::Le(low_post, hn::Set(d, last_position(low_k))));
      here = hn::And(here, hn::And(hn::Ge(high_post, hn::Set(d, first_position(low_k + 1))),
                                   hn::Le(high_post, hn::Set(d, last_position(low_k + 1)))));
      here = hn::And(here, hn::And(active_, in_front(c.x)));
      // A path that begins at the eye's foot has nothing before it.
      here = hn::And(here, outward<kUp>(c.x));
      pass(here, c.x, c.height);
      const V x = hn::Set(d, static_cast<T>(next_k));
      const M there = hn::And(hn::And(active_, on_line(next_k, next)), hn::And(in_front(x), outward<kUp>(x)));
      pass(there, x, height_on(next));
      line = next;
    }
  }

  template <bool kUp>
  M outward(V x) const {
    const M beyond = kUp ? hn::Ge(x, seen_x_) : hn::Le(x, seen_x_);
    return hn::Or(beyond, hn::Not(started_));
  }

  void pass(M who, V x, V height) {
    begin(hn::AndNot(started_, who), x, height);
    event(who, x, height);
    seen_x_ = hn::IfThenElse(who, x, seen_x_);
    seen_h_ = hn::IfThenElse(who, height, seen_h_);
  }

  // All lanes are there.
  template <bool kUp, Reach kReach>
  void fast(int first, int last) {
    const D d;
    const V zero = hn::Zero(d);
    const T rate = (at_high_.low - at_low_.low) / static_cast<T>(std::abs(last - first));
    const int low_end = std::min(first, last);
    const auto from = [&](int k) { return at_low_.low + rate * static_cast<T>(k - low_end); };
    Line line = read<kReach>(first, from(first));
    for (int k = first; k != last; k += kUp ? 1 : -1) {
      const int next_k = kUp ? k + 1 : k - 1;

      const Line next = read<kReach>(next_k, from(next_k));
      const Crossing c = between(kUp ? k : next_k, kUp ? line : next, kUp ? next : line);
      const V x = hn::Set(d, static_cast<T>(next_k));
      const V height = height_on(next);
      const V rest_c = hn::Add(c.height, rest_at(c.x));
      const V rest = hn::Add(height, rest_at(x));
      const M reached = hn::And(alive_, hn::Ge(hn::Max(rest_c, rest), zero));
      if (!hn::AllFalse(d, reached)) {
        const M first_reached = hn::And(alive_, hn::Ge(rest_c, zero));
        if (!hn::AllFalse(d, first_reached)) resolve(first_reached, c.x, c.height, rest_c);
        seen_x_ = c.x;
        seen_h_ = c.height;
        event(alive_, x, height);
      }
      seen_x_ = x;
      seen_h_ = height;
      line = next;
    }
  }

  // Rows up to the slope of an event are resolved by the facet between the last event and this one.
  void resolve(M who, V x, V height, V rest) {
    const D d;
    const V zero = hn::Zero(d);
    const V one = hn::Set(d, T(1));
    const V sigma = hn::MulAdd(sigma1_, x, sigma0_);
    const V per_sigma = reciprocal(d, sigma);
    const V reached = hn::Mul(hn::Add(height, hn::MulAdd(base1_, x, base0_)), per_sigma);
    V rows = hn::Max(model_.count_up_to(reached), hn::Add(row_, one));
    rows = hn::Min(rows, end_);
    // Where the next row's ray meets the facet.
    const V before = hn::Min(hn::Add(seen_h_, rest_at(seen_x_)), zero);
    const V share = hn::Min(hn::Mul(before, reciprocal(d, hn::Sub(before, hn::Max(rest, least())))), one);
    const V at_x = hn::MulAdd(share, hn::Sub(x, seen_x_), seen_x_);
    const V at_h = hn::MulAdd(share, hn::Sub(height, seen_h_), seen_h_);
    const V at = hn::Mul(inverse(at_x, at_h), reciprocal(d, hn::MulAdd(sigma1_, at_x, sigma0_)));
    scatter(group_.start, who, at);
    const M more = hn::And(who, hn::Gt(rows, hn::Add(row_, one)));
    if (!hn::AllFalse(d, more)) {
      const V end = hn::Mul(inverse(x, height), per_sigma);
      const V rise = hn::Sub(reached, slope_);
      const M rises = hn::And(more, hn::Gt(rise, zero));
      scatter(group_.gain, rises, hn::Div(hn::Sub(end, at), rise));
    }
    row_ = hn::IfThenElse(who, rows, row_);
    aim();
  }

  // w R^2 / |E|: over sigma it is the inverse horizontal distance.
  V inverse(V x, V height) const {
    return hn::NegMulAdd(height, per_distance_, hn::MulAdd(depth1_, x, depth0_));
  }

  // Keeps a quotient of two zeros from being NaN.
  static V least() { return hn::Set(D(), T(1e-30)); }

  // To each lane's next row.
  void scatter(float* to, M who, V values) const {
    const D d;
#if HWY_TARGET <= HWY_AVX3
    if constexpr (sizeof(T) == 4) {
      const __m512i row = _mm512_cvttps_epi32(row_.raw);
      const __m512i lane = _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
      _mm512_mask_i32scatter_ps(to, who.raw, _mm512_add_epi32(_mm512_slli_epi32(row, 4), lane), values.raw, 4);
      return;
    }
#endif
    alignas(64) T rows[kMaxLanes];
    alignas(64) T all[kMaxLanes];
    hn::Store(hn::IfThenElse(who, row_, hn::Set(d, T(-1))), d, rows);
    hn::Store(values, d, all);
    for (std::size_t k = 0; k < hn::Lanes(d); ++k) {
      if (rows[k] < 0) continue;
      to[static_cast<std::size_t>(rows[k]) * kMaxLanes + static_cast<std::size_t>(lane0_) + k] =
          static_cast<float>(all[k]);
    }
  }

  const LatticeLines<T>& lines_;
  Family family_;
  int n_;
  int lane0_;
  ColumnGroup& group_;
  RowModel<D, kKind> model_;
  V position_, turn_, per_turn_, per_rest_;
  V sigma0_, sigma1_, base0_, base1_, depth0_, depth1_, per_distance_;
  V row_, end_, slope_, base_s0_, base_s1_;
  M active_, alive_, started_;
  V seen_x_, seen_h_;  // the last event of each lane
  Extent at_low_{};
  Extent at_high_{};
  T from_ = 0;
};

using FloatTag = hn::CappedTag<float, kMaxLanes>;
using DoubleTag = hn::CappedTag<double, kMaxLanes / 2>;

struct Foot {
  bool inside = false;  // the eye's foot is seen from this face
  double x = 0;
  double y = 0;
  double depth = 0;  // w of S there

  double on(Family family) const {
    return family == Family::kColumns ? x : (family == Family::kRows ? y : x - y);
  }
  // As the posts of a lattice have it.
  double height(const DepthPlane& plane, const ColumnEye& eye) const {
    return (plane.w0 + plane.wx * x + plane.wy * y - depth) * eye.radius_m * eye.radius_m;
  }
};

template <RowKind kKind>
void walk_as(const LatticeFrame& f, LatticeSource& source, const ColumnEye& eye, const glm::dvec3& up,
             const Rows& rows, ColumnGroup& group) {
  Paths paths;
  find_paths(f, eye, group, paths);
  Foot foot;
  if (up.z > 0) {
    foot.inside = true;
    foot.depth = 1.0 / (up.z * eye.ground_m);
    foot.x = (up.x / up.z - f.u0) / f.du;
    foot.y = (up.y / up.z - f.v0) / f.dv;
  }
  unsigned kinds = 0;
  for (double kind : paths.kind) {
    if (kind >= 0) kinds |= 1U << static_cast<int>(kind);
  }
  for (int kind = 0; kind < 2 * kFamilies; ++kind) {
    if (((kinds >> kind) & 1U) == 0) continue;
    const auto family = static_cast<Family>(kind / 2);
    const bool outward_up = (kind & 1) != 0;
    double from = kHuge;
    double to = -kHuge;
    for (int lane = 0; lane < kMaxLanes; ++lane) {
      if (paths.kind[lane] != kind) continue;
      from = std::min(from, paths.from[lane]);
      to = std::max(to, paths.to[lane]);
    }
    const int least = family == Family::kDiagonals ? -f.intervals : 0;
    // One line more on either side, so that rounding of the ends leaves out no event.
    const int low = std::clamp(static_cast<int>(std::floor(from - 1e-3)), least, f.intervals);
    const int high = std::clamp(static_cast<int>(std::ceil(to + 1e-3)), least, f.intervals);
    int first = outward_up ? low : high;
    const int last = outward_up ? high : low;
    if (foot.inside) {
      const double at = foot.on(family);
      // Outward all lines lie on one side of the foot's.
      const double nearest = outward_up ? first - at : at - first;
      if (nearest < kExactLines && needs_exact(f, eye)) {
        const double reach = outward_up ? at + kExactLines : at - kExactLines;
        int until = static_cast<int>(outward_up ? std::ceil(reach) : std::floor(reach));
        until = outward_up ? std::min(until, last) : std::max(until, last);
        if (until != first) {
          const LatticeLines<double>& lines = source.exact_lines(family);
          const DepthPlane& plane = lines.reference;
          find_bases(f, plane, eye, up, paths);
          const double height = foot.height(plane, eye);
          for (int lane0 = 0; lane0 < static_cast<int>(hn::Lanes(FloatTag()));
               lane0 += static_cast<int>(hn::Lanes(DoubleTag()))) {
            Walk<DoubleTag, kKind> walk(lines, family, f.intervals, paths, kind, lane0, eye, rows, group);
            if (!walk.any()) continue;
            walk.start_at_foot(at, height, paths);
            walk.run(first, until);
            walk.store();
          }
          first = until;
        }
      }
    }
    if (first == last) continue;
    const LatticeLines<float>& lines = source.lines(family);
    find_bases(f, lines.reference, eye, up, paths);
    const bool begins = foot.inside && first == (outward_up ? low : high);
    Walk<FloatTag, kKind> walk(lines, family, f.intervals, paths, kind, 0, eye, rows, group);
    if (!walk.any()) continue;
    if (begins)
      walk.start_at_foot(static_cast<float>(foot.on(family)),
                         static_cast<float>(foot.height(lines.reference, eye)), paths);
    walk.run(first, last);
    walk.store();
  }
}

void WalkLattice(const LatticeFrame& f, LatticeSource& source, const ColumnEye& eye, const glm::dvec3& up,
                 const Rows& rows, ColumnGroup& group) {
  switch (rows.kind) {
    case RowKind::kEven: return walk_as<RowKind::kEven>(f, source, eye, up, rows, group);
    case RowKind::kTable: return walk_as<RowKind::kTable>(f, source, eye, up, rows, group);
    case RowKind::kFan: return walk_as<RowKind::kFan>(f, source, eye, up, rows, group);
  }
}

template <RowKind kKind>
void least_as(const Rows& rows, ColumnGroup& group) {
  const FloatTag d;
  const RowModel<FloatTag, kKind> model(rows, group, 0);
  const auto row = hn::Load(d, group.row);
  const auto alive = hn::Lt(row, hn::Load(d, group.row_end));
  const auto far = hn::Set(d, std::numeric_limits<float>::infinity());
  group.least_slope =
      static_cast<double>(hn::GetLane(hn::MinOfLanes(d, hn::IfThenElse(alive, model.slope(row), far))));
}

void UpdateLeastSlope(const Rows& rows, ColumnGroup& group) {
  switch (rows.kind) {
    case RowKind::kEven: return least_as<RowKind::kEven>(rows, group);
    case RowKind::kTable: return least_as<RowKind::kTable>(rows, group);
    case RowKind::kFan: return least_as<RowKind::kFan>(rows, group);
  }
}

template <RowKind kKind>
void expand_as(const Rows& rows, ColumnGroup& group, int first, int last, float* out, std::ptrdiff_t stride) {
  const bool whole = group.columns == static_cast<int>(hn::Lanes(FloatTag()));
  const FloatTag d;
  using V = hn::Vec<FloatTag>;
  const RowModel<FloatTag, kKind> model(rows, group, 0);
  const V zero = hn::Zero(d);
  const V one = hn::Set(d, 1.0F);
  const V sky = hn::Set(d, std::numeric_limits<float>::infinity());
  const V resolved = hn::Load(d, group.row);
  const float most = hn::GetLane(hn::MaxOfLanes(d, resolved));
  V start = hn::Load(d, group.run_start);
  V gain = hn::Load(d, group.run_gain);
  V from = hn::Load(d, group.run_slope);
  const auto put = [&](int r, V seen) {
    float* const to = out + static_cast<std::ptrdiff_t>(r - first) * stride;
    if (whole) {
      hn::StoreU(seen, d, to);
    } else {
      alignas(64) float some[kMaxLanes];
      hn::Store(seen, d, some);
      std::copy_n(some, group.columns, to);
    }
  };
  const int ground = std::clamp(static_cast<int>(most), first, last);
  for (int r = first; r < ground; ++r) {
    float* const starts = group.start + static_cast<std::ptrdiff_t>(r) * kMaxLanes;
    float* const gains = group.gain + static_cast<std::ptrdiff_t>(r) * kMaxLanes;
    const V row = hn::Set(d, static_cast<float>(r));
    const V slope = model.slope(row);
    const V now = hn::Load(d, starts);
    const auto begins = hn::Ne(now, zero);
    if (!hn::AllFalse(d, begins)) {
      start = hn::IfThenElse(begins, now, start);
      gain = hn::IfThenElse(begins, hn::Load(d, gains), gain);
      from = hn::IfThenElse(begins, slope, from);
      hn::Store(zero, d, starts);
      hn::Store(zero, d, gains);
    }
    const V per = hn::MulAdd(gain, hn::Sub(slope, from), start);
    V length;
    if constexpr (kKind == RowKind::kFan) {
      length = hn::Sqrt(hn::MulAdd(slope, slope, one));
    } else {
      length = hn::Set(d, rows.length[r]);
    }
    put(r, hn::IfThenElse(hn::Lt(row, resolved), hn::Div(length, per), sky));
  }
  for (int r = ground; r < last; ++r) put(r, sky);
  hn::Store(start, d, group.run_start);
  hn::Store(gain, d, group.run_gain);
  hn::Store(from, d, group.run_slope);
}

void ExpandRows(const Rows& rows, ColumnGroup& group, int first, int last, float* out, std::ptrdiff_t stride) {
  switch (rows.kind) {
    case RowKind::kEven: return expand_as<RowKind::kEven>(rows, group, first, last, out, stride);
    case RowKind::kTable: return expand_as<RowKind::kTable>(rows, group, first, last, out, stride);
    case RowKind::kFan: return expand_as<RowKind::kFan>(rows, group, first, last, out, stride);
  }
}

void CopyRows(const float* from, std::ptrdiff_t from_stride, float* to, std::ptrdiff_t to_stride, int columns,
              int rows, bool stream) {
  const FloatTag d;
  const auto lanes = static_cast<std::ptrdiff_t>(hn::Lanes(d));
  const auto bytes = static_cast<std::uintptr_t>(lanes) * sizeof(float);
  for (int r = 0; r < rows; ++r, from += from_stride, to += to_stride) {
    std::ptrdiff_t x = 0;
    if (stream) {
      // Up to the first whole vector.
      while (x < columns && reinterpret_cast<std::uintptr_t>(to + x) % bytes != 0) {
        to[x] = from[x];
        ++x;
      }
      for (; x + lanes <= columns; x += lanes) hn::Stream(hn::LoadU(d, from + x), d, to + x);
    }
    for (; x + lanes <= columns; x += lanes) hn::StoreU(hn::LoadU(d, from + x), d, to + x);
    for (; x < columns; ++x) to[x] = from[x];
  }
  if (stream) hwy::FlushStream();
}

int ColumnLanes() { return static_cast<int>(hn::Lanes(FloatTag())); }
const char* ColumnTarget() { return hwy::TargetName(HWY_TARGET); }

}  // namespace
}  // namespace vpe::voxel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vpe::voxel {

bool needs_exact(const LatticeFrame& frame, const ColumnEye& eye) {
  return eye.distance_m - eye.ground_m < kExactLines * std::max(frame.du, frame.dv) * eye.radius_m;
}

HWY_EXPORT(WalkLattice);
HWY_EXPORT(UpdateLeastSlope);
HWY_EXPORT(ExpandRows);
HWY_EXPORT(CopyRows);
HWY_EXPORT(ColumnLanes);
HWY_EXPORT(ColumnTarget);

void walk_lattice(const LatticeFrame& frame, LatticeSource& source, const ColumnEye& eye, const glm::dvec3& up,
                  const Rows& rows, ColumnGroup& group) {
  HWY_DYNAMIC_DISPATCH(WalkLattice)(frame, source, eye, up, rows, group);
}
void update_least_slope(const Rows& rows, ColumnGroup& group) {
  HWY_DYNAMIC_DISPATCH(UpdateLeastSlope)(rows, group);
}
void expand_rows(const Rows& rows, ColumnGroup& group, int first, int last, float* out, std::ptrdiff_t stride) {
  HWY_DYNAMIC_DISPATCH(ExpandRows)(rows, group, first, last, out, stride);
}
void copy_rows(const float* from, std::ptrdiff_t from_stride, float* to, std::ptrdiff_t to_stride, int columns,
               int rows, bool stream) {
  HWY_DYNAMIC_DISPATCH(CopyRows)(from, from_stride, to, to_stride, columns, rows, stream);
}
int column_lanes() { return HWY_DYNAMIC_DISPATCH(ColumnLanes)(); }
const char* column_target() { return HWY_DYNAMIC_DISPATCH(ColumnTarget)(); }

}  // namespace vpe::voxel
#endif
