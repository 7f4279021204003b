#!/bin/bash
# Time of `vpe patch` against the full build of the same planet, in turn.
#   tests/bench/patch_ratio.sh STRIP [VPE [BASE [ROUNDS [OPTION...]]]]
# STRIP is a raster or a file of reliefs; BASE the raster of the planet, by default the embedded Mars; options are those of
# `vpe build` for both. Prints seconds of wall and processor time of both, and the medians of their ratios.
set -euo pipefail
strip=$1
vpe=${2:-build/release/vpe}
base=${3:-embedded}
rounds=${4:-3}
options=("${@:5}")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
export LC_ALL=C TIMEFORMAT='%R %U %S'

image=()
[[ $base == embedded ]] && image=(--image embedded)
"$vpe" build "$base" "${image[@]}" "${options[@]}" -o "$work/base.vpe" -q
step=$("$vpe" info "$work/base.vpe" --json | sed -n 's/.*"height_quantum_m": *\([0-9.e-]*\).*/\1/p')

patch() {
  rm -f "$work"/patched.vpe*
  "$vpe" patch "$work/base.vpe" "$strip" -o "$work/patched.vpe" -q
}
full() {
  rm -f "$work"/full.vpe*
  "$vpe" build "$base" "$strip" "${image[@]}" "${options[@]}" --height-step "$step" -o "$work/full.vpe" -q
}
identity() { "$vpe" info "$1" --json | sed -n 's/.*"identity": *"\([0-9a-f]*\)".*/\1/p'; }
. "$(dirname "$0")/timing.sh"

for ((n = 1; n <= rounds; ++n)); do
  read -r patch_wall patch_cpu < <(seconds patch)
  read -r full_wall full_cpu < <(seconds full)
  echo "vpe patch: $patch_wall s, processor $patch_cpu s; vpe build: $full_wall s, processor $full_cpu s"
  awk -v a="$patch_wall" -v b="$full_wall" 'BEGIN { print a / b }' >>"$work/wall"
  awk -v a="$patch_cpu" -v b="$full_cpu" 'BEGIN { print a / b }' >>"$work/processor"
done
[[ $(identity "$work/patched.vpe") == $(identity "$work/full.vpe") ]] || { echo "the planets differ" >&2; exit 1; }
echo "median ratio of wall times $(median <"$work/wall"), of processor times $(median <"$work/processor")"
