#!/bin/bash
# Builds a benchmark with former sources of some folders or files, and today's of all else, so that bench_ratio.sh can compare
# it with today's build:
#   tests/bench/former_bench.sh COMMIT BENCH OUT PATH...
#   tests/bench/former_bench.sh 63bef1ef cast_bench /tmp/cast_bench vpe/voxel/cast vpe/voxel/columns vpe/voxel/smooth vpe/voxel/volume
# BENCH is a target of one source, built before in $BUILD (default: build/release, by Ninja). PATHs are as git names them; headers of
# the former folders are found before today's. It fails where former sources do not fit the rest of the tree.
set -euo pipefail
[[ $# -ge 4 ]] || {
  sed -n '4s/^# *//p' "$0" >&2
  exit 2
}
commit=$1 bench=$2 out=$(realpath -m "$3")
shift 3
root=$(realpath "$(dirname "$0")/../..")
build=$(realpath "${BUILD:-$root/build/release}")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
git -C "$root" archive "$commit" "$@" | tar -x -C "$work"

field() { # of the build statement that begins with $1: the value of $2
  awk -v begin="$1" -v name="$2" 'index($0, begin) == 1 { found = 1 }
    found && $1 == name { sub(/^[^=]*= */, ""); print; exit }
    found && /^$/ { exit }' "$build/build.ninja"
}
object="build tests/bench/CMakeFiles/$bench.dir/"
source=$(awk -v begin="$object" 'index($0, begin) == 1 { print $4; exit }' "$build/build.ninja")
libraries=$(field "build tests/bench/$bench: " LINK_LIBRARIES)
[[ -n $source && -n $libraries ]] || { echo "former_bench.sh: $build has no $bench" >&2; exit 1; }
read -ra flags <<<"$(field "$object" FLAGS | sed 's/-Werror//; s/-Winvalid-pch.*//') -w"
read -ra includes <<<"$(field "$object" INCLUDES) $(pkg-config --cflags cairo 2>/dev/null || true)"
read -ra linked <<<"$libraries"
export work
{
  echo "$source"
  find "$work" -name '*.cpp'
} | xargs -P "$(nproc)" -I{} bash -c \
  'name=${1#"$work/"}; shift; "$@" -o "$work/${name//\//_}.o"' _ {} g++ "-I$work" "${includes[@]}" "${flags[@]}" -c {}
# Objects come first, so nothing is taken from today's library that they define.
cd "$build"
g++ -O3 -Wl,--allow-multiple-definition -o "$out" "$work"/*.o "${linked[@]}"
