#include "paging/live/relief_patch.h"

#include <algorithm>

#include "relief/relief_source.h"

namespace paging {

namespace {

class ReliefGround final : public GroundChange {
 public:
  ReliefGround(relief::Relief relief, const std::string& name) : relief_(std::move(relief)) {
    info_ = relief::relief_info({}, relief_.placed().size());
    info_.name = name;
    for (const relief::PlacedRelief& one : relief_.placed()) {
      const double spacing_m = one.spacing_m();
      info_.resolution_m = info_.resolution_m > 0 ? std::min(info_.resolution_m, spacing_m) : spacing_m;
    }
  }

  std::vector<mars::SourceInfo> infos() const override { return {info_}; }
  bool touches(const mars::Cap& cap) const override { return relief_.touches(cap); }
  double spacing_in(const mars::Cap& cap) const override { return relief_.spacing_m(cap); }

  void change(std::span<const glm::dvec3> directions, double /*spacing_m*/, std::span<double> heights_m,
              std::span<int> decided_by) const override {
    std::vector<relief::ReliefChange> changes(directions.size());
    relief_.change(directions, heights_m, changes);
    for (std::size_t i = 0; i < changes.size(); ++i) {
      heights_m[i] = changes[i].height_m;
      decided_by[i] = changes[i].decides ? 0 : -1;
    }
  }

 private:
  relief::Relief relief_;
  mars::SourceInfo info_;
};

}  // namespace

std::shared_ptr<const GroundChange> relief_change(relief::Relief relief, const std::string& name) {
  return std::make_shared<ReliefGround>(std::move(relief), name);
}

std::shared_ptr<const PlanetFile> ReliefPatcher::with(std::span<const relief::ReliefSpec> reliefs,
                                                      const PatchOptions& options, MadePatch* made) const {
  if (made != nullptr) *made = {};
  if (reliefs.empty()) return base();
  relief::Relief placed =
      relief::place({reliefs.begin(), reliefs.end()}, base()->radius_m(),
                    [this](const glm::dvec3& direction) { return maker_.ground_m(direction); });
  MadePatch patch = maker_.make(*relief_change(std::move(placed)), options);
  if (made != nullptr) *made = patch;
  if (!patch.patch) return base();
  std::shared_ptr<const PlanetFile> former;
  {
    const std::lock_guard lock(last_->mutex);
    former = last_->planet.lock();
  }
  std::shared_ptr<const PlanetFile> patched = base()->with(std::move(patch.patch), former);
  const std::lock_guard lock(last_->mutex);
  last_->planet = patched;
  return patched;
}

std::shared_ptr<const PlanetFile> with_reliefs(std::shared_ptr<const PlanetFile> base,
                                               std::span<const relief::ReliefSpec> reliefs,
                                               const PatchOptions& options) {
  if (reliefs.empty()) return base;
  return ReliefPatcher(std::move(base)).with(reliefs, options);
}

}  // namespace paging
