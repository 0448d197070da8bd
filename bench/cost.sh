#!/bin/sh
# Prices of accuracy on three scenes, measured twice: bench/cost.sh WALE OUT_DIR [MINUTES [SIZE]].
# WALE is the program; each of the six runs takes MINUTES (10 unless given). Then says how alike the two rankings are.
set -e
wale=$1
out=$2
minutes=${3:-10}
size=${4:-128x128}
here=$(dirname "$0")
mkdir -p "$out"
for round in 1 2; do
  for scene in swatch_front sock backlit; do
    "$wale" cost "$here/../scenes/$scene.json" -o "$out/$scene.$round" --minutes "$minutes" --size "$size" --quiet \
      >"$out/$scene.$round.txt"
  done
done
for scene in swatch_front sock backlit; do
  python3 "$here/cost_ranking.py" "$out/$scene.1/cost.json" "$out/$scene.2/cost.json"
done
