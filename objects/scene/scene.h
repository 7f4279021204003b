// All objects that stand on a planet at one time, in a tree of balls.
//
// Typical usage:
//   const Scene scene(models, instances, names);
//   scene.visit([&](const SceneBall& ball) { return overlaps(ball); },
//               [&](std::uint32_t n) { draw(scene.instance(n)); });
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "objects/scene/instance.h"
#include "objects/scene/model.h"

namespace objects {

// A ball in the body-fixed frame around instances or around one.
struct SceneBall {
  glm::dvec3 centre_m{0, 0, 0};
  double radius_m = 0;
  double largest_m = 0;  // radius of the largest instance in it
};

// Bounds what an instance takes in a scene of many, with its share of the tree.
inline constexpr std::size_t kMostBytesOfInstance = 64;

// Immutable. Any thread may call any member.
class Scene {
 public:
  using Models = std::vector<std::shared_ptr<const Model>>;

  Scene() = default;
  // Instances are sorted, so that a scene does not depend on their order. names[0] must be "". Throws
  // std::invalid_argument if an instance names a model or a name that is not there, or is placed nowhere (not finite).
  Scene(Models models, std::vector<Instance> instances, std::vector<std::string> names = {""});

  const Models& models() const { return models_; }
  std::uint32_t size() const { return static_cast<std::uint32_t>(packed_.size()); }
  Instance instance(std::uint32_t n) const;
  const std::vector<std::string>& names() const { return names_; }
  bool is_empty() const { return packed_.empty(); }

  // Returns the ball around an instance.
  SceneBall ball(std::uint32_t instance) const;
  // Returns the ball around all of them.
  SceneBall ball() const { return nodes_.empty() ? SceneBall{} : nodes_.front().ball; }

  // Returns a distance from a place within which there is no object; infinity if there are none. Of meshes it is that to
  // boxes of a few triangles, of other models that to their balls. Levels may be used whose errors are up to `error_share`
  // of the distance of their balls.
  double clear_distance_m(const glm::dvec3& place_m, double error_share) const;

  // Calls leaf(n) for each instance whose own ball and all balls above it enter(ball) accepts, in ascending order.
  template <class Enter, class Leaf>
  void visit(const Enter& enter, const Leaf& leaf) const;

  // Bytes of instances and tree, without models.
  std::size_t bytes() const;

 private:
  static constexpr std::uint32_t kLeaf = 16;  // instances at most
  // What instances have in common.
  struct Kind {
    std::uint32_t model;
    std::uint32_t name;
    bool is_mirrored;
    auto operator<=>(const Kind&) const = default;
  };
  struct Packed {
    glm::dvec3 position_m;
    glm::quat rotation;
    float scale;
    std::uint32_t kind;
  };
  struct Node {
    SceneBall ball;
    std::uint32_t begin = 0;  // instances
    std::uint32_t end = 0;
    std::uint32_t skip = 0;  // the node after this one's descendants
    bool is_leaf = false;
  };

  void build(std::vector<Instance>& instances);
  // Returns a distance from a place within which an instance has no triangle at levels of this error and less; 0 if it has
  // no triangles.
  double clear_of_mesh_m(std::uint32_t instance, const glm::dvec3& place_m, double geometric_error_m) const;

  Models models_;
  std::vector<Kind> kinds_;
  std::vector<Packed> packed_;
  std::vector<std::string> names_{""};
  std::vector<Node> nodes_;  // each before its descendants
};

template <class Enter, class Leaf>
void Scene::visit(const Enter& enter, const Leaf& leaf) const {
  for (std::uint32_t at = 0; at < nodes_.size();) {
    const Node& node = nodes_[at];
    if (!enter(node.ball)) {
      at = node.skip;
      continue;
    }
    if (node.is_leaf) {
      for (std::uint32_t n = node.begin; n < node.end; ++n) {
        if (enter(ball(n))) leaf(n);
      }
    }
    ++at;
  }
}

}  // namespace objects
