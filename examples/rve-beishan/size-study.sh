#!/usr/bin/env bash
# The tension of tension.prm in cells of five sizes, five realisations each: writes results/size-NN-mm.json, the summary of
# each run, and results/sizes.csv, mean and scatter over the realisations.
#
#   examples/rve-beishan/size-study.sh FELDSPAR
set -euo pipefail
feldspar=$(realpath "$1")
cd "$(dirname "${BASH_SOURCE[0]}")"
work=$(mktemp --directory)
trap 'rm --recursive "$work"' EXIT
echo "edge_mm,grains,youngs_modulus_GPa,its_deviation,tensile_strength_MPa,its_deviation,fracture_energy_J_per_m2,its_deviation" >results/sizes.csv
for edge in 12 16 23 32.5 46; do
  sed "s/32.5 mm/$edge mm/" tension.prm >"$work/size.prm"
  "$feldspar" rve "$work/size.prm" --output "$work/$edge" --quiet >"$work/log" || cat "$work/log"
  cp "$work/$edge/summary.json" "results/size-$edge-mm.json"
  # Fracture energy: work after the peak, per area of the one crack across the cell.
  for curve in "$work/$edge"/curves/*.csv; do
    awk -F, -v edge="$edge" 'NR == 1 { for (i = 1; i <= NF; ++i) column[$i] = i; next }
      { strain[NR] = $column["strain_yy"]
        stress[NR] = $column["stress_yy_Pa"]
        if (stress[NR] > peak) { peak = stress[NR]; at = NR } }
      END { for (k = at + 1; k <= NR; ++k) energy += 0.5 * (stress[k] + stress[k - 1]) * (strain[k] - strain[k - 1])
        print peak / 1e6, energy * edge * 1e-3, stress[5] / strain[5] / 1e9 }' "$curve"
  done | awk -v edge="$edge" -v grains="$(grep -m1 '"n_grains"' "$work/$edge/summary.json" | tr -dc 0-9)" '
    { n++; for (i = 1; i <= 3; ++i) { sum[i] += $i; square[i] += $i * $i } }
    END { for (i = 1; i <= 3; ++i) { mean[i] = sum[i] / n; spread[i] = sqrt((square[i] - n * mean[i]^2) / (n - 1)) }
      printf "%s,%s,%.2f,%.2f,%.2f,%.2f,%.2f,%.2f\n", edge, grains, mean[3], spread[3], mean[1], spread[1], mean[2], spread[2] }' >>results/sizes.csv
done
