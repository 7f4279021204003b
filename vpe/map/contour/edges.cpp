#include "vpe/map/contour/edges.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <tuple>

namespace vpe::map {

namespace {

constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

// Holds what begins at one crossing and ends at another one of the same level.
struct DirectedLink {
  std::int64_t multiple = 0;
  std::uint64_t from = 0;
  std::uint64_t to = 0;
};

bool begins_before(const DirectedLink& a, const DirectedLink& b) {
  return std::tie(a.multiple, a.from) < std::tie(b.multiple, b.from);
}

// Returns for each link the one that begins where it ends, or kNone. Links are sorted by begins_before().
std::vector<std::size_t> successors(std::span<const DirectedLink> links) {
  std::vector<std::size_t> next(links.size(), kNone);
  for (std::size_t n = 0; n < links.size(); ++n) {
    const DirectedLink wanted{links[n].multiple, links[n].to, 0};
    const auto found = std::lower_bound(links.begin(), links.end(), wanted, begins_before);
    if (found != links.end() && found->multiple == wanted.multiple && found->from == wanted.from)
      next[n] = static_cast<std::size_t>(found - links.begin());
  }
  return next;
}

// Calls visit(first, closed) for the first link of each line: open ones, then rings. visit() returns nothing.
template <typename Visit>
void for_each_line(const std::vector<std::size_t>& next, const Visit& visit) {
  std::vector<std::uint8_t> has_previous(next.size(), 0);
  for (const std::size_t n : next)
    if (n != kNone) has_previous[n] = 1;
  std::vector<std::uint8_t> done(next.size(), 0);
  const auto finish = [&](std::size_t first) {
    for (std::size_t n = first; n != kNone && done[n] == 0; n = next[n]) done[n] = 1;
  };
  for (const bool is_closed : {false, true}) {
    for (std::size_t n = 0; n < next.size(); ++n) {
      if (done[n] != 0 || (!is_closed && has_previous[n] != 0)) continue;
      visit(n, is_closed);
      finish(n);
    }
  }
}

// Appends the links of one cell at one level. `corners_m` run clockwise from the cell's first post, `edges`
// begin with the one between the first two of them.
void add_links(const std::array<double, 4>& corners_m, const std::array<std::uint64_t, 4>& edges,
               double level_m, std::int64_t multiple, std::vector<DirectedLink>& links) {
  std::array<std::size_t, 4> crossed{};
  std::size_t count = 0;
  for (std::size_t n = 0; n < 4; ++n)
    if ((corners_m[n] >= level_m) != (corners_m[(n + 1) % 4] >= level_m)) crossed[count++] = n;
  const double middle_m = ((corners_m[0] + corners_m[1]) + (corners_m[2] + corners_m[3])) / 4;
  for (std::size_t n = 0; n < count; ++n) {
    if (corners_m[crossed[n]] < level_m) continue;
    // The line begins where the way around the cell goes down. In an ambiguous cell with a high middle it cuts
    // off the low post that follows, else the high one before.
    const std::size_t to = middle_m >= level_m ? (n + 1) % count : (n + count - 1) % count;
    links.push_back({multiple, edges[crossed[n]], edges[crossed[to]]});
  }
}

std::vector<DirectedLink> links_of_rows(const HeightGrid& grid, const LevelScale& scale, int begin, int end) {
  std::vector<DirectedLink> links;
  const auto columns = static_cast<std::uint64_t>(grid.columns);
  for (int row = begin; row < end; ++row) {
    for (int column = 0; column + 1 < grid.columns; ++column) {
      const std::array<double, 4> corners_m{grid.at(column, row), grid.at(column + 1, row),
                                            grid.at(column + 1, row + 1), grid.at(column, row + 1)};
      const auto [low, high] = std::minmax({corners_m[0], corners_m[1], corners_m[2], corners_m[3]});
      if (!std::isfinite(corners_m[0] - corners_m[0] + corners_m[1] - corners_m[1] + corners_m[2] -
                         corners_m[2] + corners_m[3] - corners_m[3]))
        continue;
      const std::uint64_t post = static_cast<std::uint64_t>(row) * columns + static_cast<std::uint64_t>(column);
      const std::array<std::uint64_t, 4> edges{2 * post, 2 * (post + 1) + 1, 2 * (post + columns),
                                               2 * post + 1};
      for (std::int64_t multiple = scale.first_above(low); scale.level_m(multiple) <= high; ++multiple)
        add_links(corners_m, edges, scale.level_m(multiple), multiple, links);
    }
  }
  std::sort(links.begin(), links.end(), begins_before);
  return links;
}

}  // namespace

std::int64_t LevelScale::first_above(double height_m) const {
  auto multiple = static_cast<std::int64_t>(std::floor((height_m - base_m) / interval_m)) + 1;
  while (level_m(multiple) <= height_m) ++multiple;
  while (level_m(multiple - 1) > height_m) --multiple;
  return multiple;
}

std::vector<EdgeChain> chains_of_rows(const HeightGrid& grid, const LevelScale& scale, int begin, int end) {
  const std::vector<DirectedLink> links = links_of_rows(grid, scale, begin, end);
  const std::vector<std::size_t> next = successors(links);
  std::vector<EdgeChain> chains;
  for_each_line(next, [&](std::size_t first, bool is_closed) {
    EdgeChain chain{links[first].multiple, is_closed, {links[first].from}};
    for (std::size_t n = first;;) {
      if (is_closed && next[n] == first) break;
      chain.edges.push_back(links[n].to);
      n = next[n];
      if (n == kNone) break;
    }
    chain.edges.shrink_to_fit();
    chains.push_back(std::move(chain));
  });
  return chains;
}

std::vector<EdgeChain> join_chains(std::vector<EdgeChain> chains) {
  std::vector<EdgeChain> joined;
  std::vector<EdgeChain> open;
  for (EdgeChain& chain : chains) (chain.is_closed ? joined : open).push_back(std::move(chain));
  chains.clear();
  std::sort(open.begin(), open.end(), [](const EdgeChain& a, const EdgeChain& b) {
    return std::make_tuple(a.multiple, a.edges.front()) < std::make_tuple(b.multiple, b.edges.front());
  });
  std::vector<DirectedLink> links;
  links.reserve(open.size());
  for (const EdgeChain& chain : open)
    links.push_back({chain.multiple, chain.edges.front(), chain.edges.back()});
  const std::vector<std::size_t> next = successors(links);
  for_each_line(next, [&](std::size_t first, bool is_closed) {
    EdgeChain line{open[first].multiple, is_closed, std::move(open[first].edges)};
    for (std::size_t n = next[first]; n != kNone && n != first; n = next[n]) {
      line.edges.insert(line.edges.end(), open[n].edges.begin() + 1, open[n].edges.end());
      open[n].edges = {};
    }
    if (is_closed) line.edges.pop_back();
    joined.push_back(std::move(line));
  });
  for (EdgeChain& line : joined)
    if (line.is_closed)
      std::rotate(line.edges.begin(), std::min_element(line.edges.begin(), line.edges.end()), line.edges.end());
  std::sort(joined.begin(), joined.end(), [](const EdgeChain& a, const EdgeChain& b) {
    return std::make_tuple(a.multiple, a.edges.front()) < std::make_tuple(b.multiple, b.edges.front());
  });
  return joined;
}

}  // namespace vpe::map
