#!/bin/sh
# Measures how time and memory grow with the number of segments, Embree beside: bench/growth.sh BUILD_DIR OUT.csv.
# Needs 8 GB of memory and a quarter of an hour on two cores.
set -e
programs=$1/bench
out=$2
rm -f "$out"
for segments in 1e5 1e6 5e6 2e7; do
  case $segments in
    2e7) repetitions=3 updates=1 ;;
    5e6) repetitions=5 updates=3 ;;
    *) repetitions=5 updates=5 ;;
  esac
  "$programs/embree_peer" $segments 1024 $repetitions "$out"
  "$programs/embree_updates" $segments $updates "$out"
  "$programs/procedural_bench" $segments 256 1 1 "$out"
done
"$programs/procedural_bench" 5e7 256 1 0 "$out"
