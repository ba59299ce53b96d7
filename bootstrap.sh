#!/usr/bin/env bash
# From a fresh Debian 12 to results.
#
#   ./bootstrap.sh demo      packages, build, three specimens of Beishan granite as grains, then as finite elements with
#                            grains inside, both in one report; ends with its path
#   ./bootstrap.sh test      packages, build by clang under the sanitizers, its unit tests and a minute of fuzzing, release
#                            build by gcc, all tests
#   ./bootstrap.sh build     packages and release build
#   ./bootstrap.sh install   the same; the command, the library and the Python module in /usr/local (another place: install DIR)
#   ./bootstrap.sh check     tries what is installed: breaks a small specimen by command and from Python
#   ./bootstrap.sh package   a Debian package for any processor with AVX2, faster on those with AVX-512; ends with its path
#   ./bootstrap.sh docs      the documentation as a site; ends with its path
#   ./bootstrap.sh packages  packages only: everything the others need
#
# Root (or sudo) is needed only while packages are missing. With CI set in the environment warnings are errors and
# `test` also checks format and lint, and has clang read what it does not build.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"

build_packages=(
  g++ cmake ninja-build git ca-certificates
  libeigen3-dev libtbb-dev libfmt-dev libhdf5-openmpi-dev libhdf5-dev
  libdeal.ii-dev petsc-dev
  libceres-dev libopenturns-dev libcli11-dev nlohmann-json3-dev libudunits2-dev libpugixml-dev libpng-dev libboost-dev libkainjow-mustache-dev
  gnuplot-nox fonts-dejavu-core
)
python_packages=(pybind11-dev python3-dev python3-numpy python3-pandas python3-matplotlib)
site_packages=(python3-sphinx python3-myst-parser furo libjs-katex)
test_packages=(
  "${site_packages[@]}"
  "${python_packages[@]}"
  clang clang-format clang-tidy python3 libgtest-dev libbenchmark-dev locales chromium slurm-wlm
  python3-vtk9 # reads fields/ as ParaView does, for a test
  mypy jupyter-nbconvert python3-ipykernel # of the Python module and its notebooks
  python3-getfem # of examples/other-codes
  r-base-core # scripts of docs/recipes.md
)

say() { printf '\n==> %s\n' "$*"; }
die()
{
  printf 'bootstrap.sh: %s\n' "$*" >&2
  exit 1
}

is_installed() { [[ "$(dpkg-query --show --showformat='${db:Status-Status}' "$1" 2>/dev/null)" == installed ]]; }

# as_root COMMAND [ARGUMENT...]
as_root()
{
  if ((EUID == 0)); then
    "$@"
  elif command -v sudo >/dev/null; then
    sudo "$@"
  else
    die "neither root nor sudo is at hand for: $*"
  fi
}

need_packages()
{
  command -v dpkg-query >/dev/null ||
    die "this is not a Debian system; the packages it would install are listed in this script"
  local missing=() package
  for package in "$@"; do
    is_installed "$package" || missing+=("$package")
  done
  ((${#missing[@]})) || return 0

  ((EUID == 0)) || command -v sudo >/dev/null ||
    die "neither root nor sudo is at hand; let root run: apt-get update && apt-get install --no-install-recommends ${missing[*]}"
  say "installing ${missing[*]}"
  as_root apt-get update --quiet
  as_root env DEBIAN_FRONTEND=noninteractive \
    apt-get install --quiet --yes --no-install-recommends "${missing[@]}" </dev/null
}

# Several files a unit: about two thirds of the processor time of a clean build, and the same bits. Who changes the code turns it
# off in build/release (CONTRIBUTING.md).
joined_units=-DCMAKE_UNITY_BUILD=ON

# configure PRESET [CMake option...]
configure()
{
  local preset=$1
  shift
  local warnings_as_errors=OFF
  [[ -z "${CI:-}" ]] || warnings_as_errors=ON
  say "building $preset"
  cmake --preset "$preset" -DFELDSPAR_WARNINGS_AS_ERRORS="$warnings_as_errors" "$@"
}

# build PRESET [CMake option...]
build()
{
  configure "$@"
  cmake --build --preset "$1" --parallel "$(nproc)"
}

run_tests()
{
  say "testing $1"
  ctest --preset "$1" --parallel "$(nproc)"
}

check_format()
{
  say "checking the format"
  git ls-files -z '*.h' '*.cc' | xargs --null clang-format --dry-run -Werror
  scripts/check-words.py
}

# Checks the lint of laboratory/ and dem/, by the units that build/asan joined, and the files that it did not join as one
# more: file by file takes six times as long, nearly all of it for headers that the files share.
check_lint()
{
  say "checking the lint"
  local joined=build/asan/lint_of_dem.cc units
  units=$(sed -En "s@^ *\"file\": \"($PWD/(build/asan/)?(laboratory|dem)/.*)\",?\$@\1@p" build/asan/compile_commands.json)
  sed -En "s@^$PWD/(laboratory|dem)/.*@#include \"&\"@p" <<<"$units" >"$joined"
  { grep -E --invert-match "^$PWD/(laboratory|dem)/" <<<"$units" && echo "$PWD/$joined"; } |
    xargs --max-args=1 --max-procs="$(nproc)" clang-tidy -p build/asan --quiet --warnings-as-errors='*' \
      --checks=-bugprone-suspicious-include
}

# Reads with clang the units that build/asan leaves out.
check_other_compiler()
{
  say "reading the rest with clang"
  cmake --preset asan-all "$joined_units" >/dev/null
  scripts/read-with-clang.py build/asan-all build/asan
}

demo()
{
  need_packages "${build_packages[@]}"
  python_module=OFF
  build_release feldspar # without the finite elements, whose headers are half of a build
  local feldspar=build/release/app/feldspar
  say "breaking three specimens of Beishan granite: a minute and a half of processor time"
  "$feldspar" lab examples/beishan-granite/demo.prm --output demo/direct --force
  say "the first page is demo/direct/report.html; the finite elements come next"
  build_release
  say "the same rock as finite elements with grains inside: seven minutes of processor time"
  "$feldspar" multiscale examples/multiscale-beishan/demo.prm --output demo/multiscale --force
  say "both in one report"
  "$feldspar" report demo/direct demo/multiscale --output demo/report --force
}

# build_release [TARGET]
python_module=ON
build_release()
{
  configure release "$joined_units" -DBUILD_TESTING=OFF -DFELDSPAR_BENCHMARKS=OFF "-DFELDSPAR_PYTHON=$python_module"
  cmake --build --preset release --parallel "$(nproc)" ${1:+--target "$1"}
}

# install_feldspar [DIR]
install_feldspar()
{
  local prefix=${1:-/usr/local} parent
  umask 022 # what is installed or packed is everybody's to read
  need_packages "${build_packages[@]}" "${python_packages[@]}"
  build_release
  say "installing into $prefix"
  parent=$prefix
  until [[ -e $parent ]]; do parent=$(dirname "$parent"); done
  if [[ -w $parent ]]; then
    cmake --install build/release --prefix "$prefix" --strip
  else
    as_root cmake --install build/release --prefix "$prefix" --strip
  fi
  say "$("$prefix/bin/feldspar" version) is in $prefix/bin"
}

# check_installation [DIR]
check_installation()
{
  local prefix=${1:-/usr/local}
  PYTHONPATH=$(echo "$prefix"/lib/python3*/dist-packages) FELDSPAR_PROGRAM=$prefix/bin/feldspar \
    /usr/bin/python3 -m feldspar.check
}

package()
{
  umask 022
  need_packages "${build_packages[@]}" "${python_packages[@]}" dpkg-dev file
  build package "$joined_units"
  build package-avx512 "$joined_units"
  say "packing"
  (cd build/package &&
    cpack -G DEB -D "CPACK_INSTALL_CMAKE_PROJECTS=$PWD;feldspar;ALL;/;$PWD/../package-avx512;feldspar;code;/")
  ls "$PWD"/build/package/*.deb
}

run_all_tests()
{
  need_packages "${build_packages[@]}" "${test_packages[@]}"
  build asan "$joined_units"
  run_tests asan
  say "fuzzing"
  scripts/fuzz.sh 60
  if [[ -n "${CI:-}" ]]; then
    check_format
    check_lint
    check_other_compiler
  fi
  build release "$joined_units" -DBUILD_TESTING=ON -DFELDSPAR_BENCHMARKS=ON -DFELDSPAR_PYTHON=ON
  run_tests release
}

case "${1:-}" in
  demo) demo ;;
  test) run_all_tests ;;
  build)
    need_packages "${build_packages[@]}" "${python_packages[@]}"
    build_release
    ;;
  docs)
    need_packages "${build_packages[@]}" "${site_packages[@]}"
    python_module=OFF
    build_release feldspar # for the report that the site shows
    scripts/build-site.sh
    ;;
  install) install_feldspar "${@:2}" ;;
  check) check_installation "${@:2}" ;;
  package) package ;;
  packages) need_packages "${build_packages[@]}" "${test_packages[@]}" ;;
  *) die "usage: ./bootstrap.sh demo|test|build|install [DIR]|check [DIR]|package|docs|packages" ;;
esac
