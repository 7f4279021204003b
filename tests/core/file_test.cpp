// Files that appear whole or not at all.
#include "vpe/base/file.h"

#include <gtest/gtest.h>

#include "tests/support/support.h"

namespace vpe::core {
namespace {

class File : public ::testing::Test {
 protected:
  test_support::TempDir dir_;
};

// Also nothing, which has no place in memory (undefined behaviour was found there by a sanitizer).
TEST_F(File, HoldsWhatWasWrittenOnceItIsCommitted) {
  const std::vector<std::uint8_t> bytes{1, 2, 3};
  base::OutputFile file(dir_ / "x");
  file.write({});
  file.write(bytes);
  file.write({});
  EXPECT_FALSE(std::filesystem::exists(dir_ / "x"));
  file.commit();
  EXPECT_EQ(base::read_file(dir_ / "x", 100), bytes);
}

TEST_F(File, IsNotThereUncommitted) {
  {
    base::OutputFile file(dir_ / "x");
    file.write({});
  }
  EXPECT_TRUE(std::filesystem::is_empty(dir_.path()));
}

}  // namespace
}  // namespace vpe::core
