#!/usr/bin/env bash
# Makes the documentation site from the pages of the tree, and prints the path of its first page. A link that leads nowhere
# is an error.
#
#   scripts/build-site.sh [FOLDER]     default: build/site
#
# Needs the Debian packages python3-sphinx, python3-myst-parser, furo and libjs-katex.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
site=${1:-$root/build/site}
pages=$(mktemp -d)
trap 'rm -rf "$pages"' EXIT
cd "$root"
find README.md CONTRIBUTING.md CHANGELOG.md docs examples benchmarks \
  \( -name '*.md' -o -path '*/figures/*' -o -path '*/results/*.png' -o -path '*/results/*.svg' \) -type f \
  -not -path 'docs/site/*' -exec cp --parents -t "$pages" {} +
cp docs/site/conf.py docs/site/index.md "$pages"
mkdir -p "$site"
# Sphinx is a package of the distribution, for its own Python.
/usr/bin/python3 -m sphinx -q -W --keep-going -b html "$pages" "$site"
echo "$site/index.html"
