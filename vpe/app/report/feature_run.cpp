#include "vpe/app/report/feature_run.h"

#include <algorithm>
#include <filesystem>
#include <stdexcept>

#include "vpe/gl/polygon_renderer.h"
#include "vpe/voxel/ray_renderer.h"

namespace vpe::app {
namespace {

constexpr core::Backend kBackends[] = {core::Backend::kPolygon, core::Backend::kRay};

const FeatureRow& row_of(const std::vector<FeatureRow>& rows, const std::string& scene, core::Backend backend) {
  for (const FeatureRow& row : rows) {
    if (row.scene->name == scene && row.backend == backend) return row;
  }
  throw std::logic_error("no row of " + scene);
}

// Returns true for scenes that the other program draws, too: they use nothing that it lacks.
bool is_drawn_by_other(const FeatureScene& scene) { return scene.name == "bare" || scene.name == "planes"; }

constexpr const char* kNotLeftOut = "part of every program: no build option leaves it out";

const char* note_on(const std::string& feature, bool compared_with_other) {
  if (feature == "overlays")
    return compared_with_other ? "never: VPE_OVERLAYS=OFF"
                               : "never: give --against a program built with VPE_OVERLAYS=OFF";
  if (feature.starts_with("imagery"))
    return "nothing is read without imagery in the planet file; always built in";
  if (feature == "shadows") return "their cost is in making tiles (start-up), not in frames; always built in";
  return kNotLeftOut;
}

}  // namespace

std::vector<FeatureRow> feature_rows(bool has_imagery) {
  std::vector<FeatureRow> rows;
  for (const core::Backend backend : kBackends) {
    for (const FeatureScene& scene : feature_scenes()) {
      if ((backend == core::Backend::kRay && !scene.rays) || !is_built_in(scene)) continue;
      if (scene.imagery && !has_imagery) continue;
      FeatureRow& row = rows.emplace_back();
      row.scene = &scene;
      row.backend = backend;
    }
  }
  return rows;
}

void measure_processes(const FeaturePlan& plan, std::vector<FeatureRow>& rows,
                       const std::function<void()>& step) {
  std::vector<std::vector<report::SceneCost>> costs(rows.size());
  std::vector<std::vector<report::SceneCost>> never(rows.size());
  const std::string self = std::filesystem::read_symlink("/proc/self/exe").string();
  // An unmeasured process brings program and planet into the system's memory.
  ProbeRequest first = plan.probe;
  first.scene = "bare";
  first.program = self;
  static_cast<void>(probe(first));
  if (!plan.against.empty()) {
    first.program = plan.against;
    static_cast<void>(probe(first));
  }
  for (int round = 0; round < plan.starts; ++round) {
    for (std::size_t k = 0; k < rows.size(); ++k) {
      ProbeRequest request = plan.probe;
      request.scene = rows[k].scene->name;
      request.backend = rows[k].backend;
      request.program = self;
      step();
      costs[k].push_back(probe(request));
      rows[k].processor_s.push_back(*costs[k].back().processor_s);
      if (plan.against.empty() || !is_drawn_by_other(*rows[k].scene)) continue;
      request.program = plan.against;
      step();
      never[k].push_back(probe(request));
      rows[k].never_processor_s.push_back(*never[k].back().processor_s);
    }
  }
  for (std::size_t k = 0; k < rows.size(); ++k) {
    rows[k].cost = report::median_cost(costs[k]);
    rows[k].never = report::median_cost(never[k]);
  }
}

void measure_frames(const FeaturePlan& plan, std::vector<FeatureRow>& rows, core::Backend backend,
                    const std::shared_ptr<gl::Context>& context,
                    const std::shared_ptr<const paging::PlanetFile>& planet) {
  const std::size_t bytes = static_cast<std::size_t>(plan.probe.memory_mb) << 20;
  const core::View view = feature_view(plan.probe.pose, plan.probe.size, planet);
  struct FrameCase {
    FeatureRow* row;
    std::unique_ptr<core::Renderer> renderer;
    std::unique_ptr<ScenePainter> painter;
    core::DrawRequest request;
    std::vector<double> rest_share;
  };
  std::vector<FrameCase> cases;
  for (FeatureRow& row : rows) {
    if (row.backend != backend) continue;
    FrameCase& c = cases.emplace_back();
    c.row = &row;
    if (backend == core::Backend::kRay) {
      c.renderer = voxel::make_ray_renderer(planet, {bytes, plan.probe.threads});
    } else {
      c.renderer = gl::make_polygon_renderer(context, planet, {bytes, plan.probe.threads, {}});
    }
    c.painter = std::make_unique<ScenePainter>(*row.scene, planet, plan.probe.statistics_file);
    c.request = scene_request(*row.scene, view);
  }
  const report::Clock clock = report::wall_clock();
  std::vector<std::function<void()>> runs;
  for (FrameCase& c : cases) {
    runs.emplace_back([&c, &clock] {
      const double begin_s = clock();
      const core::FrameStats stats = c.painter->paint(*c.renderer, c.request);
      const double all_s = clock() - begin_s;
      const double stages_s = 1e-3 * (stats.select_ms + stats.load_ms + stats.draw_ms + stats.read_ms);
      c.rest_share.push_back(all_s / stages_s);
    });
  }
  const std::vector<report::Timing> timings = report::time_interleaved(runs, plan.rounds);
  for (std::size_t k = 0; k < cases.size(); ++k) {
    cases[k].row->frames = timings[k];
    cases[k].row->rest_ratio = report::median(cases[k].rest_share);
  }
}

std::vector<report::FeatureCost> feature_costs(const std::vector<FeatureRow>& rows, bool has_other) {
  std::vector<report::FeatureCost> costs;
  for (const FeatureRow& row : rows) {
    if (row.scene->compared.empty()) continue;
    const FeatureRow& without = row_of(rows, row.scene->compared, row.backend);
    report::FeatureCost& cost = costs.emplace_back();
    cost.feature = row.scene->name;
    cost.backend = core::to_string(row.backend);
    cost.compared = row.scene->compared;
    cost.off = without.cost;
    cost.on = row.cost;
    cost.frame_ratio = report::ratio(row.frames, without.frames);
    cost.note = note_on(cost.feature, has_other);
    if (cost.feature == "overlays" && has_other) {
      cost.never = without.never;
      cost.never_ratio = report::ratio({without.processor_s}, {without.never_processor_s});
    }
  }
  for (const core::Backend backend : kBackends) {
    const FeatureRow& bare = row_of(rows, "bare", backend);
    report::FeatureCost& certificate = costs.emplace_back();
    certificate.feature = "certificate";
    certificate.backend = core::to_string(backend);
    certificate.compared = "the same image";
    certificate.on = bare.cost;
    // Rays count everything in one stage.
    if (backend == core::Backend::kPolygon) certificate.frame_ratio = bare.rest_ratio;
    certificate.note =
        "made with every image from errors stored in its tiles; the ratio is an upper bound, the time of the "
        "whole call relative to its counted stages";
    report::FeatureCost& window = costs.emplace_back();
    window.feature = "window";
    window.backend = core::to_string(backend);
    window.compared = "bare";
    window.off = bare.cost;
    window.note = "on: needs a screen, see docs/measurements/window.md; never: VPE_WINDOW=OFF";
    if (has_other) {
      window.never = bare.never;
      window.never_ratio = report::ratio({bare.processor_s}, {bare.never_processor_s});
    }
  }
  return costs;
}

int count_processes(const FeaturePlan& plan, const std::vector<FeatureRow>& rows) {
  const auto drawn_by_other = std::count_if(
      rows.begin(), rows.end(), [](const FeatureRow& row) { return is_drawn_by_other(*row.scene); });
  return plan.starts * static_cast<int>(static_cast<std::ptrdiff_t>(rows.size()) +
                                        (plan.against.empty() ? 0 : drawn_by_other));
}

}  // namespace vpe::app
