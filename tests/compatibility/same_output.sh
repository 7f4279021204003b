#!/usr/bin/env bash
# Checks that two versions of vpe make the same output.
#
#   tests/compatibility/same_output.sh [--same-names] [--only PATTERN] OLD_VPE NEW_VPE [WORKDIR]
#
# Runs the same commands with both programs, one at a time, and compares what they write byte by byte. Gives
# renamed options and settings to the new program twice: by their old names, which it must still take, and by
# their new ones (--same-names leaves these out). --only runs the cases whose name matches a shell pattern.
#
# Prints a line for each output:
#   same     NAME  BYTES/SHA256   equal; the brackets name what is not compared: versions and measured times
#   renamed  NAME  BYTES/SHA256   equal but for words that compare_output.py lists as renamed on purpose
#   DIFFERS  NAME  WHERE          different, or a program failed
#   skipped  NAME  WHY
# Exits with 1 if anything differs. WORKDIR (a temporary folder when left out, removed unless something differs)
# keeps everything: old/CASE, new/CASE, and renamed/CASE for the new program with new names.
#
# Needs bash, Python 3, and for some cases ffmpeg and the planetary data beside the checkout (../shared/data, or
# $VPE_SHARED_DATA). Takes about three minutes on two cores, four with new names.
# shellcheck disable=SC2054 # commas within words
set -uo pipefail

usage() {
  sed -n '4s/^# *//p' "$0" >&2
  exit 2
}
new_names=yes
only='*'
while [ $# -gt 0 ]; do
  case "$1" in
    --same-names) new_names=no ;;
    --only)
      only=${2:?--only needs a pattern}
      shift
      ;;
    -*) usage ;;
    *) break ;;
  esac
  shift
done
if [ $# -lt 2 ] || [ $# -gt 3 ]; then usage; fi
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
root=$(cd "$here/../.." && pwd)
old_vpe=$(realpath -e "$1") && new_vpe=$(realpath -e "$2") || exit 2
if [ $# -eq 3 ]; then
  mkdir -p "$3" && work=$(cd "$3" && pwd) || exit 2
  own_work=no
  if [ -n "$(ls -A "$work")" ]; then
    echo "same_output.sh: $work is not empty" >&2
    exit 2
  fi
else
  work=$(mktemp -d)
  own_work=yes
fi
data=${VPE_SHARED_DATA:-$root/../shared/data}
# The interpreter itself: a wrapper around it would cost as much as the comparisons.
python=$("${PYTHON:-python3}" -c 'import sqlite3, sys, zlib; print(sys.executable)') || exit 2
compare=("$python" "$here/compare_output.py")

# The user's own files and variables must not count.
export XDG_CACHE_HOME=$work/cache XDG_CONFIG_HOME=$work/config
export XDG_STATE_HOME=$work/state XDG_DATA_HOME=$work/data
export VPE_THREADS=2 LC_ALL=C TZ=UTC
unset VPE_MEMORY
mkdir -p "$work"/{cache,config,state,data,in/old,in/new}

same=0 renamed=0 different=0 skipped=0

report() { # WORD NAME [DETAILS]
  case "$1" in
    same) same=$((same + 1)) ;;
    renamed) renamed=$((renamed + 1)) ;;
    skipped) skipped=$((skipped + 1)) ;;
    *) different=$((different + 1)) ;;
  esac
  printf '%-8s %s%s\n' "$1" "$2" "${3:+  $3}"
}

# Compares two paths and reports the result under a name.
compare_paths() { # NAME OLD NEW
  local line
  line=$("${compare[@]}" "$2" "$3")
  report "${line%%$'\t'*}" "$1" "${line#*$'\t'}"
}

# Runs a program in $work/SIDE/NAME, with stdin from $input when that is set. Keeps what it prints in
# $work/SIDE/NAME.stdout and NAME.stderr.
run() { # SIDE PROGRAM NAME ARGUMENT...
  local side=$1 program=$2 folder=$work/$1/$3
  shift 3
  mkdir -p "$folder"
  (cd "$folder" && exec "$program" "$@" <"${input:-/dev/null}" >"$folder.stdout" 2>"$folder.stderr")
  local status=$?
  echo "$*" >"$folder.command"
  return "$status"
}

# Prints the last message of a program that failed.
fault() { # FILE
  grep -v '^Run with --help' "$1" | tail -n 1
}

# Puts the words of the new version into `translated`.
translate() { # ARGUMENT...
  local word before=
  translated=()
  for word in "$@"; do
    case "$before $word" in
      '--backend voxel') word=ray ;;
      '--set rays.mode=plain') word=rays.mode=reference ;;
      '--set lod.rule=hitchner') word=lod.metric=distance ;;
      '--set lod.rule='*) word=lod.metric=${word#*=} ;;
      '--align fit' | '--level fit') word=plane ;;
      '--align bend' | '--level bend') word=edges ;;
      *' --level') word=--align ;;
      *' --mask-blunders') word=--reject-outliers ;;
      *' --convert') word=--to-datum ;;
      *' --convert='*) word=--to-datum=${word#*=} ;;
      *' --planes') word=--aux-layers ;;
      *' --again') word=--from-sidecar ;;
      *'/old-names.'*) word=${word/old-names/new-names} ;;
      *'/old/names.'*) word=${word/'/old/names'/'/new/names'} ;;
    esac
    translated+=("$word")
    before=$word
  done
}

is_wanted() {
  # shellcheck disable=SC2053 # a pattern on purpose
  [[ $1 == $only ]]
}

# Runs a case with both programs and compares its outputs: files and folders that it writes, or stdout.EXT for
# what it prints, compared as a file of that kind. Both must exit with the status $expected.
check() { # NAME OUTPUT... -- ARGUMENT...
  local name=$1 outputs=() status
  is_wanted "$name" || return 0
  shift
  while [ "$1" != -- ]; do
    outputs+=("$1")
    shift
  done
  shift
  run old "$old_vpe" "$name" "$@"
  status=$?
  if [ "$status" -ne "${expected:-0}" ]; then
    report DIFFERS "$name" "the old program exits with $status: $(fault "$work/old/$name.stderr")"
    return
  fi
  check_side "$name" new "$name" "$@"
  [ "$new_names" = yes ] || return 0
  translate "$@"
  [ "$*" = "${translated[*]}" ] || check_side "$name (new names)" renamed "$name" "${translated[@]}"
}

# Runs the new program for check() and compares what it writes. Reads the array `outputs`.
check_side() { # TITLE SIDE NAME ARGUMENT...
  local title=$1 side=$2 name=$3 status output
  shift 3
  run "$side" "$new_vpe" "$name" "$@"
  status=$?
  if [ "$status" -ne "${expected:-0}" ]; then
    report DIFFERS "$title" "the new program exits with $status: $(fault "$work/$side/$name.stderr")"
    return
  fi
  [ ${#outputs[@]} -gt 0 ] || report same "$title" "exit status $status"
  for output in "${outputs[@]}"; do
    case "$output" in
      stdout.*)
        cp "$work/old/$name.stdout" "$work/old/$name/$output"
        cp "$work/$side/$name.stdout" "$work/$side/$name/$output"
        ;;
    esac
    compare_paths "$title/$output" "$work/old/$name/$output" "$work/$side/$name/$output"
  done
}

# Runs the new program alone, by old and by new names, and compares its outputs with what the old one wrote.
check_new() { # NAME OUTPUT=REFERENCE... -- ARGUMENT...
  local name=$1 pairs=() pair side
  is_wanted "$name" || return 0
  shift
  while [ "$1" != -- ]; do
    pairs+=("$1")
    shift
  done
  shift
  translate "$@"
  for side in new renamed; do
    local title=$name arguments=("$@")
    if [ "$side" = renamed ]; then
      if [ "$new_names" = no ] || [ "$*" = "${translated[*]}" ]; then continue; fi
      title="$name (new names)"
      arguments=("${translated[@]}")
    fi
    if ! run "$side" "$new_vpe" "$name" "${arguments[@]}"; then
      report DIFFERS "$title" "the new program fails: $(fault "$work/$side/$name.stderr")"
      continue
    fi
    for pair in "${pairs[@]}"; do
      compare_paths "$title/${pair%%=*}" "$work/${pair#*=}" "$work/$side/$name/${pair%%=*}"
    done
  done
}

# --------------------------------------------------------------------------------------------------------------
# Inputs

cat >"$work/in/names.csv" <<'TEXT'
name,lon,lat,diameter_km
Near,-59.15,-13.68,1
North rim,-59.2,-13.3,20
South rim,-59.25,-14.1,5
East,-58.8,-13.65,3
Far,-62.0,-13.5,100
TEXT
printf '%s\n' -59.2,-13.7 -59.31,-13.52 120,10 0,90 180,-45.5 137.4,-4.6 >"$work/in/places.csv"
flight() { # SETTINGS
  cat <<TEXT
flight 1
view fov=60 size=320x200 fps=10
at 0 pose lon=-59.6 lat=-13.9 alt=12000 yaw=60 pitch=-15 roll=0
at 1 look yaw=20 pitch=5
at 1 interest lon=-59.2 lat=-13.7 radius=20000 levels=+1
at 1.5 pose lon=-59.2 lat=-13.7 height=2000 yaw=80 pitch=-20 roll=-15
at 1.5 set overlay.compass=on exaggeration=2
at 2 set mode=lit ${1:-}
at 3 pose lon=-58.9 lat=-13.5 alt=9000 yaw=120 pitch=-25 roll=5
at 3 end
TEXT
}
flight >"$work/in/film.flight"
flight "lod.rule=hitchner rays.mode=plain" >"$work/in/old/names.flight"
flight "lod.metric=distance rays.mode=reference" >"$work/in/new/names.flight"
cat >"$work/in/old-names.toml" <<'TEXT'
[render]
backend = "voxel"
size = "320x200"
set = ["mode=lit", "rays.mode=multires"]
TEXT
sed 's/voxel/ray/' "$work/in/old-names.toml" >"$work/in/new-names.toml"

in=../../in
planets=../../planets

# --------------------------------------------------------------------------------------------------------------
# Planets: identity, all tables, and what `info` says

# Builds a planet with both programs and keeps the old one for the cases that follow.
planet() { # NAME ARGUMENT...
  local name=$1
  shift
  if is_wanted "planet-$name"; then
    check "planet-$name" planet.vpe -- build "$@" -q -o planet.vpe
  else
    run old "$old_vpe" "planet-$name" build "$@" -q -o planet.vpe
  fi
  if ! mv "$work/old/planet-$name/planet.vpe" "$work/planets/$name.vpe"; then
    echo "same_output.sh: the old program cannot build planets" >&2
    exit 1
  fi
  # An old planet file opens with the new program and holds the same.
  check "info-$name" stdout.json -- info --json "$planets/$name.vpe"
  check "verify-$name" stdout.json -- verify --json "$planets/$name.vpe"
}

mkdir -p "$work/planets"
region=--region=-59.7,-14.2,-58.7,-13.2
planet embedded embedded --image embedded --base-spacing 60000 "$region" --spacing 250
mola=$data/mola4/megt90n000cb.lbl
mola128=$data/gale-mola128/gale_megt128.lbl
ctx=$data/gale-ctx20/gale_ctx20_mosaic.tif
ctx_sphere=B01_009861_1753_XI_04S222W__B06_011984_1754_XN_04S222W-DEM.tif
coarse=(--base-spacing 20000 --spacing 15000)
whole=embedded # a planet to look at from orbit
if [ -e "$mola" ]; then
  whole=mola
  planet mola "$mola" "${coarse[@]}"
else
  report skipped planet-mola "$mola is not there"
fi
inset=embedded # a planet with places that have no data
if [ -e "$mola128" ] && [ -e "$ctx" ]; then
  inset=gale
  gale=(--base-spacing 60000 --region 137.3,-4.75,137.45,-4.6 --spacing 120)
  planet gale "$mola128" "$ctx" --datum areoid --level bend --mask-blunders "${gale[@]}"
  check planet-fit planet.vpe -- build "$mola128" "$ctx" --datum areoid --level fit --blunder 100 "${gale[@]}" \
    -q -o planet.vpe
  check planet-convert planet.vpe -- build "$mola128" "$data/gale-ctx20/$ctx_sphere" --level fit \
    --datum "$ctx_sphere=sphere:3396190" --convert --areoid "$data/mola8/mola8_areoid.lbl" "${gale[@]}" \
    -q -o planet.vpe
else
  report skipped planet-gale "no data of Gale crater in $data"
fi

# Parts of a build, merged: by each program, and by the new one from parts that both made.
if is_wanted planet-parts; then
  source=(embedded --base-spacing 90000 "$region" --spacing 1000)
  for side in old new; do
    program=$new_vpe
    [ "$side" = new ] || program=$old_vpe
    run "$side" "$program" planet-parts build "${source[@]}" -q -o p.vpe --part 1/2
    run "$side" "$program" planet-parts build "${source[@]}" -q -o p.vpe --part 2/2
    run "$side" "$program" planet-parts merge -q -o merged.vpe p.1-of-2.vpe p.2-of-2.vpe
    run "$side" "$program" planet-parts build "${source[@]}" -q -o whole.vpe
  done
  for part in p.1-of-2.vpe p.2-of-2.vpe merged.vpe; do
    compare_paths "planet-parts/$part" "$work/old/planet-parts/$part" "$work/new/planet-parts/$part"
  done
  compare_paths planet-parts/whole "$work/old/planet-parts/whole.vpe" "$work/new/planet-parts/merged.vpe"
  if [ "$("$old_vpe" --version)" = "$("$new_vpe" --version)" ]; then
    check_new planet-parts-mixed merged.vpe=old/planet-parts/merged.vpe -- merge -q -o merged.vpe \
      ../../old/planet-parts/p.1-of-2.vpe ../../new/planet-parts/p.2-of-2.vpe
  else
    report skipped planet-parts-mixed "parts of two versions are not of one build"
  fi
fi

# A build that the old program leaves unfinished is finished by the new one.
if is_wanted planet-interrupted; then
  source=(embedded --base-spacing 60000 --region=-59.7,-14.2,-58.2,-12.7 --spacing 130 --threads 1)
  run old "$old_vpe" planet-interrupted build "${source[@]}" -q -o planet.vpe
  mkdir -p "$work/new/planet-interrupted"
  cd "$work/new/planet-interrupted" || exit 1
  # A job of its own group: bash lets background commands ignore SIGINT otherwise.
  set -m
  "$old_vpe" build "${source[@]}" -q -o planet.vpe 2>../planet-interrupted.stderr &
  set +m
  job=$!
  for _ in $(seq 100); do
    [ "$(stat -c %s planet.vpe.part 2>/dev/null || echo 0)" -gt 2000000 ] && break
    sleep 0.1
  done
  kill -INT -- "-$job"
  wait "$job"
  interrupted=$?
  kept=$(stat -c %s planet.vpe.part 2>/dev/null || echo 0)
  if [ "$interrupted" -ne 130 ] || [ "$kept" -eq 0 ]; then
    report DIFFERS planet-interrupted "not interrupted: exit status $interrupted, $kept bytes kept"
  else
    ln planet.vpe.part held # tells a file that was continued from one that was begun again
    run new "$new_vpe" planet-interrupted build "${source[@]}" -q -o planet.vpe
    compare_paths planet-interrupted/planet.vpe "$work/old/planet-interrupted/planet.vpe" planet.vpe
    if [ planet.vpe -ef held ]; then
      report same planet-interrupted/continued "$kept bytes were kept"
    elif [ "$("$old_vpe" --version)" != "$("$new_vpe" --version)" ]; then
      report skipped planet-interrupted/continued "another version begins a build again"
    else
      report DIFFERS planet-interrupted/continued "the new program began the build again"
    fi
  fi
  cd "$root" || exit 1
fi

# --------------------------------------------------------------------------------------------------------------
# Stills

backends=(polygon voxel)
near=(--pose=-59.2,-13.7,0,60,-10,0 --height 2500 --size 320x200)
low=(--pose=-59.31,-13.52,0,170,-4,12 --height 30 --size 320x200 --fov 75)
orbit=(--pose=-75,5,5500000,20,-85,0 --size 320x200 --fov 50)
pole=(--pose=0,89.99,30000,0,-35,0 --size 320x200)
seam=(--pose=179.99,0.01,20000,90,-10,-30 --size 320x200)
rover=(--pose=137.37,-4.67,0,118,2,0 --height 40 --size 320x200)

if ! run old "$old_vpe" probe render "$planets/embedded.vpe" "${near[@]}" --backend polygon -o probe.png; then
  report skipped polygon "the old program cannot draw triangles: $(fault "$work/old/probe.stderr")"
  backends=(voxel)
fi

# Draws a still with ranges and certificate by each backend.
still() { # NAME PLANET ARGUMENT...
  local name=$1 planet=$2 backend
  shift 2
  for backend in "${backends[@]}"; do
    check "still-$backend-$name" image.png range.tif certificate.json stdout.json -- \
      render "$planets/$planet.vpe" "$@" --backend "$backend" --range range.tif \
      --certificate certificate.json --json -o image.png
  done
}
# Draws a still by rays alone.
still_by_rays() { # NAME PLANET ARGUMENT...
  local kept=("${backends[@]}")
  backends=(voxel)
  still "$@"
  backends=("${kept[@]}")
}
# Draws a still by triangles alone.
still_by_triangles() { # NAME PLANET ARGUMENT...
  case " ${backends[*]} " in *' polygon '*) ;; *) return ;; esac
  local kept=("${backends[@]}")
  backends=(polygon)
  still "$@"
  backends=("${kept[@]}")
}

marks=(--set overlay.graticule=on --set overlay.contours=on --set overlay.scale=on --set overlay.north=on)
words=(--set overlay.legend=on --set overlay.compass=on --set "overlay.title=A title, West of it"
  --set overlay.names="$in/names.csv" --set overlay.distances=on)
still textured embedded "${near[@]}" --set mode=textured
still lit embedded "${near[@]}" --set mode=lit "${marks[@]}"
still coloured embedded "${near[@]}" --set mode=coloured "${words[@]}"
still unlit embedded "${low[@]}" --set mode=unlit --set colour=slope --set palette=viridis \
  --set overlay.legend=on
still low embedded "${low[@]}" --set shadows=on --set haze.visibility=60000 --set sun.elevation=12
still exaggerated embedded "${near[@]}" --set exaggeration=4 --set colourise=on --tolerance 0.3
still samples embedded "${near[@]}" --set samples=4 --set sun=Ls90,15:00 --set gamma=1.3
for backend in "${backends[@]}"; do # a pair has no range image
  check "still-$backend-stereo" image.png certificate.json -- render "$planets/embedded.vpe" "${low[@]}" \
    --backend "$backend" --stereo anaglyph --eye-base 5 --certificate certificate.json -o image.png
done
still orbit "$whole" "${orbit[@]}" --set mode=coloured --set overlay.graticule=on
still pole "$whole" "${pole[@]}" --set mode=coloured --set colour=aspect --set edges=hard
still seam "$whole" "${seam[@]}" --set mode=lit --set background=black
still rover "$inset" "${rover[@]}" --set mode=coloured --set overlay.contours=on
still_by_rays exact embedded "${low[@]}" --set rays.mode=exact --tolerance 0
still_by_rays multires embedded "${near[@]}" --set rays.mode=multires --set rays.cell=8
still_by_rays plain embedded "${low[@]}" --set rays.mode=plain
still_by_triangles levels embedded "${near[@]}" --set inspect=levels --set shading=flat \
  --interest=-59.2,-13.6,20000,1
still_by_triangles wireframe embedded "${near[@]}" --set mode=wireframe --set lod.triangles=20000
still_by_triangles distance embedded "${near[@]}" --set lod.rule=hitchner --set lod.distance.scale=200000
still_by_triangles table embedded "${near[@]}" --set lod.rule=hitchner --set lod.distance.table=0:9,2e4:6,1e5:4
still_by_triangles centre embedded "${near[@]}" --set lod.rule=error --set lod.centre.weight=1 \
  --set cull.occlusion=on --cull-from=-59.2,-13.7,0,60,-20,0
# What explains levels of detail, and overlays by themselves.
check explain-lod levels.json layer.png image.png -- render "$planets/embedded.vpe" "${near[@]}" "${marks[@]}" \
  --backend "${backends[0]}" --explain-lod levels.json --overlay-layer layer.png -o image.png
check still-jpeg image.jpg -- render "$planets/embedded.vpe" "${near[@]}" --backend voxel -o image.jpg
check still-config image.png -- render "$planets/embedded.vpe" --pose=-59.2,-13.7,5000,60,-10,0 \
  --config "$in/old-names.toml" -o image.png

# --------------------------------------------------------------------------------------------------------------
# Films

for backend in "${backends[@]}"; do
  check "film-$backend" frames stats.csv log.flight -- fly "$in/film.flight" "$planets/embedded.vpe" \
    --backend "$backend" -q -o frames --stats stats.csv --log log.flight
done
check film-old-names frames log.flight -- fly "$in/old/names.flight" "$planets/embedded.vpe" --frames 18-29x2 \
  --backend "${backends[0]}" -q -o frames --log log.flight
check film-voxel-old-names frames -- fly "$in/old/names.flight" "$planets/embedded.vpe" --frames 18-29x2 \
  --backend voxel -q -o frames
check film-part frames -- fly "$in/film.flight" "$planets/embedded.vpe" --part 2/3 --backend voxel -q -o frames
if [ -e "$work/old/film-voxel/log.flight" ]; then
  # The old program's log replays.
  check film-log frames -- fly ../film-voxel/log.flight "$planets/embedded.vpe" --frames 0-29x5 \
    --backend voxel -q -o frames
  # Frames that the old program left are completed by the new one.
  for side in new renamed; do
    mkdir -p "$work/$side/film-continued/frames"
    cp "$work/old/film-voxel/frames/"frame_00000?.png "$work/$side/film-continued/frames"
  done
  check_new film-continued frames=old/film-voxel/frames -- fly "$in/film.flight" "$planets/embedded.vpe" \
    --backend voxel -q -o frames
fi
if command -v ffmpeg >/dev/null; then
  check film-video film.mp4 film.mp4.json -- fly "$in/film.flight" "$planets/embedded.vpe" --frames 0-9 \
    --backend voxel -q -o film.mp4
else
  report skipped film-video "no ffmpeg"
fi

# --------------------------------------------------------------------------------------------------------------
# Panoramas

planes=range,lonlat,elevation,slope,incidence
at=(--at=-59.2,-13.7 --height 200)
# Draws a panorama with both programs, draws it with the new one from the old one's sidecar, and has both look
# into the old one.
panorama() { # NAME EXTENSION PLANES ARGUMENT...
  local name=panorama-$1 image=pano.$2 plane outputs=() pairs=() options=()
  pairs=("again.$2=old/$name/$image")
  if [ -n "$3" ]; then
    options=(--planes "$3")
    for plane in ${3//,/ }; do
      outputs+=("pano.$plane.tif")
      pairs+=("again.$plane.tif=old/$name/pano.$plane.tif")
    done
  fi
  shift 3
  check "$name" "$image" pano.json "${outputs[@]}" -- panorama "$planets/embedded.vpe" "${at[@]}" "$@" \
    "${options[@]}" -q -o "$image"
  [ -e "$work/old/$name/pano.json" ] || return
  check_new "$name-again" "${pairs[@]}" -- panorama --again "../../old/$name/pano.json" -q \
    -o "again.${image#*.}"
  check "$name-view" view.png stdout.json -- overlook "../../old/$name/$image" --view 119,-5 \
    --size 320x200 --fov 50 --compass -o view.png --json
  check "$name-pixels" stdout.json -- overlook "../../old/$name/$image" --at 200,-5 --at 250,-15 \
    --at-pixel 50.5,60.5 --json
}
panorama facets png "$planes" --projection facets --width 1000 --yaw 10
panorama cylinder tif "$planes" --projection cylinder --width 1000
panorama equirectangular jpg range --projection equirectangular --width 600
panorama arc png elevation --from 150 --to 260 --elevation=-20,20 --degrees-per-pixel 0.2 --set mode=lit \
  --sun Ls90,15:00
panorama overlays png '' --width 900 "${words[@]}" --set overlay.compass=horizon
panorama reference png '' --width 300 --set rays.mode=plain
panorama stereo-ou png '' --width 600 --stereo ou
panorama stereo-anaglyph png '' --width 400 --stereo anaglyph --eye-base 3
case " ${backends[*]} " in
  *' polygon '*) panorama triangles png range,lonlat --backend polygon --width 800 --facets 6 --tolerance 0.5 ;;
esac

# --------------------------------------------------------------------------------------------------------------
# Questions

for planet in embedded "$whole" "$inset"; do
  name=query-$planet
  [ -e "$work/old/$name" ] && continue
  check "$name" stdout.csv -- query "$planets/$planet.vpe" -59.2,-13.7 137.37,-4.668 137.4,-4.6 10,20
  check "$name-json" stdout.json -- query --json "$planets/$planet.vpe" -59.2,-13.7 137.37,-4.668 10,20
  input=$work/in/places.csv check "$name-stdin" stdout.csv -- query "$planets/$planet.vpe"
done
check profile stdout.csv -- profile "$planets/embedded.vpe" -59.4,-13.9 -59.2,-13.7 -58.9,-13.3
check profile-step stdout.csv -- profile "$planets/$whole.vpe" --step 20000 170,-10 -170,20
check profile-json stdout.json -- profile --json "$planets/$inset.vpe" --step 500 137.3,-4.7 137.45,-4.6
check horizon skyline.csv features.csv landscape stdout.json -- horizon "$planets/embedded.vpe" "${at[@]}" \
  --step 1 -o skyline.csv --names "$in/names.csv" --features features.csv --landscape landscape --json
check horizon-orbit skyline.csv -- horizon "$planets/$whole.vpe" --at 226.2,18.65 --altitude 400000 --from -20 \
  --to 40 --step 5 -o skyline.csv
check horizon-rover skyline.csv -- horizon "$planets/$inset.vpe" --at 137.37,-4.668 --height 2 --step 2 \
  -o skyline.csv

# --------------------------------------------------------------------------------------------------------------
# Files of the user, as far as commands read them without a window

mkdir -p "$work/config/vpe"
cat >"$work/config/vpe/explore.toml" <<'TEXT'
[gamepad]
invert_pitch = true

[head_tracker]
enabled = true
smoothing_s = 0.25
TEXT
check preferences stdout.toml -- explore --print-settings
printf 'spot "Here it is" -59.2 -13.7 2 pano.json # a comment\nspot There 10.5 20 0 "other place.json"\n' \
  >"$work/in/spots.txt"
printf 'spot "Here it is" -59.2\n' >"$work/in/bad-spots.txt"
if is_wanted spots; then
  # Without a display the program reads the file, then fails for want of a window.
  for side in old new; do
    program=$new_vpe
    [ "$side" = new ] || program=$old_vpe
    for file in spots bad-spots; do
      (
        unset DISPLAY WAYLAND_DISPLAY
        run "$side" "$program" "$file" explore "$planets/embedded.vpe" --spots "$in/$file.txt"
      )
    done
    grep -q "spots.txt:1" "$work/$side/bad-spots.stderr" && ! grep -q "spots.txt:" "$work/$side/spots.stderr"
    verdict=$?
    [ "$verdict" -eq 0 ] || report DIFFERS spots "the $side program: $work/$side/spots.stderr"
    [ "$verdict" -ne 0 ] || [ "$side" = old ] || report same spots "read as far as the missing window"
  done
fi
expected=1 check bad-flight -- fly "$in/places.csv" "$planets/embedded.vpe" -q -o frames
expected=2 check bad-option -- render --no-such-option
expected=2 check bad-setting -- render "$planets/embedded.vpe" "${near[@]}" --set no.such=1 -o image.png

# Checks that the new program takes every option of the old one. A file of options with an unknown name is
# refused, whatever the command.
if is_wanted options; then
  for command in $("$old_vpe" --help | awk '/^Subcommands:/ { on = 1; next } on && /^  [a-z]/ { print $1 }'); do
    names=$("$old_vpe" "$command" --help | sed -nE 's/^  (-[a-zA-Z],)?--([a-z0-9-]+).*/\2/p' |
      grep -vxE 'help|config|version')
    [ -n "$names" ] || continue
    {
      echo "[$command]"
      for option in $names; do echo "$option = '1'"; done
    } >"$work/in/options-$command.toml"
    other=query
    [ "$command" != query ] || other=info
    places=()
    [ "$other" = info ] || places+=(10,20)
    check "options-$command" -- "$other" "$planets/embedded.vpe" "${places[@]}" \
      --config "$in/options-$command.toml"
  done
fi

# --------------------------------------------------------------------------------------------------------------
# Kept files of old formats

while IFS= read -r file; do
  name=kept-${file#"$root"/tests/data/}
  name=${name//\//-}
  if ! run old "$old_vpe" "$name-probe" info --json "$file"; then
    report skipped "$name" "the old program does not open it"
    continue
  fi
  check "$name-info" stdout.json -- info --json "$file"
  check "$name-verify" stdout.json -- verify --json "$file"
  input=$work/in/places.csv check "$name-query" stdout.csv -- query "$file"
  check "$name-still" image.png range.tif -- render "$file" "${orbit[@]}" --backend voxel --range range.tif \
    -o image.png
done < <(find "$root/tests/data" -name '*.vpe' 2>/dev/null | sort)
while IFS= read -r file; do
  name=kept-$(basename "$file")
  check "$name" frames log.flight -- fly "$file" "$planets/$whole.vpe" --frames 0-0 --size 160x100 \
    --backend voxel -q -o frames --log log.flight
done < <(find "$root/scripts/flights" "$root/tests/data" -name '*.flight' 2>/dev/null | sort)

# --------------------------------------------------------------------------------------------------------------

equal=$((same + renamed))
echo "$equal the same ($renamed of them renamed), $different different, $skipped skipped, in $SECONDS s"
if [ "$own_work" = yes ] && [ "$different" -eq 0 ]; then
  rm -rf "$work"
else
  echo "Everything is in $work"
fi
[ "$different" -eq 0 ]
