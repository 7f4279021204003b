#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "lod/mesh.h"
#include "lod/mesh_overlay.h"
#include "vpe/core/mutation.h"

namespace lod {

using vpe::core::Guard;
using vpe::core::mutated;

void ErrorTerms::include(const ErrorTerms& other) {
  relief_m = std::max(relief_m, other.relief_m);
  sag_m = std::max(sag_m, other.sag_m);
  total_m = std::max(total_m, other.total_m);
}

double second_order_bound(double exaggeration, double range_m, double min_height_m, double max_height_m,
                          double radius_m) {
  const double x = exaggeration;
  const double low = std::min(0.0, x);
  const double high = std::max(1.0, x);
  const double a =
      radius_m + std::min({low * min_height_m, low * max_height_m, high * min_height_m, high * max_height_m});
  if (a <= 0.0) return std::numeric_limits<double>::infinity();
  if (mutated(Guard::kSecondOrder)) return 0.0;
  return std::abs(x * (x - 1.0)) * range_m * range_m * radius_m * radius_m / (4.0 * a * a * a);
}

double error_bound(const ErrorTerms& terms, double exaggeration, double min_height_m, double max_height_m,
                   double radius_m) {
  if (exaggeration == 1.0) return terms.total_m;
  return std::abs(exaggeration) * terms.relief_m + terms.sag_m +
         second_order_bound(exaggeration, max_height_m - min_height_m, min_height_m, max_height_m, radius_m);
}

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
