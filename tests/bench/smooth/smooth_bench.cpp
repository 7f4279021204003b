// Compares casts of smooth ground (rays.mode=perturbation) with exact columns over the same tiles, at equal pixels.
// docs/measurements/relief.md has the figures.
//
//   smooth_bench table PLANET [ROUNDS]          a table of views; one thread; medians of processor time in
//                                              interleaved rounds, and of ratios by round
//   smooth_bench once PLANET VIEW KIND          one cast after another one that loads, for callgrind
//
// VIEW is the number of a row of the table; KIND is bicubic, bilinear, or exact.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <string>
#include <vector>

#include "mars/geodesy/pose.h"
#include "vpe/base/parallel.h"
#include "vpe/voxel/cast/range_caster.h"
#include "vpe/voxel/smooth/smooth_caster.h"

namespace {

using vpe::core::RayPatch;
using vpe::core::View;

struct NamedView {
  const char* name;
  double height_m;
  double pitch_deg;
  double fov_deg;
};

// Over Gale: along the ground, down at magnified posts, and from far.
constexpr NamedView kViews[]{
    {"100 m up, level", 100, 0, 60},          {"1 km up, -10 degrees", 1000, -10, 60},
    {"1 km up, -45 degrees", 1000, -45, 60},  {"10 km up, -20 degrees", 10000, -20, 60},
    {"100 km up, -30 degrees", 1e5, -30, 60}, {"1000 km up, down", 1e6, -90, 60}};

struct Scene {
  explicit Scene(const std::string& path)
      : planet(paging::PlanetFile::open(path)),
        caster(planet, std::size_t{2} << 30),
        ground(caster.surface(), std::size_t{2} << 30) {}

  View view(const NamedView& named) const {
    const mars::LonLat place{137.4, -4.6};
    const double ground_m = std::max(caster.surface().at(mars::direction(place)).height_m,
                                     ground.at(mars::direction(place), {}).height_m);
    View v;
    v.width = 960;
    v.height = 540;
    v.fov_deg = named.fov_deg;
    v.camera = mars::to_camera(
        {place.lon_deg, place.lat_deg, ground_m + named.height_m, 110, named.pitch_deg, 0}, planet->radius_m());
    return v;
  }

  std::shared_ptr<const paging::PlanetFile> planet;
  vpe::voxel::RangeCaster caster;
  vpe::voxel::SmoothGround ground;
};

enum class Kind { kExact, kBicubic, kBilinear };

double once_ms(Scene& scene, const View& view, Kind kind, vpe::base::ThreadPool& pool) {
  std::vector<float> range_m(static_cast<std::size_t>(view.width) * static_cast<std::size_t>(view.height));
  std::vector<vpe::voxel::PixelNormal> normals(kind == Kind::kExact ? 0 : range_m.size());
  // Of the processor: other work on the machine does not count.
  const std::clock_t start = std::clock();
  if (kind == Kind::kExact) {
    scene.caster.cast(view, {}, pool, range_m);
  } else {
    const RayPatch patch = kind == Kind::kBicubic ? RayPatch::kBicubic : RayPatch::kBilinear;
    cast_smooth(scene.ground, view, {patch, 1}, pool, {range_m, normals});
  }
  return 1000.0 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

void table(const std::string& path, int rounds) {
  Scene scene(path);
  vpe::base::ThreadPool pool(1);
  std::printf("| view | exact, ms | bicubic, ms | ratio | bilinear, ms | ratio |\n|---|---|---|---|---|---|\n");
  for (const NamedView& named : kViews) {
    const View view = scene.view(named);
    std::vector<double> exact, bicubic, bilinear, bicubic_ratio, bilinear_ratio;
    for (int round = 0; round <= rounds; ++round) {
      const double e = once_ms(scene, view, Kind::kExact, pool);
      const double c = once_ms(scene, view, Kind::kBicubic, pool);
      const double l = once_ms(scene, view, Kind::kBilinear, pool);
      if (round == 0) continue;  // it loads
      exact.push_back(e);
      bicubic.push_back(c);
      bilinear.push_back(l);
      bicubic_ratio.push_back(c / e);
      bilinear_ratio.push_back(l / e);
    }
    std::printf("| %s | %.1f | %.1f | %.1f | %.1f | %.1f |\n", named.name, median(exact), median(bicubic),
                median(bicubic_ratio), median(bilinear), median(bilinear_ratio));
    std::fflush(stdout);
  }
}

}  // namespace

int main(int argc, char** argv) {
  const std::string what = argc > 2 ? argv[1] : "";
  if (what == "table") {
    table(argv[2], argc > 3 ? std::atoi(argv[3]) : 5);
    return 0;
  }
  if (what == "once" && argc > 4) {
    Scene scene(argv[2]);
    vpe::base::ThreadPool pool(1);
    const std::string kind = argv[4];
    const View view =
        scene.view(kViews[std::clamp(std::atoi(argv[3]), 0, static_cast<int>(std::size(kViews)) - 1)]);
    const Kind as = kind == "exact" ? Kind::kExact : (kind == "bicubic" ? Kind::kBicubic : Kind::kBilinear);
    once_ms(scene, view, as, pool);
    std::printf("%.1f ms\n", once_ms(scene, view, as, pool));
    return 0;
  }
  std::fprintf(stderr, "smooth_bench table PLANET [ROUNDS] | smooth_bench once PLANET VIEW KIND\n");
  return 2;
}
