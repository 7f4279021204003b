#include "paging/live/ground_change.h"

#include <stdexcept>

namespace paging {

namespace {

// From this share on the source decides.
constexpr double kDecidingShare = 0.5;

class MixedGround final : public GroundChange {
 public:
  MixedGround(std::shared_ptr<const mars::ElevationSource> source, double share)
      : source_(std::move(source)), share_(share) {}

  std::vector<mars::SourceInfo> infos() const override { return source_->infos(); }

  bool touches(const mars::Cap& cap) const override {
    return share_ > 0 && !std::isinf(source_->spacing_in(cap));
  }

  double spacing_in(const mars::Cap& cap) const override { return source_->spacing_in(cap); }

  void change(std::span<const glm::dvec3> directions, double spacing_m, std::span<double> heights_m,
              std::span<int> decided_by) const override {
    std::vector<double> source_m(directions.size());
    source_->sample_with_origin(directions, spacing_m, source_m, decided_by);
    for (std::size_t i = 0; i < directions.size(); ++i) {
      if (!std::isfinite(source_m[i])) {
        decided_by[i] = -1;
        continue;
      }
      const bool decides = share_ >= kDecidingShare;
      if (!decides) decided_by[i] = -1;
      if (std::isfinite(heights_m[i]) && share_ < 1) {
        heights_m[i] += share_ * (source_m[i] - heights_m[i]);
      } else if (decides) {
        heights_m[i] = source_m[i];
      }
    }
  }

 private:
  std::shared_ptr<const mars::ElevationSource> source_;
  double share_;
};

}  // namespace

std::shared_ptr<const GroundChange> mixed_ground(std::shared_ptr<const mars::ElevationSource> source,
                                                 double share) {
  if (!source) throw std::invalid_argument("no source to mix the ground with");
  if (!(share >= 0 && share <= 1))
    throw std::invalid_argument("a share of " + std::to_string(share) + " of a source; expected 0 to 1");
  return std::make_shared<MixedGround>(std::move(source), share);
}

}  // namespace paging
