// Acceptance: ten sessions that were recorded replay to the bit, and rays draw the same images of them.
#include <gtest/gtest.h>

#include <array>
#include <fstream>
#include <set>
#include <sstream>

#include "mars/geodesy/sun.h"
#include "scripts/path.h"
#include "tests/paging/planet_fixture.h"
#include "vpe/explore/draw_choice.h"
#include "vpe/explore/files/session_log.h"
#include "vpe/explore/session.h"
#include "vpe/voxel/ray_renderer.h"

namespace vpe::explore {
namespace {

using test_support::Random;

std::shared_ptr<const paging::PlanetFile> planet() {
  static const test_support::TempDir folder;
  static const auto made = test_support::build_fake(
      folder / "p.vpe", test_support::FakeElevation(test_support::bumpy_height), 200'000);
  return made;
}

// What an image of a session was requested with.
struct Seen {
  double time_s = 0;
  mars::Pose pose;
  mars::HeadAngles look;
  core::View view;
  core::Settings settings;
  core::Backend backend = core::Backend::kPolygon;
  std::optional<core::StereoLayout> stereo;
  double eye_base_m = 0;
  double convergence_m = 0;
};

scripts::Flight flight_over(Random& random) {
  const double lon_deg = random.uniform(-170, 160);
  const std::string lon = std::to_string(lon_deg);
  const scripts::ParsedFlight parsed = scripts::parse_flight(
      "flight 1.1\nview fov=70\nat 0 pose lon=" + lon + " lat=5 alt=90000 pitch=-30\nat 0 view backend=ray\n" +
          "at 0.5 set colour=slope\nat 0.7 view fov=25.5 eyes=anaglyph base=900 convergence=95000\nat 1 look yaw=20\n" +
          "at 1.5 view eyes=off fov=40\nat 2 pose lon=" + std::to_string(lon_deg + 2) +
          " lat=7 alt=80000 yaw=30 pitch=-20\n",
      "flown");
  EXPECT_TRUE(parsed.flight.has_value());
  return *parsed.flight;
}

// Acts at random for some seconds, and records an image after most of the actions.
std::vector<Seen> recorded_session(int seed, const std::filesystem::path& file) {
  Random random(static_cast<unsigned>(seed));
  SessionOptions options;
  options.start = mars::Pose{random.uniform(-180, 180),
                             random.uniform(-80, 80),
                             random.uniform(3e4, 3e5),
                             random.uniform(-180, 180),
                             -35,
                             0};
  options.fov_deg = random.uniform(20, 80);
  Session session(std::make_shared<const paging::Surface>(planet(), std::size_t{32} << 20), options);
  session.resize(96, 54);
  DrawChooser chooser;
  DrawChoice own;
  core::Backend now = core::Backend::kPolygon;
  SessionLog log(file, {session.screen().fov_deg, 96, 54, {30, 1}}, session.ground().radius_m);
  std::vector<Seen> seen;
  mars::HeadAngles tracker;
  double time_s = random.uniform(0, 0.5);
  const auto xy = [&] {
    const double x = random.uniform(0, 96);
    return glm::dvec2(x, random.uniform(0, 54));
  };
  for (int n = 0; n < 250; ++n) {
    const double dt_s = random.integer(0, 15) == 0 ? random.uniform(0.3, 20) : random.uniform(0.005, 0.05);
    time_s += dt_s;
    Controls controls;
    switch (random.integer(0, 14)) {
      case 0: session.set_fov(session.screen().fov_deg * random.log_uniform(0.5, 2)); break;
      case 1: session.press(random.integer(0, 1) == 0 ? MouseUse::kHold : MouseUse::kTilt, xy()); break;
      case 2: session.release(); break;
      case 3: session.wheel(xy(), random.uniform(-1, 1)); break;
      case 4: own.drawn_by = static_cast<core::DrawnBy>(random.integer(0, 2)); break;
      case 5: {
        const int eyes = random.integer(0, 3);
        own.stereo = eyes == 3 ? std::nullopt : std::optional(static_cast<core::StereoLayout>(eyes));
        break;
      }
      case 6: own.eye_base_m = random.integer(0, 1) == 0 ? 0 : random.log_uniform(1, 5000); break;
      case 7: {
        const int width = 2 * random.integer(32, 60);
        session.resize(width, 2 * random.integer(16, 32));
        break;
      }
      case 8: EXPECT_EQ(session.set("exaggeration", random.integer(0, 1) == 0 ? "1" : "2.5"), ""); break;
      case 9: tracker = {random.uniform(-90, 90), random.uniform(-30, 30), 0}; break;
      case 10:
        if (random.integer(0, 2) == 0) {
          EXPECT_EQ(session.flights().load(flight_over(random)), "");
        }
        (void)session.follow(true);
        break;
      case 11: session.leave_flight(); break;
      case 12: own.convergence_m = random.integer(0, 1) == 0 ? 0 : random.log_uniform(1e4, 1e7); break;
      default: controls.forward = controls.yaw_right = random.uniform(-1, 1); break;
    }
    if (session.mouse_use() != MouseUse::kNone) session.drag(xy());
    session.advance(dt_s, controls, tracker);
    const DrawChoice chosen = chooser.update(own, session.follows_flight() ? session.player() : nullptr);
    now = core::backend_for(chosen.drawn_by, {false, true, session.pose().alt_m / mars::kMarsRadius_m, now});
    Seen image{
        time_s, session.pose(),      session.look(), session.view(), session.settings(), now, chosen.stereo,
        0,      chosen.convergence_m};
    image.eye_base_m = chosen.eye_base_m > 0 ? chosen.eye_base_m : core::base_for_height_m(session.height_m());
    scripts::ViewState view{image.view.fov_deg,
                            scripts::ImageSize{image.view.width, image.view.height},
                            core::drawn_by(now),
                            scripts::Eyes{chosen.stereo},
                            {},
                            {}};
    if (chosen.stereo) {
      view.eye_base_m = image.eye_base_m;
      view.convergence_m = image.convergence_m;
    }
    if (random.integer(0, 4) == 0) continue;  // no image is due in this iteration
    EXPECT_EQ(log.frame({time_s, image.pose, image.look, view}, image.settings), time_s);
    seen.push_back(image);
  }
  log.end(time_s + 1);
  return seen;
}

// Draws an image by rays, for both eyes if there are two.
std::vector<base::Rgb> drawn(core::Renderer& renderer, const core::View& view, const core::Settings& settings,
                             const mars::Pose& pose, std::optional<core::StereoLayout> stereo, double base_m,
                             double convergence_m) {
  core::DrawRequest request;
  request.settings = settings.values();
  request.sun = mars::sun_direction({pose.lon_deg, pose.lat_deg}, request.settings.sun_azimuth_deg,
                                    request.settings.sun_elevation_deg);
  std::vector<core::RgbImage> eyes;
  for (const double side : stereo ? std::vector<double>{-0.5, 0.5} : std::vector<double>{0}) {
    request.view = core::eye_view(view, side * base_m, core::convergence_at(convergence_m));
    core::Frame frame = renderer.draw(request).frame;
    eyes.push_back({frame.width, frame.height, std::move(frame.colour)});
  }
  return stereo ? core::combine_stereo(eyes[0], eyes[1], *stereo).pixels : eyes[0].pixels;
}

std::array<double, 9> numbers(const mars::Pose& p, const mars::HeadAngles& h) {
  return {p.lon_deg,  p.lat_deg, p.alt_m,     p.yaw_deg, p.pitch_deg,
          p.roll_deg, h.yaw_deg, h.pitch_deg, h.roll_deg};
}

TEST(Replay, OfTenRecordedSessionsIsEqualToTheBit) {
  const test_support::TempDir folder;
  const auto renderer = voxel::make_ray_renderer(planet(), {std::size_t{256} << 20, 2});
  int zooms = 0;
  int pairs = 0;
  int converging = 0;
  int by_rays = 0;
  int images = 0;
  int grounds = 0;
  for (int seed = 1; seed <= 10; ++seed) {
    const std::filesystem::path file = folder / (std::to_string(seed) + ".flight");
    const std::vector<Seen> seen = recorded_session(seed, file);
    std::ifstream in(file);
    std::stringstream text;
    text << in.rdbuf();
    EXPECT_TRUE(text.str().starts_with("flight 1.1\n"));
    EXPECT_EQ(text.str().find("\n# at "), std::string::npos) << "a part of the session is a comment only";
    const scripts::ParsedFlight parsed = scripts::parse_flight(text.str(), file.string());
    ASSERT_TRUE(parsed.flight.has_value()) << to_string(parsed.errors.at(0));
    const scripts::Path path(*parsed.flight, planet()->radius_m(), {});
    for (std::size_t n = 0; n < seen.size(); ++n) {
      const Seen& was = seen[n];
      const scripts::FlightState is = path.at(was.time_s);
      ASSERT_EQ(numbers(is.pose, is.head), numbers(was.pose, was.look)) << seed << " " << n;
      ASSERT_EQ(is.view.fov_deg, was.view.fov_deg) << seed << " " << n;
      ASSERT_EQ(is.view.size, (scripts::ImageSize{was.view.width, was.view.height}));
      ASSERT_EQ(is.view.backend, core::drawn_by(was.backend));
      ASSERT_EQ(is.view.eyes, scripts::Eyes{was.stereo});
      if (was.stereo) {
        ASSERT_EQ(is.view.eye_base_m, was.eye_base_m);
        ASSERT_EQ(is.view.convergence_m, was.convergence_m);
        converging += was.convergence_m > 0 ? 1 : 0;
      }
      core::Settings settings;
      path.apply_settings(was.time_s, settings);
      ASSERT_EQ(settings, was.settings);
      zooms += n > 0 && seen[n - 1].view.fov_deg != was.view.fov_deg ? 1 : 0;
      pairs += was.stereo ? 1 : 0;
      by_rays += was.backend == core::Backend::kRay ? 1 : 0;
      if (n % 40 != 7) continue;
      core::View view;
      view.camera = is.camera;
      view.fov_deg = *is.view.fov_deg;
      view.width = is.view.size->width;
      view.height = is.view.size->height;
      const auto then =
          drawn(*renderer, was.view, was.settings, was.pose, was.stereo, was.eye_base_m, was.convergence_m);
      const auto again = drawn(*renderer, view, settings, is.pose, is.view.eyes->layout,
                               is.view.eye_base_m.value_or(0), is.view.convergence_m.value_or(0));
      ASSERT_EQ(then, again) << seed << " " << n;
      ++images;
      // Sky alone would be equal anyway.
      std::set<int> reds;
      for (const base::Rgb& pixel : then) reds.insert(pixel.r);
      grounds += reds.size() > 20 ? 1 : 0;
    }
  }
  // The sessions had what is to be replayed.
  EXPECT_GT(zooms, 100);
  EXPECT_GT(pairs, 300);
  EXPECT_GT(converging, 30);
  EXPECT_GT(by_rays, 300);
  EXPECT_GE(images, 40);
  EXPECT_GE(grounds, 20);
}

}  // namespace
}  // namespace vpe::explore
