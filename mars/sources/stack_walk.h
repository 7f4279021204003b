// Shared parts of the stacks of elevation and of images: order of the sources, feathering, shares of each
// place.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <memory>
#include <numeric>
#include <span>
#include <string>
#include <vector>

#include "mars/geodesy/sphere.h"
#include "mars/sources/source.h"
#include "mars/sources/stack.h"

namespace mars {

// Returns 3 t^2 - 2 t^3 for t clamped to [0, 1].
inline double smooth_step(double t) {
  t = std::clamp(t, 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

// Returns the finest resolution of a source: of its data, where it has any beside what is made up.
template <class Source>
double resolution_m(const Source& source) {
  double data_m = std::numeric_limits<double>::infinity();
  double all_m = data_m;
  for (const SourceInfo& info : source.infos()) {
    all_m = std::min(all_m, info.resolution_m);
    if (!info.illustration) data_m = std::min(data_m, info.resolution_m);
  }
  return std::isfinite(data_m) ? data_m : all_m;
}

// Returns the sources by resolution, the finest first; ties keep their order. Throws SourceError if there are
// none, one is null, or the options are out of range.
template <class Source>
std::vector<std::shared_ptr<const Source>> by_resolution(std::vector<std::shared_ptr<const Source>> sources,
                                                         const StackOptions& options) {
  if (sources.empty()) throw SourceError("stack of sources: none given; name at least one raster");
  if (std::any_of(sources.begin(), sources.end(), [](const auto& s) { return s == nullptr; })) {
    throw SourceError("stack of sources: one of them is null; open every source first");
  }
  if (!(options.feather_posts >= 0 && options.feather_posts <= kMaxFeather_posts)) {
    throw SourceError("stack of sources: feather of " + std::to_string(options.feather_posts) +
                      " posts; give 0 to " + std::to_string(static_cast<int>(kMaxFeather_posts)));
  }
  if (!(options.feather_m >= 0 && std::isfinite(options.feather_m))) {
    throw SourceError("stack of sources: a feather of " + std::to_string(options.feather_m) +
                      " m; give 0 or more");
  }
  std::stable_sort(sources.begin(), sources.end(),
                   [](const auto& a, const auto& b) { return resolution_m(*a) < resolution_m(*b); });
  return sources;
}

// Returns the width of the fade of source s in its posts.
template <class Source>
double feather_posts(const std::vector<std::shared_ptr<const Source>>& sources, std::size_t s,
                     const StackOptions& options) {
  const double own_m = resolution_m(*sources[s]);
  if (options.feather_m > 0) return std::min(options.feather_m / own_m, kMaxFeather_posts);
  if (options.feather_base_posts <= 0 || s + 1 == sources.size()) return options.feather_posts;
  const double base_m = options.feather_base_posts * resolution_m(*sources[s + 1]);
  return std::min(std::max(options.feather_posts, base_m / own_m), kMaxFeather_posts);
}

// Holds the places of a batch that coarser sources still contribute to.
struct StackRest {
  std::vector<glm::dvec3> directions;
  std::vector<std::size_t> places;  // index of each in the batch
  std::vector<double> share;        // what the finer sources have left of each, 0..1

  explicit StackRest(std::span<const glm::dvec3> batch)
      : directions(batch.begin(), batch.end()), places(batch.size()), share(batch.size(), 1.0) {
    std::iota(places.begin(), places.end(), std::size_t{0});
  }

  // Removes places whose share is used up.
  void compact() {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < places.size(); ++i) {
      if (share[i] <= 0) continue;
      directions[kept] = directions[i];
      places[kept] = places[i];
      share[kept] = share[i];
      ++kept;
    }
    directions.resize(kept);
    places.resize(kept);
    share.resize(kept);
  }
};

// Sets `shares` to the source's own share of each place where it has data. The lowest source gets all that is
// left of a place unless a finer one has a part of it, so its boundary is evaluated only there.
template <class Source>
void boundary_shares(const Source& source, double feather_posts, const StackRest& rest,
                     std::span<const char> has, bool lowest, std::vector<double>& shares) {
  shares.assign(rest.places.size(), 1.0);
  const auto* boundary = dynamic_cast<const BoundaryAware*>(&source);
  if (boundary == nullptr || feather_posts <= 0) return;
  std::vector<glm::dvec3> near;
  std::vector<std::size_t> numbers;
  for (std::size_t i = 0; i < rest.places.size(); ++i) {
    if (has[i] == 0 || (lowest && rest.share[i] >= 1)) continue;
    near.push_back(rest.directions[i]);
    numbers.push_back(i);
  }
  if (near.empty()) return;
  std::vector<double> distances(near.size());
  boundary->boundary_distance(near, feather_posts, distances);
  for (std::size_t k = 0; k < near.size(); ++k) shares[numbers[k]] = smooth_step(distances[k] / feather_posts);
}

// Returns a cap that contains a whole batch.
inline Cap enclosing_cap(std::span<const glm::dvec3> directions) {
  glm::dvec3 sum(0);
  for (const glm::dvec3& d : directions) sum += d;
  if (!(glm::length(sum) > 0.5 * static_cast<double>(directions.size()))) return {{1, 0, 0}, kPi};
  const glm::dvec3 centre = glm::normalize(sum);
  double chord = 0;
  for (const glm::dvec3& d : directions) chord = std::max(chord, glm::length(d - centre));
  return {centre, 2 * std::asin(std::min(1.0, chord / 2)) + 1e-12};
}

// Walks down the stack. For each source, over the places that the finer ones have not used up, calls
// sample(source index, directions, has), which must set `has` to 1 where the source has data and to 0
// elsewhere; then visit(source index, places = indices in the batch, has, shares of the value).
template <class Source, class Sample, class Visit>
void walk_stack(const std::vector<std::shared_ptr<const Source>>& sources, const StackOptions& options,
                std::span<const glm::dvec3> directions, const Sample& sample, const Visit& visit) {
  StackRest rest(directions);
  std::vector<double> shares;
  std::vector<char> has;
  const Cap cap = enclosing_cap(directions);
  for (std::size_t s = 0; s < sources.size() && !rest.places.empty(); ++s) {
    if (std::isinf(sources[s]->spacing_in(cap))) continue;
    has.assign(rest.places.size(), 0);
    sample(s, rest.directions, has);
    const bool lowest = s + 1 == sources.size();
    boundary_shares(*sources[s], feather_posts(sources, s, options), rest, has, lowest, shares);
    for (std::size_t i = 0; i < shares.size(); ++i) shares[i] = has[i] != 0 ? shares[i] * rest.share[i] : 0.0;
    visit(s, rest.places, has, shares);
    for (std::size_t i = 0; i < shares.size(); ++i) rest.share[i] -= shares[i];
    rest.compact();
  }
}

}  // namespace mars
