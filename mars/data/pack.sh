#!/usr/bin/env bash
# Packs the carried data of Mars anew: mola8.tif and mdim21.jpg with mdim21.vrt, and their checksums.
#   mars/data/pack.sh MOLA_LABEL MDIM_JPEG
# MOLA_LABEL: global MOLA topography, 8 posts a degree, 2880 x 1440, metres above the areoid, 0 to 360 degrees east.
# MDIM_JPEG: MDIM 2.1 colour mosaic, 2880 x 1440, -180 to 180 degrees east. Its bytes are copied.
set -euo pipefail
[ $# -eq 2 ] || { sed -n '2,5s/^# \{0,1\}//p' "$0" >&2; exit 2; }
cd "$(dirname "$0")"
crs='+proj=eqc +lat_ts=0 +lat_0=0 +R=3396190 +units=m +no_defs'
quarter=5334722.777097360 # a quarter of the sphere's great circle, metres
half=10669445.554194721
gdal_translate -q "$1" mola8.tif -of GTiff -ot Int16 -a_nodata none -a_srs "$crs +lon_0=180" \
  -a_ullr -$half $quarter $half -$quarter -co COMPRESS=DEFLATE -co ZLEVEL=9 -co PREDICTOR=2 \
  -co TILED=YES -co BLOCKXSIZE=288 -co BLOCKYSIZE=288 \
  -mo TIFFTAG_IMAGEDESCRIPTION="MOLA topography, 8 posts a degree, metres above the areoid"
rm -f mola8.tif.aux.xml
cp "$2" mdim21.jpg
gdal_translate -q mdim21.jpg mdim21.vrt -of VRT -a_srs "$crs +lon_0=0" -a_ullr -$half $quarter $half -$quarter
# Every value must be that of the original.
same() { [ "$(gdalinfo -checksum "$1" | grep Checksum=)" = "$(gdalinfo -checksum "$2" | grep Checksum=)" ]; }
same "$1" mola8.tif || { echo "mola8.tif: its values differ from those of $1" >&2; exit 1; }
sha256sum mola8.tif mdim21.jpg mdim21.vrt > SHA256SUMS
