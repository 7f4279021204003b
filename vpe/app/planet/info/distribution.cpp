#include "vpe/app/planet/info/distribution.h"

#include <algorithm>
#include <cmath>

namespace vpe::app {

namespace {

// 4 pi steradians are below 2^63 steps.
constexpr double kStepsPerSteradian = 0x1p59;

}  // namespace

Distribution::Distribution(double low, double high, int bins, Spacing spacing)
    : low_(low), high_(high), spacing_(spacing), bins_(static_cast<std::size_t>(std::max(1, bins))) {}

void Distribution::add(double value, double area_sr) {
  const double at = std::clamp((value - low_) / (high_ - low_), 0.0, 1.0);
  const double bin = (spacing_ == Spacing::kSquare ? std::sqrt(at) : at) * static_cast<double>(bins_.size());
  const auto steps = static_cast<std::uint64_t>(std::llround(area_sr * kStepsPerSteradian));
  bins_[std::min(static_cast<std::size_t>(bin), bins_.size() - 1)] += steps;
  total_ += steps;
  lowest_ = count_ == 0 ? value : std::min(lowest_, value);
  highest_ = count_ == 0 ? value : std::max(highest_, value);
  ++count_;
}

void Distribution::include(const Distribution& other) {
  if (other.count_ == 0) return;
  for (std::size_t n = 0; n < bins_.size(); ++n) bins_[n] += other.bins_[n];
  lowest_ = count_ == 0 ? other.lowest_ : std::min(lowest_, other.lowest_);
  highest_ = count_ == 0 ? other.highest_ : std::max(highest_, other.highest_);
  total_ += other.total_;
  count_ += other.count_;
}

double Distribution::area_sr() const { return static_cast<double>(total_) / kStepsPerSteradian; }

double Distribution::edge(std::size_t bin) const {
  const double at = static_cast<double>(bin) / static_cast<double>(bins_.size());
  return low_ + (high_ - low_) * (spacing_ == Spacing::kSquare ? at * at : at);
}

double Distribution::percentile(double share) const {
  const double wanted = share * static_cast<double>(total_);
  double below = 0;
  for (std::size_t n = 0; n < bins_.size(); ++n) {
    const auto here = static_cast<double>(bins_[n]);
    if (here > 0 && below + here >= wanted) {
      const double value = edge(n) + (edge(n + 1) - edge(n)) * std::max(0.0, wanted - below) / here;
      return std::clamp(value, lowest_, highest_);
    }
    below += here;
  }
  return highest_;
}

double Distribution::share_below(double value) const {
  double below = 0;
  for (std::size_t n = 0; n < bins_.size() && edge(n) < value; ++n) {
    const double width = edge(n + 1) - edge(n);
    below += static_cast<double>(bins_[n]) * std::min(1.0, (value - edge(n)) / width);
  }
  return below / static_cast<double>(total_);
}

double Distribution::share_between(double from, double to) const {
  return total_ == 0 ? 0 : share_below(to) - share_below(from);
}

double Distribution::mean() const {
  double sum = 0;
  for (std::size_t n = 0; n < bins_.size(); ++n)
    sum += static_cast<double>(bins_[n]) * 0.5 * (edge(n) + edge(n + 1));
  return sum / static_cast<double>(total_);
}

double Distribution::rms() const {
  double sum = 0;
  for (std::size_t n = 0; n < bins_.size(); ++n) {
    const double middle = 0.5 * (edge(n) + edge(n + 1));
    sum += static_cast<double>(bins_[n]) * middle * middle;
  }
  return std::sqrt(sum / static_cast<double>(total_));
}

}  // namespace vpe::app
