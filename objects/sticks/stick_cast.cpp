#include <algorithm>
#include <cmath>
#include <limits>

#include "objects/sticks/stick_model.h"

namespace objects {

namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

// A ray along an axis, in voxels. All places of side i come from the same rounding, so neighbours share them exactly.
struct AxisRay {
  double origin = 0;
  double step = 0;  // for a unit of t
  double inverse = 0;
  double never = 0;  // infinity if the ray runs beside the axis, else 0

  void set(double from, double direction) {
    origin = from;
    step = direction;
    inverse = step == 0 ? 0.0 : 1.0 / step;
    never = step == 0 ? kNever : 0.0;
  }
  double t_of(int side) const { return (side - origin) * inverse; }
  // Where the ray leaves a range of cells.
  double leave(int begin, int end) const { return t_of(step > 0 ? end : begin) + never; }
  // Where it enters: -infinity if it runs inside, +infinity if it runs beside it.
  double enter(int begin, int end) const {
    if (step == 0) return origin >= begin && origin < end ? -kNever : kNever;
    return step > 0 ? t_of(begin) : t_of(end);
  }
  // The cell of [begin, end) in which the ray goes on at t.
  int cell_at(double t, int begin, int end) const {
    const double at = step == 0 ? origin : origin + step * t;
    int c =
        static_cast<int>(std::clamp(std::floor(at), static_cast<double>(begin), static_cast<double>(end - 1)));
    if (step > 0) {
      while (c + 1 < end && t_of(c + 1) <= t) ++c;
      while (c > begin && t_of(c) > t) --c;
    } else if (step < 0) {
      while (c > begin && t_of(c) <= t) --c;
      while (c + 1 < end && t_of(c + 1) > t) ++c;
    }
    return c;
  }
};

class StickWalk {
 public:
  StickWalk(const StickModel::Level& level, const StickBlocks& blocks, float until, StickHits& hits)
      : level_(level), blocks_(blocks), until_(until), hits_(hits) {}

  void run(const ModelRay& ray) {
    if (!set_rays(ray) || !enter_box()) return;
    walk();
    end_layer();
  }

 private:
  bool set_rays(const ModelRay& ray) {
    const auto edge_m = static_cast<double>(level_.grid.voxel_m);
    double length2 = 0;
    for (int k = 0; k < 3; ++k) {
      AxisRay& a = rays_[static_cast<std::size_t>(k)];
      a.set((static_cast<double>(ray.origin_m[k]) - static_cast<double>(level_.grid.corner_m[k])) / edge_m,
            static_cast<double>(ray.direction[k]) / edge_m);
      length2 += a.step * a.step;
      if (!std::isfinite(a.origin) || !std::isfinite(a.step)) return false;
    }
    voxels_per_t_ = std::sqrt(length2);
    z_slack_ = 1e-6 + 1e-12 * std::abs(rays_[2].origin);
    return length2 > 0;
  }

  // Cuts the ray to the box of all voxels.
  bool enter_box() {
    end_ = static_cast<double>(until_);
    for (std::size_t k = 0; k < 3; ++k) {
      const double from = rays_[k].enter(blocks_.low[k], blocks_.high[k]);
      end_ = std::min(end_, rays_[k].leave(blocks_.low[k], blocks_.high[k]));
      if (from > t_) {
        t_ = from;
        side_ = static_cast<int>(k);
      }
    }
    return t_ <= end_ && end_ > 0 && blocks_.high[0] > 0;
  }

  // The cell of a range in which the ray goes on at t_; it may have come through the range's first side.
  int cell_in(std::size_t axis, int begin, int end) const {
    const AxisRay& a = rays_[axis];
    if (side_ == static_cast<int>(axis)) return a.step > 0 ? begin : end - 1;
    return a.cell_at(t_, begin, end);
  }

  void walk() {
    constexpr int kSide = StickBlocks::kSide;
    const AxisRay& rx = rays_[0];
    const AxisRay& ry = rays_[1];
    int bx = cell_in(0, blocks_.low[0], blocks_.high[0]) / kSide;
    int by = cell_in(1, blocks_.low[1], blocks_.high[1]) / kSide;
    const int turn_x = rx.step > 0 ? 1 : -1;
    const int turn_y = ry.step > 0 ? 1 : -1;
    const int low_x = blocks_.low[0] / kSide;
    const int low_y = blocks_.low[1] / kSide;
    const int high_x = (blocks_.high[0] - 1) / kSide;
    const int high_y = (blocks_.high[1] - 1) / kSide;
    double leave_x = rx.leave(bx * kSide, (bx + 1) * kSide);
    double leave_y = ry.leave(by * kSide, (by + 1) * kSide);
    while (true) {
      const double leave = std::min({leave_x, leave_y, end_});
      const std::size_t block = static_cast<std::size_t>(by) * static_cast<std::size_t>(blocks_.blocks_x) +
                                static_cast<std::size_t>(bx);
      if (meets(blocks_.blocks[block], leave) && walk_block(bx * kSide, by * kSide)) return;
      if (leave >= end_) return;
      t_ = leave;
      if (leave_x <= leave_y) {
        bx += turn_x;
        side_ = 0;
        if (bx < low_x || bx > high_x) return;
        leave_x = rx.leave(bx * kSide, (bx + 1) * kSide);
      } else {
        by += turn_y;
        side_ = 1;
        if (by < low_y || by > high_y) return;
        leave_y = ry.leave(by * kSide, (by + 1) * kSide);
      }
    }
  }

  // Returns whether a stretch of the ray from t_ may meet a block.
  bool meets(const StickBlocks::Heights& heights, double leave) const {
    if (heights.high == heights.low) return false;
    const AxisRay& z = rays_[2];
    const double a = z.origin + z.step * t_;
    const double b = z.origin + z.step * leave;
    return std::max(a, b) >= heights.low - z_slack_ && std::min(a, b) <= heights.high + z_slack_;
  }

  // Walks from column to column of a block. Returns true if the ray ends there.
  bool walk_block(int x0, int y0) {
    const AxisRay& rx = rays_[0];
    const AxisRay& ry = rays_[1];
    const int begin_x = std::max(x0, blocks_.low[0]);
    const int begin_y = std::max(y0, blocks_.low[1]);
    const int end_x = std::min(x0 + StickBlocks::kSide, blocks_.high[0]);
    const int end_y = std::min(y0 + StickBlocks::kSide, blocks_.high[1]);
    int x = cell_in(0, begin_x, end_x);
    int y = cell_in(1, begin_y, end_y);
    const int turn_x = rx.step > 0 ? 1 : -1;
    const int turn_y = ry.step > 0 ? 1 : -1;
    const auto row = static_cast<std::size_t>(level_.grid.columns_x);
    double leave_x = rx.leave(x, x + 1);
    double leave_y = ry.leave(y, y + 1);
    while (true) {
      const double leave = std::min({leave_x, leave_y, end_});
      const std::uint32_t stick =
          level_.columns[static_cast<std::size_t>(y) * row + static_cast<std::size_t>(x)];
      if (stick != 0) {
        cell_ = {x, y};
        if (climb(level_.sticks[stick], leave)) return true;
      }
      if (leave >= end_) return false;
      t_ = leave;
      if (leave_x <= leave_y) {
        x += turn_x;
        side_ = 0;
        if (x < begin_x || x >= end_x) return false;
        leave_x = rx.leave(x, x + 1);
      } else {
        y += turn_y;
        side_ = 1;
        if (y < begin_y || y >= end_y) return false;
        leave_y = ry.leave(y, y + 1);
      }
    }
  }

  // Returns true if the ray ends in the stick between t_ and `leave`.
  bool climb(const StickModel::Stick& stick, double leave) {
    if (stick.runs == 0) return false;
    const StickModel::Run* first = &level_.runs[stick.first_run];
    const StickModel::Run* last = first + stick.runs - 1;
    const AxisRay& z = rays_[2];
    if (stick.kind != StickKind::kComplex) {
      const int begin = first->begin;
      const int end = last->begin + last->length;
      const double from = std::max(t_, z.enter(begin, end));
      const double to = z.leave(begin, end);
      if (!(from <= std::min(leave, to)) || !(to > 0)) return false;
      return end_at(from, begin, end, first);
    }
    const bool goes_up = z.step >= 0;
    for (const StickModel::Run* run = goes_up ? first : last;; goes_up ? ++run : --run) {
      const int begin = run->begin;
      const int end = begin + run->length;
      const double enter = z.enter(begin, end);
      if (z.step != 0 && enter > leave) return false;
      const double from = std::max(t_, enter);
      const double to = z.leave(begin, end);
      if (from <= std::min(leave, to) && to > 0) {
        if (run->is_opaque) return end_at(from, begin, end, run);
        add_layers(*run, from, std::min(leave, to));
      }
      if (run == (goes_up ? last : first)) return false;
    }
  }

  // Stores the front: the ray enters a stretch of opaque runs that begins with `run`.
  bool end_at(double from, int begin, int end, const StickModel::Run* run) {
    if (!(from < static_cast<double>(until_))) return false;
    const AxisRay& z = rays_[2];
    const bool by_z = z.step != 0 && z.enter(begin, end) >= t_;
    const int height = by_z ? (z.step > 0 ? begin : end - 1) : z.cell_at(from, begin, end);
    while (height >= run->begin + run->length) ++run;
    StickHit& front = hits_.front;
    front.t = std::min(static_cast<float>(from), std::nextafter(until_, 0.0F));
    front.voxel =
        level_.voxels[run->first_voxel + (run->is_uniform ? 0U : static_cast<unsigned>(height - run->begin))];
    front.place = {static_cast<std::uint16_t>(cell_[0]), static_cast<std::uint16_t>(cell_[1]),
                   static_cast<std::uint16_t>(height)};
    const int side = by_z ? 2 : side_ >= 0 ? side_ : longest_axis();
    front.face = {0, 0, 0};
    front.face[side] = rays_[static_cast<std::size_t>(side)].step > 0 ? -1.0F : 1.0F;
    hits_.has_front = true;
    return true;
  }

  int longest_axis() const {
    const double x = std::abs(rays_[0].step);
    const double y = std::abs(rays_[1].step);
    const double z = std::abs(rays_[2].step);
    return x > y ? (x > z ? 0 : 2) : (y > z ? 1 : 2);
  }

  void add_layers(const StickModel::Run& run, double from, double to) {
    if (run.is_uniform) {
      add_layer(from, to, level_.voxels[run.first_voxel]);
      return;
    }
    const AxisRay& z = rays_[2];
    const int begin = run.begin;
    const int end = begin + run.length;
    for (int at = z.cell_at(from, begin, end); at >= begin && at < end && from < to;
         at += z.step < 0 ? -1 : 1) {
      const double leave = std::min(to, z.leave(at, at + 1));
      add_layer(from, leave, level_.voxels[run.first_voxel + static_cast<unsigned>(at - begin)]);
      from = leave;
    }
  }

  void add_layer(double from, double to, const StickVoxel& voxel) {
    if (!(to > from)) return;
    if (layer_end_ == from && layer_voxel_.colour == voxel.colour) {
      layer_end_ = to;
      return;
    }
    end_layer();
    layer_begin_ = from;
    layer_end_ = to;
    layer_voxel_ = voxel;
  }

  void end_layer() {
    if (layer_end_ > layer_begin_) {
      const double passes = 1.0 - layer_voxel_.colour.a / 255.0;
      const double opacity = 1.0 - std::pow(passes, (layer_end_ - layer_begin_) * voxels_per_t_);
      hits_.layers.push_back({static_cast<float>(layer_begin_), static_cast<float>(layer_end_),
                              static_cast<float>(opacity), layer_voxel_});
    }
    layer_begin_ = layer_end_ = -1;
  }

  const StickModel::Level& level_;
  const StickBlocks& blocks_;
  const float until_;
  StickHits& hits_;
  std::array<AxisRay, 3> rays_;
  double voxels_per_t_ = 0;
  double z_slack_ = 0;
  double end_ = 0;
  double t_ = 0;   // where the ray enters the column
  int side_ = -1;  // the axis that it crosses there; -1: it begins in the column
  std::array<int, 2> cell_{0, 0};
  double layer_begin_ = -1;
  double layer_end_ = -1;
  StickVoxel layer_voxel_;
};

}  // namespace

void StickModel::cast(const ModelRay& ray, std::size_t level, float until, StickHits& hits) const {
  hits.layers.clear();
  hits.front = {};
  hits.has_front = false;
  if (level >= levels_.size() || !(until > 0)) return;
  StickWalk(levels_[level], blocks_[level], until, hits).run(ray);
}

}  // namespace objects
