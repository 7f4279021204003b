// Files that appear complete or not at all.
#include "vpe/base/file.h"

#include <gtest/gtest.h>

#include "tests/support/support.h"

namespace vpe::base {
namespace {

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

}  // namespace
}  // namespace vpe::base
