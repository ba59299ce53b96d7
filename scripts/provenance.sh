#!/usr/bin/env bash
# Refuses a program whose results could not be traced to a commit. Scripts that write committed results ask it first.
#
#   scripts/provenance.sh PROGRAM
#
# Prints the version, such as 0.1.0+g1a2b3c4. Exit code 1, with a line that says why, for a build of a changed work tree
# (its version ends in .modified) or of no commit at all.
set -euo pipefail
program=${1:?usage: scripts/provenance.sh PROGRAM}
version=$("$program" --version)
version=${version##* }
case $version in
  *.modified) reason="is of a work tree with changes that are in no commit" ;;
  *+g*) reason= ;;
  *) reason="names no commit" ;;
esac
if [[ $reason ]]; then
  echo "$program ($version) $reason: commit, build again, and make the results with that" >&2
  exit 1
fi
echo "$version"
