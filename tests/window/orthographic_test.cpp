// Tests of the orthographic camera in the explore window.
#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include "tests/window/explore_window_fixture.h"
#include "vpe/explore/orthographic.h"

namespace vpe::window {
namespace {

class OrthographicTest : public ExploreWindowTest {
 protected:
  explore::Session& session() { return window_->session(); }
  double shown_m() {
    return explore::shown_height_m(session().pose(), session().screen(), session().ground()).value();
  }
};

TEST_F(OrthographicTest, AKeyAndThePanelSwitchIt) {
  open();
  session().put({10, 20, 200'000, 30, -60, 0});
  settle();
  const mars::LonLat middle = under(left() + session().view().width / 2.0, 270);
  const double before_m = shown_m();
  key("o");
  settle();
  ASSERT_TRUE(session().is_orthographic());
  EXPECT_NEAR(shown_m(), before_m, 0.01 * before_m);
  const mars::LonLat now = under(left() + session().view().width / 2.0, 270);
  EXPECT_LT(mars::distance_rad(middle, now) * session().ground().radius_m, 0.005 * before_m);
  EXPECT_NE(window_->state().message.find("orthographic"), std::string::npos);
  EXPECT_TRUE(window_->shows_final_image());
  click("View");
  iterate(2);
  click("Orthographic");
  settle();
  EXPECT_FALSE(session().is_orthographic());
  EXPECT_NEAR(session().pose().alt_m, 200'000, 2000);
}

TEST_F(OrthographicTest, SkyInTheMiddleIsAnswered) {
  open();
  session().put({10, 20, 200'000, 30, 20, 0});
  settle();
  key("o");
  EXPECT_FALSE(session().is_orthographic());
  EXPECT_NE(window_->state().message.find("sky"), std::string::npos) << window_->state().message;
}

// The ground shows no perspective: equal steps on a plane across the line of sight are equal steps in the image.
TEST_F(OrthographicTest, BothBackendsShowTheGroundByParallelRays) {
  for (const core::Backend backend : {core::Backend::kRay, core::Backend::kPolygon}) {
    open(960, 540, backend);
    session().put({10, 20, 300'000, 0, -90, 0});
    settle();
    key("o");
    settle();
    ASSERT_TRUE(window_->shows_final_image());
    const core::View view = session().view();
    const double m_px = shown_m() / view.height;
    const glm::dvec3 middle = explore::ground_at(session().pose(), session().screen(),
                                                 {view.width / 2.0, view.height / 2.0}, session().ground())
                                  .value();
    const auto& axes = view.camera.axes;
    const double depth_m = 20'000;
    for (const double x : {-200.0, 0.0, 250.0}) {
      for (const double y : {-150.0, 100.0}) {
        const auto place = session().place_at({view.width / 2.0 + x, view.height / 2.0 + y});
        ASSERT_TRUE(place);
        const glm::dvec3 up = mars::direction(*place);
        const glm::dvec3 ground = up * (session().ground().radius_m + session().ground().height_m(up));
        const glm::dvec3 off = ground - middle;
        const double bound_px = explore::parallel_shift_px(session().screen(), shown_m(), depth_m) + 0.1;
        EXPECT_NEAR(glm::dot(off, axes.right) / m_px, x, bound_px);
        EXPECT_NEAR(-glm::dot(off, axes.up) / m_px, y, bound_px);
      }
    }
    window_.reset();
  }
}

}  // namespace
}  // namespace vpe::window
