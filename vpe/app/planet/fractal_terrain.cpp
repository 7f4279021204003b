#include "vpe/app/planet/fractal_terrain.h"

#include <chrono>
#include <cmath>
#include <glm/geometric.hpp>

#include "lod/tree/posts.h"
#include "paging/build/builder.h"
#include "vpe/report/processor_time.h"
#include "vpe/report/value_noise.h"

namespace vpe::app {
namespace {

constexpr std::uint64_t kSeed = 19960713;
constexpr double kLongest_m = 20000;
constexpr double kHeightOfWave = 0.02;    // as a share of its length
constexpr double kRootSpacing_m = 45000;  // of the six tiles of level 0

double height_m(const glm::dvec3& direction, double spacing_m) {
  double height = 0;
  std::uint64_t seed = kSeed;
  double wave = kLongest_m;
  while (wave >= 2 * spacing_m) {
    height += kHeightOfWave * wave * report::value_noise(direction * (mars::kMarsRadius_m / wave), seed++);
    wave *= 0.5;
  }
  return height;
}

// Adds the processor time of this thread, while the object lives, to a sum.
class Spent {
 public:
  explicit Spent(std::atomic<std::int64_t>& sum_ns) : sum_ns_(sum_ns) {}
  ~Spent() { sum_ns_ += report::thread_processor_ns() - begin_ns_; }
  Spent(const Spent&) = delete;
  Spent& operator=(const Spent&) = delete;

 private:
  std::atomic<std::int64_t>& sum_ns_;
  std::int64_t begin_ns_ = report::thread_processor_ns();
};

}  // namespace

double PatchSpec::spacing_m() const {
  return lod::post_spacing_m(finest_level(), 1 << kPatchTileK, mars::kMarsRadius_m);
}

FractalPatch::FractalPatch(const PatchSpec& spec) : spec_(spec) {}

std::vector<mars::SourceInfo> FractalPatch::infos() const {
  mars::SourceInfo info;
  info.name = "fractal ground for measurements, " + std::to_string(spec_.side_posts()) + " posts a side";
  info.resolution_m = spec_.spacing_m();
  info.datum = mars::VerticalDatum::sphere(mars::kMarsRadius_m);
  info.illustration = true;
  return {info};
}

void FractalPatch::sample(std::span<const glm::dvec3> directions, double spacing_m,
                          std::span<double> heights_m) const {
  const Spent spent(spent_ns_);
  for (std::size_t n = 0; n < directions.size(); ++n) heights_m[n] = height_m(directions[n], spacing_m);
}

void FractalPatch::origin(std::span<const glm::dvec3>, std::span<int> source_index) const {
  std::fill(source_index.begin(), source_index.end(), 0);
}

double FractalPatch::spacing_in(const mars::Cap& cap) const {
  const mars::ChartPoint middle = mars::chart_point(cap.centre);
  for (int level = 0; level <= spec_.finest_level(); ++level) {
    const lod::TileKey key = lod::tile_at(middle, level);
    if (glm::length(lod::bounding_cap(key).centre - cap.centre) > 1e-12) continue;
    if (lod::contains(key, spec_.patch) || lod::contains(spec_.patch, key)) return 1.5 * spec_.spacing_m();
  }
  return 1e9;
}

void FractalPatch::visit_posts(std::size_t max_posts, const mars::PostVisitor& visit) const {
  const int intervals = spec_.side_posts() - 1;
  const double all = static_cast<double>(intervals) * intervals;
  int step = 4;
  while (all / step / step > static_cast<double>(max_posts)) step *= 2;
  std::vector<glm::dvec3> directions(static_cast<std::size_t>(intervals / step));
  std::vector<double> heights(directions.size());
  const lod::GridLines lines = lod::grid_lines(spec_.patch, intervals);
  for (int j = step / 2; j < intervals; j += step) {
    {
      const Spent spent(spent_ns_);
      for (std::size_t n = 0; n < directions.size(); ++n) {
        const auto i = static_cast<std::size_t>(step / 2) + n * static_cast<std::size_t>(step);
        directions[n] =
            mars::chart_direction(spec_.patch.face, lines.u[i], lines.v[static_cast<std::size_t>(j)]);
        heights[n] = height_m(directions[n], spec_.spacing_m());
      }
    }
    visit(directions, heights);
  }
}

double FractalPatch::processor_s() const { return 1e-9 * static_cast<double>(spent_ns_.load()); }

PatchBuild build_patch(const PatchSpec& spec, const std::filesystem::path& file, int threads,
                       const std::function<void(double)>& step) {
  paging::BuildOptions options;
  options.output = file.string();
  options.base_spacing_m = kRootSpacing_m;
  options.tile_k = kPatchTileK;
  options.threads = threads;
  const FractalPatch terrain(spec);
  const double begin_s = report::processor_s();
  const auto start = std::chrono::steady_clock::now();
  const paging::BuildSummary summary = paging::build_planet(
      options, terrain, nullptr, [&](const paging::BuildProgress& progress) { step(progress.fraction); });
  PatchBuild out;
  out.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  out.processor_s = report::processor_s() - begin_s - terrain.processor_s();
  out.bytes = summary.bytes;
  out.finest_posts = summary.meta.leaf_tiles * summary.meta.tile.post_count();
  out.planet = paging::PlanetFile::open(file.string());
  const lod::TileTree& tree = out.planet->tree();
  for (lod::TileTree::Index n = 0; n < static_cast<lod::TileTree::Index>(tree.size()); ++n) {
    if (tree[n].has_children || !lod::contains(spec.patch, tree[n].key)) continue;
    out.patch_cells += std::int64_t{1} << (2 * kPatchTileK);
  }
  return out;
}

}  // namespace vpe::app
