#!/bin/bash
# Build time against gdalwarp (bilinear, 2 threads, as many output posts) followed by gdaladdo, in turn.
#   tests/bench/build_ratio.sh [--former FORMER_VPE] [--counts] [--choices] [VPE [DEM [SPACING_M [ROUNDS]]]]
# Prints seconds of wall and processor time of all, and medians with the least and the largest of their ratios. With a
# former program it builds in the same turns, and both planets must be equal. --counts adds the instructions of a build with
# posts twice as far apart, on one thread, and the branches that callgrind's model of a processor mispredicts. --choices runs
# GDAL with other choices in the same turns, and prints their processor times over that of the choice compared, and the
# build's over theirs. Let nothing else run beside it: then the wall times count; beside other work only the processor
# times do.
set -euo pipefail
former=
counts=false
choices=false
while [[ ${1:-} == --* ]]; do
  case $1 in
    --former) former=$2; shift 2 ;;
    --counts) counts=true; shift ;;
    --choices) choices=true; shift ;;
    *) echo "build_ratio.sh: unknown option $1" >&2; exit 2 ;;
  esac
done
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

build_by() { # PROGRAM NAME SPACING_M THREADS
  rm -f "$work/$2".vpe*
  "$1" build "$dem" -o "$work/$2.vpe" --spacing "$3" --base-spacing "$3" --threads "$4" -q
}
build() { build_by "$vpe" new "$spacing" 2; }
build_former() { build_by "$former" former "$spacing" 2; }
warp_by() { # COMPRESSION RESAMPLING [OPTION ...]
  local compression=$1 resampling=$2
  shift 2
  rm -f "$work"/w.tif*
  gdalwarp -q -r "$resampling" -multi -wo NUM_THREADS=2 -ts $((2 * height)) "$height" -co TILED=YES \
    -co COMPRESS="$compression" -co NUM_THREADS=2 "$@" "$dem" "$work/w.tif"
  gdaladdo -q -r average "$work/w.tif" 2 4 8 16
}
warp() { warp_by ZSTD bilinear; }
warp_deflate() { warp_by DEFLATE bilinear; }
warp_plain() { warp_by NONE bilinear; }
warp_cubic() { warp_by ZSTD cubic; }
warp_exact() { warp_by ZSTD bilinear -et 0 -wm 500; }
other_choices="deflate plain cubic exact"
. "$(dirname "$0")/timing.sh"

ratio() { # NAME A B: keeps a / b
  awk -v a="$2" -v b="$3" 'BEGIN { print a / b }' >>"$work/$1"
}
summary() { # NAME: median (least..largest)
  echo "$(median <"$work/$1") ($(sort -g "$work/$1" | head -1)..$(sort -g "$work/$1" | tail -1))"
}
identity() { "$vpe" info "$work/$1.vpe" --json | sed -n 's/.*"identity": *"\([^"]*\)".*/\1/p'; }

for ((n = 1; n <= rounds; ++n)); do
  former_cpu=
  if [[ -n $former ]]; then read -r _ former_cpu < <(seconds build_former); fi
  read -r vpe_wall vpe_cpu < <(seconds build)
  read -r gdal_wall gdal_cpu < <(seconds warp)
  echo "vpe build: $vpe_wall s, processor $vpe_cpu s; gdalwarp + gdaladdo: $gdal_wall s, processor $gdal_cpu s" \
    "${former_cpu:+; former build: processor $former_cpu s}"
  ratio wall "$vpe_wall" "$gdal_wall"
  ratio processor "$vpe_cpu" "$gdal_cpu"
  if [[ -n $former ]]; then
    ratio new_former "$vpe_cpu" "$former_cpu"
    ratio former_gdal "$former_cpu" "$gdal_cpu"
  fi
  if $choices; then
    for choice in $other_choices; do
      read -r _ choice_cpu < <(seconds "warp_$choice")
      ratio "$choice" "$choice_cpu" "$gdal_cpu"
      ratio "new_$choice" "$vpe_cpu" "$choice_cpu"
    done
  fi
done
echo "median ratio of wall times $(summary wall), of processor times $(summary processor)"
if [[ -n $former ]]; then
  echo "processor times: new / former $(summary new_former), former / GDAL $(summary former_gdal)"
  [[ -n $(identity new) && $(identity new) == "$(identity former)" ]] || { echo "the planets differ" >&2; exit 1; }
  echo "equal planets: $(identity new)"
fi
if $choices; then
  for choice in $other_choices; do
    echo "processor times: $choice / GDAL $(summary "$choice"), vpe / $choice $(summary "new_$choice")"
  done
fi

instructions() { # PROGRAM NAME: instructions and mispredicted branches
  valgrind --tool=callgrind --branch-sim=yes --callgrind-out-file=/dev/null "$1" build "$dem" -o "$work/$2.vpe" \
    --spacing $((2 * spacing)) --base-spacing $((2 * spacing)) --threads 1 -q 2>&1 |
    awk '/Collected : / { sub(/.*Collected : /, ""); printf "%.0f, mispredicted branches %.0f", $1, $3 + $5 }'
}
if $counts; then
  rm -f "$work"/*.vpe*
  echo "instructions: $(instructions "$vpe" new)${former:+; former $(instructions "$former" former)}"
fi
