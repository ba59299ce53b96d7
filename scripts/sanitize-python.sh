#!/usr/bin/env bash
# Tests of the Python module under the address and undefined-behaviour sanitizers, which Python has to load before the module.
# Where a test runs the command, it is that of build/release, without sanitizers.
#
#   scripts/sanitize-python.sh            all tests but those of types, and of README.md, which take a long time so
#   scripts/sanitize-python.sh TEST...    some of them, as bodies_test.Tests
#
# The build takes a quarter of an hour of processor time, the tests some minutes.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

tests=("$@")
((${#tests[@]})) || tests=(bodies_test commands_test.Commands materials_test pages_test.Pages.test_{python,material})
[[ -x build/release/app/feldspar ]] || { echo "build/release/app/feldspar is missing: cmake --build --preset release" >&2; exit 1; }
cmake --preset asan -B build/asan-python -DFELDSPAR_PYTHON=ON -DFELDSPAR_FUZZ=OFF -DBUILD_TESTING=OFF -DCMAKE_UNITY_BUILD=ON \
  -DCMAKE_SHARED_LINKER_FLAGS=-shared-libasan -DCMAKE_MODULE_LINKER_FLAGS=-shared-libasan >/dev/null
cmake --build build/asan-python --parallel "$(nproc)" --target feldspar_python
export PYTHONPATH=$PWD/build/asan-python/python FELDSPAR_PROGRAM=$PWD/build/release/app/feldspar MPLBACKEND=Agg
export ASAN_OPTIONS=detect_leaks=0 # Python keeps what it allocates
cd tests/python
LD_PRELOAD=$(clang -print-file-name=libclang_rt.asan-x86_64.so) /usr/bin/python3 -c '
import os, sys, unittest
del os.environ["LD_PRELOAD"]  # for the programs that tests start
unittest.main(module=None, argv=["unittest", *sys.argv[1:]])' "${tests[@]}"
