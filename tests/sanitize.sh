#!/usr/bin/env bash
# The tests of geom, host and the readers under the address and undefined-behaviour sanitizers, then small renders on
# PoCL; ends with a count as ./wale test prints it.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build="${WALE_SANITIZE_BUILD:-$root/build-sanitize}"
[[ -f "$build/build.ninja" ]] ||
  cmake -S "$root" -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=RelWithDebInfo -DWALE_SANITIZE=ON >/dev/null
cmake --build "$build" --target wale tests_geom tests_host tests_fuzz >"$build/build.log" 2>&1 ||
  { cat "$build/build.log"; exit 1; }
export LSAN_OPTIONS="suppressions=$root/tests/leaks.supp:print_suppressions=0"
export UBSAN_OPTIONS=print_stacktrace=1
passed=0 failed=0

# $1: name; the rest: a command that says how many tests passed, or counts as one
count() {
  local name=$1 log="$build/$1.txt" ok=0 bad=0
  shift
  if "$@" >"$log" 2>&1; then ok=1; else bad=1; fi
  local counted; counted=$(awk '/^\[  PASSED  \]/ {print $4}' "$log" | tail -n 1)
  if ((bad)); then
    bad=$(awk '/^\[  FAILED  \] [0-9]+ test/ {print $4}' "$log" | tail -n 1)
    bad=${bad:-1}
    grep -E -A 12 'ERROR: |runtime error|FAILED' "$log" | head -n 60 || true
  fi
  ok=${counted:-$ok}
  printf 'sanitized %s: %s passed, %s failed\n' "$name" "$ok" "$bad"
  passed=$((passed + ok)) failed=$((failed + bad))
}

for program in tests_geom tests_host tests_fuzz; do count "$program" "$build/tests/$program"; done
for scene in pillow swatch_fibres; do
  count "render_$scene" "$build/wale" render "$root/scenes/$scene.json" --size 24x24 --spp 2 --quiet \
    --set "fabrics.0.gauge.wales=12" -o "$build/$scene.exr"
done
echo "$passed passed, $failed failed, 0 skipped"
((failed == 0))
