#include "mars/embedded/detail_below.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "mars/embedded/embedded.h"
#include "mars/embedded/measured.h"
#include "mars/embedded/surface.h"
#include "mars/sources/stack.h"

namespace mars {

namespace {

// Adds sign * detail at a spacing.
void add_detail_at(std::span<const glm::dvec3> directions, double spacing_m, double sign,
                   std::span<double> out) {
  embedded::evaluate_all(
      embedded::MeasuredMars::get(), directions, spacing_m, embedded::best_simd(), embedded::Wanted::kHeights,
      [&](const embedded::Block&, std::span<const std::uint32_t> index, const embedded::Surface& s) {
        for (std::size_t i = 0; i < index.size(); ++i)
          out[index[i]] += sign * static_cast<double>(s.detail_m[i]);
      });
}

bool shows_detail(double spacing_m, double data_spacing_m) {
  return embedded::detail_spacing_m(spacing_m) <
         std::min(embedded::kCoarsestRelief_m, embedded::detail_spacing_m(data_spacing_m));
}

class DetailedElevation final : public ElevationSource, public BoundaryAware {
 public:
  DetailedElevation(std::shared_ptr<const ElevationSource> data, double finest_m)
      : data_(std::move(data)), finest_m_(finest_m), infos_(data_->infos()) {
    // Of several rasters the finest one: none gets detail that it may contradict.
    data_spacing_m_ = std::ranges::min(infos_, {}, &SourceInfo::resolution_m).resolution_m;
    SourceInfo detail;
    detail.name = kDetailBelow + infos_.front().name;
    detail.resolution_m = finest_m_;
    detail.datum = infos_.front().datum;
    detail.body_radius_m = kMarsRadius_m;
    detail.illustration = true;
    detail_ = static_cast<int>(infos_.size());
    infos_.push_back(std::move(detail));
  }

  std::vector<SourceInfo> infos() const override { return infos_; }

  void sample(std::span<const glm::dvec3> directions, double spacing_m,
              std::span<double> heights_m) const override {
    data_->sample(directions, spacing_m, heights_m);
    add(directions, spacing_m, heights_m);
  }

  void origin(std::span<const glm::dvec3> directions, std::span<int> source_index) const override {
    data_->origin(directions, source_index);
  }

  void sample_with_origin(std::span<const glm::dvec3> directions, double spacing_m, std::span<double> heights_m,
                          std::span<int> source_index) const override {
    data_->sample_with_origin(directions, spacing_m, heights_m, source_index);
    if (!shows_detail(spacing_m, data_spacing_m_)) return;
    add(directions, spacing_m, heights_m);
    for (int& index : source_index)
      if (index >= 0) index = detail_;
  }

  double spacing_in(const Cap& cap) const override {
    const double data_m = data_->spacing_in(cap);
    return std::isfinite(data_m) ? std::min(data_m, finest_m_) : data_m;
  }

  void visit_posts(std::size_t max_posts, const PostVisitor& visit) const override {
    data_->visit_posts(max_posts, visit);
  }
  void visit_posts_in(std::size_t max_posts, const WantedCap& wanted, const PostVisitor& visit) const override {
    data_->visit_posts_in(max_posts, wanted, visit);
  }
  void visit_means(std::size_t max_posts, const PostVisitor& visit) const override {
    data_->visit_means(max_posts, visit);
  }

  void boundary_distance(std::span<const glm::dvec3> directions, double limit_posts,
                         std::span<double> posts) const override {
    boundary_distance_of(*data_, directions, limit_posts, posts);
  }

 private:
  // Adds the detail where there are data.
  void add(std::span<const glm::dvec3> directions, double spacing_m, std::span<double> heights_m) const {
    if (!shows_detail(spacing_m, data_spacing_m_)) return;
    std::vector<glm::dvec3> wanted;
    std::vector<std::size_t> index;
    for (std::size_t i = 0; i < directions.size(); ++i) {
      if (!std::isfinite(heights_m[i])) continue;
      wanted.push_back(directions[i]);
      index.push_back(i);
    }
    std::vector<double> detail_m(wanted.size());
    detail_below(wanted, spacing_m, data_spacing_m_, detail_m);
    for (std::size_t k = 0; k < index.size(); ++k) heights_m[index[k]] += detail_m[k];
  }

  std::shared_ptr<const ElevationSource> data_;
  double finest_m_;
  double data_spacing_m_ = 0;
  std::vector<SourceInfo> infos_;
  int detail_ = 0;  // index of its info
};

}  // namespace

void detail_below(std::span<const glm::dvec3> directions, double spacing_m, double data_spacing_m,
                  std::span<double> detail_m) {
  std::ranges::fill(detail_m, 0.0);
  if (directions.empty() || !shows_detail(spacing_m, data_spacing_m)) return;
  add_detail_at(directions, spacing_m, 1.0, detail_m);
  if (embedded::detail_spacing_m(data_spacing_m) < embedded::kCoarsestRelief_m)
    add_detail_at(directions, data_spacing_m, -1.0, detail_m);
}

std::shared_ptr<const ElevationSource> with_detail(std::shared_ptr<const ElevationSource> data,
                                                   double finest_m) {
  return std::make_shared<DetailedElevation>(std::move(data), finest_m);
}

}  // namespace mars
