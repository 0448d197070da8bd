#!/usr/bin/env bash
# Relaxes the charts of this folder into the tiles beside them, and writes what each one took to FOLDER/*.json.
# usage: scenes/patterns/make.sh [FOLDER for reports, build/patterns] [NAME ...]
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
root=$(cd "$here/../.." && pwd)
wale="${WALE:-$root/build/wale}"
reports="${1:-$root/build/patterns}"
shift || true
names=("$@")
((${#names[@]})) || mapfile -t names < <(cd "$here" && ls ./*.chart | sed 's|^\./||; s|\.chart$||')
mkdir -p "$reports"
# Loops of other lengths than 13.2 yarn diameters, where the stitch asks for them.
declare -A options=([seed]="--loop-diameters 15" [moss]="--loop-diameters 15")
failed=0
for name in "${names[@]}"; do
  # shellcheck disable=SC2086
  "$wale" knit "$here/$name.chart" -o "$here/$name.json" --json "$reports/$name.json" --quiet ${options[$name]:-} |
    sed -n 's/^/    /; 1p; /relaxed/p' || failed=1
done
exit "$failed"
