// vpe report features.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "vpe/app/cli/examples.h"
#include "vpe/app/cli/interrupt.h"
#include "vpe/app/cli/json_output.h"
#include "vpe/app/cli/progress.h"
#include "vpe/app/planet/planet_argument.h"
#include "vpe/app/report/feature_run.h"
#include "vpe/app/report/report_commands.h"
#include "vpe/app/report/report_folder.h"
#include "vpe/base/temporary.h"

namespace vpe::app {
namespace {

struct FeatureArguments {
  FeaturePlan plan;  // the scene of its probe is empty unless this is a child process
  std::string folder;
  bool brief = false;

  FeatureArguments() {
    plan.probe.pose = "-70,-13.5,4000,80,-15";
    plan.probe.size = "640x360";
  }
};

// Removes a file at the end of its life.
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
  ProbeRequest& probe = arguments.plan.probe;
  probe.memory_mb = common.memory_mb;
  probe.threads = common.threads;
  if (arguments.folder.empty()) throw UsageError("-o FOLDER is missing: the folder for the report");
  if (arguments.brief) {
    probe.size = "160x90";
    probe.frames = 2;
    arguments.plan.rounds = 3;
    arguments.plan.starts = 1;
  }
  const std::filesystem::path folder = arguments.folder;
  check_report_folder(folder);
  report::RunFacts facts = read_run_facts(common);
  const InterruptGuard guard;
  const auto planet = open_planet(probe.planet, common);
  probe.planet = planet->path();
  static_cast<void>(feature_view(probe.pose, probe.size, planet));
  const Scratch scratch(base::temporary_name(folder / "statistics").string() + ".csv");
  probe.statistics_file = scratch.name();

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
  for (const core::Backend backend : {core::Backend::kPolygon, core::Backend::kRay}) {
    InterruptGuard::check();
    measure_frames(arguments.plan, rows, backend, context, planet);
  }

  const report::Table table = report::feature_table(feature_costs(rows, !arguments.plan.against.empty()));
  report::Page page;
  page.title = "Cost of features that a scene can do without";
  page.paragraphs = report::to_paragraphs(facts);
  page.paragraphs.push_back("Planet " + planet->path() + ", pose " + probe.pose +
                            " (longitude, latitude, metres above the terrain, heading, pitch), " + probe.size +
                            (arguments.plan.against.empty() ? "" : "; never: " + arguments.plan.against));
  page.sections.push_back({"Costs", {}, {}, {table}});
  const nlohmann::json json{
      {"run", report::to_json(facts)},
      {"load_after", report::load_now()},
      {"planet", planet->path()},
      {"pose", probe.pose},
      {"size", probe.size},
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

// Makes the report, or in a process that a report has started, measures that process.
void report_or_probe(FeatureArguments& arguments, const Common& common) {
  ProbeRequest& probe = arguments.plan.probe;
  if (probe.scene.empty()) {
    report_features(arguments, common);
    return;
  }
  probe.memory_mb = common.memory_mb;
  probe.threads = common.threads;
  run_probe(probe);
}

}  // namespace

report::Page features_report(const ReportRequest& request, const Common& common) {
  FeatureArguments arguments;
  arguments.folder = request.folder.string();
  arguments.plan.probe.planet = request.planet;
  arguments.brief = request.is_short;
  return report_features(arguments, common);
}

void add_report_features(CLI::App& report, Common& common) {
  auto arguments = std::make_shared<FeatureArguments>();
  ProbeRequest& probe = arguments->plan.probe;
  CLI::App* command =
      add_command(report, "features",
                  "Measure the cost of imagery, light, shadows, overlays and other features: on, "
                  "off, and in a program built without them",
                  common, true);
  command->add_option("PLANET", probe.planet, "Planet file or DEM (default: the embedded Mars)");
  command->add_option("-o,--output", arguments->folder,
                      "Folder for features.html, features.json, features.csv");
  command->add_option(
      "--against", arguments->plan.against,
      "Another vpe, built without overlays and windows; its figures become the columns 'never'");
  command->add_option("--pose", probe.pose, "LON,LAT,HEIGHT,YAW,PITCH: degrees, metres above the terrain")
      ->capture_default_str();
  command->add_option("--size", probe.size, "WIDTHxHEIGHT, pixels")->capture_default_str();
  command->add_option("--rounds", arguments->plan.rounds, "Number of times that each frame is timed")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command->add_option("--starts", arguments->plan.starts, "Number of times that each process is started")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command->add_flag("--short", arguments->brief, "Small images, one start of each process");
  // Options for the processes that a report starts.
  command->add_option("--probe", probe.scene)->group("");
  command
      ->add_option_function<std::string>(
          "--backend", [&probe](const std::string& text) { probe.backend = *core::parse_backend(text); })
      ->group("")
      ->check(CLI::IsMember({std::string(core::to_string(core::Backend::kPolygon)),
                             std::string(core::to_string(core::Backend::kRay))}));
  command->add_option("--frames", probe.frames)->group("")->check(CLI::Range(1, 1000));
  command->add_option("--statistics", probe.statistics_file)->group("");
  add_examples(*command, {{"small images", "vpe report features mars.vpe --short -o features"},
                          {"against a program without overlays and windows",
                           "vpe report features mars.vpe --against build/bare/vpe -o features"}});
  command->callback([arguments, &common] { report_or_probe(*arguments, common); });
}

}  // namespace vpe::app
