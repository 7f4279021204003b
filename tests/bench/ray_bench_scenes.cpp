#include "tests/bench/ray_bench_scenes.h"

#include <algorithm>
#include <chrono>
#include <cstdio>

#include "paging/build/builder.h"
#include "tests/lod/mesh_terrain.h"
#include "tests/support/fake_source.h"

namespace bench {

namespace {

constexpr int kTileK = 7;
constexpr double kBaseSpacing_m = 5300;
constexpr std::uint64_t kSeed = 1996;
constexpr int kRevision = 1;  // of the ground below; files of another revision are not used

// Provides fractal ground with craters in the patch, of the wanted height range, with waves up to half the
// patch.
class PatchElevation : public test_support::FakeElevation {
 public:
  explicit PatchElevation(const PatchSpec& spec)
      : FakeElevation([](const glm::dvec3&) { return 0.0; }),
        spec_(spec),
        terrain_(kSeed, 0.1 * side_m(), 0.5 * side_m()) {
    const mars::Cap cap = lod::bounding_cap(spec.patch);
    terrain_.add_craters(cap.centre, cap.radius_rad, 60, side_m() / 200, side_m() / 12);
    const lod::Posts posts = terrain_.posts(spec.patch, 256);
    const auto [low, high] = std::minmax_element(posts.height_m.begin(), posts.height_m.end());
    const double wanted_m =
        spec.relief_cells * side_m() / static_cast<double>(1 << (spec.levels_below + kTileK));
    low_m_ = *low;
    scale_ = wanted_m / (*high - *low);
  }

  void sample(std::span<const glm::dvec3> directions, double spacing_m,
              std::span<double> heights_m) const override {
    for (std::size_t n = 0; n < directions.size(); ++n)
      heights_m[n] = scale_ * (terrain_.height_m(directions[n], spacing_m) - low_m_);
  }

  // Fine in the patch and in the tiles that contain it, so that the tree is refined down to it.
  double spacing_in(const mars::Cap& cap) const override {
    const mars::ChartPoint middle = mars::chart_point(cap.centre);
    for (int level = 0; level <= spec_.patch.level + spec_.levels_below; ++level) {
      const lod::TileKey key = lod::tile_at(middle, level);
      if (glm::length(lod::bounding_cap(key).centre - cap.centre) > 1e-12) continue;
      if (lod::contains(key, spec_.patch) || lod::contains(spec_.patch, key)) return finest_m();
    }
    return 1e9;
  }

  double finest_m() const {
    return 1.5 * lod::post_spacing_m(spec_.patch.level + spec_.levels_below, 1 << kTileK, lod_test::kRadius);
  }

 private:
  double side_m() const { return lod::nominal_side_m(spec_.patch.level, lod_test::kRadius); }

  PatchSpec spec_;
  lod_test::Terrain terrain_;
  double low_m_ = 0;
  double scale_ = 1;
};

}  // namespace

const std::vector<PatchSpec>& patch_specs() {
  static const std::vector<PatchSpec> kSpecs{
      {"513", {mars::Face::kPlusX, 9, 300, 208}, 2, 64},
      {"2049", {mars::Face::kPlusX, 7, 75, 52}, 4, 160},
      {"8193", {mars::Face::kPlusX, 7, 75, 52}, 6, 336},
  };
  return kSpecs;
}

RayScene patch_scene(const PatchSpec& spec, const std::filesystem::path& folder, int threads) {
  const std::filesystem::path file =
      folder / ("ray-bench-" + spec.name + "-" + std::to_string(kRevision) + ".vpe");
  if (!std::filesystem::exists(file)) {
    std::filesystem::create_directories(folder);
    const auto start = std::chrono::steady_clock::now();
    paging::BuildOptions options;
    options.output = file.string();
    options.base_spacing_m = kBaseSpacing_m;
    options.tile_k = kTileK;
    options.threads = threads;
    options.resampling_posts = 5000;
    const PatchElevation source(spec);
    paging::build_planet(options, source, nullptr);
    std::fprintf(stderr, "built %s in %.0f s\n", file.c_str(),
                 std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  return {spec.name, paging::PlanetFile::open(file.string()), lod::bounding_cap(spec.patch).centre};
}

RayScene planet_scene(const std::string& name, const std::string& file) {
  return {name, paging::PlanetFile::open(file), mars::direction({-67.0, -13.0})};
}

}  // namespace bench
