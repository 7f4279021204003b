// vpe report features.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <functional>
#include <nlohmann/json.hpp>

#include "vpe/app/feature_probe.h"
#include "vpe/app/interrupt.h"
#include "vpe/app/planet_argument.h"
#include "vpe/app/progress.h"
#include "vpe/app/report.h"
#include "vpe/app/report_folder.h"
#include "vpe/app/report_parts.h"
#include "vpe/app/temporary.h"
#include "vpe/gl/context.h"
#include "vpe/gl/polygon_renderer.h"
#include "vpe/report/turns.h"
#include "vpe/voxel/ray_renderer.h"

namespace vpe::app {
namespace {

const std::string kPolygonBackend = "polygon";
const std::string kRayBackend = "voxel";

struct FeatureArguments {
  ProbeOrder order;  // as given; its scene is empty unless this is a child
  std::string folder;
  std::string against;
  int rounds = 9;
  int starts = 3;
  bool brief = false;
};

// One scene and backend, and what was measured of it.
struct Row {
  const FeatureScene* scene = nullptr;
  std::string backend;
  report::SceneCost cost;   // of this program's processes
  report::SceneCost never;  // of the other's, where it is asked
  std::vector<double> frame_s;
  std::vector<double> never_frame_s;
  report::Timing turns;
  std::optional<double> rest_ratio;  // picture to the same without what no stage of it counts
};

// Removes a file when it goes.
class Scratch {
 public:
  explicit Scratch(std::filesystem::path path) : path_(std::move(path)) {}
  ~Scratch() {
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
  }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
  std::string name() const { return path_.string(); }

 private:
  std::filesystem::path path_;
};

std::vector<Row> rows_to_measure(bool has_imagery) {
  std::vector<Row> rows;
  for (const std::string& backend : {kPolygonBackend, kRayBackend}) {
    for (const FeatureScene& scene : feature_scenes()) {
      if ((backend == kRayBackend && !scene.rays) || !is_built_in(scene)) continue;
      if (scene.imagery && !has_imagery) continue;
      Row& row = rows.emplace_back();
      row.scene = &scene;
      row.backend = backend;
    }
  }
  return rows;
}

Row& row_of(std::vector<Row>& rows, const std::string& scene, const std::string& backend) {
  for (Row& row : rows) {
    if (row.scene->name == scene && row.backend == backend) return row;
  }
  throw std::logic_error("no row of " + scene);
}

// Scenes that the other program is asked for too: those without what it lacks.
bool is_asked_of_other(const FeatureScene& scene) { return scene.name == "bare" || scene.name == "planes"; }

using Step = std::function<void(const char*)>;

void measure_processes(const FeatureArguments& arguments, std::vector<Row>& rows, const Step& step) {
  std::vector<std::vector<report::SceneCost>> costs(rows.size());
  std::vector<std::vector<report::SceneCost>> never(rows.size());
  const std::string self = std::filesystem::read_symlink("/proc/self/exe").string();
  // One that does not count, so that program and planet lie in the system's memory.
  ProbeOrder first = arguments.order;
  first.scene = "bare";
  first.program = self;
  static_cast<void>(probe(first));
  if (!arguments.against.empty()) {
    first.program = arguments.against;
    static_cast<void>(probe(first));
  }
  for (int round = 0; round < arguments.starts; ++round) {
    for (std::size_t k = 0; k < rows.size(); ++k) {
      ProbeOrder order = arguments.order;
      order.scene = rows[k].scene->name;
      order.backend = rows[k].backend;
      order.program = self;
      step("processes");
      costs[k].push_back(probe(order));
      rows[k].frame_s.push_back(*costs[k].back().frame_s);
      if (arguments.against.empty() || !is_asked_of_other(*rows[k].scene)) continue;
      order.program = arguments.against;
      step("processes");
      never[k].push_back(probe(order));
      rows[k].never_frame_s.push_back(*never[k].back().frame_s);
    }
  }
  for (std::size_t k = 0; k < rows.size(); ++k) {
    rows[k].cost = report::median_cost(costs[k]);
    rows[k].never = report::median_cost(never[k]);
  }
}

// Frames of all scenes of a backend in turns, each with a renderer of its own.
void measure_turns(const FeatureArguments& arguments, std::vector<Row>& rows, const std::string& backend,
                   const std::shared_ptr<gl::Context>& context,
                   const std::shared_ptr<const paging::PlanetFile>& planet, const Step& step) {
  const std::size_t bytes = std::size_t{static_cast<std::size_t>(arguments.order.memory_mb)} << 20;
  const core::View view = feature_view(arguments.order.pose, arguments.order.size, planet);
  struct Contestant {
    Row* row;
    std::unique_ptr<core::Renderer> renderer;
    std::unique_ptr<ScenePainter> painter;
    core::DrawRequest request;
    std::vector<double> rest_share;
  };
  std::vector<Contestant> contestants;
  for (Row& row : rows) {
    if (row.backend != backend) continue;
    Contestant& c = contestants.emplace_back();
    c.row = &row;
    if (backend == kRayBackend) {
      c.renderer = voxel::make_ray_renderer(planet, {bytes, arguments.order.threads});
    } else {
      c.renderer = gl::make_polygon_renderer(context, planet, {bytes, arguments.order.threads, {}});
    }
    c.painter = std::make_unique<ScenePainter>(*row.scene, planet, arguments.order.statistics_file);
    c.request = scene_request(*row.scene, view);
  }
  const report::Clock clock = report::wall_clock();
  std::vector<std::function<void()>> turns;
  for (Contestant& c : contestants) {
    turns.emplace_back([&c, &clock] {
      const double begin_s = clock();
      const core::FrameStats stats = c.painter->paint(*c.renderer, c.request);
      const double all_s = clock() - begin_s;
      const double stages_s = 1e-3 * (stats.select_ms + stats.load_ms + stats.draw_ms + stats.read_ms);
      c.rest_share.push_back(all_s / stages_s);
    });
  }
  step("frames");
  const std::vector<report::Timing> timings = report::time_in_turns(turns, arguments.rounds);
  for (std::size_t k = 0; k < contestants.size(); ++k) {
    contestants[k].row->turns = timings[k];
    contestants[k].row->rest_ratio = report::median(contestants[k].rest_share);
  }
}

constexpr const char* kNotLeftOut = "part of every program: no option of the build leaves it out";

const char* note_on(const std::string& feature, bool compared_with_other) {
  if (feature == "overlays")
    return compared_with_other ? "never: VPE_OVERLAYS=OFF"
                               : "never: give --against a program built with VPE_OVERLAYS=OFF";
  if (feature == "imagery") return "without imagery in the planet file nothing of it is read; built in always";
  if (feature == "shadows") return "their cost is in making tiles (start-up), not in frames; built in always";
  return kNotLeftOut;
}

std::vector<report::FeatureCost> costs_of(std::vector<Row>& rows, bool has_other) {
  std::vector<report::FeatureCost> costs;
  for (Row& row : rows) {
    if (row.scene->compared.empty()) continue;
    const Row& without = row_of(rows, row.scene->compared, row.backend);
    report::FeatureCost& cost = costs.emplace_back();
    cost.feature = row.scene->name;
    cost.backend = row.backend;
    cost.compared = row.scene->compared;
    cost.off = without.cost;
    cost.on = row.cost;
    cost.frame_ratio = report::ratio(row.turns, without.turns);
    cost.note = note_on(cost.feature, has_other);
    if (cost.feature == "overlays" && has_other) {
      cost.never = without.never;
      cost.never_ratio = report::ratio({without.frame_s}, {without.never_frame_s});
    }
  }
  for (const std::string& backend : {kPolygonBackend, kRayBackend}) {
    const Row& bare = row_of(rows, "bare", backend);
    report::FeatureCost& certificate = costs.emplace_back();
    certificate.feature = "certificate";
    certificate.backend = backend;
    certificate.compared = "the same picture";
    certificate.on = bare.cost;
    // Of rays all is counted in one stage.
    if (backend == kPolygonBackend) certificate.frame_ratio = bare.rest_ratio;
    certificate.note =
        "made with every picture, of what its tiles have in store; the ratio is a bound, the whole call to "
        "what its "
        "stages count";
    report::FeatureCost& window = costs.emplace_back();
    window.feature = "window";
    window.backend = backend;
    window.compared = "bare";
    window.off = bare.cost;
    window.note = "on: needs a screen, see docs/window.md; never: VPE_WINDOW=OFF";
    if (has_other) {
      window.never = bare.never;
      window.never_ratio = report::ratio({bare.frame_s}, {bare.never_frame_s});
    }
  }
  return costs;
}

void report_features(FeatureArguments& arguments, const Common& common) {
  ProbeOrder& order = arguments.order;
  order.memory_mb = common.memory_mb;
  order.threads = common.threads;
  if (!order.scene.empty()) return run_probe(order);
  if (arguments.folder.empty()) throw UsageError("-o FOLDER is missing: where the report shall be written");
  if (arguments.brief) {
    order.size = "160x90";
    order.frames = 2;
    arguments.rounds = 3;
    arguments.starts = 1;
  }
  const std::filesystem::path folder = arguments.folder;
  check_report_folder(folder);
  RunFacts facts = read_run_facts(common);
  const InterruptGuard guard;
  const auto planet = open_planet(order.planet, common);
  order.planet = planet->path();
  static_cast<void>(feature_view(order.pose, order.size, planet));
  const Scratch scratch(temporary_name(folder / "statistics").string() + ".csv");
  order.statistics_file = scratch.name();

  std::vector<Row> rows = rows_to_measure(planet->meta().finest_image_level >= 0);
  ProgressLine line(common.quiet);
  const double others = arguments.against.empty() ? 0 : 4;
  const double all = arguments.starts * (static_cast<double>(rows.size()) + others) + 2;
  double done = 0;
  const auto step = [&](const char* what) {
    InterruptGuard::check();
    line.show(what, done / all);
    done += 1;
  };
  measure_processes(arguments, rows, step);
  const std::shared_ptr<gl::Context> context = gl::Context::create();
  facts.opengl = context->info().renderer + ", " + context->info().version;
  for (const std::string& backend : {kPolygonBackend, kRayBackend})
    measure_turns(arguments, rows, backend, context, planet, step);

  const report::Table table = report::feature_table(costs_of(rows, !arguments.against.empty()));
  report::Page page;
  page.title = "What things cost that a scene can do without";
  page.paragraphs = to_paragraphs(facts);
  page.paragraphs.push_back("Planet " + planet->path() + ", pose " + order.pose +
                            " (longitude, latitude, metres above the terrain, heading, pitch), " + order.size +
                            (arguments.against.empty() ? "" : "; never: " + arguments.against));
  page.sections.push_back({"Costs", {}, {}, {table}});
  const nlohmann::json json{
      {"run", to_json(facts)},
      {"load_after", load_now()},
      {"planet", planet->path()},
      {"pose", order.pose},
      {"size", order.size},
      {"against", arguments.against.empty() ? nlohmann::json() : nlohmann::json(arguments.against)},
      {"features", report::to_json(table)}};
  write_report(folder, "features", page, json, {table});
  if (common.json) {
    print_json(json);
  } else if (!common.quiet) {
    std::printf("%s\n", (folder / "features.html").c_str());
  }
}

}  // namespace

void add_report_features(CLI::App& report, Common& common) {
  auto arguments = std::make_shared<FeatureArguments>();
  ProbeOrder& order = arguments->order;
  order.pose = "-70,-13.5,4000,80,-15";
  order.size = "640x360";
  order.backend = kPolygonBackend;
  CLI::App* command = add_command(report, "features",
                                  "What imagery, light, shadows, overlays and the like cost: on, off, and in a "
                                  "program built without them",
                                  common, true);
  command->add_option("PLANET", order.planet, "Planet file or DEM; the embedded Mars when left out");
  command->add_option("-o,--output", arguments->folder,
                      "Folder for features.html, features.json, features.csv");
  command->add_option("--against", arguments->against,
                      "Another vpe, built without overlays and windows: its figures stand as 'never'");
  command->add_option("--pose", order.pose, "LON,LAT,HEIGHT,YAW,PITCH: degrees, metres above the terrain")
      ->capture_default_str();
  command->add_option("--size", order.size, "WIDTHxHEIGHT, pixels")->capture_default_str();
  command->add_option("--rounds", arguments->rounds, "How often each frame is timed")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command->add_option("--starts", arguments->starts, "How often each process is started")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command->add_flag("--short", arguments->brief, "Small pictures, a start each");
  // For the processes that this one starts.
  command->add_option("--probe", order.scene)->group("");
  command->add_option("--backend", order.backend)
      ->group("")
      ->check(CLI::IsMember({kPolygonBackend, kRayBackend}));
  command->add_option("--frames", order.frames)->group("")->check(CLI::Range(1, 1000));
  command->add_option("--statistics", order.statistics_file)->group("");
  command->callback([arguments, &common] { report_features(*arguments, common); });
}

}  // namespace vpe::app
