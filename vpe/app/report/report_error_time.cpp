// vpe report error-time.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <stdexcept>

#include "vpe/app/cli/examples.h"
#include "vpe/app/cli/interrupt.h"
#include "vpe/app/cli/json_output.h"
#include "vpe/app/cli/output.h"
#include "vpe/app/cli/progress.h"
#include "vpe/app/picture/image_options.h"
#include "vpe/app/planet/planet_argument.h"
#include "vpe/app/report/embree_ranges.h"
#include "vpe/app/report/report_commands.h"
#include "vpe/app/report/report_error_time_configurations.h"
#include "vpe/app/report/report_folder.h"
#include "vpe/base/file.h"
#include "vpe/base/number.h"
#include "vpe/base/parallel.h"
#include "vpe/base/temporary.h"
#include "vpe/core/json_text.h"
#include "vpe/gl/polygon_renderer.h"
#include "vpe/report/error_time_page.h"
#include "vpe/voxel/ray_renderer.h"

namespace vpe::app {

namespace {

namespace fs = std::filesystem;

// Parts of --memory. What an image takes while rays draw it comes on top of what they keep of the ground, with triangles it is
// included. Larger: tiles are read again less often, and the process takes more than --memory.
constexpr double kMostOfRays = 0.5;
constexpr std::size_t kSurfaceShare = 16;  // for the errors of pixels

constexpr const char* kExactBaseline = "exact";
constexpr const char* kEmbreeBaseline = "embree";

struct ErrorTimeArguments {
  std::string planet;
  std::string output;
  bool is_short = false;
  std::string size;  // empty: the default, or that of --short
  int rounds = 0;    // 0: the default, or that of --short
  std::vector<std::string> views;
  std::string baseline = kExactBaseline;
};

constexpr const char* kShortViews[] = {"high oblique", "canyon floor"};

std::vector<NamedView> chosen_views(const ErrorTimeArguments& arguments, std::vector<NamedView> all) {
  std::vector<std::string> wanted = arguments.views;
  if (wanted.empty() && arguments.is_short) wanted.assign(std::begin(kShortViews), std::end(kShortViews));
  if (wanted.empty()) return all;
  std::string names;
  for (const NamedView& view : all) names += (names.empty() ? "" : ", ") + view.name;
  std::vector<NamedView> chosen;
  for (const std::string& name : wanted) {
    const auto found = std::find_if(all.begin(), all.end(), [&](const NamedView& v) { return v.name == name; });
    if (found == all.end()) throw UsageError("--view '" + name + "': the views are " + names);
    chosen.push_back(*found);
  }
  return chosen;
}

class Renderers {
 public:
  Renderers(std::shared_ptr<const paging::PlanetFile> planet, const Common& common)
      : planet_(std::move(planet)), common_(common), context_(gl::Context::create()) {}

  std::unique_ptr<core::Renderer> make(const std::string& name, double share) const {
    const auto part = [&](double of_all) {
      return static_cast<std::size_t>(of_all * static_cast<double>(memory_bytes(common_)));
    };
    const std::size_t bytes = part(share);
    if (name == kRayImages)
      return voxel::make_ray_renderer(planet_, {part(std::min(share, kMostOfRays)), common_.threads});
    if (name == kEmbreeRanges) return make_embree_renderer(planet_, common_.threads);
    gl::RendererOptions options;
    options.memory_bytes = bytes;
    options.threads = common_.threads;
    return gl::make_polygon_renderer(context_, planet_, options);
  }
  const gl::ContextInfo& info() const { return context_->info(); }

 private:
  std::shared_ptr<const paging::PlanetFile> planet_;
  const Common& common_;
  std::shared_ptr<gl::Context> context_;
};

std::vector<std::string> about(const ErrorTimeArguments& arguments, const report::RunFacts& facts,
                               const paging::PlanetMeta& meta, const Size& size, int rounds) {
  std::vector<std::string> lines = report::to_paragraphs(facts);
  lines.push_back((arguments.planet.empty() ? std::string("The embedded Mars") : arguments.planet) +
                  ", images of " + std::to_string(size.width) + "x" + std::to_string(size.height) +
                  ", 60 degrees high. Times are medians of " + std::to_string(rounds) +
                  " interleaved rounds, with everything loaded, from the request to colours in memory.");
  lines.emplace_back(
      "Errors are measured against rays in mode exact, and shifts against the reference surface "
      "(docs/guide/numbers-and-errors.md). docs/design/reports.md defines each figure.");
  lines.emplace_back(
      "Limits: untextured triangles have one colour each; Hitchner 1992 compared textures with Gouraud-shaded "
      "meshes, so the comparison neither confirms nor contradicts that one. Rays in mode reference are a "
      "simple march without tuning and no conventional ray caster; their time is no baseline for published "
      "speed-ups. rays.cell bounds the geometric error in pixels; it is not the pixel-to-voxel ratio of "
      "Cohen-Or 1996, as colours do not coarsen with it.");
  if (meta.illustration)
    lines.emplace_back("This planet is an illustration; its numbers are not data about Mars.");
  return lines;
}

void write_files(const fs::path& folder, const report::ErrorTimeReport& report, const report::Page& page) {
  base::write_file(folder / "error-time.csv", report::to_csv(report::points_table(report.results)));
  base::write_file(folder / "error-time.json", core::json_text(report::error_time_json(report), 1) + "\n");
  base::write_file(folder / "error-time.svg", report::to_svg_file(report::summary_plot(report.results)));
  base::write_file(folder / "error-time.html", report::to_html(page));
}

void print_summary(const fs::path& folder, const report::ErrorTimeReport& report) {
  for (const report::SubjectResult& result : report.results) {
    for (const report::DefaultPlace& p : report::place_defaults(result)) {
      std::printf("%-13s %s%-24s %-16s %8.4g  %8.4g ms  %.2f of the front, %.2f of its own front\n",
                  p.view.c_str(), p.is_chosen ? "* " : "  ", p.sweep.c_str(), p.knob.c_str(), p.error,
                  p.time_ms, p.over_front, p.over_own_front);
    }
  }
  std::printf("%s\n", (folder / "error-time.html").c_str());
}

void warn_of_false_statements(const std::vector<report::SubjectResult>& results) {
  for (const report::SubjectResult& result : results) {
    for (std::size_t k = 0; k < result.measured.size(); ++k) {
      const report::Measured& m = result.measured[k];
      if (m.within_stated()) continue;
      std::fprintf(stderr, "vpe: warning: %s, %s, %s: a shift of %s px, but the certificate states %s px\n",
                   result.subject.view.c_str(), result.subject.configurations[k].sweep.c_str(),
                   result.subject.configurations[k].knob.c_str(),
                   base::format_number(m.shift.forward.max_px).c_str(),
                   base::format_number(*m.stated_px).c_str());
    }
  }
}

report::Page error_time(const ErrorTimeArguments& arguments, const Common& common) {
  const Size size = parse_size(!arguments.size.empty() ? arguments.size
                               : arguments.is_short    ? "320x180"
                                                       : "640x360");
  constexpr int kLeastSide = 32;  // half of it still has windows of structural similarity
  if (size.width < kLeastSide || size.height < kLeastSide)
    throw UsageError("--size " + arguments.size + ": each side must be at least " + std::to_string(kLeastSide));
  if (arguments.baseline == kEmbreeBaseline && !has_embree())
    throw UsageError("--baseline embree: not built in; configure with -DVPE_EMBREE=ON (libembree-dev)");
  const int rounds = arguments.rounds > 0 ? arguments.rounds : arguments.is_short ? 3 : 5;
  const fs::path folder = arguments.output;
  make_folder(folder);
  check_output(folder / "error-time.html");
  base::remove_stale_temporaries(folder,
                                 [](const std::string& name) { return name.starts_with("error-time."); });

  const auto planet = open_planet(arguments.planet, common);
  note_illustration(planet->meta(), common.quiet);
  const paging::Surface surface(planet, memory_bytes(common) / kSurfaceShare);
  const std::vector<NamedView> views =
      chosen_views(arguments, arguments.planet.empty() ? embedded_views(surface) : views_of(surface));
  report::RunFacts facts = read_run_facts(common);
  const Renderers renderers(planet, common);
  facts.opengl = renderers.info().renderer + ", " + renderers.info().version;

  report::ErrorTimeReport report{"Error against time", {}, {}};
  {
    const InterruptGuard guard;
    ProgressLine progress(common.quiet);
    report::ErrorTimeOptions options;
    options.make = [&](const std::string& name, double share) { return renderers.make(name, share); };
    options.surface = [&](std::span<const glm::dvec3> directions, std::span<double> radius_m) {
      surface.radius(directions, radius_m);
    };
    options.rounds = rounds;
    options.threads = common.threads > 0 ? common.threads : base::default_threads();
    for (std::size_t k = 0; k < views.size(); ++k) {
      options.progress = [&](const std::string& what, double fraction) {
        InterruptGuard::check();
        progress.show(what, (static_cast<double>(k) + fraction) / static_cast<double>(views.size()));
      };
      ConfigurationOptions configurations;
      configurations.width = size.width;
      configurations.height = size.height;
      configurations.is_short = arguments.is_short;
      configurations.has_gpu = gl::has_gpu();
      configurations.with_embree = arguments.baseline == kEmbreeBaseline;
      report.results.push_back(report::measure(subject_of(views[k], *planet, configurations), options));
    }
    InterruptGuard::check();
  }
  report.about = about(arguments, facts, planet->meta(), size, rounds);
  report::Page page = report::error_time_page(report);
  write_files(folder, report, page);
  warn_of_false_statements(report.results);
  if (common.json) {
    print_json(report::error_time_json(report));
  } else if (!common.quiet) {
    print_summary(folder, report);
  }
  return page;
}

}  // namespace

report::Page error_time_report(const ReportRequest& request, const Common& common) {
  ErrorTimeArguments arguments;
  arguments.output = request.folder.string();
  arguments.planet = request.planet;
  arguments.is_short = request.is_short;
  return error_time(arguments, common);
}

void add_report_error_time(CLI::App& report, Common& common) {
  auto arguments = std::make_shared<ErrorTimeArguments>();
  CLI::App* command =
      add_command(report, "error-time", "Measure error against run time of every backend and mode, with plots",
                  common, true);
  command->add_option("PLANET", arguments->planet, "Planet file or DEM (default: the embedded Mars)");
  command->add_option("-o,--output", arguments->output, "Folder for error-time.html, .svg, .csv and .json")
      ->required();
  command->add_flag("--short", arguments->is_short, "Two views, small images, few values of each setting");
  command
      ->add_option(
          "--view", arguments->views,
          "Only this view (repeatable): orbit, high oblique, canyon floor, rim, crater, plain, grazing, polar")
      ->expected(1)
      ->allow_extra_args(false)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  command->add_option("--size", arguments->size,
                      "WIDTHxHEIGHT, pixels (default: 640x360; with --short 320x180)");
  command->add_option("--rounds", arguments->rounds, "Interleaved rounds of timing; 0: 5, or 3 with --short")
      ->check(CLI::Range(0, 1000))
      ->capture_default_str();
  command
      ->add_option("--baseline", arguments->baseline,
                   "Timing baseline: exact ray casting, or Embree (ranges only; if built in)")
      ->check(CLI::IsMember({kExactBaseline, kEmbreeBaseline}))
      ->capture_default_str();
  add_examples(*command, {{"a first look", "vpe report error-time mars.vpe --short -o error-time"},
                          {"one view in more detail",
                           "vpe report error-time mars.vpe --view rim --size 1280x720 --rounds 9 -o rim"}});
  command->callback([arguments, &common] { error_time(*arguments, common); });
}

}  // namespace vpe::app
