#!/usr/bin/env bash
# Shows where the time of a laboratory test goes: a uniaxial test of Beishan granite on one thread under perf (Debian:
# linux-perf), as shares of its second tenth, still intact, and of a later one, broken.
#
#   benchmarks/profile.sh FELDSPAR
set -euo pipefail
feldspar=$(realpath "$1")
folder=$(mktemp --directory)
trap 'rm --recursive "$folder"' EXIT
cd "$folder"
: > rock.prm
"$feldspar" specimen rock.prm --output . --force --quiet > /dev/null
cat > test.prm <<END
subsection Specimen
  set Specimen file = specimen.h5
end
subsection Tests
  set List = uniaxial_compression
end
END
perf record --quiet --event cpu-clock --freq 2000 --output perf.data \
  "$feldspar" lab test.prm --output run --threads 1 --quiet > /dev/null
for part in 10%-20% 55%-65%; do
  echo "$part of the time"
  perf report --input perf.data --time "$part" --comm feldspar --stdio --no-children 2> /dev/null |
    awk '/^ +[0-9.]+%/ {
           kind = "other"
           if (/update_joint|update_segments|sweep_joints|record_grain|flat_joint/) kind = "sweep over joints"
           if (/sum_forces|sum_over_joints/) kind = "sum of forces"
           if (/move_bodies|move_one/) kind = "motion of grains"
           if (/Touches<.>::update|linear_contact|Walls<.>::press/) kind = "contacts without a face, walls"
           if (/contacts_may_be_missed|find_contacts|pairs_within|CellGrid|torn|ncidence|choose_time_step|stiffness_over_inertia|regroup|SweepMemory/)
             kind = "search for contacts, time step"
           if (/energies|joint_energy|StrainGauge|unbalanced|force_across/) kind = "rows of the curve"
           sum[kind] += $1
         }
         END { for (kind in sum) printf "  %5.1f %%  %s\n", sum[kind], kind }' | sort --reverse
done
