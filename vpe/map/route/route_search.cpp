#include "vpe/map/route/route_search.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <queue>

namespace vpe::map {

namespace {

constexpr std::array<glm::ivec2, 16> kSteps{{{1, 0},
                                             {0, 1},
                                             {-1, 0},
                                             {0, -1},
                                             {1, 1},
                                             {-1, 1},
                                             {-1, -1},
                                             {1, -1},
                                             {2, 1},
                                             {1, 2},
                                             {-1, 2},
                                             {-2, 1},
                                             {-2, -1},
                                             {-1, -2},
                                             {1, -2},
                                             {2, -1}}};
constexpr std::uint8_t kNoStep = 255;
constexpr std::size_t kCheckEvery = 4096;

// Holds costs and last steps of posts, in blocks that are made when they are needed.
class CostStore {
 public:
  struct Entry {
    double& cost_m;
    std::uint8_t& step;
    std::uint8_t& done;
  };

  CostStore(int columns, int rows)
      : blocks_across_((columns + kSide - 1) / kSide),
        blocks_(static_cast<std::size_t>(blocks_across_) *
                static_cast<std::size_t>((rows + kSide - 1) / kSide)) {}

  Entry at(glm::ivec2 post) {
    auto& block = blocks_[static_cast<std::size_t>(post.y / kSide) * static_cast<std::size_t>(blocks_across_) +
                          static_cast<std::size_t>(post.x / kSide)];
    if (block == nullptr) {
      block = std::make_unique<Block>();
      block->cost_m.fill(std::numeric_limits<double>::infinity());
      block->step.fill(kNoStep);
      block->done.fill(0);
    }
    const auto n = static_cast<std::size_t>(post.y % kSide * kSide + post.x % kSide);
    return {block->cost_m[n], block->step[n], block->done[n]};
  }

 private:
  static constexpr int kSide = 64;
  struct Block {
    std::array<double, kSide * kSide> cost_m;
    std::array<std::uint8_t, kSide * kSide> step;
    std::array<std::uint8_t, kSide * kSide> done;
  };
  int blocks_across_;
  std::vector<std::unique_ptr<Block>> blocks_;
};

struct OpenPost {
  double bound_m = 0;  // of the whole way through this post
  double cost_m = 0;
  glm::ivec2 post{0};
};

// Orders a queue whose top has the least bound.
struct ComesLater {
  bool operator()(const OpenPost& a, const OpenPost& b) const {
    if (a.bound_m != b.bound_m) return a.bound_m > b.bound_m;
    if (a.post.y != b.post.y) return a.post.y > b.post.y;
    return a.post.x > b.post.x;
  }
};

// How many corners straighten() looks ahead in one round.
constexpr std::size_t kAhead = 32;

// Costs that differ by this share are equal but for rounding.
constexpr double kCostSlack = 1e-12;

// Computes the cheapest chain of straight ways over some of the posts, whose steps go at most kAhead posts
// ahead.
std::vector<glm::ivec2> cheapest_chain(const RouteGround& ground, const std::vector<glm::ivec2>& posts,
                                       const std::function<void()>& check) {
  const std::size_t count = posts.size();
  std::vector<double> cost_m(count, std::numeric_limits<double>::infinity());
  std::vector<std::size_t> before(count, 0);
  cost_m[0] = 0;
  for (std::size_t to = 1; to < count; ++to) {
    if (check) check();
    // The longest way comes first, so that equal costs leave out most posts.
    for (std::size_t from = to > kAhead ? to - kAhead : 0; from < to; ++from) {
      const auto way = ground.straight(posts[from], posts[to]);
      if (!way || cost_m[from] + way->cost_m >= cost_m[to] * (1 - kCostSlack)) continue;
      cost_m[to] = cost_m[from] + way->cost_m;
      before[to] = from;
    }
  }
  std::vector<glm::ivec2> chain;
  for (std::size_t n = count - 1; n > 0; n = before[n]) chain.push_back(posts[n]);
  chain.push_back(posts[0]);
  std::reverse(chain.begin(), chain.end());
  return chain;
}

}  // namespace

SearchResult search_route(const RouteGround& ground, glm::ivec2 from, glm::ivec2 to,
                          const std::function<void()>& check) {
  CostStore store(ground.grid().columns, ground.grid().rows);
  std::priority_queue<OpenPost, std::vector<OpenPost>, ComesLater> open;
  store.at(from).cost_m = 0;
  open.push({ground.least_cost_m(from, to), 0, from});
  SearchResult result;
  for (std::size_t n = 1; !open.empty(); ++n) {
    if (check && n % kCheckEvery == 0) check();
    const OpenPost best = open.top();
    open.pop();
    const CostStore::Entry here = store.at(best.post);
    if (best.cost_m > here.cost_m) continue;
    if (here.done == 0) ++result.reached;
    here.done = 1;
    if (best.post == to) break;
    for (std::size_t step = 0; step < kSteps.size(); ++step) {
      const glm::ivec2 next = best.post + kSteps[step];
      if (!ground.is_inside(next) || !ground.is_passable(next)) continue;
      const CostStore::Entry there = store.at(next);
      // Costs at least the length on the map.
      if (best.cost_m >= there.cost_m) continue;
      const auto way = ground.straight(best.post, next);
      if (!way || best.cost_m + way->cost_m >= there.cost_m) continue;
      there.cost_m = best.cost_m + way->cost_m;
      there.step = static_cast<std::uint8_t>(step);
      open.push({there.cost_m + ground.least_cost_m(next, to), there.cost_m, next});
    }
  }
  const CostStore::Entry last = store.at(to);
  if (last.step == kNoStep && from != to) return result;
  result.cost_m = last.cost_m;
  for (glm::ivec2 post = to; post != from; post -= kSteps[store.at(post).step]) result.posts.push_back(post);
  result.posts.push_back(from);
  std::reverse(result.posts.begin(), result.posts.end());
  return result;
}

std::vector<glm::ivec2> straighten(const RouteGround& ground, std::vector<glm::ivec2> posts,
                                   const std::function<void()>& check) {
  while (posts.size() > 2) {
    std::vector<glm::ivec2> chain = cheapest_chain(ground, posts, check);
    const bool is_final = chain.size() == posts.size();
    posts = std::move(chain);
    if (is_final) break;
  }
  return posts;
}

}  // namespace vpe::map
