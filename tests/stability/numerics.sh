#!/usr/bin/env bash
# Measures again what docs/measurements/numerics.md states: runs the tests of the label stability, the long ones too, and puts the
# worst case of every claim beside its bound into the table between the two marks of the document.
#   tests/stability/numerics.sh [BUILD_FOLDER [-- ARGUMENTS OF CTEST]]
set -euo pipefail
cd "$(dirname "$0")/../.."
build=${1:-build/release}
shift || true
[ "${1:-}" != -- ] || shift
VPE_NUMERICS_OUT=$(mktemp)
export VPE_NUMERICS_OUT
table=$(mktemp)
trap 'rm -f "$VPE_NUMERICS_OUT" "$table"' EXIT
ctest --test-dir "$build" -L stability --no-tests=error --output-on-failure "$@"

# Of each claim the line with the largest share of its bound; of bound 0 the largest value.
{
  echo '| claim | worst measured | bound | unit | test |'
  echo '|---|---|---|---|---|'
  awk -F'\t' '{
    share = $3 > 0 ? $2 / $3 : $2
    if (!($1 in most) || share > most[$1]) { most[$1] = share; line[$1] = $5 "\t| " $1 " | " $2 " | " $3 " | " $4 " | `" $5 "` |" }
  } END { for (claim in line) print line[claim] }' "$VPE_NUMERICS_OUT" | LC_ALL=C sort | cut -f2-
} >"$table"
awk -v table="$table" '
  /<!-- measured -->/ { print; print ""; while ((getline row < table) > 0) print row; print ""; inside = 1; next }
  /<!-- end of measured -->/ { inside = 0 }
  !inside { print }' docs/measurements/numerics.md >docs/measurements/numerics.md.new
mv docs/measurements/numerics.md.new docs/measurements/numerics.md
echo "$(($(wc -l <"$table") - 2)) claims in docs/measurements/numerics.md"
