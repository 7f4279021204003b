#!/bin/bash
# Films by two programs in turn, with encoding: seconds of wall and processor time a frame, ffmpeg's included.
#   tests/bench/film_ratio.sh OTHER_VPE [VPE [FRAMES [ROUNDS [OPTION...]]]]
# FRAMES as in `vpe fly --frames`; options are those of `vpe fly` for both, also a planet and --backend. Prints the medians of the
# ratios of OTHER_VPE's times to those of VPE, the bytes of both films, and the likeness (SSIM, PSNR) of each to the frames
# before encoding. Beside other work only the processor times count.
set -euo pipefail
other=$1
vpe=${2:-build/release/vpe}
frames=${3:-300-419}
rounds=${4:-5}
options=("${@:5}")
flight=$(dirname "$0")/../../scripts/flights/valles-marineris.flight
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
export LC_ALL=C TIMEFORMAT='%R %U %S'

film() { # by program $1 to the folder $2
  rm -rf "${work:?}/$2"
  mkdir "$work/$2"
  "$1" fly "$flight" "${options[@]}" -o "$work/$2/film.mp4" --frames "$frames" --threads 2 --quiet
}
of_other() { film "$other" other; }
of_vpe() { film "$vpe" vpe; }
. "$(dirname "$0")/timing.sh"

likeness() { # of the film in folder $1 to the PNG frames
  ffmpeg -v info -i "$work/$1/film.mp4" -framerate 30 -start_number "${frames%%-*}" -i "$work/frames/frame_%06d.png" -lavfi \
    '[0:v]setpts=N/30/TB,format=gbrp,split[a][b];[1:v]setpts=N/30/TB,format=gbrp,split[c][d];[a][c]ssim;[b][d]psnr' \
    -f null - 2>&1 | grep -oE 'SSIM.*|average:[0-9.]*' | grep -oE 'All:[0-9.]*|average:[0-9.]*' | tr '\n' ' '
}

of_other && of_vpe  # warm
for ((n = 1; n <= rounds; ++n)); do
  read -r other_wall other_cpu < <(seconds of_other)
  read -r vpe_wall vpe_cpu < <(seconds of_vpe)
  echo "other: $other_wall s, processor $other_cpu s; vpe: $vpe_wall s, processor $vpe_cpu s"
  awk -v a="$other_wall" -v b="$vpe_wall" 'BEGIN { print a / b }' >>"$work/wall"
  awk -v a="$other_cpu" -v b="$vpe_cpu" 'BEGIN { print a / b }' >>"$work/processor"
  echo "$vpe_cpu" >>"$work/seconds"
done
rm -rf "$work/frames"
"$vpe" fly "$flight" "${options[@]}" -o "$work/frames" --frames "$frames" --threads 2 --quiet
count=$(find "$work/frames" -name '*.png' | wc -l)
for one in other vpe; do echo "$one: $(stat -c %s "$work/$one/film.mp4") bytes, $(likeness "$one")"; done
median <"$work/seconds" | awk -v n="$count" '{ printf "%d frames; vpe: %.1f ms of processor time a frame\n", n, 1000 * $1 / n }'
echo "median ratio of wall times $(median <"$work/wall"), of processor times $(median <"$work/processor")"
