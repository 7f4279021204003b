// Measured worst cases beside their bounds: the rows of the table in docs/measurements/numerics.md.
#pragma once

#include <string>

namespace test_support {

// Expects value <= bound, which fails for NaN. Prints both, and keeps them as a property of the running test.
// When $VPE_NUMERICS_OUT names a file, appends a line to it: claim, value, bound, unit and test (folder/file
// Suite.Name), separated by tabs. Several tests may record a claim, each of them several times:
// tests/stability/numerics.sh takes the largest ratio to the bound. Any thread and several processes may call
// it.
void record_worst(const std::string& claim, double value, double bound, const std::string& unit);

}  // namespace test_support
