#include "lod/mesh/error_meter.h"

#include <bit>
#include <stdexcept>
#include <utility>

#include "lod/mesh/overlay_cut.h"
#include "lod/mesh/overlay_points.h"

namespace lod {

namespace {

// The pieces of the overlay that are visited: all, or those that may have the largest distances.
enum class Pieces { kAll, kLargest };

ErrorTerms measure_overlay(const CoarseMesh& mesh, const FineGrid& fine, Pieces pieces) {
  const int depth = fine.key.level - mesh.key.level;
  const auto bits = [](int intervals) { return std::countr_zero(static_cast<unsigned>(intervals)); };
  if (!contains(mesh.key, fine.key) || depth + bits(fine.intervals) < bits(mesh.intervals)) {
    throw std::invalid_argument("ErrorMeter: tile " + to_string(fine.key) + " of " +
                                std::to_string(fine.intervals) +
                                " intervals does not refine the mesh of tile " + to_string(mesh.key) +
                                " over " + std::to_string(mesh.intervals));
  }
  if (fine.radius_m != mesh.radius_m)
    throw std::invalid_argument("ErrorMeter: mesh and posts have different planet radii");

  // The extent of the fine tile in units of the mesh's grid, rounded outwards.
  const auto span = [&](std::int32_t fine_index, std::int32_t index) {
    const std::int64_t at =
        (static_cast<std::int64_t>(fine_index) - (static_cast<std::int64_t>(index) << depth)) * mesh.intervals;
    const std::int64_t round_up = (std::int64_t{1} << depth) - 1;
    return std::pair(at >> depth, (at + mesh.intervals + round_up) >> depth);
  };
  const auto i = span(fine.key.i, mesh.key.i);
  const auto j = span(fine.key.j, mesh.key.j);
  const auto touches = [&](const CoarseMesh::Box& b) {
    return b.i0 <= i.second && b.i1 >= i.first && b.j0 <= j.second && b.j1 >= j.first;
  };

  OverlayPoints overlay(mesh, fine);
  const bool same_grid = depth + bits(fine.intervals) == bits(mesh.intervals);
  const OverlayCut cut(mesh, fine, i.first, j.first);
  const bool may_leave_out = pieces == Pieces::kLargest && same_grid;
  LargestDistances most;
  for (std::size_t k = 0; k < mesh.triangles.size(); ++k) {
    const CoarseMesh::Box& box = mesh.triangle_boxes[k];
    if (!touches(box)) continue;
    const CoarseMesh::Triangle t = mesh.triangles[k];
    overlay.vary(t);
    if (may_leave_out && cut.leaves_out(t, box, most)) continue;
    overlay.add_posts(t);
    most = overlay.largest();
  }
  for (std::size_t k = 0; k < mesh.segments.size(); ++k) {
    const CoarseMesh::Box& box = mesh.segment_boxes[k];
    if (!touches(box)) continue;
    const CoarseMesh::Segment s = mesh.segments[k];
    const bool ascending = (s.to.u - s.from.u) * (s.to.v - s.from.v) > 0.0;
    // Such an edge is a diagonal of S itself.
    if (same_grid && ascending && box.i1 - box.i0 == 1 && box.j1 - box.j0 == 1) continue;
    if (may_leave_out && cut.leaves_out(s, box, most)) continue;
    overlay.add_crossings(s);
    most = overlay.largest();
  }
  return overlay.terms();
}

}  // namespace

struct FinePosts::Prepared : FineGrid {
  using FineGrid::FineGrid;
};

FinePosts::FinePosts(const Posts& posts, double radius_m)
    : prepared_(std::make_unique<const Prepared>(posts, radius_m)) {}
FinePosts::~FinePosts() = default;
FinePosts::FinePosts(FinePosts&&) noexcept = default;
FinePosts& FinePosts::operator=(FinePosts&&) noexcept = default;
const FineGrid& FinePosts::grid() const { return *prepared_; }

struct ErrorMeter::Prepared : CoarseMesh {
  using CoarseMesh::CoarseMesh;
};

ErrorMeter::ErrorMeter(const TileKey& key, const TileMesh& mesh, std::span<const double> vertex_height_m,
                       double radius_m)
    : prepared_(std::make_unique<const Prepared>(key, mesh, vertex_height_m, radius_m)) {}
ErrorMeter::~ErrorMeter() = default;
ErrorMeter::ErrorMeter(ErrorMeter&&) noexcept = default;
ErrorMeter& ErrorMeter::operator=(ErrorMeter&&) noexcept = default;

ErrorTerms ErrorMeter::measure(const FinePosts& fine) const {
  return measure_overlay(*prepared_, *fine.prepared_, Pieces::kLargest);
}

ErrorTerms ErrorMeter::measure_all(const FinePosts& fine) const {
  return measure_overlay(*prepared_, *fine.prepared_, Pieces::kAll);
}

ErrorTerms ErrorMeter::measure(const Posts& fine) const {
  return measure(FinePosts(fine, prepared_->radius_m));
}

ErrorTerms measure_error(const TileKey& key, const TileMesh& mesh, std::span<const double> vertex_height_m,
                         const Posts& fine, double radius_m) {
  return ErrorMeter(key, mesh, vertex_height_m, radius_m).measure(fine);
}

}  // namespace lod
