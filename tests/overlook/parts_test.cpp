// Parts of a view: they cover what the image shows, and each lies on the textures that it names.
#include "vpe/overlook/parts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <random>
#include <set>

#include "mars/geodesy/pose.h"
#include "panorama/viewer/viewer.h"
#include "tests/overlook/overlook_fixture.h"

namespace {

using namespace vpe::overlook;
using overlook_test::FormulaSource;
using overlook_test::maps;
using panorama::LevelGrid;
using panorama::PanoramaMap;

constexpr unsigned kSeed = 20261127;

std::vector<LevelGrid> grids_of(const PanoramaMap& map) {
  const FormulaSource source(map.width_px, map.height_px, 128, [](auto, auto) { return vpe::base::Rgb{}; });
  return panorama::level_grids(source.levels(), map, {});
}

vpe::core::View random_view(std::mt19937& random) {
  const auto number = [&](double low, double high) {
    return std::uniform_real_distribution(low, high)(random);
  };
  vpe::core::View view = panorama::view_of(number(0, 360), number(-60, 60), number(2, 100), 320, 200);
  view.camera.axes =
      mars::oriented_axes(panorama::kViewerFrame, number(0, 360), number(-60, 60), number(-180, 180));
  return view;
}

bool holds(const Rectangle& r, const glm::dvec2& p) {
  return p.x >= r.left && p.x <= r.right && p.y >= r.top && p.y <= r.bottom;
}

TEST(OverlookParts, CoverEveryPixelThatTheImageShows) {
  std::mt19937 random(kSeed);
  for (const PanoramaMap& map : maps()) {
    const std::vector<LevelGrid> grids = grids_of(map);
    for (int n = 0; n < 12; ++n) {
      const vpe::core::View view = random_view(random);
      const std::vector<Part> parts =
          choose_parts(map, grids, view, {}, [](const TextureKey&) { return true; });
      for (int k = 0; k < 300; ++k) {
        const double x = std::uniform_real_distribution(0.0, 320.0)(random);
        const double y = std::uniform_real_distribution(0.0, 200.0)(random);
        const auto place = panorama::shown_place(map, panorama::to_direction(vpe::core::pixel_ray(view, x, y)));
        if (!place) continue;
        const auto many = std::count_if(parts.begin(), parts.end(),
                                        [&](const Part& part) { return holds(part.rectangle, *place); });
        EXPECT_GE(many, 1) << to_string(map.kind) << " " << place->x << " " << place->y << " seed " << kSeed;
      }
    }
  }
}

TEST(OverlookParts, LieOnTheirTextures) {
  std::mt19937 random(kSeed);
  for (const PanoramaMap& map : maps()) {
    const std::vector<LevelGrid> grids = grids_of(map);
    for (int n = 0; n < 12; ++n) {
      const vpe::core::View view = random_view(random);
      for (const Part& part : choose_parts(map, grids, view, {}, [](const TextureKey&) { return true; })) {
        ASSERT_FALSE(part.textures.empty());
        EXPECT_LE(part.textures.size(), Part::kMostLevels);
        EXPECT_TRUE(!part.is_enlarged || (part.textures.size() == 1 && part.textures[0].level == 0));
        for (std::size_t k = 0; k < part.textures.size(); ++k) {
          const TextureKey& key = part.textures[k];
          EXPECT_EQ(key.level, part.textures[0].level + static_cast<int>(k));
          const LevelGrid& grid = grids[static_cast<std::size_t>(key.level)];
          const double left =
              (part.rectangle.left * grid.scale.x) - static_cast<double>(key.column) * kTextureSide_px;
          const double right =
              (part.rectangle.right * grid.scale.x) - static_cast<double>(key.column) * kTextureSide_px;
          // Half a pixel more at both ends is there: the border, and what it repeats at the image's ends.
          EXPECT_GE(left, -1e-5);
          EXPECT_LE(right, kTextureSide_px + 1.0);
          const double top = part.rectangle.top * grid.scale.y - static_cast<double>(key.row) * kTextureSide_px;
          const double bottom =
              part.rectangle.bottom * grid.scale.y - static_cast<double>(key.row) * kTextureSide_px;
          EXPECT_GE(top, -1e-5);
          EXPECT_LE(bottom, kTextureSide_px + 1.0);
        }
      }
    }
  }
}

// The shader of a part has no more levels and samples than the part says.
TEST(OverlookParts, HaveTheLevelsAndSamplesOfTheirPixels) {
  std::mt19937 random(kSeed);
  int pixels = 0;
  int missed = 0;
  std::map<std::pair<std::size_t, int>, int> seen;
  for (const PanoramaMap& map : maps()) {
    const std::vector<LevelGrid> grids = grids_of(map);
    for (int n = 0; n < 24; ++n) {
      const vpe::core::View view = random_view(random);
      const std::vector<Part> parts =
          choose_parts(map, grids, view, {}, [](const TextureKey&) { return true; });
      for (int k = 0; k < 200; ++k) {
        const double x = std::uniform_real_distribution(1.0, 319.0)(random);
        const double y = std::uniform_real_distribution(1.0, 199.0)(random);
        const auto place = [&](double px, double py) {
          return panorama::shown_place(map, panorama::to_direction(vpe::core::pixel_ray(view, px, py)));
        };
        const auto here = place(x, y);
        const auto right = place(x + 1, y);
        const auto below = place(x, y + 1);
        if (!here || !right || !below) continue;
        const auto off = [&](const glm::dvec2& there) {
          return glm::dvec2(std::remainder(there.x - here->x, map.turn_px), there.y - here->y);
        };
        const panorama::Footprint footprint = panorama::footprint_of(off(*right), off(*below));
        const auto part = std::ranges::find_if(parts, [&](const Part& p) { return holds(p.rectangle, *here); });
        if (part == parts.end()) continue;
        ++pixels;
        ++seen[std::pair(part->textures.size(), part->most_samples)];
        const int level = panorama::level_of_footprint(grids, footprint.thin_px);
        const bool is_mixed = footprint.thin_px > grids[static_cast<std::size_t>(level)].reduction * (1 + 1e-9);
        const int last = std::min(level + (is_mixed ? 1 : 0), static_cast<int>(grids.size()) - 1);
        missed += level < part->textures.front().level || last > part->textures.back().level ||
                          footprint.samples > part->most_samples
                      ? 1
                      : 0;
      }
    }
  }
  std::printf("%d of %d pixels need more than their part has\n", missed, pixels);
  EXPECT_GT(pixels, 5000);
  EXPECT_LT(missed, pixels / 2000);
  // Parts for one level and for several, for one sample, two and more.
  for (const int samples : {1, 2, 16})
    EXPECT_TRUE(std::ranges::any_of(seen, [&](const auto& one) { return one.first.second == samples; }))
        << samples;
  for (const std::size_t levels : {std::size_t{1}, std::size_t{2}, std::size_t{3}})
    EXPECT_TRUE(std::ranges::any_of(seen, [&](const auto& one) { return one.first.first == levels; }))
        << levels;
}

TEST(OverlookParts, CoarserTexturesStandIn) {
  const PanoramaMap& map = maps()[0];
  const std::vector<LevelGrid> grids = grids_of(map);
  const vpe::core::View view = panorama::view_of(100, 0, 30, 640, 400);
  int refused = 0;
  const std::vector<Part> parts = choose_parts(map, grids, view, {}, [&](const TextureKey& key) {
    if (key.level >= 2) return true;
    ++refused;
    return false;
  });
  EXPECT_GT(refused, 0);
  ASSERT_FALSE(parts.empty());
  for (const Part& part : parts) EXPECT_EQ(part.textures[0].level, 2);
  // Nothing is ready: the coarsest.
  for (const Part& part : choose_parts(map, grids, view, {}, [](const TextureKey&) { return false; }))
    EXPECT_EQ(part.textures[0].level, static_cast<int>(grids.size()) - 1);
}

TEST(OverlookParts, SeesOnlyItsSideOfTheImage) {
  const PanoramaMap& map = maps()[0];
  const std::vector<LevelGrid> grids = grids_of(map);
  std::set<TextureKey> all;
  const std::vector<Part> parts =
      choose_parts(map, grids, panorama::view_of(190, 0, 10, 640, 400), {}, [&](const TextureKey& key) {
        all.insert(key);
        return true;
      });
  // 16 degrees of 360 by 10: 136 columns, and half of their rows beyond each edge at most.
  EXPECT_LE(all.size(), 9U);
  EXPECT_GE(all.size(), 1U);
}

}  // namespace
