#!/usr/bin/env bash
# Builds the programs of examples/library against an installation of its own, as somebody else would, and runs them.
#
#   tests/library/installed.sh BUILD_FOLDER
set -euo pipefail
source_dir=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
here=$(mktemp -d)
trap 'rm -rf "$here"' EXIT

cmake --install "$1" --prefix "$here/prefix" >/dev/null
cmake -S "$source_dir/examples/library" -B "$here/build" -G Ninja -DCMAKE_PREFIX_PATH="$here/prefix" >/dev/null
cmake --build "$here/build" --parallel 2

fail()
{
  printf '%s\n' "$*" >&2
  exit 1
}
if ldd "$here"/prefix/lib/libfeldspar.so | grep -q libmpi; then fail "libfeldspar.so links MPI, of which a program may have its own"; fi

# The library exports what its headers declare and nothing else: each part of a name, but for arguments, stands in them.
nm --dynamic --defined-only --demangle "$here/prefix/lib/libfeldspar.so" |
  sed -E '/ A FELDSPAR_1$/d; s/^[0-9a-f]+ . //; s/^(typeinfo|typeinfo name|vtable) for //; s/[(@[].*//' | sort -u >"$here/exported"
grep -q '^feldspar::v1::Rve::trial$' "$here/exported" && grep -qx feldspar_last_error "$here/exported" || fail "no names: $(cat "$here/exported")"
while read -r name; do
  [[ $name =~ ^feldspar(::v1::|_) ]] || fail "libfeldspar.so exports $name"
  for part in ${name//::/ }; do
    grep -qF "$part" "$here"/prefix/include/feldspar/*.h && [[ $part != *State ]] || fail "libfeldspar.so exports $name"
  done
done <"$here/exported"

# A program keeps an Eigen of its own, with flags other than the library's.
for alignment in 0 64; do
  c++ -std=c++20 -march=native -DEIGEN_MAX_ALIGN_BYTES=$alignment -I"$here/prefix/include" -isystem /usr/include/eigen3 \
    "$source_dir/tests/library/own_eigen.cc" -L"$here/prefix/lib" -Wl,-rpath,"$here/prefix/lib" -lfeldspar -o "$here/own_eigen"
  "$here/own_eigen" >"$here/stiffness_$alignment" || fail "a program with an Eigen of its own does not solve"
done
cmp "$here/stiffness_0" "$here/stiffness_64"

"$here/build/uniaxial_compression" >"$here/uniaxial.csv"
grep -Eq '^# compressive strength [0-9]+\.[0-9]+ MPa$' "$here/uniaxial.csv" || fail "no strength: $(tail -1 "$here/uniaxial.csv")"

# The first crack ends the rise; a mistake is one line.
"$here/build/one_point" >"$here/point.csv"
awk -F, '/^[0-9]/ { if ($2 + 0 > peak) peak = $2 + 0; last = $2 + 0 } /^# / { refused = $0 }
  END { exit !(peak > 5 && last < 0.5 * peak && refused ~ /not in/) }' "$here/point.csv" || fail "$(cat "$here/point.csv")"

# Elastic until the first segment breaks: the force doubles with the displacement. Later bonds break, and the force falls.
"$here/build/notched_plate" >"$here/plate.csv"
awk -F, 'NR == 2 { first = $2 }
  NR == 3 && ($3 != 0 || ($2 - 2 * first) ^ 2 > (1e-3 * first) ^ 2) { print "not elastic: " $0; bad = 1 }
  $2 + 0 > peak { peak = $2 + 0 }
  END { if (!($3 > 0 && $2 < 0.2 * peak)) { print "the plate holds: " $0; bad = 1 } exit bad }' "$here/plate.csv" ||
  fail "$(cat "$here/plate.csv")"

# The installed module finds the installed library and program.
PYTHONPATH=$(echo "$here"/prefix/lib/python3*/dist-packages) FELDSPAR_PROGRAM=$here/prefix/bin/feldspar \
  /usr/bin/python3 -m feldspar.check
