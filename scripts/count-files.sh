#!/usr/bin/env bash
# Counts the files that a commit touches, by role: what does it take to add a laboratory test, a joint law, a material?
#
#   scripts/count-files.sh COMMIT          one commit
#   scripts/count-files.sh FROM..TO        the difference of two commits
#   scripts/count-files.sh --row NAME ...  the same as a row of the table in CONTRIBUTING.md
set -euo pipefail
cd "$(git -C "$(dirname "${BASH_SOURCE[0]}")" rev-parse --show-toplevel)"

row=""
if [[ "${1:-}" == --row ]]; then
  [[ $# -eq 3 ]] || { echo "usage: count-files.sh [--row NAME] COMMIT|FROM..TO" >&2; exit 2; }
  row=$2
  shift 2
fi
[[ $# -eq 1 ]] || { echo "usage: count-files.sh [--row NAME] COMMIT|FROM..TO" >&2; exit 2; }
range=$1
[[ "$range" == *..* ]] || range="$range^..$range"

# The role of a file: a source that is new, a source that was there, the build, pages and inputs, tests.
role()
{
  local status=$1 file=$2
  case "$file" in
    tests/*) echo tests ;;
    *CMakeLists.txt | cmake/*) echo build ;;
    *.md | examples/* | docs/*) echo docs ;;
    app/* | base/* | calibration/* | coupling/* | dem/* | fem/* | include/* | interfaces/* | laboratory/* | library/* | python/* | \
      report/* | results/* | runs/*)
      [[ "$status" == A ]] && echo new || echo changed ;;
    *) echo other ;;
  esac
}

declare -A count=([new]=0 [changed]=0 [build]=0 [docs]=0 [tests]=0 [other]=0)
declare -A list
while IFS=$'\t' read -r status file; do
  of=$(role "$status" "$file")
  count[$of]=$((count[$of] + 1))
  list[$of]+="  $status $file"$'\n'
done < <(git diff --no-renames --name-status "$range")

if [[ -n "$row" ]]; then
  echo "| $row | ${count[new]} | ${count[changed]} | ${count[build]} | ${count[docs]} | ${count[tests]} |"
  exit
fi
for of in new changed build docs tests other; do
  case $of in
    new) echo "new sources: ${count[$of]}" ;;
    changed) echo "changed sources: ${count[$of]}" ;;
    *) echo "$of: ${count[$of]}" ;;
  esac
  printf '%s' "${list[$of]:-}"
done
