#!/usr/bin/env bash
# Switches off one guard after the other (vpe/base/mutation.h) and runs the tests that stand for it: each has to fail,
# and with all guards on each has to pass.
#   cmake --preset mutations && cmake --build build/mutations --target lod_tests paging_tests scripts_tests \
#     stability_tests stability_gl_tests
#   tests/stability/mutants.sh [BUILD_FOLDER]
set -uo pipefail
cd "$(dirname "$0")/../.."
tests=$(realpath "${1:-build/mutations}")/tests

# guard, program, test
mutants="
lowest-occluder  lod/lod_tests                    Select.DrawsEveryVisiblePlaceExactlyOnce
facet-sagitta    lod/lod_tests                    Tree.RegionsAndTheLowestRadiusContainTheFacets
skirt-neighbour  lod/lod_tests                    Skirt.CoversWhatIsDrawnAcrossEveryEdgeAndNoMore
second-order     lod/lod_tests                    ErrorMeter.SecondOrderIsNeeded
second-order     lod/lod_tests                    ErrorMeter.BoundHoldsAtEveryExaggeration
cell-variation   stability/stability_tests        GeometryErrors.HoldBetweenTheVerticesWhereTheyAreMeasured
errors-nest      lod/lod_tests                    Tree.RefusesErrorsAndHeightsThatDoNotNest
border-posts     lod/lod_tests                    Posts.SurfaceIsWatertightAcrossAChangeOfDepth
border-posts     paging/paging_tests              Builder.SurfaceIsWatertightAcrossAllBorders
short-way        scripts/scripts_tests            Path.HeadTurnsSmoothlyInTheShorterDirectionAndIsHeldOutside
short-way        stability/stability_tests        StiffFlight.YawPassesThrough180DegreesEvenly
face-order       paging/paging_tests              Surface.CastAgreesWithEveryFacet
face-order       stability/stability_tests        GeometryRays.HitWhatIsThereAndNothingElse
near-origin      stability/gl/stability_gl_tests  PolygonMotion.KeepsTheOrderFromATenthOfAMetreToAHundredThousandKilometres
reversed-depth   stability/gl/stability_gl_tests  PolygonMotion.KeepsTheOrderFromATenthOfAMetreToAHundredThousandKilometres
nodata-heights   paging/paging_tests              Builder.NodataPlacesAreKnown
nodata-heights   stability/stability_tests        GeometryRays.NodataGroundIsDrawnAndReported
"

log=$(mktemp)
trap 'rm -f "$log"' EXIT
failed=0
# run GUARD PROGRAM TEST: the program's status; a filter that names no test is an error of its own.
run() {
  VPE_MUTATION=$1 timeout 300 "$tests/$2" --gtest_filter="$3" >"$log" 2>&1
  local status=$?
  grep -q '1 test from 1 test suite ran' "$log" || [ "$status" -gt 1 ] || status=99
  return "$status"
}
while read -r guard program test; do
  [ -n "$guard" ] || continue
  if ! run "" "$program" "$test"; then
    echo "FAILS WITH ALL GUARDS ON: $test"
    tail -5 "$log"
    failed=1
    continue
  fi
  run "$guard" "$program" "$test"
  status=$?
  # 1: an expectation failed. Anything else is a crash, a missing test or an unknown guard: no proof.
  if [ "$status" -eq 1 ]; then
    printf '%-16s caught by %s\n' "$guard" "$test"
  else
    printf '%-16s SURVIVES %s (status %s)\n' "$guard" "$test" "$status"
    failed=1
  fi
done <<<"$mutants"
exit "$failed"
