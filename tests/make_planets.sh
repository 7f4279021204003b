#!/usr/bin/env bash
# Makes the planet files that the long tests draw, and prints the variables that name them, for `eval`.
#   tests/make_planets.sh [PROGRAM [FOLDER]]
# PROGRAM: build/release/vpe when left out. FOLDER: build/planets; files that are there are kept. Gale is left out where
# there is no planetary data beside the checkout or in $VPE_SHARED_DATA.
set -euo pipefail
cd "$(dirname "$0")/.."
vpe=$(realpath "${1:-build/release/vpe}")
folder=${2:-build/planets}
data=${VPE_SHARED_DATA:-../shared/data}
mkdir -p "$folder"
folder=$(realpath "$folder")

# make NAME ARGUMENTS...: one planet file; the program continues a build that was stopped.
make() {
  local file=$folder/$1.vpe
  shift
  [ -e "$file" ] || "$vpe" build --quiet "$@" -o "$file" >&2
}

make embedded embedded --image embedded
# The route of LongFlight: more tiles than its memory holds.
make large embedded --region -135,-15,-20,12 --spacing 500
echo "export VPE_EMBEDDED_PLANET=$folder/embedded.vpe VPE_LARGE_PLANET=$folder/large.vpe"
if [ -e "$data/gale-ctx20/gale_ctx20_mosaic.tif" ]; then
  make gale "$data"/mola8/mola8_topo.lbl "$data"/gale-mola128/gale_megt128.lbl "$data"/gale-ctx20/gale_ctx20_mosaic.tif \
    "$data"/gale-hirise5/gale_hirise5_dtm.tif "$data"/gale-hirise1/missionDEM.tif --datum areoid --align edges \
    --reject-outliers --image "$data"/mdim21/mdim21_2880.vrt --image "$data"/gale-hrsc/gale_texture.vrt \
    --image "$data"/gale-hirise5/irb.vrt --image "$data"/gale-hirise1/gale_hirise_ortho_050cm.tif
  echo "export VPE_GALE_PLANET=$folder/gale.vpe"
else
  echo "no planetary data in $data: tests over Gale will be skipped (tools/fetch_test_data.sh)" >&2
fi
