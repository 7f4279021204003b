#include "objects/draw/volume_light.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <limits>

namespace objects {

namespace {

constexpr double kPosts_px = 4;  // of the light's lattice in the image
constexpr int kLeastLightSide = 5;
constexpr double kGroundPosts = 8;  // along the longest side
constexpr std::size_t kPostsOfItem = 256;

// Posts of one volume, as work items.
struct LightItem {
  const PlacedObject* object;
  VolumeLight* light;
  const VolumeLight* ground;
  std::size_t begin;
  std::size_t end;
};

glm::dvec3 body_place(const PlacedObject& o, const glm::dvec3& place_m) {
  return o.position_m + static_cast<double>(o.scale) * (o.to_body * place_m);
}

}  // namespace

VolumeLight::VolumeLight(const glm::dvec3& low_m, const glm::dvec3& high_m, double spacing_m) : low_m_(low_m) {
  const glm::dvec3 size_m = high_m - low_m;
  // As fine as the number of posts allows.
  const double least_m = std::cbrt(size_m.x * size_m.y * size_m.z / kMostPosts);
  double step_m = std::max(spacing_m, least_m);
  const auto side = [&](int k) {
    return std::max(kLeastLightSide, static_cast<int>(std::min(1e6, std::ceil(size_m[k] / step_m))) + 1);
  };
  while (static_cast<double>(side(0)) * side(1) * side(2) > kMostPosts) step_m *= 1.1;
  std::size_t count = 1;
  for (int k = 0; k < 3; ++k) {
    sides_[static_cast<std::size_t>(k)] = side(k);
    step_m_[k] = size_m[k] / (side(k) - 1);
    count *= static_cast<std::size_t>(side(k));
  }
  posts_.assign(count, 1.0F);
}

glm::dvec3 VolumeLight::place_m(std::size_t post) const {
  const auto nx = static_cast<std::size_t>(sides_[0]);
  const auto ny = static_cast<std::size_t>(sides_[1]);
  const glm::dvec3 at(static_cast<double>(post % nx), static_cast<double>(post / nx % ny),
                      static_cast<double>(post / nx / ny));
  return low_m_ + at * step_m_;
}

float VolumeLight::at(const glm::dvec3& place_m) const {
  const glm::dvec3 place = (place_m - low_m_) / step_m_;
  int cell[3];
  float share[3];
  for (int k = 0; k < 3; ++k) {
    const int last = sides_[static_cast<std::size_t>(k)] - 1;
    const double p = std::clamp(place[k], 0.0, static_cast<double>(last));
    cell[k] = std::min(static_cast<int>(p), last - 1);
    share[k] = static_cast<float>(p - cell[k]);
  }
  const auto nx = static_cast<std::size_t>(sides_[0]);
  const std::size_t plane = nx * static_cast<std::size_t>(sides_[1]);
  const float* p = posts_.data() + static_cast<std::size_t>(cell[2]) * plane +
                   static_cast<std::size_t>(cell[1]) * nx + static_cast<std::size_t>(cell[0]);
  const auto row = [&](const float* r) { return r[0] + share[0] * (r[1] - r[0]); };
  const auto layer = [&](const float* l) {
    const float near = row(l);
    return near + share[1] * (row(l + nx) - near);
  };
  const float below = layer(p);
  return below + share[2] * (layer(p + plane) - below);
}

VolumeLights::VolumeLights(const ObjectRays& rays, const SunGrid& before_sun, const ImageLight& light,
                           const ViewCone& cone, vpe::base::ThreadPool& pool) {
  std::vector<PlacedObject> seen = rays.in_cone(cone, std::numeric_limits<double>::infinity());
  std::erase_if(seen, [](const PlacedObject& o) { return o.volume == nullptr || !o.by_rays; });
  std::map<std::uint32_t, VolumeLight> ground;
  std::vector<LightItem> ground_items;
  std::vector<LightItem> items;
  const auto add = [&](std::vector<LightItem>& list, const PlacedObject& o, VolumeLight& of,
                       const VolumeLight* before) {
    for (std::size_t n = 0; n < of.size(); n += kPostsOfItem)
      list.push_back({&o, &of, before, n, std::min(of.size(), n + kPostsOfItem)});
  };
  for (const PlacedObject& o : seen) {
    const glm::dvec3 low_m(o.model->volume()->low_m());
    const glm::dvec3 high_m(o.model->volume()->high_m());
    const glm::dvec3 size_m = high_m - low_m;
    const double longest_m = std::max({size_m.x, size_m.y, size_m.z});
    const double spacing_m = kPosts_px * 2 * o.ball_radius_m / std::max(1.0, o.diameter_px);
    VolumeLight& own = lights_.try_emplace(o.instance, low_m, high_m, spacing_m).first->second;
    const VolumeLight* before = nullptr;
    if (light.ground != nullptr) {
      VolumeLight& coarse =
          ground.try_emplace(o.instance, low_m, high_m, longest_m / kGroundPosts).first->second;
      add(ground_items, o, coarse, nullptr);
      before = &coarse;
    }
    add(items, o, own, before);
  }
  pool.run(ground_items.size(), [&](std::size_t n) {
    const LightItem& item = ground_items[n];
    for (std::size_t post = item.begin; post < item.end; ++post) {
      const glm::dvec3 place_m = body_place(*item.object, item.light->place_m(post));
      item.light->post(post) = light.ground->sees_sun(place_m) ? 1.0F : 0.0F;
    }
  });
  pool.run(items.size(), [&](std::size_t n) {
    const LightItem& item = items[n];
    for (std::size_t post = item.begin; post < item.end; ++post) {
      const glm::dvec3 local_m = item.light->place_m(post);
      const float share = item.ground != nullptr ? item.ground->at(local_m) : 1.0F;
      const glm::dvec3 place_m = body_place(*item.object, local_m);
      item.light->post(post) =
          share > 0 ? share * static_cast<float>(sun_above(light, before_sun, place_m)) : 0.0F;
    }
  });
}

const VolumeLight* VolumeLights::find(std::uint32_t instance) const {
  const auto at = lights_.find(instance);
  return at == lights_.end() ? nullptr : &at->second;
}

bool has_volumes(const Scene& scene) {
  return std::any_of(scene.models().begin(), scene.models().end(),
                     [](const auto& model) { return model->volume() != nullptr; });
}

}  // namespace objects
