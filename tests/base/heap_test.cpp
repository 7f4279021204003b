// The return of freed memory to the system.
#include "vpe/base/heap.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdio>
#include <cstring>
#include <memory>
#include <vector>

namespace vpe::base {
namespace {

// Returns the resident memory of this process, MB; 0 where the system does not say.
[[maybe_unused]] double resident_mb() {
  std::FILE* const file = std::fopen("/proc/self/statm", "r");
  if (file == nullptr) return 0;
  long all = 0;
  long resident = 0;
  const int read = std::fscanf(file, "%ld %ld", &all, &resident);
  std::fclose(file);
  return read == 2 ? static_cast<double>(resident) * static_cast<double>(sysconf(_SC_PAGESIZE)) / 1048576 : 0;
}

TEST(Heap, FreedMemoryGoesBackToTheSystem) {
#if !defined(__GLIBC__) || defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "skipped: another allocator";
#else
  if (resident_mb() == 0) GTEST_SKIP() << "skipped: no /proc";
  constexpr std::size_t kBlock = 20'000;  // small enough for the heap
  std::vector<std::unique_ptr<char[]> > blocks(4000);
  for (auto& block : blocks) {
    block = std::make_unique<char[]>(kBlock);
    std::memset(block.get(), 1, kBlock);
  }
  // The last block stays, so that the heap does not shrink by itself.
  blocks.erase(blocks.begin(), blocks.end() - 1);
  const double before_mb = resident_mb();
  return_freed_memory();
  EXPECT_LT(resident_mb(), before_mb - 50);
#endif
}

}  // namespace
}  // namespace vpe::base
