#include "relief/relief_source.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "mars/sources/stack.h"

namespace relief {

namespace {

constexpr std::int64_t kNanosecondsOfSecond = 1'000'000'000;

class ReliefElevation final : public mars::ElevationSource, public mars::BoundaryAware {
 public:
  ReliefElevation(std::shared_ptr<const mars::ElevationSource> below, Relief relief, mars::SourceInfo info)
      : below_(std::move(below)), relief_(std::move(relief)), infos_(below_->infos()) {
    for (const mars::SourceInfo& other : infos_) finest_m_ = std::min(finest_m_, other.resolution_m);
    for (const mars::SourceInfo& other : infos_) {
      if (!other.datum.is_known()) continue;
      info.datum = other.datum;
      break;
    }
    for (const PlacedRelief& one : relief_.placed()) {
      info.resolution_m =
          info.resolution_m > 0 ? std::min(info.resolution_m, one.spacing_m()) : one.spacing_m();
    }
    infos_.push_back(std::move(info));
  }

  std::vector<mars::SourceInfo> infos() const override { return infos_; }

  void sample(std::span<const glm::dvec3> directions, double spacing_m,
              std::span<double> heights_m) const override {
    below_->sample(directions, spacing_m, heights_m);
    const std::vector<ReliefChange> changes = changes_of(directions, heights_m);
    for (std::size_t i = 0; i < heights_m.size(); ++i) heights_m[i] = changes[i].height_m;
  }

  void origin(std::span<const glm::dvec3> directions, std::span<int> source_index) const override {
    below_->origin(directions, source_index);
    std::vector<double> heights_m(directions.size());
    below_->sample(directions, finest_m_, heights_m);
    set_origin(changes_of(directions, heights_m), source_index);
  }

  void sample_with_origin(std::span<const glm::dvec3> directions, double spacing_m, std::span<double> heights_m,
                          std::span<int> source_index) const override {
    below_->sample_with_origin(directions, spacing_m, heights_m, source_index);
    const std::vector<ReliefChange> changes = changes_of(directions, heights_m);
    for (std::size_t i = 0; i < heights_m.size(); ++i) heights_m[i] = changes[i].height_m;
    set_origin(changes, source_index);
  }

  double spacing_in(const mars::Cap& cap) const override {
    const double below_m = below_->spacing_in(cap);
    return std::isinf(below_m) ? below_m : std::min(below_m, relief_.spacing_m(cap));
  }

  void visit_posts(std::size_t max_posts, const mars::PostVisitor& visit) const override {
    below_->visit_posts(max_posts, unchanged(visit));
  }

  void visit_posts_in(std::size_t max_posts, const mars::WantedCap& wanted,
                      const mars::PostVisitor& visit) const override {
    below_->visit_posts_in(max_posts, wanted, unchanged(visit));
  }

  void visit_means(std::size_t max_posts, const mars::PostVisitor& visit) const override {
    below_->visit_means(max_posts,
                        [&](std::span<const glm::dvec3> directions, std::span<const double> heights_m) {
                          std::vector<double> changed_m(heights_m.size());
                          for (std::size_t i = 0; i < heights_m.size(); ++i)
                            changed_m[i] = relief_.height_m(directions[i], heights_m[i]);
                          visit(directions, changed_m);
                        });
  }

  void boundary_distance(std::span<const glm::dvec3> directions, double limit_posts,
                         std::span<double> posts) const override {
    mars::boundary_distance_of(*below_, directions, limit_posts, posts);
  }

 private:
  std::vector<ReliefChange> changes_of(std::span<const glm::dvec3> directions,
                                       std::span<const double> heights_m) const {
    std::vector<ReliefChange> changes(directions.size());
    relief_.change(directions, heights_m, changes);
    return changes;
  }

  void set_origin(std::span<const ReliefChange> changes, std::span<int> source_index) const {
    for (std::size_t i = 0; i < changes.size(); ++i) {
      if (changes[i].decides && source_index[i] >= 0) source_index[i] = static_cast<int>(infos_.size()) - 1;
    }
  }

  // Returns a visitor that passes on what no relief changes. The result must not outlive `visit`.
  mars::PostVisitor unchanged(const mars::PostVisitor& visit) const {
    return [this, &visit](std::span<const glm::dvec3> directions, std::span<const double> heights_m) {
      std::vector<glm::dvec3> kept;
      std::vector<double> kept_m;
      for (std::size_t i = 0; i < directions.size(); ++i) {
        if (relief_.change(directions[i], heights_m[i]).is_changed) continue;
        kept.push_back(directions[i]);
        kept_m.push_back(heights_m[i]);
      }
      if (!kept.empty()) visit(kept, kept_m);
    };
  }

  std::shared_ptr<const mars::ElevationSource> below_;
  Relief relief_;
  std::vector<mars::SourceInfo> infos_;
  double finest_m_ = std::numeric_limits<double>::infinity();  // posts of below_
};

}  // namespace

GroundHeight ground_of(std::shared_ptr<const mars::ElevationSource> source) {
  return [source = std::move(source)](const glm::dvec3& direction) {
    double height_m = std::numeric_limits<double>::quiet_NaN();
    const double spacing_m = source->spacing_in({direction, 0});
    if (std::isinf(spacing_m)) return height_m;
    source->sample({&direction, 1}, spacing_m, {&height_m, 1});
    return height_m;
  };
}

mars::SourceInfo relief_info(const std::filesystem::path& file, std::size_t reliefs) {
  mars::SourceInfo info;
  info.name = file.string();
  info.illustration = true;
  info.treatment = std::to_string(reliefs) + (reliefs == 1 ? " formula changes" : " formulas change") +
                   " the heights of the sources before it";
  if (const auto stamp = mars::file_stamp(file.string())) {
    info.size_bytes = stamp->size_bytes;
    info.mtime_s = stamp->mtime_ns / kNanosecondsOfSecond;
    info.files.push_back(*stamp);
  }
  return info;
}

std::shared_ptr<const mars::ElevationSource> with_relief(std::shared_ptr<const mars::ElevationSource> below,
                                                         Relief relief, mars::SourceInfo info) {
  return std::make_shared<ReliefElevation>(std::move(below), std::move(relief), std::move(info));
}

}  // namespace relief
