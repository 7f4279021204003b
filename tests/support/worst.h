// Measured worst cases beside their bounds: the rows of the tables in docs/numerics.md.
#pragma once

#include <string>

namespace test_support {

// Expects value <= bound, which no NaN is; prints both, and keeps them as a property of the running test. When
// $VPE_NUMERICS_OUT names a file, a line is added to it: claim, value, bound, unit and test (folder/file
// Suite.Name), with tabs between them. A claim may be recorded by several tests, and several times by each:
// tests/stability/numerics.sh takes the largest share of its bound. Any thread; safe among processes.
void record_worst(const std::string& claim, double value, double bound, const std::string& unit);

}  // namespace test_support
