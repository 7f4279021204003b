#include "vpe/app/report/papers/papers_stereo.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <set>
#include <span>

#include "vpe/app/picture/carried_drawer.h"
#include "vpe/base/number.h"
#include "vpe/core/image/image.h"
#include "vpe/core/stereo.h"
#include "vpe/report/interleaved_timing.h"
#include "vpe/report/papers.h"
#include "vpe/voxel/ray_renderer.h"

namespace vpe::app {

namespace {

struct Look {
  const char* name;     // of files
  const char* caption;  // of the table
  core::Mode mode;
  bool shadows;
  std::span<const report::PublishedPair> published;
};

constexpr std::array<Look, 2> kLooks{
    {{"lit", "Table 1: light, and shadows of the ground", core::Mode::kLit, true, report::kWan2000Lit},
     {"textured", "Table 2: imagery", core::Mode::kTextured, false, report::kWan2000Textured}}};

struct Eyes {
  core::DrawRequest left;
  core::DrawRequest right;
};

Eyes eyes_of(const StereoPaperPlan& plan, const Look& look, double base_m) {
  core::DrawRequest request;
  request.view = plan.view;
  request.sun = plan.sun;
  request.settings.mode = look.mode;
  request.settings.shadows = look.shadows;
  Eyes eyes{request, request};
  eyes.left.view = core::eye_view(plan.view, -0.5 * base_m, std::nullopt);
  eyes.right.view = core::eye_view(plan.view, 0.5 * base_m, std::nullopt);
  return eyes;
}

struct PairTimes {
  double left_s = 0;
  double right_s = 0;
  double full_s = 0;         // of the right eye
  double right_to_left = 0;  // medians of ratios within a round
  double right_to_full = 0;
  double casting_s = 0;  // of the right eye's pixels
};

PairTimes time_pair(CarriedDrawer& pair, core::Renderer& renderer, const Eyes& eyes, int rounds) {
  std::vector<double> casting_s;
  const std::vector<std::function<void()>> cases{[&] { pair.draw_first(eyes.left); },
                                                 [&] {
                                                   pair.draw_carried(eyes.right);
                                                   casting_s.push_back(pair.drawing_s());
                                                 },
                                                 [&] { renderer.draw(eyes.right); }};
  const std::vector<report::Timing> timings = report::time_interleaved(cases, rounds);
  casting_s.erase(casting_s.begin());  // of the untimed round
  return {timings[0].median_s(),
          timings[1].median_s(),
          timings[2].median_s(),
          report::ratio(timings[1], timings[0]),
          report::ratio(timings[1], timings[2]),
          report::median(casting_s)};
}

// Returns the mean distance of two images' colours, as a share of that of black and white.
double mean_difference(const core::Frame& a, const core::Frame& b) {
  double sum = 0;
  for (std::size_t n = 0; n < a.colour.size(); ++n)
    sum += glm::length(glm::dvec3(a.colour[n].r - b.colour[n].r, a.colour[n].g - b.colour[n].g,
                                  a.colour[n].b - b.colour[n].b));
  return sum / (255 * std::sqrt(3.0) * static_cast<double>(std::max<std::size_t>(a.colour.size(), 1)));
}

struct Figure8 {
  double cast_to_carried = 0;
  double difference = 0;
  double unfiltered_difference = 0;
  double incoherent_casting = 0;
};

// Draws the six images of the figure, and writes them.
Figure8 draw_figure(const StereoPaperPlan& plan, const std::shared_ptr<const paging::PlanetFile>& planet,
                    core::Renderer& renderer, const Look& look, const Eyes& eyes,
                    const std::filesystem::path& folder) {
  const auto write = [&](const char* part, const std::vector<base::Rgb>& pixels, const core::Frame& frame) {
    core::write_image(folder / ("stereo-" + std::string(look.name) + "-" + part + ".png"), pixels, frame.width,
                      frame.height);
  };
  CarriedDrawerOptions options{.memory_bytes = plan.memory_bytes / 4, .threads = plan.threads.back()};
  CarriedDrawer pair(renderer, planet, options);
  const core::Frame left = pair.draw_first(eyes.left).frame;
  const core::Frame right = pair.draw_carried(eyes.right).frame;
  const core::Frame full = renderer.draw(eyes.right).frame;
  write("a-left", left.colour, left);
  write("b-right", right.colour, right);
  write("c-cast", with_drawn_pixels_red(pair.carried(), right), right);
  write("d-right-full", full.colour, full);
  write("e-differences", colour_differences(right, full), right);
  Figure8 figure;
  const auto count = [&](warp::Origin origin) { return static_cast<double>(pair.carried().count(origin)); };
  figure.cast_to_carried =
      count(warp::Origin::kOpen) / std::max(count(warp::Origin::kCarried) + count(warp::Origin::kBetween), 1.0);
  figure.difference = mean_difference(right, full);

  options.filters = false;
  CarriedDrawer unfiltered(renderer, planet, options);
  unfiltered.draw_first(eyes.left);
  const core::Frame nearest = unfiltered.draw_carried(eyes.right).frame;
  write("f-differences-unfiltered", colour_differences(nearest, full), right);
  figure.unfiltered_difference = mean_difference(nearest, full);

  options.filters = true;
  options.uses_clear_air = false;
  CarriedDrawer from_the_eye(renderer, planet, options);
  from_the_eye.draw_first(eyes.left);
  std::vector<double> ratios;
  for (int round = 0; round <= plan.rounds; ++round) {
    pair.draw_carried(eyes.right);
    from_the_eye.draw_carried(eyes.right);
    if (round > 0 && pair.drawing_s() > 0) ratios.push_back(from_the_eye.drawing_s() / pair.drawing_s());
  }
  figure.incoherent_casting = report::median(ratios);
  return figure;
}

report::Table time_table(const Look& look) {
  report::Table table;
  table.name = std::string("stereo-") + look.name;
  table.caption = look.caption;
  table.columns = {{"processors", "processors, or threads here"},
                   {"published_left_s", "left image, 500 x 400"},
                   {"published_right_s", "right image, by reprojection"},
                   {"published_right_to_left", "their ratio"},
                   {"left_s", "here: left image, drawn in full (median)"},
                   {"right_s", "here: right image, carried, and the rest drawn (median)"},
                   {"right_full_s", "here: right image, drawn in full (median)"},
                   {"right_to_left", "here: carried right over left (median of ratios within a round)"},
                   {"right_to_full", "here: carried right over right in full"},
                   {"pair_share", "here: a pair with a carried eye over two images"},
                   {"casting_share", "here: share of drawn pixels in the carried right image's time"}};
  return table;
}

void add_times(const Look& look, const std::map<int, PairTimes>& measured, report::Table& table) {
  std::set<int> rows;
  for (const report::PublishedPair& p : look.published) rows.insert(p.processors);
  for (const auto& [threads, times] : measured) rows.insert(threads);
  for (const int n : rows) {
    std::vector<report::Cell> row(table.columns.size());
    row[0] = static_cast<double>(n);
    const auto published = std::ranges::find(look.published, n, &report::PublishedPair::processors);
    if (published != look.published.end()) {
      row[1] = published->left_s;
      row[2] = published->right_s;
      row[3] = published->right_s / published->left_s;
    }
    if (const auto found = measured.find(n); found != measured.end()) {
      const PairTimes& t = found->second;
      row[4] = t.left_s;
      row[5] = t.right_s;
      row[6] = t.full_s;
      row[7] = t.right_to_left;
      row[8] = t.right_to_full;
      row[9] = (t.left_s + t.right_s) / (t.left_s + t.full_s);
      row[10] = t.casting_s / t.right_s;
    }
    table.add(std::move(row));
  }
}

report::Table figure_table(const std::array<Figure8, 2>& figures, const std::array<double, 2>& casting_share) {
  const report::PublishedReprojection& p = report::kWan2000Figure8;
  report::Table table;
  table.name = "stereo-figure-8";
  table.caption = "Fig. 8 and section 4";
  table.columns = {{"quantity", "what is measured"},
                   {"published", "with light"},
                   {"lit", "here, with light and shadows"},
                   {"textured", "here, with imagery"}};
  const auto add = [&](const char* what, double published, double lit, double textured) {
    table.add({std::string(what), published, lit, textured});
  };
  const Figure8& a = figures[0];
  const Figure8& b = figures[1];
  add("cast pixels : carried ground pixels", p.cast_to_carried, a.cast_to_carried, b.cast_to_carried);
  add("mean colour difference from the right image in full", p.difference, a.difference, b.difference);
  add("the same without a filter between pixels", p.unfiltered_difference, a.unfiltered_difference,
      b.unfiltered_difference);
  add("without : with filter", p.unfiltered_difference / p.difference, a.unfiltered_difference / a.difference,
      b.unfiltered_difference / b.difference);
  add("share of casting in the right image's time", p.casting_share, casting_share[0], casting_share[1]);
  add("casting from the eye : from where the air is known to be clear", p.incoherent_casting,
      a.incoherent_casting, b.incoherent_casting);
  return table;
}

// Draws the ranges of the middle for the distance between the eyes.
double base_of(const StereoPaperPlan& plan, core::Renderer& renderer) {
  if (plan.eye_base_m > 0) return plan.eye_base_m;
  core::DrawRequest request;
  request.view = plan.view;
  request.sun = plan.sun;
  request.want_range = true;
  const auto base_m = core::comfortable_base_m(renderer.draw(request).frame.range_m);
  if (!base_m) throw std::runtime_error("the view shows only sky; give another --pose");
  return *base_m;
}

}  // namespace

int count_steps(const StereoPaperPlan& plan) {
  return static_cast<int>(kLooks.size() * (plan.threads.size() + 1));
}

StereoPaper measure_stereo_paper(const StereoPaperPlan& plan,
                                 const std::shared_ptr<const paging::PlanetFile>& planet,
                                 const std::filesystem::path& folder, const std::function<void()>& step) {
  StereoPaper paper;
  std::array<Figure8, 2> figures;
  std::array<double, 2> casting_share{};
  std::array<std::map<int, PairTimes>, 2> times;
  for (const int threads : plan.threads) {
    const auto rays = voxel::make_ray_renderer(planet, {.memory_bytes = plan.memory_bytes, .threads = threads});
    if (paper.eye_base_m == 0) paper.eye_base_m = base_of(plan, *rays);
    CarriedDrawer pair(*rays, planet, {.memory_bytes = plan.memory_bytes / 4, .threads = threads});
    for (std::size_t n = 0; n < kLooks.size(); ++n) {
      step();
      const Eyes eyes = eyes_of(plan, kLooks[n], paper.eye_base_m);
      times[n][threads] = time_pair(pair, *rays, eyes, plan.rounds);
      casting_share[n] = times[n][threads].casting_s / times[n][threads].right_s;
      if (threads != plan.threads.back()) continue;
      step();
      figures[n] = draw_figure(plan, planet, *rays, kLooks[n], eyes, folder);
    }
  }
  for (std::size_t n = 0; n < kLooks.size(); ++n) {
    paper.tables.push_back(time_table(kLooks[n]));
    add_times(kLooks[n], times[n], paper.tables.back());
  }
  paper.tables.push_back(figure_table(figures, casting_share));
  paper.section = {
      "Stereoscopic rendering (Wan, Zhang, Kaufman, Qu 2000)",
      {"Two eyes " + base::format_rounded(paper.eye_base_m, 2) +
           " m apart. The left one is drawn by rays, its pixels are carried to the right one, and what is left is drawn "
           "by rays. Published: SGI Power Challenge, 194 MHz, another terrain and view; only ratios compare.",
       "Where the ratio of the carried right image to the one in full is above 1, drawing both in full is quicker "
       "(--stereo-method full).",
       "Images of Fig. 8, for light (lit) and imagery (textured): stereo-lit-a-left.png, stereo-lit-b-right.png, "
       "stereo-lit-c-cast.png (drawn pixels in red), stereo-lit-d-right-full.png, stereo-lit-e-differences.png, "
       "stereo-lit-f-differences-unfiltered.png; differences of 50 steps and more are white."},
      {},
      paper.tables};
  return paper;
}

}  // namespace vpe::app
