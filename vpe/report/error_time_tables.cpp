#include "vpe/report/error_time_tables.h"

#include <algorithm>

namespace vpe::report {

namespace {

Cell number(double value) { return value; }
Cell number(std::int64_t value) { return static_cast<double>(value); }
Cell number(const std::optional<double>& value) { return value ? Cell(*value) : Cell(); }
Cell yes(bool value) { return value ? Cell(std::string("yes")) : Cell(std::string("no")); }
constexpr double kMegabyte = 1 << 20;

struct Field {
  Column column;
  bool in_page;  // one of the main figures
  Cell (*of)(const Configuration& configuration, const Measured& measured);
};

const std::vector<Field>& fields() {
  using W = const Configuration&;
  using M = const Measured&;
  static const std::vector<Field> all{
      {{"sweep", "the setting that is varied"}, true, [](W w, M) { return Cell(w.sweep); }},
      {{"knob", "its value"}, true, [](W w, M) { return Cell(w.knob); }},
      {{"default", "yes: drawn when nothing is set; backend: drawn when only the backend is set"},
       true,
       [](W w, M) {
         return w.is_chosen ? Cell(std::string("yes")) : w.is_default ? Cell(std::string("backend")) : Cell();
       }},
      {{"shift_median_px", "shift of drawn pixels against the reference surface, median"},
       false,
       [](W w, M m) { return w.has_ranges ? number(m.shift.forward.median_px) : Cell(); }},
      {{"shift_p99_px", "99 % of the drawn pixels are shifted by at most this"},
       true,
       [](W w, M m) { return w.has_ranges ? number(m.shift.forward.p99_px) : Cell(); }},
      {{"shift_max_px", "largest shift of a drawn pixel"},
       true,
       [](W w, M m) { return w.has_ranges ? number(m.shift.forward.max_px) : Cell(); }},
      {{"stated_px", "largest shift that the certificate states"},
       true,
       [](W, M m) { return number(m.stated_px); }},
      {{"range_image_px", "error that the range image adds by its own rounding"},
       false,
       [](W w, M m) { return w.has_ranges ? number(m.slack_px) : Cell(); }},
      {{"within_stated", "whether the largest shift is within stated_px + range_image_px"},
       true,
       [](W, M m) { return m.stated_px ? yes(m.within_stated()) : Cell(); }},
      {{"back_median_px", "distance at which the reference's terrain is found in the image, median"},
       false,
       [](W w, M m) { return w.has_ranges ? number(m.shift.backward.median_px) : Cell(); }},
      {{"back_p99_px", "99 % of the reference's pixels are found within this distance"},
       true,
       [](W w, M m) { return w.has_ranges ? number(m.shift.backward.p99_px) : Cell(); }},
      {{"back_max_px", "largest of these distances"},
       false,
       [](W w, M m) { return w.has_ranges ? number(m.shift.backward.max_px) : Cell(); }},
      {{"skyline_p99_px", "rows between both skylines: at most this on 99 % of the columns"},
       false,
       [](W w, M m) { return w.has_ranges && m.skyline.count > 0 ? number(m.skyline.p99) : Cell(); }},
      {{"skyline_max_px", "rows between both skylines: largest"},
       true,
       [](W w, M m) { return w.has_ranges && m.skyline.count > 0 ? number(m.skyline.max) : Cell(); }},
      {{"holes", "pixels of sky with terrain all around"},
       false,
       [](W w, M m) { return w.has_ranges ? number(m.shift.sky_for_ground) : Cell(); }},
      {{"range_median", "relative range error, median"},
       false,
       [](W w, M m) { return w.has_ranges ? number(m.range.median) : Cell(); }},
      {{"range_p99", "relative range error, 99 % quantile"},
       true,
       [](W w, M m) { return w.has_ranges ? number(m.range.p99) : Cell(); }},
      {{"range_max", "relative range error, largest"},
       false,
       [](W w, M m) { return w.has_ranges ? number(m.range.max) : Cell(); }},
      {{"colour_rms", "root mean square colour error, steps of 8-bit sRGB"},
       true,
       [](W, M m) { return number(m.colour_rms); }},
      {{"ssim", "structural similarity, 1 = equal"}, true, [](W, M m) { return number(m.similarity); }},
      {{"time_ms", "median of the rounds"}, true, [](W, M m) { return number(1e3 * m.timing.median_s()); }},
      {{"time_min_ms", "shortest round"},
       false,
       [](W, M m) {
         return number(1e3 * *std::min_element(m.timing.round_s.begin(), m.timing.round_s.end()));
       }},
      {{"time_max_ms", "longest round"},
       false,
       [](W, M m) {
         return number(1e3 * *std::max_element(m.timing.round_s.begin(), m.timing.round_s.end()));
       }},
      {{"ratio", "time relative to the baseline, median over the rounds"},
       true,
       [](W, M m) { return number(m.ratio); }},
      {{"triangles", "number drawn, skirts included"},
       true,
       [](W, M m) { return m.triangles > 0 ? number(m.triangles) : Cell(); }},
      {{"rays", "number of rays cast"}, true, [](W, M m) { return m.rays > 0 ? number(m.rays) : Cell(); }},
      {{"tiles", "number drawn, or crossed by rays"}, false, [](W, M m) { return number(m.tiles); }},
      {{"memory_mb", "held by a renderer that drew only this, MiB"},
       true,
       [](W, M m) { return number(static_cast<double>(m.bytes) / kMegabyte); }},
      {{"pages_reloaded", "pages loaded while it was timed: if not 0, times include loading"},
       false,
       [](W, M m) { return number(m.pages_reloaded); }},
  };
  return all;
}

void add_rows(Table& table, const SubjectResult& result, bool page) {
  const std::vector<std::size_t> front = fronts(result);
  for (std::size_t k = 0; k < result.measured.size(); ++k) {
    std::vector<Cell> row;
    if (!page) row.emplace_back(result.subject.view);
    for (const Field& field : fields()) {
      if (!page || field.in_page) row.push_back(field.of(result.subject.configurations[k], result.measured[k]));
    }
    row.push_back(std::binary_search(front.begin(), front.end(), k) ? Cell(std::string("yes")) : Cell());
    table.add(std::move(row));
  }
}

Table empty_points_table(const std::string& name, const std::string& caption, bool page) {
  Table table{name, caption, {}, {}};
  if (!page) table.columns.push_back({"view", "name of the view"});
  for (const Field& field : fields()) {
    if (!page || field.in_page) table.columns.push_back(field.column);
  }
  table.columns.push_back(
      {"front",
       "on the Pareto front: no configuration that shows the same image is as fast and has as small an error"});
  return table;
}

}  // namespace

Table points_table(const std::vector<SubjectResult>& results) {
  Table table = empty_points_table("error-time", "Every configuration of every view", false);
  for (const SubjectResult& result : results) add_rows(table, result, false);
  return table;
}

Table view_table(const SubjectResult& result) {
  Table table =
      empty_points_table("points", "All configurations. Point at a column's head for its meaning.", true);
  add_rows(table, result, true);
  return table;
}

Table sweeps_table(const std::vector<SubjectResult>& results) {
  Table table{
      "sweeps",
      "Each sweep from coarse to fine: the range of its error, and whether the error falls at every step",
      {{"view", "name of the view"},
       {"sweep", "the setting that is varied"},
       {"coarsest", "first value"},
       {"finest", "last value"},
       {"points", "number of values"},
       {"largest_error", "shift of 99 % of the pixels, px; for colours the RMS"},
       {"smallest_error", "likewise"},
       {"decades", "between the two; errors of rounding count as 0.001 px or 0.05 steps of colour"},
       {"worst_rise", "largest factor from a point to the next finer one; at most 1 if errors fall"},
       {"within_stated", "no measured shift exceeds what its certificate states"}},
      {}};
  for (const SubjectResult& result : results) {
    for (const SweepSummary& s : summarize_sweeps(result)) {
      table.add({s.view, s.sweep, s.coarsest, s.finest, static_cast<double>(s.points), s.largest_error,
                 s.smallest_error, s.decades, s.worst_rise, yes(s.within_stated)});
    }
  }
  return table;
}

Table defaults_table(const std::vector<SubjectResult>& results) {
  Table table{
      "defaults",
      "The images drawn when nothing is set, or only the backend, compared with the fastest configuration "
      "whose error is no larger",
      {{"view", "name of the view"},
       {"default", "yes: drawn when nothing is set; backend: drawn when only the backend is set"},
       {"sweep", "the setting that is varied"},
       {"knob", "the default value"},
       {"error", "shift of 99 % of the pixels, px; for samples the RMS of colours"},
       {"time_ms", "median of the rounds"},
       {"front_ms", "time of the fastest configuration whose error is no larger"},
       {"front", "that configuration"},
       {"over_front", "time relative to the front"},
       {"over_own_front", "the same among configurations of the same backend"}},
      {}};
  for (const SubjectResult& result : results) {
    for (const DefaultPlace& p : place_defaults(result)) {
      table.add({p.view, std::string(p.is_chosen ? "yes" : "backend"), p.sweep, p.knob, p.error, p.time_ms,
                 p.front_ms, p.front, p.over_front, p.over_own_front});
    }
  }
  return table;
}

}  // namespace vpe::report
