#!/usr/bin/env bash
# Cells of five sizes, five realisations each: the tension of tension.prm event by event, and the compression of
# uniaxial.prm by explicit dynamics, which always passes its peak. Writes results/size-NN-mm.json and
# results/size-NN-mm-compression.json, the summary of each run, and results/sizes.csv, mean and scatter over the
# realisations.
#
#   examples/rve-beishan/size-study.sh FELDSPAR
set -euo pipefail
feldspar=$(realpath "$1")
cd "$(dirname "${BASH_SOURCE[0]}")"
../../scripts/provenance.sh "$feldspar"
work=$(mktemp --directory)
trap 'rm --recursive "$work"' EXIT

# Mean and standard deviation of each column, separated by commas.
mean_and_deviation() {
  awk '{ n++; for (i = 1; i <= NF; ++i) { sum[i] += $i; square[i] += $i * $i } }
    END { for (i = 1; i <= NF; ++i) { mean = sum[i] / n
      printf ",%.2f,%.2f", mean, sqrt((square[i] - n * mean^2) / (n - 1)) } }'
}

printf edge_mm,grains >results/sizes.csv
for figure in youngs_modulus_GPa tensile_strength_MPa fracture_energy_J_per_m2 compressive_strength_MPa; do
  printf ",%s,its_deviation" "$figure" >>results/sizes.csv
done
for edge in 12 16 23 32.5 46; do
  sed "s/32.5 mm/$edge mm/" tension.prm >"$work/tension.prm"
  sed -e "s/32.5 mm/$edge mm/" -e "/^subsection Variants/,/^end/d" -e "/set Largest step/a set Solver = explicit" \
    uniaxial.prm >"$work/compression.prm"
  for test in tension compression; do
    "$feldspar" rve "$work/$test.prm" --output "$work/$test-$edge" --quiet >"$work/log" || cat "$work/log"
  done
  ../../scripts/keep-results.py "$work/tension-$edge/summary.json" --to "results/size-$edge-mm.json"
  ../../scripts/keep-results.py "$work/compression-$edge/summary.json" --to "results/size-$edge-mm-compression.json"
  printf "\n%s,%s" "$edge" "$(grep -m1 '"n_grains"' "$work/tension-$edge/summary.json" | tr -dc 0-9)" >>results/sizes.csv
  # Fracture energy: work after the peak, per area of the one crack across the cell.
  for curve in "$work/tension-$edge"/curves/*.csv; do
    awk -F, -v edge="$edge" 'NR == 1 { for (i = 1; i <= NF; ++i) column[$i] = i; next }
      { strain[NR] = $column["strain_yy"]
        stress[NR] = $column["stress_yy_Pa"]
        if (stress[NR] > peak) { peak = stress[NR]; at = NR } }
      END { for (k = at + 1; k <= NR; ++k) energy += 0.5 * (stress[k] + stress[k - 1]) * (strain[k] - strain[k - 1])
        print stress[5] / strain[5] / 1e9, peak / 1e6, energy * edge * 1e-3 }' "$curve"
  done | mean_and_deviation >>results/sizes.csv
  for curve in "$work/compression-$edge"/curves/*.csv; do
    awk -F, 'NR == 1 { for (i = 1; i <= NF; ++i) column[$i] = i; next }
      -$column["stress_yy_Pa"] > peak { peak = -$column["stress_yy_Pa"] }
      END { print peak / 1e6 }' "$curve"
  done | mean_and_deviation >>results/sizes.csv
done
echo >>results/sizes.csv
