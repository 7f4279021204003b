#!/usr/bin/env bash
# Checks that two versions of vpe make the same output.
#
#   tests/compatibility/same_output.sh [--same-names] [--only PATTERN] OLD_VPE NEW_VPE [WORKDIR]
#
# Runs the same commands with both programs, one at a time, and compares what they write byte by byte. Options and
# settings that were renamed are given to the new program twice: by their old names, which it must still take, and
# by their new ones. --same-names leaves out the latter. --only runs the cases whose name matches a shell pattern.
#
# Prints a line for each output:
#   same     NAME  BYTES/SHA256      equal; in brackets what names a version or measures a time, which is not compared
#   renamed  NAME  BYTES/SHA256      equal but for words that compare_output.py lists as renamed on purpose
#   DIFFERS  NAME  where             different, or a program failed
#   skipped  NAME  why
# Exits with 1 if anything differs. WORKDIR (a temporary folder when left out, removed unless something differs)
# keeps everything: old/CASE, new/CASE, and renamed/CASE for the new program with new names.
#
# Needs bash, Python 3, and for some cases ffmpeg and the planetary data beside the checkout (../shared/data, or
# $VPE_SHARED_DATA). Takes two to four minutes on two cores.
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
[ $# -ge 2 ] && [ $# -le 3 ] || usage
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
compare=("${PYTHON:-python3}" "$here/compare_output.py")
"${compare[0]}" -c 'import sqlite3, zlib' || exit 2

# The user's own files and variables must not count.
export XDG_CACHE_HOME=$work/cache XDG_CONFIG_HOME=$work/config XDG_STATE_HOME=$work/state XDG_DATA_HOME=$work/data
export VPE_THREADS=2 LC_ALL=C TZ=UTC
unset VPE_MEMORY
mkdir -p "$work"/{cache,config,state,data,in}

same=0 renamed=0 different=0 skipped=0
case_failed=

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

# Runs a program in $work/SIDE/NAME, with stdin from $input when that is set. What it prints is kept beside its output.
run() { # SIDE PROGRAM NAME ARGUMENT...
  local side=$1 program=$2 folder=$work/$1/$3
  shift 3
  mkdir -p "$folder"
  (cd "$folder" && exec "$program" "$@" <"${input:-/dev/null}" >"$folder.stdout" 2>"$folder.stderr")
  local status=$?
  echo "$*" >"$folder.command"
  return "$status"
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
    esac
    translated+=("$word")
    before=$word
  done
}

is_wanted() {
  # shellcheck disable=SC2053 # a pattern on purpose
  [[ $1 == $only ]]
}

# Runs a case with both programs and compares the outputs named: files and folders that it writes, or stdout.EXT for
# what it prints, compared as a file of that kind. `expected` is the exit status that both must have.
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
    report DIFFERS "$name" "the old program exits with $status: $(tail -n 1 "$work/old/$name.stderr")"
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
    report DIFFERS "$title" "the new program exits with $status: $(tail -n 1 "$work/$side/$name.stderr")"
    return
  fi
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

# Runs the new program alone, and the new program with new names, and compares its outputs with paths of the old one.
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
      [ "$new_names" = yes ] && [ "$*" != "${translated[*]}" ] || continue
      title="$name (new names)"
      arguments=("${translated[@]}")
    fi
    if ! run "$side" "$new_vpe" "$name" "${arguments[@]}"; then
      report DIFFERS "$title" "the new program fails: $(tail -n 1 "$work/$side/$name.stderr")"
      continue
    fi
    for pair in "${pairs[@]}"; do
      compare_paths "$title/${pair%%=*}" "$work/${pair#*=}" "$work/$side/$name/${pair%%=*}"
    done
  done
}

# ---------------------------------------------------------------------------------------------------------------------
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
at 2 set mode=lit $1
at 3 pose lon=-58.9 lat=-13.5 alt=9000 yaw=120 pitch=-25 roll=5
at 3 end
TEXT
}
flight >"$work/in/film.flight"
flight "lod.rule=hitchner rays.mode=plain" >"$work/in/old-names.flight"
flight "lod.metric=distance rays.mode=reference" >"$work/in/new-names.flight"
cat >"$work/in/old-names.toml" <<'TEXT'
[render]
backend = "voxel"
size = "320x200"
set = ["mode=lit", "rays.mode=multires"]
TEXT
sed 's/voxel/ray/' "$work/in/old-names.toml" >"$work/in/new-names.toml"

in=../../in
planets=../../planets

# ---------------------------------------------------------------------------------------------------------------------
# Planets: identity, all tables, and what `info` says

# Builds a planet with both programs and keeps the old one for the cases that follow.
planet() { # NAME ARGUMENT...
  local name=$1 wanted=$only
  shift
  only='*' # the planets are needed in any case
  check "planet-$name" planet.vpe -- build "$@" -q -o planet.vpe
  only=$wanted
  mkdir -p "$work/planets"
  mv "$work/old/planet-$name/planet.vpe" "$work/planets/$name.vpe" 2>/dev/null || return 1
  check "info-$name" stdout.json -- info --json "$planets/$name.vpe"
  check "verify-$name" stdout.json -- verify --json "$planets/$name.vpe"
  if [ -e "$work/new/planet-$name/planet.vpe" ]; then
    check_new "cross-$name" planet.json="new/cross-$name/reference.json" -- --version
  fi
}
TEXT_ONLY=
