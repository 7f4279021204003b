#include "relief/relief.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <stdexcept>

#include "vpe/base/quote.h"

namespace relief {

namespace {

// All places of a batch ask all reliefs near it if these are few, or if this share of them is near its centre.
constexpr std::size_t kFewReliefs = 32;
constexpr std::size_t kShareOfBatch = 4;

ReliefChange unchanged(double ground_m) { return {ground_m, false, false}; }

// Applies a relief to what those before it left.
void apply(const PlacedRelief& relief, const glm::dvec3& direction, ReliefChange& all) {
  const ReliefChange one = relief.change(direction, all.height_m);
  all.height_m = one.height_m;
  all.decides = all.decides || one.decides;
}

void finish(double ground_m, ReliefChange& all) {
  all.is_changed = !std::isnan(ground_m) && all.height_m != ground_m;
  all.decides = all.decides && all.is_changed;
}

// Applies reliefs in order.
ReliefChange changed_by(const std::vector<PlacedRelief>& placed, std::span<const std::uint32_t> numbers,
                        const glm::dvec3& direction, double ground_m) {
  ReliefChange all = unchanged(ground_m);
  for (const std::uint32_t n : numbers) apply(placed[n], direction, all);
  finish(ground_m, all);
  return all;
}

// Returns a cap that holds all unit directions.
mars::Cap cap_of(std::span<const glm::dvec3> directions) {
  glm::dvec3 middle(0);
  for (const glm::dvec3& d : directions) middle += d;
  const double length = glm::length(middle);
  if (!(length > 0.5 * static_cast<double>(directions.size()))) return {{1, 0, 0}, mars::kPi};
  middle /= length;
  // The farthest in a straight line is the farthest on the sphere.
  glm::dvec3 farthest = middle;
  double most = 0;
  for (const glm::dvec3& d : directions) {
    const glm::dvec3 away = d - middle;
    const double square = glm::dot(away, away);
    if (square > most) {
      most = square;
      farthest = d;
    }
  }
  // Squares of nearly equal lengths may be in the wrong order by their rounding.
  return {middle, mars::angle_between_rad(middle, farthest) * (1 + 1e-15) + 1e-14};
}

}  // namespace

double Relief::height_m(const glm::dvec3& direction, double ground_m) const {
  return change(direction, ground_m).height_m;
}

ReliefChange Relief::change(const glm::dvec3& direction, double ground_m) const {
  std::vector<std::uint32_t> near;
  tree_.find({direction, 0}, near);
  return changed_by(placed_, near, direction, ground_m);
}

void Relief::change(std::span<const glm::dvec3> directions, std::span<const double> ground_m,
                    std::span<ReliefChange> changes) const {
  if (directions.empty()) return;
  const mars::Cap cap = cap_of(directions);
  std::vector<std::uint32_t> near;
  std::vector<std::uint32_t> at_centre;
  tree_.find(cap, near);
  tree_.find({cap.centre, 0}, at_centre);
  if (near.size() <= kFewReliefs || at_centre.size() >= near.size() / kShareOfBatch) {
    // Each relief is fetched once for all places.
    for (std::size_t i = 0; i < directions.size(); ++i) changes[i] = unchanged(ground_m[i]);
    for (const std::uint32_t n : near) {
      for (std::size_t i = 0; i < directions.size(); ++i) apply(placed_[n], directions[i], changes[i]);
    }
    for (std::size_t i = 0; i < directions.size(); ++i) finish(ground_m[i], changes[i]);
    return;
  }
  for (std::size_t i = 0; i < directions.size(); ++i) {
    tree_.find({directions[i], 0}, near);
    changes[i] = changed_by(placed_, near, directions[i], ground_m[i]);
  }
}

bool Relief::touches(const mars::Cap& cap) const {
  std::vector<std::uint32_t> near;
  tree_.find(cap, near);
  return std::ranges::any_of(near, [&](std::uint32_t n) { return placed_[n].touches(cap); });
}

Interval Relief::bounds_m(const mars::Cap& cap, const Interval& ground_m) const {
  std::vector<std::uint32_t> near;
  tree_.find(cap, near);
  Interval all = ground_m;
  for (const std::uint32_t n : near) all = placed_[n].bounds_m(cap, all);
  return all;
}

double Relief::spacing_m(const mars::Cap& cap) const {
  std::vector<std::uint32_t> near;
  tree_.find(cap, near);
  double finest_m = std::numeric_limits<double>::infinity();
  for (const std::uint32_t n : near) {
    if (placed_[n].touches(cap)) finest_m = std::min(finest_m, placed_[n].spacing_m());
  }
  return finest_m;
}

std::string relief_title(const ReliefSpec& spec, std::size_t number) {
  return spec.name.empty() ? "relief " + std::to_string(number)
                           : "relief " + std::to_string(number) + " " + vpe::base::quote_text(spec.name);
}

Relief place(std::vector<ReliefSpec> specs, double radius_m, const GroundHeight& ground) {
  return place(
      std::move(specs), [radius_m](const glm::dvec3&) { return radius_m; }, ground);
}

Relief place(std::vector<ReliefSpec> specs, const BaseRadius& radius_m, const GroundHeight& ground) {
  if (specs.size() > kMostReliefs) {
    throw std::runtime_error(std::to_string(specs.size()) + " reliefs; expected at most " +
                             std::to_string(kMostReliefs));
  }
  Relief relief;
  std::vector<mars::Cap> caps;
  for (ReliefSpec& spec : specs) {
    const std::string title = relief_title(spec, relief.placed_.size() + 1);
    if (const std::string problem = problem_of(spec); !problem.empty())
      throw std::runtime_error(title + ": " + problem);
    const double own_radius_m = radius_m(mars::direction(spec.place));
    if (!(own_radius_m > 0 && std::isfinite(own_radius_m)))
      throw std::runtime_error("reliefs on a planet without a radius; expected a finite one above 0");
    try {
      relief.placed_.emplace_back(std::move(spec), own_radius_m);
    } catch (const std::invalid_argument& e) {
      throw std::runtime_error(title + ": " + e.what());
    }
    caps.push_back(relief.placed_.back().cap());
  }
  relief.tree_ = CapTree(caps);
  std::vector<std::uint32_t> near;
  for (std::size_t n = 0; n < relief.placed_.size(); ++n) {
    PlacedRelief& one = relief.placed_[n];
    double zero_m = one.mode() == Mode::kAdd ? 0.0 : one.spec().level_m.value_or(0) + one.spec().rise_m;
    if (one.needs_ground()) {
      const glm::dvec3& centre = one.cap().centre;
      const double ground_m = ground ? ground(centre) : std::numeric_limits<double>::quiet_NaN();
      relief.tree_.find({centre, 0}, near);
      near.erase(std::ranges::lower_bound(near, static_cast<std::uint32_t>(n)), near.end());
      zero_m += changed_by(relief.placed_, near, centre, ground_m).height_m;
      if (!std::isfinite(zero_m)) {
        throw std::runtime_error(relief_title(one.spec(), n + 1) +
                                 ": there is no ground at its place; give level_m, or another place");
      }
    }
    one.set_zero_m(zero_m);
  }
  return relief;
}

}  // namespace relief
