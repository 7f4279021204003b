#!/usr/bin/env bash
# Installs what is missing, builds, and runs the tests.
#   ./test.sh                    the default tests
#   ./test.sh --all              also the long ones, with planets made for them; clang; clang-tidy; the API reference;
#                                both sanitizer builds, floating-point traps and mutants
#   ./test.sh --fuzz [SECONDS]   the fuzzers alone, each for so long (600)
set -euo pipefail
cd "$(dirname "$0")"
usage() { echo "usage: ./test.sh [--all | --fuzz [SECONDS]]" >&2; exit 2; }
what=${1:-default}
case "$what" in
  default) ;;
  --all | --fuzz) ;;
  *) usage ;;
esac
if [ "$what" = default ]; then .ci/install.sh; else .ci/install.sh --all; fi
jobs=${JOBS:-$(nproc)}

# build PRESET [TARGETS ...]
build() {
  local targets=("${@:2}") folder=build/$1
  [ "$1" != ci ] || folder=build/release
  cmake --preset "$1" -DVPE_TESTS=ON >/dev/null &&
    cmake --build "$folder" ${targets[0]:+--target "${targets[@]}"} -- -j"$jobs"
}

# Runs ctest in a build folder and says how many tests ran and which were skipped. One process more at a time than there
# are cores: tests of windows and films wait for much of their time.
run() {
  local status=0 log="build/$1/Testing/Temporary/LastTest.log"
  ctest --test-dir "build/$1" -j"$((jobs + 1))" --no-tests=error --output-on-failure "${@:2}" || status=$?
  local skipped
  skipped=$(grep -oE '^\[  SKIPPED \] [^ ,]+\.[^ ,]+' "$log" | sort -u | sed 's/.*\] /  /' || true)
  echo "tests run: $(grep -cE '^\[ RUN      \]' "$log")"
  if [ -n "$skipped" ]; then
    echo "skipped:"
    echo "$skipped"
    [ -e ../shared/data ] || [ -n "${VPE_SHARED_DATA:-}" ] || echo "  (no planetary data beside the checkout)"
  fi
  if [ "$status" -ne 0 ]; then
    echo "failed:"
    grep -oE '^\[  FAILED  \] [^ ,]+\.[^ ,]+' "$log" | sort -u | sed 's/.*\] /  /' || true
  fi
  return "$status"
}

# Runs the default tests of a build with a sanitizer. Reports go to files, so that those of subprocesses count too.
# LeakSanitizer itself crashes now and then while threads of a graphics driver end: such a test is run again.
run_sanitized() {
  local reports="$PWD/build/$1/reports" status=0
  rm -rf "$reports"
  mkdir -p "$reports"
  ASAN_OPTIONS="detect_leaks=1:log_path=$reports/address" TSAN_OPTIONS="log_path=$reports/thread" \
    UBSAN_OPTIONS="print_stacktrace=1:log_path=$reports/undefined" \
    run "$1" -L shard --repeat until-pass:2 --timeout 6000 || status=$?
  local report
  for report in "$reports"/*; do
    [ -e "$report" ] || continue
    if grep -q "LeakSanitizer has encountered a fatal error" "$report" && ! grep -q "ERROR:" "$report"; then continue; fi
    echo "report of a sanitizer: $report"
    head -40 "$report"
    status=1
  done
  return "$status"
}

if [ "$what" = --fuzz ]; then
  seconds=${2:-600}
  targets=(flight payload planet forged label rover gpano sidecar image place table axes scene relief sticks mesh volume)
  cmake --preset fuzz >/dev/null
  cmake --build build/fuzz --target vpe_fuzz_seeds "${targets[@]/#/vpe_fuzz_}" -- -j"$jobs"
  for target in "${targets[@]}"; do
    corpus=build/fuzz/corpus/$target
    build/fuzz/tests/fuzz/vpe_fuzz_seeds "$target" "$corpus"
    # Findings stay in build/fuzz; libFuzzer ends with an error at the first one.
    UBSAN_OPTIONS=print_stacktrace=1 "build/fuzz/tests/fuzz/vpe_fuzz_$target" -max_total_time="$seconds" \
      -artifact_prefix=build/fuzz/ -print_final_stats=1 -verbosity=0 -timeout=20 -rss_limit_mb=2048 "$corpus"
    echo "$target: $seconds s without a finding"
  done
  exit
fi
tools/check_format.sh
# In CI warnings are errors; a newer compiler's new warnings stop nobody else.
if [ "${CI:-}" = true ]; then build ci; else build release; fi
if [ "$what" = default ]; then
  run release -L shard --timeout 3000
  exit
fi
eval "$(tests/make_planets.sh)"
run release -LE shard
cmake --preset release -DVPE_DOCS_WARN_AS_ERROR=FAIL_ON_WARNINGS >/dev/null
cmake --build build/release --target docs
build clang
run clang -L shard
tools/check_tidy.sh --preset clang
# Sanitizers over all default tests; cmake/sanitizer_support.cpp names the libraries that are left out.
build asan
run_sanitized asan
build tsan
run_sanitized tsan
# Pure functions under floating-point traps; then every guard switched off, which a test has to notice.
build traps cull_tests lod_tests scripts_tests mars_tests core_tests paging_tests explore_tests panorama_tests stability_tests
tests/stability/traps.sh
build mutations lod_tests paging_tests scripts_tests stability_tests stability_gl_tests
tests/stability/mutants.sh
