#!/usr/bin/env bash
# Runs the studies of the examples and writes their committed results.
#
#   examples/update-results.sh FELDSPAR [NAME ...]
#
# FELDSPAR is the built command; without names every study is run. Each results/NAME.json is the summary.json of its run:
# figures, seeds, commit and machine. The READMEs take their figures from there, and a test checks that they agree.
set -euo pipefail
feldspar=$(realpath "$1")
shift
cd "$(dirname "${BASH_SOURCE[0]}")"
studies=("$@")
((${#studies[@]})) || studies=(beishan ensemble radius-as-diameter rate-study beishan-cylinder)
for study in "${studies[@]}"; do
  run=$(mktemp --directory)
  input=$(ls ./*/"$study.prm")
  "$feldspar" lab "$input" --output "$run" --force
  cp "$run/summary.json" "$(dirname "$input")/results/$study.json"
  rm --recursive "$run"
done
