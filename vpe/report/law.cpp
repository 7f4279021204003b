#include "vpe/report/law.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>

namespace vpe::report {
namespace {

Cell cell(const std::optional<double>& value) { return value ? Cell(*value) : Cell(); }
Cell cell(const std::optional<bool>& value) {
  return value ? Cell(std::string(*value ? "yes" : "no")) : Cell();
}

bool is_good(double value) { return value > 0 && std::isfinite(value); }

bool has_two_x(const Law& law) {
  return std::any_of(law.samples.begin(), law.samples.end(),
                     [&](const LawSample& s) { return s.x != law.samples.front().x; });
}

Growth fit_medians(const Law& law) {
  std::vector<double> x;
  std::vector<double> y;
  for (const LawSample& sample : law.samples) {
    x.push_back(sample.x);
    y.push_back(median(sample.y));
  }
  return fit_growth(x, y);
}

Growth fit_rounds(const Law& law) {
  const LawSample& a = law.samples[0];
  const LawSample& b = law.samples[1];
  const Growth medians = fit_medians(law);
  if (a.y.size() != b.y.size() || a.y.size() < 2) return medians;
  std::vector<double> x;
  std::vector<double> y;
  for (std::size_t round = 0; round < a.y.size(); ++round) {
    const double mean = std::sqrt(a.y[round] * b.y[round]);
    x.insert(x.end(), {a.x, b.x});
    y.insert(y.end(), {a.y[round] / mean, b.y[round] / mean});
  }
  Growth growth = fit_growth(x, y);
  growth.factor = medians.factor;
  growth.points = 2;
  return growth;
}

}  // namespace

std::vector<LawSample> timed_samples(std::span<const double> x, std::span<const Timing> timings) {
  if (x.size() != timings.size()) throw std::invalid_argument("timed_samples: a timing for each x is needed");
  std::vector<LawSample> samples;
  for (std::size_t k = 0; k < x.size(); ++k) samples.push_back({x[k], timings[k].round_s});
  return samples;
}

std::optional<LawFit> fit(const Law& law) {
  if (law.samples.size() < 2 || !has_two_x(law)) return std::nullopt;
  for (const LawSample& sample : law.samples) {
    if (!is_good(sample.x) || sample.y.empty() || !std::all_of(sample.y.begin(), sample.y.end(), is_good))
      return std::nullopt;
  }
  LawFit out;
  out.of_rounds = law.samples.size() == 2;
  out.growth = out.of_rounds ? fit_rounds(law) : fit_medians(law);
  if (!law.least_exponent && !law.most_exponent) return out;
  const double least = law.least_exponent.value_or(-HUGE_VAL);
  const double most = law.most_exponent.value_or(HUGE_VAL);
  const double low = out.growth.exponent - out.growth.half_width;
  const double high = out.growth.exponent + out.growth.half_width;
  out.holds = least <= out.growth.exponent && out.growth.exponent <= most;
  out.surely = (least <= low && high <= most) || high < least || low > most;
  return out;
}

Table law_table(std::span<const Law> laws) {
  Table table{"scaling-laws",
              "Fitted exponents p of y = c x^p. half_width: half the interval that contains p with 95 %.",
              {{"axis", "size that is varied"},
               {"what", "case that is measured"},
               {"x", "varied size, with its unit"},
               {"y", "measured value, with its unit"},
               {"exponent", "fitted exponent"},
               {"half_width", "half the 95 % interval; for two x from the scatter of the rounds alone"},
               {"factor", "y at x = 1"},
               {"points", "number of different x"},
               {"least", "least exponent aimed at"},
               {"most", "largest exponent aimed at"},
               {"holds", "the exponent meets the aim"},
               {"surely", "the whole interval meets the aim, or the whole interval misses it"}},
              {}};
  for (const Law& law : laws) {
    std::vector<Cell> row{law.axis, law.what, law.x_name, law.y_name};
    const std::optional<LawFit> fitted = fit(law);
    if (fitted) {
      const Growth& growth = fitted->growth;
      row.insert(row.end(),
                 {growth.exponent, growth.half_width, growth.factor, static_cast<double>(growth.points)});
    } else {
      row.insert(row.end(), {Cell(), Cell(), Cell(), static_cast<double>(law.samples.size())});
    }
    row.insert(row.end(), {cell(law.least_exponent), cell(law.most_exponent)});
    row.push_back(fitted ? cell(fitted->holds) : Cell());
    row.push_back(fitted ? cell(fitted->surely) : Cell());
    table.add(std::move(row));
  }
  return table;
}

Table sample_table(std::span<const Law> laws) {
  Table table{"scaling-samples",
              "All measurements: median, least and most over the interleaved rounds.",
              {{"axis", "size that is varied"},
               {"what", "case that is measured"},
               {"x_name", "varied size, with its unit"},
               {"x", "value of that size"},
               {"y_name", "measured value, with its unit"},
               {"median", "over the rounds"},
               {"least", "over the rounds"},
               {"most", "over the rounds"},
               {"rounds", "number of rounds"}},
              {}};
  for (const Law& law : laws) {
    for (const LawSample& sample : law.samples) {
      const auto [least, most] = std::minmax_element(sample.y.begin(), sample.y.end());
      const bool any = !sample.y.empty();
      table.add({law.axis, law.what, law.x_name, sample.x, law.y_name, median(sample.y),
                 any ? Cell(*least) : Cell(), any ? Cell(*most) : Cell(),
                 static_cast<double>(sample.y.size())});
    }
  }
  return table;
}

Plot law_plot(std::span<const Law> laws, const std::string& axis, const std::string& y_name) {
  Plot plot;
  plot.y_label = y_name;
  for (const Law& law : laws) {
    if (law.axis != axis || law.y_name != y_name) continue;
    plot.title = y_name + " over " + law.x_name;
    plot.x_label = law.x_name;
    Series series;
    const std::optional<LawFit> fitted = fit(law);
    series.name = law.what + (fitted ? ": " + exponent_text(fitted->growth) : "");
    for (const LawSample& sample : law.samples)
      series.points.push_back({sample.x, median(sample.y), "", {}, false});
    plot.series.push_back(std::move(series));
  }
  return plot;
}

std::vector<std::pair<std::string, std::string>> law_plots(std::span<const Law> laws) {
  std::vector<std::pair<std::string, std::string>> plots;
  for (const Law& law : laws) {
    const std::pair<std::string, std::string> plot{law.axis, law.y_name};
    if (std::find(plots.begin(), plots.end(), plot) == plots.end()) plots.push_back(plot);
  }
  return plots;
}

std::string exponent_text(const Growth& growth) {
  char text[64];
  if (std::isfinite(growth.half_width)) {
    std::snprintf(text, sizeof text, "%.3f +- %.3f", growth.exponent, growth.half_width);
  } else {
    std::snprintf(text, sizeof text, "%.3f", growth.exponent);
  }
  return text;
}

}  // namespace vpe::report
