// Shares of a planet's area by a value, summed without regard to order.
#pragma once

#include <cstdint>
#include <vector>

namespace vpe::app {

// Sums areas by value in bins. The sums are whole numbers, so that they depend on neither order nor threads. A percentile is
// exact to the width of its bin.
class Distribution {
 public:
  // Spaces the bins' edges between `low` and `high`, low < high: evenly, or by the square from `low`, so that values near
  // `low` have narrow bins. Expects at least one bin.
  enum class Spacing : std::uint8_t { kEven, kSquare };
  Distribution(double low, double high, int bins, Spacing spacing);

  // Adds an area in steradians, at most 4 pi in all. A value beyond the ends counts in the bin at that end.
  void add(double value, double area_sr);
  // Adds what another distribution of equal bins holds.
  void include(const Distribution& other);

  bool is_empty() const { return total_ == 0; }
  std::int64_t count() const { return count_; }
  double lowest() const { return lowest_; }  // of the values themselves
  double highest() const { return highest_; }
  double area_sr() const;

  // Returns the value below which this share (0..1) of the area lies. Expects that it is not empty.
  double percentile(double share) const;
  // Returns the share of the area with values from `from` to `to`, linear within bins. 0 if it is empty.
  double share_between(double from, double to) const;
  // Returns the mean and the root of the mean square of the values, each taken as the middle of its bin.
  double mean() const;
  double rms() const;

 private:
  double edge(std::size_t bin) const;
  double share_below(double value) const;

  double low_;
  double high_;
  Spacing spacing_;
  std::vector<std::uint64_t> bins_;
  std::uint64_t total_ = 0;
  std::int64_t count_ = 0;
  double lowest_ = 0;
  double highest_ = 0;
};

}  // namespace vpe::app
