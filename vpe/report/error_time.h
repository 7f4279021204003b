// Error against run time: images of one view made in many ways, each measured against a reference and timed
// in turns with the others.
//
// A way is a point of a sweep over a knob of quality; renderers come in by name, so that tests can count frames
// of fake ones.
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

// What a sweep makes smaller.
enum class ErrorKind : std::uint8_t {
  kShift,   // of pixels: the larger of the 99 % quantiles forward and backward, px
  kColour,  // root mean square, steps of 8-bit sRGB
};

// Puts what was drawn together to one image of the reference's size.
using Compose = std::function<core::Frame(std::vector<core::Frame> frames)>;

struct Configuration {
  std::string sweep;        // as in "triangles by tolerance"
  std::string knob;         // as in "lod.tolerance=2"
  bool is_default = false;  // what is drawn when no more than the backend is named
  bool is_chosen = false;   // what is drawn when nothing is named
  ErrorKind kind = ErrorKind::kShift;
  std::string comparison_group;  // ways of equal name show the same and may stand on one front; empty: on none
  std::string plot;              // of the view, by its kind of error, on which it stands; empty: on none
  std::string colour_plot;       // by its colours, likewise
  std::string renderer;          // name for MakeRenderer
  std::vector<core::DrawRequest> requests;  // drawn one after another: what is timed
  Compose compose;                          // left out: the image of the only request
  std::size_t reference = 0;                // which of Subject::references
  // Relative error of the renderer's range images at the nearest ground; at the farthest 1 + farthest / nearest
  // times (vpe/gl/polygon_renderer.h). 0: in what it states.
  double range_error = 0;
  int most_rounds = std::numeric_limits<int>::max();  // of timing, for what is slow
  bool has_colours = true;                            // false: ranges alone are drawn
  bool has_ranges = true;                             // false: colours alone are compared
};

// An image that counts as exact, and how it is made.
struct Reference {
  core::View view;
  std::string renderer;
  std::vector<core::DrawRequest> requests;
  Compose compose;
  bool has_ranges = true;
};

struct Subject {
  std::string view;   // its name
  std::string about;  // where it is, as people read it
  std::vector<Reference> references;
  std::vector<Configuration> configurations;
  std::size_t baseline = 0;  // the way that times are ratios to
};

// `share`: of the memory for data. Renderers are used by one thread, several may be there at once.
using MakeRenderer = std::function<std::unique_ptr<core::Renderer>(const std::string& name, double share)>;

struct Measured {
  core::ImageErrors shift;  // of nothing where colours alone are compared
  core::Spread skyline;
  core::Spread range;
  std::optional<double> colour_rms;
  std::optional<double> similarity;
  // That no forward shift exceeds, by the certificate; nothing where that is not finite, and of composed
  // images.
  std::optional<double> stated_px;
  double slack_px = 0;  // what the range image itself may be off, beside what is stated
  std::int64_t triangles = 0;
  std::int64_t rays = 0;  // pixels of what was drawn without triangles, times samples
  std::int64_t tiles = 0;
  std::int64_t bytes = 0;  // held by a renderer that drew this alone
  Timing timing;
  double ratio = 0;                 // to the baseline
  std::int64_t pages_reloaded = 0;  // in the rounds that count: with 0 the times are of drawing alone

  double error(ErrorKind kind) const;
  double shift_p99_px() const;  // the larger of forward and backward
  bool within_stated() const;   // also where nothing is stated
};

// Measured in the order of Subject::ways.
struct SubjectResult {
  Subject subject;
  std::vector<Measured> measured;
};

struct ErrorTimeOptions {
  MakeRenderer make;
  core::SurfaceRadius surface;
  int rounds = 5;
  int threads = 1;  // of measuring; results do not depend on it
  Clock clock = wall_clock();
  // What is being done, and the share of all that is done; may throw to stop.
  std::function<void(const std::string& what, double fraction)> progress = [](const std::string&, double) {};
};

// Draws the references, then every way by a renderer of its own with ranges, then all ways in turns, without
// ranges, by one renderer for each name; where that had to load something again, as other ways took the memory,
// and before every quick one, a frame that does not count goes before the next. Throws what renderers throw, std::invalid_argument for a
// subject without ways or with images of other sizes than their reference's, std::runtime_error when a
// image is not complete.
SubjectResult measure(const Subject& subject, const ErrorTimeOptions& options);

}  // namespace vpe::report
