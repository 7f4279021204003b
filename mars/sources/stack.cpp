#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "mars/sources/source.h"
#include "mars/sources/stack_walk.h"

namespace mars {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

class ElevationStack final : public ElevationSource {
 public:
  ElevationStack(std::vector<std::shared_ptr<const ElevationSource>> sources, const StackOptions& options)
      : sources_(by_resolution(std::move(sources), options)), options_(options) {
    const SourceInfo* known = nullptr;
    for (const auto& source : sources_) {
      first_info_.push_back(infos_.size());
      resolution_m_ = std::min(resolution_m_, resolution_m(*source));
      for (SourceInfo& info : source->infos()) infos_.push_back(std::move(info));
    }
    for (const SourceInfo& info : infos_) {
      if (!info.datum.is_known()) continue;
      if (known != nullptr && !(known->datum == info.datum)) {
        throw SourceError(known->name + " has heights of datum '" + to_string(known->datum) + "', but " +
                          info.name + " has heights of datum '" + to_string(info.datum) +
                          "'; convert one of them first");
      }
      known = &info;
    }
  }

  std::vector<SourceInfo> infos() const override { return infos_; }

  void sample(std::span<const glm::dvec3> directions, double spacing_m,
              std::span<double> heights_m) const override {
    std::vector<Blend> blends(directions.size());
    blend(directions, spacing_m, blends);
    for (std::size_t i = 0; i < blends.size(); ++i) heights_m[i] = blends[i].height_m();
  }

  void origin(std::span<const glm::dvec3> directions, std::span<int> source_index) const override {
    std::vector<Blend> blends(directions.size());
    blend(directions, resolution_m_, blends);
    for (std::size_t i = 0; i < blends.size(); ++i) source_index[i] = blends[i].origin;
  }

  void sample_with_origin(std::span<const glm::dvec3> directions, double spacing_m, std::span<double> heights_m,
                          std::span<int> source_index) const override {
    std::vector<Blend> blends(directions.size());
    blend(directions, spacing_m, blends);
    for (std::size_t i = 0; i < blends.size(); ++i) {
      heights_m[i] = blends[i].height_m();
      source_index[i] = blends[i].origin;
    }
  }

  double spacing_in(const Cap& cap) const override {
    double finest = std::numeric_limits<double>::infinity();
    for (const auto& source : sources_) finest = std::min(finest, source->spacing_in(cap));
    return finest;
  }

  void visit_posts(std::size_t max_posts, const PostVisitor& visit) const override {
    visit_posts_in(max_posts, {}, visit);
  }

  void visit_posts_in(std::size_t max_posts, const WantedCap& wanted, const PostVisitor& visit) const override {
    const std::size_t each = std::max<std::size_t>(max_posts / sources_.size(), max_posts > 0 ? 1 : 0);
    std::vector<Blend> blends;
    std::vector<glm::dvec3> kept;
    std::vector<double> kept_m;
    for (std::size_t s = 0; s < sources_.size(); ++s) {
      const auto keep_own = [&](std::span<const glm::dvec3> directions, std::span<const double> heights_m) {
        blends.assign(directions.size(), {});
        blend(directions, resolution_m_, blends);
        kept.clear();
        kept_m.clear();
        for (std::size_t i = 0; i < directions.size(); ++i) {
          if (!blends[i].single || blends[i].main != static_cast<int>(s)) continue;
          kept.push_back(directions[i]);
          kept_m.push_back(heights_m[i]);
        }
        if (!kept.empty()) visit(kept, kept_m);
      };
      sources_[s]->visit_posts_in(each, wanted, keep_own);
    }
  }

 private:
  struct Blend {
    double weighted_m = 0;
    double weight = 0;
    double finest_m = kNaN;  // the value of the finest source, used where every share is zero
    double largest = -1;     // share of `main`
    int main = -1;
    int origin = -1;     // index into infos_ of what decides within `main`
    bool single = true;  // one source alone makes the value

    double height_m() const { return single ? finest_m : weighted_m / weight; }
  };

  void blend(std::span<const glm::dvec3> directions, double spacing_m, std::span<Blend> blends) const {
    std::vector<double> heights_m;
    std::vector<int> own;
    walk_stack(
        sources_, options_, directions,
        [&](std::size_t s, std::span<const glm::dvec3> places, std::span<char> has) {
          heights_m.resize(places.size());
          own.resize(places.size());
          sources_[s]->sample_with_origin(places, spacing_m, heights_m, own);
          for (std::size_t i = 0; i < has.size(); ++i) has[i] = std::isnan(heights_m[i]) ? 0 : 1;
        },
        [&](std::size_t s, std::span<const std::size_t> places, std::span<const char> has,
            std::span<const double> shares) {
          for (std::size_t i = 0; i < places.size(); ++i) {
            if (has[i] == 0) continue;
            Blend& b = blends[places[i]];
            if (b.main < 0 || (b.weight <= 0 && shares[i] > 0)) {
              b.finest_m = heights_m[i];
              b.single = true;
            } else if (shares[i] > 0) {
              b.single = false;
            }
            if (shares[i] > b.largest) {
              b.largest = shares[i];
              b.main = static_cast<int>(s);
              b.origin = static_cast<int>(first_info_[s]) + std::max(own[i], 0);
            }
            b.weighted_m += heights_m[i] * shares[i];
            b.weight += shares[i];
          }
        });
  }

  std::vector<std::shared_ptr<const ElevationSource>> sources_;
  StackOptions options_;
  double resolution_m_ = std::numeric_limits<double>::infinity();
  std::vector<SourceInfo> infos_;
  std::vector<std::size_t> first_info_;  // index into infos_ of the first info of each source
};

}  // namespace

void boundary_distance_of(const ElevationSource& source, std::span<const glm::dvec3> directions,
                          double limit_posts, std::span<double> posts) {
  if (const auto* boundary = dynamic_cast<const BoundaryAware*>(&source)) {
    boundary->boundary_distance(directions, limit_posts, posts);
    return;
  }
  std::vector<int> origin(directions.size());
  source.origin(directions, origin);
  for (std::size_t i = 0; i < posts.size(); ++i) posts[i] = origin[i] < 0 ? 0.0 : limit_posts;
}

std::shared_ptr<const ElevationSource> stack_elevation(
    std::vector<std::shared_ptr<const ElevationSource>> sources, const StackOptions& options) {
  return std::make_shared<ElevationStack>(std::move(sources), options);
}

}  // namespace mars
