#include "tests/bench/figures/ray_figures_edges.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <stdexcept>

// The kernel's parts are compiled once here, for the instruction set of this file.
// clang-format off
#include <hwy/highway.h>
// clang-format on

#include "vpe/voxel/columns/column_lines-inl.h"
#include "vpe/voxel/columns/column_paths-inl.h"

namespace bench {

namespace {

namespace voxel = vpe::voxel;
namespace kernel = vpe::voxel::HWY_NAMESPACE;
using One = hwy::HWY_NAMESPACE::CappedTag<double, 1>;
using voxel::LineFamily;

double first_lane(hwy::HWY_NAMESPACE::Vec<One> v) { return hwy::HWY_NAMESPACE::GetLane(v); }

// Returns the family of the one edge between two lines: `straight` as PathReader::Crossing::other.
LineFamily family_between(LineFamily walked, bool straight) {
  if (walked == LineFamily::kDiagonals) return straight ? LineFamily::kColumns : LineFamily::kRows;
  if (!straight) return LineFamily::kDiagonals;
  return walked == LineFamily::kColumns ? LineFamily::kRows : LineFamily::kColumns;
}

// Crosses one tile after the other with one column.
class ColumnEdges {
 public:
  ColumnEdges(const Scene& scene, const voxel::ColumnCamera& camera, const glm::dvec3& azimuth)
      : scene_(scene), camera_(camera), azimuth_(azimuth) {}

  // Appends the crossings of a tile, and returns the place at which the column leaves it.
  EdgeCrossing cross(const lod::TileKey& key, std::vector<EdgeCrossing>& out) {
    const lod::TileTree& tree = scene_.surface().planet().tree();
    const int n = tree.shape().intervals();
    if (voxel::grids_per_side(key.level, n) != 1) throw std::runtime_error("the column leaves the fine tiles");
    const double u0 = mars::face_line(key.i, key.level);
    const double v0 = mars::face_line(key.j, key.level);
    frame_ = {n, u0, (mars::face_line(key.i + 1, key.level) - u0) / n, v0,
              (mars::face_line(key.j + 1, key.level) - v0) / n};
    const mars::FaceAxes& axes = mars::face_axes(key.face);
    const auto in_face = [&](const glm::dvec3& x) {
      return glm::dvec3(glm::dot(x, axes.right), glm::dot(x, axes.up), glm::dot(x, axes.out));
    };
    const glm::dvec3 up = in_face(camera_.up);
    set_group(in_face(azimuth_), up);
    kernel::Paths paths;
    kernel::find_paths(frame_, camera_, group_, paths);
    if (paths.kind[0] < 0) throw std::runtime_error("the column does not cross its tile");
    const auto family = static_cast<LineFamily>(static_cast<int>(paths.kind[0]) / 2);
    const auto tile = static_cast<lod::TileTree::Index>(tree.find(key) - tree.tiles().data());
    const auto grids = scene_.caster->store().exact_grids(tile, family, 1);
    const voxel::HeightGridLines<double>& lines = grids->lines(0, 0);
    kernel::find_bases(frame_, lines.reference, camera_, up, paths);
    read(lines, family, paths, key, out);
    const bool outward = (static_cast<int>(paths.kind[0]) & 1) != 0;
    return crossing(paths, outward ? paths.to[0] : paths.from[0], 0);
  }

 private:
  void set_group(const glm::dvec3& azimuth, const glm::dvec3& up) {
    const glm::dvec3 normal = glm::cross(azimuth, up);
    group_.columns = 1;
    for (int lane = 0; lane < voxel::kMaxLanes; ++lane) {
      group_.row[lane] = 0;
      group_.row_end[lane] = 1;
      group_.row_stop[lane] = 1;
      for (int k = 0; k < 3; ++k) {
        group_.azimuth[k][lane] = azimuth[k];
        group_.normal[k][lane] = normal[k];
      }
    }
  }

  void read(const voxel::HeightGridLines<double>& lines, LineFamily family, const kernel::Paths& paths,
            const lod::TileKey& key, std::vector<EdgeCrossing>& out) const {
    const One d;
    const kernel::PathReader<One> reader(lines, family, frame_.intervals, hn_set(paths.position0[0]),
                                         hn_set(paths.position1[0]));
    const auto add = [&](double x, double height, LineFamily on, bool walked) {
      if (x < paths.from[0] || x > paths.to[0]) return;
      EdgeCrossing edge = crossing(paths, x, height);
      edge.family = on;
      edge.walked = walked;
      edge.tile = key;
      out.push_back(edge);
    };
    const int least = family == LineFamily::kDiagonals ? -frame_.intervals : 0;
    const int first = std::max(static_cast<int>(std::floor(paths.from[0])), least);
    const int last = std::min(static_cast<int>(std::ceil(paths.to[0])), frame_.intervals);
    for (int k = first; k <= last; ++k) {
      const auto line = reader.gather(k);
      add(k, first_lane(reader.height_on(line)), family, true);
      if (k == last) break;
      const auto edge = reader.between(reader.line_number(k), line, reader.gather(k + 1));
      const bool straight = !hwy::HWY_NAMESPACE::AllFalse(d, edge.other);
      add(first_lane(edge.x), first_lane(edge.height), family_between(family, straight), false);
    }
  }

  static hwy::HWY_NAMESPACE::Vec<One> hn_set(double x) { return hwy::HWY_NAMESPACE::Set(One(), x); }

  // Returns the place at line x of a path with a post of this height: the formulas of HorizonWalk::resolve().
  EdgeCrossing crossing(const kernel::Paths& paths, double x, double height) const {
    EdgeCrossing edge;
    const double sigma = paths.sigma0[0] + paths.sigma1[0] * x;
    edge.slope = (height + paths.base0[0] + paths.base1[0] * x) / sigma;
    edge.distance_m = sigma / (paths.depth0[0] + paths.depth1[0] * x - height / camera_.distance_m);
    edge.in_grid = {paths.x0[0] + paths.xk[0] * x, paths.y0[0] + paths.yk[0] * x};
    return edge;
  }

  const Scene& scene_;
  voxel::ColumnCamera camera_;
  glm::dvec3 azimuth_;
  voxel::HeightGridFrame frame_;
  voxel::ColumnGroup group_;
};

}  // namespace

std::vector<EdgeCrossing> edges_of_column(const Scene& scene, const voxel::ColumnCamera& camera,
                                          const glm::dvec3& azimuth, double reach_m) {
  std::vector<EdgeCrossing> edges;
  ColumnEdges column(scene, camera, azimuth);
  for (EdgeCrossing end; end.distance_m < reach_m;) {
    constexpr double kBeyond_m = 0.01;
    const glm::dvec3 place =
        (camera.distance_m + end.slope * end.distance_m) * camera.up + (end.distance_m + kBeyond_m) * azimuth;
    end = column.cross(scene.surface().at(place).tile, edges);
  }
  std::sort(edges.begin(), edges.end(),
            [](const EdgeCrossing& a, const EdgeCrossing& b) { return a.distance_m < b.distance_m; });
  const auto same = [](const EdgeCrossing& a, const EdgeCrossing& b) {
    return b.distance_m - a.distance_m < 1e-6;
  };
  edges.erase(std::unique(edges.begin(), edges.end(), same), edges.end());
  std::erase_if(edges, [&](const EdgeCrossing& edge) { return edge.distance_m > reach_m; });
  return edges;
}

}  // namespace bench
