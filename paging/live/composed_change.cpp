#include "paging/live/composed_change.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

namespace paging {

namespace {

// From this share on the change decides.
constexpr double kDecidingPart = 0.5;

class PartialChange final : public GroundChange {
 public:
  PartialChange(std::shared_ptr<const GroundChange> whole, double share)
      : whole_(std::move(whole)), share_(share) {}

  std::vector<mars::SourceInfo> infos() const override { return whole_->infos(); }
  bool touches(const mars::Cap& cap) const override { return share_ > 0 && whole_->touches(cap); }
  double spacing_in(const mars::Cap& cap) const override { return whole_->spacing_in(cap); }

  void change(std::span<const glm::dvec3> directions, double spacing_m, std::span<double> heights_m,
              std::span<int> decided_by) const override {
    const std::vector<double> before_m(heights_m.begin(), heights_m.end());
    whole_->change(directions, spacing_m, heights_m, decided_by);
    if (share_ == 1) return;
    const bool decides = share_ >= kDecidingPart;
    for (std::size_t i = 0; i < heights_m.size(); ++i) {
      if (!decides) decided_by[i] = -1;
      if (std::isnan(before_m[i]) || std::isnan(heights_m[i])) {
        if (!decides) heights_m[i] = before_m[i];
      } else {
        heights_m[i] = before_m[i] + share_ * (heights_m[i] - before_m[i]);
      }
    }
  }

 private:
  std::shared_ptr<const GroundChange> whole_;
  double share_;
};

class ChangesInOrder final : public GroundChange {
 public:
  explicit ChangesInOrder(std::vector<std::shared_ptr<const GroundChange>> all) : all_(std::move(all)) {
    for (const auto& one : all_) {
      const std::vector<mars::SourceInfo> infos = one->infos();
      begins_.push_back(static_cast<int>(infos_.size()));
      infos_.insert(infos_.end(), infos.begin(), infos.end());
    }
  }

  std::vector<mars::SourceInfo> infos() const override { return infos_; }

  bool touches(const mars::Cap& cap) const override {
    return std::ranges::any_of(all_, [&](const auto& one) { return one->touches(cap); });
  }

  double spacing_in(const mars::Cap& cap) const override {
    double spacing_m = std::numeric_limits<double>::infinity();
    for (const auto& one : all_) spacing_m = std::min(spacing_m, one->spacing_in(cap));
    return spacing_m;
  }

  void change(std::span<const glm::dvec3> directions, double spacing_m, std::span<double> heights_m,
              std::span<int> decided_by) const override {
    std::ranges::fill(decided_by, -1);
    std::vector<int> decided(directions.size());
    for (std::size_t n = 0; n < all_.size(); ++n) {
      std::ranges::fill(decided, -1);
      all_[n]->change(directions, spacing_m, heights_m, decided);
      for (std::size_t i = 0; i < decided.size(); ++i)
        if (decided[i] >= 0) decided_by[i] = begins_[n] + decided[i];
    }
  }

 private:
  std::vector<std::shared_ptr<const GroundChange>> all_;
  std::vector<int> begins_;  // of the infos of each
  std::vector<mars::SourceInfo> infos_;
};

void require_change(const std::shared_ptr<const GroundChange>& change) {
  if (!change) throw std::invalid_argument("no change of the ground");
}

}  // namespace

std::shared_ptr<const GroundChange> partial_change(std::shared_ptr<const GroundChange> change, double share) {
  require_change(change);
  if (!(share >= 0 && share <= 1))
    throw std::invalid_argument("a share of " + std::to_string(share) + " of a change; expected 0 to 1");
  return std::make_shared<PartialChange>(std::move(change), share);
}

std::shared_ptr<const GroundChange> changes_in_order(std::vector<std::shared_ptr<const GroundChange>> changes) {
  for (const auto& one : changes) require_change(one);
  if (changes.size() == 1) return changes.front();
  return std::make_shared<ChangesInOrder>(std::move(changes));
}

}  // namespace paging
