#!/usr/bin/env bash
# The four contact models on specimens of the same radii, and one page of them.
#
#   examples/contact-models/four-models.sh [FELDSPAR [FOLDER]]
#
# FELDSPAR is the program (default: feldspar), FOLDER where the results go (default: four-models). A model whose folder is
# there is resumed where it stands, or left as it is when it is done; the page is FOLDER/page/report.html.
set -euo pipefail
inputs=$(cd "$(dirname "$0")" && pwd)
program=$(command -v "${1:-feldspar}") || { echo "${1:-feldspar} is not there: name the program" >&2; exit 2; }
folder=${2:-four-models}
models=(flat-joint parallel-bond clumped grain-based)
mkdir -p "$folder"
for model in "${models[@]}"; do
  if [[ -e $folder/$model/run.json ]]; then
    "$program" lab --resume "$folder/$model"
  else
    "$program" lab "$inputs/$model.prm" --output "$folder/$model"
  fi
done
"$program" report "${models[@]/#/$folder/}" --output "$folder/page" --force
