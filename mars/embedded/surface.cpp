#include "mars/embedded/surface.h"

#include <algorithm>
#include <memory>
#include <vector>

#include "mars/embedded/block.h"
#include "mars/embedded/detail.h"
#include "mars/embedded/landforms.h"
#include "mars/embedded/math.h"

namespace mars::embedded {

namespace {

// Octaves have wavelengths of 2^k metres.
constexpr int kFirstOctave = 1;
constexpr int kFirstRugged =
    13;  // Terrain::rugged scales wavelengths of 8 km and more, Terrain::rough shorter ones

// Returns the standard deviation of an octave in the highlands, in metres.
constexpr float amplitude_m(int octave) {
  constexpr float kLong[] = {18, 28, 42, 56, 60, 45, 30};
  if (octave >= kFirstRugged) return kLong[octave - kFirstRugged];
  float a = 21.0F;
  for (int k = 12; k > octave; --k) a *= k > 7 ? 0.56F : 0.55F;
  return a;
}

// Returns the octave that distorts the outlines of craters of a level: about their radius.
int ragged_octave(int level, int first) {
  return std::max(std::max(first, kFirstOctave), std::min(level, kLastOctave));
}

void roughen(const Block& block, double detail_m, const Octaves& octaves, Surface& out) {
  Lane<float> sum{};
  Lane<float> fine{};
  Lane<float> patch;
  Lane<float> buried, bare, even, uncovered;
  Sand sand;
  const bool sandy = lay_sand(block, detail_m, octaves, out.ground, out.craters, sand);
  const auto& broad = octaves.n[15];
  const auto& middle = octaves.n[static_cast<std::size_t>(std::max(12, octaves.first))];
  with_simd(block.simd, [&] {
    for (std::size_t i = 0; i < block.padded; ++i) {
      const float p = 0.85F + 0.30F * broad[i] + (octaves.first <= 12 ? 0.22F * middle[i] : 0.0F);
      patch[i] = std::max(0.25F, std::min(1.7F, p));
      buried[i] = std::max(out.craters.buried[i], out.craters.filled[i]);
      const float open = 1.0F - 0.8F * sand.cover[i];
      bare[i] = out.ground.rough[i] * patch[i] * open;
      even[i] = std::min(1.0F, out.ground.rough[i] * patch[i]) * open;
      uncovered[i] = bare[i] * (1.0F - 0.7F * buried[i]);
    }
    for (int k = kLastOctave; k >= octaves.first; --k) {
      const float a = amplitude_m(k);
      const Lane<float>& n = octaves.n[static_cast<std::size_t>(k)];
      if (k >= kFirstRugged) {
        for (std::size_t i = 0; i < block.padded; ++i) {
          const float r = out.ground.rugged[i];
          // Ruggedness above 1 means mountains: crests instead of swells, with more of the shorter ones.
          const float crag = std::max(0.0F, r - 1.2F);
          const float crest = (0.75F - magnitude(n[i])) * crag * (k <= 16 ? 3.2F : 0.5F);
          const float keep = 1.0F - out.craters.filled[i] * (k <= kBasinLevel ? 0.8F : 0.0F);
          sum[i] += a * (r * n[i] + crest) * keep;
        }
      } else {
        // Craters and sand smooth the roughness; stones and dust equalise the shortest octaves.
        const Lane<float>& amount = k >= 8 ? uncovered : (k > 5 ? bare : even);
        for (std::size_t i = 0; i < block.padded; ++i) {
          const float crest = (0.72F - magnitude(n[i])) * 0.5F;
          sum[i] += a * amount[i] * (0.8F * n[i] + crest);
          fine[i] = fine[i] * 0.82F + 0.55F * n[i];
        }
      }
    }
    // Lava flows form terraces with steep lobate fronts.
    if (detail_m <= 2048.0) {
      for (std::size_t i = 0; i < block.padded; ++i) {
        const float x = 1.7F * octaves.n[16][i] + 0.7F * octaves.n[14][i] + 0.35F * octaves.n[12][i] + 64.0F;
        const auto whole = static_cast<float>(static_cast<std::int32_t>(x));
        const float front = std::min(1.0F, (x - whole) * 6.0F);
        sum[i] += 24.0F * out.ground.volcanic[i] * (whole - 64.0F + front * front * (3.0F - 2.0F * front)) *
                  (1.0F - out.ground.wall[i]);
      }
    }
    // Valley networks in the highlands and wrinkle ridges on the plains follow zero lines of the longer
    // octaves.
    if (detail_m <= 2048.0) {
      for (std::size_t i = 0; i < block.padded; ++i) {
        const float distortion = 0.26F * octaves.n[15][i] + 0.10F * octaves.n[13][i];
        const float bed = std::max(0.0F, 1.0F - magnitude(octaves.n[17][i] + distortion) * (1.0F / 0.11F));
        const float ridge =
            std::max(0.0F, 1.0F - magnitude(octaves.n[16][i] + 0.5F * distortion + 0.35F) * (1.0F / 0.085F));
        const float old = std::max(0.0F, out.ground.cratered[i] - 0.5F) * 2.0F * (1.0F - buried[i]);
        const float plain = std::max(out.ground.lowland[i], out.ground.volcanic[i] * 0.8F) *
                            (1.0F - out.ground.ice[i]) * (1.0F - out.ground.trough[i]) *
                            (1.0F - out.ground.wall[i]);
        sum[i] += 60.0F * plain * ridge * ridge * (3.0F - 2.0F * ridge) - 110.0F * old * bed * bed;
      }
    }
  });
  if (sandy) {
    with_simd(block.simd, [&] {
      for (std::size_t i = 0; i < block.padded; ++i) sum[i] += sand.height_m[i];
    });
  } else {
    sand.crest.fill(0.0F);
  }
  if (detail_m <= kCoarsestDetail_m) {
    for (std::size_t i = 0; i < block.padded; ++i) patch[i] *= out.ground.rough[i];
    add_detail(block, detail_m, sand, patch, out, sum, fine);
  } else {
    out.rock.fill(0.0F);
    out.rock_tone.fill(0.0F);
  }
  out.sand = sand.cover;
  out.crest = sand.crest;
  with_simd(block.simd, [&] {
    for (std::size_t i = 0; i < block.padded; ++i) {
      // Large craters end where a younger trough or the ice begins, and are partly filled on the deepest
      // floors.
      const double young = std::max({out.ground.trough[i], out.ground.wall[i], out.ground.ice[i]});
      const double open = (1.0 - young) * (0.35 + 0.65 * ramp(-7600.0, -5200.0, out.ground.height_m[i]));
      const double craters =
          static_cast<double>(out.craters.relief[i]) + open * static_cast<double>(out.craters.large[i]);
      out.height_m[i] = out.ground.height_m[i] + static_cast<double>(sum[i]) +
                        craters * (1.0 / static_cast<double>(kCraterUnits));
      out.grain[i] = fine[i];
    }
  });
}

// Sorts directions into blocks, in place, and evaluates the blocks.
class Splitter {
 public:
  Splitter(std::span<const glm::dvec3> directions, double detail_m, Simd simd, const SurfaceSink& sink)
      : detail_m_(detail_m), simd_(simd), sink_(sink), smallest_(smallest_crater_level(detail_m)) {
    posts_.resize(directions.size());
    for (std::size_t i = 0; i < directions.size(); ++i)
      posts_[i] = {directions[i], static_cast<std::uint32_t>(i)};
    surface_ = std::make_unique_for_overwrite<Surface>();
  }

  void run() {
    if (!posts_.empty()) split(posts_, kLargestCraterLevel, 0, 0, true);
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

  void split(std::span<Post> posts, int level, std::size_t inherited_begin, std::size_t inherited_end,
             bool root) {
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
    if (root) find_named_craters(centre, reach, 4.0 * detail_m_, craters_);
    candidates_.clear();
    while (level >= smallest_ && affordable(reach, level, posts.size()))
      find_candidates(centre, reach, level--, candidates_);
    if (!candidates_.empty()) keep_craters(candidates_, simd_, craters_);
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
    split(posts.first(left), level, begin, end, false);
    split(posts.subspan(left), level, begin, end, false);
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
    evaluate(block, detail_m_, craters_, std::span(touching_).subspan(begin, end - begin), *surface_);
    sink_(block, std::span(index).first(posts.size()), *surface_);
  }

  static std::vector<Post>& scratch() {
    static thread_local std::vector<Post> posts;
    return posts;
  }

  // Reused by later calls: allocating fresh pages for each tile would cost more than sorting it.
  std::vector<Post>& posts_ = scratch();
  std::vector<Crater> craters_;
  std::vector<std::uint32_t> touching_;
  std::vector<Candidate> candidates_;
  double detail_m_;
  Simd simd_;
  const SurfaceSink& sink_;
  int smallest_;
  std::unique_ptr<Surface> surface_;
};

}  // namespace

double detail_spacing_m(double spacing_m) {
  double detail = kFinestDetail_m;
  while (detail < 1048576.0 && 2.0 * detail <= spacing_m) detail *= 2.0;
  return detail;
}

void evaluate(const Block& block, double detail_m, std::span<const Crater> craters,
              std::span<const std::uint32_t> touching, Surface& out) {
  Octaves& octaves = out.octaves;
  octaves.first = kFirstOctave;
  while (octaves.first < kOutlineOctave && static_cast<double>(1 << octaves.first) < 2.0 * detail_m)
    ++octaves.first;
  for (int k = octaves.first; k <= kLastOctave; ++k) add_octave(block, k, octaves);
  terrain(block, octaves, detail_m, out.ground);
  out.craters.clear();
  for (const std::uint32_t k : touching) {
    const Crater& c = craters[k];
    if (!block.near(c.centre, c.radius_m * kEjectaReach / kRadius_m)) continue;
    add_crater(block, c, octaves.n[static_cast<std::size_t>(ragged_octave(c.level, octaves.first))],
               out.craters);
  }
  roughen(block, detail_m, octaves, out);
}

void evaluate_all(std::span<const glm::dvec3> directions, double spacing_m, Simd simd,
                  const SurfaceSink& sink) {
  Splitter(directions, detail_spacing_m(spacing_m), simd, sink).run();
}

}  // namespace mars::embedded
