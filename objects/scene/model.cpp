#include "objects/scene/model.h"

#include <algorithm>
#include <glm/ext/scalar_constants.hpp>
#include <stdexcept>

#include "objects/model/surface_sample.h"
#include "objects/sticks/build_sticks.h"
#include "objects/sticks/stick_look.h"

namespace objects {

namespace {

glm::dvec3 corner(const Mesh& mesh, std::size_t triangle, int k) {
  return glm::dvec3(mesh.positions_m[mesh.triangles[triangle][k]]);
}

}  // namespace

Model::Model(std::string name, std::vector<Level> levels) : name_(std::move(name)), levels_(std::move(levels)) {
  if (levels_.empty()) throw std::invalid_argument("a model needs a level");
  Mesh& finest = levels_.front().mesh;
  for (Texture& t : finest.textures) textures_.emplace_back(std::move(t));
  finest.textures.clear();
  ball_ = bounding_ball(finest);
  for (const Level& level : levels_) {
    errors_m_.push_back(level.geometric_error_m);
    for (const glm::vec3& p : level.mesh.positions_m)
      ball_.radius_m = std::max(ball_.radius_m, glm::distance(p, ball_.centre_m) * 1.000001F);
  }
  double area = 0;
  double opaque_area = 0;
  glm::dvec3 colour(0);
  for (std::size_t n = 0; n < finest.triangles.size(); ++n) {
    const glm::dvec3 a = corner(finest, n, 0);
    const double size = 0.5 * glm::length(glm::cross(corner(finest, n, 1) - a, corner(finest, n, 2) - a));
    const glm::vec4 c =
        surface_colour(finest, textures_, static_cast<std::uint32_t>(n), {1.0F / 3, 1.0F / 3}, 1e9F);
    const double opacity = static_cast<double>(c.w) / 255;
    colour += size * opacity * glm::dvec3(c);
    opaque_area += size * opacity;
    area += size;
  }
  if (opaque_area > 0) mean_colour_ = colour / opaque_area;
  mean_opacity_ = area > 0 ? opaque_area / area : 0;
  is_see_through_ = std::ranges::any_of(finest.material_table,
                                        [](const Material& m) { return m.alpha == AlphaMode::kBlend; });
  const double disc =
      glm::pi<double>() * static_cast<double>(ball_.radius_m) * static_cast<double>(ball_.radius_m);
  mean_silhouette_m2_ = std::min(area / 4, disc);
}

// The mean over three directions stands for that over all.
Model::Model(std::string name, std::shared_ptr<const StickModel> sticks)
    : name_(std::move(name)), sticks_(std::move(sticks)) {
  if (sticks_ == nullptr || sticks_->levels().empty()) throw std::invalid_argument("a model needs a level");
  // Levels that would make the ball much larger are left out.
  constexpr double kMostGrowth = 0.15;
  ball_ = StickModel({sticks_->levels().front()}).ball();
  const auto radius_m = static_cast<double>(ball_.radius_m);
  for (std::size_t n = 0; n < sticks_->levels().size(); ++n) {
    const double error_of_level_m = stick_error_m(*sticks_, n);
    if (error_of_level_m > kMostGrowth * radius_m) break;
    errors_m_.push_back(error_of_level_m);
  }
  ball_.radius_m = static_cast<float>((radius_m + errors_m_.back()) * (1 + 1e-6));
  const StickLook look = look_of(sticks_->levels().front());
  const double disc =
      glm::pi<double>() * static_cast<double>(ball_.radius_m) * static_cast<double>(ball_.radius_m);
  mean_silhouette_m2_ = std::min((look.area_m2.x + look.area_m2.y + look.area_m2.z) / 3, disc);
  mean_colour_ = look.colour;
  mean_opacity_ = look.opacity;
  is_see_through_ = look.opacity < 1;
}

Model::Model(std::string name, std::shared_ptr<const VolumeModel> volume)
    : name_(std::move(name)), volume_(std::move(volume)) {
  if (volume_ == nullptr) throw std::invalid_argument("a model needs a level");
  for (std::size_t n = 0; n < volume_->levels().size(); ++n) errors_m_.push_back(volume_->level_error_m(n));
  ball_ = volume_->ball();
  const Rgba& colour = volume_->colour();
  mean_colour_ = {colour.r, colour.g, colour.b};
  mean_silhouette_m2_ = volume_->look().silhouette_m2;
  mean_opacity_ = volume_->look().opacity;
  is_see_through_ = true;
}

std::size_t Model::level_within(double geometric_error_m) const {
  std::size_t best = 0;
  for (std::size_t n = 1; n < errors_m_.size(); ++n) {
    if (errors_m_[n] <= geometric_error_m) best = n;
  }
  return best;
}

std::size_t Model::bytes() const {
  std::size_t sum = 0;
  for (const Level& level : levels_) sum += level.mesh.bytes() + level.tree.bytes();
  for (const TexturePyramid& t : textures_) sum += t.bytes();
  return sum + (sticks_ ? sticks_->bytes() : 0) + (volume_ ? volume_->bytes() : 0);
}

}  // namespace objects
