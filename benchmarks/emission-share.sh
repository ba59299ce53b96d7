#!/usr/bin/env bash
# The share of a uniaxial test that the events of acoustic emission take: samples by perf within EmissionWatch::follow() over
# those within the test, so that other load on the machine does not matter.
#
#   benchmarks/emission-share.sh FELDSPAR
set -euo pipefail
feldspar=$(realpath "$1")
work=$(mktemp --directory)
trap 'rm --recursive "$work"' EXIT
printf 'subsection Tests\n  set List = uniaxial_compression\nend\n' >"$work/one.prm"
perf record --quiet --output="$work/samples" --freq=399 --call-graph=dwarf,8192 \
  "$feldspar" lab "$work/one.prm" --output "$work/run" --quiet --threads 1 >/dev/null 2>&1
perf script --input="$work/samples" --fields=ip,sym 2>/dev/null | awk '
  BEGIN { RS = "" }
  /LabTest/ { ++test }
  /EmissionWatch.*follow/ { ++emission }
  END { printf "%.1f %% of %d samples\n", 100 * emission / test, test }'
