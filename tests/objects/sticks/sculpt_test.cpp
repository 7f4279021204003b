// Voxels from photographs: hulls in closed form, silhouettes, colours, masks, refusals.
#include "objects/sticks/sculpt.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <numeric>
#include <stdexcept>

#include "tests/objects/sticks/stick_shapes.h"
#include "vpe/base/file.h"

namespace objects {
namespace {

using stick_shapes::kFar;
using vpe::base::Rgb;
using vpe::core::RgbImage;

constexpr Rgb kGround{208, 200, 192};

// A photograph of an ellipse with a rim around it, and its mask by the background.
SculptView ellipse(SculptSide side, int width, int height, const Rgb& colour) {
  constexpr int kRim = 7;
  SculptView view;
  view.side = side;
  view.image.width = width + 2 * kRim + 3;
  view.image.height = height + 2 * kRim;
  for (int y = 0; y < view.image.height; ++y) {
    for (int x = 0; x < view.image.width; ++x) {
      const double u = (x + 0.5 - kRim) / width * 2 - 1;
      const double v = (y + 0.5 - kRim) / height * 2 - 1;
      view.image.pixels.push_back(u * u + v * v < 1 ? colour : kGround);
    }
  }
  view.mask = mask_by_background(view.image, kGround, 8);
  return view;
}

std::vector<SculptView> three_views(int scale = 100) {
  return {ellipse(SculptSide::kRight, 6 * scale, 3 * scale, {200, 30, 30}),
          ellipse(SculptSide::kFront, 4 * scale, 3 * scale, {30, 200, 30}),
          ellipse(SculptSide::kTop, 4 * scale, 6 * scale, {30, 30, 200})};
}
const SculptOptions kSize{.size_m = {4, 6, 3}, .voxels_longest = 120};  // voxels of 5 cm

// Below 1 inside of each of the cylinders over three ellipses; the model stands on z = 0.
double hull_value(const glm::dvec3& p) {
  const double x = p.x / 2;
  const double y = p.y / 3;
  const double z = (p.z - 1.5) / 1.5;
  return std::max({x * x + y * y, y * y + z * z, x * x + z * z});
}

TEST(Sculpt, TheHullIsThatOfTheClosedForm) {
  const VoxelGrid voxels = sculpt(three_views(), kSize);
  const StickGrid& g = voxels.grid();
  ASSERT_EQ(g.columns_x, 80);
  ASSERT_EQ(g.columns_y, 120);
  ASSERT_EQ(g.height, 60);
  EXPECT_FLOAT_EQ(g.corner_m.x, -2);
  EXPECT_EQ(g.corner_m.z, 0);
  for (int y = 0; y < g.columns_y; ++y) {
    for (int x = 0; x < g.columns_x; ++x) {
      for (int z = 0; z < g.height; ++z) {
        const auto edge = static_cast<double>(g.voxel_m);
        const glm::dvec3 centre = glm::dvec3(g.corner_m) + edge * (glm::dvec3(x, y, z) + 0.5);
        // Moved by a voxel towards the middle, and away from it.
        const glm::dvec3 outward = glm::normalize(centre - glm::dvec3(0, 0, 1.5)) * edge;
        if (hull_value(centre + outward) < 1) {
          ASSERT_TRUE(voxels.is_set(x, y, z)) << x << " " << y << " " << z;
        }
        if (hull_value(centre - outward) > 1) {
          ASSERT_FALSE(voxels.is_set(x, y, z)) << x << " " << y << " " << z;
        }
      }
    }
  }
}

// What a camera sees from a side: parallel rays, as many as voxels.
struct Seen {
  int both = 0;
  int either = 0;
  double red = 0, green = 0, blue = 0;
};
Seen look(const StickModel& model, int depth, double toward) {
  const glm::dvec3 size_m(4, 6, 3);
  const int u = depth == 0 ? 1 : 0;
  const int v = depth == 2 ? 1 : 2;
  Seen out;
  StickHits hits;
  for (int n = 0; n < 300 * 300; ++n) {
    const double a = (n % 300 + 0.5) / 150.0 - 1;
    const double b = (n / 300 + 0.5) / 150.0 - 1;
    glm::dvec3 from(0, 0, 1.5);
    from[u] += 0.5 * size_m[u] * a;
    from[v] += 0.5 * size_m[v] * b;
    from[depth] += 20 * toward;
    glm::vec3 d(0);
    d[depth] = static_cast<float>(-toward);
    model.cast({glm::vec3(from), d}, 0, kFar, hits);
    const bool is_inside = a * a + b * b < 1;
    out.both += is_inside && hits.has_front ? 1 : 0;
    out.either += is_inside || hits.has_front ? 1 : 0;
    if (!hits.has_front) continue;
    out.red += hits.front.voxel.colour.r > 150 ? 1 : 0;
    out.green += hits.front.voxel.colour.g > 150 ? 1 : 0;
    out.blue += hits.front.voxel.colour.b > 150 ? 1 : 0;
  }
  return out;
}

TEST(Sculpt, SilhouettesAndColoursAreThoseOfThePhotographs) {
  SculptOptions fine = kSize;
  fine.voxels_longest = 512;
  const StickModel model = build_sticks(sculpt(three_views(), fine));
  const Seen right = look(model, 0, 1);
  const Seen front = look(model, 1, 1);
  const Seen top = look(model, 2, 1);
  for (const Seen& seen : {right, front, top}) EXPECT_GE(static_cast<double>(seen.both) / seen.either, 0.995);
  // The hull faces its own photograph in the middle, and others around it.
  EXPECT_GT(right.red, 0.5 * right.both);
  EXPECT_GT(front.green, 0.5 * front.both);
  EXPECT_GT(top.blue, 0.5 * top.both);
  EXPECT_GE(static_cast<double>(look(model, 0, -1).both) / right.either, 0.99);
}

// Paints each quarter of a silhouette in another colour.
SculptView quarters(SculptSide side, int width, int height) {
  SculptView view = ellipse(side, width, height, {250, 250, 250});
  for (int y = 0; y < view.image.height; ++y) {
    for (int x = 0; x < view.image.width; ++x) {
      const auto at = static_cast<std::size_t>(y * view.image.width + x);
      if (view.mask.shows[at] == 0) continue;
      const bool is_right = x - 7 >= width / 2;
      const bool is_low = y - 7 >= height / 2;
      view.image.pixels[at] = {static_cast<std::uint8_t>(is_right ? 255 : 0),
                               static_cast<std::uint8_t>(is_low ? 255 : 0), static_cast<std::uint8_t>(side)};
    }
  }
  return view;
}

TEST(Sculpt, PhotographsLieTheRightWayRound) {
  const std::vector<SculptView> views{
      quarters(SculptSide::kRight, 600, 300), quarters(SculptSide::kLeft, 600, 300),
      quarters(SculptSide::kFront, 400, 300), quarters(SculptSide::kBack, 400, 300),
      quarters(SculptSide::kTop, 400, 600),   quarters(SculptSide::kBottom, 400, 600)};
  const StickModel model = build_sticks(sculpt(views, kSize));
  StickHits hits;
  // The colour seen from a direction, a little right of and above the middle of the photograph.
  const auto expect = [&](const glm::vec3& toward, const glm::vec3& right, const glm::vec3& up,
                          SculptSide side) {
    for (const float u : {-0.3F, 0.3F}) {
      for (const float v : {-0.3F, 0.3F}) {
        model.cast({glm::vec3(0, 0, 1.5F) + toward * 20.0F + right * u + up * v, -toward}, 0, kFar, hits);
        ASSERT_TRUE(hits.has_front);
        const Rgba wanted{static_cast<std::uint8_t>(u > 0 ? 255 : 0),
                          static_cast<std::uint8_t>(v < 0 ? 255 : 0), static_cast<std::uint8_t>(side), 255};
        EXPECT_EQ(hits.front.voxel.colour, wanted) << name_of(side) << " " << u << " " << v;
        EXPECT_GT(glm::dot(glm::vec3(hits.front.voxel.normal[0], hits.front.voxel.normal[1],
                                     hits.front.voxel.normal[2]),
                           toward),
                  90)
            << name_of(side);
      }
    }
  };
  expect({1, 0, 0}, {0, 1, 0}, {0, 0, 1}, SculptSide::kRight);
  expect({-1, 0, 0}, {0, -1, 0}, {0, 0, 1}, SculptSide::kLeft);
  expect({0, 1, 0}, {-1, 0, 0}, {0, 0, 1}, SculptSide::kFront);
  expect({0, -1, 0}, {1, 0, 0}, {0, 0, 1}, SculptSide::kBack);
  expect({0, 0, 1}, {1, 0, 0}, {0, 1, 0}, SculptSide::kTop);
  expect({0, 0, -1}, {-1, 0, 0}, {0, 1, 0}, SculptSide::kBottom);
}

TEST(Sculpt, UnseenVoxelsTakeColoursOfNeighbours) {
  const VoxelGrid voxels = sculpt(three_views(40), kSize);
  for (const VoxelGrid::Coloured& c : voxels.coloured()) {
    const int sum = c.voxel.colour.r + c.voxel.colour.g + c.voxel.colour.b;
    EXPECT_NEAR(sum, 260, 3);  // a mixture of the three
  }
}

TEST(Sculpt, OrderOfPhotographsDoesNotCount) {
  std::vector<SculptView> views = three_views(30);
  const StickModel a = build_sticks(sculpt(views, kSize));
  std::swap(views[0], views[2]);
  const StickModel b = build_sticks(sculpt(views, kSize));
  EXPECT_EQ(stick_shapes::count_voxels(a.levels()[0]), stick_shapes::count_voxels(b.levels()[0]));
}

std::string refused(const std::vector<SculptView>& views, const SculptOptions& options = kSize) {
  try {
    sculpt(views, options);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}
bool has(const std::string& text, const char* part) { return text.find(part) != std::string::npos; }

TEST(Sculpt, SaysWhatIsWrong) {
  const std::vector<SculptView> good = three_views(30);
  EXPECT_EQ(refused(good), "");
  EXPECT_TRUE(has(refused({good[0], good[1]}), "at least three photographs, not 2"));
  EXPECT_TRUE(has(refused({good[0], good[1], good[0]}), "two photographs are from the right"));
  std::vector<SculptView> bad = good;
  std::fill(bad[1].mask.shows.begin(), bad[1].mask.shows.end(), 0);
  EXPECT_TRUE(has(refused(bad), "the mask of the photograph from the front is empty"));
  std::fill(bad[1].mask.shows.begin(), bad[1].mask.shows.end(), 1);
  EXPECT_TRUE(has(refused(bad), "the mask of the photograph from the front is the whole image"));
  bad = good;
  bad[2].mask.width -= 1;
  EXPECT_TRUE(has(refused(bad), "the photograph from the top has 137 x 194 pixels, its mask 136 x 194"));
  bad = good;
  bad[1] = ellipse(SculptSide::kFront, 4 * 40, 3 * 30, {1, 2, 3});
  EXPECT_TRUE(has(refused(bad), "the photograph from the front shows is 160 x 90 pixels, 33 percent too wide"))
      << refused(bad);
  bad[1] = ellipse(SculptSide::kFront, 4 * 20, 3 * 30, {1, 2, 3});
  EXPECT_TRUE(has(refused(bad), "50 percent too narrow")) << refused(bad);
  bad[1] = ellipse(SculptSide::kFront, 4 * 32, 3 * 30, {1, 2, 3});  // 7 percent
  EXPECT_EQ(refused(bad), "");
  for (const double size : {0.0, -1.0, std::nan(""), 1e12})
    EXPECT_TRUE(has(refused(good, {.size_m = {4, size, 3}}), "must be above 0"));
  EXPECT_TRUE(has(refused(good, {.size_m = {4, 6, 3}, .voxels_longest = 0}), "1 to 1024 voxels"));
  EXPECT_TRUE(has(refused(good, {.size_m = {4, 6, 3}, .voxels_longest = 2000}), "not 2000"));
}

TEST(PhotoMask, SpotsOfTheBackgroundsColourStay) {
  SculptView view = ellipse(SculptSide::kRight, 60, 40, {10, 20, 30});
  const std::size_t spot = static_cast<std::size_t>(27) * static_cast<std::size_t>(view.image.width) + 37;
  view.image.pixels[spot] = kGround;
  const PhotoMask mask = mask_by_background(view.image, kGround, 0);
  EXPECT_EQ(mask.shows[spot], 1);
  EXPECT_EQ(mask.shows[0], 0);
  EXPECT_EQ(mask.shows, view.mask.shows);
  view.image.pixels[3] = {213, 200, 192};
  EXPECT_EQ(mask_by_background(view.image, kGround, 4).shows[3], 1);
  EXPECT_EQ(mask_by_background(view.image, kGround, 5).shows[3], 0);
}

TEST(PhotoMask, ContoursFollowTheEvenOddRule) {
  const PhotoMask box = mask_by_contour({{2, 1}, {8, 1}, {8, 5}, {2, 5}}, 10, 7);
  EXPECT_EQ(std::accumulate(box.shows.begin(), box.shows.end(), 0), 6 * 4);
  EXPECT_EQ(box.shows[1 * 10 + 2], 1);
  EXPECT_EQ(box.shows[5 * 10 + 2], 0);
  // A star drawn in one stroke has a hole.
  std::vector<glm::dvec2> star;
  for (int n = 0; n < 5; ++n) {
    const double angle = n * 4 * 3.14159265 / 5;
    star.emplace_back(50 + 45 * std::sin(angle), 50 - 45 * std::cos(angle));
  }
  const PhotoMask mask = mask_by_contour(star, 100, 100);
  EXPECT_EQ(mask.shows[50 * 100 + 50], 0);
  EXPECT_EQ(mask.shows[20 * 100 + 50], 1);
  EXPECT_EQ(mask.shows[5 * 100 + 5], 0);
  const PhotoMask all = mask_by_contour({{-9, -9}, {30, -9}, {30, 30}, {-9, 30}}, 10, 7);
  EXPECT_EQ(std::accumulate(all.shows.begin(), all.shows.end(), 0), 70);
  EXPECT_THROW(mask_by_contour(star, 0, 5), std::invalid_argument);
}

TEST(PhotoMask, ContourFilesAreRead) {
  const std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("contour_test_" + std::to_string(::getpid()) + ".txt");
  vpe::base::write_file(path, std::string_view("# outline\n 1.5, 2\r\n\n30,2\n 3e1 ,40.25"));
  const std::vector<glm::dvec2> points = read_contour_file(path);
  ASSERT_EQ(points.size(), 3U);
  EXPECT_EQ(points[0], glm::dvec2(1.5, 2));
  EXPECT_EQ(points[2], glm::dvec2(30, 40.25));
  const auto why = [&](std::string_view text) {
    vpe::base::write_file(path, text);
    try {
      read_contour_file(path);
    } catch (const vpe::base::FileError& error) {
      EXPECT_TRUE(has(error.what(), "contour_test_"));
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_TRUE(has(why("1,2\n3,4\n5;6\n"), "line 3"));
  EXPECT_TRUE(has(why("1,2\n3,4 5\n"), "line 2"));
  EXPECT_TRUE(has(why("1,2\nnan,4\n"), "line 2"));
  EXPECT_TRUE(has(why("1,2\n1e300,4\n"), "line 2"));
  EXPECT_TRUE(has(why("1,2\n3,4\n"), "it has 2 points"));
  EXPECT_TRUE(has(why(""), "it has 0 points"));
  std::filesystem::remove(path);
}

}  // namespace
}  // namespace objects
