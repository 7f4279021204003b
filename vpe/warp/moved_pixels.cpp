#include "vpe/warp/moved_pixels.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

namespace vpe::warp {

Motion::Motion(const core::View& from, const core::View& to)
    : part_(core::drawn_part(from)), lengths_(from), new_lengths_(to) {
  const mars::Axes& a = from.camera.axes;
  const mars::Axes& b = to.camera.axes;
  const auto in_new = [&b](const glm::dvec3& v) {
    return glm::dvec3(glm::dot(v, b.right), glm::dot(v, b.up), glm::dot(v, b.forward));
  };
  const glm::dvec3 right = in_new(a.right);
  const glm::dvec3 up = in_new(a.up);
  const glm::dvec3 forward = in_new(a.forward);
  const double focal = core::focal_px(from);
  const double cx = 0.5 * from.width + from.principal_offset_px.x - part_.x;
  const double cy = 0.5 * from.height + from.principal_offset_px.y - part_.y;
  shift_m_ = in_new(to.camera.position_m - from.camera.position_m);
  shift_ = shift_m_;
  focal_ = static_cast<float>(focal);
  right_ = right;
  up_ = up;
  first_ = (0.5 - cx) * right + (cy - 0.5) * up + focal * forward;
  const core::SubRectangle new_part = core::drawn_part(to);
  new_focal_ = static_cast<float>(core::focal_px(to));
  new_cx_ = static_cast<float>(0.5 * to.width + to.principal_offset_px.x - new_part.x);
  new_cy_ = static_cast<float>(0.5 * to.height + to.principal_offset_px.y - new_part.y);
  borders_ = {focal * right + cx * forward, -focal * right + (part_.width - cx) * forward,
              -focal * up + cy * forward, focal * up + (part_.height - cy) * forward};
  for (std::size_t n = 0; n < borders_.size(); ++n) outside_m_[n] = -glm::dot(borders_[n], shift_m_);
}

double Motion::entry_m(int x, int y) const {
  const auto f = static_cast<double>(new_focal_);
  const glm::dvec3 ray((x + 0.5 - static_cast<double>(new_cx_)) / f,
                       (static_cast<double>(new_cy_) - y - 0.5) / f, 1);
  double depth_m = 0;
  for (std::size_t n = 0; n < borders_.size(); ++n) {
    if (outside_m_[n] <= 0) continue;
    const double turns_in = glm::dot(borders_[n], ray);
    depth_m =
        turns_in > 0 ? std::max(depth_m, outside_m_[n] / turns_in) : std::numeric_limits<double>::infinity();
  }
  return depth_m == 0 ? 0 : depth_m * glm::length(ray);
}

void MovedPixels::move(const Motion& motion, const core::Frame& frame, base::ThreadPool& pool) {
  width = motion.width();
  height = motion.height();
  for (std::vector<float>* member : {&x_px, &y_px, &parallax_x_px, &parallax_y_px, &inverse_depth})
    member->resize(frame.range_m.size());
  constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
  pool.run(static_cast<std::size_t>(height), [&](std::size_t row) {
    const int y = static_cast<int>(row);
    std::vector<float> length(static_cast<std::size_t>(width));
    motion.lengths().row(y, length);
    const std::size_t first = index(0, y);
    const float focal = motion.focal();
    for (int x = 0; x < width; ++x) {
      const std::size_t n = first + static_cast<std::size_t>(x);
      const float range = frame.range_m[n];
      const glm::vec3 ray = motion.ray(x, y);
      // The ray is `focal` deep; a point at the range divides it.
      const float nearness = range > 0 ? focal * length[static_cast<std::size_t>(x)] / range : kNone;
      const glm::vec3 point = motion.moved(ray, nearness);
      const glm::vec2 xy = motion.place(point);
      const glm::vec2 far = motion.place(ray);
      const bool is_ahead = motion.is_ahead(point);
      const bool has_parallax = nearness > 0 && motion.is_ahead(ray);
      x_px[n] = is_ahead ? xy.x : kNone;
      y_px[n] = is_ahead ? xy.y : kNone;
      parallax_x_px[n] = has_parallax ? xy.x - far.x : 0;
      parallax_y_px[n] = has_parallax ? xy.y - far.y : 0;
      inverse_depth[n] = nearness / point.z;
    }
  });
}

}  // namespace vpe::warp
