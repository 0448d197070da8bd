#!/usr/bin/env bash
# Renders every bundled pattern from the front and lit from behind: the pictures of docs/patterns.md.
# usage: scenes/patterns/gallery.sh [NAME ...]   (needs oiiotool)
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
root=$(cd "$here/../.." && pwd)
wale="${WALE:-$root/build/wale}"
out="$root/docs/patterns"
names=("$@")
((${#names[@]})) || mapfile -t names < <(cd "$here" && ls ./*.chart | sed 's|^\./||; s|\.chart$||')
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir -p "$out"
for name in "${names[@]}"; do
  for side in front back; do
    "$wale" render "$root/scenes/gallery_$side.json" --set "fabrics.0.pattern=\"$here/$name.json\"" \
      -o "$work/a.png" --spp "${SPP:-48}" --size "${SIZE:-256x256}" --quiet
    oiiotool --nosoftwareattrib "$work/a.png" --attrib CompressionQuality 82 -o "$out/${name}_$side.jpg"
  done
done
