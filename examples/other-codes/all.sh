#!/usr/bin/env bash
# Runs the samples, the element and the plate in each finite-element code that is installed, in the working folder. CalculiX is
# built into calculix/ unless it is there.
set -euo pipefail
here=$(dirname "$(realpath "${BASH_SOURCE[0]}")")
for code in getfem dolfinx; do
  if python3 -c "import $code" 2>/dev/null; then
    python3 "$here/${code}_sample.py"
  else
    echo "$code is not installed"
  fi
done
if command -v run-escript >/dev/null; then
  run-escript "$here/escript_sample.py"
else
  echo "escript is not installed"
fi
[[ -x calculix/ccx ]] || "$here/../../scripts/build-calculix.sh" calculix
for example in sample element plate; do
  python3 "$here/calculix_$example.py" calculix/ccx
done
