#!/usr/bin/env bash
# Installs missing packages, builds vpe, and makes images, a film, a panorama and a report of the embedded Mars in out/.
# Says before each step what it does and how long that takes on two cores, and after it how long it took.
set -euo pipefail
cd "$(dirname "$0")"
begun=$SECONDS
# step TEXT EXPECTED COMMAND ...
step() {
  local from=$SECONDS
  printf '\n== %s (about %s)\n' "$1" "$2"
  "${@:3}"
  printf '   done in %d s, %d:%02d since the start\n' $((SECONDS - from)) $(((SECONDS - begun) / 60)) $(((SECONDS - begun) % 60))
}
build() {
  cmake --preset release >/dev/null
  cmake --build build/release --target vpe vpe_coarse_mars -- -j"${JOBS:-$(nproc)}"
}
vpe=build/release/vpe
still() { $vpe render --quiet --set samples=4 -o "out/$1.png" "${@:2}"; }
globe=(--pose=-75,0,5500000,0,-90,0 --size 1280x1280 --fov 50 --set sun.azimuth=60 --set sun.elevation=50)
stills() {
  still globe "${globe[@]}"
  still olympus --pose=-133.8,10.5,200000,0,-30,0 --set sun.azimuth=280 --set sun.elevation=22
  still valles --pose=-56.5,-14.2,70000,283,-17,0 --set sun.elevation=25
  still noctis --pose=-97,-10.5,90000,10,-28,0 --set sun.elevation=30
  still hellas --pose=70,-40,4500000,0,-90,0 --size 1280x960 --fov 50 --set mode=coloured
  still gale --pose=137.4,-7.9,60000,8,-26,0 --set sun.azimuth=290 --set sun.elevation=25
  still jezero --pose=76.9,18.2,22000,62,-32,0 --set sun.elevation=25
  still boreum --pose=0,88.5,1300000,0,-90,0 --size 1280x960 --fov 50
}

mkdir -p out
step "Packages" "1 minute, where some are missing" .ci/install.sh
step "Program" "10 minutes, later a few seconds" build
step "A first still, of the few tiles that come with the program: out/first.png" "2 s" \
  still first build/release/share/coarse-mars.vpe "${globe[@]}"
step "The planet, into the cache: MOLA, MDIM and synthetic detail, 244 MB" "1 minute, once" $vpe info
step "Eight stills: out/globe.png, olympus, valles, noctis, hellas, gale, jezero, boreum" "30 s" stills
step "A panorama of Gale with names: out/gale-panorama.jpg" "5 s" \
  $vpe panorama --quiet --at 137.2,-5.75 --height 300 --elevation=-8,9 --width 3600 --sun Ls90,15:00 \
  --set overlay.names=scripts/places/mars.csv --set overlay.distances=on --set overlay.compass=on -o out/gale-panorama.jpg
step "A film into Valles Marineris: out/valles-marineris.mp4" "2 minutes" \
  $vpe fly scripts/flights/valles-marineris.flight -o out/valles-marineris.mp4 --stats out/valles-marineris.csv
step "Error against run time of both backends: out/error-time/error-time.html" "1 minute" \
  $vpe report error-time --short --quiet -o out/error-time

cat <<'TEXT'

In out/: first.png globe.png olympus.png valles.png noctis.png hellas.png gale.png jezero.png boreum.png
         gale-panorama.jpg        all around from the floor of Gale; opens in any viewer
         valles-marineris.mp4     a flight from orbit down into Valles Marineris and along it
         valles-marineris.csv     time and error bound of every frame
         error-time/              error-time.html has the plots

The embedded Mars is MOLA and MDIM at eight posts a degree; smaller ground is synthetic. In a window, and with finer data:
  build/release/vpe explore
  build/release/vpe overlook out/gale-panorama.jpg
  build/release/vpe get
  build/release/vpe build DEM --image IMAGE -o mars.vpe
  build/release/vpe query mars.vpe -59.2,-13.7
'build/release/vpe doctor' shows what vpe uses of this machine. README.md and 'build/release/vpe --help' tell more.
TEXT
