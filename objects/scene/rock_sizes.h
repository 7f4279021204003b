// How many rocks of which diameters lie on a square metre.
#pragma once

#include <vector>

#include "objects/files/scene_file.h"

namespace objects {

// Immutable. Any thread may call any member.
class RockSizes {
 public:
  // Takes distribution and diameters of an entry, which must be in the ranges of scene files.
  explicit RockSizes(const ScatterEntry& entry);

  // Returns the number of rocks with a diameter within those of the entry.
  double rocks_per_m2() const { return rocks_per_m2_; }
  // Returns the diameter below which the share of these rocks is `share`, in [0, 1]. The share of rocks below it is
  // right within 1e-5.
  double diameter_m(double share) const;

 private:
  double least_m_;
  double log_ratio_;  // of the largest to the smallest diameter
  double rocks_per_m2_ = 0;
  double exponent_ = 0;  // of a power law
  std::vector<double>
      shares_;  // of others: of rocks below each of diameters that are equally far in logarithms
};

}  // namespace objects
