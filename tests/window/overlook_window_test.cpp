// Tests of the window of `vpe overlook` with simulated mouse and keys on a virtual screen.
#include "vpe/window/overlook_window.h"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <array>
#include <cmath>
#include <fstream>

#include "panorama/metadata/sidecar.h"
#include "panorama/viewer/render_view.h"
#include "tests/support/support.h"
#include "tests/window/window_fixture.h"
#include "vpe/app/panorama/overlook_places.h"
#include "vpe/app/panorama/panorama_painter.h"
#include "vpe/base/file.h"

namespace vpe::window {
namespace {

namespace fs = std::filesystem;
using panorama::Direction;
using panorama::PanoramaMap;

const PanoramaMap kCylinder = panorama::cylinder_map(1440, 480, 1440, 30.0, 240.0);
const PanoramaMap kFacets = panorama::faceted_map(8, 180, 400, 22.5, 200.0);

vpe::base::Rgb colour_of(const Direction& d) {
  const double a = d.azimuth_deg * mars::kRadiansPerDegree;
  const auto byte = [](double share) { return static_cast<std::uint8_t>(std::lround(255 * share)); };
  return {byte(0.5 + 0.5 * std::sin(a)), byte(0.5 + 0.5 * std::cos(a)), byte(0.5 + d.elevation_deg / 180)};
}

std::vector<vpe::base::Rgb> pixels_of(const PanoramaMap& map, double rotated_deg = 0) {
  std::vector<vpe::base::Rgb> pixels;
  for (std::int64_t y = 0; y < map.height_px; ++y) {
    for (std::int64_t x = 0; x < map.width_px; ++x) {
      Direction d = map.to_direction(static_cast<double>(x) + 0.5, static_cast<double>(y) + 0.5);
      d.azimuth_deg += rotated_deg;
      pixels.push_back(colour_of(d));
    }
  }
  return pixels;
}

class OverlookWindowTest : public WindowTest<OverlookWindow> {
 protected:
  void SetUp() override {
    WindowTest::SetUp();
    preferences_.use_space_mouse = false;
    pad_ = [] { return std::nullopt; };
  }

  fs::path write(const PanoramaMap& map, const std::string& name) {
    core::write_image(folder_ / name, pixels_of(map), static_cast<int>(map.width_px),
                      static_cast<int>(map.height_px));
    const fs::path json = (folder_ / name).replace_extension(".json");
    base::write_file(json, panorama::to_text({name, map, {}}));
    return json;
  }

  struct Opening {
    // Small, as pixels are made by the processor here.
    int width = 640;
    int height = 400;
    std::optional<Direction> look;
    double fov_deg = 60;
    std::optional<core::StereoLayout> stereo;
  };
  static Opening looking(const Direction& look) {
    Opening how;
    how.look = look;
    return how;
  }
  void open(const fs::path& json) { open(json, Opening()); }
  void open(const fs::path& json, const Opening& how) {
    const app::PanoramaFiles files{json.string(), {}, {}};
    OverlookWindowSetup setup;
    setup.view = app::overlook_setup(files, std::size_t{64} << 20, 2, graphics_);
    setup.view.look = how.look;
    setup.view.fov_deg = how.fov_deg;
    setup.view.stereo = how.stereo;
    setup.view.images = folder_.path();
    setup.display.width = how.width;
    setup.display.height = how.height;
    setup.display.scale = how.width > 2000 ? 2 : 1;
    setup.preferences = preferences_;
    setup.devices.pad = [this] { return pad_(); };
    window_.reset();
    window_ = std::make_unique<OverlookWindow>(std::move(setup));
    focus();
  }

  void drag(glm::dvec2 from, glm::dvec2 to) {
    move(from.x, from.y);
    robot_->press();
    iterate(2);
    for (int n = 1; n <= 3; ++n) {
      const glm::dvec2 at = from + (to - from) * (n / 3.0);
      move(at.x, at.y);
    }
    robot_->release();
    settle();
  }
  void key(const std::string& name) {
    WindowTest::key(name);
    settle();
  }
  core::RgbImage screenshot() {
    core::RgbImage image;
    window_->capture(&image);
    robot_->key("shift");  // any event draws a frame
    for (int n = 0; n < 100 && image.pixels.empty(); ++n) window_->step(0.01);
    return image;
  }
  const panorama::Viewer& viewer() { return window_->view().viewer(); }
  Direction under(double x, double y) { return viewer().direction(x, y); }

  explore::Preferences preferences_;
  app::OverlookGraphics graphics_ = app::OverlookGraphics::kAuto;
  std::function<std::optional<explore::PadState>()> pad_;
};

void expect_same(const Direction& a, const Direction& b, double within_deg) {
  EXPECT_NEAR(std::remainder(a.azimuth_deg - b.azimuth_deg, 360.0), 0.0, within_deg);
  EXPECT_NEAR(a.elevation_deg, b.elevation_deg, within_deg);
}

TEST_F(OverlookWindowTest, ShowsEachDirectionAtItsPixelAndThenDrawsNothing) {
  for (const PanoramaMap& map : {kCylinder, kFacets}) {
    open(write(map, "a.png"));
    ASSERT_NE(window_->view().drawn(), nullptr);
    const core::RgbImage shown = screenshot();
    ASSERT_EQ(shown.width, 640);
    ASSERT_EQ(shown.height, 400);
    for (int y = 50; y < viewer().size().y; y += 17) {
      for (int x = 5; x < 640; x += 31) {
        const vpe::base::Rgb got = shown.pixels[static_cast<std::size_t>(y * 640 + x)];
        const vpe::base::Rgb right = colour_of(under(x + 0.5, y + 0.5));
        EXPECT_NEAR(got.r, right.r, 3) << x << "," << y;
        EXPECT_NEAR(got.g, right.g, 3) << x << "," << y;
        EXPECT_NEAR(got.b, right.b, 3) << x << "," << y;
      }
    }
    settle();
    const std::int64_t frames = window_->frames();
    const std::int64_t images = window_->view().images();
    for (int n = 0; n < 50; ++n) window_->step(0.001);
    EXPECT_EQ(window_->frames(), frames);
    EXPECT_EQ(window_->view().images(), images);
  }
}

TEST_F(OverlookWindowTest, ADragHoldsTheDirectionAroundTheFullCircle) {
  for (const PanoramaMap& map : {kCylinder, kFacets}) {
    open(write(map, "a.png"));
    const double begun_deg = viewer().yaw_deg();
    const bool all_around = map.kind == panorama::MapKind::kCylinder;
    for (int n = 0; n < (all_around ? 6 : 2); ++n) {
      const double y = n % 2 == 0 ? 160 : 150;
      const Direction held = under(560, 155);
      drag({560, 155}, {40, y});
      expect_same(under(40, y), held, 1e-6);
    }
    if (all_around) {
      EXPECT_GT(viewer().yaw_deg(), begun_deg + 360.0);  // and on
    }
    const core::View& view = window_->view().drawn()->request.draw.view;
    EXPECT_EQ(view.height, viewer().size().y);
    EXPECT_EQ(view.camera.axes.forward, viewer().view().camera.axes.forward);
  }
}

TEST_F(OverlookWindowTest, EndsAtTheImagesEdges) {
  for (const PanoramaMap& map : {kCylinder, kFacets}) {
    open(write(map, "a.png"));
    const panorama::ElevationRange seen = panorama::elevations_of(map);
    drag({320, 50}, {320, 330});
    EXPECT_NEAR(under(320, 0).elevation_deg, seen.high_deg, 1e-6);
    drag({320, 330}, {320, 50});
    EXPECT_NEAR(under(320, viewer().size().y).elevation_deg, seen.low_deg, 1e-6);
  }
}

TEST_F(OverlookWindowTest, TheWheelZoomsAtTheCursor) {
  open(write(kCylinder, "a.png"));
  move(450, 220);
  settle();
  const Direction before = under(450, 220);
  const double wide = std::tan(viewer().fov_deg() / 2 * mars::kRadiansPerDegree);
  robot_->wheel(3);
  iterate(5);
  settle();
  expect_same(under(450, 220), before, 1e-6);
  EXPECT_NEAR(std::tan(viewer().fov_deg() / 2 * mars::kRadiansPerDegree),
              wide / std::pow(OverlookView::kZoomStep, 3), 1e-9);
  robot_->wheel(40);
  iterate(5);
  settle();
  EXPECT_EQ(viewer().fov_deg(), viewer().min_fov_deg());
}

TEST_F(OverlookWindowTest, KeysRotateAndZoom) {
  open(write(kCylinder, "a.png"), looking(Direction{100, 5}));
  move(320, 150);
  robot_->key_down("Right");
  iterate(10);
  robot_->key_up("Right");
  settle();
  EXPECT_GT(viewer().yaw_deg(), 100.0);
  EXPECT_EQ(viewer().pitch_deg(), 5.0);
  robot_->key_down("Down");
  iterate(10);
  robot_->key_up("Down");
  settle();
  EXPECT_LT(viewer().pitch_deg(), 5.0);
  key("n");
  EXPECT_NEAR(std::remainder(viewer().yaw_deg(), 360.0), 0.0, 1e-9);
  key("plus");
  EXPECT_LT(viewer().fov_deg(), 60.0);
  key("0");
  EXPECT_EQ(viewer().fov_deg(), 60.0);
  key("minus");
  EXPECT_GT(viewer().fov_deg(), 60.0);
  key("r");
  EXPECT_EQ(viewer().yaw_deg(), 100.0);
  EXPECT_EQ(viewer().pitch_deg(), 5.0);
  EXPECT_EQ(viewer().fov_deg(), 60.0);
}

TEST_F(OverlookWindowTest, CompassMarksStandAtTheirAzimuths) {
  for (const double pitch_deg : {0.0, 12.0}) {
    open(write(kCylinder, "a.png"), looking(Direction{350, pitch_deg}));
    const core::RgbImage shown = screenshot();
    const std::vector<overlay::PlacedMark> marks = window_->view().compass();
    ASSERT_GT(marks.size(), 6U);
    const double row = viewer().size().y / 2.0;
    for (const overlay::PlacedMark& placed : marks) {
      const Direction there{placed.mark.azimuth_deg, under(placed.at.x, row).elevation_deg};
      const auto at = viewer().screen(there);
      ASSERT_TRUE(at.has_value());
      EXPECT_NEAR(at->x, placed.at.x, 1.0) << placed.mark.azimuth_deg;
      EXPECT_NEAR(at->y, row, 1.0);
      // And on the screen: the brightest of the first row's neighbourhood is the tick.
      if (placed.at.x < 8 || placed.at.x > 632) continue;
      int brightest = 0;
      int brightest_x = 0;
      for (int x = static_cast<int>(placed.at.x) - 6; x <= static_cast<int>(placed.at.x) + 6; ++x) {
        const vpe::base::Rgb& p = shown.pixels[static_cast<std::size_t>(640 + x)];
        if (p.r + p.g + p.b <= brightest) continue;
        brightest = p.r + p.g + p.b;
        brightest_x = x;
      }
      EXPECT_NEAR(brightest_x + 0.5, placed.at.x, 1.01) << placed.mark.azimuth_deg;
      EXPECT_GT(brightest, 450);
    }
  }
}

TEST_F(OverlookWindowTest, TheReadOutIsThatOfTheCommandLine) {
  const fs::path json_path = write(kCylinder, "a.png");
  std::vector<float> range;
  for (int n = 0; n < 1440 * 480; ++n) range.push_back(n < 1440 * 240 ? NAN : static_cast<float>(n % 1440));
  core::write_tiff(folder_ / "a.range.tif", range, 1440, 480);
  auto json = nlohmann::json::parse(panorama::to_text({"a.png", kCylinder, {}}));
  json["planes"] = {{"range", "a.range.tif"}};
  base::write_file(json_path, json.dump());
  open(json_path);
  int ground = 0;
  for (const glm::dvec2 at : {glm::dvec2{100, 250}, {320, 320}, {600, 200}, {350, 50}}) {
    move(at.x, at.y);
    settle();
    const auto reading = window_->view().reading();
    ASSERT_TRUE(reading && reading->place);
    expect_same(reading->direction, under(at.x, at.y), 1e-9);
    const panorama::ProbeResult told = app::probe_direction(window_->view().panorama(), under(at.x, at.y));
    EXPECT_EQ(app::csv_line(*reading->place), app::csv_line(told));
    const bool is_ground = reading->direction.elevation_deg < 0;
    ground += is_ground ? 1 : 0;
    ASSERT_EQ(reading->place->values.size(), 1U);
    EXPECT_EQ(reading->place->values[0].name, "range_m");
    ASSERT_EQ(reading->place->values[0].value.has_value(), is_ground);
    if (is_ground) {
      EXPECT_EQ(*reading->place->values[0].value, std::floor(reading->place->x));
    }
  }
  EXPECT_EQ(ground, 3);
  move(320, 390);  // over the bar
  EXPECT_FALSE(window_->view().reading().has_value());
}

TEST_F(OverlookWindowTest, AHeadTrackerRotatesItAndReturns) {
  preferences_.use_head_tracker = true;
  preferences_.head_from.port = 0;
  open(write(kCylinder, "a.png"), looking(Direction{100, 0}));
  ASSERT_TRUE(window_->devices().tracker_port().has_value());
  const int out = socket(AF_INET, SOCK_DGRAM, 0);
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(static_cast<std::uint16_t>(*window_->devices().tracker_port()));
  to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  const auto send_look = [&](double yaw_deg, double pitch_deg) {
    const std::array<double, 6> numbers{0, 0, 0, yaw_deg, pitch_deg, 20};
    ASSERT_EQ(sendto(out, numbers.data(), sizeof numbers, 0, reinterpret_cast<const sockaddr*>(&to), sizeof to),
              static_cast<ssize_t>(sizeof numbers));
  };
  const auto turn_until = [&](double yaw_deg, double pitch_deg, bool sends) {
    for (int n = 0; n < 1000; ++n) {
      if (sends) send_look(yaw_deg - 100, pitch_deg);
      iterate(1);
      if (std::abs(viewer().yaw_deg() - yaw_deg) < 0.01 && std::abs(viewer().pitch_deg() - pitch_deg) < 0.01)
        return;
    }
    ADD_FAILURE() << "looks to " << viewer().yaw_deg() << "," << viewer().pitch_deg();
  };
  turn_until(130, 8, true);
  EXPECT_NEAR(viewer().roll_deg(), 20, 0.1);
  turn_until(100, 0, false);  // nothing is sent any more
  EXPECT_NEAR(viewer().roll_deg(), 0, 0.1);
  close(out);
}

TEST_F(OverlookWindowTest, AGamepadRotatesIt) {
  open(write(kCylinder, "a.png"), looking(Direction{100, 0}));
  explore::PadState pad;
  pad.axes[static_cast<std::size_t>(explore::PadAxis::kRightX)] = 1;
  pad_ = [&pad] { return pad; };
  iterate(10);
  pad_ = [] { return std::nullopt; };
  settle();
  EXPECT_GT(viewer().yaw_deg(), 100.0);
  const double yaw_deg = viewer().yaw_deg();
  iterate(10);
  EXPECT_EQ(viewer().yaw_deg(), yaw_deg);
}

TEST_F(OverlookWindowTest, PairsInEveryLayout) {
  std::vector<vpe::base::Rgb> both = pixels_of(kCylinder);
  const std::vector<vpe::base::Rgb> right = pixels_of(kCylinder, 40);
  both.insert(both.end(), right.begin(), right.end());
  core::write_image(folder_ / "ou.png", both, 1440, 960);
  auto json = nlohmann::json::parse(panorama::to_text({"ou.png", kCylinder, {}}));
  json["stereo"] = "ou";
  base::write_file(folder_ / "ou.json", json.dump());
  Opening anaglyph;
  anaglyph.stereo = core::StereoLayout::kAnaglyph;
  graphics_ = app::OverlookGraphics::kOff;  // which is exact
  open(folder_ / "ou.json", anaglyph);
  const auto drawn = panorama::open_tiled_image(folder_ / "ou.png", panorama::ImageFileFormat::kPng, {});
  const auto expected = [&] {
    panorama::RenderViewOptions options;
    const core::RgbImage left = panorama::render_view(*drawn, kCylinder, viewer().view(), options);
    options.origin.y_px = kCylinder.height_px;
    return core::combine_stereo(left, panorama::render_view(*drawn, kCylinder, viewer().view(), options),
                                *window_->view().stereo());
  };
  EXPECT_EQ(window_->view().drawn()->image.pixels, expected().pixels);
  for (const auto& [name, size] : {std::pair{"side by side", glm::ivec2{320, 348}},
                                   {"over and under", glm::ivec2{640, 174}},
                                   {"red and cyan", glm::ivec2{640, 348}}}) {
    click("##eyes");
    click("##eyes=" + std::string(name));
    settle();
    EXPECT_EQ(viewer().size(), size) << name;
    EXPECT_EQ(window_->view().drawn()->image.pixels, expected().pixels) << name;
  }
  // The halves show the same directions.
  click("##eyes");
  click("##eyes=side by side");
  move(50, 150);
  const auto in_left = window_->view().reading();
  move(370, 150);
  const auto in_right = window_->view().reading();
  ASSERT_TRUE(in_left && in_right);
  expect_same(in_left->direction, in_right->direction, 1e-9);
  const Direction held = under(300, 150);
  drag({300, 150}, {350, 155});  // over the border between the halves
  expect_same(under(350, 155), held, 1e-6);
  const auto after = window_->view().reading();
  ASSERT_TRUE(after.has_value());
  expect_same(after->direction, under(30, 155), 1e-9);  // of the half that the cursor is in
}

TEST_F(OverlookWindowTest, HidesHelpsSavesAndCloses) {
  open(write(kCylinder, "a.png"));
  EXPECT_LT(viewer().size().y, 400);
  key("h");
  EXPECT_EQ(viewer().size().y, 400);
  EXPECT_TRUE(window_->widgets().places().empty());
  key("h");
  EXPECT_LT(viewer().size().y, 400);
  key("F12");
  key("F12");
  EXPECT_FALSE(window_->view().message_is_error());
  EXPECT_NE(window_->view().message().find("a-view-2.png"), std::string::npos) << window_->view().message();
  for (const char* name : {"a-view-1.png", "a-view-2.png"})
    EXPECT_EQ(core::read_image(folder_ / name).pixels, window_->view().drawn()->image.pixels);
  key("F1");
  key("Escape");  // the help
  EXPECT_FALSE(window_->display().should_close());
  robot_->key("Escape");
  bool open = true;
  for (int n = 0; n < 100 && open; ++n) open = window_->step(0.01);
  EXPECT_FALSE(open);
}

TEST_F(OverlookWindowTest, MovesInSmallerImagesWhenTimeIsShort) {
  preferences_.draw_budget_ms = 1e-3;
  open(write(kCylinder, "a.png"));
  move(150, 150);
  robot_->press();
  iterate(2);
  int smallest = viewer().size().y;
  for (int n = 1; n <= 20; ++n) {
    move(150 + 10 * n, 150);
    smallest = std::min(smallest, window_->view().drawn()->request.draw.view.height);
  }
  robot_->release();
  settle();
  EXPECT_LT(smallest, viewer().size().y);
  EXPECT_EQ(window_->view().drawn()->request.draw.view.height, viewer().size().y);
}

TEST_F(OverlookWindowTest, ADamagedImageIsReported) {
  const fs::path json = write(kCylinder, "bad.png");
  std::fstream file(folder_ / "bad.png", std::ios::in | std::ios::out | std::ios::binary);
  file.seekp(static_cast<std::streamoff>(fs::file_size(folder_ / "bad.png") / 2));
  file << "not what was here";
  file.close();
  open(json);
  EXPECT_TRUE(window_->view().message_is_error());
  EXPECT_NE(window_->view().message().find("bad.png"), std::string::npos) << window_->view().message();
  EXPECT_EQ(window_->view().drawn(), nullptr);
}

TEST_F(OverlookWindowTest, NothingOverlaps) {
  for (const auto& [width, height] : {std::pair{1280, 720}, std::pair{2560, 1440}}) {
    Opening how;
    how.width = width;
    how.height = height;
    open(write(kCylinder, "a.png"), how);
    EXPECT_GE(window_->widgets().places().size(), 3U);
    const auto& places = window_->widgets().places();
    for (auto a = places.begin(); a != places.end(); ++a) {
      EXPECT_GE(a->second.y0, viewer().size().y) << a->first;
      EXPECT_LE(a->second.x1, width) << a->first;
      EXPECT_LE(a->second.y1, height) << a->first;
      for (auto b = std::next(a); b != places.end(); ++b) {
        const double w = std::min(a->second.x1, b->second.x1) - std::max(a->second.x0, b->second.x0);
        const double h = std::min(a->second.y1, b->second.y1) - std::max(a->second.y0, b->second.y0);
        EXPECT_FALSE(w > 1 && h > 1) << a->first << " and " << b->first << " at " << width;
      }
    }
  }
}

// An image that does not fit into memory is copied into the cache; closing the window stops that.
TEST(PanoramaPainterTest, StopsCopyingWhenNobodyWantsIt) {
  const test_support::TempDir folder;
  setenv("XDG_CACHE_HOME", (folder / "cache").c_str(), 1);
  const PanoramaMap map = panorama::cylinder_map(1440, 1440, 1440, 0, 720);
  core::write_image(folder / "a.png", pixels_of(map), 1440, 1440);
  base::write_file(folder / "a.json", panorama::to_text({"a.png", map, {}}));
  OverlookSetup setup = app::overlook_setup({(folder / "a.json").string(), {}, {}},
                                            panorama::TiledImageOptions::kMinBudget_bytes, 1);
  ImageRequest request;
  request.draw.view = panorama::view_of(0, 0, 60, 64, 36);
  const auto painter = setup.make_painter();
  setup.copying->stop = true;
  EXPECT_THROW(painter->paint(request), std::exception);
  const fs::path kept = folder / "cache" / "vpe" / "pictures";
  EXPECT_TRUE(!fs::exists(kept) || fs::is_empty(kept));
  setup.copying->stop = false;
  EXPECT_EQ(painter->paint(request).image.width, 64);
  EXPECT_FALSE(fs::is_empty(kept));
  unsetenv("XDG_CACHE_HOME");
}

}  // namespace
}  // namespace vpe::window
