#include "vpe/report/error_time_page.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

namespace vpe::report {

namespace {

Series& series_of(Plot& plot, const std::string& name) {
  const auto found =
      std::find_if(plot.series.begin(), plot.series.end(), [&](const Series& s) { return s.name == name; });
  if (found != plot.series.end()) return *found;
  plot.series.push_back({name, {}, true});
  return plot.series.back();
}

std::string label(const Configuration& configuration) {
  const char* role = configuration.is_chosen    ? " (default)"
                     : configuration.is_default ? " (default of its backend)"
                                                : "";
  return configuration.knob + role;
}

class Plots {
 public:
  explicit Plots(const SubjectResult& result) : result_(result), front_(fronts(result)) {}

  std::vector<Plot> all() {
    for (std::size_t k = 0; k < result_.measured.size(); ++k) {
      const Configuration& configuration = result_.subject.configurations[k];
      const Measured& measured = result_.measured[k];
      if (!configuration.plot.empty())
        add(k, configuration.plot, configuration.kind, measured.error(configuration.kind));
      if (!configuration.colour_plot.empty() && measured.colour_rms)
        add(k, configuration.colour_plot, ErrorKind::kColour, *measured.colour_rms);
    }
    return std::move(plots_);
  }

 private:
  void add(std::size_t k, const std::string& name, ErrorKind kind, double error) {
    const Configuration& configuration = result_.subject.configurations[k];
    const Measured& measured = result_.measured[k];
    const std::string title = result_.subject.view + ": " + name;
    auto plot = std::find_if(plots_.begin(), plots_.end(), [&](const Plot& p) { return p.title == title; });
    if (plot == plots_.end()) {
      Plot fresh;
      fresh.title = title;
      fresh.x_label = "time, ms";
      fresh.y_label = kind == ErrorKind::kShift ? "shift of 99 % of the pixels, px"
                                                : "colour error (RMS), steps of 8-bit sRGB";
      plots_.push_back(fresh);
      plot = plots_.end() - 1;
    }
    Point point{1e3 * measured.timing.median_s(), error, label(configuration), {}, false};
    point.marked = kind == configuration.kind && std::binary_search(front_.begin(), front_.end(), k);
    if (kind == ErrorKind::kShift) point.bound = measured.stated_px;
    series_of(*plot, configuration.sweep).points.push_back(point);
  }

  const SubjectResult& result_;
  std::vector<std::size_t> front_;
  std::vector<Plot> plots_;
};

}  // namespace

Plot summary_plot(const std::vector<SubjectResult>& results) {
  Plot plot;
  plot.title = "Error against time, medians over " + std::to_string(results.size()) + " views";
  plot.y_label = "shift of 99 % of the pixels, px";
  plot.width_px = 860;
  plot.height_px = 520;
  if (results.empty()) return plot;
  const Subject& first = results.front().subject;
  const Configuration& baseline = first.configurations.at(first.baseline);
  plot.x_label = "time, relative to " + baseline.sweep + ", " + baseline.knob;
  for (const ConfigurationOverViews& w : over_views(results)) {
    if (w.configuration.plot != baseline.plot || w.configuration.kind != ErrorKind::kShift) continue;
    Point point{
        w.ratio, w.error, label(w.configuration), {}, w.configuration.is_default || w.configuration.is_chosen};
    if (std::isfinite(w.stated_px)) point.bound = w.stated_px;
    series_of(plot, w.configuration.sweep).points.push_back(point);
  }
  return plot;
}

Page error_time_page(const ErrorTimeReport& report) {
  Page page{report.title, report.about, {}};
  Section all{
      "All views",
      {"Large points are the defaults. The mark above a point is the largest shift that its certificates "
       "state (median over the views); a dashed line joins the two."},
      {summary_plot(report.results)},
      {defaults_table(report.results), sweeps_table(report.results)}};
  page.sections.push_back(std::move(all));
  for (const SubjectResult& result : report.results) {
    Section section{
        result.subject.view,
        {result.subject.about,
         "Large filled points are on the Pareto front: no configuration that shows the same image is "
         "as fast and has as small an error. Marks above points are stated bounds of the largest "
         "shift."},
        Plots(result).all(),
        {view_table(result)}};
    page.sections.push_back(std::move(section));
  }
  return page;
}

nlohmann::json error_time_json(const ErrorTimeReport& report) {
  return {{"title", report.title},
          {"about", report.about},
          {"points", to_json(points_table(report.results))},
          {"sweeps", to_json(sweeps_table(report.results))},
          {"defaults", to_json(defaults_table(report.results))}};
}

}  // namespace vpe::report
