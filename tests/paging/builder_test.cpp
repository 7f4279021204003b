#include "paging/build/builder.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <mutex>
#include <set>

#include "paging/build/source_heights.h"
#include "tests/paging/planet_fixture.h"
#include "tests/support/worst.h"

namespace {

using test_support::build_fake;
using test_support::bumpy_height;
using test_support::FakeElevation;
using test_support::fine_around;
using test_support::Random;
using test_support::TempDir;

const glm::dvec3 kCorner = glm::normalize(glm::dvec3(1, 1, 1));

// Posts of the finest tiles equal the source up to half a quantum, also on all borders.
TEST(Builder, PostsAreTheSource) {
  TempDir dir;
  const FakeElevation source(bumpy_height, fine_around(kCorner, 0.05, 20000));
  const auto planet = build_fake(dir / "p.vpe", source, 200000);
  const double quantum = planet->meta().quantum_m;
  int constrained = 0;
  for (const lod::TileInfo& info : planet->tree().tiles()) {
    const paging::TileHeights heights = planet->heights(info.key);
    const lod::GridLines lines = lod::grid_lines(info.key, heights.posts.intervals);
    for (int j = 0; j < heights.posts.side(); ++j) {
      for (int i = 0; i < heights.posts.side(); ++i) {
        const double h = heights.posts.at(i, j);
        const glm::dvec3 d = mars::chart_direction(info.key.face, lines.u[static_cast<std::size_t>(i)],
                                                   lines.v[static_cast<std::size_t>(j)]);
        if (std::abs(h - bumpy_height(d)) <= 0.5 * quantum + 1e-9) continue;
        // Only odd border posts of a finest tile beside a coarser one may differ: they lie on its edges.
        ASSERT_FALSE(info.has_children);
        const int last = heights.posts.intervals;
        ASSERT_TRUE(((i == 0 || i == last) && j % 2 == 1) || ((j == 0 || j == last) && i % 2 == 1));
        ++constrained;
      }
    }
  }
  EXPECT_GT(constrained, 0);
}

// Heights of a large part of the radius in steps from post to post, and posts close to the centre.
TEST(Builder, SteepGroundOfSmallBodiesIsBuiltOrRefused) {
  TempDir dir;
  const auto steps = [](double low, double high) {
    return [=](const glm::dvec3& d) {
      const double side = std::floor(40 * d.x) + std::floor(40 * d.y) + std::floor(40 * d.z);
      return mars::kMarsRadius_m * (std::fmod(std::abs(side), 2) == 0 ? low : high);
    };
  };
  for (const double low : {-0.3, -0.9, -0.998}) {
    SCOPED_TRACE(low);
    const FakeElevation source(steps(low, 0.3), fine_around(kCorner, 0.05, 40000));
    const auto planet = build_fake(dir / "p.vpe", source, 400000);
    EXPECT_NEAR(planet->meta().highest_radius_m, 1.3 * mars::kMarsRadius_m, 1);
  }
  for (const double low : {-0.9995, -1.0, -1.5, -1e30}) {
    SCOPED_TRACE(low);
    const FakeElevation source(steps(low, 0.3), fine_around(kCorner, 0.05, 40000));
    EXPECT_THROW(build_fake(dir / "q.vpe", source, 400000), paging::UnusableSource);
    EXPECT_FALSE(std::filesystem::exists(dir / "q.vpe.part"));
  }
}

// Overwrites its file in the middle of the build, as a download or a program that is still writing does.
class ChangingElevation final : public FakeElevation {
 public:
  ChangingElevation(std::filesystem::path file, std::function<void()> change)
      : FakeElevation(bumpy_height), stamp_(*mars::file_stamp(file.string())), change_(std::move(change)) {}
  std::vector<mars::SourceInfo> infos() const override {
    auto infos = FakeElevation::infos();
    infos[0].files = {stamp_};
    return infos;
  }
  void sample(std::span<const glm::dvec3> directions, double spacing_m,
              std::span<double> heights_m) const override {
    std::call_once(once_, change_);
    FakeElevation::sample(directions, spacing_m, heights_m);
  }

 private:
  mars::FileStamp stamp_;
  std::function<void()> change_;
  mutable std::once_flag once_;
};

TEST(Builder, ASourceThatChangesDuringTheBuildIsRefused) {
  TempDir dir;
  const std::filesystem::path file = dir / "dem.bin";
  const auto write = [&](const std::string& text) { std::ofstream(file, std::ios::binary) << text; };
  const std::string whole(100'000, 'a');
  write(whole);
  const auto time = std::filesystem::last_write_time(file);
  const auto message = [&](const std::function<void()>& change) -> std::string {
    try {
      build_fake(dir / "p.vpe", ChangingElevation(file, change), 1e6);
    } catch (const paging::UnusableSource& e) {
      EXPECT_FALSE(std::filesystem::exists(dir / "p.vpe"));
      EXPECT_FALSE(std::filesystem::exists(dir / "p.vpe.part"));
      return e.what();
    }
    return "";
  };
  EXPECT_EQ(message([] {}), "");
  std::filesystem::remove(dir / "p.vpe");
  EXPECT_NE(message([&] { write(whole + "b"); }).find("dem.bin: has changed"), std::string::npos);
  write(whole);
  EXPECT_NE(message([&] { std::filesystem::last_write_time(file, time + std::chrono::milliseconds(7)); }), "");
  // Size and time are kept.
  EXPECT_NE(message([&] {
              write(std::string(100'000, 'b'));
              std::filesystem::last_write_time(file, time + std::chrono::milliseconds(7));
            }),
            "");
  EXPECT_NE(message([&] { std::filesystem::remove(file); }), "");
}

// The reference surface from both sides of every tile border, at posts and between them.
TEST(Builder, SurfaceIsWatertightAcrossAllBorders) {
  TempDir dir;
  const FakeElevation source(bumpy_height, fine_around(kCorner, 0.05, 20000));
  const auto planet = build_fake(dir / "p.vpe", source, 200000);
  const paging::Surface surface(planet, 1 << 26);
  Random random(31);
  double worst = 0;
  for (const lod::TileInfo& info : planet->tree().tiles()) {
    if (info.has_children) continue;
    const auto tile = surface.tile(info.key);
    const mars::ChartRect rect = lod::chart_rect(info.key);
    for (int n = 0; n < 40; ++n) {
      const double t = random.uniform(0, 1);
      const bool vertical = n % 2 == 0;
      const bool far = n % 4 < 2;
      const double u = vertical ? (far ? rect.u1 : rect.u0) : rect.u0 + t * (rect.u1 - rect.u0);
      const double v = vertical ? rect.v0 + t * (rect.v1 - rect.v0) : (far ? rect.v1 : rect.v0);
      const double own = lod::surface_height(tile->data.posts, tile->lines, u, v, planet->radius_m());
      // Just outside, on whatever tile and face that is.
      const double step = 1e-12;
      const glm::dvec3 outside = mars::cube_point(rect.face, u + (vertical ? (far ? step : -step) : 0.0),
                                                  v + (vertical ? 0.0 : (far ? step : -step)));
      worst = std::max(worst, std::abs(surface.at(outside).height_m - own));
    }
  }
  // 1e-12 of a radius beside the border, on slopes of up to one.
  test_support::record_worst("S from both sides of a border", worst, 1e-5, "m");
}

TEST(Builder, ErrorsBoundTheDistanceAndNest) {
  TempDir dir;
  const FakeElevation source(bumpy_height, fine_around(kCorner, 0.05, 20000));
  const auto planet = build_fake(dir / "p.vpe", source, 200000);
  const paging::Surface surface(planet, 1 << 26);
  Random random(32);
  for (const lod::TileInfo& info : planet->tree().tiles()) {
    for (std::size_t v = 0; v + 1 < info.variants.size() + (info.has_children ? 1U : 0U); ++v) {
      const paging::PackedMesh packed = planet->mesh(info.key, static_cast<int>(v));
      const lod::GridLines lines = lod::grid_lines(info.key, packed.mesh.intervals);
      double worst = 0;
      for (int n = 0; n < 60; ++n) {
        // A random place in a random triangle of the mesh.
        const auto t =
            static_cast<std::size_t>(random.integer(0, static_cast<int>(packed.mesh.triangle_count()) - 1));
        glm::dvec3 p(0);
        double a = random.uniform(0, 1);
        double b = random.uniform(0, 1);
        if (a + b > 1) a = 1 - a, b = 1 - b;
        const std::array<double, 3> weight{a, b, 1 - a - b};
        for (std::size_t k = 0; k < 3; ++k) {
          const std::size_t at = packed.mesh.triangles[3 * t + k];
          const lod::MeshVertex vertex = packed.mesh.vertices[at];
          p += weight[k] * mars::chart_direction(info.key.face, lines.u[vertex.i], lines.v[vertex.j]) *
               (planet->radius_m() + packed.height_q[at] * planet->meta().quantum_m);
        }
        worst = std::max(worst, std::abs(glm::length(p) - surface.at(p).radius_m));
      }
      EXPECT_LE(worst, info.variants[v].terms.total_m + 1e-6) << lod::to_string(info.key) << " variant " << v;
    }
    if (!info.has_children) {
      EXPECT_EQ(info.variants.back().terms.total_m, 0);
      EXPECT_FALSE(info.posts_terms.known());
      continue;
    }
    ASSERT_TRUE(info.posts_terms.known());
    const lod::Posts posts = planet->heights(info.key).posts;
    const lod::GridLines lines = lod::grid_lines(info.key, posts.intervals);
    double worst = 0;
    for (int n = 0; n < 300; ++n) {
      const double u = random.uniform(lines.u.front(), lines.u.back());
      const double v = random.uniform(lines.v.front(), lines.v.back());
      const glm::dvec3 direction = mars::chart_direction(info.key.face, u, v);
      const double grid_m = lod::surface_height(posts, lines, u, v, planet->radius_m());
      worst = std::max(worst, std::abs(grid_m - surface.at(direction).height_m));
    }
    EXPECT_LE(worst, info.posts_terms.terms().total_m + 1e-6) << lod::to_string(info.key);
    EXPECT_GE(worst, info.posts_terms.terms().total_m * 0.05) << lod::to_string(info.key);
  }
}

TEST(Builder, ContentDoesNotDependOnThreads) {
  TempDir dir;
  const FakeElevation source(bumpy_height, fine_around({0, 0, 1}, 0.05, 40000));
  const auto one = build_fake(dir / "one.vpe", source, 300000, 1);
  const auto four = build_fake(dir / "four.vpe", source, 300000, 4);
  EXPECT_EQ(one->meta().identity, four->meta().identity);
  EXPECT_TRUE(one->meta() == four->meta());
}

TEST(Builder, APlanThatIsPassedInGivesTheSamePlanet) {
  TempDir dir;
  const FakeElevation source(bumpy_height, fine_around({0, 0, 1}, 0.05, 40000));
  const auto own = build_fake(dir / "own.vpe", source, 300000);
  paging::BuildOptions options;
  options.output = (dir / "given.vpe").string();
  options.base_spacing_m = 300000;
  options.threads = 2;
  options.tile_k = 5;
  options.resampling_posts = 5000;
  const paging::BuildPlan plan = paging::plan_tiles(options, source);
  EXPECT_TRUE(paging::build_planet(options, source, nullptr, {}, plan).meta == own->meta());
}

TEST(Builder, ResamplingErrorIsMeasured) {
  TempDir dir;
  const FakeElevation source(bumpy_height);
  const auto coarse = build_fake(dir / "coarse.vpe", source, 400000);
  const auto fine = build_fake(dir / "fine.vpe", source, 100000);
  EXPECT_EQ(fine->meta().resampling.posts, 5000);
  EXPECT_GT(coarse->meta().resampling.rms_m, 2 * fine->meta().resampling.rms_m);
  // The same by hand.
  const paging::Surface surface(fine, 1 << 26);
  double worst = 0;
  source.visit_posts(5000, [&](std::span<const glm::dvec3> directions, std::span<const double> heights) {
    for (std::size_t n = 0; n < directions.size(); ++n) {
      worst = std::max(worst, std::abs(surface.at(directions[n]).height_m - heights[n]));
    }
  });
  EXPECT_NEAR(worst, fine->meta().resampling.max_m, 1e-6);
}

TEST(Builder, NodataPlacesAreKnown) {
  TempDir dir;
  const FakeElevation source([](const glm::dvec3& d) { return d.z > 0.5 ? std::nan("") : 1000.0; });
  const auto planet = build_fake(dir / "p.vpe", source, 200000);
  const paging::Surface surface(planet, 1 << 26);
  EXPECT_TRUE(surface.at({0, 0, 1}).nodata);
  EXPECT_FALSE(surface.at({0, 0, -1}).nodata);
  EXPECT_NEAR(surface.at({0, 0, 1}).height_m, 1000.0, 0.1);  // filled, so that images have no pit

  // On every level, inner tiles too, masks agree with the source at each post.
  std::set<int> levels;
  const auto check = [&](const auto& self, const lod::TileKey& key) -> bool {
    const lod::TileInfo* info = planet->tree().find(key);
    const paging::TileHeights tile = planet->heights(key);
    const lod::GridLines lines = lod::grid_lines(key, tile.posts.intervals);
    const auto side = static_cast<std::size_t>(tile.posts.side());
    bool any = false;
    for (std::size_t j = 0; j < side; ++j) {
      for (std::size_t i = 0; i < side; ++i) {
        const glm::dvec3 p = mars::cube_point(key.face, lines.u[i], lines.v[j]);
        const bool nodata = !tile.nodata.empty() && tile.nodata[j * side + i];
        EXPECT_EQ(nodata, p.z / glm::length(p) > 0.5) << lod::to_string(key) << " " << i << " " << j;
        any = any || nodata;
      }
    }
    if (any) levels.insert(key.level);
    EXPECT_EQ(any, !tile.nodata.empty());
    if (info->has_children) {
      for (int c = 0; c < 4; ++c) any = self(self, lod::child(key, c)) || any;
    }
    EXPECT_EQ(planet->has_nodata(key), any) << lod::to_string(key);
    return any;
  };
  for (int f = 0; f < mars::kFaces; ++f) check(check, {static_cast<mars::Face>(f), 0, 0, 0});
  EXPECT_EQ(static_cast<int>(levels.size()), planet->meta().finest_level + 1);
}

TEST(Builder, RegionsKnowCapsAcrossTheAntimeridianAndPoles) {
  const auto cap = [](double lon, double lat, double radius_deg) {
    return mars::Cap{mars::direction({lon, lat}), radius_deg * mars::kRadiansPerDegree};
  };
  const paging::Region pacific{170, -10, -170, 10};
  EXPECT_TRUE(paging::touches(pacific, cap(180, 0, 1)));
  EXPECT_TRUE(paging::touches(pacific, cap(-175, 5, 1)));
  EXPECT_TRUE(paging::touches(pacific, cap(165, 0, 6)));
  EXPECT_FALSE(paging::touches(pacific, cap(165, 0, 4)));
  EXPECT_FALSE(paging::touches(pacific, cap(0, 0, 30)));
  EXPECT_FALSE(paging::touches(pacific, cap(180, 20, 5)));
  const paging::Region north{0, 80, 10, 90};
  EXPECT_TRUE(paging::touches(north, cap(180, 89, 2)));
  // Never a false negative, for random caps and random places of the region.
  Random random(33);
  for (int n = 0; n < 20000; ++n) {
    const paging::Region r{random.uniform(-180, 180), random.uniform(-90, 0), random.uniform(-180, 180),
                           random.uniform(0, 90)};
    double width = r.east_deg - r.west_deg;
    if (width < 0) width += 360;
    const mars::LonLat inside{r.west_deg + random.uniform(0, width), random.uniform(r.south_deg, r.north_deg)};
    const mars::Cap c{random.direction(), random.uniform(0, 1.5)};
    if (mars::angle_between_rad(c.centre, mars::direction(inside)) < c.radius_rad) {
      ASSERT_TRUE(paging::touches(r, c));
    }
  }
}

}  // namespace
