#include "objects/reader/ply_points.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <initializer_list>
#include <limits>
#include <string>
#include <vector>

#include "objects/reader/model_frame.h"
#include "objects/reader/ply_values.h"
#include "objects/reader/refusal.h"
#include "vpe/base/quote.h"

namespace objects {

namespace {

constexpr double kMostRounding = 1.0 / 4096;  // of the longest side, before a note is made

bool holds_faces(const PlyElement& element) {
  return element.count > 0 && (element.name == "face" || element.name == "tristrips");
}

// The places of three properties in an element.
using PlyTriple = std::array<std::size_t, 3>;

// Returns the places of the first three names that are all there.
std::optional<PlyTriple> triple_of(const PlyElement& element,
                                   std::initializer_list<std::array<std::string_view, 3>> choices) {
  for (const auto& names : choices) {
    PlyTriple found{};
    std::size_t count = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto at = std::find_if(element.properties.begin(), element.properties.end(),
                                   [&](const PlyProperty& p) { return p.name == names[k] && !p.is_list; });
      if (at == element.properties.end()) continue;
      found[k] = static_cast<std::size_t>(at - element.properties.begin());
      ++count;
    }
    if (count == 3) return found;
  }
  return {};
}

glm::dvec3 vector_at(const std::vector<double>& values, const PlyTriple& places) {
  return {values[places[0]], values[places[1]], values[places[2]]};
}

// Returns the number that stands for a full channel.
double full_channel(PlyType type) {
  const bool is_float = type == PlyType::kFloat32 || type == PlyType::kFloat64;
  return is_float ? 1 : type == PlyType::kUint16 ? 65535 : 255;
}

bool is_finite(const glm::dvec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

// Gathers points and counts what is wrong with them.
class PointReader {
 public:
  PointReader(const PlyElement& vertices, const glm::dmat3& to_model)
      : to_model_(to_model), turn_(to_model / glm::length(to_model[0])) {
    const auto position = triple_of(vertices, {{"x", "y", "z"}});
    if (!position) throw Refusal("its vertices have no x, y and z", "export the points with coordinates");
    position_ = *position;
    normal_ = triple_of(vertices, {{"nx", "ny", "nz"}, {"normal_x", "normal_y", "normal_z"}});
    colour_ = triple_of(
        vertices,
        {{"red", "green", "blue"}, {"r", "g", "b"}, {"diffuse_red", "diffuse_green", "diffuse_blue"}});
    for (std::size_t k = 0; colour_ && k < 3; ++k)
      full_[k] = full_channel(vertices.properties[(*colour_)[k]].type);
    mesh_.positions_m.reserve(vertices.count);
    if (normal_) mesh_.normals.reserve(vertices.count);
    if (colour_) mesh_.colours.reserve(vertices.count);
  }

  void add(const std::vector<double>& values) {
    ++read_;
    const glm::dvec3 position_m = to_model_ * vector_at(values, position_);
    if (!is_finite(position_m)) {
      ++unplaced_;
      return;
    }
    const glm::dvec3 far_m = glm::abs(position_m);
    if (std::max({far_m.x, far_m.y, far_m.z}) > MeshLimits::kMostExtent_m)
      throw Refusal("the coordinates of its point " + std::to_string(read_ - 1) + " are over 1e9 m",
                    "correct the unit of length or move the points to the origin");
    low_m_ = glm::min(low_m_, position_m);
    high_m_ = glm::max(high_m_, position_m);
    mesh_.positions_m.emplace_back(position_m);
    if (normal_) mesh_.normals.push_back(normal(turn_ * vector_at(values, *normal_)));
    if (colour_) mesh_.colours.push_back(colour(vector_at(values, *colour_)));
  }

  MeshStream take() {
    MeshStream stream;
    if (mesh_.positions_m.empty()) throw Refusal("none of its points has finite coordinates");
    if (unplaced_ > 0)
      stream.notes.push_back(
          ignored_note(unplaced_, "point without finite coordinates", "points without finite coordinates"));
    if (unturned_ > 0)
      stream.notes.push_back(
          ignored_note(unturned_, "normal without a direction", "normals without a direction"));
    const glm::dvec3 far_m = glm::max(glm::abs(low_m_), glm::abs(high_m_));
    const glm::dvec3 size_m = high_m_ - low_m_;
    const double longest_m = std::max({size_m.x, size_m.y, size_m.z});
    const double rounding_m = 0.5 * static_cast<double>(std::numeric_limits<float>::epsilon()) *
                              std::max({far_m.x, far_m.y, far_m.z});
    if (longest_m > 0 && rounding_m > kMostRounding * longest_m) {
      char digits[32];
      std::snprintf(digits, sizeof digits, "%.2g", rounding_m);
      stream.notes.push_back("its points are far from the origin and therefore rounded by up to " +
                             std::string(digits) + " m; move the origin to them");
    }
    stream.mesh = std::move(mesh_);
    return stream;
  }

 private:
  glm::vec3 normal(const glm::dvec3& given) {
    const double length = glm::length(given);
    if (length > 0 && std::isfinite(length)) return glm::vec3(given / length);
    ++unturned_;
    return {0, 0, 0};
  }

  Rgba colour(const glm::dvec3& given) const {
    std::array<std::uint8_t, 3> bytes{};
    for (std::size_t k = 0; k < 3; ++k) {
      const double channel = given[static_cast<glm::length_t>(k)];
      if (!(channel >= 0 && channel <= full_[k]))
        throw Refusal("the colour of its point " + std::to_string(read_ - 1) + " is not within 0 to " +
                          std::to_string(static_cast<int>(full_[k])),
                      "export colours of the type uchar");
      bytes[k] = static_cast<std::uint8_t>(std::lround(channel * 255.0 / full_[k]));
    }
    return {bytes[0], bytes[1], bytes[2], 255};
  }

  glm::dmat3 to_model_;
  glm::dmat3 turn_;
  PlyTriple position_{};
  std::optional<PlyTriple> normal_;
  std::optional<PlyTriple> colour_;
  std::array<double, 3> full_{255, 255, 255};
  Mesh mesh_;
  glm::dvec3 low_m_{std::numeric_limits<double>::infinity()};
  glm::dvec3 high_m_{-std::numeric_limits<double>::infinity()};
  std::size_t read_ = 0;
  std::size_t unplaced_ = 0;
  std::size_t unturned_ = 0;
};

}  // namespace

std::optional<MeshStream> read_ply_points(const std::filesystem::path& path, const ModelFileOptions& options) {
  PlyValues values(path);
  const std::vector<PlyElement>& elements = values.header().elements;
  if (std::any_of(elements.begin(), elements.end(), holds_faces)) return {};
  const auto vertices = std::find_if(elements.begin(), elements.end(),
                                     [](const PlyElement& e) { return e.name == "vertex" && e.count > 0; });
  if (vertices == elements.end()) throw Refusal("it has neither points nor faces");
  if (!options.allows_points)
    throw Refusal("it has points and no faces", "make sticks of it with `vpe object FILE -o NAME.sticks`");

  values.check_size(*vertices);
  PointReader points(*vertices, glm::dmat3(model_frame(options.up == UpAxis::kY, options.unit_m)));
  std::vector<double> numbers;
  for (auto before = elements.begin(); before != vertices; ++before)
    for (std::uint64_t n = 0; n < before->count; ++n) values.next(*before, numbers);
  for (std::uint64_t n = 0; n < vertices->count; ++n) {
    values.next(*vertices, numbers);
    points.add(numbers);
  }
  MeshStream stream = points.take();
  for (auto e = elements.begin(); e != elements.end(); ++e)
    if (e != vertices && e->count > 0)
      stream.notes.push_back("the element " + vpe::base::quote_text(e->name) + " is ignored");
  if (const std::string reason = check_points(stream.mesh); !reason.empty()) throw Refusal(reason);
  return stream;
}

}  // namespace objects
