#!/usr/bin/env bash
# Makes the documentation site from the pages of the tree, and prints the path of its first page. A link that leads nowhere
# is an error.
#
#   scripts/build-site.sh [FOLDER [FELDSPAR]]     default: build/site, build/release/app/feldspar
#
# The site shows the report of examples/first-run, which the program FELDSPAR makes in seconds.
# Needs the Debian packages python3-sphinx, python3-myst-parser, furo and libjs-katex.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
site=${1:-$root/build/site}
feldspar=${2:-$root/build/release/app/feldspar}
pages=$(mktemp -d)
trap 'rm -rf "$pages"' EXIT
cd "$root"
find README.md CONTRIBUTING.md CHANGELOG.md docs examples benchmarks \
  \( -name '*.md' -o -path '*/figures/*' -o -path '*/results/*.png' -o -path '*/results/*.svg' \) -type f \
  -not -path 'docs/site/*' -exec cp --parents -t "$pages" {} +
cp docs/site/conf.py "$pages"
sed 's|](../../|](|' docs/site/index.md >"$pages/index.md" # the first page stands at the root of the site
mkdir -p "$site"
"$feldspar" lab examples/first-run/granite.prm --output "$pages/run" --quiet >/dev/null
mkdir "$pages/beside" && cp "$pages/run/report.html" "$pages/beside"
# Sphinx is a package of the distribution, for its own Python.
/usr/bin/python3 -m sphinx -q -W --keep-going -b html "$pages" "$site"
echo "$site/index.html"
