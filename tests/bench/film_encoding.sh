#!/bin/bash
# Settings of the encoder of films, in turn, on the same frames: processor time of ffmpeg alone, bytes, and likeness (PSNR, SSIM) to
# the frames before encoding.
#   tests/bench/film_encoding.sh [--counts] [VPE [FRAMES [ROUNDS [OPTION...]]]]
# FRAMES as in `vpe fly --frames`, ROUNDS at least 5; options are those of `vpe fly`, also a planet. Prints medians, and the median of
# each time over that of the settings of today in the same round (least..largest). --counts prints the instructions of ffmpeg
# and of to_planar_420() by callgrind instead; few frames will do.
set -euo pipefail
counts=false
if [[ ${1:-} == --counts ]]; then
  counts=true
  shift
fi
vpe=${1:-build/release/vpe}
frames=${2:-360-419}
rounds=${3:-5}
options=("${@:4}")
[[ $frames =~ ^[0-9]+-[0-9]+$ && $rounds =~ ^[0-9]+$ && $rounds -ge 5 ]] || {
  sed -n '4s/^# *//p' "$0" >&2
  exit 2
}
bench=$(dirname "$0")
planes=$(dirname "$vpe")/tests/bench/film_planes
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
export LC_ALL=C TIMEFORMAT='%R %U %S'
. "$bench/timing.sh"

size=1280x720
"$vpe" fly "$bench/../../scripts/flights/valles-marineris.flight" "${options[@]}" --size "$size" -o "$work/frames" --frames "$frames" \
  --threads 2 --quiet
ffmpeg -v error -framerate 30 -start_number "${frames%%-*}" -i "$work/frames/frame_%06d.png" -f rawvideo -pix_fmt rgb24 "$work/frames.rgb"
rm -r "$work/frames"
"$planes" "$size" <"$work/frames.rgb" >"$work/frames.yuv"

scaled='scale=out_color_matrix=bt709:out_range=tv:flags=accurate_rnd+full_chroma_int+full_chroma_inp,format=yuv420p'
ahead='open-gop=0:mbtree=1:rc-lookahead=10'
names=(now rgb planes plain nob ultra)
declare -A what=(
  [now]='planes, `superfast` with `mbtree=1:rc-lookahead=10` (today)'
  [rgb]='RGB, `veryfast`, colours converted by ffmpeg (before 2026-11-28)'
  [planes]='planes, `veryfast`'
  [plain]='planes, `superfast` alone'
  [nob]='as today, without B-frames'
  [ultra]='`ultrafast` with the look-ahead, CABAC and B-frames'
)
declare -A input=([rgb]=rgb24) # else planes
declare -A words=(
  [now]="-preset superfast -x264-params $ahead"
  [rgb]="-vf $scaled -preset veryfast -x264-params open-gop=0"
  [planes]="-preset veryfast -x264-params open-gop=0"
  [plain]="-preset superfast -x264-params open-gop=0"
  [nob]="-preset superfast -x264-params $ahead:bframes=0"
  [ultra]="-preset ultrafast -x264-params $ahead:cabac=1:bframes=3"
)
ffmpeg=(ffmpeg)
encode() { # NAME FORMAT FILE
  # shellcheck disable=SC2086  # the words are words
  "${ffmpeg[@]}" -y -nostdin -v error -f rawvideo -pix_fmt "$2" -s "$size" -framerate 30 -i "$3" -colorspace bt709 -color_primaries bt709 \
    -color_trc bt709 -color_range tv -c:v libx264 ${words[$1]} -crf 18 -threads 4 -f mp4 "$work/$1.mp4"
}
one() {
  if [[ -n ${input[$name]:-} ]]; then encode "$name" "${input[$name]}" "$work/frames.rgb"; else encode "$name" yuv420p "$work/frames.yuv"; fi
}
likeness() { # NAME
  ffmpeg -v info -i "$work/$1.mp4" -f rawvideo -pix_fmt rgb24 -s "$size" -framerate 30 -i "$work/frames.rgb" -lavfi \
    '[0:v]setpts=N/30/TB,format=gbrp,split[a][b];[1:v]setpts=N/30/TB,format=gbrp,split[c][d];[a][c]ssim;[b][d]psnr' \
    -f null - 2>&1 | grep -oE 'All:[0-9.]*|average:[0-9.]*' | sort -r |
    awk -F: '{ x[NR] = $2 } END { printf "%.2f dB; %.4f", x[1], x[2] }'
}

if $counts; then
  callgrind=(valgrind --tool=callgrind --callgrind-out-file=/dev/null)
  ffmpeg=("${callgrind[@]}" ffmpeg)
  for name in "${names[@]}"; do
    echo "$(one 2>&1 | sed -n 's/.*Collected : *//p') instructions: ${what[$name]}"
  done
  echo "$("${callgrind[@]}" --toggle-collect='*to_planar_420*' "$planes" "$size" 2>&1 >/dev/null <"$work/frames.rgb" |
    sed -n 's/.*Collected : *//p') instructions: to_planar_420()"
  exit
fi
for ((n = 0; n <= rounds; ++n)); do # the first round warms
  for name in "${names[@]}"; do
    read -r _ processor < <(seconds one)
    if ((n == 0)); then continue; fi
    echo "$processor" >>"$work/$name.s"
    if [[ $name == now ]]; then now=$processor; fi
    awk -v a="$processor" -v b="$now" 'BEGIN { printf "%.3f\n", a / b }' >>"$work/$name.ratio"
  done
done
echo "$rounds rounds in turn"
echo '| input and settings of x264, `crf 18` | processor time, s | of today | bytes | PSNR; SSIM |'
echo '|---|---|---|---|---|'
for name in "${names[@]}"; do
  echo "| ${what[$name]} | $(median <"$work/$name.s") | $(median <"$work/$name.ratio")" \
    "($(sort -g "$work/$name.ratio" | head -1)..$(sort -g "$work/$name.ratio" | tail -1)) | $(stat -c %s "$work/$name.mp4") | $(likeness "$name") |"
done
