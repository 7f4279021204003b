#include "vpe/app/report/papers/papers_terrain.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <memory>
#include <set>
#include <string>

#include "vpe/app/report/papers/paper_images.h"
#include "vpe/app/report/papers/volume_image.h"
#include "vpe/base/number.h"
#include "vpe/report/interleaved_timing.h"
#include "vpe/report/papers.h"

namespace vpe::app {

namespace {

constexpr int kTerrainSide = 512;
constexpr double kDegree = 3.14159265358979323846 / 180;

// Looks north over the terrain from near its southern border.
core::View terrain_view(double roll_deg) {
  const double pitch = -30 * kDegree;
  const double roll = roll_deg * kDegree;
  const glm::dvec3 forward{0, std::cos(pitch), std::sin(pitch)};
  const glm::dvec3 right{1, 0, 0};
  const glm::dvec3 up = glm::cross(right, forward);
  core::View view;
  view.camera.position_m = {256, 20, 130};
  view.camera.axes = {std::cos(roll) * right - std::sin(roll) * up,
                      std::sin(roll) * right + std::cos(roll) * up, forward};
  view.width = 500;
  view.height = 400;
  view.fov_deg = 45;
  return view;
}

std::vector<double> rolls_of(const TerrainPaperPlan& plan) {
  std::vector<double> rolls;
  const int last = plan.is_short ? 2 : 9;
  for (int n = 0; n <= last; ++n) rolls.push_back(45.0 * n / last);
  return rolls;
}

// What is timed: the paper's two ways by threads, then other ways on one thread.
struct Cases {
  std::vector<report::BenchmarkCase> all;
  std::vector<std::size_t> accurate;  // by thread count of the plan
  std::vector<std::size_t> approximate;
  std::size_t checked = 0;
  std::size_t conventional = 0;        // every sample interpolated
  std::size_t conventional_cells = 0;  // with boundary cells
  std::vector<std::size_t> rolled;     // by roll
};

using voxel::VolumeCastOptions;
using voxel::VolumeStart;

constexpr VolumeCastOptions kAccurate{.start = VolumeStart::kPaper, .refines = false};
constexpr VolumeCastOptions kApproximate{.is_approximate = true, .start = VolumeStart::kPaper};

Cases make_cases(const TerrainPaperPlan& plan, const PhotographedVolume& scene,
                 const std::function<void()>& step) {
  Cases cases;
  const auto add = [&](const core::View& view, const VolumeCastOptions& options, int threads) {
    const auto pool = std::make_shared<base::ThreadPool>(threads);
    cases.all.push_back({[&scene, view, options, pool] { draw_volume(scene, view, options, *pool); },
                         [&step](double) { step(); }});
    return cases.all.size() - 1;
  };
  const core::View view = terrain_view(0);
  for (const int threads : plan.threads) {
    cases.accurate.push_back(add(view, kAccurate, threads));
    cases.approximate.push_back(add(view, kApproximate, threads));
  }
  cases.checked = add(view, {.refines = false}, 1);
  cases.conventional = add(view, {.start = VolumeStart::kCamera, .uses_cells = false, .refines = false}, 1);
  cases.conventional_cells = add(view, {.start = VolumeStart::kCamera, .refines = false}, 1);
  for (const double roll : rolls_of(plan)) cases.rolled.push_back(add(terrain_view(roll), kAccurate, 1));
  return cases;
}

report::Table time_table_of(const TerrainPaperPlan& plan, const Cases& cases,
                            const std::vector<report::Timing>& timings) {
  report::Table table;
  table.name = "terrain-table-1";
  table.caption = "Table 1: terrain rendering";
  table.columns = {{"processors", "processors, or threads here"},
                   {"published_accurate_s", "accurate terrain rendering"},
                   {"published_approximate_s", "approximate terrain rendering"},
                   {"published_approximate_to_accurate", "their ratio"},
                   {"published_accurate_to_one", "accurate, over that of one processor"},
                   {"accurate_s", "here: accurate (median)"},
                   {"approximate_s", "here: approximate (median)"},
                   {"approximate_to_accurate", "here: their ratio (median of ratios within a round)"},
                   {"accurate_to_one", "here: accurate, over that of one thread"},
                   {"ratio_of_ratios", "approximate to accurate, here over published"}};
  std::set<int> rows(plan.threads.begin(), plan.threads.end());
  for (const report::PublishedTerrain& p : report::kWan1999Terrain) rows.insert(p.processors);
  for (const int n : rows) {
    std::vector<report::Cell> row(table.columns.size());
    row[0] = static_cast<double>(n);
    const auto published = std::ranges::find(report::kWan1999Terrain, n, &report::PublishedTerrain::processors);
    const bool is_published = published != report::kWan1999Terrain.end();
    if (is_published) {
      row[1] = published->accurate_s;
      row[2] = published->approximate_s;
      row[3] = published->approximate_s / published->accurate_s;
      row[4] = published->accurate_s / report::kWan1999Terrain.front().accurate_s;
    }
    const auto here = std::ranges::find(plan.threads, n);
    if (here != plan.threads.end()) {
      const auto at = static_cast<std::size_t>(here - plan.threads.begin());
      const report::Timing& accurate = timings[cases.accurate[at]];
      const report::Timing& approximate = timings[cases.approximate[at]];
      const double share = report::ratio(approximate, accurate);
      row[5] = accurate.median_s();
      row[6] = approximate.median_s();
      row[7] = share;
      row[8] = report::ratio(accurate, timings[cases.accurate.front()]);
      if (is_published) row[9] = share * published->accurate_s / published->approximate_s;
    }
    table.add(std::move(row));
  }
  return table;
}

// Returns the share of pixels whose hits differ from those of rays that begin at the camera.
double share_of_other_hits(const PhotographedVolume& scene, base::ThreadPool& pool) {
  const core::View view = terrain_view(0);
  const auto cast = [&](VolumeStart start) {
    return voxel::cast_volume(scene.volume, scene.cells, view, {.start = start, .refines = false}, pool).range;
  };
  const std::vector<float> paper = cast(VolumeStart::kPaper);
  const std::vector<float> exact = cast(VolumeStart::kCamera);
  std::size_t others = 0;
  for (std::size_t n = 0; n < paper.size(); ++n) others += paper[n] != exact[n] ? 1 : 0;
  return static_cast<double>(others) / static_cast<double>(paper.size());
}

report::Table ratio_table(const TerrainPaperPlan& plan, const PhotographedVolume& scene, const Cases& cases,
                          const std::vector<report::Timing>& timings) {
  const report::PublishedTerrain& one = report::kWan1999Terrain.front();
  const report::PublishedTerrainTimes& p = report::kWan1999Times;
  report::Table table;
  table.name = "terrain-section-7";
  table.caption = "Section 7, one processor";
  table.columns = {{"quantity", "what is measured"},
                   {"published", "in the paper"},
                   {"here", "here"},
                   {"ratio_of_ratios", "here over published"}};
  const auto add = [&](const char* what, std::optional<double> published, double here) {
    std::vector<report::Cell> row(4);
    row[0] = std::string(what);
    if (published) row[1] = *published;
    row[2] = here;
    if (published) row[3] = here / *published;
    table.add(std::move(row));
  };
  const report::Timing& accurate = timings[cases.accurate.front()];
  const auto to_accurate = [&](std::size_t n) { return report::ratio(timings[n], accurate); };
  add("conventional : accurate, every sample interpolated", p.conventional_s / one.accurate_s,
      to_accurate(cases.conventional));
  add("conventional : accurate, with boundary cells", p.conventional_s / one.accurate_s,
      to_accurate(cases.conventional_cells));
  add("approximate : accurate", one.approximate_s / one.accurate_s, to_accurate(cases.approximate.front()));
  double sum = 0;
  for (const std::size_t n : cases.rolled) sum += report::ratio(timings[n], timings[cases.rolled.front()]);
  add("roll of 45 degrees : none", p.roll_45_s / one.accurate_s,
      report::ratio(timings[cases.rolled.back()], timings[cases.rolled.front()]));
  add("mean of rolls from 0 to 45 degrees : none", p.roll_mean_s / one.accurate_s,
      sum / static_cast<double>(cases.rolled.size()));
  add("boundary array : volume, bytes", std::nullopt,
      static_cast<double>(scene.cells.bytes()) / static_cast<double>(scene.volume.bytes()));
  add("start that is checked by blocks : start of the paper", std::nullopt, to_accurate(cases.checked));
  base::ThreadPool pool(plan.threads.back());
  add("share of pixels with other hits than rays from the camera", std::nullopt,
      share_of_other_hits(scene, pool));
  return table;
}

}  // namespace

int count_steps(const TerrainPaperPlan& plan) {
  return static_cast<int>(2 * plan.threads.size() + 3 + rolls_of(plan).size()) * (plan.rounds + 1);
}

TerrainPaper measure_terrain_paper(const TerrainPaperPlan& plan, const std::filesystem::path& folder,
                                   const std::function<void()>& step) {
  const PhotographedVolume scene = hills_volume(kTerrainSide, voxel::VolumeFilter::kGaussian);
  const Cases cases = make_cases(plan, scene, step);
  const std::vector<report::Timing> timings = report::time_interleaved(cases.all, plan.rounds);

  TerrainPaper paper;
  paper.section.heading = "Terrain as a volume (Wan, Qu, Kaufman 1999)";
  paper.section.paragraphs = {
      "Table 1 and section 7: SGI Power Challenge, R10000 processors of 194 MHz; 500 x 400 pixels, pitch -30 degrees, "
      "samples 0.6 voxels apart, terrain of 512 x 512 x 64 voxels with a photograph.",
      "Here: invented terrain of the same size under a Gaussian filter, the same pitch, pixels and interval; hits are samples, as in "
      "the paper. Only ratios compare. Conventional casting begins at the camera; the paper does not say whether it asks the "
      "boundary cells, so both are here. Rounds are interleaved."};
  paper.tables = {time_table_of(plan, cases, timings), ratio_table(plan, scene, cases, timings)};
  base::ThreadPool pool(plan.threads.back());
  const core::RgbImage accurate = draw_volume(scene, terrain_view(0), kAccurate, pool).colours;
  const core::RgbImage approximate = draw_volume(scene, terrain_view(0), kApproximate, pool).colours;
  paper.section.images = {write_paper_image(folder, "terrain-figure-6.png", "Fig. 6: accurate", accurate),
                          write_paper_image(folder, "terrain-figure-7.png",
                                            "Fig. 7: approximate, boundary cells alone", approximate),
                          write_paper_image(folder, "terrain-difference.png", "Difference of both, eightfold",
                                            eightfold_difference(accurate, approximate)),
                          write_paper_image(folder, "terrain-roll.png", "A roll of 30 degrees",
                                            draw_volume(scene, terrain_view(30), kAccurate, pool).colours)};
  paper.section.tables = paper.tables;
  return paper;
}

}  // namespace vpe::app
