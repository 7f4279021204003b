// Builds that are stopped, killed or fail continue where they ended, and give the same content.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>

#include "paging/planet/sqlite.h"
#include "tests/paging/planet_fixture.h"

namespace {

using test_support::bumpy_height;
using test_support::FakeElevation;
using test_support::FakeImage;
using test_support::fine_around;
using test_support::Random;
using test_support::TempDir;

class Resume : public testing::Test {
 protected:
  paging::BuildOptions options() const {
    paging::BuildOptions o;
    o.output = (dir_ / "p.vpe").string();
    o.base_spacing_m = 300000;
    o.threads = 2;
    o.tile_k = 4;
    o.resampling_posts = 2000;
    o.commit_s = 0;  // after each tile
    return o;
  }

  const FakeElevation source_{bumpy_height, fine_around(glm::normalize(glm::dvec3(1, 1, 1)), 0.05, 50000)};
  const FakeImage image_{};

  paging::BuildSummary build(const paging::BuildOptions& o,
                             const paging::ProgressFunction& progress = {}) const {
    return paging::build_planet(o, source_, &image_, progress);
  }

  // Returns the meta of an uninterrupted build.
  const paging::PlanetMeta& whole() {
    if (whole_.tiles == 0) {
      paging::BuildOptions o = options();
      o.output = (dir_ / "whole.vpe").string();
      whole_ = build(o).meta;
    }
    return whole_;
  }

  // Expects equal content: identity, which covers the checksums of all payloads, and all of meta.
  void expect_whole() {
    const auto planet = paging::PlanetFile::open(options().output);
    EXPECT_TRUE(planet->meta() == whole()) << planet->meta().identity << " is not " << whole().identity;
    EXPECT_FALSE(std::filesystem::exists(options().output + ".part"));
    EXPECT_FALSE(std::filesystem::exists(options().output + ".part-journal"));
    // Every payload reads: none has a wrong checksum.
    for (const lod::TileInfo& tile : planet->tree().tiles()) {
      planet->heights(tile.key);
      const std::size_t meshes = tile.variants.size() - (tile.has_children ? 0 : 1);
      for (std::size_t v = 0; v < meshes; ++v) planet->mesh(tile.key, static_cast<int>(v));
      if (const auto image = planet->image_key(tile.key)) planet->image(*image);
    }
  }

  // Cuts the partial file short, or changes a bit anywhere: the next build never gives other content. It may
  // report that the file is damaged, and works once the file is removed.
  void damage_and_continue(int times) {
    paging::BuildOptions o = options();
    o.commit_s = 60;
    EXPECT_THROW(build(o,
                       [](const paging::BuildProgress& p) {
                         if (p.fraction > 0.9) throw std::runtime_error("stop");
                       }),
                 std::runtime_error);
    const std::filesystem::path part = options().output + ".part";
    const std::filesystem::path copy = dir_ / "copy";
    std::filesystem::copy_file(part, copy);
    const auto size = static_cast<int>(std::filesystem::file_size(part));
    Random random(79);
    int refused = 0;
    int continued = 0;
    for (int n = 0; n < times; ++n) {
      SCOPED_TRACE(n);
      std::filesystem::remove(options().output);
      std::filesystem::copy_file(copy, part, std::filesystem::copy_options::overwrite_existing);
      if (n % 3 == 0) {
        std::filesystem::resize_file(part, static_cast<std::uintmax_t>(random.integer(0, size)));
      } else {
        std::fstream file(part, std::ios::in | std::ios::out | std::ios::binary);
        const int at = random.integer(0, size - 1);
        file.seekg(at);
        const int bit = 1 << random.integer(0, 7);
        const int byte = file.get() ^ bit;
        file.seekp(at);
        file.put(static_cast<char>(byte));
      }
      try {
        const auto summary = build(o);
        continued += summary.kept > 0 ? 1 : 0;
      } catch (const std::runtime_error& e) {
        ++refused;
        EXPECT_NE(std::string(e.what()).find("p.vpe.part"), std::string::npos) << e.what();
        std::filesystem::remove(part);
        std::filesystem::remove(part.string() + "-journal");
        build(o);
      }
      expect_whole();
    }
    EXPECT_GT(continued, 0);
    RecordProperty("refused", refused);
  }

  TempDir dir_;

 private:
  paging::PlanetMeta whole_;
};

// Stops at every n-th step of all, whatever stage that is in.
TEST_F(Resume, StoppedAtAnyStepOneAfterAnother) {
  std::int64_t steps = 0;
  {
    paging::BuildOptions o = options();
    o.output = (dir_ / "count.vpe").string();
    build(o, [&](const paging::BuildProgress&) { ++steps; });
  }
  ASSERT_GT(steps, 50);
  std::int64_t kept_before = 0;
  int stops = 0;
  for (bool done = false; !done;) {
    std::int64_t calls = 0;
    std::int64_t kept = 0;
    try {
      build(options(), [&](const paging::BuildProgress& p) {
        kept = std::max(kept, p.kept);
        if (++calls == 9) throw std::runtime_error("stop");
      });
      done = true;
    } catch (const std::runtime_error& e) {
      ASSERT_STREQ(e.what(), "stop");
      ++stops;
      ASSERT_LT(stops, steps) << "no progress";
    }
    EXPECT_GE(kept, std::min<std::int64_t>(kept_before, kept));
    kept_before = kept;
  }
  EXPECT_GT(stops, steps / 9 - 4);
  expect_whole();
}

// SIGKILL at random moments.
void kill_and_continue(const std::function<void()>& build, int kills, double longest_s, Random& random,
                       int& killed) {
  for (killed = 0; killed < kills;) {
    const pid_t child = ::fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
      try {
        build();
      } catch (const std::exception& e) {
        std::fprintf(stderr, "%s\n", e.what());
        ::_exit(2);
      }
      ::_exit(0);
    }
    ::usleep(static_cast<useconds_t>(1e6 * random.uniform(0, longest_s)));
    ::kill(child, SIGKILL);
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    if (WIFSIGNALED(status)) {
      ++killed;
      continue;
    }
    ASSERT_EQ(WEXITSTATUS(status), 0);
    break;
  }
  build();
}

TEST_F(Resume, KilledAtRandomMoments) {
  Random random(77);
  int total = 0;
  // A fast machine ends before it is killed: then kill sooner.
  double longest_s = 0.15;
  for (int round = 0; round < 3 || (round < 12 && total < 6); ++round, longest_s *= 0.7) {
    std::filesystem::remove(options().output);
    int killed = 0;
    kill_and_continue([this] { build(options()); }, 12, longest_s, random, killed);
    ASSERT_FALSE(HasFatalFailure());
    expect_whole();
    total += killed;
  }
  EXPECT_GE(total, 6);
}

class LongResume : public Resume {};

TEST_F(Resume, ADamagedPartialFileNeverEndsInOtherContent) { damage_and_continue(12); }
TEST_F(LongResume, DamagedTwoHundredTimes) { damage_and_continue(200); }

TEST_F(LongResume, KilledTwoHundredTimes) {
  Random random(78);
  int total = 0;
  while (total < 200) {
    std::filesystem::remove(options().output);
    int killed = 0;
    kill_and_continue([this] { build(options()); }, 25, 0.1, random, killed);
    if (HasFatalFailure()) return;
    expect_whole();
    total += killed;
  }
  RecordProperty("kills", total);
}

TEST_F(Resume, AFailedSourceKeepsWhatWasBuilt) {
  bool broken = true;
  const FakeElevation source(
      [&broken](const glm::dvec3& d) -> double {
        if (broken && d.z > 0.999999) throw mars::SourceError("no.tif: cannot read block 7");
        return bumpy_height(d);
      },
      [](const mars::Cap&) { return 1e9; });
  // The failing face is the fifth of six.
  paging::BuildOptions small = options();
  small.threads = 1;
  EXPECT_THROW(paging::build_planet(small, source, nullptr), mars::SourceError);
  EXPECT_FALSE(std::filesystem::exists(options().output));
  EXPECT_TRUE(std::filesystem::exists(options().output + ".part"));
  broken = false;
  const auto continued = paging::build_planet(small, source, nullptr);
  EXPECT_GT(continued.kept, 0);
  paging::BuildOptions o = options();
  o.output = (dir_ / "whole.vpe").string();
  const auto fresh = paging::build_planet(o, source, nullptr);
  EXPECT_TRUE(continued.meta == fresh.meta);
}

TEST_F(Resume, FailingBeforeAnyTileLeavesNothing) {
  const FakeElevation source(
      [](const glm::dvec3&) -> double { throw mars::SourceError("no.tif: cannot read"); });
  EXPECT_THROW(paging::build_planet(options(), source, nullptr), mars::SourceError);
  EXPECT_TRUE(std::filesystem::is_empty(dir_.path()));
}

TEST_F(Resume, OtherOptionsStartAnew) {
  const auto stop_half_way = [](const paging::BuildProgress& p) {
    if (p.fraction > 0.3) throw std::runtime_error("stop");
  };
  EXPECT_THROW(build(options(), stop_half_way), std::runtime_error);
  paging::BuildOptions other = options();
  other.mesh_ratio = 128;
  bool replaced = false;
  const auto summary = build(other, [&](const paging::BuildProgress& p) { replaced = replaced || p.replaced; });
  EXPECT_TRUE(replaced);
  EXPECT_EQ(summary.kept, 0);
  EXPECT_NE(summary.meta.identity, whole().identity);
}

// Limits the size of files that this process writes, as a full disk does.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) : handler_(::signal(SIGXFSZ, SIG_IGN)) {
    ::getrlimit(RLIMIT_FSIZE, &former_);
    const rlimit limit{bytes, former_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileSizeLimit() {
    ::setrlimit(RLIMIT_FSIZE, &former_);
    ::signal(SIGXFSZ, handler_);
  }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;

 private:
  rlimit former_{};
  void (*handler_)(int);
};

std::string content_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

// An error that says nothing about the content (no space, no permission, ...) leaves the partial file.
TEST_F(Resume, APartialFileThatCannotBeWrittenIsKept) {
  EXPECT_THROW(build(options(),
                     [](const paging::BuildProgress& p) {
                       if (p.fraction > 0.7) throw std::runtime_error("stop");
                     }),
               std::runtime_error);
  const std::string part = options().output + ".part";
  {
    // As when a build is killed after its last tile: `meta` has rows, which are deleted first.
    paging::Database db(part, paging::Database::Mode::kCreate);
    db.execute("INSERT INTO meta VALUES('format', '1.2')");
  }
  const std::string before = content_of(part);
  {
    const FileSizeLimit full(0);
    EXPECT_THROW(build(options()), paging::DatabaseError);
  }
  EXPECT_TRUE(content_of(part) == before);
  EXPECT_GT(build(options()).kept, 0);
  expect_whole();
}

// What another program left under the names that a build uses is neither overwritten nor removed.
TEST_F(Resume, FilesOfOthersAreKept) {
  paging::Database(options().output + ".other", paging::Database::Mode::kCreate)
      .execute("PRAGMA application_id = 7; CREATE TABLE t(x); INSERT INTO t VALUES(1)");
  const std::string database = content_of(options().output + ".other");
  for (const char* suffix : {".part", ".part-journal", ".part-wal", ".part-shm"}) {
    for (const std::string& content : {std::string("mine\n"), std::string(20000, 'x'), database}) {
      SCOPED_TRACE(suffix + content.substr(0, 6));
      const std::string file = options().output + suffix;
      std::ofstream(file, std::ios::binary) << content;
      std::string message;
      try {
        build(options());
      } catch (const paging::DatabaseError& e) {
        message = e.what();
      }
      EXPECT_NE(message.find(file), std::string::npos) << message;
      EXPECT_NE(message.find("move it"), std::string::npos) << message;
      EXPECT_TRUE(content_of(file) == content);
      std::filesystem::remove(file);
    }
  }
  EXPECT_EQ(build(options()).kept, 0);
  expect_whole();
}

TEST_F(Resume, TwoBuildsOfOneFileDoNotMix) {
  std::string message;
  build(options(), [&](const paging::BuildProgress& p) {
    if (p.fraction < 0.5 || !message.empty()) return;
    try {
      build(options());
      message = "no error";
    } catch (const std::runtime_error& e) {
      message = e.what();
    }
  });
  EXPECT_NE(message.find("another build is writing it"), std::string::npos) << message;
  expect_whole();
}

}  // namespace
