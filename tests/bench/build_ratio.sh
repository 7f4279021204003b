#!/bin/bash
# Build time against gdalwarp (bilinear, 2 threads, as many output posts) followed by gdaladdo, in turn.
#   tests/bench/build_ratio.sh [VPE [DEM [SPACING_M [ROUNDS]]]]
# Prints seconds of wall and processor time of both, and the medians of their ratios. Let nothing else run beside it:
# then the wall times count; beside other work only the processor times do.
set -euo pipefail
vpe=${1:-build/release/vpe}
dem=${2:-../shared/data/mola8/mola8_topo.lbl}
spacing=${3:-5300}
rounds=${4:-5}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
export LC_ALL=C TIMEFORMAT='%R %U %S'

posts=$("$vpe" build "$dem" -o "$work/p.vpe" --spacing "$spacing" --base-spacing "$spacing" --estimate --json |
  sed -n 's/.*"posts": *\([0-9]*\).*/\1/p')
# A global map twice as wide as high, of as many pixels.
height=$(awk -v n="$posts" 'BEGIN { print int(sqrt(n / 2) + 0.5) }')
echo "$posts posts; gdalwarp to $((2 * height)) x $height"

build() {
  rm -f "$work"/p.vpe*
  "$vpe" build "$dem" -o "$work/p.vpe" --spacing "$spacing" --base-spacing "$spacing" --threads 2 -q
}
warp() {
  rm -f "$work"/w.tif*
  gdalwarp -q -r bilinear -multi -wo NUM_THREADS=2 -ts $((2 * height)) "$height" -co TILED=YES -co COMPRESS=ZSTD \
    -co NUM_THREADS=2 "$dem" "$work/w.tif"
  gdaladdo -q -r average "$work/w.tif" 2 4 8 16
}
. "$(dirname "$0")/timing.sh"

for ((n = 1; n <= rounds; ++n)); do
  read -r vpe_wall vpe_cpu < <(seconds build)
  read -r gdal_wall gdal_cpu < <(seconds warp)
  echo "vpe build: $vpe_wall s, processor $vpe_cpu s; gdalwarp + gdaladdo: $gdal_wall s, processor $gdal_cpu s"
  awk -v a="$vpe_wall" -v b="$gdal_wall" 'BEGIN { print a / b }' >>"$work/wall"
  awk -v a="$vpe_cpu" -v b="$gdal_cpu" 'BEGIN { print a / b }' >>"$work/processor"
done
echo "median ratio of wall times $(median <"$work/wall"), of processor times $(median <"$work/processor")"
