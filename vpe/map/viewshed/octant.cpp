#include "vpe/map/viewshed/octant.h"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <utility>

#include "vpe/map/viewshed/fan_kernel.h"
#include "vpe/map/viewshed/ring_block.h"
#include "vpe/map/viewshed/rise.h"

namespace vpe::map {

namespace {

constexpr int kRaysPerFan = 512;
constexpr int kFewestRays = 8;
// The ray to a post may pass a ridge between the rays on its sides where it is higher than under both.
constexpr float kDoubt = 1.0F;  // in differences of their horizons, from their mean
constexpr int kRidgeReach = 1;  // lines on both sides of a ridge where needed heights look too

// Sweeps one fan.
class Sweep {
 public:
  Sweep(const Octant& octant, const FanRays& rays, const OctantResults& results)
      : octant_(octant), rays_(rays), results_(results), count_(rays.last - rays.first + 1) {
    const std::size_t size = static_cast<std::size_t>(count_) + 2 + RayFan::kPad;
    for (std::vector<float>* member : {&fan_.slope, &fan_.slope_inverse, &fan_.ridge, &fan_.needed_m,
                                       &fan_.rises_m, &fan_.rises_before_m, &targets_m_})
      member->resize(size);
    fan_.doubts.resize(size);
    fan_.sights.resize(size);
    fan_.horizon.resize(size, kNoRise);
    for (int n = 0; n < count_; ++n) {
      const auto at = static_cast<std::size_t>(n);
      const float ray = static_cast<float>(rays.first + n);
      fan_.slope[at] = ray / static_cast<float>(rays.division);
      if (ray > 0) fan_.slope_inverse[at] = static_cast<float>(rays.division) / ray;
    }
  }

  void run() {
    for (int ring = 1; ring <= octant_.rings; ++ring) {
      const int from = first_needed(ring);
      if (from > octant_.last_post) break;
      if (is_across() && (ring - 1) % kRingsOfBlock == 0) begin_block(ring);
      load(ring, from);
      decide(ring);
      raise(ring);
      std::swap(fan_.rises_m, fan_.rises_before_m);
      first_before_ = first_;
    }
    end_block();
  }

 private:
  // Return the first and the last post of a ring that the rays need; the last one may be beyond the grid.
  int first_needed(int ring) const {
    return static_cast<int>(std::int64_t{ring} * rays_.first / rays_.division);
  }
  int last_needed(int ring) const {
    return static_cast<int>(std::int64_t{ring} * rays_.last / rays_.division) + 1;
  }

  bool is_across() const { return std::abs(octant_.post_step) != 1; }
  bool has_targets() const { return octant_.targets_m != octant_.rises_m; }

  void begin_block(int ring) {
    end_block();
    const int rings = std::min(kRingsOfBlock, octant_.rings - ring + 1);
    BlockFrame frame;
    frame.first_ring = ring;
    frame.first_post = first_needed(ring);
    frame.posts = std::min(last_needed(ring + rings - 1), octant_.last_post) - frame.first_post + 1;
    const BlockSteps steps{octant_.ring_step, octant_.post_step};
    rises_block_.resize(frame);
    rises_block_.read(octant_.rises_m, steps, rings);
    if (has_targets()) {
      targets_block_.resize(frame);
      targets_block_.read(octant_.targets_m, steps, rings);
    }
    if (results_.sights != nullptr) sights_block_.resize(frame);
  }

  // Writes the results of the block that ends. The posts of rings begin and end farther from the axis, ring by ring.
  void end_block() {
    if (written_.empty()) return;
    const BlockSteps steps{octant_.out_ring_step, octant_.out_post_step};
    std::size_t begin = 0;
    std::size_t end = 0;
    for (int post = written_.front().first; post <= written_.back().second; ++post) {
      while (begin < written_.size() && written_[begin].second < post) ++begin;
      while (end < written_.size() && written_[end].first <= post) ++end;
      sights_block_.write(results_.sights, steps, post, static_cast<int>(begin), static_cast<int>(end));
    }
    written_.clear();
  }

  void copy(const float* grid, RingBlock<float>& block, int ring, std::vector<float>& out) {
    const int last = std::min(last_needed(ring), octant_.last_post);
    float* const posts = out.data();
    if (is_across()) {
      const float* const line = block.ring(ring, first_);
      std::copy(line, line + (last - first_ + 1), posts);
    } else {
      const float* const line = grid + ring * octant_.ring_step;
      if (octant_.post_step == 1) {
        std::copy(line + first_, line + last + 1, posts);
      } else {
        for (int post = first_; post <= last; ++post) posts[post - first_] = line[-post];
      }
    }
    // Beyond the grid's edge the ground goes on as it is there, for the ray outside it that posts on the edge need.
    for (int post = last + 1; post <= last_needed(ring); ++post) posts[post - first_] = posts[last - first_];
  }

  void load(int ring, int from) {
    first_ = from;
    copy(octant_.rises_m, rises_block_, ring, fan_.rises_m);
    if (has_targets()) copy(octant_.targets_m, targets_block_, ring, targets_m_);
  }

  void decide(int ring) {
    const std::int64_t division = rays_.division;
    const bool ends_octant = rays_.last == rays_.division;
    const auto ceil_divide = [&](std::int64_t product) { return (product + division - 1) / division; };
    auto from = ceil_divide(std::int64_t{ring} * rays_.first);
    auto to = ceil_divide(std::int64_t{ring} * rays_.last) - 1 + (ends_octant ? 1 : 0);
    from = std::max<std::int64_t>(from, octant_.has_axis ? 0 : 1);
    to = std::min<std::int64_t>(to, std::min(octant_.last_post, octant_.has_diagonal ? ring : ring - 1));
    if (is_across() && results_.sights != nullptr) {
      written_.emplace_back(static_cast<int>(from), static_cast<int>(to));
    }
    if (from > to) return;
    RingPosts posts;
    posts.rays = count_;
    posts.posts = static_cast<int>(to - from) + 1;
    posts.ring = ring;
    posts.first = static_cast<int>(from) - first_;
    posts.start =
        static_cast<float>(static_cast<double>(from * division - std::int64_t{ring} * rays_.first) / ring);
    posts.step = static_cast<float>(rays_.division) / static_cast<float>(ring);
    posts.targets_m = has_targets() ? targets_m_.data() : fan_.rises_m.data();
    const int doubts = judge_posts(posts, ring > 1 ? kDoubt : 0, fan_);
    for (int n = 0; n < doubts; ++n) {
      const int number = fan_.doubts[static_cast<std::size_t>(n)];
      const auto at = static_cast<std::size_t>(posts.first + number);
      const float target = posts.targets_m[at];
      fan_.needed_m[at] = look_closer(posts, number, 0);
      if (target != kNoRise) fan_.sights[at] = target >= fan_.needed_m[at] ? Sight::seen : Sight::hidden;
    }
    if (results_.needed_m != nullptr) sharpen(posts);
    write(ring, posts);
  }

  // Computes what hidden targets need by the edges on their own lines. The verdict stays.
  void sharpen(const RingPosts& posts) {
    for (int number = 0; number < posts.posts; ++number) {
      const auto at = static_cast<std::size_t>(posts.first + number);
      if (fan_.sights[at] != Sight::hidden) continue;
      const float needed = look_closer(posts, number, kRidgeReach);
      if (needed > posts.targets_m[at]) fan_.needed_m[at] = needed;
    }
  }

  // Returns the rise that a target needs by the edges that the line to its post crosses at the ridges of the rays on its
  // sides, and at `reach` lines on both sides of these.
  float look_closer(const RingPosts& posts, int number, int reach) const {
    const int place = static_cast<int>(posts.start + static_cast<float>(number) * posts.step);
    const auto ray = static_cast<std::size_t>(std::min(place, count_ - 2));
    const float left = fan_.ridge[ray];
    const float right = fan_.ridge[ray + 1];
    const int post = first_ + posts.first + number;
    float horizon = kNoRise;
    for (int near = -reach; near <= reach; ++near) {
      horizon = std::max(horizon, tangent_at(left, near, posts.ring, post));
      if (right != left) horizon = std::max(horizon, tangent_at(right, near, posts.ring, post));
    }
    return horizon * static_cast<float>(posts.ring);
  }

  // Returns the tangent of the edge that the line to a post crosses `near` lines beyond a ridge of RayFan.
  float tangent_at(float ridge, int near, int ring, int post) const {
    const bool is_ring = ridge > 0;
    const int line = static_cast<int>(is_ring ? ridge : -ridge) + near;
    if (line <= 0 || line >= (is_ring ? ring : post)) return kNoRise;
    const double place = static_cast<double>(line) * (is_ring ? post : ring) / (is_ring ? ring : post);
    const int nearest = static_cast<int>(place);
    const float part = static_cast<float>(place - nearest);
    const std::ptrdiff_t step = is_ring ? octant_.post_step : octant_.ring_step;
    const float* const before =
        octant_.rises_m + line * (is_ring ? octant_.ring_step : octant_.post_step) + nearest * step;
    const float rise = part == 0 ? *before : *before + part * (before[step] - *before);
    return rise / static_cast<float>(is_ring ? line : place);
  }

  void write(int ring, const RingPosts& posts) {
    const std::ptrdiff_t step = octant_.out_post_step;
    const std::ptrdiff_t out = ring * octant_.out_ring_step + (first_ + posts.first) * step;
    const Sight* const sights = fan_.sights.data() + posts.first;
    const float* const needed = fan_.needed_m.data() + posts.first;
    if (results_.needed_m != nullptr) {
      float* const rises = results_.needed_m + out;
      for (int n = 0; n < posts.posts; ++n) rises[n * step] = sights[n] == Sight::seen ? kNoRise : needed[n];
    } else if (is_across()) {
      std::copy(sights, sights + posts.posts, sights_block_.ring(ring, first_ + posts.first));
    } else {
      if (step == 1) {
        std::copy(sights, sights + posts.posts, results_.sights + out);
      } else {
        for (int n = 0; n < posts.posts; ++n) results_.sights[out - n] = sights[n];
      }
    }
  }

  void raise(int ring) {
    RingCrossing crossing;
    crossing.rays = count_;
    crossing.ring = ring;
    const std::int64_t begin = std::int64_t{ring} * rays_.first - std::int64_t{first_} * rays_.division;
    crossing.start = static_cast<float>(static_cast<double>(begin) / rays_.division);
    crossing.step = static_cast<float>(ring) / static_cast<float>(rays_.division);
    crossing.first_post = first_;
    crossing.shift_before = first_ - first_before_;
    raise_horizons(crossing, fan_);
  }

  const Octant& octant_;
  const FanRays& rays_;
  const OctantResults& results_;
  int count_;
  RayFan fan_;
  std::vector<float> targets_m_;
  RingBlock<float> rises_block_;
  RingBlock<float> targets_block_;
  RingBlock<Sight> sights_block_;
  std::vector<std::pair<int, int>> written_;  // first and last posts of the rings of the block
  int first_ = 0;                             // post of the ring that is the first entry of the fan's
  int first_before_ = 0;
};

}  // namespace

std::vector<FanRays> divide(const Octant& octant) {
  std::vector<FanRays> fans;
  if (octant.rings < 1) return fans;
  const int division = std::max(octant.rings, kFewestRays);
  for (int first = 0; first < division; first += kRaysPerFan)
    fans.push_back({division, first, std::min(division, first + kRaysPerFan)});
  return fans;
}

void sweep(const Octant& octant, const FanRays& rays, const OctantResults& results) {
  Sweep(octant, rays, results).run();
}

}  // namespace vpe::map
