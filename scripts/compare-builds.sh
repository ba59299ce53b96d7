#!/usr/bin/env bash
# What a clean build of two commits takes, in processor time: the command `feldspar` alone, as ./bootstrap.sh build makes it.
#
#   scripts/compare-builds.sh OLD_COMMIT NEW_COMMIT
#
# Each is cloned anew and built without a compiler cache, one after the other; half an hour of one processor each. Compare
# within one run only, on a machine that does nothing else.
set -euo pipefail
tree=$(git -C "$(dirname "${BASH_SOURCE[0]}")" rev-parse --show-toplevel)
work=$(mktemp --directory)
trap 'rm --recursive --force "$work"' EXIT
export CCACHE_DISABLE=1
unset CMAKE_C_COMPILER_LAUNCHER CMAKE_CXX_COMPILER_LAUNCHER
for commit in "$@"; do
  git clone --quiet --shared --no-checkout "$tree" "$work/clone"
  git -C "$work/clone" checkout --quiet --detach "$commit"
  (
    cd "$work/clone"
    cmake --preset release -DBUILD_TESTING=OFF -DFELDSPAR_BENCHMARKS=OFF >"$work/log"
    TIMEFORMAT="%U %S"
    { time cmake --build --preset release --parallel "$(nproc)" --target feldspar >>"$work/log" 2>&1; } 2>"$work/times"
  ) || { tail -n 20 "$work/log" >&2 && exit 1; }
  awk -v commit="$commit" '{ printf "%s: %.0f s of processor time, %.0f of them in the system\n", commit, $1 + $2, $2 }' "$work/times"
  rm --recursive --force "$work/clone"
done
