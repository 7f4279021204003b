// The same sources at -O0 and at the build's own optimisation give the same bits: no fast-math, no contraction.
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <map>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/worst.h"

namespace {

std::vector<std::string> lines_of(const std::string& program) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> pipe(popen(("'" + program + "'").c_str(), "r"), pclose);
  std::vector<std::string> lines;
  char text[512];
  while (pipe && std::fgets(text, sizeof text, pipe.get()) != nullptr) lines.emplace_back(text);
  return lines;
}

TEST(Arithmetic, OptimisedAndPlainCodeGiveEqualBits) {
  const std::vector<std::string> optimised = lines_of(VPE_PURE_RESULTS);
  const std::vector<std::string> plain = lines_of(VPE_PURE_RESULTS_PLAIN);
  ASSERT_EQ(optimised.size(), plain.size());
  ASSERT_GT(plain.size(), 40000U);
  double different = 0;
  std::map<std::string, int> by_name;
  for (std::size_t n = 0; n < plain.size(); ++n) {
    if (optimised[n] == plain[n]) continue;
    different += 1;
    if (++by_name[plain[n].substr(0, plain[n].find_first_of("0123456789"))] == 1)
      ADD_FAILURE() << "plain     " << plain[n] << "optimised " << optimised[n];
  }
  test_support::record_worst("-O0 against the build's optimisation: results that differ", different, 0,
                             "of " + std::to_string(plain.size()));
}

}  // namespace
