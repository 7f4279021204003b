#!/usr/bin/env bash
# Runs the tests of pure functions with floating-point traps: the first invalid operation, division by zero or overflow
# in one of the suites of tests/support/traps.cpp ends it with the test's name.
#   cmake --preset traps && cmake --build build/traps --target cull_tests lod_tests scripts_tests mars_tests core_tests \
#     paging_tests explore_tests panorama_tests stability_tests
#   tests/stability/traps.sh [BUILD_FOLDER]
set -uo pipefail
cd "$(dirname "$0")/../.."
tests=$(realpath "${1:-build/traps}")/tests
log=$(mktemp)
trap 'rm -f "$log"' EXIT
failed=0
for module in cull lod scripts mars core paging explore panorama stability; do
  program=$tests/$module/${module}_tests
  # Suites without traps run in the other builds.
  suites=$(VPE_LIST_TRAPPED=$module "$program")
  if RC_PARAMS=seed=20261122 timeout 1200 "$program" --gtest_filter="$suites" --gtest_brief=1 >"$log" 2>&1; then
    echo "$module: $(grep -oE '[0-9]+ tests?\.' "$log" | tail -1) without a trap"
  else
    grep -E 'floating-point trap|FAILED' "$log" || tail -5 "$log"
    grep -A12 'floating-point trap' "$log" | tail -12
    failed=1
  fi
done
exit "$failed"
