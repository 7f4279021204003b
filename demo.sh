#!/usr/bin/env bash
# Installs missing packages, builds vpe, and draws images and a film of the embedded Mars into out/.
set -euo pipefail
cd "$(dirname "$0")"
.ci/install.sh
cmake --preset release >/dev/null
cmake --build build/release --target vpe -- -j"${JOBS:-$(nproc)}"
vpe=build/release/vpe
mkdir -p out

$vpe info
still() { $vpe render --quiet --set samples=4 "$@"; }
still -o out/globe.png   --pose=-75,0,5500000,0,-90,0 --size 1280x1280 --fov 50 --set sun.azimuth=60 --set sun.elevation=50
still -o out/olympus.png --pose=-133.8,10.5,200000,0,-30,0 --set sun.azimuth=280 --set sun.elevation=22
still -o out/valles.png  --pose=-56.5,-14.2,70000,283,-17,0 --set sun.elevation=25
still -o out/noctis.png  --pose=-97,-10.5,90000,10,-28,0 --set sun.elevation=30
still -o out/hellas.png  --pose=70,-40,4500000,0,-90,0 --size 1280x960 --fov 50 --set mode=coloured
still -o out/gale.png    --pose=137.4,-7.9,60000,8,-26,0 --set sun.azimuth=290 --set sun.elevation=25
still -o out/jezero.png  --pose=76.9,18.2,22000,62,-32,0 --set sun.elevation=25
still -o out/boreum.png  --pose=0,88.5,1300000,0,-90,0 --size 1280x960 --fov 50
$vpe fly scripts/flights/valles-marineris.flight -o out/valles-marineris.mp4 --stats out/valles-marineris.csv

cat <<'TEXT'

Made in out/:
  valles-marineris.mp4   a flight from orbit down into Valles Marineris and along it
  globe.png olympus.png valles.png noctis.png hellas.png gale.png jezero.png boreum.png
  valles-marineris.csv   time and error bound of every frame

The embedded Mars is MOLA and MDIM at eight posts a degree; smaller ground is synthetic. With finer data:
  build/release/vpe build DEM --image IMAGE -o mars.vpe
  build/release/vpe fly scripts/flights/valles-marineris.flight mars.vpe -o real.mp4
  build/release/vpe query mars.vpe -59.2,-13.7
  build/release/vpe render mars.vpe --pose -59.2,-13.7,0,90,-5,0 --height 2000 -o view.png
'build/release/vpe doctor' shows what vpe uses of this machine. README.md and 'build/release/vpe --help' tell more.
TEXT
