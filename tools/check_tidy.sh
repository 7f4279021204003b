#!/usr/bin/env bash
# Checks the sources of the program with clang-tidy; every finding is an error.
#
#   tools/check_tidy.sh [--preset NAME] [--fix] [--jobs N] [PATH ...]
#
# Reads build/NAME/compile_commands.json (NAME: release when left out); configure the preset first:
#   cmake --preset release
# Without PATH: all product sources (not tests). PATH is a file or a folder; only sources that the build compiles are
# checked. The checks are those of .clang-tidy. Needs clang-tidy 14; CLANG_TIDY names another program. Takes about
# 15 s a source. Exits with 1 if there is a finding, with 2 on wrong usage.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
cd "$root"

usage() {
  sed -n '4s/^# *//p' "$root/tools/check_tidy.sh" >&2
  exit 2
}

preset=release
jobs=$(nproc)
fix=()
paths=()
while [ $# -gt 0 ]; do
  case "$1" in
    --preset) [ $# -gt 1 ] || usage; preset=$2; shift ;;
    --jobs) [ $# -gt 1 ] || usage; jobs=$2; shift ;;
    --fix) fix=(--fix); jobs=1 ;;  # two processes must not rewrite one header
    --help | -h | -*) usage ;;
    *) paths+=("${1%/}") ;;
  esac
  shift
done
[ ${#paths[@]} -gt 0 ] || paths=(mars cull lod paging scripts panorama vpe)

tidy=${CLANG_TIDY:-clang-tidy-14}
if ! command -v "$tidy" >/dev/null; then
  echo "check_tidy.sh: $tidy is not installed; on Debian 12: apt-get install clang-tidy-14" >&2
  exit 2
fi
commands=build/$preset/compile_commands.json
if [ ! -f "$commands" ]; then
  echo "check_tidy.sh: there is no $commands; run: cmake --preset $preset" >&2
  exit 2
fi

# The compiled sources below the given paths, one a line.
sources() {
  python3 - "$commands" "$root" "${paths[@]}" <<'PYTHON'
import json
import os
import sys

commands, root, *paths = sys.argv[1:]
with open(commands, encoding="utf-8") as file:
    entries = json.load(file)
wanted = set()
for entry in entries:
    name = os.path.relpath(os.path.join(entry["directory"], entry["file"]), root)
    if any(name == path or name.startswith(path + "/") for path in paths) and os.path.exists(os.path.join(root, name)):
        wanted.add(name)
print("\n".join(sorted(wanted)))
PYTHON
}
mapfile -t files < <(sources)
if [ ${#files[@]} -eq 0 ] || [ -z "${files[0]}" ]; then
  echo "check_tidy.sh: $commands has no source in ${paths[*]}" >&2
  exit 2
fi

# g++'s options that clang does not know must not be findings.
options=(-p "build/$preset" --quiet "--warnings-as-errors=*" --extra-arg=-Wno-unknown-warning-option
  --extra-arg=-Wno-unused-command-line-argument "${fix[@]}")
status=0
printf '%s\0' "${files[@]}" | xargs -0 -n 1 -P "$jobs" "$tidy" "${options[@]}" \
  2> >(grep -vE '^[0-9]+ warnings?( and [0-9]+ errors?)? generated\.$' >&2) || status=1
if [ "$status" -ne 0 ]; then
  echo "check_tidy.sh: findings in ${#files[@]} sources; see above" >&2
  exit 1
fi
echo "${#files[@]} sources checked"
