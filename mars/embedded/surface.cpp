#include "mars/embedded/surface.h"

#include <algorithm>
#include <memory>
#include <vector>

#include "mars/embedded/math.h"
#include "mars/embedded/pins.h"

namespace mars::embedded {

namespace {

// Returns the octave that distorts the outlines of craters of a level: about their radius.
int ragged_octave(int level, int first) { return std::max(first, std::min(level, kLastOctave)); }

// Evaluates a block. `touching` are the indices of the craters that may touch it.
void evaluate(const Block& block, const MeasuredMars& mars, double detail_m, Wanted wanted,
              std::span<const Crater> craters, std::span<const std::uint32_t> touching, Surface& out) {
  if (detail_m >= kCoarsestRelief_m) {
    lay_measured(block, mars, out.ground);
    out.octaves.first = kOutlineOctave;
    std::fill_n(out.detail_m.begin(), block.padded, 0.0F);
    out.height_m = out.ground.height_m;
    return;
  }
  lay_ground(block, mars, out.ground);
  add_octaves(block, detail_m, out.octaves);
  out.craters.clear();
  for (const std::uint32_t k : touching) {
    const Crater& c = craters[k];
    if (!block.near(c.centre, c.radius_m * kEjectaReach / kRadius_m)) continue;
    add_crater(block, c, out.octaves.n[static_cast<std::size_t>(ragged_octave(c.level, out.octaves.first))],
               out.ground.post_m, out.craters);
  }
  lay_relief(block, detail_m, out.ground, out.octaves, out.craters, out.relief);
  lay_near_relief(block, detail_m, out.ground, out.octaves, out.craters, out.relief);
  if (wanted == Wanted::kColours) return;
  sum_pinned(block, mars, detail_m, out.ground, out.relief, out.detail_m);
  with_simd(block.simd, [&] {
    for (std::size_t i = 0; i < block.padded; ++i)
      out.detail_m[i] += static_cast<float>(out.craters.relief[i]) * (1.0F / kCraterUnits);
  });
  if (wanted == Wanted::kHeights) subtract_means(block, mars, detail_m, out.ground, out.detail_m);
  // At a pole all meridians meet: detail ends within its last circle of posts.
  constexpr double kLastRow = 0.5 * kMeasuredColumns - 1.0;
  with_simd(block.simd, [&] {
    for (std::size_t i = 0; i < block.padded; ++i) {
      const double beyond = std::max(-out.ground.places.row[i], out.ground.places.row[i] - kLastRow);
      out.detail_m[i] *= static_cast<float>(1.0 - ramp(0.0, 0.5, beyond));
      out.height_m[i] = out.ground.height_m[i] + static_cast<double>(out.detail_m[i]);
    }
  });
}

// Sorts directions into blocks, in place, and evaluates the blocks.
class Splitter {
 public:
  Splitter(const MeasuredMars& mars, std::span<const glm::dvec3> directions, double detail_m, Simd simd,
           Wanted wanted, const SurfaceSink& sink)
      : scratch_(scratch(wanted)),
        mars_(mars),
        detail_m_(detail_m),
        simd_(simd),
        wanted_(wanted),
        sink_(sink),
        smallest_(detail_m < kCoarsestRelief_m ? smallest_crater_level(detail_m) : kLargestCraterLevel + 1) {
    posts_.resize(directions.size());
    for (std::size_t i = 0; i < directions.size(); ++i)
      posts_[i] = {directions[i], static_cast<std::uint32_t>(i)};
  }

  void run() {
    if (!posts_.empty()) split(posts_, kLargestCraterLevel, 0, 0);
  }

 private:
  struct Post {
    glm::dvec3 direction;
    std::uint32_t index;
  };

  // Returns true if searching the lattice cells of a level now costs little relative to the number of posts.
  static bool affordable(double reach, int level, std::size_t posts) {
    const double cells = 2.0 * reach * kRadius_m / crater_cell_m(level) + 3.5;
    return posts == 1 || cells * cells * cells <= 1200.0 + 2.0 * static_cast<double>(posts);
  }

  void split(std::span<Post> posts, int level, std::size_t inherited_begin, std::size_t inherited_end) {
    glm::dvec3 low = posts[0].direction;
    glm::dvec3 high = low;
    for (const Post& p : posts) {
      low = {std::min(low.x, p.direction.x), std::min(low.y, p.direction.y), std::min(low.z, p.direction.z)};
      high = {std::max(high.x, p.direction.x), std::max(high.y, p.direction.y),
              std::max(high.z, p.direction.z)};
    }
    const glm::dvec3 centre = (low + high) * 0.5;
    const glm::dvec3 size = high - low;
    const double reach = 0.5 * std::sqrt(size.x * size.x + size.y * size.y + size.z * size.z) + 1e-14;

    // All craters are in one list; a node has the indices of those that may touch it.
    const std::size_t known = craters_.size();
    candidates_.clear();
    while (level >= smallest_ && affordable(reach, level, posts.size()))
      find_candidates(centre, reach, level--, candidates_);
    if (!candidates_.empty()) keep_craters(candidates_, mars_, simd_, craters_);
    const std::size_t begin = touching_.size();
    for (std::size_t k = inherited_begin; k < inherited_end; ++k) {
      const Crater& c = craters_[touching_[k]];
      const double limit = reach + c.radius_m * kEjectaReach / kRadius_m;
      if (chord2(c.centre, centre) <= limit * limit) touching_.push_back(touching_[k]);
    }
    for (std::size_t k = known; k < craters_.size(); ++k) touching_.push_back(static_cast<std::uint32_t>(k));
    const std::size_t end = touching_.size();

    const double longest = std::max({size.x, size.y, size.z});
    // Rocks are searched over the whole extent of a block, so at fine spacings it must not be much wider than
    // its posts.
    const bool compact = detail_m_ > kCoarsestDetail_m || reach * kRadius_m <= 32.0 * detail_m_;
    if ((posts.size() <= kBlock && level < smallest_ && compact) || longest == 0.0) {
      for (std::size_t first = 0; first < posts.size(); first += kBlock) {
        leaf(posts.subspan(first, std::min(kBlock, posts.size() - first)), begin, end);
      }
      craters_.resize(known);
      touching_.resize(begin);
      return;
    }
    const int axis = size.x == longest ? 0 : (size.y == longest ? 1 : 2);
    const double middle = centre[axis];
    const auto cut = std::partition(posts.begin(), posts.end(),
                                    [axis, middle](const Post& p) { return p.direction[axis] < middle; });
    const auto count = static_cast<std::size_t>(cut - posts.begin());
    // Rounding may put the middle on an end if the extent is a single step.
    const std::size_t left = std::clamp<std::size_t>(count, 1, posts.size() - 1);
    split(posts.first(left), level, begin, end);
    split(posts.subspan(left), level, begin, end);
    craters_.resize(known);
    touching_.resize(begin);
  }

  void leaf(std::span<const Post> posts, std::size_t begin, std::size_t end) {
    Block block;
    block.simd = simd_;
    block.count = posts.size();
    std::array<std::uint32_t, kBlock> index;
    for (std::size_t i = 0; i < posts.size(); ++i) {
      block.x[i] = posts[i].direction.x;
      block.y[i] = posts[i].direction.y;
      block.z[i] = posts[i].direction.z;
      index[i] = posts[i].index;
    }
    block.finish();
    evaluate(block, mars_, detail_m_, wanted_, craters_, std::span(touching_).subspan(begin, end - begin),
             scratch_.surface);
    sink_(block, std::span(index).first(posts.size()), scratch_.surface);
  }

  // Holds memory that later calls use again: allocating fresh pages for each tile would cost more than sorting it.
  struct Scratch {
    std::vector<Post> posts;
    Surface surface;
  };
  static Scratch& scratch(Wanted wanted) {
    // Means are found while a block is evaluated.
    static thread_local std::unique_ptr<Scratch> both[2];
    auto& mine = both[wanted == Wanted::kHeightsWithoutMeans ? 1 : 0];
    if (mine == nullptr) mine = std::make_unique<Scratch>();
    return *mine;
  }

  Scratch& scratch_;
  std::vector<Post>& posts_ = scratch_.posts;
  std::vector<Crater> craters_;
  std::vector<std::uint32_t> touching_;
  std::vector<Candidate> candidates_;
  const MeasuredMars& mars_;
  double detail_m_;
  Simd simd_;
  Wanted wanted_;
  const SurfaceSink& sink_;
  int smallest_;
};

}  // namespace

double detail_spacing_m(double spacing_m) {
  double detail = kFinestDetail_m;
  while (detail < 1048576.0 && 2.0 * detail <= spacing_m) detail *= 2.0;
  return detail;
}

void evaluate_all(const MeasuredMars& mars, std::span<const glm::dvec3> directions, double spacing_m, Simd simd,
                  Wanted wanted, const SurfaceSink& sink) {
  Splitter(mars, directions, detail_spacing_m(spacing_m), simd, wanted, sink).run();
}

}  // namespace mars::embedded
