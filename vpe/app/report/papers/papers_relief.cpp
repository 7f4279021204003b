#include "vpe/app/report/papers/papers_relief.h"

#include <array>
#include <span>

#include "vpe/app/report/papers/relief_hills.h"
#include "vpe/base/number.h"
#include "vpe/report/papers.h"
#include "vpe/report/processor_time.h"

namespace vpe::app {
namespace {

using relief::Interpolation;

struct ReliefWay {
  const char* name;     // of files
  const char* caption;  // of the table
  Interpolation interpolation;
  double tolerance_px;
};

constexpr std::array<ReliefWay, 4> kReliefWays{
    {{"relief-bilinear", "Bilinear heights, exact", Interpolation::kBilinear, 0},
     {"relief-bilinear-half-pixel", "Bilinear heights, tolerance of half a pixel", Interpolation::kBilinear,
      0.5},
     {"relief-bicubic", "Bicubic heights, exact", Interpolation::kBicubic, 0},
     {"relief-bicubic-half-pixel", "Bicubic heights, tolerance of half a pixel", Interpolation::kBicubic,
      0.5}}};

std::span<const ReliefWay> ways_of(const ReliefPaperPlan& plan) {
  return std::span(kReliefWays).first(plan.is_short ? 2 : kReliefWays.size());
}

// Returns what the table says of its first and last row: "1024: 1.035 published, 0.98 here (0.95 to 1.02)".
std::string ratio_text(const report::Table& table) {
  const auto cell = [&](std::size_t column, int decimals) {
    return base::format_fixed(std::get<double>(table.rows.front()[column]), decimals);
  };
  return table.caption + ": " + cell(2, 3) + " published, " + cell(6, 3) + " here (" + cell(7, 3) + " to " +
         cell(8, 3) + ").";
}

struct NamedImage {
  std::string name;  // of its file
  std::string caption;
  int posts = 0;
};

report::PageImage write_figure(const NamedImage& figure, const std::filesystem::path& folder) {
  base::ThreadPool pool(1);
  const core::RgbImage image =
      draw_relief(on_plane(hills_map({.posts = figure.posts})), hills_view(), {}, pool);
  core::write_image(folder / figure.name, image.pixels, image.width, image.height);
  return {figure.caption, core::encode_png(image.pixels, image.width, image.height, 6)};
}

}  // namespace

int count_steps(const ReliefPaperPlan& plan) {
  return static_cast<int>(ways_of(plan).size() * report::vyatkin_2002_times().rows.size()) * (plan.rounds + 1);
}

ReliefPaper measure_relief_paper(const ReliefPaperPlan& plan, const std::filesystem::path& folder,
                                 const std::function<void()>& step) {
  const report::PublishedTimes& published = report::vyatkin_2002_times();
  base::ThreadPool pool(1);
  const core::View view = hills_view();
  std::vector<report::BenchmarkCase> cases;
  for (const ReliefWay& way : ways_of(plan)) {
    for (const report::PublishedTimes::Row& row : published.rows) {
      const relief::Surface surface =
          on_plane(hills_map({.posts = static_cast<int>(row.size), .interpolation = way.interpolation}));
      cases.push_back({[surface, &view, &pool, tolerance_px = way.tolerance_px] {
                         draw_relief(surface, view, {.tolerance_px = tolerance_px}, pool);
                       },
                       [&step](double) { step(); }});
    }
  }
  const std::vector<report::Timing> timings = report::time_interleaved(cases, plan.rounds, report::processor_s);

  ReliefPaper paper;
  paper.section.heading = "Relief by perturbation functions (Vyatkin, Dolgovesov 2002)";
  paper.section.paragraphs = {
      published.paper + ": " + published.machine + ".",
      "Here: the same invented hills on a plane from maps of each resolution, 512 x 512 pixels, cast and shaded: processor "
      "time of one thread. Only ratios compare: the machine and the terrain are others, and this caster ends at a root or at the "
      "tolerance rather than after 21 halvings. Rounds are interleaved; in brackets, and in the columns least and most, are "
      "their extremes.",
      "The largest map against the smallest:"};
  const std::size_t sizes = published.rows.size();
  for (std::size_t n = 0; n < ways_of(plan).size(); ++n) {
    report::Table table = report::compare_times(published, std::span(timings).subspan(n * sizes, sizes));
    table.name = ways_of(plan)[n].name;
    table.caption = ways_of(plan)[n].caption;
    paper.section.paragraphs.push_back(ratio_text(table));
    paper.tables.push_back(std::move(table));
  }
  report::Table& first = paper.tables.front();
  first.columns.push_back({"published_picture", "file that the paper names"});
  first.columns.push_back({"here_picture", "here: file in this folder"});
  std::vector<NamedImage> figures{{"relief-figure-6.png", "Fig. 6: map of 200 x 200, bilinear heights", 200},
                                  {"relief-figure-7.png", "Fig. 7: map of 64 x 64", 64},
                                  {"relief-figure-8.png", "Fig. 8: map of 128 x 128", 128}};
  for (std::size_t n = 0; n < sizes; ++n) {
    const std::string posts = base::format_number(published.rows[n].size);
    const std::string name = "relief-t" + posts + ".png";
    first.rows[n].insert(first.rows[n].end(), {published.rows[n].picture, name});
    figures.push_back(
        {name, "Table: map of " + posts + " x " + posts, static_cast<int>(published.rows[n].size)});
  }
  for (const NamedImage& figure : figures) paper.section.images.push_back(write_figure(figure, folder));
  paper.section.tables = paper.tables;
  return paper;
}

}  // namespace vpe::app
