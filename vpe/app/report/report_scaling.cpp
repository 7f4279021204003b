// vpe report scaling.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "vpe/app/cli/examples.h"
#include "vpe/app/cli/interrupt.h"
#include "vpe/app/cli/json_output.h"
#include "vpe/app/cli/progress.h"
#include "vpe/app/report/report_commands.h"
#include "vpe/app/report/report_folder.h"
#include "vpe/app/report/scaling_run.h"
#include "vpe/base/temporary.h"

namespace vpe::app {
namespace {

struct ScalingArguments {
  std::string folder;
  std::vector<int> grid_sides;
  std::vector<int> depth_sides;
  int rounds = 0;
  bool full = false;
  bool brief = false;
};

void check_sides(const char* option, const std::vector<int>& sides) {
  if (sides.empty()) return;
  const bool rising = std::adjacent_find(sides.begin(), sides.end(), std::greater_equal<>()) == sides.end();
  if (sides.size() >= 2 && rising && std::all_of(sides.begin(), sides.end(), is_side)) return;
  throw UsageError(std::string(option) +
                   ": expected two or more of 257, 513, 1025, 2049, 4097, 8193, 16385, in rising order");
}

ScalingPlan make_plan(const ScalingArguments& arguments, const Common& common) {
  if (arguments.full && arguments.brief) throw UsageError("--full and --short exclude each other");
  check_sides("--sizes", arguments.grid_sides);
  check_sides("--depths", arguments.depth_sides);
  ScalingPlan plan = arguments.full ? full_scaling() : arguments.brief ? short_scaling() : usual_scaling();
  if (!arguments.grid_sides.empty()) plan.grid_sides = arguments.grid_sides;
  if (!arguments.depth_sides.empty()) plan.depth_sides = arguments.depth_sides;
  if (arguments.rounds > 0) plan.rounds = arguments.rounds;
  plan.memory_bytes = memory_bytes(common);
  return plan;
}

// Share of the time, for the progress.
constexpr double kBuildShare = 0.6;

class Steps {
 public:
  Steps(bool quiet, double images) : line_(quiet), images_(images) {}

  void building(double fraction) {
    InterruptGuard::check();
    line_.show("building planets", kBuildShare * fraction);
  }
  void image(const char* what) {
    InterruptGuard::check();
    drawn_ += 1;
    line_.show(what, std::min(1.0, kBuildShare + (1 - kBuildShare) * drawn_ / images_));
  }

 private:
  ProgressLine line_;
  double images_;
  double drawn_ = 0;
};

double count_images(const ScalingPlan& plan) {
  const auto count = [](const auto& list) { return static_cast<double>(list.size()); };
  return (plan.rounds + 1) * (3 * count(plan.grid_sides) + 6 * count(plan.depth_sides) + 3 * count(plan.sizes) +
                              2 * count(plan.threads)) +
         count(plan.speeds_m_s) * plan.flight_s * 30;
}

const char* about(const std::string& axis) {
  if (axis == "builder") return "Cost of a build over the finest posts of the planet.";
  if (axis == "grid")
    return "Grids of posts 10 m apart, from a few kilometres to the whole patch, seen from 500 m above their "
           "middle.";
  if (axis == "depth")
    return "One patch of 42 km and one camera, with ever finer posts. The exponent is that of time over posts "
           "a side: time grows by 2 to that power for a doubling of the resolution, which is one level of the "
           "tree.";
  if (axis == "image") return "One view in ever more pixels, from 500 m above the deepest planet.";
  if (axis == "threads") return "The same view on more threads. The exponent of perfect scaling is -1.";
  return "Flights over the deepest planet at ever higher speed.";
}

report::Page make_page(const report::RunFacts& facts, const std::vector<report::Law>& laws,
                       const report::Table& planets, const report::Table& flights) {
  report::Page page;
  page.title = "How costs grow";
  page.paragraphs = report::to_paragraphs(facts);
  page.sections.push_back({"Exponents", {}, {}, {report::law_table(laws)}});
  std::string axis;
  for (const auto& [of, y_name] : report::law_plots(laws)) {
    if (of != axis) {
      page.sections.push_back({of, {about(of)}, {}, {}});
      if (of == "builder") page.sections.back().tables.push_back(planets);
      if (of == "speed") page.sections.back().tables.push_back(flights);
    }
    axis = of;
    page.sections.back().plots.push_back(report::law_plot(laws, of, y_name));
  }
  page.sections.push_back({"All measurements", {}, {}, {report::sample_table(laws)}});
  return page;
}

void print_laws(const std::vector<report::Law>& laws) {
  for (const report::Law& law : laws) {
    const auto fitted = report::fit(law);
    if (!fitted) continue;
    std::printf("%-8s %-28s %-12s over %-40s ^ %s%s\n", law.axis.c_str(), law.what.c_str(), law.y_name.c_str(),
                law.x_name.c_str(), report::exponent_text(fitted->growth).c_str(),
                !fitted->holds   ? ""
                : *fitted->holds ? "  meets the aim"
                                 : "  MISSES the aim");
  }
}

report::Page report_scaling(const ScalingArguments& arguments, const Common& common) {
  const ScalingPlan plan = make_plan(arguments, common);
  const std::filesystem::path folder = arguments.folder;
  check_report_folder(folder);
  report::RunFacts facts = read_run_facts(common);
  const InterruptGuard guard;
  const std::shared_ptr<gl::Context> context = gl::Context::create();
  facts.opengl = context->info().renderer + ", " + context->info().version;
  Steps steps(common.quiet, count_images(plan));

  ScalingPlanets planets(base::temporary_name(folder / "planets"), common.threads);
  std::vector<PatchSpec> specs;
  for (const int side : plan.grid_sides) specs.push_back(grid_patch(side));
  for (const int side : plan.depth_sides) specs.push_back(depth_patch(side));
  planets.build(specs, plan.build_rounds, [&](double fraction) { steps.building(fraction); });

  std::vector<report::Law> laws = planets.laws();
  const char* what = "";
  const ScalingBench bench{plan, planets, context, [&] { steps.image(what); }};
  const auto measure = [&](const char* name, std::vector<report::Law> (*measured)(const ScalingBench&)) {
    what = name;
    for (report::Law& law : measured(bench)) laws.push_back(std::move(law));
  };
  measure("size of the grid", measure_grid);
  measure("depth of the planet", measure_depth);
  measure("size of the image", measure_image);
  measure("threads", measure_threads);
  what = "flights";
  FlightFigures flights = measure_flights(bench);
  std::move(flights.laws.begin(), flights.laws.end(), std::back_inserter(laws));

  const report::Table fits = report::law_table(laws);
  const report::Table samples = report::sample_table(laws);
  const report::Table built = planets.table();
  nlohmann::json json{{"run", report::to_json(facts)},     {"load_after", report::load_now()},
                      {"laws", report::to_json(fits)},     {"samples", report::to_json(samples)},
                      {"planets", report::to_json(built)}, {"flights", report::to_json(flights.table)}};
  report::Page page = make_page(facts, laws, built, flights.table);
  write_report(folder, "scaling", page, json, {fits, samples, built, flights.table});
  if (common.json) {
    print_json(json);
  } else if (!common.quiet) {
    print_laws(laws);
    std::printf("%s\n", (folder / "scaling.html").c_str());
  }
  return page;
}

}  // namespace

report::Page scaling_report(const ReportRequest& request, const Common& common) {
  ScalingArguments arguments;
  arguments.folder = request.folder.string();
  arguments.brief = request.is_short;
  return report_scaling(arguments, common);
}

void add_report_scaling(CLI::App& report, Common& common) {
  auto arguments = std::make_shared<ScalingArguments>();
  CLI::App* command = add_command(
      report, "scaling",
      "Measure how costs grow with grid, depth, image size, threads and speed, with exponents and plots. "
      "Builds its own planets. Each renderer may use --memory",
      common, true);
  command->add_option("-o,--output", arguments->folder, "Folder for scaling.html, scaling.json and CSV files")
      ->required();
  command
      ->add_option("--sizes", arguments->grid_sides,
                   "Posts a side of the growing grids, 2^n + 1, such as 257,513")
      ->delimiter(',');
  command->add_option("--depths", arguments->depth_sides, "Posts a side of the ever finer grids, 2^n + 1")
      ->delimiter(',');
  command->add_option("--rounds", arguments->rounds, "Number of times that each image is timed")
      ->check(CLI::Range(1, 1000));
  command->add_flag("--full", arguments->full,
                    "Grids up to 16385 posts a side and images up to 3840x2160; needs about 3 GB of disk");
  command->add_flag("--short", arguments->brief, "Only the smallest sizes; under a minute");
  add_examples(*command,
               {{"under a minute", "vpe report scaling --short -o scaling"},
                {"grids of the sizes given", "vpe report scaling --sizes 257,513,1025 --rounds 5 -o scaling"}});
  command->callback([arguments, &common] { report_scaling(*arguments, common); });
}

}  // namespace vpe::app
