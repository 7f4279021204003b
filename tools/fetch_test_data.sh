#!/usr/bin/env bash
# Downloads the public planetary data that some tests need; without them these tests are skipped.
#
#   tools/fetch_test_data.sh [--substitutes] [--list | --check] [FOLDER]
#
# FOLDER is $VPE_SHARED_DATA when left out, else ../shared/data beside the checkout, where the tests look. About 45 MB
# are downloaded, 66 MB more with --substitutes. Files that are there with the right checksum are kept, so a stopped run
# continues. Every file appears under its name only when it is complete and its checksum is right.
#
#   --substitutes  also makes mola8/ as means of MOLA's 16 pixels a degree maps. The reference files were made in
#                  another way, so values differ slightly and no checksum is known.
#   --list         prints what would be done, and downloads nothing
#   --check        only checks what is there
#
# tools/test_data/manifest.tsv has the addresses, checksums, owners, and the files that cannot be had.
# Exits with 1 if a file could not be made; the others are made nevertheless. Needs curl, sha256sum, python3.
#
# NOTE: the addresses are those of 2026-11, taken from the records of the archives and repositories. They have not
# been tried from every network: archives move, and two entries name an abbreviated commit. A wrong download cannot
# pass as data, because its checksum differs. VPE_DATA_MIRROR=URL replaces https:// and the host of every address.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
here=$root/tools/test_data

usage() {
  sed -n '4s/^# *//p' "$root/tools/fetch_test_data.sh" >&2
  exit 2
}

action="make"
substitutes=no
folder=
while [ $# -gt 0 ]; do
  case "$1" in
    --list) action=list ;;
    --check) action=check ;;
    --substitutes) substitutes=yes ;;
    --help | -h | -*) usage ;;
    *) [ -z "$folder" ] || usage; folder=$1 ;;
  esac
  shift
done
folder=${folder:-${VPE_SHARED_DATA:-$root/../shared/data}}
for program in curl sha256sum python3; do
  command -v "$program" >/dev/null || { echo "fetch_test_data.sh: $program is not installed" >&2; exit 2; }
done

part=
trap '[ -z "$part" ] || rm -f "$part" "$part.in"' EXIT
trap 'exit 130' INT
trap 'exit 143' TERM

# is_right FILE SHA256: whether the file is there and is what it should be.
is_right() {
  [ -s "$1" ] || return 1
  [ "$2" != - ] || return 0
  [ "$(sha256sum "$1" | cut -d' ' -f1)" = "$2" ]
}

# download URL FILE [FIRST-LAST]: bytes of an address, several tries.
download() {
  local url=$1
  if [ -n "${VPE_DATA_MIRROR:-}" ]; then url=${VPE_DATA_MIRROR%/}/${url#https://*/}; fi
  curl --fail --location --silent --show-error --retry 4 --retry-delay 2 --connect-timeout 30 \
    --speed-limit 1000 --speed-time 60 ${3:+--range "$3"} --output "$2" -- "$url"
}

# window IN OUT: samples 5670 to 6566 of rows of 11520 samples of 16 bits.
window() {
  python3 - "$1" "$2" <<'PYTHON'
import sys
row, first, last, rows = 2 * 11520, 2 * 5670, 2 * 6567, 897
data = open(sys.argv[1], "rb").read()
if len(data) != row * rows:
    sys.exit(f"{len(data)} bytes instead of {row * rows}: the server does not send parts of files")
with open(sys.argv[2], "wb") as out:
    for n in range(rows):
        out.write(data[n * row + first:n * row + last])
PYTHON
}

# mean IN OUT: means of 2 x 2 of 2880 rows of 5760 signed samples of 16 bits, most significant byte first.
mean() {
  python3 - "$1" "$2" <<'PYTHON'
import array
import sys
width, height = 5760, 2880
data = array.array("h")
with open(sys.argv[1], "rb") as file:
    data.frombytes(file.read())
if len(data) != width * height:
    sys.exit(f"{2 * len(data)} bytes instead of {2 * width * height}")
if sys.byteorder == "little":
    data.byteswap()
with open(sys.argv[2], "wb") as out:
    for r in range(0, height, 2):
        a, b = data[r * width:(r + 1) * width], data[(r + 1) * width:(r + 2) * width]
        line = array.array("h", [(w + x + y + z + 2) // 4 for w, x, y, z in zip(a[::2], a[1::2], b[::2], b[1::2])])
        if sys.byteorder == "little":
            line.byteswap()
        out.write(line.tobytes())
PYTHON
}

# make KIND FILE SHA256 SOURCE
make_file() {
  local kind=$1 to=$folder/$2 sum=$3 source=$4
  mkdir -p "$(dirname "$to")"
  part=$to.part
  case "$kind" in
    fetch) download "$source" "$part" || return 1 ;;
    copy | label) cp -- "$here/$source" "$part" || return 1 ;;
    # Rows 243 to 1139 of 23040 bytes.
    window) { download "$source" "$part.in" 5598720-26265599 && window "$part.in" "$part"; } || return 1 ;;
    mean) { download "$source" "$part.in" && mean "$part.in" "$part"; } || return 1 ;;
    *) echo "unknown kind $kind in manifest.tsv" >&2; return 1 ;;
  esac
  rm -f "$part.in"
  if ! is_right "$part" "$sum"; then
    echo "checksum of $2 differs from $sum: the source is another file by now" >&2
    return 1
  fi
  mv -f -- "$part" "$to"
  part=
}

declare -A state=()  # of each file: right, made or failed
names=()
while IFS=$'\t' read -r kind file sum source; do
  case "$kind" in
    '' | '#'*) continue ;;
    mean | label) [ "$substitutes" = yes ] || continue ;;
  esac
  [ -n "${state[$file]:-}" ] || names+=("$file")
  case "${state[$file]:-}" in right | made) continue ;; esac
  if is_right "$folder/$file" "$sum"; then
    state[$file]=right
    continue
  fi
  case "$action" in
    list) echo "$kind $file from $source"; state[$file]=wanted; continue ;;
    check) state[$file]=failed; continue ;;
  esac
  # Reference files, whose checksums are not those of the substitutes, are kept: is_right() takes any of them.
  echo "$kind $file"
  if make_file "$kind" "$file" "$sum" "$source"; then
    state[$file]=made
  else
    [ -z "$part" ] || rm -f "$part" "$part.in"
    part=
    state[$file]=failed
  fi
done <"$here/manifest.tsv"

failed=0
for file in "${names[@]}"; do
  if [ "${state[$file]}" = failed ]; then
    echo "missing: $file" >&2
    failed=$((failed + 1))
  fi
done
[ "$action" != list ] || exit 0
echo "$((${#names[@]} - failed)) of ${#names[@]} files are in $folder"
[ "$failed" -eq 0 ]
