#include "vpe/app/report/papers/papers_triangles.h"

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <utility>

#include "mars/geodesy/pose.h"
#include "mars/geodesy/sun.h"
#include "vpe/app/report/papers/paper_images.h"
#include "vpe/app/report/papers/patch_scene.h"
#include "vpe/gl/polygon_renderer.h"
#include "vpe/report/interleaved_timing.h"
#include "vpe/report/papers.h"
#include "vpe/voxel/ray_renderer.h"

namespace vpe::app {

namespace {

// A way to draw the terrain. Rays have no triangles.
struct TerrainWay {
  const char* name;
  std::optional<core::RayMode> rays;
  double published_s;  // 0: not in the paper
};

constexpr std::size_t kAccurateWay = 1;

std::array<TerrainWay, 4> terrain_ways() {
  const report::PublishedTerrain& one = report::kWan1999Terrain.front();
  return {{{"triangles, full resolution", std::nullopt, report::kWan1999Times.triangles_s},
           {"rays, accurate (rays.mode=volume)", core::RayMode::kVolume, one.accurate_s},
           {"rays, approximate (rays.mode=boundary)", core::RayMode::kBoundary, one.approximate_s},
           {"rays, exact (rays.mode=exact)", core::RayMode::kExact, 0}}};
}

core::DrawRequest triangles_request(const PatchScene& scene, const TerrainWay& way) {
  core::DrawRequest request;
  request.view.camera = mars::to_camera(scene.pose, scene.build.planet->radius_m());
  request.view.width = 500;
  request.view.height = 400;
  request.view.fov_deg = 45;
  request.sun = mars::sun_direction({scene.pose.lon_deg, scene.pose.lat_deg}, 315, 40);
  core::SettingsValues& settings = request.settings;
  settings.mode = core::Mode::kColoured;
  settings.smooth_edges = false;
  settings.lod_tolerance_px = 0;
  settings.occlusion = core::Occlusion::kOff;
  if (way.rays) settings.ray_mode = *way.rays;
  return request;
}

report::Table triangles_table(const std::array<std::optional<report::Timing>, 4>& timings,
                              const std::array<core::DrawResult, 4>& images) {
  report::Table table;
  table.name = "terrain-triangles";
  table.caption = "Section 7: triangles and rays, one processor, on a planet";
  table.columns = {{"way", "how the terrain is drawn"},
                   {"published_s", "in the paper"},
                   {"published_to_accurate", "over accurate rays, in the paper"},
                   {"time_s", "here, from request to colours in memory (median)"},
                   {"to_accurate", "over accurate rays, here (median of ratios within a round)"},
                   {"ratio_of_ratios", "here over published"},
                   {"triangles", "drawn"}};
  const std::array<TerrainWay, 4> ways = terrain_ways();
  for (std::size_t n = 0; n < ways.size(); ++n) {
    std::vector<report::Cell> row(table.columns.size());
    row[0] = std::string(ways[n].name);
    const double published = ways[n].published_s / ways[kAccurateWay].published_s;
    if (ways[n].published_s > 0) {
      row[1] = ways[n].published_s;
      row[2] = published;
    }
    if (timings[n]) {
      const double here = report::ratio(*timings[n], *timings[kAccurateWay]);
      row[3] = timings[n]->median_s();
      row[4] = here;
      if (ways[n].published_s > 0) row[5] = here / published;
      if (!ways[n].rays) row[6] = static_cast<double>(images[n].stats.triangles);
    }
    table.add(std::move(row));
  }
  return table;
}

}  // namespace

int count_triangles_steps(const TrianglesPaperPlan& plan) {
  return static_cast<int>(terrain_ways().size()) * (plan.rounds + 1);
}

TrianglesPaper measure_triangles_paper(const TrianglesPaperPlan& plan, const std::filesystem::path& folder,
                                       const std::function<void()>& step) {
  PatchScene scene;
  build_patch_scene(folder / "triangles-terrain.vpe", {.height_share = 1.0 / 6}, scene);
  scene.pose.pitch_deg = -30;
  const std::array<TerrainWay, 4> ways = terrain_ways();
  std::shared_ptr<gl::Context> context;
  std::unique_ptr<core::Renderer> polygons;
  std::string trouble;
  try {
    context = gl::Context::create();
    gl::RendererOptions options;
    options.memory_bytes = plan.memory_bytes / 2;
    polygons = gl::make_polygon_renderer(context, scene.build.planet, options);
  } catch (const gl::ContextError& e) {
    trouble = e.what();
  }
  const std::unique_ptr<core::PixelRenderer> rays =
      voxel::make_ray_renderer(scene.build.planet, {.memory_bytes = plan.memory_bytes / 2, .threads = 1});
  std::array<core::DrawResult, 4> images;
  std::array<std::optional<std::size_t>, 4> place;
  std::vector<report::BenchmarkCase> cases;
  for (std::size_t n = 0; n < ways.size(); ++n) {
    core::Renderer* renderer = ways[n].rays ? static_cast<core::Renderer*>(rays.get()) : polygons.get();
    if (renderer == nullptr) continue;
    place[n] = cases.size();
    const core::DrawRequest request = triangles_request(scene, ways[n]);
    cases.push_back({[&images, renderer, request, n] { images[n] = renderer->draw(request); },
                     [&step](double) { step(); }});
  }
  const std::vector<report::Timing> timings = report::time_interleaved(cases, plan.rounds);
  std::array<std::optional<report::Timing>, 4> by_way;
  for (std::size_t n = 0; n < ways.size(); ++n)
    if (place[n]) by_way[n] = timings[*place[n]];

  TrianglesPaper paper;
  paper.section.heading = "Triangles and rays (Wan, Qu, Kaufman 1999, section 7)";
  paper.section.paragraphs = {
      "Published: the terrain of Table 1 as triangles with its photograph, at full resolution on the graphics hardware of the same "
      "machine.",
      "Here: made-up terrain of 513 x 513 posts on a planet, coloured by elevation with light in place of a photograph, 500 x 400 "
      "pixels, a pitch of -30 degrees; rays on one thread. Triangles are those of lod.tolerance=0. Only ratios compare: without "
      "graphics hardware OpenGL runs on all processors.",
      "Triangles gain more than in the paper: OpenGL works on many pixels at once and on all processors, while these rays go from "
      "tile to tile and from sample to sample on one (docs/design/terrain-volume.md has the profile)."};
  if (!trouble.empty())
    paper.section.paragraphs.push_back("Triangles were not measured: there is no OpenGL: " + trouble + ".");
  paper.tables = {triangles_table(by_way, images)};
  for (const auto& [n, file, caption] :
       {std::tuple(std::size_t{0}, "terrain-triangles.png", "Triangles, full resolution"),
        std::tuple(kAccurateWay, "terrain-volume.png", "The same by accurate rays, on a planet")}) {
    if (!by_way[n]) continue;
    core::Frame& frame = images[n].frame;
    paper.section.images.push_back(
        write_paper_image(folder, file, caption, {frame.width, frame.height, std::move(frame.colour)}));
  }
  paper.section.tables = paper.tables;
  return paper;
}

}  // namespace vpe::app
