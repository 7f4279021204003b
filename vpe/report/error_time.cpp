#include "vpe/report/error_time.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <stdexcept>

#include "vpe/base/heap.h"

namespace vpe::report {

namespace {

// Configurations that take no longer are drawn once more before they are timed. That restores what others
// displaced from caches and memory, also pages that no statistics count.
constexpr double kQuick_s = 0.1;

// Returns the share of memory for each of several renderers.
double share_of(std::size_t renderers) {
  return 1.0 / static_cast<double>(std::max<std::size_t>(1, renderers));
}

// An image of one or several requests.
struct Composition {
  const std::vector<core::DrawRequest>& requests;
  const Compose& compose;
  bool has_ranges;
};

// Draws an image of the view. Passes each request and its result on before the frame is joined to the others.
core::Frame draw_composed(
    core::Renderer& renderer, const Composition& image, const core::View& view,
    const std::function<void(const core::DrawRequest&, const core::DrawResult&)>& see = {}) {
  std::size_t drawn = 0;
  const auto next = [&] {
    core::DrawRequest request = image.requests.at(drawn++);
    request.want_range = image.has_ranges;
    core::DrawResult result = renderer.draw(request);
    if (!result.missing.empty()) {
      throw std::runtime_error("an image to be measured lacks " + result.missing.front().tile + ": " +
                               result.missing.front().why);
    }
    if (see) see(request, result);
    return std::move(result.frame);
  };
  const std::size_t count = image.requests.size();
  if (!image.compose && count != 1)
    throw std::invalid_argument("measure: several images and no function to join them");
  core::Frame frame = image.compose ? image.compose(count, next) : next();
  if (drawn != count)
    throw std::invalid_argument("measure: " + std::to_string(drawn) + " of " + std::to_string(count) +
                                " images were joined");
  const glm::ivec2 size = core::drawn_size(view);
  if (frame.width != size.x || frame.height != size.y) {
    throw std::invalid_argument("measure: an image of " + std::to_string(frame.width) + "x" +
                                std::to_string(frame.height) + " for a view of " + std::to_string(size.x) +
                                "x" + std::to_string(size.y));
  }
  return frame;
}

// The same by a renderer of its own, which is gone when the image is returned.
core::Frame draw_alone(const std::string& name, const Composition& image, const core::View& view,
                       const ErrorTimeOptions& options,
                       const std::function<void(const core::DrawRequest&, const core::DrawResult&)>& see = {}) {
  base::return_freed_memory();
  const std::unique_ptr<core::Renderer> renderer = options.make(name, 1.0);
  return draw_composed(*renderer, image, view, see);
}

// Returns the shift that the range image's own error can add.
double slack_px(const core::View& view, const std::vector<float>& range_m, double range_error) {
  float nearest = core::kSkyRange;
  float farthest = 0;
  for (const float range : range_m) {
    if (!(range > 0)) continue;
    nearest = std::min(nearest, range);
    if (std::isfinite(range)) farthest = std::max(farthest, range);
  }
  if (!std::isfinite(nearest)) return 0;
  return range_error * (1.0 + static_cast<double>(farthest) / static_cast<double>(nearest)) *
         core::focal_px(view);
}

void count(const core::DrawRequest& request, const core::DrawResult& result, Measured& measured) {
  const core::Certificate& c = result.certificate;
  const double stated_px = c.image_bound_px.value_or(c.shift_bound_px);
  if (std::isfinite(stated_px)) measured.stated_px = std::max(measured.stated_px.value_or(0.0), stated_px);
  measured.triangles += result.stats.triangles + result.stats.skirt_triangles;
  measured.tiles += result.stats.tiles_drawn;
  if (result.stats.triangles == 0) {
    const glm::ivec2 size = core::drawn_size(request.view);
    measured.rays += std::int64_t{size.x} * size.y * request.settings.samples;
  }
  measured.bytes = std::max(measured.bytes, result.stats.bytes_resident);
}

Measured measure_errors(const Configuration& configuration, const core::View& view, const core::Frame& truth,
                        const ErrorTimeOptions& options) {
  Measured measured;
  const core::Frame frame = draw_alone(
      configuration.renderer, {configuration.requests, configuration.compose, configuration.has_ranges}, view,
      options, [&](const core::DrawRequest& request, const core::DrawResult& result) {
        count(request, result, measured);
      });
  if (configuration.has_colours) {
    measured.colour_rms = core::colour_rms(frame.colour, truth.colour);
    measured.similarity = core::structural_similarity(frame.colour, truth.colour, frame.width, frame.height);
  }
  if (!configuration.has_ranges || configuration.compose) measured.stated_px.reset();
  if (configuration.has_ranges) {
    core::MetricOptions metrics;
    metrics.threads = options.threads;
    measured.shift = core::compare_to_reference(view, frame.range_m, truth.range_m, options.surface, metrics);
    measured.skyline = core::skyline_shift_px(frame.range_m, truth.range_m, frame.width, frame.height);
    measured.range = core::range_error(frame.range_m, truth.range_m);
    measured.slack_px = slack_px(view, frame.range_m, configuration.range_error);
  }
  return measured;
}

void measure_times(const Subject& subject, const ErrorTimeOptions& options, std::vector<Measured>& measured,
                   const std::function<void(const std::string&)>& step) {
  std::set<std::string> names;
  for (const Configuration& configuration : subject.configurations) names.insert(configuration.renderer);
  base::return_freed_memory();
  std::map<std::string, std::unique_ptr<core::Renderer>> renderers;
  for (const std::string& name : names) renderers[name] = options.make(name, share_of(names.size()));
  const auto draw = [&](const Configuration& configuration) {
    std::int64_t uploaded = 0;
    for (const core::DrawRequest& request : configuration.requests) {
      core::DrawRequest plain = request;
      plain.want_range = !configuration.has_colours;
      uploaded += renderers.at(configuration.renderer)->draw(plain).stats.pages_uploaded;
    }
    return uploaded;
  };
  std::vector<BenchmarkCase> cases;
  std::vector<int> runs(subject.configurations.size(), 0);
  std::vector<bool> is_displaced(subject.configurations.size(), false);  // its data, while others are drawn
  for (std::size_t k = 0; k < subject.configurations.size(); ++k) {
    BenchmarkCase benchmark_case;
    benchmark_case.most_rounds = subject.configurations[k].most_rounds;
    benchmark_case.prepare = [&, k](double last_s) {
      step("timing " + subject.configurations[k].sweep);
      if (runs[k] == 1) {
        is_displaced[k] = draw(subject.configurations[k]) > 0;
      } else if (runs[k] > 1 && (is_displaced[k] || last_s < kQuick_s)) {
        draw(subject.configurations[k]);
      }
    };
    benchmark_case.run = [&, k] {
      const std::int64_t uploaded = draw(subject.configurations[k]);
      if (runs[k]++ > 0) measured[k].pages_reloaded += uploaded;
    };
    cases.push_back(std::move(benchmark_case));
  }
  const std::vector<Timing> timings = time_interleaved(cases, options.rounds, options.clock);
  for (std::size_t k = 0; k < timings.size(); ++k) {
    measured[k].timing = timings[k];
    measured[k].ratio = ratio(timings[k], timings[subject.baseline]);
  }
}

}  // namespace

double Measured::shift_p99_px() const { return std::max(shift.forward.p99_px, shift.backward.p99_px); }

double Measured::error(ErrorKind kind) const {
  return kind == ErrorKind::kShift ? shift_p99_px() : colour_rms.value_or(0.0);
}

bool Measured::within_stated() const { return !stated_px || shift.forward.max_px <= *stated_px + slack_px; }

SubjectResult measure(const Subject& subject, const ErrorTimeOptions& options) {
  if (subject.configurations.empty() || subject.baseline >= subject.configurations.size() ||
      subject.references.empty())
    throw std::invalid_argument("measure: a subject without configurations, baseline or reference");
  const double configurations = static_cast<double>(subject.configurations.size());
  const double steps = static_cast<double>(subject.references.size()) + 2 * configurations +
                       (options.rounds + 1) * configurations;
  double done = 0;
  const auto step = [&](const std::string& what, double size) {
    options.progress(subject.view + ", " + what, std::min(1.0, done / steps));
    done += size;
  };
  std::vector<core::Frame> truths;
  for (const Reference& reference : subject.references) {
    step("reference", 1);
    truths.push_back(draw_alone(reference.renderer,
                                {reference.requests, reference.compose, reference.has_ranges}, reference.view,
                                options));
  }
  SubjectResult result{subject, {}};
  for (const Configuration& configuration : subject.configurations) {
    step(configuration.sweep, 2);
    result.measured.push_back(measure_errors(configuration, subject.references.at(configuration.reference).view,
                                             truths.at(configuration.reference), options));
  }
  measure_times(subject, options, result.measured, [&](const std::string& what) { step(what, 1); });
  return result;
}

}  // namespace vpe::report
