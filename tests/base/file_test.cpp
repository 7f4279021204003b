// Files that appear complete or not at all.
#include "vpe/base/file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <fstream>
#include <future>

#include "tests/support/support.h"
#include "vpe/base/temporary.h"

namespace vpe::base {
namespace {

namespace fs = std::filesystem;

std::string text_of(const fs::path& file) {
  const auto bytes = read_file(file, 1U << 20U);
  return {bytes.begin(), bytes.end()};
}

class File : public ::testing::Test {
 protected:
  test_support::TempDir dir_;
};

// Also no bytes, whose pointer is null (a sanitizer found undefined behaviour there).
TEST_F(File, HoldsWhatWasWrittenOnceItIsCommitted) {
  const std::vector<std::uint8_t> bytes{1, 2, 3};
  OutputFile file(dir_ / "x");
  file.write({});
  file.write(bytes);
  file.write({});
  EXPECT_FALSE(std::filesystem::exists(dir_ / "x"));
  file.commit();
  EXPECT_EQ(read_file(dir_ / "x", 100), bytes);
}

TEST_F(File, IsNotThereUncommitted) {
  {
    OutputFile file(dir_ / "x");
    file.write({});
  }
  EXPECT_TRUE(std::filesystem::is_empty(dir_.path()));
}

// A name that others can foresee: what they put there is neither written through nor removed.
TEST_F(File, LeavesWhatHasTheNameOfATemporaryFile) {
  std::ofstream(dir_ / "victim") << "victim";
  const fs::path planted = temporary_name(dir_ / "x");
  fs::create_symlink(dir_ / "victim", planted);
  std::ofstream(dir_ / "x.tmp") << "mine";
  write_file(dir_ / "x", "new");
  EXPECT_EQ(text_of(dir_ / "x"), "new");
  EXPECT_FALSE(fs::is_symlink(dir_ / "x"));
  EXPECT_EQ(text_of(dir_ / "victim"), "victim");
  EXPECT_TRUE(fs::is_symlink(planted));
  EXPECT_EQ(text_of(dir_ / "x.tmp"), "mine");
}

TEST_F(File, TwoWritersDoNotMix) {
  OutputFile first(dir_ / "x");
  first.write(std::vector<std::uint8_t>(10, 'a'));
  {
    OutputFile second(dir_ / "x");
    second.write(std::vector<std::uint8_t>(20, 'b'));
    first.write(std::vector<std::uint8_t>(10, 'a'));
    second.commit();
    EXPECT_EQ(text_of(dir_ / "x"), std::string(20, 'b'));
  }
  first.commit();
  EXPECT_EQ(text_of(dir_ / "x"), std::string(20, 'a'));
  EXPECT_EQ(std::distance(fs::directory_iterator(dir_.path()), {}), 1);
}

TEST_F(File, ReplacesWhatALinkLeadsTo) {
  fs::create_directory(dir_ / "store");
  std::ofstream(dir_ / "store/old") << "old";
  fs::create_symlink("store/old", dir_ / "link");
  fs::create_symlink("link", dir_ / "link of link");
  fs::create_symlink("store/new", dir_ / "dangling");
  fs::create_symlink("circle", dir_ / "circle");
  write_file(dir_ / "link of link", "1");
  EXPECT_EQ(text_of(dir_ / "store/old"), "1");
  write_file(dir_ / "dangling", "2");
  EXPECT_EQ(text_of(dir_ / "store/new"), "2");
  for (const char* link : {"link", "link of link", "dangling"})
    EXPECT_TRUE(fs::is_symlink(dir_ / link)) << link;
  EXPECT_THROW(write_file(dir_ / "circle", "3"), FileError);
  EXPECT_EQ(std::distance(fs::directory_iterator(dir_ / "store"), {}), 2);
}

TEST_F(File, APipeGetsTheContentAndStaysAPipe) {
  const fs::path pipe = dir_ / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  auto reader = std::async(std::launch::async, [&] {
    std::ifstream in(pipe);
    return std::string(std::istreambuf_iterator<char>(in), {});
  });
  const std::string text(200'000, 'x');
  write_file(pipe, text);
  EXPECT_EQ(reader.get(), text);
  EXPECT_TRUE(fs::is_fifo(pipe));
  write_file("/dev/null", text);
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
  EXPECT_THROW(write_file("/dev/full", text), FileError);
  EXPECT_THROW(write_file(dir_.path(), text), FileError);
}

TEST_F(File, OnlyTemporaryFilesOfDeadWritersAreSweptAway) {
  const pid_t dead = ::fork();
  if (dead == 0) ::_exit(0);
  ASSERT_EQ(::waitpid(dead, nullptr, 0), dead);
  std::array<char, 256> host{};
  ASSERT_EQ(::gethostname(host.data(), host.size() - 1), 0);
  const std::string here = std::string(".") + host.data() + "-";
  const auto old = fs::file_time_type::clock::now() - std::chrono::hours(72);
  struct Case {
    std::string name;
    bool is_old;
    bool stays;
  };
  const std::string gone = std::to_string(dead);
  const std::vector<Case> cases{{"f.mp4" + here + gone + ".tmp", false, false},
                                {"f.mp4" + here + gone + "-2.tmp", false, false},
                                {"f.mp4.far.away-12.tmp", true, false},
                                {"f.mp4.far-a-way-12-3.tmp", true, false},
                                {"f.mp4.far.away-12.tmp2", true, true},
                                {"f.mp4.far.away-13.tmp", false, true},
                                {"f.mp4" + here + std::to_string(::getpid()) + ".tmp", true, true},
                                {"f.mp4.tmp", true, true},
                                {"f.mp4.my-edit.tmp", true, true},
                                {"f.mp4.my-2nd.tmp", true, true},
                                {"f.mp4.-12.tmp", true, true},
                                {"f.mp4-12.tmp", true, true},
                                {"g.mp4" + here + gone + ".tmp", true, true}};
  for (const Case& c : cases) {
    std::ofstream(dir_ / c.name) << "half";
    if (c.is_old) fs::last_write_time(dir_ / c.name, old);
  }
  remove_stale_temporaries(dir_.path(), [](const std::string& name) { return name == "f.mp4"; });
  for (const Case& c : cases) EXPECT_EQ(fs::exists(dir_ / c.name), c.stays) << c.name;
}

}  // namespace
}  // namespace vpe::base
