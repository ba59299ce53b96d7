#!/usr/bin/env bash
# dem/ and representative volumes under clang's thread sanitizer, with a TBB that is built under it too: the sanitizer does
# not see how the packaged TBB hands work from thread to thread, and reports each hand-over as a race.
#
#   scripts/thread-sanitizer.sh                      all unit and verification tests
#   scripts/thread-sanitizer.sh CTEST_OPTION...      some of them, e.g. -L unit
#
# The source of TBB comes from Debian's archive, in the version that is installed; no root is needed. It needs the packages
# of ./bootstrap.sh packages and dpkg-dev.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

tbb=$PWD/build/tsan-tbb
if ! compgen -G "$tbb/build/*/libtbb.so" >/dev/null; then
  mkdir -p "$tbb/lists/partial" "$tbb/none"
  if [[ -f /etc/apt/sources.list.d/debian.sources ]]; then
    list=debian.sources
    sed 's/^Types: deb$/Types: deb-src/' "/etc/apt/sources.list.d/$list" >"$tbb/$list"
  else
    list=sources.list
    sed -n 's/^deb /deb-src /p' "/etc/apt/$list" >"$tbb/$list"
  fi
  apt=(apt-get --quiet -o "Dir::Etc::sourcelist=$tbb/$list" -o "Dir::Etc::sourceparts=$tbb/none"
    -o "Dir::State::lists=$tbb/lists")
  "${apt[@]}" update
  (cd "$tbb" && "${apt[@]}" source "onetbb=$(dpkg-query --show --showformat='${source:Version}' libtbb-dev)")
  cmake -S "$tbb"/onetbb-*/ -B "$tbb/build" -G Ninja -DCMAKE_BUILD_TYPE=RelWithDebInfo -DCMAKE_C_COMPILER=clang \
    -DCMAKE_CXX_COMPILER=clang++ -DTBB_SANITIZE=thread -DTBB_TEST=OFF -DTBBMALLOC_BUILD=OFF -DTBB_STRICT=OFF
  cmake --build "$tbb/build" --target tbb --parallel "$(nproc)"
fi
cmake --preset tsan -DCMAKE_UNITY_BUILD=ON
cmake --build --preset tsan --parallel "$(nproc)"
LD_LIBRARY_PATH=$(dirname "$(compgen -G "$tbb/build/*/libtbb.so")") ctest --preset tsan --parallel "$(nproc)" "$@"
