#!/bin/sh
# Makes the drape's base mesh frame by frame, and renders it with the ball unlit and lit: four frames for docs/drape.jpg,
# and with VIDEO=1 all 48 of them as videos. Usage: scenes/drape/make.sh [OUT], SPP and SIZE from the environment.
set -eu
root=$(cd "$(dirname "$0")/../.." && pwd)
out=${1:-$root/out/drape}
size=${SIZE:-400x400}
spp=${SPP:-64}
mkdir -p "$out"
"$root/build/drape" "$root/scenes/drape/cloth"

render() { # NAME FRAMES ARGS...
  name=$1 frames=$2
  shift 2
  "$root/build/wale" render "$root/scenes/drape/drape.json" -o "$out/${name}_##.png" --frames "$frames" --spp "$spp" \
    --size "$size" "$@"
}
if [ "${VIDEO:-0}" = 1 ]; then
  render unlit 0..47 --set lights.ball.intensity=0 --video "$out/unlit.mp4"
  render lit 0..47 --set lights.key.intensity=0 --video "$out/lit.mp4"
fi
pictures=
for name in unlit lit; do
  [ $name = unlit ] && other=ball || other=key
  for frame in 11 17 25 47; do
    render $name $frame --set lights.$other.intensity=0
    pictures="$pictures $out/${name}_$frame.png"
  done
done
# shellcheck disable=SC2086
oiiotool $pictures --mosaic 4x2 -o "$out/drape.png"
