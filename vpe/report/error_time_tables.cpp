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
  bool in_page;  // of the many figures, those that people look for
  Cell (*of)(const Configuration& configuration, const Measured& measured);
};

const std::vector<Field>& fields() {
  using W = const Configuration&;
  using M = const Measured&;
  static const std::vector<Field> all{
      {{"sweep", "what is varied"}, true, [](W w, M) { return Cell(w.sweep); }},
      {{"knob", "its value"}, true, [](W w, M) { return Cell(w.knob); }},
      {{"default", "drawn when nothing is set; backend: when the backend alone is"},
       true,
       [](W w, M) {
         return w.is_chosen ? Cell(std::string("yes")) : w.is_default ? Cell(std::string("backend")) : Cell();
       }},
      {{"shift_median_px", "shift of drawn pixels against S, median"},
       false,
       [](W w, M m) { return w.has_ranges ? number(m.shift.forward.median_px) : Cell(); }},
      {{"shift_p99_px", "99 % of the drawn pixels are shifted by no more"},
       true,
       [](W w, M m) { return w.has_ranges ? number(m.shift.forward.p99_px) : Cell(); }},
      {{"shift_max_px", "largest shift of a drawn pixel"},
       true,
       [](W w, M m) { return w.has_ranges ? number(m.shift.forward.max_px) : Cell(); }},
      {{"stated_px", "what the certificate states as the largest"},
       true,
       [](W, M m) { return number(m.stated_px); }},
      {{"range_image_px", "what the range image adds by its own rounding"},
       false,
       [](W w, M m) { return w.has_ranges ? number(m.slack_px) : Cell(); }},
      {{"within_stated", "whether the largest is within both"},
       true,
       [](W, M m) { return m.stated_px ? yes(m.within_stated()) : Cell(); }},
      {{"back_median_px", "how far from its place reference ground is found in the picture, median"},
       false,
       [](W w, M m) { return w.has_ranges ? number(m.shift.backward.median_px) : Cell(); }},
      {{"back_p99_px", "99 % of the reference's pixels are found no farther away"},
       true,
       [](W w, M m) { return w.has_ranges ? number(m.shift.backward.p99_px) : Cell(); }},
      {{"back_max_px", "largest of them"},
       false,
       [](W w, M m) { return w.has_ranges ? number(m.shift.backward.max_px) : Cell(); }},
      {{"skyline_p99_px", "rows between both skylines, on 99 % of the columns at most"},
       false,
       [](W w, M m) { return w.has_ranges && m.skyline.count > 0 ? number(m.skyline.p99) : Cell(); }},
      {{"skyline_max_px", "rows between both skylines at most"},
       true,
       [](W w, M m) { return w.has_ranges && m.skyline.count > 0 ? number(m.skyline.max) : Cell(); }},
      {{"holes", "sky where there is ground all around"},
       false,
       [](W w, M m) { return w.has_ranges ? number(m.shift.sky_for_ground) : Cell(); }},
      {{"range_median", "relative range error, median"},
       false,
       [](W w, M m) { return w.has_ranges ? number(m.range.median) : Cell(); }},
      {{"range_p99", "relative range error, 99 %"},
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
      {{"ratio", "time to the baseline's, median over the rounds"},
       true,
       [](W, M m) { return number(m.ratio); }},
      {{"triangles", "drawn, skirts included"},
       true,
       [](W, M m) { return m.triangles > 0 ? number(m.triangles) : Cell(); }},
      {{"rays", "cast"}, true, [](W, M m) { return m.rays > 0 ? number(m.rays) : Cell(); }},
      {{"tiles", "drawn or cast over"}, false, [](W, M m) { return number(m.tiles); }},
      {{"memory_mb", "held by a renderer that drew this alone, MiB"},
       true,
       [](W, M m) { return number(static_cast<double>(m.bytes) / kMegabyte); }},
      {{"pages_reloaded", "pages loaded while it was timed: where it is not 0, times are of loading too"},
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
  if (!page) table.columns.push_back({"view", "where from"});
  for (const Field& field : fields()) {
    if (!page || field.in_page) table.columns.push_back(field.column);
  }
  table.columns.push_back({"front", "no other way that shows the same is as quick and errs as little"});
  return table;
}

}  // namespace

Table points_table(const std::vector<SubjectResult>& results) {
  Table table = empty_points_table("error-time", "Every way of every view", false);
  for (const SubjectResult& result : results) add_rows(table, result, false);
  return table;
}

Table view_table(const SubjectResult& result) {
  Table table =
      empty_points_table("points", "All ways; what a column is shows where its head is pointed at", true);
  add_rows(table, result, true);
  return table;
}

Table sweeps_table(const std::vector<SubjectResult>& results) {
  Table table{"sweeps",
              "Each sweep from coarse to fine: how far its error goes, and whether it falls all the way",
              {{"view", "where from"},
               {"sweep", "what is varied"},
               {"coarsest", "first value"},
               {"finest", "last value"},
               {"points", "how many"},
               {"largest_error", "shift of 99 % of the pixels, px; of colours their RMS"},
               {"smallest_error", "the same"},
               {"decades", "between both; errors of rounding count as 0.001 px or 0.05 steps of colour"},
               {"worst_rise", "largest factor from a point to the next finer one: up to 1 where errors fall"},
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
      "What is drawn when nothing is set, or no more than the backend, against the shortest time at which "
      "any way errs no more",
      {{"view", "where from"},
       {"default", "yes: drawn when nothing is set; backend: when the backend alone is"},
       {"sweep", "what is varied"},
       {"knob", "the default"},
       {"error", "shift of 99 % of the pixels, px; of samples the RMS of colours"},
       {"time_ms", "median of the rounds"},
       {"front_ms", "of the quickest way that errs no more"},
       {"front", "that way"},
       {"over_front", "time to the front's"},
       {"over_own_front", "the same among ways of the same backend"}},
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
