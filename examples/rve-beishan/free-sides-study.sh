#!/usr/bin/env bash
# The effect of free sides on the compressive strength: cells, and boxes of the same size with free sides between smooth
# platens, compressed by explicit dynamics, in the plane and in space. Writes results/free-sides-DIMENSIONd-EDGE-mm-cell.json
# and …-box.json from the summary of each run.
#
#   examples/rve-beishan/free-sides-study.sh FELDSPAR
set -euo pipefail
feldspar=$(realpath "$1")
cd "$(dirname "${BASH_SOURCE[0]}")"
../../scripts/provenance.sh "$feldspar"
work=$(mktemp --directory)
trap 'rm --recursive "$work"' EXIT

# Dimension, edge [mm], seeds and how far the cell is pressed.
study() {
  local dimension=$1 edge=$2 seeds=$3 size=$4
  local gap=0.0457 direction="free, -1, free" porosity=""
  if ((dimension == 3)); then
    gap=0.05 direction="free, free, -1, free, free, free"
    porosity="set Porosity = 0.385" # of the box: its walls leave voids
  fi
  # A shape, and what else is said of the specimen.
  rock() {
    cat <<END
subsection Specimen
  set Dimension = $dimension
  set Shape = $1
  set Width = $edge mm
  set Height = $edge mm
  set Packing relaxation = dynamics
  ${2-}
end
subsection Flat joint
  set Installation gap ratio = $gap
end
subsection Seeds
  set Seeds = $seeds
end
END
  }
  {
    rock periodic
    cat <<END
subsection Strain path
  set Direction = $direction
  set Size = $size
  set Largest step = 2e-5
  set Solver = explicit
  set Steps per millistrain = 20000
end
END
  } >"$work/cell.prm"
  # The laboratory's rate, at which as many waves cross the body up to its peak.
  {
    rock box "$porosity"
    cat <<END
subsection Tests
  set List = uniaxial_compression
  set Compression strain rate = $(awk "BEGIN { print 100 / $edge }") 1/s
  set Stop strain over peak strain = 1.2
end
END
  } >"$work/box.prm"
  local name=results/free-sides-${dimension}d-$edge-mm
  "$feldspar" rve "$work/cell.prm" --output "$work/cell" --force --quiet >"$work/log" || cat "$work/log"
  "$feldspar" lab "$work/box.prm" --output "$work/box" --force --quiet >"$work/log" || cat "$work/log"
  for body in cell box; do
    ../../scripts/keep-results.py "$work/$body/summary.json" --to "$name-$body.json"
  done
}

study 2 16 1..5 0.0065
study 2 32.5 1..5 0.0055
study 3 13.3 1..3 0.008
study 3 20 1..3 0.007
