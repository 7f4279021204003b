#include "vpe/report/papers.h"

#include <algorithm>
#include <stdexcept>

namespace vpe::report {

const PublishedTimes& vyatkin_2002_times() {
  static const PublishedTimes kTimes{
      "Vyatkin and Dolgovesov 2002, Table",
      "Intel Pentium Celeron, 333 MHz; 9 x 21 levels: 512 x 512 pixels, 21 halvings of depth",
      "map_posts",
      "posts on a side of the height map",
      {{1024, 59, "t1024.tga"}, {512, 58, "t512.tga"}, {128, 58, "t128.tga"}, {64, 57, "t64.tga"}},
      64};
  return kTimes;
}

Table compare_times(const PublishedTimes& published, std::span<const Timing> timings) {
  const auto base = std::ranges::find(published.rows, published.base_size, &PublishedTimes::Row::size);
  if (base == published.rows.end()) throw std::invalid_argument("no published row has the base size");
  if (timings.size() != published.rows.size())
    throw std::invalid_argument("not one timing for each published row");
  const Timing& base_timing = timings[static_cast<std::size_t>(base - published.rows.begin())];
  const std::size_t rounds = base_timing.round_s.size();
  for (const Timing& timing : timings) {
    if (timing.round_s.empty() || timing.round_s.size() != rounds)
      throw std::invalid_argument("timings without the same rounds");
  }
  Table table;
  table.columns = {{published.size_name, published.size_meaning},
                   {"published_s", "published time"},
                   {"published_ratio", "published time over that of the base size"},
                   {"here_s", "here: time, median of the rounds"},
                   {"here_least_s", "here: shortest time of a round"},
                   {"here_most_s", "here: longest time of a round"},
                   {"here_ratio", "here: time over that of the base size (median of ratios within a round)"},
                   {"here_ratio_least", "here: smallest ratio of a round"},
                   {"here_ratio_most", "here: largest ratio of a round"},
                   {"ratio_of_ratios", "ratio here over the published ratio"}};
  for (std::size_t n = 0; n < timings.size(); ++n) {
    const std::vector<double>& times = timings[n].round_s;
    std::vector<double> ratios;
    for (std::size_t round = 0; round < rounds; ++round)
      ratios.push_back(times[round] / base_timing.round_s[round]);
    const double published_ratio = published.rows[n].time_s / base->time_s;
    const double here_ratio = ratio(timings[n], base_timing);
    table.add({published.rows[n].size, published.rows[n].time_s, published_ratio, timings[n].median_s(),
               std::ranges::min(times), std::ranges::max(times), here_ratio, std::ranges::min(ratios),
               std::ranges::max(ratios), here_ratio / published_ratio});
  }
  return table;
}

}  // namespace vpe::report
