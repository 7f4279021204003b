// Tests of two eyes in the explore window: the places of their images, marks over them, the recorded size.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <string>

#include "tests/window/explore_window_fixture.h"
#include "vpe/explore/files/hotspots.h"
#include "vpe/window/panels/flight_panel.h"

namespace vpe::window {
namespace {

using core::StereoLayout;

TEST(ImageLayoutTest, EyesShareTheView) {
  for (const auto& [width, height] : {std::pair{630.0, 513.0}, {631.0, 512.0}, {17.0, 16.0}}) {
    const ViewArea view{330, 7, width, height};
    const ImageLayout one{view, std::nullopt};
    EXPECT_EQ(one.eyes(), 1);
    EXPECT_EQ(one.eye_size(), glm::ivec2(static_cast<int>(width), static_cast<int>(height)));
    EXPECT_EQ((ImageLayout{view, StereoLayout::kAnaglyph}.eye_size()), one.eye_size());
    for (const StereoLayout stereo : {StereoLayout::kSideBySide, StereoLayout::kOverUnder}) {
      const ImageLayout pair{view, stereo};
      const bool is_beside = stereo == StereoLayout::kSideBySide;
      EXPECT_EQ(pair.eyes(), 2);
      EXPECT_EQ(pair.eye_size().x, one.eye_size().x / (is_beside ? 2 : 1));
      EXPECT_EQ(pair.eye_size().y, one.eye_size().y / (is_beside ? 1 : 2));
      EXPECT_GT(pair.image_area().width, width - 2);
      EXPECT_GT(pair.image_area().height, height - 2);
      for (int eye = 0; eye < 2; ++eye) {
        const ViewArea area = pair.eye_area(eye);
        for (const auto& [right, down] : {std::pair{0.0, 0.0}, {0.25, 0.5}, {0.99, 0.99}}) {
          const glm::dvec2 xy{right * area.width, down * area.height};
          const glm::dvec2 cursor{area.x + xy.x, area.y + xy.y};
          EXPECT_EQ(pair.eye_at(cursor), eye);
          ASSERT_TRUE(pair.camera_xy(cursor));
          EXPECT_LT(glm::length(*pair.camera_xy(cursor) - xy), 1e-9);
          const glm::dvec2 between = pair.xy_of(1 - eye, cursor) - xy;
          EXPECT_NEAR(std::abs(is_beside ? between.x : between.y), is_beside ? area.width : area.height, 1e-9);
        }
      }
      EXPECT_FALSE(pair.camera_xy({view.x - 1, view.y + 1}));
      EXPECT_FALSE(pair.camera_xy({view.x + 1, view.y + height + 1}));
    }
  }
}

class StereoTest : public ExploreWindowTest {
 protected:
  void choose(const std::string& name) {
    click("View");
    iterate(2);
    click("##eyes");
    click("##eyes=" + name);
    settle();
  }
  core::RgbImage captured() {
    core::RgbImage image;
    window_->capture(&image);
    for (int n = 0; n < 100 && image.pixels.empty(); ++n) key("Shift_L");
    window_->capture(nullptr);
    EXPECT_FALSE(image.pixels.empty());
    return image;
  }
  // Returns the views of both eyes.
  std::array<core::View, 2> eyes() {
    const double base_m = window_->drawn()->request.eye_base_m;
    return {core::eye_view(window_->session().view(), -base_m / 2, std::nullopt),
            core::eye_view(window_->session().view(), base_m / 2, std::nullopt)};
  }
  // Returns whether pixels of a colour are near a point of the world in an eye's image, which begins at `left`.
  static bool is_marked(const core::RgbImage& image, const core::View& eye, const glm::dvec3& point_m, int left,
                        base::Rgb colour) {
    const core::Projected p = core::project(eye, point_m);
    if (p.behind) return false;
    int count = 0;
    for (int dy = -2; dy <= 2; ++dy)
      for (int dx = -2; dx <= 2; ++dx) {
        const int x = left + static_cast<int>(std::lround(p.xy.x)) + dx;
        const int y = static_cast<int>(std::lround(p.xy.y)) + dy;
        if (x < 0 || y < 0 || x >= image.width || y >= image.height) return false;
        const base::Rgb pixel = image.pixels[static_cast<std::size_t>(y * image.width + x)];
        const int off =
            std::abs(pixel.r - colour.r) + std::abs(pixel.g - colour.g) + std::abs(pixel.b - colour.b);
        count += off < 30 ? 1 : 0;
      }
    return count >= 6;
  }
};

TEST_F(StereoTest, EachEyeOfAPairFillsItsHalfOfTheView) {
  open();
  window_->session().put({20, 10, 30'000, 0, -35, 0});
  for (const auto& [name, layout] :
       {std::pair{"side by side", StereoLayout::kSideBySide}, {"over and under", StereoLayout::kOverUnder}}) {
    choose(name);
    key("h");  // nothing lies over the view
    settle();
    const bool is_beside = layout == StereoLayout::kSideBySide;
    EXPECT_EQ(window_->session().screen().width, is_beside ? 480 : 960);
    EXPECT_EQ(window_->session().screen().height, is_beside ? 540 : 270);
    const core::RgbImage& image = window_->image();
    ASSERT_EQ(image.width, 960);
    ASSERT_EQ(image.height, 540);
    const core::RgbImage shown = captured();
    ASSERT_EQ(shown.pixels.size(), image.pixels.size());
    int off = 0;
    for (std::size_t n = 0; n < image.pixels.size(); ++n) {
      off = std::max(off, std::abs(shown.pixels[n].r - image.pixels[n].r));
      off = std::max(off, std::abs(shown.pixels[n].g - image.pixels[n].g));
    }
    EXPECT_LE(off, 1) << name;
    key("h");
    settle();
  }
}

TEST_F(StereoTest, MarksAreInTheImageOfEachEye) {
  explore::Hotspot hotspot;
  hotspot.name = "Ridge";
  hotspot.place = {20, 10.15};
  hotspot.height_m = 2500;
  extra_.hotspots = {hotspot};
  open(1290, 540);
  const double ground_m = window_->session().ground().height_m(mars::direction({20, 10}));
  window_->session().put({20, 10, ground_m + 3000, 0, -25, 0});
  choose("side by side");
  ASSERT_EQ(window_->session().screen().width, 480);
  const int left = 330;
  // A place of a measurement, in the left eye's image; one of a drawing, in the right eye's.
  move(left + 200, 300);
  key("m");
  click("Draw");
  iterate(2);
  click("Point");
  click(left + 480 + 320, 330);
  key("Escape");
  // A pose of a flight in front of the camera.
  scripts::Flight flight;
  flight.waypoints.resize(2);
  for (int n = 0; n < 2; ++n) {
    scripts::Waypoint& w = flight.waypoints[static_cast<std::size_t>(n)];
    w.time_s = 10 * n;
    w.lon_deg = 19.97 + 0.06 * n;
    w.lat_deg = 10.12;
    w.up_m = ground_m + 2200;
  }
  ASSERT_EQ(window_->session().flights().load(flight), "");
  move(left + 100, 20);
  settle();
  const core::RgbImage shown = captured();
  const double radius_m = window_->session().ground().radius_m;
  const auto on_ground = [&](mars::LonLat place) {
    const glm::dvec3 d = mars::direction(place);
    return d * (radius_m + window_->session().ground().height_m(d));
  };
  const std::array<core::View, 2> eye = eyes();
  const auto& drawings = window_->drawing().drawings().all();
  ASSERT_EQ(drawings.size(), 1U);
  const mars::LonLat drawn = drawings[0]->vertices[0];
  const glm::dvec2 click_xy = core::project(eye[1], on_ground(drawn)).xy;
  EXPECT_LT(glm::length(click_xy - glm::dvec2(320, 330)), 0.1) << "the right eye's ground was clicked";
  ASSERT_EQ(window_->measure().points().size(), 1U);
  const mars::LonLat measured = window_->measure().points()[0];
  EXPECT_LT(glm::length(core::project(eye[0], on_ground(measured)).xy - glm::dvec2(200, 300)), 0.1);
  const auto pose_m = [&](const scripts::Waypoint& w) {
    return mars::direction({w.lon_deg, w.lat_deg}) * (radius_m + w.up_m);
  };
  const double hotspot_m =
      radius_m + window_->session().ground().height_m(mars::direction(hotspot.place)) + 2500;
  const struct {
    const char* what;
    glm::dvec3 point_m;
    base::Rgb colour;
  } marks[] = {{"measure", on_ground(measured), {255, 214, 90}},
               {"drawing", on_ground(drawn), drawings[0]->colour},
               {"pose", pose_m(flight.waypoints[0]), {255, 214, 90}},
               {"hotspot", mars::direction(hotspot.place) * hotspot_m, {120, 220, 255}}};
  for (const auto& mark : marks) {
    for (int n = 0; n < 2; ++n)
      EXPECT_TRUE(is_marked(shown, eye[static_cast<std::size_t>(n)], mark.point_m, left + 480 * n, mark.colour))
          << mark.what << " of eye " << n;
    const double disparity_px =
        core::project(eye[0], mark.point_m).xy.x - core::project(eye[1], mark.point_m).xy.x;
    EXPECT_GT(disparity_px, 4) << mark.what << ": the eyes see it at different places";
  }
}

// The size in a log is that of both images together, as in films.
// The ground under the cursor is held, zoomed to and flown to in the image of the eye that the cursor is in.
TEST_F(StereoTest, TheMouseActsInTheImageOfTheEyeItIsIn) {
  open(1290, 540);
  const double ground_m = window_->session().ground().height_m(mars::direction({20, 10}));
  window_->session().put({20, 10, ground_m + 3000, 30, -35, 0});
  choose("side by side");
  for (const int eye : {0, 1}) {
    const ViewArea area = ImageLayout{{330, 0, 960, 540}, StereoLayout::kSideBySide}.eye_area(eye);
    const glm::dvec2 from{area.x + 160, 300};
    move(from.x, from.y);
    settle();
    const auto held =
        window_->session().place_at(eyes()[static_cast<std::size_t>(eye)], from - glm::dvec2(area.x, area.y));
    ASSERT_TRUE(held);
    const glm::dvec3 up = mars::direction(*held);
    const glm::dvec3 held_m =
        up * (window_->session().ground().radius_m + window_->session().ground().height_m(up));
    const auto off_px = [&](glm::dvec2 cursor) {
      const core::View view = eyes()[static_cast<std::size_t>(eye)];
      return glm::length(core::project(view, held_m).xy + glm::dvec2(area.x, area.y) - cursor);
    };
    EXPECT_LT(off_px(from), 1e-3) << eye;
    // Between the eyes it is elsewhere, so that holding it there would not do.
    const glm::dvec2 middle = core::project(window_->session().view(), held_m).xy + glm::dvec2(area.x, area.y);
    EXPECT_GT(glm::length(middle - from), 3) << eye;
    robot_->press();
    iterate(2);
    for (int n = 1; n <= 6; ++n) move(from.x + 12 * n, from.y + 15 * n);
    settle();
    EXPECT_LT(off_px(from + glm::dvec2(72, 90)), 0.05) << eye;
    robot_->release();
    settle();
    robot_->wheel(2);
    iterate(5);
    settle();
    EXPECT_LT(off_px(from + glm::dvec2(72, 90)), 3) << eye;
  }
}

TEST_F(StereoTest, TheLogHasTheSizeOfTheWholeView) {
  open();
  choose("side by side");
  ASSERT_EQ(window_->act({explore::ActionKind::kRecord}), "");
  window_->session().set_fov(33);
  iterate(20);
  settle();
  ASSERT_EQ(window_->act({explore::ActionKind::kRecord}), "");
  std::filesystem::path log;
  for (const auto& entry : std::filesystem::directory_iterator(folder_.path()))
    if (entry.path().extension() == ".flight") log = entry.path();
  const scripts::ParsedFlight parsed = read_flight_file(log);
  ASSERT_TRUE(parsed.flight);
  EXPECT_EQ(parsed.flight->view.width, 630);
  EXPECT_EQ(parsed.flight->view.height, window_->session().screen().height);
  const scripts::Path path(*parsed.flight, planet_->radius_m(), {});
  const auto size = path.at(path.duration_s()).view.size;
  EXPECT_EQ(size.value_or(scripts::ImageSize{630, 0}).width, 630);
}

}  // namespace
}  // namespace vpe::window
