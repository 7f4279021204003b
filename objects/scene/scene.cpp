#include "objects/scene/scene.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <stdexcept>
#include <tuple>

namespace objects {

namespace {

bool is_placed(const Instance& i) {
  const auto finite = [](auto... x) { return (std::isfinite(x) && ...); };
  return finite(i.position_m.x, i.position_m.y, i.position_m.z, i.rotation.w, i.rotation.x, i.rotation.y,
                i.rotation.z, i.scale) &&
         i.scale > 0;
}

auto sort_key(const Instance& i) {
  return std::tuple(i.position_m.x, i.position_m.y, i.position_m.z, i.model, i.scale, i.rotation.w,
                    i.rotation.x, i.rotation.y, i.rotation.z, i.is_mirrored, i.name);
}

// Widens a ball's radius by the rounding of its computation.
double widened(double radius_m, const glm::dvec3& centre_m) {
  constexpr double kRounding = 1e-15;
  return radius_m * (1 + 1e-12) + kRounding * glm::length(centre_m);
}

SceneBall joined(const SceneBall& a, const SceneBall& b) {
  const glm::dvec3 between = b.centre_m - a.centre_m;
  const double distance = glm::length(between);
  const double largest = std::max(a.largest_m, b.largest_m);
  if (distance + b.radius_m <= a.radius_m) return {a.centre_m, a.radius_m, largest};
  if (distance + a.radius_m <= b.radius_m) return {b.centre_m, b.radius_m, largest};
  const double radius = 0.5 * (distance + a.radius_m + b.radius_m);
  const glm::dvec3 centre = a.centre_m + between * ((radius - a.radius_m) / distance);
  return {centre, widened(radius, centre), largest};
}

// Sorts a range along the longest side of its box, and returns its middle.
std::size_t halve(std::vector<Instance>& instances, std::size_t begin, std::size_t end) {
  glm::dvec3 low(instances[begin].position_m);
  glm::dvec3 high = low;
  for (std::size_t n = begin; n < end; ++n) {
    low = glm::min(low, instances[n].position_m);
    high = glm::max(high, instances[n].position_m);
  }
  const glm::dvec3 size = high - low;
  const int axis = size.x >= size.y ? (size.x >= size.z ? 0 : 2) : (size.y >= size.z ? 1 : 2);
  const auto at = [&](std::size_t n) { return instances.begin() + static_cast<std::ptrdiff_t>(n); };
  std::sort(at(begin), at(end), [axis](const Instance& a, const Instance& b) {
    if (a.position_m[axis] != b.position_m[axis]) return a.position_m[axis] < b.position_m[axis];
    return sort_key(a) < sort_key(b);
  });
  return begin + (end - begin) / 2;
}

}  // namespace

Scene::Scene(Models models, std::vector<Instance> instances, std::vector<std::string> names)
    : models_(std::move(models)), names_(std::move(names)) {
  if (names_.empty() || !names_.front().empty())
    throw std::invalid_argument("names[0] of a scene must be \"\"");
  for (const Instance& i : instances) {
    if (i.model >= models_.size() || models_[i.model] == nullptr || i.name >= names_.size())
      throw std::invalid_argument("an object names a model that the scene has not");
    if (!is_placed(i)) throw std::invalid_argument("an object has no finite place or size");
  }
  if (!instances.empty()) build(instances);
}

void Scene::build(std::vector<Instance>& instances) {
  // First the order, which is a function of the set, then the balls from the leaves up.
  const auto order = [&](const auto& self, std::size_t begin, std::size_t end) -> void {
    const std::size_t at = nodes_.size();
    nodes_.push_back(
        {{}, static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(end), 0, end - begin <= kLeaf});
    const std::size_t middle = halve(instances, begin, end);
    if (end - begin > kLeaf) {
      self(self, begin, middle);
      self(self, middle, end);
    }
    nodes_[at].skip = static_cast<std::uint32_t>(nodes_.size());
  };
  order(order, 0, instances.size());
  nodes_.shrink_to_fit();
  for (const Instance& i : instances) kinds_.push_back({i.model, i.name, i.is_mirrored});
  std::sort(kinds_.begin(), kinds_.end());
  kinds_.erase(std::unique(kinds_.begin(), kinds_.end()), kinds_.end());
  kinds_.shrink_to_fit();
  packed_.reserve(instances.size());
  for (const Instance& i : instances) {
    const auto kind = std::lower_bound(kinds_.begin(), kinds_.end(), Kind{i.model, i.name, i.is_mirrored});
    packed_.push_back({i.position_m, i.rotation, i.scale, static_cast<std::uint32_t>(kind - kinds_.begin())});
  }
  // Descendants come after their node.
  for (std::size_t n = nodes_.size(); n-- > 0;) {
    Node& node = nodes_[n];
    if (node.is_leaf) {
      node.ball = ball(node.begin);
      for (std::uint32_t i = node.begin + 1; i < node.end; ++i) node.ball = joined(node.ball, ball(i));
    } else {
      node.ball = joined(nodes_[n + 1].ball, nodes_[nodes_[n + 1].skip].ball);
    }
  }
}

Instance Scene::instance(std::uint32_t n) const {
  const Packed& p = packed_[n];
  const Kind& kind = kinds_[p.kind];
  return {p.position_m, p.rotation, p.scale, kind.model, kind.name, kind.is_mirrored};
}

double Scene::clear_distance_m(const glm::dvec3& place_m, double error_share) const {
  double clear_m = std::numeric_limits<double>::infinity();
  const auto distance_m = [&](const SceneBall& ball) {
    return std::max(glm::distance(place_m, ball.centre_m) - ball.radius_m, 0.0);
  };
  visit([&](const SceneBall& ball) { return distance_m(ball) < clear_m; },
        [&](std::uint32_t n) {
          const double to_ball_m = distance_m(ball(n));
          clear_m =
              std::min(clear_m, std::max(to_ball_m, clear_of_mesh_m(n, place_m, error_share * to_ball_m)));
        });
  return clear_m;
}

double Scene::clear_of_mesh_m(std::uint32_t n, const glm::dvec3& place_m, double geometric_error_m) const {
  const Instance i = instance(n);
  const Model& model = *models_[i.model];
  if (model.levels().empty()) return 0;
  const auto scale = static_cast<double>(i.scale);
  glm::dvec3 place = glm::conjugate(glm::dquat(i.rotation)) * (place_m - i.position_m) / scale;
  if (i.is_mirrored) place.x = -place.x;
  // The rotation's rounding turns places.
  constexpr double kRotationError = 4e-7;
  const double coarsest_m = scale * model.level_error_m(model.levels().size() - 1);
  const double off_m = std::min(geometric_error_m, coarsest_m) + kRotationError * scale * glm::length(place);
  return std::max(scale * model.levels().front().tree.clear_distance_m(place) - off_m, 0.0);
}

SceneBall Scene::ball(std::uint32_t n) const {
  const Instance i = instance(n);
  const Ball& model = models_[i.model]->ball();
  glm::dvec3 centre(model.centre_m);
  if (i.is_mirrored) centre.x = -centre.x;
  const glm::dvec3 at = i.position_m + static_cast<double>(i.scale) * (glm::dquat(i.rotation) * centre);
  // The rotation's rounding turns the ball's centre.
  constexpr double kRotationError = 4e-7;
  const double reach = static_cast<double>(i.scale) * glm::length(centre);
  const double radius =
      widened(static_cast<double>(i.scale) * static_cast<double>(model.radius_m) + kRotationError * reach, at);
  return {at, radius, radius};
}

std::size_t Scene::bytes() const {
  return packed_.capacity() * sizeof(Packed) + kinds_.capacity() * sizeof(Kind) +
         nodes_.capacity() * sizeof(Node);
}

}  // namespace objects
