#include "vpe/core/metrics.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "vpe/base/parallel.h"
#include "vpe/base/quantile.h"

namespace vpe::core {

namespace {

constexpr double kNotMeasured = std::numeric_limits<double>::quiet_NaN();

bool is_valid_range(float range_m) { return range_m > 0.0F; }
bool is_surface(float range_m) { return is_valid_range(range_m) && std::isfinite(range_m); }
bool is_sky(float range_m) { return range_m == std::numeric_limits<float>::infinity(); }

// A range image with its size.
struct RangePixels {
  std::span<const float> range_m;
  int width;
  int height;

  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
  }
  float at(int x, int y) const { return range_m[index(x, y)]; }
  bool contains(int x, int y) const { return x >= 0 && y >= 0 && x < width && y < height; }
};

RangePixels image_of(const View& view, std::span<const float> range_m, const char* name) {
  const glm::ivec2 size = drawn_size(view);
  const RangePixels image{range_m, size.x, size.y};
  if (range_m.size() != static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y)) {
    throw std::invalid_argument(std::string(name) + " has " + std::to_string(range_m.size()) +
                                " pixels, the view " + std::to_string(size.x) + "x" + std::to_string(size.y));
  }
  return image;
}

glm::dvec3 centre_ray(const View& view, int x, int y) {
  const SubRectangle part = drawn_part(view);
  return pixel_ray(view, part.x + x + 0.5, part.y + y + 0.5);
}

double distance_to_segment(const glm::dvec3& from, const glm::dvec3& to) {
  const glm::dvec3 along = to - from;
  const double length2 = glm::dot(along, along);
  const double s = length2 > 0.0 ? std::clamp(-glm::dot(from, along) / length2, 0.0, 1.0) : 0.0;
  return glm::length(from + along * s);
}

// The drawn image about one reference hit, in its pixel space with the hit at the origin.
class PixelSpace {
 public:
  PixelSpace(const RangePixels& drawn, int x, int y, double range_m, double focal)
      : drawn_(drawn), x_(x), y_(y), range_m_(range_m), focal_(focal) {}

  // Returns the distance to the nearest edge of the drawn net within `reach` columns and rows.
  double distance(int reach) const {
    double nearest = std::numeric_limits<double>::infinity();
    for (int dy = -reach; dy <= reach; ++dy) {
      for (int dx = -reach; dx <= reach; ++dx) {
        if (!drawn_.contains(x_ + dx, y_ + dy)) continue;
        const glm::dvec3 from = point(dx, dy);
        nearest = std::min(nearest, glm::length(from));
        for (const glm::ivec2 step : kForwardSteps) {
          const glm::ivec2 end(dx + step.x, dy + step.y);
          if (std::abs(end.x) > reach || end.y > reach || !drawn_.contains(x_ + end.x, y_ + end.y)) continue;
          nearest = std::min(nearest, distance_to_segment(from, point(end.x, end.y)));
        }
      }
    }
    return nearest;
  }

 private:
  // Half of the eight neighbours, so that each edge is measured once.
  static constexpr std::array<glm::ivec2, 4> kForwardSteps{{{1, 0}, {-1, 1}, {0, 1}, {1, 1}}};

  glm::dvec3 point(int dx, int dy) const {
    const float range_m = drawn_.at(x_ + dx, y_ + dy);
    const double nearness = is_surface(range_m) ? range_m_ / static_cast<double>(range_m) : 0.0;
    return {dx, dy, focal_ * (nearness - 1.0)};
  }

  const RangePixels& drawn_;
  int x_;
  int y_;
  double range_m_;
  double focal_;
};

// An edge outside a window of `reach` pixels is at least that far away, so a smaller distance is final.
double surface_shift(const RangePixels& drawn, int x, int y, float reference_m, double focal, int search) {
  const PixelSpace space(drawn, x, y, static_cast<double>(reference_m), focal);
  double shift = space.distance(1);
  for (int reach = 1; shift > reach && reach < search;) {
    reach = std::min(2 * reach, search);
    shift = space.distance(reach);
  }
  return shift;
}

double sky_shift(const RangePixels& drawn, int x, int y, int search) {
  double nearest = std::numeric_limits<double>::infinity();
  for (int reach = 0; reach <= search && nearest > reach; ++reach) {
    for (int dy = -reach; dy <= reach; ++dy) {
      for (int dx = -reach; dx <= reach; ++dx) {
        if (!drawn.contains(x + dx, y + dy) || is_surface(drawn.at(x + dx, y + dy))) continue;
        nearest = std::min(nearest, std::hypot(dx, dy));
      }
    }
  }
  return nearest;
}

bool is_inner(const RangePixels& image, int x, int y) {
  return x > 0 && y > 0 && x < image.width - 1 && y < image.height - 1;
}

template <class Predicate>
bool all_nine(const RangePixels& image, int x, int y, const Predicate& predicate) {
  if (x < 1 || y < 1 || x + 1 >= image.width || y + 1 >= image.height) return false;
  for (int dy = -1; dy <= 1; ++dy) {
    for (int dx = -1; dx <= 1; ++dx) {
      if (!predicate(image.at(x + dx, y + dy))) return false;
    }
  }
  return true;
}

nlohmann::ordered_json as_json(const ShiftSummary& s) {
  return {{"pixels", s.pixels},
          {"median_px", s.median_px},
          {"p90_px", s.p90_px},
          {"p99_px", s.p99_px},
          {"p999_px", s.p999_px},
          {"max_px", s.max_px},
          {"share_over_1px", s.share_over_1px},
          {"worst_x", s.worst_x},
          {"worst_y", s.worst_y}};
}

}  // namespace

std::vector<double> forward_shift_px(const View& view, std::span<const float> range_m,
                                     const SurfaceRadius& surface, const MetricOptions& options) {
  const RangePixels drawn = image_of(view, range_m, "the drawn image");
  const double focal = focal_px(view);
  std::vector<double> shift_px(range_m.size(), kNotMeasured);
  base::parallel_for(static_cast<std::size_t>(drawn.height), options.threads, [&](std::size_t row) {
    const int y = static_cast<int>(row);
    std::vector<std::size_t> pixels;
    std::vector<glm::dvec3> directions;
    std::vector<double> drawn_radius_m;
    for (int x = 0; x < drawn.width; ++x) {
      if (!is_surface(drawn.at(x, y))) continue;
      const glm::dvec3 point =
          view.camera.position_m + centre_ray(view, x, y) * static_cast<double>(drawn.at(x, y));
      pixels.push_back(drawn.index(x, y));
      drawn_radius_m.push_back(glm::length(point));
      directions.push_back(point / drawn_radius_m.back());
    }
    std::vector<double> radius_m(directions.size());
    surface(directions, radius_m);
    for (std::size_t n = 0; n < pixels.size(); ++n) {
      shift_px[pixels[n]] =
          std::abs(drawn_radius_m[n] - radius_m[n]) * focal / static_cast<double>(range_m[pixels[n]]);
    }
  });
  return shift_px;
}

std::vector<double> backward_shift_px(const View& view, std::span<const float> range_m,
                                      std::span<const float> reference_m, const MetricOptions& options) {
  const RangePixels drawn = image_of(view, range_m, "the drawn image");
  const RangePixels reference = image_of(view, reference_m, "the reference image");
  const double focal = focal_px(view);
  const int search = std::max(1, options.search_px);
  std::vector<double> shift_px(range_m.size(), kNotMeasured);
  base::parallel_for(static_cast<std::size_t>(drawn.height), options.threads, [&](std::size_t row) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < drawn.width; ++x) {
      const float hit_m = reference.at(x, y);
      if (!is_inner(drawn, x, y) || !is_valid_range(hit_m)) continue;
      shift_px[drawn.index(x, y)] =
          is_sky(hit_m) ? sky_shift(drawn, x, y, search) : surface_shift(drawn, x, y, hit_m, focal, search);
    }
  });
  return shift_px;
}

ShiftSummary summarize(std::span<const double> shift_px, int width) {
  std::vector<double> sorted;
  sorted.reserve(shift_px.size());
  std::copy_if(shift_px.begin(), shift_px.end(), std::back_inserter(sorted),
               [](double s) { return !std::isnan(s); });
  ShiftSummary summary;
  if (sorted.empty()) return summary;
  std::sort(sorted.begin(), sorted.end());
  summary.pixels = static_cast<std::int64_t>(sorted.size());
  summary.median_px = base::sorted_quantile_rank(sorted, 0.5);
  summary.p90_px = base::sorted_quantile_rank(sorted, 0.9);
  summary.p99_px = base::sorted_quantile_rank(sorted, 0.99);
  summary.p999_px = base::sorted_quantile_rank(sorted, 0.999);
  summary.max_px = sorted.back();
  const auto over = sorted.end() - std::upper_bound(sorted.begin(), sorted.end(), 1.0);
  summary.share_over_1px = static_cast<double>(over) / static_cast<double>(sorted.size());
  const auto worst =
      static_cast<int>(std::find(shift_px.begin(), shift_px.end(), summary.max_px) - shift_px.begin());
  summary.worst_x = worst % width;
  summary.worst_y = worst / width;
  return summary;
}

ImageErrors compare_to_reference(const View& view, std::span<const float> range_m,
                                 std::span<const float> reference_m, const SurfaceRadius& surface,
                                 const MetricOptions& options) {
  const RangePixels drawn = image_of(view, range_m, "the drawn image");
  const RangePixels reference = image_of(view, reference_m, "the reference image");
  ImageErrors errors;
  errors.forward = summarize(forward_shift_px(view, range_m, surface, options), drawn.width);
  errors.backward = summarize(backward_shift_px(view, range_m, reference_m, options), drawn.width);
  for (int y = 0; y < drawn.height; ++y) {
    for (int x = 0; x < drawn.width; ++x) {
      const float range = drawn.at(x, y);
      if (!is_valid_range(range)) ++errors.invalid;
      if (is_sky(range) && all_nine(reference, x, y, is_surface)) ++errors.sky_for_ground;
      if (is_surface(range) && all_nine(reference, x, y, is_sky)) ++errors.false_surface;
    }
  }
  return errors;
}

std::string to_json(const ImageErrors& errors) {
  nlohmann::ordered_json json;
  json["forward"] = as_json(errors.forward);
  json["backward"] = as_json(errors.backward);
  json["holes"] = errors.sky_for_ground;
  json["false_surface"] = errors.false_surface;
  json["invalid"] = errors.invalid;
  return json.dump(2) + "\n";
}

HorizonErrors check_horizon(const View& view, std::span<const float> range_m, double lowest_radius_m,
                            double highest_radius_m) {
  const RangePixels drawn = image_of(view, range_m, "the drawn image");
  const double camera_distance_m = glm::length(view.camera.position_m);
  const glm::dvec3 down =
      camera_distance_m > 0.0 ? -view.camera.position_m / camera_distance_m : glm::dvec3(0, 0, 1);
  constexpr double kTolerance_rad = 1e-12;
  // A ray meets a sphere if its angle from straight down is at most that of the sphere's outline.
  const auto outline_rad = [camera_distance_m](double radius_m) {
    if (camera_distance_m <= radius_m) return 2.0 * mars::kPi;
    // asin(radius / distance) by its tangent, which does not cancel close to the sphere.
    return std::atan2(radius_m, std::sqrt((camera_distance_m - radius_m) * (camera_distance_m + radius_m)));
  };
  const double lowest_outline_rad = outline_rad(lowest_radius_m);
  const double highest_outline_rad = outline_rad(highest_radius_m);
  HorizonErrors errors;
  for (int y = 0; y < drawn.height; ++y) {
    for (int x = 0; x < drawn.width; ++x) {
      const double angle_rad = mars::angle_between_rad(down, centre_ray(view, x, y));
      if (!is_surface(drawn.at(x, y)) && angle_rad < lowest_outline_rad - kTolerance_rad) ++errors.sky_below;
      if (is_surface(drawn.at(x, y)) && angle_rad > highest_outline_rad + kTolerance_rad)
        ++errors.surface_above;
    }
  }
  return errors;
}

}  // namespace vpe::core
