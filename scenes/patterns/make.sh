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
# Loops of other lengths than 13.2 yarn diameters, where the stitch asks for them; blocking, where the cloth would gather or
# buckle; and how many starts, where 4 would take long or more find a lower state.
declare -A options=(
  [basketweave]="--loop-diameters 14 --blocking 1 --starts 2"
  [cable_4]="--blocking 1 --starts 2"
  [cable_6]="--blocking 1 --starts 1"
  [eyelet]="--loop-diameters 15 --blocking 0.4 --starts 2"
  [honeycomb]="--loop-diameters 15 --course-tension 1.6 --wale-tension 6 --starts 2"
  [mosaic]="--loop-diameters 15 --blocking 1 --starts 8"
  [moss]="--loop-diameters 15 --blocking 0.5 --starts 8"
  [seed]="--loop-diameters 15 --blocking 0.5 --starts 16"
  [stranded]="--loop-diameters 15 --blocking 1 --starts 2"
  [stockinette_relaxed]="--strains"
  [waffle]="--blocking 0.2"
)
failed=0
for name in "${names[@]}"; do
  # shellcheck disable=SC2086
  "$wale" knit "$here/$name.chart" -o "$here/$name.json" --json "$reports/$name.json" --quiet ${options[$name]:-} |
    sed -n 's/^/    /; 1p; /relaxed/p' || failed=1
done
exit "$failed"
