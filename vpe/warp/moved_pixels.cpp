#include "vpe/warp/moved_pixels.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <span>

#include "vpe/warp/block_kernel.h"

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
  exact_.shift_m = in_new(to.camera.position_m - from.camera.position_m);
  shift_ = exact_.shift_m;
  focal_ = static_cast<float>(focal);
  right_ = right;
  up_ = up;
  exact_.first = (0.5 - cx) * right + (cy - 0.5) * up + focal * forward;
  exact_.by_column = right;
  exact_.by_row = -up;
  exact_.focal = focal;
  first_ = exact_.first;
  const core::SubRectangle new_part = core::drawn_part(to);
  exact_.new_focal = core::focal_px(to);
  exact_.new_centre_px = {0.5 * to.width + to.principal_offset_px.x - new_part.x,
                          0.5 * to.height + to.principal_offset_px.y - new_part.y};
  new_focal_ = static_cast<float>(exact_.new_focal);
  new_cx_ = static_cast<float>(exact_.new_centre_px.x);
  new_cy_ = static_cast<float>(exact_.new_centre_px.y);
  borders_ = {focal * right + cx * forward, -focal * right + (part_.width - cx) * forward,
              -focal * up + cy * forward, focal * up + (part_.height - cy) * forward};
  for (std::size_t n = 0; n < borders_.size(); ++n) outside_m_[n] = -glm::dot(borders_[n], exact_.shift_m);
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

void MovedPixels::take(const Motion& motion, const core::Frame& frame, base::ThreadPool& pool) {
  width = motion.width();
  height = motion.height();
  const std::size_t count = frame.range_m.size() + kPad;
  for (std::vector<float>* member :
       {&first_inverse_depth, &x_px, &y_px, &parallax_x_px, &parallax_y_px, &inverse_depth})
    member->resize(count);
  word.resize(frame.colour.empty() ? 0 : count);
  constexpr int kRows = 16;
  pool.run(static_cast<std::size_t>((height + kRows - 1) / kRows), [&](std::size_t task) {
    const int first = static_cast<int>(task) * kRows;
    const auto row_size = static_cast<std::size_t>(width);
    for (int y = first; y < std::min(first + kRows, height); ++y) {
      const std::span<float> row(&first_inverse_depth[index(0, y)], row_size);
      motion.lengths().row(y, row);
      invert({&frame.range_m[index(0, y)], row_size}, row);
      if (!word.empty()) widen({&frame.colour[index(0, y)], row_size}, &word[index(0, y)]);
    }
  });
}

void MovedPixels::move(const Motion& motion, int x, int end_x, int y) {
  constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
  for (; x < end_x; ++x) {
    const std::size_t n = index(x, y);
    const glm::vec3 ray = motion.ray(x, y);
    // The ray is `focal` deep; a point at the range divides it.
    const float nearness = motion.focal() * first_inverse_depth[n];
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
}

}  // namespace vpe::warp
