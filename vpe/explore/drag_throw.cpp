#include "vpe/explore/drag_throw.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "vpe/explore/steer.h"

namespace vpe::explore {

namespace {

constexpr double kSameTime_s = 0.005;

}  // namespace

void DragSamples::add(double time_s, glm::dvec2 xy, const mars::Pose& pose) {
  if (!is_begun_) begun_xy_ = xy;
  is_begun_ = true;
  const bool replaces = samples_.size() > 1 && time_s - samples_.back().time_s < kSameTime_s;
  if (replaces)
    samples_.back() = {samples_.back().time_s, xy, pose};
  else
    samples_.push_back({time_s, xy, pose});
  std::erase_if(samples_, [time_s](const Sample& s) { return time_s - s.time_s > ThrowLimits::kOldest_s; });
}

std::optional<Motion> DragSamples::motion(double release_s, double image_rows) const {
  if (samples_.size() < 2) return std::nullopt;
  const Sample& last = samples_.back();
  if (release_s - last.time_s > ThrowLimits::kRest_s) return std::nullopt;
  const double scale = image_rows / 720.0;
  if (glm::length(last.xy - begun_xy_) < ThrowLimits::kShortest_px * scale) return std::nullopt;
  auto first = samples_.end() - 2;
  while (first != samples_.begin() && last.time_s - (first - 1)->time_s <= ThrowLimits::kWindow_s) --first;
  const double dt_s = last.time_s - first->time_s;
  if (!(dt_s >= kSameTime_s)) return std::nullopt;
  const double speed_px_s = glm::length(last.xy - first->xy) / dt_s;
  if (speed_px_s < ThrowLimits::kSlowest_px_s * scale) return std::nullopt;
  return Motion{first->pose, last.pose, dt_s};
}

mars::Pose thrown(const Motion& motion, double time_s, const TerrainQuery& ground) {
  const double left = 1.0 - std::clamp(time_s / ThrowLimits::kTime_s, 0.0, 1.0);
  const double ahead_s = ThrowLimits::kTime_s / 3.0 * (1.0 - left * left * left);
  mars::Pose pose = foreseen(motion, ahead_s).value_or(motion.now);
  pose.alt_m = motion.now.alt_m;
  pose.roll_deg = motion.now.roll_deg;
  return kept_clear(pose, ground);
}

}  // namespace vpe::explore
