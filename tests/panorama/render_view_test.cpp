// Views of panoramas, against what the image's formula says in each direction.
#include "panorama/viewer/render_view.h"

#include <cmath>

#include "mars/geodesy/sphere.h"
#include "panorama/viewer/viewer.h"
#include "tests/support/support.h"
#include "vpe/base/parallel.h"

namespace {

using panorama::Direction;
using panorama::ImageLevel;
using panorama::PanoramaMap;
using panorama::Tile;
using panorama::TiledImage;

constexpr double kDeg = mars::kRadiansPerDegree;

// An image by formula, its smaller levels means of the larger; tiles of 64 x 64.
class FormulaTiles : public panorama::TileSource {
 public:
  using Formula = std::function<glm::dvec3(const Direction&)>;
  FormulaTiles(const PanoramaMap& map, int levels, const Formula& formula) {
    levels_.push_back({map.width_px, map.height_px, 64, 64});
    pixels_.emplace_back();
    for (std::int64_t y = 0; y < map.height_px; ++y) {
      for (std::int64_t x = 0; x < map.width_px; ++x)
        pixels_[0].push_back(
            formula(map.to_direction(static_cast<double>(x) + 0.5, static_cast<double>(y) + 0.5)));
    }
    for (int n = 1; n < levels; ++n) add_level();
  }
  const std::vector<ImageLevel>& levels() const override { return levels_; }
  std::shared_ptr<const Tile> read(int level, std::int64_t column, std::int64_t row) const override {
    const ImageLevel& size = levels_[static_cast<std::size_t>(level)];
    auto tile = std::make_shared<Tile>();
    tile->width_px = tile->height_px = 64;
    for (std::int64_t y = row * 64; y < row * 64 + 64; ++y) {
      for (std::int64_t x = column * 64; x < column * 64 + 64; ++x) {
        // Beyond the edge nothing may be looked at: bright red.
        glm::dvec3 c(255, 0, 0);
        if (x < size.width_px && y < size.height_px) {
          c = pixels_[static_cast<std::size_t>(level)][static_cast<std::size_t>(y * size.width_px + x)];
        }
        tile->pixels.push_back({static_cast<std::uint8_t>(std::lround(c.x)),
                                static_cast<std::uint8_t>(std::lround(c.y)),
                                static_cast<std::uint8_t>(std::lround(c.z))});
      }
    }
    return tile;
  }

 private:
  void add_level() {
    const ImageLevel fine = levels_.back();
    const ImageLevel coarse{fine.width_px / 2, fine.height_px / 2, 64, 64};
    const auto& from = pixels_.back();
    const auto at = [&](std::int64_t x, std::int64_t y) {
      return from[static_cast<std::size_t>(y * fine.width_px + x)];
    };
    std::vector<glm::dvec3> to;
    for (std::int64_t y = 0; y < coarse.height_px; ++y) {
      for (std::int64_t x = 0; x < coarse.width_px; ++x) {
        to.push_back(
            0.25 * (at(2 * x, 2 * y) + at(2 * x + 1, 2 * y) + at(2 * x, 2 * y + 1) + at(2 * x + 1, 2 * y + 1)));
      }
    }
    levels_.push_back(coarse);
    pixels_.push_back(std::move(to));
  }

  std::vector<ImageLevel> levels_;
  std::vector<std::vector<glm::dvec3>> pixels_;
};

TiledImage image_of(const PanoramaMap& map, const FormulaTiles::Formula& formula, int levels = 4) {
  return {std::make_unique<FormulaTiles>(map, levels, formula), std::size_t{64} << 20};
}

// Smooth over the sphere, and closed at 360 degrees.
glm::dvec3 smooth(const Direction& d) {
  const double a = d.azimuth_deg * kDeg;
  const double e = d.elevation_deg * kDeg;
  return {128 + 100 * std::sin(3 * a), 128 + 100 * std::cos(2 * a), 128 + 100 * std::sin(4 * e)};
}

const std::vector<PanoramaMap>& maps() {
  static const std::vector<PanoramaMap> kMaps{
      panorama::cylinder_map(800, 320, 800, 100.0, 150.0),
      panorama::equirectangular_map(800, 400, 800, -30.0, 200.0),
      panorama::faceted_map(8, 100, 320, 10.0, 160.0),
      panorama::faceted_map(3, 240, 320, 10.0, 160.0),
  };
  return kMaps;
}

TEST(RenderView, ShowsWhatIsThereAcrossEverySeam) {
  for (const PanoramaMap& map : maps()) {
    const TiledImage tiled_image = image_of(map, smooth);
    for (double yaw_deg = 0; yaw_deg < 360; yaw_deg += 45) {
      for (const double fov_deg : {20.0, 60.0}) {
        const vpe::core::View view = panorama::view_of(yaw_deg, 3.0, fov_deg, 160, 90);
        const vpe::core::RgbImage image = panorama::render_view(tiled_image, map, view, {});
        double worst = 0;
        for (int y = 0; y < 90; ++y) {
          for (int x = 0; x < 160; ++x) {
            const Direction d = panorama::to_direction(vpe::core::pixel_ray(view, x + 0.5, y + 0.5));
            if (!panorama::shown_place(map, d)) continue;
            const glm::dvec3 is = smooth(d);
            const vpe::base::Rgb& p = image.pixels[static_cast<std::size_t>(y * 160 + x)];
            worst = std::max({worst, std::abs(p.r - is.x), std::abs(p.g - is.y), std::abs(p.b - is.z)});
          }
        }
        // Bytes are rounded twice; the curvature over a footprint adds less than one.
        EXPECT_LT(worst, 3.0) << to_string(map.kind) << " " << map.facets << " yaw " << yaw_deg << " fov "
                              << fov_deg;
      }
    }
  }
}

// The marks of 20 directions are where the viewer says, and their pixels lead back to them.
TEST(RenderView, MarksAreFoundWhereTheViewerSays) {
  const std::vector<PanoramaMap> large{panorama::cylinder_map(1800, 400, 1800, 100.0, 200.0),
                                       panorama::equirectangular_map(1800, 400, 1800, 100.0, 200.0),
                                       panorama::faceted_map(8, 225, 400, 100.0, 200.0)};
  for (const PanoramaMap& map : large) {
    std::vector<Direction> marks;
    for (int n = 0; n < 20; ++n) marks.push_back({std::fmod(2.0 + 18.0 * n, 360.0), -14.0 + 1.5 * n});
    const TiledImage tiled_image = image_of(
        map,
        [&](const Direction& d) {
          double nearest_deg = 1e9;
          for (const Direction& mark : marks) {
            if (std::abs(d.elevation_deg - mark.elevation_deg) > 0.8) continue;
            nearest_deg =
                std::min(nearest_deg, std::hypot(std::remainder(d.azimuth_deg - mark.azimuth_deg, 360.0) *
                                                     std::cos(mark.elevation_deg * kDeg),
                                                 d.elevation_deg - mark.elevation_deg));
          }
          return glm::dvec3(255.0 * std::max(0.0, 1.0 - nearest_deg / 0.8));
        },
        2);
    for (const Direction& mark : marks) {
      panorama::Viewer viewer(map, 240, 180);
      viewer.set_fov(20.0);
      viewer.look_at(mark.azimuth_deg + 4.0, mark.elevation_deg - 3.0);
      const vpe::core::RgbImage image = panorama::render_view(tiled_image, map, viewer.view(), {});
      const auto said = viewer.screen(mark);
      ASSERT_TRUE(said);
      glm::dvec2 sum(0.0);
      double weight = 0;
      for (int y = 0; y < 180; ++y) {
        for (int x = 0; x < 240; ++x) {
          const double bright = image.pixels[static_cast<std::size_t>(y * 240 + x)].g;
          if (std::hypot(x + 0.5 - said->x, y + 0.5 - said->y) > 16) continue;
          sum += bright * glm::dvec2(x + 0.5, y + 0.5);
          weight += bright;
        }
      }
      ASSERT_GT(weight, 500.0);
      const glm::dvec2 found = sum / weight;
      EXPECT_LT(std::hypot(found.x - said->x, found.y - said->y), 0.5) << mark.azimuth_deg;
      const Direction back = viewer.direction(found.x, found.y);
      const double pixel_deg = 20.0 / 180;
      EXPECT_LT(std::abs(std::remainder(back.azimuth_deg - mark.azimuth_deg, 360.0)), 0.5 * pixel_deg);
      EXPECT_LT(std::abs(back.elevation_deg - mark.elevation_deg), 0.5 * pixel_deg);
    }
  }
}

TEST(RenderView, FineStripesFadeWhenTheyAreFarOff) {
  const PanoramaMap map = panorama::equirectangular_map(2048, 1024, 2048, 0.0, 512.0);
  const TiledImage tiled_image = image_of(
      map,
      [&](const Direction& d) {
        const auto at = map.place(d);
        return glm::dvec3((static_cast<int>(at.x) + static_cast<int>(at.y)) % 2 == 0 ? 255.0 : 0.0);
      },
      5);
  // Eight pixels of the image fall into one of the view.
  const vpe::core::RgbImage image =
      panorama::render_view(tiled_image, map, panorama::view_of(33.0, 0.0, 90.0, 80, 65), {});
  for (const vpe::base::Rgb& p : image.pixels) EXPECT_NEAR(p.g, 127.5, 6.0);
  // Towards the zenith a row of the image is a point; it is still the mean.
  const vpe::core::RgbImage up =
      panorama::render_view(tiled_image, map, panorama::view_of(33.0, 90.0, 40.0, 64, 64), {});
  for (const vpe::base::Rgb& p : up.pixels) EXPECT_NEAR(p.g, 127.5, 20.0);
}

TEST(RenderView, PartsOfACircleEndSharply) {
  // A third of a circle, from azimuth 300 to 60.
  const PanoramaMap map = panorama::cylinder_map(600, 300, 1800, 300.0, 150.0);
  const TiledImage tiled_image = image_of(
      map, [](const Direction&) { return glm::dvec3(200.0); }, 3);
  panorama::RenderViewOptions options;
  options.outside = {0, 0, 255};
  const vpe::core::View view = panorama::view_of(60.0, 0.0, 30.0, 200, 100);
  const vpe::core::RgbImage image = panorama::render_view(tiled_image, map, view, options);
  for (int y = 0; y < 100; ++y) {
    for (int x = 0; x < 200; ++x) {
      const Direction d = panorama::to_direction(vpe::core::pixel_ray(view, x + 0.5, y + 0.5));
      const bool inside =
          d.azimuth_deg < 60.0 && std::abs(d.elevation_deg) < std::atan(150.0 / map.focal_px) / kDeg;
      EXPECT_EQ(image.pixels[static_cast<std::size_t>(y * 200 + x)],
                inside ? (vpe::base::Rgb{200, 200, 200}) : options.outside)
          << x << "," << y;
    }
  }
}

TEST(RenderView, AlmostAFullCircleHasNoGap) {
  // As rover mosaics: whole degrees a pixel do not make whole columns.
  const PanoramaMap map = panorama::equirectangular_map(770, 300, 770.45, 0.0, 150.0);
  const TiledImage tiled_image = image_of(
      map, [](const Direction&) { return glm::dvec3(200.0); }, 3);
  for (const double fov_deg : {0.5, 5.0, 60.0}) {
    const vpe::core::RgbImage image =
        panorama::render_view(tiled_image, map, panorama::view_of(0.0, 0.0, fov_deg, 120, 80), {});
    for (const vpe::base::Rgb& p : image.pixels) EXPECT_EQ(p, (vpe::base::Rgb{200, 200, 200}));
  }
}

TEST(RenderView, MoreThanAFullCircleIsSeamless) {
  const PanoramaMap map = panorama::cylinder_map(1000, 300, 800, 0.0, 150.0);
  const TiledImage tiled_image = image_of(map, smooth, 3);
  for (double yaw_deg = 0; yaw_deg < 360; yaw_deg += 20) {
    const vpe::core::View view = panorama::view_of(yaw_deg, 0.0, 40.0, 90, 60);
    const vpe::core::RgbImage image = panorama::render_view(tiled_image, map, view, {});
    for (int x = 0; x < 90; ++x) {
      const glm::dvec3 is = smooth(panorama::to_direction(vpe::core::pixel_ray(view, x + 0.5, 30.5)));
      EXPECT_NEAR(image.pixels[static_cast<std::size_t>(30 * 90 + x)].r, is.x, 3.0) << yaw_deg;
    }
  }
}

TEST(RenderView, TheEyesOfAPairStayApart) {
  // The left eye is green, the right eye blue; nothing of one comes into the other, at any distance.
  class Halves : public panorama::TileSource {
   public:
    Halves() {
      for (int n = 0; n < 5; ++n) levels_.push_back({1024 >> n, 208 >> n, 1024 >> n, 208 >> n});
    }
    const std::vector<ImageLevel>& levels() const override { return levels_; }
    std::shared_ptr<const Tile> read(int level, std::int64_t, std::int64_t) const override {
      const ImageLevel& size = levels_[static_cast<std::size_t>(level)];
      auto tile = std::make_shared<Tile>();
      tile->width_px = size.tile_width_px;
      tile->height_px = size.tile_height_px;
      for (std::int64_t n = 0; n < size.width_px * size.height_px; ++n) {
        const bool left = n % size.width_px < size.width_px / 2;
        tile->pixels.push_back(left ? vpe::base::Rgb{0, 255, 0} : vpe::base::Rgb{0, 0, 255});
      }
      return tile;
    }

   private:
    std::vector<ImageLevel> levels_;
  };
  const TiledImage pair(std::make_unique<Halves>(), std::size_t{64} << 20);
  const PanoramaMap camera = panorama::cylinder_map(512, 208, 512, 0.0, 100.0);
  for (const double fov_deg : {10.0, 90.0}) {
    for (const double yaw_deg : {0.0, 180.0, 359.0}) {
      for (const int height : {8, 120}) {
        const vpe::core::View view = panorama::view_of(yaw_deg, 0.0, fov_deg, 2 * height, height);
        panorama::RenderViewOptions options;
        options.outside = {0, 255, 0};
        for (const vpe::base::Rgb& p : panorama::render_view(pair, camera, view, options).pixels)
          EXPECT_EQ(p, (vpe::base::Rgb{0, 255, 0}));
        options.outside = {0, 0, 255};
        options.origin.x_px = 512;
        for (const vpe::base::Rgb& p : panorama::render_view(pair, camera, view, options).pixels)
          EXPECT_EQ(p, (vpe::base::Rgb{0, 0, 255}));
      }
    }
  }
}

TEST(RenderView, TheSameBytesForAnyNumberOfThreads) {
  const PanoramaMap map = maps()[2];
  const vpe::core::View view = panorama::view_of(7.0, 5.0, 70.0, 241, 153);
  panorama::RenderViewOptions one;
  one.threads = 1;
  const TiledImage tiled_image = image_of(map, smooth);
  const vpe::core::RgbImage alone = panorama::render_view(tiled_image, map, view, one);
  for (const int threads : {2, 8}) {
    panorama::RenderViewOptions many;
    many.threads = threads;
    // A budget of two tiles only: what is kept changes nothing either.
    const TiledImage tight(std::make_unique<FormulaTiles>(map, 4, smooth), 25000);
    EXPECT_EQ(panorama::render_view(tight, map, view, many).pixels, alone.pixels);
  }
}

TEST(RenderView, OtherViewsAndBadOnes) {
  const PanoramaMap map = maps()[0];
  const TiledImage tiled_image = image_of(map, smooth);
  vpe::core::View view = panorama::view_of(0.0, 0.0, 60.0, 64, 48);
  view.projection = vpe::core::Projection::kEquirectangular;
  const vpe::core::RgbImage round = panorama::render_view(tiled_image, map, view, {});
  const Direction d = panorama::to_direction(vpe::core::pixel_ray(view, 20.5, 24.5));
  EXPECT_NEAR(round.pixels[24 * 64 + 20].r, smooth(d).x, 12.0);  // a pixel is 6 degrees wide
  view.fov_deg = 0;
  EXPECT_THROW(panorama::render_view(tiled_image, map, view, {}), std::invalid_argument);
  PanoramaMap bad = map;
  bad.focal_px = NAN;
  EXPECT_THROW(panorama::render_view(tiled_image, bad, panorama::view_of(0, 0, 60, 64, 48), {}),
               std::invalid_argument);
}

}  // namespace
