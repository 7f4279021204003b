#include "mars/sources/adjusted.h"

#include <cmath>
#include <vector>

#include "mars/sources/stack.h"

namespace mars {
namespace {

class AdjustedElevation final : public ElevationSource, public BoundaryAware, public Maskable {
 public:
  AdjustedElevation(std::shared_ptr<const ElevationSource> source, HeightAdjustment adjustment,
                    const VerticalDatum& datum, const std::string& treatment)
      : source_(std::move(source)), adjustment_(std::move(adjustment)), infos_(source_->infos()) {
    for (SourceInfo& info : infos_) {
      info.datum = datum;
      info.treatment = add_treatment(info.treatment, treatment);
    }
  }
  AdjustedElevation(std::shared_ptr<const ElevationSource> source, HeightAdjustment adjustment,
                    std::vector<SourceInfo> infos)
      : source_(std::move(source)), adjustment_(std::move(adjustment)), infos_(std::move(infos)) {}

  // The mask tests adjusted heights, but removes posts of the inner source, whose boundary then changes too.
  std::shared_ptr<const ElevationSource> with_mask(PostMask mask, int margin,
                                                   const std::string& treatment) const override {
    const auto* inner = dynamic_cast<const Maskable*>(source_.get());
    if (inner == nullptr) return nullptr;
    const PostMask own_mask = [mask = std::move(mask), adjustment = adjustment_](
                                  std::span<const glm::dvec3> directions, std::span<double> heights_m) {
      std::vector<double> own_m(heights_m.begin(), heights_m.end());
      adjustment(directions, own_m);
      mask(directions, own_m);
      for (std::size_t i = 0; i < own_m.size(); ++i) {
        if (std::isnan(own_m[i])) heights_m[i] = own_m[i];
      }
    };
    auto masked = inner->with_mask(own_mask, margin, "");
    if (masked == nullptr) return nullptr;
    std::vector<SourceInfo> infos = infos_;
    for (SourceInfo& info : infos) info.treatment = add_treatment(info.treatment, treatment);
    return std::make_shared<const AdjustedElevation>(std::move(masked), adjustment_, std::move(infos));
  }

  std::vector<SourceInfo> infos() const override { return infos_; }

  void sample(std::span<const glm::dvec3> directions, double spacing_m,
              std::span<double> heights_m) const override {
    source_->sample(directions, spacing_m, heights_m);
    adjustment_(directions, heights_m);
  }

  void origin(std::span<const glm::dvec3> directions, std::span<int> source_index) const override {
    source_->origin(directions, source_index);
  }

  void sample_with_origin(std::span<const glm::dvec3> directions, double spacing_m, std::span<double> heights_m,
                          std::span<int> source_index) const override {
    source_->sample_with_origin(directions, spacing_m, heights_m, source_index);
    adjustment_(directions, heights_m);
    for (std::size_t i = 0; i < heights_m.size(); ++i)
      if (!std::isfinite(heights_m[i])) source_index[i] = -1;
  }

  double spacing_in(const Cap& cap) const override { return source_->spacing_in(cap); }

  void visit_posts(std::size_t max_posts, const PostVisitor& visit) const override {
    source_->visit_posts(max_posts, adjusting(visit));
  }
  void visit_posts_in(std::size_t max_posts, const WantedCap& wanted, const PostVisitor& visit) const override {
    source_->visit_posts_in(max_posts, wanted, adjusting(visit));
  }
  void visit_means(std::size_t max_posts, const PostVisitor& visit) const override {
    source_->visit_means(max_posts, adjusting(visit));
  }

  void boundary_distance(std::span<const glm::dvec3> directions, double limit_posts,
                         std::span<double> posts) const override {
    boundary_distance_of(*source_, directions, limit_posts, posts);
  }

 private:
  // Returns a visitor of own heights that passes adjusted ones on. The result must not outlive `visit`.
  PostVisitor adjusting(const PostVisitor& visit) const {
    return [this, &visit, own_m = std::vector<double>()](std::span<const glm::dvec3> directions,
                                                         std::span<const double> heights_m) mutable {
      own_m.assign(heights_m.begin(), heights_m.end());
      adjustment_(directions, own_m);
      visit(directions, own_m);
    };
  }

  std::shared_ptr<const ElevationSource> source_;
  HeightAdjustment adjustment_;
  std::vector<SourceInfo> infos_;
};

}  // namespace

std::string add_treatment(const std::string& before, const std::string& treatment) {
  if (before.empty() || treatment.empty()) return before + treatment;
  return before + "; " + treatment;
}

std::shared_ptr<const ElevationSource> adjusted(std::shared_ptr<const ElevationSource> source,
                                                HeightAdjustment adjustment, const VerticalDatum& datum,
                                                const std::string& treatment) {
  return std::make_shared<AdjustedElevation>(std::move(source), std::move(adjustment), datum, treatment);
}

}  // namespace mars
