#!/usr/bin/env bash
# Runs the studies of the examples and writes their committed results.
#
#   examples/update-results.sh FELDSPAR [EXAMPLE/NAME ...]
#
# FELDSPAR is the built command; without names every study is run. Each EXAMPLE/results/NAME.json is what
# scripts/keep-results.py keeps of the summary.json of its run: figures, seeds, version and machine. Where a folder has a study.py, that writes the results that are not listed
# here. beishan-granite/results/ensemble-by-motion.json is ensemble.prm with Packing relaxation = dynamics. Inputs that say so
# had their results made before grains came to rest by descent; whoever makes them anew takes the entry out and mends the README.
# scripts/write-tables.py then writes the tables of the READMEs from there, and a test compares. A build of a changed work tree is
# refused: its results could not be made again.
set -euo pipefail
feldspar=$(realpath "$1")
shift
cd "$(dirname "${BASH_SOURCE[0]}")"
../scripts/provenance.sh "$feldspar"
studies=("$@")
((${#studies[@]})) || studies=(
  beishan-granite/{beishan,ensemble,radius-as-diameter,rate-study,platens}
  beishan-cylinder/beishan-cylinder
  contact-models/{flat-joint,parallel-bond,grain-based,clumped,clump-size}
  calibrate-{beishan,beishan-cylinder,lac-du-bonnet,sandstone}/calibrate
  flawed-granite/{flaw,closed-flaw,flaw-length}
  toughness/{toughness,large-plate,softening,softening-strength,in-plane,in-space}
  emission-beishan/{granite,spheres,windows}
  granite-minerals/{minerals,texture,scaled}
  direct-shear/{smooth-plane,intact,stiff-rock}
  rve-beishan/{tension,break-rules,explicit-tension,uniaxial,triaxial-20,triaxial-60,kinematics,kinematics-free-sides,tension-3d,uniaxial-3d,triaxial-20-3d,triaxial-60-3d}
  multiscale-beishan/{beishan,demo}
  multiscale-beishan-cylinder/{tension,cylinder,compression}
)
for study in "${studies[@]}"; do
  run=$(mktemp --directory)
  command=lab
  [[ $study == rve-* ]] && command=rve
  [[ $study == multiscale-* ]] && command=multiscale
  [[ $study == calibrate-* ]] && command=calibrate
  "$feldspar" "$command" "$study.prm" --output "$run" --force ||
    (($? == 2 || $? == 5)) # a path that ended early is a result too, and so is a verdict that is not decided
  if [[ $command == calibrate ]]; then
    # The answer becomes an input of its own; its tests are the results of that.
    here=$(dirname "$study")
    reference=$(sed -n 's/.*set Reference file *= *//p' "$study.prm")
    sed "s|Reference file = reference.json|Reference file = $reference|" "$run/best.prm" >"$here/best.prm"
    cp "$run/design.csv" "$here/results/"
    ../scripts/keep-results.py "$run/calibration.json" --to "$here/results/calibration.json"
    ../scripts/keep-results.py "$run/summary.json" --to "$here/results/best.json"
  else
    ../scripts/keep-results.py "$run/summary.json" --to "$(dirname "$study")/results/$(basename "$study").json"
  fi
  [[ $study != emission-beishan/[gs]* ]] || cp "$run/tables/emission.csv" "emission-beishan/results/${study#*/}-emission.csv"
  rm --recursive "$run"
done
