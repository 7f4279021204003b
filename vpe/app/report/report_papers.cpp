// vpe report papers.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <thread>

#include "mars/geodesy/pose.h"
#include "vpe/app/cli/examples.h"
#include "vpe/app/cli/interrupt.h"
#include "vpe/app/cli/json_output.h"
#include "vpe/app/cli/progress.h"
#include "vpe/app/picture/image_options.h"
#include "vpe/app/picture/pose_option.h"
#include "vpe/app/picture/sun_statement.h"
#include "vpe/app/planet/planet_argument.h"
#include "vpe/app/report/papers/papers_environment.h"
#include "vpe/app/report/papers/papers_flythrough.h"
#include "vpe/app/report/papers/papers_relief.h"
#include "vpe/app/report/papers/papers_stereo.h"
#include "vpe/app/report/papers/papers_terrain.h"
#include "vpe/app/report/papers/papers_texture.h"
#include "vpe/app/report/papers/papers_triangles.h"
#include "vpe/app/report/report_commands.h"
#include "vpe/app/report/report_error_time_views.h"
#include "vpe/app/report/report_folder.h"

namespace vpe::app {
namespace {

struct PapersArguments {
  std::string planet;
  std::string folder;
  std::string pose = "-59.2,-13.7,0,90,-15,0";
  double height_m = 2000;
  std::string size = "500x400";
  double fov_deg = 45;
  double eye_base_m = 0;
  int rounds = 9;
  bool brief = false;
};

StereoPaperPlan make_plan(const PapersArguments& arguments, const Common& common,
                          const std::shared_ptr<const paging::PlanetFile>& planet) {
  StereoPaperPlan plan;
  const Size size = parse_size(arguments.size);
  const mars::Pose pose = resolve(parse_pose("--pose", arguments.pose, arguments.height_m), planet, 1);
  plan.view.camera = mars::to_camera(pose, planet->radius_m());
  plan.view.width = size.width;
  plan.view.height = size.height;
  plan.view.fov_deg = arguments.fov_deg;
  if (const std::string error = core::check(plan.view); !error.empty()) throw UsageError(error);
  plan.sun = sun_for(core::SettingsValues(), pose);
  plan.eye_base_m = arguments.eye_base_m;
  plan.rounds = arguments.brief ? 2 : arguments.rounds;
  plan.memory_bytes = memory_bytes(common);
  const int most =
      common.threads > 0 ? common.threads : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  for (const int threads : {1, 2, 4, 8, 12, 16})
    if (threads <= most && (!arguments.brief || threads == 1)) plan.threads.push_back(threads);
  return plan;
}

EnvironmentPaperPlan make_environment_plan(const PapersArguments& arguments, const StereoPaperPlan& stereo,
                                           const std::shared_ptr<const paging::PlanetFile>& planet) {
  EnvironmentPaperPlan plan;
  plan.pose = resolve(parse_pose("--pose", arguments.pose, arguments.height_m), planet, 1);
  plan.sun = stereo.sun;
  plan.threads = stereo.threads;
  plan.rounds = stereo.rounds;
  plan.is_short = arguments.brief;
  plan.memory_bytes = stereo.memory_bytes;
  return plan;
}

TexturePaperPlan make_texture_plan(const PapersArguments& arguments, const StereoPaperPlan& stereo,
                                   const std::shared_ptr<const paging::PlanetFile>& planet) {
  TexturePaperPlan plan;
  const paging::Surface surface(planet, stereo.memory_bytes / 8);
  for (const NamedView& view : arguments.planet.empty() ? embedded_views(surface) : views_of(surface))
    if (!arguments.brief || plan.views.size() < 3) plan.views.push_back({view.name, view.pose});
  plan.width_px = arguments.brief ? 160 : stereo.view.width;
  plan.height_px = arguments.brief ? 128 : stereo.view.height;
  plan.fov_deg = arguments.fov_deg;
  plan.rounds = stereo.rounds;
  plan.memory_bytes = stereo.memory_bytes;
  return plan;
}

report::Page report_papers(const PapersArguments& arguments, const Common& common) {
  const std::filesystem::path folder = arguments.folder;
  check_report_folder(folder);
  const report::RunFacts facts = read_run_facts(common);
  const InterruptGuard guard;
  const auto planet = open_planet(arguments.planet, common);
  const StereoPaperPlan plan = make_plan(arguments, common, planet);
  const TerrainPaperPlan terrain_plan{plan.threads, plan.rounds, arguments.brief};
  const EnvironmentPaperPlan environment_plan = make_environment_plan(arguments, plan, planet);
  const TexturePaperPlan texture_plan = make_texture_plan(arguments, plan, planet);
  const FlythroughPaperPlan flythrough_plan{arguments.fov_deg, plan.threads, plan.rounds, arguments.brief,
                                            plan.memory_bytes};
  const ReliefPaperPlan relief_plan{.rounds = plan.rounds, .is_short = arguments.brief};
  ProgressLine line(common.quiet);
  int done = 0;
  const StereoPaper stereo = measure_stereo_paper(plan, planet, folder, [&] {
    InterruptGuard::check();
    line.show("stereo", static_cast<double>(done++) / count_steps(plan));
  });
  done = 0;
  const TerrainPaper terrain = measure_terrain_paper(terrain_plan, folder, [&] {
    InterruptGuard::check();
    line.show("terrain", static_cast<double>(done++) / count_steps(terrain_plan));
  });
  done = 0;
  const TrianglesPaperPlan triangles_plan{plan.rounds, plan.memory_bytes};
  const TrianglesPaper triangles = measure_triangles_paper(triangles_plan, folder, [&] {
    InterruptGuard::check();
    line.show("triangles", static_cast<double>(done++) / count_triangles_steps(triangles_plan));
  });
  done = 0;
  const FlythroughPaper flythrough = measure_flythrough_paper(flythrough_plan, folder, [&] {
    InterruptGuard::check();
    line.show("flythrough", static_cast<double>(done++) / count_steps(flythrough_plan));
  });
  done = 0;
  const EnvironmentPaper environment = measure_environment_paper(environment_plan, planet, folder, [&] {
    InterruptGuard::check();
    line.show("environment", static_cast<double>(done++) / count_environment_steps(environment_plan));
  });
  done = 0;
  const TexturePaper texture = measure_texture_paper(texture_plan, planet, folder, [&] {
    InterruptGuard::check();
    line.show("texture", static_cast<double>(done++) / count_texture_steps(texture_plan));
  });
  done = 0;
  const ReliefPaper relief = measure_relief_paper(relief_plan, folder, [&] {
    InterruptGuard::check();
    line.show("relief", static_cast<double>(done++) / count_steps(relief_plan));
  });
  std::vector<report::Table> tables;
  for (const auto* own : {&environment.tables, &texture.tables, &stereo.tables, &terrain.tables,
                          &triangles.tables, &flythrough.tables, &relief.tables})
    tables.insert(tables.end(), own->begin(), own->end());

  report::Page page;
  page.title = "Figures of the papers, published and here";
  page.paragraphs = report::to_paragraphs(facts);
  page.paragraphs.push_back("Panorama and stereo: planet " + planet->path() + ", pose " + arguments.pose +
                            ", " + arguments.size + " pixels in stereo.");
  page.sections = {environment.section, texture.section,    stereo.section, terrain.section,
                   triangles.section,   flythrough.section, relief.section};
  nlohmann::json json{{"run", report::to_json(facts)}, {"load_after", report::load_now()},
                      {"planet", planet->path()},      {"pose", arguments.pose},
                      {"size", arguments.size},        {"eye_base_m", stereo.eye_base_m}};
  for (const report::Table& table : tables) json[table.name] = report::to_json(table);
  write_report(folder, "papers", page, json, tables);
  if (common.json) {
    print_json(json);
  } else if (!common.quiet) {
    std::printf("%s\n", (folder / "papers.html").c_str());
  }
  return page;
}

}  // namespace

report::Page papers_report(const ReportRequest& request, const Common& common) {
  PapersArguments arguments;
  arguments.folder = request.folder.string();
  arguments.planet = request.planet;
  arguments.brief = request.is_short;
  return report_papers(arguments, common);
}

void add_report_papers(CLI::App& report, Common& common) {
  auto arguments = std::make_shared<PapersArguments>();
  CLI::App* command = add_command(
      report, "papers",
      "Measure what the papers that vpe follows have published, and put both side by side; so "
      "far the figures of merit and textures in place of triangles of Hitchner (1992), the two tables and Fig. 8 of Wan and others (2000), stereo by reprojection, Table 1, Figs 6 and 7 and the times "
      "of section 7 of Wan and others (1999), terrain as a volume, Table 1, the pixel-to-voxel ratio and the database of Cohen-Or and others (1996), flythrough by discrete rays, and the table and Figs 6 to 8 of Vyatkin and Dolgovesov (2002), relief by perturbation functions",
      common, true);
  command->add_option("PLANET", arguments->planet, "Planet file or DEM (default: the embedded Mars)");
  command
      ->add_option("-o,--output", arguments->folder,
                   "Folder for papers.html, papers.json, CSV files and images")
      ->required();
  command
      ->add_option("--pose", arguments->pose,
                   "LON,LAT,ALT,YAW,PITCH,ROLL of the camera, degrees; ALT is not used")
      ->capture_default_str();
  command->add_option("--height", arguments->height_m, "Height of the camera above the terrain, metres")
      ->check(number_within(0.1, 1e9))
      ->capture_default_str();
  command->add_option("--size", arguments->size, "WIDTHxHEIGHT of an eye's image, pixels")
      ->capture_default_str();
  command->add_option("--fov", arguments->fov_deg, "Vertical field of view, degrees")
      ->check(number_within(core::ViewLimits::kMinFov_deg, core::ViewLimits::kMaxFov_deg))
      ->capture_default_str();
  command
      ->add_option(
          "--eye-base", arguments->eye_base_m,
          "Distance between the eyes, metres (default: a thirtieth of the distance to the nearest terrain)")
      ->check(number_within(1e-6, 1e7));
  command->add_option("--rounds", arguments->rounds, "Number of times that each image is timed")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command->add_flag(
      "--short", arguments->brief,
      "Two rounds on one thread, bilinear relief, 3 rolls, 3 ratios and 3 views with textures only; under a minute");
  add_examples(*command, {{"under a minute", "vpe report papers --short -o papers"},
                          {"images of today's size", "vpe report papers mars.vpe --size 1920x1080 -o papers"}});
  command->callback([arguments, &common] { report_papers(*arguments, common); });
}

}  // namespace vpe::app
