// The ground at and beyond the edge of the data.
#include "paging/build/nodata_fill.h"

#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <map>

#include "lod/tree/facet_mask.h"
#include "paging/build/crossing_map.h"
#include "paging/planet/verify.h"
#include "tests/paging/planet_fixture.h"

namespace {

using test_support::build_fake;
using test_support::bumpy_height;
using test_support::FakeElevation;
using test_support::fine_around;
using test_support::Random;
using test_support::SpacingElevation;
using test_support::TempDir;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

// Returns hills with a hole over a corner of the cube and another one within a face.
double hills_with_holes(const glm::dvec3& d) {
  const bool is_nodata = glm::length(d - glm::normalize(glm::dvec3(1, 1, 1))) < 0.3 ||
                         glm::length(d - glm::normalize(glm::dvec3(1, 0.1, 0.2))) < 0.11;
  return is_nodata ? kNaN : 4000 + bumpy_height(d);
}

// Calls visit(tile, post, neighbour) for neighbouring posts of all finest tiles.
template <class Visit>
void visit_neighbours(const paging::PlanetFile& planet, const Visit& visit) {
  for (const lod::TileInfo& info : planet.tree().tiles()) {
    if (info.has_children) continue;
    const paging::TileHeights tile = planet.heights(info.key);
    const auto side = static_cast<std::size_t>(tile.posts.side());
    for (std::size_t n = 0; n < side * side; ++n) {
      if (n % side + 1 < side) visit(tile, n, n + 1);
      if (n + side < side * side) visit(tile, n, n + side);
    }
  }
}

TEST(NodataFill, GroundHasNoStepAtTheEdgeOfData) {
  TempDir dir;
  const auto planet = build_fake(dir / "p.vpe", FakeElevation(hills_with_holes), 40000);
  double inside_m = 0;
  double across_m = 0;
  int across = 0;
  visit_neighbours(*planet, [&](const paging::TileHeights& tile, std::size_t a, std::size_t b) {
    const double step = std::abs(tile.posts.height_m[a] - tile.posts.height_m[b]);
    const bool no_a = !tile.nodata.empty() && tile.nodata[a];
    const bool no_b = !tile.nodata.empty() && tile.nodata[b];
    if (!no_a && !no_b) inside_m = std::max(inside_m, step);
    if (no_a == no_b) return;
    across_m = std::max(across_m, step);
    ++across;
  });
  EXPECT_GT(across, 100);
  EXPECT_LT(across_m, 1.5 * inside_m) << across << " pairs";
}

TEST(NodataFill, TilesAgreeOnTheirPostsAcrossLevelsAndFaces) {
  TempDir dir;
  // Fine tiles at the rims of both holes, beside coarse ones.
  const glm::dvec3 rim = glm::normalize(glm::dvec3(1, 1, 0.55));
  const SpacingElevation source(hills_with_holes, fine_around(rim, 0.05, 10000));
  const auto planet = build_fake(dir / "p.vpe", source, 200000);
  EXPECT_GT(planet->meta().finest_level, 2);
  const paging::VerifyReport report = paging::verify(*planet, {.threads = 2, .deep_tiles = 100000});
  EXPECT_TRUE(report.problems.empty())
      << (report.problems.empty() ? std::string() : report.problems.front().what);
  // Posts at equal places have equal heights, whichever tile stores them.
  std::map<std::array<double, 3>, double> height_of;
  int shared = 0;
  for (const lod::TileInfo& info : planet->tree().tiles()) {
    const paging::TileHeights tile = planet->heights(info.key);
    if (tile.nodata.empty()) continue;
    const lod::GridLines lines = lod::grid_lines(info.key, tile.posts.intervals);
    const int side = tile.posts.side();
    for (int n = 0; n < side * side; ++n) {
      // Posts between those of a coarser neighbour lie on its edges.
      const int i = n % side;
      const int j = n / side;
      const int edges = (i == 0 ? 1 << static_cast<int>(lod::Edge::kWest) : 0) |
                        (i == side - 1 ? 1 << static_cast<int>(lod::Edge::kEast) : 0) |
                        (j == 0 ? 1 << static_cast<int>(lod::Edge::kSouth) : 0) |
                        (j == side - 1 ? 1 << static_cast<int>(lod::Edge::kNorth) : 0);
      if ((edges & tile.coarser_neighbour_mask) != 0 && (i % 2 != 0 || j % 2 != 0)) continue;
      const glm::dvec3 d = mars::chart_direction(info.key.face, lines.u[static_cast<std::size_t>(i)],
                                                 lines.v[static_cast<std::size_t>(j)]);
      const auto [it, is_new] =
          height_of.try_emplace({d.x, d.y, d.z}, tile.posts.height_m[static_cast<std::size_t>(n)]);
      if (is_new) continue;
      ++shared;
      EXPECT_EQ(it->second, tile.posts.height_m[static_cast<std::size_t>(n)]) << lod::to_string(info.key);
    }
  }
  EXPECT_GT(shared, 1000);
}

TEST(NodataFill, WithoutAnyDataNearTheMeanIsLeft) {
  TempDir dir;
  const auto planet = build_fake(
      dir / "p.vpe", FakeElevation([](const glm::dvec3& d) { return d.z > -0.9 ? kNaN : 700.0; }), 200000);
  const paging::Surface surface(planet, 1 << 24);
  EXPECT_NEAR(surface.at({0, 0, 1}).height_m, planet->meta().fill_m, 0.1);
  EXPECT_TRUE(surface.at({0, 0, 1}).nodata);
}

// An array and a hash table give the same answers.
TEST(CrossingMap, KeepsWhatIsAddedWhereverItLies) {
  using paging::Crossing;
  Random random(12);
  for (const int reach : {40, 100000000}) {
    std::vector<Crossing> crossings;
    for (int n = 0; n < 500; ++n) crossings.push_back({random.integer(0, reach), random.integer(0, reach)});
    paging::CrossingMap<int> map(crossings, 1);
    std::map<std::pair<std::int64_t, std::int64_t>, int> expected;
    for (int n = 0; n < 500; ++n) {
      const Crossing& c = crossings[static_cast<std::size_t>(n)];
      const Crossing beside{c.i + 1, c.j - 1};
      for (const Crossing& at : {c, beside}) {
        int* value = map.add(at);
        EXPECT_EQ(value != nullptr, expected.try_emplace({at.i, at.j}, n).second);
        if (value != nullptr) *value = n;
      }
      EXPECT_EQ(map.find({c.i - 1, c.j}) != nullptr, expected.contains({c.i - 1, c.j}));
    }
    for (const auto& [at, value] : expected) EXPECT_EQ(*map.find({at.first, at.second}), value);
  }
}

// The fill as paging/build/nodata_fill.h describes it, post by post and by recursion.
class SlowFill {
 public:
  SlowFill(const paging::SampleInputs& sampling, mars::Face face) : sampling_(sampling), face_(face) {}

  double height_m(int grid_level, std::int64_t i, std::int64_t j) { return find(grid_level, i, j).first; }

 private:
  using Place = std::array<std::int64_t, 3>;

  glm::dvec3 direction(int g, std::int64_t i, std::int64_t j) const {
    return mars::chart_direction(face_, mars::face_line(i, g), mars::face_line(j, g));
  }
  double sample(const glm::dvec3& d, int g) const {
    double h = kNaN;
    sampling_.elevation.sample({&d, 1}, spacing_m(g), {&h, 1});
    return h;
  }
  double spacing_m(int g) const {
    const lod::TileShape& tile = sampling_.meta.tile;
    return std::ldexp(lod::post_spacing_m(0, tile.intervals(), sampling_.meta.radius_m), tile.k - g);
  }

  double mean_around(int g, std::int64_t i, std::int64_t j) const {
    const std::int64_t last = std::int64_t{1} << g;
    double sum = 0;
    double weights = 0;
    const auto add = [&](const glm::dvec3& d, double weight) {
      const double h = sample(d, g);
      if (std::isnan(h)) return;
      sum += weight * h;
      weights += weight;
    };
    if (i == 0 || j == 0 || i == last || j == last) {
      const mars::LonLat place = mars::lon_lat(direction(g, i, j));
      for (int n = 0; n < 8; ++n)
        add(mars::direction(mars::destination(place, 45.0 * n, spacing_m(g) / sampling_.meta.radius_m)), 1.0);
    } else {
      for (int n = 0; n < 9; ++n)
        if (n != 4) add(direction(g, i + n % 3 - 1, j + n / 3 - 1), n % 2 == 1 ? 1.0 : 0.5);
    }
    return weights > 0 ? sum / weights : kNaN;
  }

  // Returns the height, and whether there are data near.
  std::pair<double, bool> find(int g, std::int64_t i, std::int64_t j) {
    const auto known = found_.find(Place{g, i, j});
    if (known != found_.end()) return known->second;
    double h = sample(direction(g, i, j), g);
    if (std::isnan(h)) h = mean_around(g, i, j);
    const bool is_near_data = !std::isnan(h);
    if (!is_near_data && g == 0) h = sampling_.meta.fill_m;
    if (!is_near_data && g > 0) {
      double sum = 0;
      double weights = 0;
      for (std::int64_t b = j >> 1; b <= (j + 1) >> 1; ++b) {
        for (std::int64_t a = i >> 1; a <= (i + 1) >> 1; ++a) {
          const auto [height_m, near] = find(g - 1, a, b);
          sum += (near ? 1 : 0.25) * height_m;
          weights += near ? 1 : 0.25;
        }
      }
      h = sum / weights;
    }
    return found_[Place{g, i, j}] = {h, is_near_data};
  }

  const paging::SampleInputs& sampling_;
  mars::Face face_;
  std::map<Place, std::pair<double, bool>> found_;
};

// In tiles of posts side by side, and in coarse ones whose posts are those of far finer tiles.
TEST(NodataFill, IsThatOfTheRecursion) {
  paging::PlanetMeta meta;
  meta.tile.k = 4;
  meta.fill_m = 123;
  const FakeElevation source(hills_with_holes);
  const paging::BuildPlan plan(meta.tile, meta.radius_m,
                               [](const lod::TileKey&, const mars::Cap&) { return 1e6; });
  const paging::SampleInputs sampling{meta, plan, source};
  const int side = meta.tile.posts();
  Random random(8);
  int filled = 0;
  for (const lod::TileKey key :
       {lod::TileKey{mars::Face::kPlusX, 0, 0, 0}, lod::TileKey{mars::Face::kPlusX, 1, 1, 1},
        lod::TileKey{mars::Face::kPlusX, 3, 4, 5}, lod::TileKey{mars::Face::kPlusX, 3, 7, 7},
        lod::TileKey{mars::Face::kPlusY, 2, 0, 3}, lod::TileKey{mars::Face::kPlusX, 5, 18, 19}}) {
    for (const int most_finer : {0, 1, 12}) {
      SCOPED_TRACE(lod::to_string(key) + " finer by " + std::to_string(most_finer));
      SlowFill slow(sampling, key.face);
      std::vector<double> heights;
      std::vector<double> expected;
      std::vector<int> levels;
      for (int n = 0; n < side * side; ++n) {
        const int level = key.level + random.integer(0, most_finer);
        const int g = level + meta.tile.k;
        const std::int64_t i = std::int64_t{key.i * (side - 1) + n % side} << (level - key.level);
        const std::int64_t j = std::int64_t{key.j * (side - 1) + n / side} << (level - key.level);
        const glm::dvec3 d = mars::chart_direction(key.face, mars::face_line(i, g), mars::face_line(j, g));
        levels.push_back(level);
        heights.push_back(hills_with_holes(d));
        expected.push_back(std::isnan(heights.back()) ? slow.height_m(g, i, j) : heights.back());
        filled += std::isnan(heights.back()) ? 1 : 0;
      }
      paging::fill_nodata(sampling, key, levels, heights);
      EXPECT_EQ(heights, expected);
    }
  }
  EXPECT_GT(filled, 500);
}

TEST(SurfaceNodata, IsThatOfTheFacetsPosts) {
  TempDir dir;
  const auto planet = build_fake(dir / "p.vpe", FakeElevation(hills_with_holes), 100000);
  const paging::Surface surface(planet, 1 << 26);
  Random random(7);
  int nodata = 0;
  int beside = 0;
  for (int n = 0; n < 20000; ++n) {
    const glm::dvec3 middle = glm::normalize(n % 2 == 0 ? glm::dvec3(1, 1, 1) : glm::dvec3(1, 0.1, 0.2));
    const glm::dvec3 d = glm::normalize(middle + 0.35 * random.direction());
    const paging::SurfacePoint point = surface.at(d);
    paging::TileHeights tile = planet->heights(point.tile);
    // The judge: a facet through a post that is not a number has no height.
    for (std::size_t k = 0; k < tile.nodata.size(); ++k)
      if (tile.nodata[k]) tile.posts.height_m[k] = kNaN;
    const mars::ChartPoint at = mars::chart_point(d);
    const lod::GridLines lines = lod::grid_lines(point.tile, tile.posts.intervals);
    const double height = lod::surface_height(tile.posts, lines, at.u, at.v, planet->radius_m());
    EXPECT_EQ(point.nodata, std::isnan(height)) << n;
    nodata += point.nodata ? 1 : 0;
    beside += point.nodata && std::isfinite(hills_with_holes(d)) ? 1 : 0;
  }
  EXPECT_GT(nodata, 1000);
  EXPECT_GT(beside, 100);  // places that were answered with heights mixed with the fill
}

TEST(FacetMask, AskedAtPostsEdgesAndFacets) {
  // Two rows of three posts; the middle one of the south row is flagged.
  const std::vector<bool> flags{false, true, false, false, false, false};
  const auto flagged = [&](std::size_t cell, double x, double y) {
    return lod::is_flagged(flags, cell, 3, x, y);
  };
  EXPECT_FALSE(flagged(0, 0, 0));      // a post
  EXPECT_TRUE(flagged(0, 1, 0));       // the flagged one
  EXPECT_TRUE(flagged(1, 0, 0));       // the same, of the next cell
  EXPECT_TRUE(flagged(0, 0.5, 0));     // on its edges
  EXPECT_TRUE(flagged(1, 0.5, 0.5));   // a diagonal
  EXPECT_FALSE(flagged(0, 0.5, 0.5));  // the diagonal of the other cell
  EXPECT_TRUE(flagged(0, 0.6, 0.3));   // facets
  EXPECT_FALSE(flagged(0, 0.3, 0.6));
  EXPECT_TRUE(flagged(1, 0.6, 0.3));
  EXPECT_TRUE(flagged(1, 0.3, 0.6));
  EXPECT_FALSE(flagged(0, 1, 1));
  EXPECT_FALSE(flagged(1, 1, 0.5));
}

}  // namespace
