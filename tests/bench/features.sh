#!/bin/sh
# What features cost, with the program built without overlays and windows as third column, and what they do while
# they are off in instructions: docs/scaling.md has the figures.
#
#   tests/bench/features.sh DIR [PLANET]
#
# Run from the root of the sources after `cmake --preset release` and a build. Builds build/features-without,
# writes DIR/features.html and so on, DIR/programs.txt, and with valgrind DIR/instructions.txt.
set -eu
out=${1:?usage: features.sh DIR [PLANET]}
planet=${2:-}
with=build/release/vpe
without=build/features-without/vpe
mkdir -p "$out"

cmake --preset release -B build/features-without -DVPE_OVERLAYS=OFF -DVPE_WINDOW=OFF -DVPE_TESTS=OFF >/dev/null
ninja -C build/features-without vpe
$with report features -o "$out" --against "$without" $planet

# Bytes of the program itself, libraries that it is linked with, and the shortest run there is: the median of 21,
# both in turns.
milliseconds() {
  begin=$(date +%s%N)
  "$1" --version >/dev/null
  end=$(date +%s%N)
  echo $(((end - begin) / 1000))
}
: >"$out/with.txt"
: >"$out/without.txt"
for round in $(seq 21); do
  milliseconds $with >>"$out/with.txt"
  milliseconds $without >>"$out/without.txt"
done
{
  for name in with without; do
    program=$(eval echo \$$name)
    echo "$name: $(stat -L -c %s "$program") bytes, $(ldd "$program" | wc -l) libraries," \
      "starts and ends in $(sort -n "$out/$name.txt" | sed -n 11p) us"
  done
} | tee "$out/programs.txt"
rm "$out/with.txt" "$out/without.txt"

command -v valgrind >/dev/null || { echo "no valgrind: instructions are left out"; exit 0; }
# Instructions of a picture on its own thread, and of making meshes and textures ready. Valgrind knows no AVX-512,
# which llvmpipe would use.
count() {
  GALLIUM_OVERRIDE_CPU_CAPS=sse4.1 valgrind --tool=callgrind --callgrind-out-file="$out/callgrind" \
    --toggle-collect='vpe::app::ScenePainter::paint*' --toggle-collect='vpe::gl::PageLoader::load*' \
    "$1" report features --probe "$2" --backend "$3" --threads 1 --size 160x90 --frames "$4" \
    --statistics "$out/none.csv" -- "$planet" 2>&1 >/dev/null | sed -n 's/.*Collected : *\([0-9]*\).*/\1/p'
}
# Instructions in functions of a name, those that they call included, in the last count.
within() {
  callgrind_annotate --inclusive=yes --threshold=100 "$out/callgrind" 2>/dev/null |
    awk -v of="$1" '{ n = $1; gsub(",", "", n); sub(/^[^:]*:/, ""); sub(/\(.*/, "") } index($0, of) { sum += n } END { print sum + 0 }'
}
{
  for backend in ray polygon; do
    for program in $with $without; do
      few=$(count $program bare $backend 2)
      many=$(count $program bare $backend 12)
      echo "$backend, $program: $(((many - few) / 10)) instructions a bare picture of 160x90 whose tiles are there"
    done
  done
  # What each thing does, off (in the bare scene) and on.
  while IFS=, read -r backend scene of; do
    count $with bare $backend 2 >/dev/null
    off=$(within "$of")
    count $with "$scene" $backend 2 >/dev/null
    echo "$backend, $scene: $off instructions in $of off, $(within "$of") on"
  done <<END
polygon,overlays,overlay::draw
polygon,statistics,StatsWriter::row
polygon,stereo,draw_stereo
polygon,planes,Target::read_depth
polygon,occlusion culling,make_occluder_profile
polygon,light and normals of posts,TerrainShader::shade
polygon,shadows,TerrainShader::sees_sun
ray,light and normals of posts,TerrainShader::normals
ray,imagery,TerrainShader::image
ray,overlays,overlay::draw
END
} | tee "$out/instructions.txt"
rm -f "$out/callgrind" "$out/none.csv"
