// Compares thin lines (vpe/overlay/stroke_mask.h) with Cairo's strokes, which drew them formerly: time, and colours of pixels.
//
//   stroke_bench [ROUNDS]
//   stroke_bench count canvas|cairo     # draws winding lines of 1.5 px alone: valgrind --tool=callgrind --toggle-collect=*Canvas::line(*
//
// One thread. A round draws 400 lines on an image of 1280x720 both ways, in turns. Likeness is of lines that are alone on an image:
// differences of opacity, 0 to 255, at pixels that either touches. docs/measurements/rendering.md has the figures.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <exception>
#include <random>
#include <vector>

#include "tests/bench/drawing/compare_ways.h"
#include "tests/bench/drawing/former_lines.h"
#include "vpe/base/number.h"
#include "vpe/overlay/canvas.h"

namespace {

using Line = std::vector<glm::dvec2>;
using vpe::overlay::Canvas;

struct Kind {
  const char* name;
  double step_px;
  double bend_rad;  // of a step, at most
  int steps;
};

constexpr Kind kKinds[] = {{"straight", 100, 0, 1}, {"winding", 4, 0.2, 25}, {"scribbles", 0.4, 0.9, 250}};
constexpr glm::ivec2 kSize(1280, 720);
constexpr double kWidths_px[] = {0.5, 1, 1.5, 3, 6};

// Returns a line that begins within `spread` of the middle.
Line line_of(const Kind& kind, glm::dvec2 middle, glm::dvec2 spread, std::mt19937& random) {
  std::uniform_real_distribution<double> any(-1, 1);
  Line line{middle + spread * glm::dvec2(any(random), any(random))};
  double angle = 4 * any(random);
  const double turn = 0.2 * kind.bend_rad * any(random);
  for (int n = 0; n < kind.steps; ++n) {
    angle += turn + kind.bend_rad * any(random);
    line.push_back(line.back() + kind.step_px * glm::dvec2(std::cos(angle), std::sin(angle)));
  }
  return line;
}

std::vector<Line> many_lines(const Kind& kind) {
  std::mt19937 random(7);
  std::vector<Line> lines;
  for (int n = 0; n < 400; ++n) lines.push_back(line_of(kind, {640, 360}, {560, 280}, random));
  return lines;
}

void draw_by_canvas(std::span<const Line> lines, double width_px, glm::ivec2 size, vpe::overlay::Layer* out) {
  Canvas canvas(size.x, size.y);
  for (const Line& line : lines) canvas.line(line, false, width_px, {1, 1, 1, 1});
  if (out != nullptr) *out = canvas.layer();
}

struct Likeness {
  int most = 0;
  double least_rms = 1e9, most_rms = 0;  // of single lines
  double mean = 0;                       // canvas less Cairo
};

Likeness likeness(const Kind& kind, double width_px) {
  constexpr int kSide_px = 256, kLines = 60;
  std::mt19937 random(11);
  Likeness out;
  for (int n = 0; n < kLines; ++n) {
    const Line line = line_of(kind, {128, 128}, {20, 20}, random);
    vpe::overlay::Layer now, cairo;
    draw_by_canvas({&line, 1}, width_px, {kSide_px, kSide_px}, &now);
    bench::draw_by_cairo({&line, 1}, width_px, {kSide_px, kSide_px}, &cairo);
    double squares = 0, sum = 0, touched = 0;
    for (std::size_t k = 0; k < now.pixels.size(); ++k) {
      const int off = now.pixels[k].a - cairo.pixels[k].a;
      if (off == 0 && cairo.pixels[k].a == 0) continue;
      out.most = std::max(out.most, std::abs(off));
      squares += off * off;
      sum += off;
      ++touched;
    }
    const double rms = std::sqrt(squares / touched);
    out.least_rms = std::min(out.least_rms, rms);
    out.most_rms = std::max(out.most_rms, rms);
    out.mean += sum / touched / kLines;
  }
  return out;
}

void run(int rounds) {
  std::printf("%d rounds in turns\n\n", rounds);
  std::puts(
      "| lines | Cairo, ms | now, ms | now / Cairo | opacity: most off | RMS of single lines | mean, now - Cairo "
      "|\n|---|---|---|---|---|---|---|");
  for (const Kind& kind : kKinds) {
    const std::vector<Line> lines = many_lines(kind);
    for (const double width_px : kWidths_px) {
      const bench::WayTimes times =
          bench::compare_ways([&] { bench::draw_by_cairo(lines, width_px, kSize, nullptr); },
                              [&] { draw_by_canvas(lines, width_px, kSize, nullptr); }, rounds);
      const Likeness like = likeness(kind, width_px);
      std::printf("| %s, %g px | %.2f | %.2f | %.2f (%.2f..%.2f) | %d | %.1f to %.1f | %+.1f |\n", kind.name,
                  width_px, times.former_ms, times.now_ms, times.ratio, times.least, times.most, like.most,
                  like.least_rms, like.most_rms, like.mean);
      std::fflush(stdout);
    }
  }
}

}  // namespace

int main(int argc, char** argv) try {
  const bool counts = argc == 3 && std::strcmp(argv[1], "count") == 0;
  const bool by_canvas = counts && std::strcmp(argv[2], "canvas") == 0;
  const bool by_cairo = counts && std::strcmp(argv[2], "cairo") == 0;
  const auto rounds = argc == 2 ? vpe::base::parse_integer(argv[1]) : 9;
  if (argc > 3 || (argc == 3 && !by_canvas && !by_cairo) || !rounds || *rounds < 1 || *rounds > 10'000) {
    std::fputs("usage: stroke_bench [ROUNDS]\n       stroke_bench count canvas|cairo\n", stderr);
    return 2;
  }
  if (by_canvas) draw_by_canvas(many_lines(kKinds[1]), 1.5, kSize, nullptr);
  if (by_cairo) bench::draw_by_cairo(many_lines(kKinds[1]), 1.5, kSize, nullptr);
  if (!counts) run(static_cast<int>(*rounds));
  return 0;
} catch (const std::exception& e) {
  std::fprintf(stderr, "stroke_bench: %s\n", e.what());
  return 1;
}
