// Patched planets: a finished planet file and changed sources give the planet file of the full build.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <fstream>

#include "paging/planet/sqlite.h"
#include "paging/planet/verify.h"
#include "tests/paging/forged_planet.h"
#include "tests/paging/planet_fixture.h"

namespace {

using test_support::bumpy_height;
using test_support::FakeElevation;
using test_support::FakeImage;
using test_support::Random;
using test_support::TempDir;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

bool meet(const mars::Cap& a, const mars::Cap& b) {
  return mars::angle_between_rad(a.centre, b.centre) <= a.radius_rad + b.radius_rad;
}

// Gives heights under a name of its own, and counts the places that are sampled.
class NamedElevation : public FakeElevation {
 public:
  NamedElevation(std::string name, double resolution_m, Height height, Spacing spacing)
      : FakeElevation(std::move(height), std::move(spacing)),
        name_(std::move(name)),
        resolution_m_(resolution_m) {}
  std::vector<mars::SourceInfo> infos() const override {
    mars::SourceInfo info = FakeElevation::infos().front();
    info.name = name_;
    info.resolution_m = resolution_m_;
    return {info};
  }
  void sample(std::span<const glm::dvec3> directions, double spacing_m,
              std::span<double> heights_m) const override {
    places_ += static_cast<std::int64_t>(directions.size());
    FakeElevation::sample(directions, spacing_m, heights_m);
  }
  std::int64_t places() const { return places_; }

 private:
  std::string name_;
  double resolution_m_;
  mutable std::atomic<std::int64_t> places_ = 0;
};

using Source = std::shared_ptr<const NamedElevation>;

// Data of the whole planet but for a hole, and finer ones about a place.
Source base() {
  const mars::Cap hole{glm::normalize(glm::dvec3(-1, 0.2, -0.4)), 0.1};
  const mars::Cap fine{glm::normalize(glm::dvec3(1, 1, 1)), 0.06};
  return std::make_shared<NamedElevation>(
      "base", 60000,
      [hole](const glm::dvec3& d) {
        return mars::angle_between_rad(d, hole.centre) < hole.radius_rad ? kNaN : bumpy_height(d);
      },
      [fine](const mars::Cap& cap) { return meet(cap, fine) ? 60000.0 : 150000.0; });
}

// Data in a cap.
Source strip(const mars::Cap& where, double spacing_m, const std::string& name = "strip") {
  return std::make_shared<NamedElevation>(
      name, spacing_m,
      [where](const glm::dvec3& d) {
        const double r = mars::angle_between_rad(d, where.centre) / where.radius_rad;
        return r < 1 ? bumpy_height(d) + 900 * (1 - r * r) : kNaN;
      },
      [where, spacing_m](const mars::Cap& cap) {
        return meet(cap, where) ? spacing_m : std::numeric_limits<double>::infinity();
      });
}

std::shared_ptr<const mars::ElevationSource> stacked(
    std::vector<std::shared_ptr<const mars::ElevationSource>> all) {
  return mars::stack_elevation(std::move(all));
}

paging::ChangedIn changes_of(const Source& source) {
  return [source](const mars::Cap& cap) { return std::isfinite(source->spacing_in(cap)); };
}

const paging::ChangedIn kNowhere = [](const mars::Cap&) { return false; };

// Expects equal content and figures. Resampling errors are not compared: which posts of each source are looked at follows
// from the number of sources.
void expect_equal(paging::PlanetMeta a, paging::PlanetMeta b) {
  for (paging::PlanetMeta* meta : {&a, &b}) {
    meta->resampling = {};
    for (paging::LevelSummary& level : meta->levels) {
      level.resampling = {};
      level.resampling_by_source.clear();
    }
  }
  EXPECT_TRUE(a == b) << a.identity << " is not " << b.identity;
}

class Patch : public testing::Test {
 protected:
  paging::BuildOptions options(const std::string& name) const {
    paging::BuildOptions o;
    o.output = (dir_ / name).string();
    o.base_spacing_m = 200000;
    o.threads = 2;
    o.tile_k = 4;
    o.quantum_m = 0.125;
    o.resampling_posts = 2000;
    o.commit_s = 0;
    return o;
  }
  std::string path(const std::string& name) const { return (dir_ / name).string(); }

  void SetUp() override { paging::build_planet(options("p.vpe"), *base(), &image_); }

  paging::BuildSummary patch(const std::string& name, const Source& added,
                             const paging::ProgressFunction& progress = {}) const {
    const auto all = stacked({base(), added});
    return paging::patch_planet(options(name), {path("p.vpe"), changes_of(added), kNowhere}, *all, &image_,
                                progress);
  }

  // Returns the message of a patch that must be refused.
  std::string refusal(const paging::BuildOptions& o, const mars::ElevationSource& all,
                      const mars::ImageSource* image) const {
    try {
      paging::patch_planet(o, {path("p.vpe"), kNowhere, kNowhere}, all, image);
    } catch (const std::runtime_error& e) {
      EXPECT_FALSE(std::filesystem::exists(o.output));
      EXPECT_FALSE(std::filesystem::exists(o.output + ".part"));
      return e.what();
    }
    ADD_FAILURE() << "not refused";
    return "";
  }

  TempDir dir_;
  const FakeImage image_{};
};

void expect_sound(const std::string& path) {
  const auto planet = paging::PlanetFile::open(path);
  const auto report = paging::verify(*planet, {.threads = 2, .deep_tiles = 10});
  EXPECT_TRUE(report.problems.empty()) << report.problems.front().where << ": " << report.problems.front().what;
}

TEST_F(Patch, EqualsTheFullBuild) {
  Random random(270);
  const paging::PlanetMeta before = paging::PlanetFile::open(path("p.vpe"))->meta();
  const std::vector<glm::dvec3> places{{0, 0, 1},
                                       glm::normalize(glm::dvec3(1, 1, 1)),
                                       {-1, 0, 0},
                                       glm::normalize(glm::dvec3(1, 0, 1)),
                                       random.direction()};
  for (std::size_t n = 0; n < places.size(); ++n) {
    SCOPED_TRACE(n);
    const double spacing_m = n % 3 == 0 ? 150000 : n % 3 == 1 ? 40000 : 15000;
    const Source added = strip({places[n], random.log_uniform(0.005, 0.1)}, spacing_m);
    const auto patched = patch("patched.vpe", added);
    const auto full = paging::build_planet(options("full.vpe"), *stacked({base(), added}), &image_);
    expect_equal(patched.meta, full.meta);
    EXPECT_GT(patched.kept, before.image_tiles + before.tiles / 2);
    EXPECT_LT(patched.kept, full.meta.tiles + full.meta.image_tiles);
    expect_sound(path("patched.vpe"));
  }
}

TEST_F(Patch, SamplesOnlyWhatChanges) {
  const Source added = strip({glm::normalize(glm::dvec3(0.3, -1, 0.2)), 0.01}, 40000);
  const Source below = base();
  const auto all = stacked({below, added});
  paging::patch_planet(options("patched.vpe"), {path("p.vpe"), changes_of(added), kNowhere}, *all, &image_);
  const Source full_below = base();
  paging::build_planet(options("full.vpe"), *stacked({full_below, added}), &image_);
  EXPECT_LT(below->places(), full_below->places() / 2);
}

TEST_F(Patch, NothingChangedKeepsAllButNodata) {
  const auto patched =
      paging::patch_planet(options("same.vpe"), {path("p.vpe"), kNowhere, kNowhere}, *base(), &image_);
  const paging::PlanetMeta before = paging::PlanetFile::open(path("p.vpe"))->meta();
  expect_equal(patched.meta, before);
  EXPECT_EQ(patched.meta.resampling.posts, before.resampling.posts);
  EXPECT_EQ(patched.meta.resampling.max_m, before.resampling.max_m);
  EXPECT_NEAR(patched.meta.resampling.rms_m, before.resampling.rms_m, 1e-9 * before.resampling.rms_m);
  EXPECT_GT(patched.kept, patched.meta.image_tiles + patched.meta.tiles / 2);
}

TEST_F(Patch, APatchedPlanetIsPatchedAgainAndInPlace) {
  const Source first = strip({{0, -1, 0}, 0.05}, 40000, "first");
  const Source second = strip({glm::normalize(glm::dvec3(0.05, -1, 0.1)), 0.06}, 20000, "second");
  patch("one.vpe", first);
  const auto all = stacked({base(), first, second});
  const auto twice =
      paging::patch_planet(options("one.vpe"), {path("one.vpe"), changes_of(second), kNowhere}, *all, &image_);
  const auto full = paging::build_planet(options("full.vpe"), *all, &image_);
  expect_equal(twice.meta, full.meta);
  expect_equal(paging::PlanetFile::open(path("one.vpe"))->meta(), full.meta);
  expect_sound(path("one.vpe"));
}

TEST_F(Patch, ImagesChangeWhereTheyAreSaid) {
  class Painted : public FakeImage {
   public:
    std::vector<mars::SourceInfo> infos() const override {
      auto infos = FakeImage::infos();
      infos.push_back(infos.front());
      infos.back().name = "painted";
      return infos;
    }
    void sample(std::span<const glm::dvec3> directions, double texel_m, std::span<vpe::base::Rgb> colours,
                std::span<std::uint8_t> alpha) const override {
      FakeImage::sample(directions, texel_m, colours, alpha);
      for (std::size_t n = 0; n < directions.size(); ++n)
        if (directions[n].y > 0.98) colours[n] = {250, 10, 10};
    }
  };
  const Painted painted;
  const mars::Cap where{{0, 1, 0}, std::acos(0.98)};
  const auto patched = paging::patch_planet(
      options("patched.vpe"), {path("p.vpe"), kNowhere, [&](const mars::Cap& cap) { return meet(cap, where); }},
      *base(), &painted);
  const auto full = paging::build_planet(options("full.vpe"), *base(), &painted);
  expect_equal(patched.meta, full.meta);
  EXPECT_NE(patched.meta.identity, paging::PlanetFile::open(path("p.vpe"))->meta().identity);
}

TEST_F(Patch, StoppedAtAnyStepItContinues) {
  const Source added = strip({glm::normalize(glm::dvec3(1, 0.2, 0.1)), 0.08}, 20000);
  const auto full = paging::build_planet(options("full.vpe"), *stacked({base(), added}), &image_);
  const auto before = paging::PlanetFile::open(path("p.vpe"))->meta();
  int stops = 0;
  bool was_continued = false;
  for (bool done = false; !done;) {
    int calls = 0;
    try {
      patch("patched.vpe", added, [&](const paging::BuildProgress& p) {
        EXPECT_EQ(p.patched, stops == 0);
        was_continued = was_continued || (!p.patched && p.kept > 0);
        if (++calls == 7 + 3 * stops) throw std::runtime_error("stop");
      });
      done = true;
    } catch (const std::runtime_error& e) {
      ASSERT_STREQ(e.what(), "stop");
      ASSERT_LT(++stops, 200);
      EXPECT_FALSE(std::filesystem::exists(path("patched.vpe")));
    }
  }
  EXPECT_GT(stops, 4);
  EXPECT_TRUE(was_continued);
  expect_equal(paging::PlanetFile::open(path("patched.vpe"))->meta(), full.meta);
  EXPECT_TRUE(paging::PlanetFile::open(path("p.vpe"))->meta() == before);
}

TEST_F(Patch, KilledInPlaceTheFileIsTheOldOne) {
  const Source added = strip({glm::normalize(glm::dvec3(1, 0.2, 0.1)), 0.08}, 20000);
  const auto full = paging::build_planet(options("full.vpe"), *stacked({base(), added}), &image_);
  const auto before = paging::PlanetFile::open(path("p.vpe"))->meta();
  for (const int last : {1, 20, 60}) {
    const pid_t child = ::fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
      int calls = 0;
      patch("p.vpe", added, [&](const paging::BuildProgress&) {
        if (++calls == last) ::kill(::getpid(), SIGKILL);
      });
      ::_exit(0);
    }
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    ASSERT_TRUE(WIFSIGNALED(status)) << last;
    EXPECT_TRUE(paging::PlanetFile::open(path("p.vpe"))->meta() == before);
  }
  EXPECT_GT(patch("p.vpe", added).kept, 0);
  expect_equal(paging::PlanetFile::open(path("p.vpe"))->meta(), full.meta);
}

// A full build must not take what a patch has left, nor the reverse: they leave different things to be done.
TEST_F(Patch, FullBuildsAndPatchesDoNotContinueEachOther) {
  const Source added = strip({glm::normalize(glm::dvec3(1, 0.2, 0.1)), 0.08}, 20000);
  const auto stop = [](const paging::BuildProgress& p) {
    if (p.fraction > 0.7) throw std::runtime_error("stop");
  };
  EXPECT_THROW(patch("q.vpe", added, stop), std::runtime_error);
  const auto all = stacked({base(), added});
  bool is_replaced = false;
  EXPECT_THROW(paging::build_planet(options("q.vpe"), *all, &image_,
                                    [&](const paging::BuildProgress& p) {
                                      is_replaced = is_replaced || p.replaced;
                                      stop(p);
                                    }),
               std::runtime_error);
  EXPECT_TRUE(is_replaced);
  const auto patched = patch("q.vpe", added, [&](const paging::BuildProgress& p) { EXPECT_TRUE(p.replaced); });
  expect_equal(patched.meta, paging::build_planet(options("full.vpe"), *all, &image_).meta);
}

TEST_F(Patch, WhatDoesNotFitIsRefused) {
  const Source added = strip({{1, 0, 0}, 0.05}, 20000);
  const auto all = stacked({base(), added});
  paging::BuildOptions o = options("q.vpe");
  o.mesh_ratio = 128;
  EXPECT_NE(refusal(o, *all, &image_).find("'mesh ratio = 256', not 'mesh ratio = 128'"), std::string::npos);
  o = options("q.vpe");
  o.body = "Moon";
  EXPECT_NE(refusal(o, *all, &image_).find("it is Mars"), std::string::npos);
  o = options("q.vpe");
  o.quantum_m = 0.25;
  EXPECT_NE(refusal(o, *all, &image_).find("step of heights"), std::string::npos);
  o = options("q.vpe");
  EXPECT_NE(refusal(o, *all, nullptr).find("fake"), std::string::npos);
  EXPECT_NE(refusal(o, *added, &image_).find("its source base"), std::string::npos);
  o.shard = {1, 2};
  EXPECT_NE(refusal(o, *all, &image_).find("part"), std::string::npos);
}

TEST_F(Patch, DamagedAndOlderFilesAreRefused) {
  const Source added = strip({{1, 0, 0}, 0.05}, 20000);
  const auto all = stacked({base(), added});
  const std::string whole = path("whole.vpe");
  std::filesystem::copy_file(path("p.vpe"), whole);
  const auto restore = [&] {
    std::filesystem::copy_file(whole, path("p.vpe"), std::filesystem::copy_options::overwrite_existing);
  };
  {
    paging::Database db(path("p.vpe"), paging::Database::Mode::kCreate);
    db.execute("UPDATE heights SET data = zeroblob(length(data)) WHERE key = (SELECT max(key) FROM heights)");
  }
  EXPECT_NE(refusal(options("q.vpe"), *all, &image_).find("damaged"), std::string::npos);
  restore();
  test_support::make_older(path("p.vpe"), "1.3");
  EXPECT_NE(refusal(options("q.vpe"), *all, &image_).find("does not tell how it was built"), std::string::npos);
  std::ofstream(path("p.vpe"), std::ios::trunc) << "no planet";
  EXPECT_NE(refusal(options("q.vpe"), *all, &image_).find("p.vpe"), std::string::npos);
}

}  // namespace
