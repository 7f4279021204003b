// Configurations measured and timed with fake renderers whose frames are counted and whose errors are known.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <pugixml.hpp>

#include "mars/geodesy/pose.h"
#include "vpe/report/error_time_page.h"
#include "vpe/report/resampling.h"

namespace vpe::report {
namespace {

constexpr double kRadius_m = 1e6;
constexpr double kHeight_m = 1000;

core::View view_down() {
  core::View view;
  view.camera = mars::to_camera({10, 20, kHeight_m, 0, -90, 0}, kRadius_m);
  view.width = 40;
  view.height = 30;
  view.fov_deg = 20;
  return view;
}

// Shared by the fakes: a log of requests, and a clock that they advance.
struct World {
  double now_s = 0;
  int made = 0;
  int alive = 0;
  int most_alive = 0;
  std::vector<std::string> log;
};

// Draws the sphere, `lod.tolerance` pixels too high, in steps of colour that are as far off; takes 1 /
// tolerance seconds, and a first frame 100 more.
class FakeRenderer : public core::Renderer {
 public:
  FakeRenderer(World& world, std::string name) : world_(world), name_(std::move(name)) {
    ++world_.made;
    world_.most_alive = std::max(world_.most_alive, ++world_.alive);
  }
  ~FakeRenderer() override { --world_.alive; }

  core::DrawResult draw(const core::DrawRequest& request) override {
    const double off_px = request.settings.lod_tolerance_px;
    world_.log.push_back(name_ + (request.want_range ? " with ranges " : " ") +
                         std::to_string(static_cast<int>(off_px)));
    world_.now_s += 1 / std::max(off_px, 0.125) + (frames_++ == 0 ? 100 : 0);
    core::DrawResult result;
    const glm::ivec2 size = core::drawn_size(request.view);
    result.frame.width = size.x;
    result.frame.height = size.y;
    const double high_m = off_px * kHeight_m / core::focal_px(request.view);
    for (int y = 0; y < size.y; ++y) {
      for (int x = 0; x < size.x; ++x) {
        const auto base = static_cast<std::uint8_t>(100 + (x * 7 + y * 3) % 20);
        const auto off = static_cast<std::uint8_t>(std::lround(2 * off_px));
        result.frame.colour.push_back({static_cast<std::uint8_t>(base + off), base, base});
        if (!request.want_range) continue;
        const core::SubRectangle part = core::drawn_part(request.view);
        const glm::dvec3 ray = core::pixel_ray(request.view, part.x + x + 0.5, part.y + y + 0.5);
        const double along = -glm::dot(request.view.camera.position_m, ray);
        const double deep2 =
            glm::dot(request.view.camera.position_m, request.view.camera.position_m) - along * along;
        const double r = kRadius_m + high_m;
        result.frame.range_m.push_back(static_cast<float>(along - std::sqrt(r * r - deep2)));
      }
    }
    result.certificate.shift_bound_px = off_px * stated_factor_;
    result.stats.triangles = static_cast<std::int64_t>(1000 / std::max(off_px, 0.125));
    result.stats.bytes_resident = 5 << 20;
    result.stats.pages_uploaded = frames_ == 1 ? 7 : 0;
    return result;
  }

  double stated_factor_ = 1.2;

 private:
  World& world_;
  std::string name_;
  int frames_ = 0;
};

Configuration configuration(double tolerance, const std::string& renderer = "a") {
  Configuration one;
  one.sweep = renderer + " by tolerance";
  one.knob = "lod.tolerance=" + std::to_string(static_cast<int>(tolerance));
  one.comparison_group = one.plot = one.colour_plot = "image";
  one.renderer = renderer;
  core::DrawRequest request;
  request.view = view_down();
  request.settings.lod_tolerance_px = tolerance;
  one.requests = {request};
  return one;
}

Subject subject() {
  Subject all;
  all.view = "straight down";
  all.about = "a <sphere>";
  all.references.push_back({view_down(), "a", {configuration(0).requests.front()}, {}, true});
  for (const double tolerance : {8.0, 4.0, 2.0}) all.configurations.push_back(configuration(tolerance));
  all.configurations[1].is_default = true;
  all.configurations.push_back(configuration(4, "b"));
  all.baseline = 1;
  return all;
}

class ErrorTime : public ::testing::Test {
 protected:
  ErrorTime() {
    options_.make = [this](const std::string& name, double share) {
      shares_.push_back(share);
      auto made = std::make_unique<FakeRenderer>(world_, name);
      made->stated_factor_ = stated_factor_;
      return made;
    };
    options_.surface = [](std::span<const glm::dvec3>, std::span<double> radius_m) {
      std::fill(radius_m.begin(), radius_m.end(), kRadius_m);
    };
    options_.clock = [this] { return world_.now_s; };
    options_.rounds = 3;
  }

  World world_;
  std::vector<double> shares_;
  double stated_factor_ = 1.2;
  ErrorTimeOptions options_;
};

TEST_F(ErrorTime, FindsTheErrorsThatWerePutIn) {
  const SubjectResult result = measure(subject(), options_);
  ASSERT_EQ(result.measured.size(), 4U);
  const std::vector<double> tolerances{8, 4, 2, 4};
  for (std::size_t k = 0; k < 4; ++k) {
    const Measured& m = result.measured[k];
    const double off_px = tolerances[k];
    // In the middle the range is the height less the error put in; towards the edges it is a few per cent
    // longer.
    EXPECT_NEAR(m.shift.forward.max_px, off_px / (1 - off_px / core::focal_px(view_down())), 0.002 * off_px)
        << k;
    EXPECT_LE(m.shift.forward.p99_px, m.shift.forward.max_px);
    EXPECT_NEAR(m.range.median, off_px / core::focal_px(view_down()), 0.002 * off_px) << k;
    EXPECT_NEAR(*m.colour_rms, 2 * off_px / std::sqrt(3.0), 1e-9) << k;
    EXPECT_LT(*m.similarity, 1);
    EXPECT_NEAR(*m.stated_px, 1.2 * off_px, 1e-12);
    EXPECT_TRUE(m.within_stated());
    EXPECT_EQ(m.triangles, static_cast<std::int64_t>(1000 / off_px));
    EXPECT_EQ(m.bytes, 5 << 20);
  }
}

TEST_F(ErrorTime, TimesInterleavedByWarmRenderers) {
  const SubjectResult result = measure(subject(), options_);
  EXPECT_NEAR(result.measured[0].timing.median_s(), 1 / 8.0, 1e-9);
  EXPECT_NEAR(result.measured[2].timing.median_s(), 1 / 2.0, 1e-9);
  EXPECT_NEAR(result.measured[2].ratio, 2, 1e-9);
  EXPECT_EQ(result.measured[1].ratio, 1);
  for (const Measured& m : result.measured) {
    EXPECT_EQ(m.timing.round_s.size(), 3U);
    EXPECT_EQ(m.pages_reloaded, 0);
  }
  // The reference and every configuration by its own renderer, with ranges; then an untimed round and three
  // timed ones, without.
  const std::vector<std::string> round{"a 8", "a 4", "a 2", "b 4"};
  std::vector<std::string> expected{"a with ranges 0", "a with ranges 8", "a with ranges 4", "a with ranges 2",
                                    "b with ranges 4"};
  expected.insert(expected.end(), round.begin(), round.end());
  // Before the first timed round each draws once to see whether it still has its data.
  for (const std::string& frame : round) expected.insert(expected.end(), 2, frame);
  for (int n = 0; n < 2; ++n) expected.insert(expected.end(), round.begin(), round.end());
  EXPECT_EQ(world_.log, expected);
  EXPECT_EQ(world_.made, 7);
  EXPECT_EQ(world_.most_alive, 2);
  EXPECT_EQ(shares_, (std::vector<double>{1, 1, 1, 1, 1, 0.5, 0.5}));
}

// Quick configurations are drawn once more before each timed frame.
TEST_F(ErrorTime, QuickConfigurationsAreTimedWarm) {
  Subject all = subject();
  all.configurations[0].requests.front().settings.lod_tolerance_px = 16;
  const SubjectResult result = measure(all, options_);
  EXPECT_NEAR(result.measured[0].timing.median_s(), 1 / 16.0, 1e-9);
  // Once in the untimed round and twice in each of three timed ones; slower ones once, but for the first.
  EXPECT_EQ(std::count(world_.log.begin(), world_.log.end(), "a 16"), 7);
  EXPECT_EQ(std::count(world_.log.begin(), world_.log.end(), "a 4"), 5);
}

// Where another configuration displaces data, loading it again is not timed.
TEST_F(ErrorTime, LoadingAgainIsNotTimed) {
  class Forgetful : public core::Renderer {
   public:
    explicit Forgetful(World& world) : real_(world, "f"), world_(world) {}
    core::DrawResult draw(const core::DrawRequest& request) override {
      core::DrawResult result = real_.draw(request);
      const double wanted = request.settings.lod_tolerance_px;
      result.stats.pages_uploaded = wanted == held_ ? 0 : 3;
      if (wanted != held_) world_.now_s += 40;
      held_ = wanted;
      return result;
    }

   private:
    FakeRenderer real_;
    World& world_;
    double held_ = -1;
  };
  options_.make = [this](const std::string&, double) { return std::make_unique<Forgetful>(world_); };
  const SubjectResult result = measure(subject(), options_);
  EXPECT_NEAR(result.measured[0].timing.median_s(), 1 / 8.0, 1e-9);
  EXPECT_EQ(result.measured[0].pages_reloaded, 0);
}

TEST_F(ErrorTime, FindsAFalseStatement) {
  stated_factor_ = 0.9;
  const SubjectResult result = measure(subject(), options_);
  EXPECT_FALSE(result.measured[0].within_stated());
  EXPECT_FALSE(summarize_sweeps(result).at(0).within_stated);
}

TEST_F(ErrorTime, WithoutAStatementNothingIsExceeded) {
  stated_factor_ = std::numeric_limits<double>::quiet_NaN();
  const SubjectResult result = measure(subject(), options_);
  EXPECT_FALSE(result.measured[0].stated_px.has_value());
  EXPECT_TRUE(result.measured[0].within_stated());
}

TEST_F(ErrorTime, SweepsSayHowFarErrorsFall) {
  const SubjectResult result = measure(subject(), options_);
  const std::vector<SweepSummary> sweeps = summarize_sweeps(result);
  ASSERT_EQ(sweeps.size(), 1U);  // b has one configuration
  EXPECT_EQ(sweeps[0].points, 3);
  EXPECT_EQ(sweeps[0].coarsest, "lod.tolerance=8");
  EXPECT_EQ(sweeps[0].finest, "lod.tolerance=2");
  EXPECT_NEAR(sweeps[0].decades, std::log10(4.0), 0.05);
  EXPECT_NEAR(sweeps[0].worst_rise, 0.5, 0.03);
  Subject rising = subject();
  std::swap(rising.configurations[1], rising.configurations[2]);
  EXPECT_NEAR(summarize_sweeps(measure(rising, options_)).at(0).worst_rise, 2, 0.2);
}

TEST_F(ErrorTime, DefaultsAreComparedWithTheFront) {
  Subject all = subject();
  // As exact as the default and faster, by another renderer; another group does not count.
  all.configurations[3].requests.front().settings.lod_tolerance_px = 4;
  SubjectResult result = measure(all, options_);
  result.measured[3].timing.round_s = {0.05, 0.05, 0.05};
  const std::vector<DefaultPlace> places = place_defaults(result);
  ASSERT_EQ(places.size(), 1U);
  EXPECT_NEAR(places[0].over_front, 0.25 / 0.05, 1e-6);
  EXPECT_NEAR(places[0].over_own_front, 1, 1e-6);
  EXPECT_EQ(places[0].front, "b by tolerance, lod.tolerance=4");
  EXPECT_EQ(fronts(result), (std::vector<std::size_t>{2, 3}));
  EXPECT_FALSE(places[0].is_chosen);
  result.subject.configurations[3].is_chosen = true;
  ASSERT_EQ(place_defaults(result).size(), 2U);
  EXPECT_TRUE(place_defaults(result)[1].is_chosen);
  EXPECT_NEAR(place_defaults(result)[1].over_front, 1, 1e-6);
  EXPECT_TRUE(over_views({result}).at(3).configuration.is_chosen);
  result.subject.configurations[3].comparison_group = "others";
  EXPECT_NEAR(place_defaults(result).at(0).over_front, 1, 1e-6);
}

TEST_F(ErrorTime, ErrorsOfRoundingAreNotBetter) {
  SubjectResult result = measure(subject(), options_);
  result.measured[1].shift.forward.p99_px = result.measured[1].shift.backward.p99_px = 2e-5;
  result.measured[2].shift.forward.p99_px = result.measured[2].shift.backward.p99_px = 1e-5;  // and slower
  EXPECT_EQ(fronts(result).back(), 1U);
  EXPECT_EQ(place_defaults(result).at(0).error, 2e-5);
}

// Two halves of an image, joined.
TEST_F(ErrorTime, ImagesMayBeComposed) {
  Subject all = subject();
  Configuration halves = configuration(2);
  halves.requests.push_back(halves.requests.front());
  halves.requests[0].view.part = {0, 0, 40, 15};
  halves.requests[1].view.part = {0, 15, 40, 15};
  halves.compose = [](std::size_t count, const NextFrame& next) {
    EXPECT_EQ(count, 2U);
    core::Frame whole = next();
    const core::Frame below = next();
    whole.height = 30;
    whole.colour.insert(whole.colour.end(), below.colour.begin(), below.colour.end());
    whole.range_m.insert(whole.range_m.end(), below.range_m.begin(), below.range_m.end());
    return whole;
  };
  all.configurations.push_back(halves);
  const SubjectResult result = measure(all, options_);
  EXPECT_NEAR(result.measured[4].shift.forward.max_px, result.measured[2].shift.forward.max_px, 1e-9);
  EXPECT_FALSE(result.measured[4].stated_px.has_value());
  EXPECT_NEAR(result.measured[4].timing.median_s(), 1, 1e-9);
  all.configurations.back().compose = {};
  EXPECT_THROW(measure(all, options_), std::invalid_argument);
  all.configurations.back().compose = [](std::size_t, const NextFrame& next) { return next(); };
  EXPECT_THROW(measure(all, options_), std::invalid_argument);
}

// So that images of many strips need the memory of one: a strip is drawn when the one before was averaged.
TEST_F(ErrorTime, StripsAreDrawnOneByOne) {
  constexpr int kFactor = 64;
  core::DrawRequest request;
  request.view = view_down();
  request.settings.lod_tolerance_px = 2;
  const std::vector<core::DrawRequest> strips = enlarged(request, kFactor);
  ASSERT_GE(strips.size(), 3U);
  int bottom = 0;
  for (const core::DrawRequest& strip : strips) {
    const core::SubRectangle& part = strip.view.part;
    EXPECT_EQ(part.y, bottom);
    EXPECT_EQ(part.height % kFactor, 0);
    EXPECT_LE(part.height, kMostStripRows);
    EXPECT_LE(std::int64_t{part.width} * part.height, kMostStripPixels);
    bottom += part.height;
  }
  EXPECT_EQ(bottom, kFactor * request.view.height);

  std::size_t drawn = 0;
  const core::Frame mean = average(request.view, kFactor)(strips.size(), [&] {
    const glm::ivec2 size = core::drawn_size(strips.at(drawn).view);
    core::Frame frame = blank_frame(size);
    for (int y = 0; y < size.y; ++y)
      for (int x = 0; x < size.x; ++x)
        frame.colour[static_cast<std::size_t>(y * size.x + x)] = {
            static_cast<std::uint8_t>(x / kFactor), static_cast<std::uint8_t>(10 * drawn),
            static_cast<std::uint8_t>(x % 2 == 0 ? 0 : 100)};
    ++drawn;
    return frame;
  });
  EXPECT_EQ(drawn, strips.size());
  ASSERT_EQ(mean.colour.size(), static_cast<std::size_t>(request.view.width * request.view.height));
  for (int y = 0; y < request.view.height; ++y) {
    const auto strip = static_cast<std::size_t>(y * kFactor / strips.front().view.part.height);
    for (int x = 0; x < request.view.width; ++x) {
      const base::Rgb& c = mean.colour[static_cast<std::size_t>(y * request.view.width + x)];
      EXPECT_EQ(c.r, x);
      EXPECT_EQ(c.g, 10 * strip);
      EXPECT_EQ(c.b, 50);
    }
  }
}

TEST_F(ErrorTime, RefusesSubjectsThatCannotBeMeasured) {
  Subject none = subject();
  none.configurations.clear();
  EXPECT_THROW(measure(none, options_), std::invalid_argument);
  Subject other = subject();
  other.configurations[0].requests.front().view.width = 41;
  EXPECT_THROW(measure(other, options_), std::invalid_argument);
}

TEST_F(ErrorTime, ProgressRisesAndMayStop) {
  double before = 0;
  options_.progress = [&](const std::string& what, double fraction) {
    EXPECT_GE(fraction, before);
    EXPECT_LE(fraction, 1);
    EXPECT_EQ(what.find("straight down, "), 0U);
    before = fraction;
  };
  measure(subject(), options_);
  EXPECT_GT(before, 0.9);
  options_.progress = [](const std::string&, double fraction) {
    if (fraction > 0.5) throw std::runtime_error("stop");
  };
  EXPECT_THROW(measure(subject(), options_), std::runtime_error);
  EXPECT_EQ(world_.alive, 0);
}

TEST_F(ErrorTime, TablesPlotsAndJsonAgree) {
  const ErrorTimeReport report{"Error & time", {"here"}, {measure(subject(), options_)}};
  const Table points = points_table(report.results);
  ASSERT_EQ(points.rows.size(), 4U);
  const nlohmann::json json = error_time_json(report);
  const auto& row = json["points"]["rows"][1];
  EXPECT_EQ(row["view"], "straight down");
  EXPECT_EQ(row["default"], "backend");
  EXPECT_EQ(row["ratio"], 1);
  EXPECT_EQ(row["shift_max_px"], report.results[0].measured[1].shift.forward.max_px);
  EXPECT_TRUE(row["rays"].is_null());
  EXPECT_EQ(json["sweeps"]["rows"].size(), 1U);
  EXPECT_EQ(json["defaults"]["rows"].size(), 1U);
  const std::string html = to_html(error_time_page(report));
  EXPECT_NE(html.find("a &lt;sphere&gt;"), std::string::npos);
  // The summary, errors and colours of the view.
  pugi::xml_document svg;
  ASSERT_TRUE(svg.load_string(to_svg(summary_plot(report.results)).c_str()));
  std::size_t plots = 0;
  for (std::size_t at = html.find("<svg"); at != std::string::npos; at = html.find("<svg", at + 1)) ++plots;
  EXPECT_EQ(plots, 2U);
}

}  // namespace
}  // namespace vpe::report
