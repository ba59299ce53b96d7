#!/usr/bin/env bash
# Readers of files from outside under libFuzzer and the sanitizers (clang), as many at a time as there are cores.
#
#   scripts/fuzz.sh                      an hour of a core over all readers
#   scripts/fuzz.sh SECONDS [READER...]  so much time of a core over these readers; in the continuous integration a minute
#
# Inputs that are new to the code are kept in build/fuzz/corpus/READER, from where a later call goes on. Inputs that a
# reader takes badly are left in build/fuzz/found and shown at the end as base64, for a machine that is gone afterwards;
# copied to tests/fuzz/corpus/READER they are read again by every build (fuzz_replay_tests). The random numbers begin
# with a seed that is the first digits of the commit: another one begins elsewhere, the same one in a fresh folder tries
# the same inputs again, as far as the time lets it.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

seconds=${1:-3600}
shift || true
readers=("$@")
if ((${#readers[@]} == 0)); then
  for folder in tests/fuzz/corpus/*/; do
    readers+=("$(basename "$folder")")
  done
fi
cmake --preset asan >/dev/null
cmake --build --preset asan --target fuzz_readers --parallel "$(nproc)"
seed=$((16#$(git rev-parse --verify --quiet HEAD | cut -c 1-7 || echo 1)))

memory=/dev/shm # files that are read once
[[ -w $memory ]] || memory=${TMPDIR:-/tmp}
mkdir -p build/fuzz/found
# HDF5 and MPI keep what they have made until the end.
export TMPDIR=$memory ASAN_OPTIONS=detect_leaks=0
seconds_each=$(((seconds + ${#readers[@]} - 1) / ${#readers[@]}))
fuzz()
{
  local reader=$1 log=build/fuzz/$1.log verdict="nothing found"
  mkdir -p "build/fuzz/corpus/$reader"
  rm --force "build/fuzz/$reader.failed"
  FELDSPAR_FUZZED_READER=$reader build/asan/tests/fuzz/fuzz_readers -max_total_time=$seconds_each -seed=$seed \
    -timeout=60 -rss_limit_mb=4096 -max_len=200000 -dict=tests/fuzz/extremes.dict -print_final_stats=1 -artifact_prefix="build/fuzz/found/$reader-" \
    "build/fuzz/corpus/$reader" "tests/fuzz/corpus/$reader" >"$log" 2>&1 || {
    verdict="FOUND: see $log and build/fuzz/found"
    touch "build/fuzz/$reader.failed"
  }
  local inputs
  inputs=$(sed -n 's/^stat::number_of_executed_units: *//p' "$log")
  printf '%-17s %9s inputs  %s\n' "$reader" "${inputs:-?}" "$verdict"
}
export -f fuzz
export seed seconds_each
printf '%s\0' "${readers[@]}" | xargs --null --max-args=1 --max-procs="$(nproc)" bash -c 'fuzz "$0"'

# One after the other, so that what two readers found does not mix.
bad=0
for reader in "${readers[@]}"; do
  [[ -e build/fuzz/$reader.failed ]] || continue
  bad=1
  tail --lines=40 "build/fuzz/$reader.log"
  sed -n 's/.*Test unit written to //p' "build/fuzz/$reader.log" | while read -r found; do
    printf '%s:\n' "$found"
    base64 "$found"
  done
done
((!bad)) || echo "seed $seed, of the commit"
exit $bad
