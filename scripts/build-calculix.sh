#!/bin/sh
# Builds a CalculiX that loads materials from shared libraries, as docs/material.md uses it:
#
#   scripts/build-calculix.sh FOLDER     makes FOLDER/ccx, in some five minutes on two cores
#
# Debian's ccx is built without CALCULIX_EXTERNAL_BEHAVIOURS_SUPPORT; this is its source with that macro. The packages
# gfortran, libarpack2-dev, libspooles-dev and liblapack-dev are needed, and a source of packages with `deb-src`.
set -eu
if [ $# -ne 1 ]; then
  echo "usage: scripts/build-calculix.sh FOLDER" >&2
  exit 2
fi
mkdir -p "$1"
cd "$1"
if [ ! -d source ]; then
  apt-get source --download-only calculix-ccx ||
    { echo "build-calculix.sh: apt-get source failed; add 'deb-src' to the sources of packages" >&2; exit 2; }
  dpkg-source --no-check -x calculix-ccx_*.dsc source
fi
sources=$(echo source/ccx_*/src)
name=$(basename "$(dirname "$sources")")
make -C "$sources" -j"$(nproc)" "$name" \
  CFLAGS='-O2 -I/usr/include/spooles -DARCH="Linux" -DSPOOLES -DARPACK -DMATRIXSTORAGE -DUSE_MT=1 -DCALCULIX_EXTERNAL_BEHAVIOURS_SUPPORT' \
  FFLAGS='-O2 -fallow-argument-mismatch' LDFLAGS=-ldl
cp "$sources/$name" ccx
echo "$PWD/ccx"
