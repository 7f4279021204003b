#!/bin/bash
# Maps of elevations against gdalwarp (bilinear, 2 threads), in turn: the same pixels, coordinate system, type, compression,
# tiles and overviews. gdalwarp reads the planet's own heights, from a map at the distance of its posts.
#   tests/bench/map_ratio.sh [VPE [PLANET [SPACING_M [ROUNDS [WEST,SOUTH,EAST,NORTH]]]]]
# Prints seconds of wall and processor time of both, and the medians of the ratios of gdalwarp's to ours. Let nothing else
# run beside it: then the wall times count; beside other work only the processor times do.
set -euo pipefail
vpe=${1:-build/release/vpe}
planet=${2:-}
spacing=${3:-500}
rounds=${4:-5}
box=${5:-120,25,160,55}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
export LC_ALL=C TIMEFORMAT='%R %U %S'

IFS=, read -r west south east north <<<"$box"
crs=$(awk -v w="$west" -v s="$south" -v e="$east" -v n="$north" \
  'BEGIN { print "+proj=stere +lat_0=" (s + n) / 2 " +lon_0=" (w + e) / 2 " +R=3396190" }')
map() { # of the box to the file $work/map.tif
  rm -f "$work/map.tif"
  "$vpe" map ${planet:+"$planet"} --box="$box" --crs "$crs" --spacing "$spacing" -o "$work/map.tif" --threads 2 --quiet
}
map >"$work/log"
posts=$(gdalinfo "$work/map.tif" | sed -n 's/.*VPE_POST_SPACING_M=\([0-9.]*\).*/\1/p')
read -r x0 y1 < <(gdalinfo "$work/map.tif" | sed -n 's/^Upper Left *( *\([-0-9.]*\), *\([-0-9.]*\)).*/\1 \2/p')
read -r x1 y0 < <(gdalinfo "$work/map.tif" | sed -n 's/^Lower Right *( *\([-0-9.]*\), *\([-0-9.]*\)).*/\1 \2/p')
read -r columns rows < <(gdalinfo "$work/map.tif" | sed -n 's/^Size is \([0-9]*\), \([0-9]*\)/\1 \2/p')
# The corners of the map lie beyond the box.
"$vpe" map ${planet:+"$planet"} --box="$((west - 20)),$((south - 15)),$((east + 20)),$((north + 15))" --spacing "$posts" \
  -o "$work/posts.tif" --quiet >"$work/log"
gdal_translate -q -co TILED=YES "$work/posts.tif" "$work/plain.tif"
warp() {
  rm -f "$work/warp.tif"
  gdalwarp -q -of COG -r bilinear -t_srs "$crs" -te "$x0" "$y0" "$x1" "$y1" -ts "$columns" "$rows" -ot Float32 \
    -dstnodata nan -multi -wo NUM_THREADS=2 -co COMPRESS=DEFLATE -co PREDICTOR=FLOATING_POINT \
    -co OVERVIEW_PREDICTOR=FLOATING_POINT -co OVERVIEW_RESAMPLING=AVERAGE -co BLOCKSIZE=512 -co NUM_THREADS=2 \
    "$work/plain.tif" "$work/warp.tif"
}
. "$(dirname "$0")/timing.sh"

echo "$columns x $rows pixels of $spacing m, posts $posts m apart, $crs"
for ((n = 1; n <= rounds; ++n)); do
  read -r vpe_wall vpe_cpu < <(seconds map)
  read -r gdal_wall gdal_cpu < <(seconds warp)
  echo "vpe map: $vpe_wall s, processor $vpe_cpu s; gdalwarp: $gdal_wall s, processor $gdal_cpu s"
  awk -v a="$gdal_wall" -v b="$vpe_wall" 'BEGIN { print a / b }' >>"$work/wall"
  awk -v a="$gdal_cpu" -v b="$vpe_cpu" 'BEGIN { print a / b }' >>"$work/processor"
done
echo "bytes: vpe map $(stat -c %s "$work/map.tif"), gdalwarp $(stat -c %s "$work/warp.tif")"
echo "vpe map has $(median <"$work/wall") times gdalwarp's rate by wall time, $(median <"$work/processor") by processor time"
