#include "vpe/app/report/papers/papers_flythrough.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <set>
#include <string>

#include "mars/geodesy/pose.h"
#include "mars/geodesy/sun.h"
#include "vpe/app/report/papers/paper_images.h"
#include "vpe/app/report/papers/patch_scene.h"
#include "vpe/base/number.h"
#include "vpe/core/frame.h"
#include "vpe/report/interleaved_timing.h"
#include "vpe/report/papers.h"
#include "vpe/voxel/ray_renderer.h"

namespace vpe::app {

namespace {

constexpr std::array<double, 3> kPitches_deg{report::kCohenOr1996Pitch_deg, 30, 60};
constexpr double kUsualRatio = 1;

std::vector<double> voxel_ratios(const FlythroughPaperPlan& plan) {
  if (plan.is_short) return {1, 2, 4};
  return {0.5, 1, 2, 4, 8};
}

core::DrawRequest flythrough_request(const FlythroughPaperPlan& plan, const PatchScene& scene,
                                     double pitch_deg) {
  core::DrawRequest request;
  mars::Pose pose = scene.pose;
  pose.pitch_deg = -pitch_deg;
  request.view.camera = mars::to_camera(pose, scene.build.planet->radius_m());
  request.view.width = plan.is_short ? 320 : 640;
  request.view.height = plan.is_short ? 240 : 480;
  request.view.fov_deg = plan.fov_deg;
  request.sun = mars::sun_direction({pose.lon_deg, pose.lat_deg}, 315, 40);
  request.settings.mode = core::Mode::kColoured;
  request.settings.smooth_edges = false;
  request.settings.ray_mode = core::RayMode::kDiscrete;
  return request;
}

// Names what a row of the table of options changes.
struct FlythroughWay {
  std::string name;
  std::function<void(core::SettingsValues&)> set;
};

std::vector<FlythroughWay> flythrough_ways() {
  using V = core::SettingsValues;
  return {{"one ray a pixel", [](V&) {}},
          {"2 rays, one above the other", [](V& v) { v.ray_vertical = 2; }},
          {"4 rays, one above the other", [](V& v) { v.ray_vertical = 4; }},
          {"levels fade into each other", [](V& v) { v.ray_blend = true; }},
          {"lines of pixels as columns", [](V& v) { v.ray_columns = core::RayColumns::kLines; }},
          {"exact casts (rays.mode=exact)", [](V& v) { v.ray_mode = core::RayMode::kExact; }},
          {"exact casts over the same tiles or finer (rays.mode=multires)",
           [](V& v) { v.ray_mode = core::RayMode::kMultires; }}};
}

// Holds what is timed.
struct FlythroughCases {
  std::vector<report::BenchmarkCase> all;
  std::vector<std::array<std::size_t, kPitches_deg.size()>> by_threads;
  std::vector<std::size_t> by_ratio;
  std::vector<std::size_t> by_way;
};

FlythroughCases make_flythrough_cases(const FlythroughPaperPlan& plan, const PatchScene& scene,
                                      const std::function<void()>& step) {
  FlythroughCases cases;
  const std::size_t share = plan.memory_bytes / plan.threads.size();
  const auto add = [&](const std::shared_ptr<core::Renderer>& renderer, const core::DrawRequest& request) {
    cases.all.push_back({[renderer, request] { renderer->draw(request); }, [&step](double) { step(); }});
    return cases.all.size() - 1;
  };
  std::shared_ptr<core::Renderer> single;
  for (const int threads : plan.threads) {
    const std::shared_ptr<core::Renderer> renderer =
        voxel::make_ray_renderer(scene.build.planet, {.memory_bytes = share, .threads = threads});
    if (single == nullptr) single = renderer;
    auto& row = cases.by_threads.emplace_back();
    for (std::size_t n = 0; n < kPitches_deg.size(); ++n)
      row[n] = add(renderer, flythrough_request(plan, scene, kPitches_deg[n]));
  }
  for (const double ratio : voxel_ratios(plan)) {
    core::DrawRequest request = flythrough_request(plan, scene, kPitches_deg[1]);
    request.settings.ray_ratio = ratio;
    cases.by_ratio.push_back(add(single, request));
  }
  for (const FlythroughWay& way : flythrough_ways()) {
    core::DrawRequest request = flythrough_request(plan, scene, kPitches_deg[1]);
    way.set(request.settings);
    cases.by_way.push_back(add(single, request));
  }
  return cases;
}

// Returns the published rates in the order of the paper's columns.
auto most_processors_first() {
  auto rates = report::kCohenOr1996Rates;
  std::ranges::reverse(rates);
  return rates;
}

// Returns images a second: the rows and columns of the paper, then those of this machine.
report::Table rate_table(const FlythroughPaperPlan& plan, const FlythroughCases& cases,
                         const std::vector<report::Timing>& timings) {
  report::Table table;
  table.name = "flythrough-table-1";
  table.caption = "Table 1: images a second, by pitch and processors";
  table.columns = {{"pitch_deg", "below the horizon"}};
  for (const report::PublishedRate& p : most_processors_first())
    table.columns.push_back({"published_" + std::to_string(p.processors) + "p_per_s",
                             std::to_string(p.processors) + " processors, one of which hands out columns"});
  for (const int threads : plan.threads)
    table.columns.push_back({"threads_" + std::to_string(threads) + "_per_s",
                             "here: " + std::to_string(threads) + " threads (median)"});
  for (std::size_t n = 0; n < kPitches_deg.size(); ++n) {
    std::vector<report::Cell> row{kPitches_deg[n]};
    for (const report::PublishedRate& p : most_processors_first()) {
      row.emplace_back();
      if (n == 0) row.back() = p.images_per_s;
    }
    for (const auto& own : cases.by_threads) row.emplace_back(1 / timings[own[n]].median_s());
    table.add(std::move(row));
  }
  return table;
}

// Returns how evenly the rate grows with processors that draw.
report::Table growth_table(const FlythroughPaperPlan& plan, const FlythroughCases& cases,
                           const std::vector<report::Timing>& timings) {
  report::Table table;
  table.name = "flythrough-growth";
  table.caption = "Section 3.3: growth of the rate with processors, the pitch above that has a published row";
  table.columns = {{"workers", "processors that draw, or threads here"},
                   {"published_share", "the rate over workers times the rate of one"},
                   {"here_share", "here: the same (median of ratios within a round)"},
                   {"ratio_of_ratios", "here over published, of the nearest number of workers"}};
  const auto share_of = [](const report::PublishedRate& p) {
    return p.images_per_s / report::kCohenOr1996Rates.front().images_per_s / (p.processors - 1);
  };
  std::set<int> rows(plan.threads.begin(), plan.threads.end());
  for (const report::PublishedRate& p : report::kCohenOr1996Rates) rows.insert(p.processors - 1);
  for (const int workers : rows) {
    const auto nearest = std::ranges::min_element(
        report::kCohenOr1996Rates, {},
        [&](const report::PublishedRate& p) { return std::abs(p.processors - 1 - workers); });
    std::vector<report::Cell> row(table.columns.size());
    row[0] = static_cast<double>(workers);
    if (nearest->processors - 1 == workers) row[1] = share_of(*nearest);
    if (const auto here = std::ranges::find(plan.threads, workers); here != plan.threads.end()) {
      const std::size_t own = cases.by_threads[static_cast<std::size_t>(here - plan.threads.begin())].front();
      const double share = 1 / report::ratio(timings[own], timings[cases.by_threads.front().front()]) / workers;
      row[2] = share;
      row[3] = share / share_of(*nearest);
    }
    table.add(std::move(row));
  }
  return table;
}

report::Table voxel_ratio_table(const FlythroughPaperPlan& plan, const FlythroughCases& cases,
                                const std::vector<report::Timing>& timings) {
  report::Table table;
  table.name = "flythrough-ratio";
  table.caption = "Section 3.3: rate by the pixel-to-voxel ratio, one thread, 30 degrees below the horizon";
  table.columns = {{"ratio_px", "largest width of a voxel"},
                   {"time_s", "time of an image (median)"},
                   {"time_to_ratio_1", "over that at ratio 1 (median of ratios within a round)"}};
  const std::vector<double> ratios = voxel_ratios(plan);
  const auto usual = static_cast<std::size_t>(std::ranges::find(ratios, kUsualRatio) - ratios.begin());
  for (std::size_t n = 0; n < ratios.size(); ++n) {
    const report::Timing& timing = timings[cases.by_ratio[n]];
    table.add({ratios[n], timing.median_s(), report::ratio(timing, timings[cases.by_ratio[usual]])});
  }
  return table;
}

report::Table way_table(const FlythroughCases& cases, const std::vector<report::Timing>& timings) {
  report::Table table;
  table.name = "flythrough-options";
  table.caption = "Options of section 2, and exact casts: one thread, 30 degrees below the horizon";
  table.columns = {{"image", "how it is drawn"},
                   {"time_s", "time of an image (median)"},
                   {"time_to_discrete", "over that of the first row (median of ratios within a round)"}};
  const std::vector<FlythroughWay> all = flythrough_ways();
  for (std::size_t n = 0; n < all.size(); ++n) {
    const report::Timing& timing = timings[cases.by_way[n]];
    table.add({all[n].name, timing.median_s(), report::ratio(timing, timings[cases.by_way.front()])});
  }
  return table;
}

// Returns the sizes of the paper's database, and of a planet file with as many posts.
report::Table database_table(const PatchBuild& build) {
  const double bytes_per_post = static_cast<double>(build.bytes) / static_cast<double>(build.finest_posts);
  report::Table table;
  table.name = "flythrough-database";
  table.caption = "Section 3.3: size of the database";
  table.columns = {
      {"part", "part of the database"},
      {"finest_posts", "voxels of its finest level"},
      {"published_bytes", "with coarser levels, as the paper says"},
      {"here_bytes", "here: as many posts at the bytes a post of this planet file, all levels included"},
      {"here_to_published", "here over published"}};
  for (const report::PublishedDatabase& part : report::kCohenOr1996Database) {
    const double here = part.finest_voxels * bytes_per_post;
    table.add({std::string(part.name), part.finest_voxels, part.bytes, here, here / part.bytes});
  }
  return table;
}

core::RgbImage flythrough_image(core::Renderer& renderer, const core::DrawRequest& request) {
  core::DrawResult drawn = renderer.draw(request);
  return {drawn.frame.width, drawn.frame.height, std::move(drawn.frame.colour)};
}

}  // namespace

int count_steps(const FlythroughPaperPlan& plan) {
  return static_cast<int>(plan.threads.size() * kPitches_deg.size() + voxel_ratios(plan).size() +
                          flythrough_ways().size()) *
         (plan.rounds + 1);
}

FlythroughPaper measure_flythrough_paper(const FlythroughPaperPlan& plan, const std::filesystem::path& folder,
                                         const std::function<void()>& step) {
  PatchScene scene;
  build_patch_scene(folder / "flythrough-terrain.vpe",
                    {.levels = plan.is_short ? 2 : 4, .threads = plan.threads.back()}, scene);
  const FlythroughCases cases = make_flythrough_cases(plan, scene, step);
  const std::vector<report::Timing> timings = report::time_interleaved(cases.all, plan.rounds);

  FlythroughPaper paper;
  const std::string posts = plan.is_short ? "513" : "2049";
  paper.section.heading = "Flythrough by discrete rays (Cohen-Or, Rich, Lerner, Shenkar 1996)";
  paper.section.paragraphs = {
      "Table 1: IBM Power Visualization System, i860 processors of 40 and 45 MHz; one processor hands out columns. Of the three "
      "rows one is known here; the size of the images is not.",
      "Here: fractal terrain of " + posts + " x " + posts + " posts 5 m apart, " +
          std::to_string(plan.is_short ? 320 : 640) + " x " + std::to_string(plan.is_short ? 240 : 480) +
          " pixels, colours by elevation with light, voxels at most a pixel wide. Only shares and ratios compare. Rounds are "
          "interleaved.",
      "Columns are handed out a task at a time, as in the paper; other load of this machine, which is stated above, lowers the growth. "
      "Time falls less than the ratio rises because rows of pixels cost as much as steps over voxels (profile of 2026-11-27)."};
  paper.tables = {rate_table(plan, cases, timings), growth_table(plan, cases, timings),
                  voxel_ratio_table(plan, cases, timings), way_table(cases, timings),
                  database_table(scene.build)};
  const auto renderer = voxel::make_ray_renderer(
      scene.build.planet, {.memory_bytes = plan.memory_bytes, .threads = plan.threads.back()});
  core::DrawRequest request = flythrough_request(plan, scene, kPitches_deg.front());
  const core::RgbImage sharp = flythrough_image(*renderer, request);
  request.settings.ray_blend = true;
  const core::RgbImage blended = flythrough_image(*renderer, request);
  request.settings.ray_blend = false;
  request.settings.ray_vertical = 4;
  const core::RgbImage supersampled = flythrough_image(*renderer, request);
  request.settings.ray_vertical = 1;
  request.settings.ray_mode = core::RayMode::kExact;
  const core::RgbImage exact = flythrough_image(*renderer, request);
  paper.section.images = {
      write_paper_image(folder, "flythrough-discrete.png", "One ray a pixel", sharp),
      write_paper_image(folder, "flythrough-blended.png", "Levels fade into each other", blended),
      write_paper_image(folder, "flythrough-vertical.png", "4 rays a pixel, one above the other", supersampled),
      write_paper_image(folder, "flythrough-exact.png", "Exact casts", exact),
      write_paper_image(folder, "flythrough-difference.png",
                        "Difference of the first and the exact image, eightfold",
                        eightfold_difference(sharp, exact))};
  paper.section.tables = paper.tables;
  return paper;
}

}  // namespace vpe::app
