#include "vpe/report/features.h"

#include "vpe/report/interleaved_timing.h"

namespace vpe::report {
namespace {

using CostValue = std::optional<double> SceneCost::*;

struct NamedFigure {
  const char* name;
  CostValue figure;
  double factor;
  const char* meaning;
};

constexpr NamedFigure kFigures[] = {
    {"peak_mb", &SceneCost::peak_mb, 1, "largest memory of the process"},
    {"startup_s", &SceneCost::startup_s, 1, "from starting the process to the first finished image"},
    {"frame_ms", &SceneCost::frame_s, 1e3, "time of an image whose tiles are loaded"},
    {"processor_ms", &SceneCost::processor_s, 1e3, "processor time of all threads for such an image"},
    {"resident_mb", &SceneCost::resident_mb, 1, "payloads of tiles held, as the renderer counts them"}};

Cell scaled_cell(const std::optional<double>& value, double factor = 1) {
  return value ? Cell(*value * factor) : Cell();
}

}  // namespace

SceneCost median_cost(std::span<const SceneCost> rounds) {
  SceneCost out;
  for (const NamedFigure& named : kFigures) {
    std::vector<double> values;
    for (const SceneCost& round : rounds) {
      if (round.*named.figure) values.push_back(*(round.*named.figure));
    }
    if (!values.empty()) out.*named.figure = median(std::move(values));
  }
  return out;
}

Table feature_table(std::span<const FeatureCost> costs) {
  Table table{"features",
              "Cost of each feature: not used (off), used (on), and in a program built without it (never). "
              "Empty: does not apply; the note says why.",
              {{"feature", "feature that a scene can do without"},
               {"backend", "backend that draws"},
               {"compared", "the scene without the feature"}},
              {}};
  for (const NamedFigure& named : kFigures) {
    for (const char* state : {"off", "on", "never"})
      table.columns.push_back(
          {std::string(named.name) + "_" + state, std::string(named.meaning) + ", " + state});
  }
  table.columns.push_back({"frame_ratio", "time of a frame, on to off, in interleaved rounds of one process"});
  table.columns.push_back(
      {"never_ratio", "processor time of an image, off to never, of interleaved processes"});
  table.columns.push_back({"note", ""});
  for (const FeatureCost& cost : costs) {
    std::vector<Cell> row{cost.feature, cost.backend, cost.compared};
    for (const NamedFigure& named : kFigures) {
      for (const SceneCost* state : {&cost.off, &cost.on, &cost.never})
        row.push_back(scaled_cell(state->*named.figure, named.factor));
    }
    row.push_back(scaled_cell(cost.frame_ratio));
    row.push_back(scaled_cell(cost.never_ratio));
    row.emplace_back(cost.note);
    table.add(std::move(row));
  }
  return table;
}

}  // namespace vpe::report
