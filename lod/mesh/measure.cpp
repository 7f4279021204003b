#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "lod/mesh/mesh.h"
#include "lod/mesh/mesh_overlay.h"

namespace lod {

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
  return measure_overlay(*prepared_, *fine.prepared_);
}

ErrorTerms ErrorMeter::measure(const Posts& fine) const {
  return measure(FinePosts(fine, prepared_->radius_m));
}

ErrorTerms measure_error(const TileKey& key, const TileMesh& mesh, std::span<const double> vertex_height_m,
                         const Posts& fine, double radius_m) {
  return ErrorMeter(key, mesh, vertex_height_m, radius_m).measure(fine);
}

}  // namespace lod
