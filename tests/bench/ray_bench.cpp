// Range pictures by the ray backend against Embree over the same triangles: docs/rays.md has the figures.
//
//   ray_bench [--dir DIR] [--scenes 513,2049,mars] [--mars FILE] [--scale 1] [--threads 2] [--rounds 5]
//             [--memory MiB] [--mesh-limit TRIANGLES] [--benchmark_filter=REGEX] [--benchmark_out=FILE ...]
//
// Scenes: patches of 513^2, 2049^2 and 8193^2 posts (ray_bench_scenes.h), built into DIR when they are not
// there (without --dir into a folder that is removed at the end), and a planet file of the embedded Mars. Every
// round casts ours, Embree's triangle mesh and Embree's grid in turn, both sides with the same threads; Embree
// in whichever of its modes was fastest in this run on this view, less the time that making its rays takes
// (measured without a scene). Its structures are made for each eye, and not timed. One iteration of
// Google Benchmark is a round, its time is ours.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/bench/ray_bench_agreement.h"
#include "tests/bench/ray_bench_caster.h"
#include "tests/bench/ray_bench_embree.h"
#include "tests/bench/ray_bench_views.h"
#include "tests/support/support.h"
#include "vpe/core/number.h"

namespace {

using test_support::EmbreeScene;
using test_support::EmbreeShape;

struct Options {
  std::string dir;
  std::string scenes = "513,2049,mars";
  std::string mars;
  double scale = 1;
  int threads = 0;
  int rounds = 5;
  double memory_mib = 4096;
  double mesh_limit = 4e7;  // triangles; beyond it only the grid, whose structure is a sixth as large
};

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// Embree's side of one view: a scene in the mode that is fastest on it.
struct Peer {
  const EmbreeScene* scene = nullptr;
  const char* shape = "";
  bench::EmbreeMode mode = bench::EmbreeMode::kPacket16;
  double setup_s = 0;
  std::vector<double> seconds;
};

struct Row {
  std::string name;
  double ours = 0, mesh = 0, grid = 0;  // Mrays/s, 0 = not made
  double ratio = 0, ratio_low = 0, ratio_high = 0;
  std::string agreement;
};

class Bench {
 public:
  explicit Bench(const Options& options) : options_(options), pool_(options.threads) {}

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

  void print_table() const {
    if (rows_.empty()) return;
    std::printf(
        "\n%d threads, picture sides x %g, medians of %d rounds; ratio to the better of mesh and grid in its "
        "round "
        "(lowest, highest)\n\n"
        "| view | ours Mrays/s | mesh | grid | ratio | agreement |\n|---|---|---|---|---|---|\n",
        pool_.threads(), options_.scale, options_.rounds);
    for (const Row& row : rows_)
      std::printf("| %s | %.2f | %.1f | %.1f | %.3g (%.3g..%.3g) | %s |\n", row.name.c_str(), row.ours,
                  row.mesh, row.grid, row.ratio, row.ratio_low, row.ratio_high, row.agreement.c_str());
  }

 private:
  // Structures of a scene and an eye; the cases of one eye follow each other.
  void prepare(const std::shared_ptr<const bench::RayScene>& scene, const glm::dvec3& eye_m) {
    if (scene_ != scene) {
      mesh_.reset();
      grid_.reset();
      scene_ = scene;
      const auto bytes = static_cast<std::size_t>(options_.memory_mib * 1048576.0);
      caster_ = std::make_unique<bench::RangeCaster>(scene->planet, pool_.threads(), bytes);
      surface_ = std::make_unique<paging::Surface>(scene->planet, std::size_t{512} << 20);
    } else if (eye_m == eye_m_) {
      return;
    }
    eye_m_ = eye_m;
    mesh_.reset();
    grid_.reset();
    const auto tiles = test_support::tiles_in_sight(*scene->planet, eye_m);
    if (static_cast<double>(test_support::triangle_count(*scene->planet, tiles)) <= options_.mesh_limit)
      make(mesh_, EmbreeShape::kTriangles, tiles, eye_m);
    make(grid_, EmbreeShape::kGrid, tiles, eye_m);
  }

  void make(std::unique_ptr<EmbreeScene>& out, EmbreeShape shape, const std::vector<lod::TileKey>& tiles,
            const glm::dvec3& eye_m) {
    out = std::make_unique<EmbreeScene>(
        *scene_->planet, tiles, eye_m,
        test_support::EmbreeOptions{shape, RTC_BUILD_QUALITY_HIGH, false, pool_.threads()});
    std::fprintf(stderr, "%s: Embree %s of %.1f M triangles in %zu tiles: built in %.2f s, %.0f MiB\n",
                 scene_->name.c_str(), shape == EmbreeShape::kGrid ? "grid" : "mesh",
                 static_cast<double>(out->triangles()) * 1e-6, tiles.size(), out->build_s(),
                 static_cast<double>(out->bytes()) / 1048576.0);
  }

  // The fastest mode, each tried twice after a first time that warms up.
  void choose_mode(Peer& peer, const bench::EmbreePicture& picture, std::span<float> range_m) {
    double best = std::numeric_limits<double>::infinity();
    picture.cast(peer.scene->scene(), peer.mode, pool_, range_m);
    for (const bench::EmbreeMode mode : bench::kEmbreeModes) {
      double setup_s = picture.cast(nullptr, mode, pool_, range_m);
      for (int n = 0; n < 2; ++n) {
        setup_s = std::min(setup_s, picture.cast(nullptr, mode, pool_, range_m));
        const double seconds = picture.cast(peer.scene->scene(), mode, pool_, range_m);
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
    prepare(scene, c.view.eye.eye_m);
    const auto pixels = static_cast<std::size_t>(c.view.width) * static_cast<std::size_t>(c.view.height);
    std::vector<float> ours_m(pixels), theirs_m(pixels);
    caster_->cast_ranges(c.view, ours_m);  // loads tiles

    const bench::EmbreePicture picture(c.view);
    std::vector<Peer> peers;
    if (mesh_) peers.push_back({mesh_.get(), "mesh", {}, 0, {}});
    peers.push_back({grid_.get(), "grid", {}, 0, {}});
    for (Peer& peer : peers) choose_mode(peer, picture, theirs_m);

    std::vector<double> ours_s, ratio;
    for (auto _ : state) {
      const auto start = std::chrono::steady_clock::now();
      caster_->cast_ranges(c.view, ours_m);
      ours_s.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
      state.SetIterationTime(ours_s.back());
      double best = std::numeric_limits<double>::infinity();
      for (Peer& peer : peers) {
        peer.seconds.push_back(picture.cast(peer.scene->scene(), peer.mode, pool_, theirs_m) - peer.setup_s);
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
    }
    state.counters["ratio"] = row.ratio;
    state.counters["ratio_low"] = row.ratio_low;
    state.counters["ratio_high"] = row.ratio_high;

    // theirs_m is the last peer's; the mesh's corners are the grid's.
    const bench::Agreement agreement = bench::compare(c.view, ours_m, theirs_m, *surface_);
    row.agreement = bench::to_text(agreement);
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

  Options options_;
  vpe::core::ThreadPool pool_;
  std::shared_ptr<const bench::RayScene> scene_;
  std::unique_ptr<bench::RangeCaster> caster_;
  std::unique_ptr<paging::Surface> surface_;
  glm::dvec3 eye_m_{0};
  std::unique_ptr<EmbreeScene> mesh_;
  std::unique_ptr<EmbreeScene> grid_;
  std::vector<Row> rows_;
};

[[noreturn]] void refuse(const std::string& what) {
  throw std::invalid_argument(what +
                              "; ray_bench [--dir DIR] [--scenes 513,2049,8193,mars] [--mars FILE] [--scale S] "
                              "[--threads N] [--rounds N] [--memory MiB] [--mesh-limit TRIANGLES] "
                              "[--benchmark_filter=REGEX] [--help]");
}

// Of what Google Benchmark has left.
Options parse(int argc, char** argv) {
  Options options;
  for (int n = 1; n < argc; n += 2) {
    const std::string key = argv[n];
    if (n + 1 == argc) refuse(key + " needs a value");
    const std::string value = argv[n + 1];
    const auto number = [&](double least) {
      const auto parsed = vpe::core::parse_number(value);
      if (!parsed || *parsed < least) refuse(key + " " + value + ": not a number, or too small");
      return *parsed;
    };
    if (key == "--dir") {
      options.dir = value;
    } else if (key == "--scenes") {
      options.scenes = value;
    } else if (key == "--mars") {
      options.mars = value;
    } else if (key == "--scale") {
      options.scale = number(0.001);
    } else if (key == "--threads") {
      options.threads = static_cast<int>(number(0));
    } else if (key == "--rounds") {
      options.rounds = static_cast<int>(number(1));
    } else if (key == "--memory") {
      options.memory_mib = number(1);
    } else if (key == "--mesh-limit") {
      options.mesh_limit = number(0);
    } else {
      refuse(key + " is no option");
    }
  }
  return options;
}

// The planet file that `vpe` builds on its first run without a planet.
std::string cached_mars() {
  const char* cache = std::getenv("XDG_CACHE_HOME");
  const char* home = std::getenv("HOME");
  const std::filesystem::path folder = cache != nullptr
                                           ? std::filesystem::path(cache)
                                           : std::filesystem::path(home != nullptr ? home : ".") / ".cache";
  return (folder / "vpe" / "embedded-mars-2.vpe").string();
}

void add_scenes(Bench& bench, const Options& options, const std::filesystem::path& folder) {
  std::string rest = options.scenes + ",";
  for (std::size_t comma = rest.find(','); comma != std::string::npos; comma = rest.find(',')) {
    const std::string name = rest.substr(0, comma);
    rest.erase(0, comma + 1);
    if (name == "mars") {
      const std::string file = options.mars.empty() ? cached_mars() : options.mars;
      if (std::filesystem::exists(file)) {
        bench.add_scene(bench::planet_scene(name, file));
      } else if (options.mars.empty()) {
        std::fprintf(stderr, "skipped: scene mars: no %s; any command of vpe without a planet builds it\n",
                     file.c_str());
      } else {
        refuse(file + ": no such planet file");
      }
      continue;
    }
    const auto& specs = bench::patch_specs();
    const auto spec = std::find_if(specs.begin(), specs.end(), [&](const auto& s) { return s.name == name; });
    if (spec == specs.end()) refuse("--scenes: no scene '" + name + "'");
    bench.add_scene(bench::patch_scene(*spec, folder, options.threads));
  }
}

}  // namespace

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  try {
    const Options options = parse(argc, argv);
    std::optional<test_support::TempDir> temporary;
    if (options.dir.empty()) temporary.emplace();
    Bench bench(options);
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
