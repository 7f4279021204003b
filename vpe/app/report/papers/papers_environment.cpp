#include "vpe/app/report/papers/papers_environment.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "panorama/image/tiled_image.h"
#include "panorama/viewer/render_view.h"
#include "panorama/viewer/viewer.h"
#include "vpe/app/panorama/panorama_requests.h"
#include "vpe/app/report/papers/paper_images.h"
#include "vpe/base/number.h"
#include "vpe/gl/tile_geometry.h"
#include "vpe/report/interleaved_timing.h"
#include "vpe/report/papers.h"
#include "vpe/voxel/ray_renderer.h"

namespace vpe::app {

namespace {

constexpr int kViewWidth = 1280;
constexpr int kViewHeight = 1024;
constexpr double kTurn_deg = 3;  // from view to view

// Returns the paper's panorama: 8 facets, a third as high as wide.
panorama::PanoramaMap environment_map(const EnvironmentPaperPlan& plan) {
  panorama::PlanOptions options;
  options.kind = panorama::MapKind::kFacets;
  options.facets = report::kHitchner1992.panorama_facets;
  options.width_px = report::kHitchner1992.panorama_width / (plan.is_short ? 4 : 1);
  // Facets have width / 8 columns over 45 degrees.
  const double focal =
      static_cast<double>(*options.width_px) / options.facets / 2 / std::tan(mars::kPi / options.facets);
  const double half_rows =
      static_cast<double>(report::kHitchner1992.panorama_height) / (plan.is_short ? 4 : 1) / 2;
  options.highest_deg = std::atan(half_rows / focal) / mars::kRadiansPerDegree;
  options.lowest_deg = -*options.highest_deg;
  return panorama::plan_panorama(options).map;
}

std::int64_t finest_posts(const paging::PlanetFile& planet) {
  const auto intervals = static_cast<std::int64_t>(planet.meta().tile.intervals());
  std::int64_t tiles = 0;
  for (const lod::TileInfo& tile : planet.tree().tiles()) tiles += tile.has_children ? 0 : 1;
  return tiles * intervals * intervals;
}

}  // namespace

int count_environment_steps(const EnvironmentPaperPlan& plan) { return 2 * (plan.rounds + 1); }

EnvironmentPaper measure_environment_paper(const EnvironmentPaperPlan& plan,
                                           const std::shared_ptr<const paging::PlanetFile>& planet,
                                           const std::filesystem::path& folder,
                                           const std::function<void()>& step) {
  const panorama::PanoramaMap map = environment_map(plan);
  PanoramaView view;
  view.pose = plan.pose;
  view.pose.pitch_deg = 0;
  view.pose.roll_deg = 0;
  view.radius_m = planet->radius_m();
  view.request.settings.mode = core::Mode::kTextured;
  view.request.settings.ray_mode = core::RayMode::kMultires;
  view.request.sun = plan.sun;
  const std::vector<core::DrawRequest> requests = requests_of(map, view);
  const int threads = plan.threads.back();
  const auto renderer =
      voxel::make_ray_renderer(planet, {.memory_bytes = plan.memory_bytes, .threads = threads});
  const auto draw = [&] {
    std::vector<core::Frame> frames;
    for (const core::DrawRequest& request : requests) frames.push_back(renderer->draw(request).frame);
    return frames;
  };
  const core::Frame whole = mosaic(map, draw());
  const core::RgbImage image{whole.width, whole.height, whole.colour};
  EnvironmentPaper paper;
  const std::string name = "environment-panorama.png";
  paper.section.images = {write_paper_image(folder, name, "Panorama of 8 facets", image)};
  const auto tiled = panorama::open_tiled_image(
      folder / name, panorama::ImageFileFormat::kPng,
      {.budget_bytes = plan.memory_bytes, .cache_folder = [&folder] { return folder; }, .progress = {}});
  panorama::Viewer viewer(map, kViewWidth, kViewHeight);
  panorama::RenderViewOptions options;
  options.threads = threads;
  const auto prepare = [&](double) { step(); };
  const std::vector<report::BenchmarkCase> cases{{[&] { draw(); }, prepare},
                                                 {[&] {
                                                    viewer.turn(kTurn_deg, 0);
                                                    panorama::render_view(*tiled, map, viewer.view(), options);
                                                  },
                                                  prepare}};
  const std::vector<report::Timing> timings = report::time_interleaved(cases, plan.rounds);
  const core::RgbImage seen = panorama::render_view(*tiled, map, viewer.view(), options);
  paper.section.images.push_back(write_paper_image(folder, "environment-overlook.png", "A view of it", seen));

  const report::PublishedEnvironment& p = report::kHitchner1992;
  const double share = static_cast<double>(map.width_px) * static_cast<double>(map.height_px) /
                       (static_cast<double>(p.panorama_width) * p.panorama_height);
  report::Table table;
  table.name = "environment-figures";
  table.caption = "Figures of merit";
  table.columns = {{"quantity", "what is measured"},
                   {"published", "in the paper"},
                   {"here", "here"},
                   {"here_to_published", "here over published"}};
  const auto add = [&](const std::string& what, double published, double here) {
    table.add({what, published, here, here / published});
  };
  const std::string size = std::to_string(map.width_px) + " x " + std::to_string(map.height_px);
  add("panorama of " + size + " pixels in 8 facets, s", p.panorama_s * share, timings[0].median_s());
  add("views of the panorama a second, 1280 x 1024 pixels (published: close to the rate of the screen)",
      p.overlook_per_s, 1 / timings[1].median_s());
  add("bytes of a vertex with light and texture, at most", p.vertex_bytes,
      static_cast<double>(sizeof(gl::VertexPosition) + sizeof(gl::VertexChart)));
  add("posts of the largest terrain (here: of the planet's finest tiles)", p.most_vertices,
      static_cast<double>(finest_posts(*planet)));
  paper.tables = {table};
  paper.section.heading = "Virtual Planetary Exploration (Hitchner 1992)";
  paper.section.paragraphs = {
      "Published: Stardent GS2000, four processors of 5 MIPS and 150 000 triangles a second at most; the overlook is shifted by "
      "hardware.",
      "Here: the ray backend on " + std::to_string(threads) + (threads == 1 ? " thread" : " threads") +
          ", rays.mode=multires, imagery with light. Views are resampled with perspective and filters rather than shifted.",
      "Views are slower than the screen because each pixel's direction is turned into a place by itself: by a profile of "
      "2026-11-27 that is half of the time, and a fifth are the means of neighbouring pixels."};
  paper.section.tables = paper.tables;
  return paper;
}

}  // namespace vpe::app
