#!/bin/bash
# Frames a second of the demo film with encoding, by triangles, by rays, and by rays of coarser cells, in turn.
#   tests/bench/film_rate.sh [VPE [FRAMES [ROUNDS [OPTION...]]]]
# FRAMES as in `vpe fly --frames` (default: the whole film); options are those of `vpe fly`, also a planet. Prints medians
# (lowest..highest). Rates count only where nothing else runs; beside other work only processor times do.
set -euo pipefail
vpe=${1:-build/release/vpe}
frames=${2:-0-899}
rounds=${3:-5}
options=("${@:4}")
[[ $rounds =~ ^[1-9][0-9]*$ && $frames =~ ^([0-9]+)-([0-9]+)$ ]] || {
  sed -n '3s/^# *//p' "$0" >&2
  exit 2
}
count=$((10#${BASH_REMATCH[2]} - 10#${BASH_REMATCH[1]} + 1))
bench=$(dirname "$0")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
export LC_ALL=C TIMEFORMAT='%R %U %S'
. "$bench/timing.sh"

declare -A words=([triangles]='--backend polygon' [rays]='--backend ray'
  ['rays, cells of 1 px']='--backend ray --set rays.mode=multires --set rays.cell=1')
cases=(triangles rays 'rays, cells of 1 px')
film() {
  rm -rf "$work/film"
  mkdir "$work/film"
  # shellcheck disable=SC2086  # the words are words
  "$vpe" fly "$bench/../../scripts/flights/valles-marineris.flight" "${options[@]}" ${words[$one]} -o "$work/film/film.mp4" \
    --frames "$frames" --threads 2 --quiet
}
for ((n = 1; n <= rounds; ++n)); do
  for one in "${cases[@]}"; do
    read -r wall processor < <(seconds film)
    awk -v n="$count" -v s="$wall" 'BEGIN { printf "%.2f\n", n / s }' >>"$work/$one.rate"
    awk -v n="$count" -v s="$processor" 'BEGIN { printf "%.1f\n", 1000 * s / n }' >>"$work/$one.ms"
  done
done
echo "$count frames, $rounds rounds in turn"
echo '| drawn by | frames/s | processor time of a frame, ms |'
echo '|---|---|---|'
for one in "${cases[@]}"; do
  line="| $one |"
  for what in rate ms; do
    line+=" $(median <"$work/$one.$what") ($(sort -g "$work/$one.$what" | head -1)..$(sort -g "$work/$one.$what" | tail -1)) |"
  done
  echo "$line"
done
