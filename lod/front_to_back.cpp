#include "lod/front_to_back.h"

#include <algorithm>
#include <array>
#include <glm/geometric.hpp>

namespace lod {

namespace {

class Walk {
 public:
  Walk(std::span<const TileKey> tiles, const glm::dvec3& nadir, std::vector<std::uint32_t>& order)
      : tiles_(tiles), nadir_(nadir), order_(order) {
    position_.reserve(tiles.size());
    for (const TileKey& tile : tiles) position_.push_back(morton_position(tile));
  }

  // Visits tiles [begin, end), which are `node` itself or below it.
  void visit(const TileKey& node, std::size_t begin, std::size_t end) {
    if (begin == end) return;
    if (end - begin == 1) {
      order_.push_back(static_cast<std::uint32_t>(begin));
      return;
    }
    const mars::FaceAxes& face = mars::face_axes(node.face);
    const double out = glm::dot(face.out, nadir_);
    const double u = mars::face_line(2 * std::int64_t{node.i} + 1, node.level + 1);
    const double v = mars::face_line(2 * std::int64_t{node.j} + 1, node.level + 1);
    const int column = glm::dot(face.right, nadir_) >= u * out ? 1 : 0;
    const int row = glm::dot(face.up, nadir_) >= v * out ? 2 : 0;
    std::array<std::size_t, 5> cut{begin, 0, 0, 0, end};
    for (int c = 1; c < 4; ++c) cut[static_cast<std::size_t>(c)] = first_from(child(node, c), begin, end);
    for (int c = 0; c < 4; ++c) {
      const int next = c ^ (column | row);
      const auto n = static_cast<std::size_t>(next);
      visit(child(node, next), cut[n], cut[n + 1]);
    }
  }

  std::size_t first_from(const TileKey& key, std::size_t begin, std::size_t end) const {
    const auto from = position_.begin() + static_cast<std::ptrdiff_t>(begin);
    const auto to = position_.begin() + static_cast<std::ptrdiff_t>(end);
    return static_cast<std::size_t>(std::lower_bound(from, to, morton_position(key)) - position_.begin());
  }

 private:
  std::span<const TileKey> tiles_;
  glm::dvec3 nadir_;
  std::vector<std::uint32_t>& order_;
  std::vector<std::int64_t> position_;
};

}  // namespace

void front_to_back(std::span<const TileKey> tiles, const glm::dvec3& nadir, std::vector<std::uint32_t>& order) {
  order.clear();
  order.reserve(tiles.size());
  std::array<mars::Face, mars::kFaces> faces{};
  for (std::size_t f = 0; f < faces.size(); ++f) faces[f] = static_cast<mars::Face>(f);
  std::stable_sort(faces.begin(), faces.end(), [&](mars::Face a, mars::Face b) {
    return glm::dot(mars::face_axes(a).out, nadir) > glm::dot(mars::face_axes(b).out, nadir);
  });
  Walk walk(tiles, nadir, order);
  for (const mars::Face face : faces) {
    const std::size_t begin = walk.first_from({face, 0, 0, 0}, 0, tiles.size());
    const auto next = static_cast<int>(face) + 1;
    const std::size_t end = next < mars::kFaces
                                ? walk.first_from({static_cast<mars::Face>(next), 0, 0, 0}, begin, tiles.size())
                                : tiles.size();
    walk.visit({face, 0, 0, 0}, begin, end);
  }
}

}  // namespace lod
