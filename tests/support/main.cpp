// main() of the test programs. With VPE_SUITE_SHARDS=n and VPE_SUITE_SHARD=k it runs the k-th of n parts, of whole suites:
// what the tests of a suite share is made once. GTEST_TOTAL_SHARDS divides suites.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <functional>
#include <string>
#include <vector>

namespace {

// Returns the suites of a part in the syntax of a filter. Large suites come first, each to the part with the fewest tests.
std::string suites_of_part(int parts, int part) {
  const testing::UnitTest& all = *testing::UnitTest::GetInstance();
  std::vector<const testing::TestSuite*> suites;
  for (int n = 0; n < all.total_test_suite_count(); ++n) suites.push_back(all.GetTestSuite(n));
  std::ranges::stable_sort(suites, std::greater<>(), &testing::TestSuite::total_test_count);
  std::vector<int> tests(static_cast<std::size_t>(parts));
  std::string filter = "NONE";
  for (const testing::TestSuite* suite : suites) {
    if (std::string(suite->name()).starts_with("Long")) continue;
    const auto least = std::ranges::min_element(tests);
    *least += suite->total_test_count();
    if (least - tests.begin() == part) filter += std::string(":") + suite->name() + ".*";
  }
  return filter;
}

int number_of(const char* variable) {
  const char* text = std::getenv(variable);
  return text != nullptr ? std::atoi(text) : -1;
}

}  // namespace

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  const int parts = number_of("VPE_SUITE_SHARDS");
  const int part = number_of("VPE_SUITE_SHARD");
  const std::string filter = GTEST_FLAG_GET(filter);
  if (part >= 0 && part < parts && filter.starts_with('-'))
    GTEST_FLAG_SET(filter, suites_of_part(parts, part) + filter);
  return RUN_ALL_TESTS();
}
