// Measures error against run time: images of one view in many configurations, each compared with a reference
// and timed in interleaved rounds.
//
// A configuration is one point of a sweep over a quality setting. Renderers are made by name, so that tests can
// count the frames of fake ones.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "vpe/core/frame.h"
#include "vpe/core/image_metrics.h"
#include "vpe/core/metrics.h"
#include "vpe/report/interleaved_timing.h"

namespace vpe::report {

// The error that a sweep reduces.
enum class ErrorKind : std::uint8_t {
  kShift,   // of pixels: the larger of the 99 % quantiles forward and backward, px
  kColour,  // root mean square, steps of 8-bit sRGB
};

// Draws the next of several requests, in their order.
using NextFrame = std::function<core::Frame()>;
// Joins the frames of `count` requests to one image of the reference's size. Must ask for each of them. A frame is drawn when
// it is asked for, so that images of any size can be joined piece by piece.
using Compose = std::function<core::Frame(std::size_t count, const NextFrame& next)>;

struct Configuration {
  std::string sweep;        // such as "triangles by tolerance"
  std::string knob;         // the setting's value, such as "lod.tolerance=2"
  bool is_default = false;  // drawn when only the backend is named
  bool is_chosen = false;   // drawn when nothing is named
  ErrorKind kind = ErrorKind::kShift;
  // Configurations of one group show the same image and may stand on one Pareto front; empty: on no front.
  std::string comparison_group;
  std::string plot;                         // of the view, by its kind of error, that shows it; empty: none
  std::string colour_plot;                  // the same by its colour error
  std::string renderer;                     // name for MakeRenderer
  std::vector<core::DrawRequest> requests;  // drawn one after another; their total time is measured
  Compose compose;                          // empty: the image of the only request
  std::size_t reference = 0;                // index in Subject::references
  // Relative error of the renderer's range images at the nearest ground; at the farthest it is
  // 1 + farthest / nearest times as large (vpe/gl/polygon_renderer.h). 0: included in what it states.
  double range_error = 0;
  int most_rounds = std::numeric_limits<int>::max();  // of timing, for slow ones (BenchmarkCase)
  bool has_colours = true;                            // false: only ranges are drawn
  bool has_ranges = true;                             // false: only colours are compared
};

// An image that counts as exact.
struct Reference {
  core::View view;
  std::string renderer;
  std::vector<core::DrawRequest> requests;
  Compose compose;
  bool has_ranges = true;
};

// One view with everything that is drawn of it.
struct Subject {
  std::string view;   // its name
  std::string about;  // its place, for people
  std::vector<Reference> references;
  std::vector<Configuration> configurations;
  std::size_t baseline = 0;  // the configuration that times are ratios to
};

// Makes a renderer that may use this share of the memory for data. One thread uses the renderers; several may
// exist at once.
using MakeRenderer = std::function<std::unique_ptr<core::Renderer>(const std::string& name, double share)>;

// The measurements of one configuration.
struct Measured {
  core::ImageErrors shift;  // without pixels where only colours are compared
  core::Spread skyline;
  core::Spread range;
  std::optional<double> colour_rms;
  std::optional<double> similarity;
  // The largest forward shift that the certificate states; nullopt where that is not finite, and for composed
  // images.
  std::optional<double> stated_px;
  double slack_px = 0;  // error of the range image itself, in addition to what is stated
  std::int64_t triangles = 0;
  std::int64_t rays = 0;  // pixels of images without triangles, times samples
  std::int64_t tiles = 0;
  std::int64_t bytes = 0;  // held by a renderer that drew only this
  Timing timing;
  double ratio = 0;                 // to the baseline
  std::int64_t pages_reloaded = 0;  // in the timed rounds; 0: the times are of drawing alone

  double error(ErrorKind kind) const;
  double shift_p99_px() const;  // the larger of forward and backward
  bool within_stated() const;   // true also where nothing is stated
};

struct SubjectResult {
  Subject subject;
  std::vector<Measured> measured;  // in the order of Subject::configurations
};

struct ErrorTimeOptions {
  MakeRenderer make;
  core::SurfaceRadius surface;
  int rounds = 5;   // more: medians less disturbed by other programs, proportionally longer
  int threads = 1;  // of measuring errors; results do not depend on it
  Clock clock = wall_clock();
  // Receives the current step and the share of all work that is done. May throw to stop.
  std::function<void(const std::string& what, double fraction)> progress = [](const std::string&, double) {};
};

// Renders the references; measures the error of each configuration with a renderer of its own; then times all
// configurations in interleaved rounds, without ranges, with one renderer for each name. Before a timed frame
// it draws an untimed one if the configuration is quick, or if it has to reload data that others displaced.
// Throws what renderers throw; std::invalid_argument for a subject without configurations, and for images whose
// size is not their reference's; std::runtime_error for an incomplete image.
//
// Memory: it holds the references, one frame (with what Compose keeps of earlier ones), and one renderer of the whole share,
// while times are measured one of each name. Before a renderer is made it returns freed memory to the system.
//
// Typical usage:
//   ErrorTimeReport report{"Error against time", {}, {}};
//   report.results.push_back(measure(subject, options));
//   write(to_html(error_time_page(report)));  // error_time_page.h
SubjectResult measure(const Subject& subject, const ErrorTimeOptions& options);

}  // namespace vpe::report
