// Draws how the frame-time controller answers a step of the load: docs/images/frame-budget.svg.
//
//   frame_budget_plot > docs/images/frame-budget.svg
//
// Also prints, to stderr, the frames that steps take to settle, and at which ratio of true to estimated slope
// the loop begins to oscillate when the estimate is held: the gain margin by simulation.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include "lod/frame_budget.h"

namespace {

constexpr double kBudget_ms = 16;
constexpr int kFrames = 90;
constexpr int kUp = 15;
constexpr int kDown = 55;
constexpr double kSlopes[] = {0.5, 1, 2, 4};
constexpr const char* kColours[] = {"#1b6ca8", "#2a9d4a", "#c77700", "#b3261e"};

std::vector<double> answer(double slope, int delay) {
  lod::FrameBudgetOptions options;
  options.budget_ms = kBudget_ms;
  options.max_multiplier = 1e4;
  lod::FrameBudgetState state;
  std::vector<double> multiplier;
  std::vector<double> ms;
  for (int t = 0; t < kFrames; ++t) {
    double m = 1;
    if (t >= delay) {
      const auto seen = static_cast<std::size_t>(t - delay);
      m = lod::next_multiplier(options, {multiplier[seen], ms[seen]}, state);
    }
    multiplier.push_back(m);
    ms.push_back((t < kUp || t >= kDown ? 20 : 200) * std::pow(m, -slope));
  }
  return ms;
}

int frames_to_settle(const std::vector<double>& ms, int from, int to) {
  int last = from;
  for (int t = from; t < to; ++t) {
    if (std::abs(ms[static_cast<std::size_t>(t)] / kBudget_ms - 1) > 0.15) last = t + 1;
  }
  return last - from;
}

// Whether a load that grows by a quarter is brought back, from a line that is right at the budget and a slope
// estimate that is held at 1.
bool comes_back(double slope, int delay) {
  lod::FrameBudgetOptions options;
  options.budget_ms = kBudget_ms;
  options.max_multiplier = 1e9;
  options.first_slope = options.min_slope = options.max_slope = 1;
  lod::FrameBudgetState state;
  state.started = true;
  state.slope = 1;
  state.multiplier = 100;
  state.log_load = state.anchor = std::log(100);
  std::vector<double> multiplier;
  std::vector<double> ms;
  double late = 0;
  for (int t = 0; t < 2000; ++t) {
    double m = 100;
    if (t >= delay) {
      const auto seen = static_cast<std::size_t>(t - delay);
      m = lod::next_multiplier(options, {multiplier[seen], ms[seen]}, state);
    }
    multiplier.push_back(m);
    ms.push_back(1.25 * kBudget_ms * std::pow(m / 100, -slope));
    if (t >= 1900) late = std::max(late, std::abs(std::log(ms.back() / kBudget_ms)));
  }
  return late <= 0.16;
}

double x_of(int frame) { return 50 + 8.0 * frame; }
double y_of(double ms, double top) { return top + 130 - 55 * (std::log10(std::clamp(ms, 1.0, 250.0))); }

void panel(int delay, double top) {
  std::printf("<text x=\"50\" y=\"%g\">a frame's time is known %d frame%s later</text>\n", top - 4, delay,
              delay == 1 ? "" : "s");
  for (const double ms : {1.0, 10.0, 100.0}) {
    std::printf(
        "<line x1=\"50\" x2=\"770\" y1=\"%g\" y2=\"%g\" stroke=\"#ddd\"/><text x=\"44\" y=\"%g\" "
        "text-anchor=\"end\">%g</text>\n",
        y_of(ms, top), y_of(ms, top), y_of(ms, top) + 4, ms);
  }
  std::printf("<rect x=\"50\" width=\"720\" y=\"%g\" height=\"%g\" fill=\"#e8f0e8\"/>\n",
              y_of(1.15 * kBudget_ms, top), y_of(0.85 * kBudget_ms, top) - y_of(1.15 * kBudget_ms, top));
  for (int k = 0; k < 4; ++k) {
    std::printf("<polyline fill=\"none\" stroke=\"%s\" stroke-width=\"1.5\" points=\"", kColours[k]);
    const std::vector<double> ms = answer(kSlopes[k], delay);
    for (int t = 0; t < kFrames; ++t)
      std::printf("%g,%.1f ", x_of(t), y_of(ms[static_cast<std::size_t>(t)], top));
    std::printf("\"/>\n");
    std::fprintf(stderr, "delay %d slope %g: %d frames up, %d down\n", delay, kSlopes[k],
                 frames_to_settle(ms, kUp, kDown), frames_to_settle(ms, kDown, kFrames));
  }
}

}  // namespace

int main() {
  std::printf(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"800\" height=\"560\" font-family=\"sans-serif\" "
      "font-size=\"12\">\n<rect width=\"800\" height=\"560\" fill=\"#fff\"/>\n");
  std::printf(
      "<text x=\"50\" y=\"20\">Frame time, ms: the load rises ten times at frame %d and falls at frame %d; "
      "band: budget of 16 ms, 15 %%</text>\n",
      kUp, kDown);
  for (int k = 0; k < 4; ++k) {
    std::printf("<text x=\"%d\" y=\"38\" fill=\"%s\">time ~ tolerance^-%g</text>\n", 50 + 150 * k, kColours[k],
                kSlopes[k]);
  }
  for (int delay = 1; delay <= 3; ++delay) panel(delay, 70 + 165 * (delay - 1));
  for (int frame = 0; frame <= kFrames; frame += 10) {
    std::printf("<text x=\"%g\" y=\"545\" text-anchor=\"middle\">%d</text>\n", x_of(frame), frame);
  }
  std::printf("</svg>\n");
  for (int delay = 1; delay <= 3; ++delay) {
    double ratio = 1.5;
    while (ratio < 20 && comes_back(ratio, delay)) ratio += 0.01;
    std::fprintf(stderr, "delay %d: oscillates from a true slope of %.2f times the estimate on\n", delay,
                 ratio);
  }
  return 0;
}
