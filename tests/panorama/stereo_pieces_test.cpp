// Pieces of panoramas for two eyes against the definition: every pixel has eyes of its own.
#include "panorama/stereo_pieces.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <random>
#include <string>

#include "panorama/planes.h"
#include "tests/panorama/stereo_fixture.h"

namespace panorama {
namespace {

using test_support::TwoEyes;
using vpe::core::StereoLayout;

const mars::Pose kPose{137.4, -4.6, 2000, 0, 0, 0};
const Viewpoint kViewpoint = viewpoint_of(kPose, mars::kMarsRadius_m);

PanoramaMap map_with(MapKind kind, std::int64_t width_px, double lowest_deg, double highest_deg) {
  PlanOptions options;
  options.kind = kind;
  options.width_px = width_px;
  options.yaw_deg = 33;
  options.lowest_deg = lowest_deg;
  options.highest_deg = highest_deg;
  return plan_panorama(options).map;
}

const Piece* piece_at(const std::vector<Piece>& pieces, std::int64_t x, std::int64_t y) {
  const auto found = std::find_if(pieces.begin(), pieces.end(), [&](const Piece& p) {
    return x >= p.x && x < p.x + p.width && y >= p.y && y < p.y + p.height;
  });
  return found == pieces.end() ? nullptr : &*found;
}

// How far a pixel is from where its own eye sees what it shows at a range.
glm::dvec2 off_px(const PanoramaMap& map, const TwoEyes& eyes, Eye eye, const Piece& piece, std::int64_t x,
                  std::int64_t y, double range_m) {
  const glm::dvec3 ray = line_of_sight(piece, x, y);
  const glm::dvec2 is = map.place(eyes.seen(eye, piece.view.camera.position_m + range_m * ray));
  return {std::remainder(is.x - (static_cast<double>(x) + 0.5), map.turn_px),
          is.y - (static_cast<double>(y) + 0.5)};
}

struct Worst {
  glm::dvec2 off_px{0, 0};
  glm::dvec2 step_px{0, 0};
};

Worst worst_of(const PanoramaMap& map, const EyePair& pair, Eye eye, double range_m) {
  const TwoEyes eyes(kPose, mars::kMarsRadius_m, pair.base_m);
  std::mt19937 random(7);
  Worst worst;
  // The full circle at once, so that neighbours across strips are found.
  const auto pieces =
      eye_pieces_of(map, kViewpoint, stereo_bands(map, pair), eye, {0, static_cast<int>(map.width_px)});
  const auto off = [&](const Piece& piece, std::int64_t x, std::int64_t y) {
    return off_px(map, eyes, eye, piece, x, y, range_m);
  };
  for (int n = 0; n < 120; ++n) {
    // Corners: errors are largest and steps are there.
    const Piece& piece = n == 0 ? pieces.back() : pieces[random() % pieces.size()];
    const std::int64_t x = piece.x + piece.width - 1;
    const std::int64_t y = piece.y + piece.height - 1;
    const glm::dvec2 here = off(piece, x, y);
    worst.off_px = glm::max(worst.off_px, glm::abs(here));
    worst.off_px = glm::max(worst.off_px, glm::abs(off(piece, piece.x, piece.y)));
    // Across the seam of 360 degrees too.
    const std::int64_t right = (x + 1) % map.width_px;
    worst.step_px = glm::max(worst.step_px, glm::abs(here - off(*piece_at(pieces, right, y), right, y)));
    if (const Piece* below = piece_at(pieces, x, y + 1))
      worst.step_px = glm::max(worst.step_px, glm::abs(here - off(*below, x, y + 1)));
  }
  return worst;
}

TEST(StereoPieces, PixelsAreWhereTheirOwnEyesSeeThem) {
  constexpr double kNearest_m = 3;
  // Second-order terms, and what comes of upright eyes.
  constexpr double kMore_px = 0.03;
  for (const double share : {1.0 / 100, 1.0 / vpe::core::kNearestToBase, kMostBase}) {
    for (const MapKind kind : {MapKind::kCylinder, MapKind::kEquirectangular}) {
      for (const std::int64_t width_px : {300, 3000}) {
        for (const double steep_deg : {20.0, 45.0, 70.0, 90.0}) {
          if (kind == MapKind::kCylinder && steep_deg > 80) continue;
          if (width_px > 1000 && steep_deg > 60 && share != 1.0 / 100) continue;  // too many pieces for a test
          const PanoramaMap map = map_with(kind, width_px, -steep_deg, 30);
          const EyePair pair{StereoLayout::kSideBySide, share * kNearest_m, kNearest_m};
          for (const double farther : {1.0, 3.0}) {
            const Eye eye = farther == 3.0 ? Eye::kLeft : Eye::kRight;
            const double range_m = farther * (kNearest_m - 0.5 * pair.base_m);
            const Worst worst = worst_of(map, pair, eye, range_m);
            const std::string which = std::string(to_string(kind)) + " of " + std::to_string(width_px) +
                                      " to " + std::to_string(steep_deg) + ", base " +
                                      std::to_string(pair.base_m) + ", range " + std::to_string(range_m);
            EXPECT_LE(worst.off_px.x, kStereoSideOff_px + kStereoFadeOff_px + kMore_px) << which;
            EXPECT_LE(worst.off_px.y, kStereoRowsOff_px + kMore_px) << which;
            EXPECT_LE(worst.step_px.x, kStereoStep_px + kMore_px) << which;
            EXPECT_LE(worst.step_px.y, kStereoStep_px + kMore_px) << which;
          }
        }
      }
    }
  }
}

// The bound is not met by pieces of single pixels.
TEST(StereoPieces, AreAsLargeAsTheBoundAllows) {
  const EyePair usual{StereoLayout::kSideBySide, 0.1, 3};
  const PanoramaMap map = map_with(MapKind::kCylinder, 6000, -45, 45);
  const auto bands = stereo_bands(map, usual);
  const auto most = std::max_element(bands.begin(), bands.end(),
                                     [](const auto& a, const auto& b) { return a.columns < b.columns; });
  EXPECT_GE(most->columns, 128);  // about the horizon
  EXPECT_EQ(bands.front().columns, bands.back().columns);
  EXPECT_GE(bands.back().columns, 8);  // 10.6 by the formula
  for (const StereoBand& band : bands) EXPECT_EQ(band.base_m, 0.1);
  // As many for any size of image.
  EXPECT_EQ(stereo_bands(map_with(MapKind::kCylinder, 60000, -45, 45), usual).back().columns,
            bands.back().columns);
  const Worst worst = worst_of(map, usual, Eye::kLeft, 2.95);
  EXPECT_GT(worst.off_px.y, 0.5 * kStereoRowsOff_px);
  // Nothing is near: whole tiles, but for the fade.
  const auto sky = stereo_bands(map, {StereoLayout::kSideBySide, 0.1, std::nullopt});
  for (const StereoBand& band : sky) EXPECT_EQ(band.columns, PlanLimits::kTile_px);
}

TEST(StereoPieces, NearerGroundIsShiftedInwardsAndTheHorizonIsNot) {
  const PanoramaMap map = map_with(MapKind::kCylinder, 6000, -45, 45);
  const EyePair pair{StereoLayout::kSideBySide, 0.1, 3};
  const auto bands = stereo_bands(map, pair);
  const auto column_of = [&](Eye eye, const glm::dvec3& point_m) {
    // The piece in whose middle column the point is.
    const TwoEyes eyes(kPose, mars::kMarsRadius_m, pair.base_m);
    const glm::dvec2 at = map.place(eyes.seen(eye, point_m));
    const auto pieces = eye_pieces_of(map, kViewpoint, bands, eye, {0, 6000});
    const Piece* piece = piece_at(pieces, static_cast<std::int64_t>(at.x), static_cast<std::int64_t>(at.y));
    return vpe::core::project(piece->view, point_m).xy.x;
  };
  const TwoEyes middle(kPose, mars::kMarsRadius_m, 0);
  for (const double azimuth_deg : {40.0, 130.0, 250.0}) {
    for (const double elevation_deg : {0.0, -30.0}) {
      for (const double range_m : {3.0, 30.0, 1e9}) {
        const TwoEyes::Ray ray = middle.ray(Eye::kLeft, {azimuth_deg, elevation_deg});
        const glm::dvec3 point_m = ray.camera_m + range_m * ray.direction;
        const double level_m = range_m * std::cos(elevation_deg * mars::kRadiansPerDegree);
        EXPECT_NEAR(column_of(Eye::kLeft, point_m) - column_of(Eye::kRight, point_m),
                    0.1 * map.focal_px / level_m, 0.1)
            << azimuth_deg << " " << elevation_deg << " " << range_m;
      }
    }
  }
}

TEST(StereoPieces, EyesStandUprightUnlessThatShows) {
  const PanoramaMap map = map_with(MapKind::kCylinder, 4096, -45, 45);
  const auto tilt = [&](double base_m) {
    const EyePair pair{StereoLayout::kSideBySide, base_m, 30 * base_m};
    const auto pieces = eye_pieces_of(map, kViewpoint, stereo_bands(map, pair), Eye::kRight, {0, 256});
    const mars::CameraPose& eye = pieces.back().view.camera;
    EXPECT_NEAR(glm::dot(eye.axes.up, eye.axes.forward), 0, 1e-15);
    return glm::length(glm::cross(eye.axes.up, glm::normalize(eye.position_m)));
  };
  EXPECT_LT(tilt(0.1), 1e-15);
  EXPECT_LT(tilt(300), 1e-15);
  EXPECT_NEAR(tilt(3000), 1500 / (mars::kMarsRadius_m + 2000), 1e-9);  // 0.29 pixels at 45 degrees
}

TEST(StereoPieces, CoverTheFileOnceForEachEye) {
  PlanOptions options;
  options.width_px = 700;
  options.arc = Arc{300, 20};  // across the start of the turn
  const PanoramaMap map = plan_panorama(options).map;
  for (const StereoLayout layout :
       {StereoLayout::kSideBySide, StereoLayout::kOverUnder, StereoLayout::kAnaglyph}) {
    const EyePair pair{layout, 0.1, 3};
    const ImageSize size = size_of_pair(map, layout);
    EXPECT_EQ(size.width_px, layout == StereoLayout::kSideBySide ? 1400 : 700);
    EXPECT_EQ(size.height_px, map.height_px * (layout == StereoLayout::kOverUnder ? 2 : 1));
    std::vector<int> covered(static_cast<std::size_t>(size.width_px * size.height_px));
    std::vector<int> by_left(covered.size());
    for (std::int64_t x = 0; x < size.width_px; x += 512) {
      const Strip strip{x, static_cast<int>(std::min<std::int64_t>(512, size.width_px - x))};
      const auto pieces = pair_pieces_of(map, kViewpoint, pair, strip);
      for (std::size_t k = 0; k < pieces.size(); ++k) {
        const Piece& piece = pieces[k];
        ASSERT_EQ(vpe::core::check(piece.view), "");
        const bool is_left = layout == StereoLayout::kAnaglyph     ? k < pieces.size() / 2
                             : layout == StereoLayout::kSideBySide ? piece.x < map.width_px
                                                                   : piece.y < map.height_px;
        // It stands on that side of the middle.
        const glm::dvec3 aside_m =
            piece.view.camera.position_m - mars::to_camera(kPose, mars::kMarsRadius_m).position_m;
        const glm::dvec3 right =
            glm::cross(line_of_sight(piece, piece.x + piece.width / 2, piece.y), piece.view.camera.axes.up);
        EXPECT_EQ(glm::dot(aside_m, right) < 0, is_left);
        for (std::int64_t y = piece.y; y < piece.y + piece.height; ++y) {
          for (std::int64_t i = piece.x; i < piece.x + piece.width; ++i) {
            ASSERT_TRUE(i >= strip.x && i < strip.x + strip.width);
            const auto at = static_cast<std::size_t>(y * size.width_px + i);
            ++covered[at];
            by_left[at] += is_left ? 1 : 0;
          }
        }
      }
    }
    const int times = layout == StereoLayout::kAnaglyph ? 2 : 1;
    EXPECT_TRUE(std::all_of(covered.begin(), covered.end(), [&](int n) { return n == times; }));
    if (times == 2) {
      EXPECT_TRUE(std::all_of(by_left.begin(), by_left.end(), [](int n) { return n == 1; }));
    }
  }
}

TEST(StereoPieces, PairsThatNobodyCanLookAtAreRefused) {
  EXPECT_EQ(check({StereoLayout::kSideBySide, 0.1, 3.0}), "");
  EXPECT_EQ(check({StereoLayout::kSideBySide, 100, std::nullopt}), "");
  for (const double base_m : {0.0, -1.0, 0.61, 3.5, HUGE_VAL, std::nan("")})
    EXPECT_NE(check({StereoLayout::kSideBySide, base_m, 3.0}), "") << base_m;
  EXPECT_NE(check({StereoLayout::kSideBySide, 0.1, -3.0}), "");
  EXPECT_NE(check({StereoLayout::kSideBySide, 1.0, 3.0}).find("at most 0.6 m"), std::string::npos);
}

}  // namespace
}  // namespace panorama
