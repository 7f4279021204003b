#include "objects/draw/volume_shader.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "vpe/core/appearance/shading.h"

namespace objects {

namespace {

// What lies behind so little light changes no colour by 1.
constexpr double kLeastThrough = 1.0 / 1024;
constexpr double kLeastOpacity = 1.0 / 512;  // that shows

// Returns exp(-depth) within 1e-8.
double transmitted(double depth) {
  if (depth > 0.05) return std::exp(-depth);
  return 1 - depth * (1 - depth / 2 * (1 - depth / 3 * (1 - depth / 4)));
}

}  // namespace

VolumeShader::VolumeShader(const ObjectShader& surfaces, const VolumeLights& lights,
                           const std::vector<PlacedObject>& objects, const ImageLight& light)
    : surfaces_(surfaces),
      lights_(lights),
      objects_(objects),
      light_(light),
      is_lit_(is_lit(light.request.settings)),
      has_shown_(objects.size(), 0) {}

// With `out`, marks the range where its opacity passes a half; what it has lies before.
VolumeShader::Veil VolumeShader::veil_of(const VolumeCrossing& crossing, double begin_m, double end_m,
                                         ObjectColour* out) {
  const PlacedObject& o = objects_[crossing.object];
  const VolumeLight* sun = is_lit_ ? lights_.find(o.instance) : nullptr;
  const vpe::core::SettingsValues& settings = light_.request.settings;
  const double before = out != nullptr ? 1 - out->over.w : 1;
  Veil veil;
  double through = 1;
  double lit = 0;
  double range_sum = 0;
  // Light is asked for twice in a spacing of its posts.
  const double light_step = sun != nullptr ? 0.5 * sun->spacing_m() / glm::length(crossing.ray.direction) : 0.0;
  double unlit = 0;  // taken, but not yet lit
  double unlit_t = 0;
  double unlit_begin = 0;
  const auto add_light = [&] {
    if (!(unlit > 0)) return;
    const glm::dvec3 place_m = crossing.ray.origin_m + unlit_t / unlit * crossing.ray.direction;
    const double incidence = sun != nullptr ? static_cast<double>(sun->at(place_m)) : 1;
    lit += unlit * vpe::core::light(settings.sun_ambient, settings.sun_diffuse, incidence);
    unlit = unlit_t = 0;
  };
  march(*o.volume, crossing.ray, begin_m - crossing.begin_m, end_m - crossing.begin_m,
        [&](const VolumeStep& step) {
          const double left = through * transmitted(step.depth);
          const double taken = through - left;
          const double middle = 0.5 * (step.begin + step.end);
          range_sum += taken * (crossing.begin_m + middle);
          if (is_lit_) {
            if (!(unlit > 0)) unlit_begin = step.begin;
            unlit += taken;
            unlit_t += taken * middle;
            if (step.end - unlit_begin >= light_step) add_light();
          }
          if (out != nullptr && before * through > 0.5 && before * left <= 0.5) {
            const double share = std::log(2 * before * through) / step.depth;
            out->range_m =
                std::min(out->range_m, crossing.begin_m + step.begin + share * (step.end - step.begin));
          }
          veil.depth += step.depth;
          through = left;
          return before * through > kLeastThrough;
        });
  add_light();
  if (through < 1) {
    veil.lit = is_lit_ ? lit / (1 - through) : 1;
    veil.range_m = range_sum / (1 - through);
  }
  return veil;
}

glm::dvec3 VolumeShader::colour_of(const PlacedObject& o, const ObjectRay& ray, const Veil& veil) const {
  const vpe::core::SettingsValues& settings = light_.request.settings;
  if (draws_lines(settings.mode)) return kLineColour;
  glm::dvec3 colour = settings.mode == vpe::core::Mode::kLit ? settings.plain_ground : o.model->mean_colour();
  colour *= veil.lit;
  const Haze haze = haze_at(light_, ray.direction, veil.range_m);
  return glm::min(colour, 255.0) * haze.transmitted + haze.added;
}

bool VolumeShader::lay(const ObjectRay& ray, const VolumeStretch& stretch, ObjectColour& out) {
  const bool is_alone = stretch.crossings.size() == 1;
  glm::dvec3 colour(0);
  double depth = 0;
  for (const std::uint32_t n : stretch.crossings) {
    const VolumeCrossing& crossing = crossings_[n];
    const Veil veil = veil_of(crossing, stretch.begin_m, stretch.end_m, is_alone ? &out : nullptr);
    if (!(veil.depth > 0)) continue;
    colour += veil.depth * colour_of(objects_[crossing.object], ray, veil);
    depth += veil.depth;
    if ((1 - out.over.w) * (1 - std::exp(-veil.depth)) > kLeastOpacity) has_shown_[crossing.object] = 1;
  }
  if (!(depth > 0)) return true;
  const double before = 1 - out.over.w;
  const double share = before * (1 - std::exp(-depth));
  out.over += glm::dvec4(colour / depth * share, share);
  if (!is_alone && before > 0.5 && before - share <= 0.5) {
    const double at = std::log(2 * before) / depth;
    out.range_m = std::min(out.range_m, stretch.begin_m + at * (stretch.end_m - stretch.begin_m));
  }
  return 1 - out.over.w > kLeastThrough;
}

ObjectColour VolumeShader::colour(const ObjectRay& ray, const RayResult& seen,
                                  std::span<const std::uint32_t> volumes, double until_m) {
  enter_volumes(objects_, volumes, ray, until_m, crossings_);
  if (crossings_.empty()) return surfaces_.colour(ray, seen);
  ObjectColour out;
  in_order(
      seen, crossings_,
      [&](const ObjectHit& hit) {
        surfaces_.lay(ray, hit, out);
        return 1 - out.over.w > kLeastThrough;
      },
      [&](const VolumeStretch& stretch) { return lay(ray, stretch, out); });
  return out;
}

}  // namespace objects
