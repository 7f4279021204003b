// Times range images of the ray backend against Embree over the same triangles. docs/measurements/rays.md has
// the figures.
//
//   ray_bench [--dir DIR] [--scenes 513,2049,8193,mars] [--mars FILE] [--scale 1] [--threads 2] [--rounds 5]
//             [--cell PX] [--nearest PX] [--show PIXELS] [--memory MiB] [--mesh-limit TRIANGLES] [--benchmark_filter=REGEX]
//             [--benchmark_out=FILE ...]
//
// Scenes are patches of 513^2, 2049^2 and 8193^2 posts (ray_bench_scenes.h), built into DIR if missing there
// (without --dir into a folder that is removed at the end), and a planet file of the embedded Mars. Every round
// casts the ray backend, Embree's triangle mesh and Embree's grid one after the other, with the same number of
// threads. Embree runs in the mode that was fastest in this run on this view; the time of making its rays,
// measured without a scene, is subtracted. Its structures are built for each camera, and not timed. One
// iteration of Google Benchmark is a round, and its time is that of the ray backend.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "tests/bench/ray_bench_agreement.h"
#include "tests/bench/ray_bench_embree.h"
#include "tests/bench/ray_bench_options.h"
#include "tests/bench/ray_bench_views.h"
#include "tests/support/support.h"
#include "vpe/core/metrics.h"
#include "vpe/voxel/cast/range_caster.h"

namespace {

using vpe::app::EmbreeScene;
using vpe::app::EmbreeShape;

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

std::string fixed(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f", value);
  return text;
}

// Returns the name of the processor as the system states it, or "".
std::string processor() {
  std::ifstream in("/proc/cpuinfo");
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with("model name")) return line.substr(std::min(line.size(), line.find(':') + 2));
  }
  return {};
}

// Holds Embree's side of one view: a scene, and the mode that is fastest on it.
struct Peer {
  const EmbreeScene* scene = nullptr;
  const char* shape = "";
  bench::EmbreeMode mode = bench::EmbreeMode::kPacket16;
  double setup_s = 0;
  std::vector<double> seconds;
};

struct Row {
  std::string name;
  double ours = 0, mesh = 0, grid = 0;  // Mrays/s, 0 = not measured
  double ratio = 0, ratio_low = 0, ratio_high = 0;
  std::string agreement;
};

class Bench {
 public:
  explicit Bench(const bench::RayBenchOptions& options) : options_(options), pool_(options.threads) {}

  void add_scene(bench::RayScene scene) {
    const auto shared = std::make_shared<const bench::RayScene>(std::move(scene));
    for (bench::RayCase& c : bench::ray_cases(*shared, options_.scale)) {
      benchmark::RegisterBenchmark(c.name.c_str(),
                                   [this, shared, c](benchmark::State& state) { run(state, shared, c); })
          ->UseManualTime()
          ->Iterations(options_.rounds)
          ->Unit(benchmark::kMillisecond);
    }
  }

  int threads() const { return pool_.threads(); }

  void print_table() const {
    if (rows_.empty()) return;
    std::printf(
        "\n%d threads, image sides x %g, medians of %d rounds; ratio to the better of mesh and grid in "
        "its round (lowest, highest)\n\n"
        "| view | ours Mrays/s | mesh | grid | ratio | agreement |\n|---|---|---|---|---|---|\n",
        pool_.threads(), options_.scale, options_.rounds);
    const auto rate = [](double mrays) { return mrays > 0.0 ? fixed(mrays) : "-"; };
    for (const Row& row : rows_)
      std::printf("| %s | %.2f | %s | %s | %.3g (%.3g..%.3g) | %s |\n", row.name.c_str(), row.ours,
                  rate(row.mesh).c_str(), rate(row.grid).c_str(), row.ratio, row.ratio_low, row.ratio_high,
                  row.agreement.c_str());
  }

 private:
  // Builds the structures of a scene and a camera, unless they are those of the last case.
  void prepare(const std::shared_ptr<const bench::RayScene>& scene, const glm::dvec3& camera_m) {
    if (scene_ != scene) {
      mesh_.reset();
      grid_.reset();
      scene_ = scene;
      const auto bytes = static_cast<std::size_t>(options_.memory_mib * 1048576.0);
      caster_ = std::make_unique<vpe::voxel::RangeCaster>(scene->planet, bytes);
      surface_ = std::make_unique<paging::Surface>(scene->planet, std::size_t{512} << 20);
    } else if (camera_m == camera_m_) {
      return;
    }
    camera_m_ = camera_m;
    mesh_.reset();
    grid_.reset();
    const auto tiles = vpe::app::tiles_in_sight(*scene->planet, camera_m);
    if (static_cast<double>(vpe::app::triangle_count(*scene->planet, tiles)) <= options_.mesh_limit)
      make(mesh_, EmbreeShape::kTriangles, tiles, camera_m);
    make(grid_, EmbreeShape::kGrid, tiles, camera_m);
  }

  void make(std::unique_ptr<EmbreeScene>& out, EmbreeShape shape, const std::vector<lod::TileKey>& tiles,
            const glm::dvec3& camera_m) {
    out = std::make_unique<EmbreeScene>(
        *scene_->planet, tiles, camera_m,
        vpe::app::EmbreeOptions{shape, RTC_BUILD_QUALITY_HIGH, false, pool_.threads()});
    std::fprintf(stderr, "%s: Embree %s of %.1f M triangles in %zu tiles: built in %.2f s, %.0f MiB\n",
                 scene_->name.c_str(), shape == EmbreeShape::kGrid ? "grid" : "mesh",
                 static_cast<double>(out->triangles()) * 1e-6, tiles.size(), out->build_s(),
                 static_cast<double>(out->bytes()) / 1048576.0);
  }

  // Selects the fastest mode: tries each twice, after a warm-up.
  void choose_mode(Peer& peer, const bench::EmbreeImage& image, std::span<float> range_m) {
    double best = std::numeric_limits<double>::infinity();
    image.cast(peer.scene->scene(), peer.mode, pool_, range_m);
    for (const bench::EmbreeMode mode : bench::kEmbreeModes) {
      double setup_s = image.cast(nullptr, mode, pool_, range_m);
      for (int n = 0; n < 2; ++n) {
        setup_s = std::min(setup_s, image.cast(nullptr, mode, pool_, range_m));
        const double seconds = image.cast(peer.scene->scene(), mode, pool_, range_m);
        if (seconds - setup_s >= best) continue;
        best = seconds - setup_s;
        peer.mode = mode;
        peer.setup_s = setup_s;
      }
    }
  }

  void run(benchmark::State& state, const std::shared_ptr<const bench::RayScene>& scene,
           const bench::RayCase& c) {
    try {
      measure(state, scene, c);
    } catch (const std::exception& e) {
      state.SkipWithError(e.what());
    }
  }

  void measure(benchmark::State& state, const std::shared_ptr<const bench::RayScene>& scene,
               const bench::RayCase& c) {
    prepare(scene, c.view.camera.position_m);
    const auto pixels = static_cast<std::size_t>(c.view.width) * static_cast<std::size_t>(c.view.height);
    std::vector<float> ours_m(pixels), theirs_m(pixels);
    vpe::voxel::RangeOptions cast_options;
    cast_options.cell_px = options_.cell_px;
    if (options_.nearest_px > 0) cast_options.sectors = {true, options_.nearest_px};
    caster_->cast(c.view, cast_options, pool_, ours_m);  // loads tiles

    const bench::EmbreeImage image(c.view);
    std::vector<Peer> peers;
    if (mesh_) peers.push_back({mesh_.get(), "mesh", {}, 0, {}});
    peers.push_back({grid_.get(), "grid", {}, 0, {}});
    for (Peer& peer : peers) choose_mode(peer, image, theirs_m);

    std::vector<double> ours_s, ratio;
    for (auto _ : state) {
      const auto start = std::chrono::steady_clock::now();
      caster_->cast(c.view, cast_options, pool_, ours_m);
      ours_s.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
      state.SetIterationTime(ours_s.back());
      double best = std::numeric_limits<double>::infinity();
      for (Peer& peer : peers) {
        peer.seconds.push_back(image.cast(peer.scene->scene(), peer.mode, pool_, theirs_m) - peer.setup_s);
        best = std::min(best, peer.seconds.back());
      }
      ratio.push_back(best / ours_s.back());
    }

    const double mrays = static_cast<double>(pixels) * 1e-6;
    Row row;
    row.name = c.name;
    row.ours = mrays / median(ours_s);
    row.ratio = median(ratio);
    row.ratio_low = *std::min_element(ratio.begin(), ratio.end());
    row.ratio_high = *std::max_element(ratio.begin(), ratio.end());
    state.counters["ours_Mrays"] = row.ours;
    for (const Peer& peer : peers) {
      const double rate = mrays / median(peer.seconds);
      (peer.scene == grid_.get() ? row.grid : row.mesh) = rate;
      state.counters[std::string(peer.shape) + "_Mrays"] = rate;
      state.counters[std::string(peer.shape) + "_setup_ms"] = 1e3 * peer.setup_s;
    }
    state.counters["ratio"] = row.ratio;
    state.counters["ratio_low"] = row.ratio_low;
    state.counters["ratio_high"] = row.ratio_high;

    // theirs_m holds the last peer's ranges. Mesh and grid have the same corners.
    const bench::Agreement agreement = bench::compare(c.view, ours_m, theirs_m, *surface_);
    row.agreement = bench::to_text(agreement);
    if (options_.cell_px > 0 || options_.nearest_px > 0)
      row.agreement += "; " + shifts(c.view, ours_m, theirs_m, state);
    for (std::size_t n = 0; n < std::min(agreement.ours_wrong.size(), static_cast<std::size_t>(options_.show));
         ++n) {
      const bench::WrongPixel& w = agreement.ours_wrong[n];
      std::fprintf(stderr, "%s: pixel %d %d: ours %.9g m, Embree %.9g m, exact %.9g m\n", c.name.c_str(), w.x,
                   w.y, w.ours_m, w.theirs_m, w.exact_m);
    }
    const auto share = [&](std::int64_t count) {
      return static_cast<double>(count) / static_cast<double>(pixels);
    };
    state.counters["hit_miss_share"] = share(agreement.hit_miss);
    state.counters["beyond_1e4_share"] = share(agreement.far);
    state.counters["difference_p50"] = agreement.p50;
    state.counters["difference_p99"] = agreement.p99;
    state.counters["difference_p9999"] = agreement.p9999;
    state.counters["judged"] = static_cast<double>(agreement.judged);
    state.counters["judged_ours_right"] = static_cast<double>(agreement.ours_right + agreement.both_right);
    state.counters["judged_embree_right"] = static_cast<double>(agreement.theirs_right + agreement.both_right);
    std::string label;
    for (const Peer& peer : peers)
      label += std::string(label.empty() ? "" : ", ") + peer.shape + " in " + bench::name(peer.mode);
    state.SetLabel(label);
    rows_.push_back(std::move(row));
  }

  // Describes how far the ray backend is off in the image, against the reference surface and Embree's exact
  // image.
  std::string shifts(const vpe::core::View& view, std::span<const float> ours_m,
                     std::span<const float> theirs_m, benchmark::State& state) const {
    const vpe::core::SurfaceRadius radius = [&](std::span<const glm::dvec3> at, std::span<double> radius_m) {
      for (std::size_t k = 0; k < at.size(); ++k) radius_m[k] = surface_->at(at[k]).radius_m;
    };
    const vpe::core::ImageErrors errors =
        vpe::core::compare_to_reference(view, ours_m, theirs_m, radius, {1, pool_.threads()});
    state.counters["forward_p999_px"] = errors.forward.p999_px;
    state.counters["backward_p999_px"] = errors.backward.p999_px;
    char text[160];
    std::snprintf(text, sizeof text, "shift 99.9 %% %.3f px forward, %.3f backward; over 1 px %.4f %%, %.4f %%",
                  errors.forward.p999_px, errors.backward.p999_px, 100 * errors.forward.share_over_1px,
                  100 * errors.backward.share_over_1px);
    return text;
  }

  bench::RayBenchOptions options_;
  vpe::base::ThreadPool pool_;
  std::shared_ptr<const bench::RayScene> scene_;
  std::unique_ptr<vpe::voxel::RangeCaster> caster_;
  std::unique_ptr<paging::Surface> surface_;
  glm::dvec3 camera_m_{0};
  std::unique_ptr<EmbreeScene> mesh_;
  std::unique_ptr<EmbreeScene> grid_;
  std::vector<Row> rows_;
};

void add_scenes(Bench& bench, const bench::RayBenchOptions& options, const std::filesystem::path& folder) {
  std::string rest = options.scenes + ",";
  for (std::size_t comma = rest.find(','); comma != std::string::npos; comma = rest.find(',')) {
    const std::string name = rest.substr(0, comma);
    rest.erase(0, comma + 1);
    if (name == "mars") {
      const std::string file = options.mars.empty() ? bench::cached_mars() : options.mars;
      if (std::filesystem::exists(file)) {
        bench.add_scene(bench::planet_scene(name, file));
      } else if (options.mars.empty()) {
        std::fprintf(stderr, "skipped: scene mars: no %s; any command of vpe without a planet builds it\n",
                     file.c_str());
      } else {
        bench::refuse(file + ": no such planet file");
      }
      continue;
    }
    const auto& specs = bench::patch_specs();
    const auto spec = std::find_if(specs.begin(), specs.end(), [&](const auto& s) { return s.name == name; });
    if (spec == specs.end()) bench::refuse("--scenes: no scene '" + name + "'");
    bench.add_scene(bench::patch_scene(*spec, folder, options.threads));
  }
}

}  // namespace

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  try {
    const bench::RayBenchOptions options = bench::parse_options(argc, argv);
    std::optional<test_support::TempDir> temporary;
    if (options.dir.empty()) temporary.emplace();
    Bench bench(options);
    benchmark::AddCustomContext("processor", processor());
    benchmark::AddCustomContext("threads", std::to_string(bench.threads()));
    benchmark::AddCustomContext("embree", RTC_VERSION_STRING);
    add_scenes(bench, options, temporary ? temporary->path() : std::filesystem::path(options.dir));
    benchmark::RunSpecifiedBenchmarks();
    bench.print_table();
    benchmark::Shutdown();
  } catch (const std::exception& e) {
    std::fprintf(stderr, "ray_bench: %s\n", e.what());
    return 1;
  }
  return 0;
}
