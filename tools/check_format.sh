#!/usr/bin/env bash
# Checks that every C++ file in the repository is formatted as .clang-format says.
#
#   tools/check_format.sh [--fix] [PATH ...]
#
# Without PATH: all tracked .h and .cpp files. --fix rewrites the files instead. Exits with 1 if a file differs, with 2
# on wrong usage. Needs clang-format 14: other versions format differently. CLANG_FORMAT names another program.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
cd "$root"

usage() {
  sed -n '4s/^# *//p' "$root/tools/check_format.sh" >&2
  exit 2
}

action=(--dry-run -Werror)
paths=()
while [ $# -gt 0 ]; do
  case "$1" in
    --fix) action=(-i) ;;
    --help | -h | -*) usage ;;
    *) paths+=("$1") ;;
  esac
  shift
done
[ ${#paths[@]} -gt 0 ] || paths=('*.h' '*.cpp')

format=${CLANG_FORMAT:-clang-format-14}
if ! command -v "$format" >/dev/null; then
  echo "check_format.sh: $format is not installed; on Debian 12: apt-get install clang-format-14" >&2
  exit 2
fi

# A tracked file may have been deleted in the working tree.
files=()
while IFS= read -r -d '' file; do
  [ -f "$file" ] && files+=("$file")
done < <(git ls-files -z -- "${paths[@]}")
if [ ${#files[@]} -eq 0 ]; then
  echo "check_format.sh: no C++ files match ${paths[*]}" >&2
  exit 2
fi

status=0
printf '%s\0' "${files[@]}" | xargs -0 -n 20 -P "$(nproc)" "$format" --style=file "${action[@]}" || status=1
if [ "$status" -ne 0 ]; then
  echo "check_format.sh: run tools/check_format.sh --fix" >&2
  exit 1
fi
echo "${#files[@]} files checked"
