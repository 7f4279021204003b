// vpe report features.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "vpe/app/cli/interrupt.h"
#include "vpe/app/cli/json_output.h"
#include "vpe/app/cli/progress.h"
#include "vpe/app/cli/temporary.h"
#include "vpe/app/planet/planet_argument.h"
#include "vpe/app/report/feature_run.h"
#include "vpe/app/report/report_commands.h"
#include "vpe/app/report/report_folder.h"

namespace vpe::app {
namespace {

struct FeatureArguments {
  FeaturePlan plan;  // the order's scene is empty unless this is a child
  std::string folder;
  bool brief = false;

  FeatureArguments() {
    plan.order.pose = "-70,-13.5,4000,80,-15";
    plan.order.size = "640x360";
    plan.order.backend = kPolygonBackend;
  }
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

report::Page report_features(FeatureArguments& arguments, const Common& common) {
  ProbeRequest& order = arguments.plan.order;
  order.memory_mb = common.memory_mb;
  order.threads = common.threads;
  if (arguments.folder.empty()) throw UsageError("-o FOLDER is missing: where the report shall be written");
  if (arguments.brief) {
    order.size = "160x90";
    order.frames = 2;
    arguments.plan.rounds = 3;
    arguments.plan.starts = 1;
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

  std::vector<FeatureRow> rows = feature_rows(planet->meta().finest_image_level >= 0);
  ProgressLine line(common.quiet);
  const double all = count_processes(arguments.plan, rows) + 1;
  double done = 0;
  measure_processes(arguments.plan, rows, [&] {
    InterruptGuard::check();
    line.show("processes", done++ / all);
  });
  const std::shared_ptr<gl::Context> context = gl::Context::create();
  facts.opengl = context->info().renderer + ", " + context->info().version;
  for (const std::string& backend : {kPolygonBackend, kRayBackend}) {
    InterruptGuard::check();
    measure_frames(arguments.plan, rows, backend, context, planet);
  }

  const report::Table table = report::feature_table(feature_costs(rows, !arguments.plan.against.empty()));
  report::Page page;
  page.title = "What things cost that a scene can do without";
  page.paragraphs = to_paragraphs(facts);
  page.paragraphs.push_back("Planet " + planet->path() + ", pose " + order.pose +
                            " (longitude, latitude, metres above the terrain, heading, pitch), " + order.size +
                            (arguments.plan.against.empty() ? "" : "; never: " + arguments.plan.against));
  page.sections.push_back({"Costs", {}, {}, {table}});
  const nlohmann::json json{
      {"run", to_json(facts)},
      {"load_after", load_now()},
      {"planet", planet->path()},
      {"pose", order.pose},
      {"size", order.size},
      {"against", arguments.plan.against.empty() ? nlohmann::json() : nlohmann::json(arguments.plan.against)},
      {"features", report::to_json(table)}};
  write_report(folder, "features", page, json, {table});
  if (common.json) {
    print_json(json);
  } else if (!common.quiet) {
    std::printf("%s\n", (folder / "features.html").c_str());
  }
  return page;
}

// A process that another report has started measures itself.
void report_or_probe(FeatureArguments& arguments, const Common& common) {
  ProbeRequest& order = arguments.plan.order;
  if (order.scene.empty()) {
    report_features(arguments, common);
    return;
  }
  order.memory_mb = common.memory_mb;
  order.threads = common.threads;
  run_probe(order);
}

}  // namespace

report::Page features_report(const ReportRequest& order, const Common& common) {
  FeatureArguments arguments;
  arguments.folder = order.folder.string();
  arguments.plan.order.planet = order.planet;
  arguments.brief = order.is_short;
  return report_features(arguments, common);
}

void add_report_features(CLI::App& report, Common& common) {
  auto arguments = std::make_shared<FeatureArguments>();
  ProbeRequest& order = arguments->plan.order;
  CLI::App* command = add_command(report, "features",
                                  "What imagery, light, shadows, overlays and the like cost: on, off, and in a "
                                  "program built without them",
                                  common, true);
  command->add_option("PLANET", order.planet, "Planet file or DEM; the embedded Mars when left out");
  command->add_option("-o,--output", arguments->folder,
                      "Folder for features.html, features.json, features.csv");
  command->add_option("--against", arguments->plan.against,
                      "Another vpe, built without overlays and windows: its figures stand as 'never'");
  command->add_option("--pose", order.pose, "LON,LAT,HEIGHT,YAW,PITCH: degrees, metres above the terrain")
      ->capture_default_str();
  command->add_option("--size", order.size, "WIDTHxHEIGHT, pixels")->capture_default_str();
  command->add_option("--rounds", arguments->plan.rounds, "How often each frame is timed")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command->add_option("--starts", arguments->plan.starts, "How often each process is started")
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
  command->callback([arguments, &common] { report_or_probe(*arguments, common); });
}

}  // namespace vpe::app
