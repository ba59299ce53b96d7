#!/usr/bin/env bash
# Measures the processor time of `./bootstrap.sh build` in a clean clone of two commits. The packages must be installed.
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
    TIMEFORMAT="%U %S"
    { time CI='' ./bootstrap.sh build >"$work/log" 2>&1; } 2>"$work/times"
  ) || { tail -n 20 "$work/log" >&2 && exit 1; }
  awk -v commit="$commit" '{ printf "%s: %.0f s of processor time, %.0f of them in the system\n", commit, $1 + $2, $2 }' "$work/times"
  rm --recursive --force "$work/clone"
done
