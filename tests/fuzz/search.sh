#!/usr/bin/env bash
# Searches every reader with libFuzzer under the address and undefined-behaviour sanitizers; ends with a count as
# ./wale test prints it. Inputs that break a reader are kept in BUILD/broken.
# usage: tests/fuzz/search.sh [SECONDS for each reader, 60] [READER ...]
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
build="${WALE_FUZZ_BUILD:-$root/build-fuzz}"
seconds="${1:-60}"
shift || true
readers=("$@")
((${#readers[@]})) || mapfile -t readers < <(ls "$root/tests/fuzz/corpus")

if ! command -v clang++ >/dev/null; then
  echo "libFuzzer: clang++ is not installed (apt-get install clang)"
  echo "0 passed, 0 failed, ${#readers[@]} skipped"
  exit 0
fi
if [[ ! -f "$build/build.ninja" ]]; then
  cmake -S "$root" -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=RelWithDebInfo -DWALE_SANITIZE=ON -DWALE_FUZZ=ON \
    -DCMAKE_CXX_COMPILER=clang++ >/dev/null
fi
cmake --build "$build" --target fuzz_readers >"$build/build.log" 2>&1 || { cat "$build/build.log"; exit 1; }

passed=0 failed=0
mkdir -p "$build/broken"
for reader in "${readers[@]}"; do
  mkdir -p "$build/corpus/$reader"
  log="$build/corpus/$reader.txt"
  if LSAN_OPTIONS="suppressions=$root/tests/leaks.supp:print_suppressions=0" WALE_FUZZ_TARGET=$reader ASAN_OPTIONS=quarantine_size_mb=4:malloc_context_size=8 "$build/tests/fuzz_readers" \
    -max_total_time="$seconds" -max_len=4096 -timeout=5 -rss_limit_mb=2048 -print_final_stats=1 \
    -artifact_prefix="$build/broken/$reader-" "$build/corpus/$reader" "$root/tests/fuzz/corpus/$reader" >"$log" 2>&1; then
    passed=$((passed + 1))
  else
    failed=$((failed + 1))
    grep -E -A 12 'ERROR|runtime error|terminate|Test unit written' "$log" || tail -n 20 "$log"
  fi
  printf '%s: %s executions, %s\n' "$reader" \
    "$(awk '/number_of_executed_units/ {print $2}' "$log")" "$(grep -oE 'cov: [0-9]+ ft: [0-9]+' "$log" | tail -n 1)"
done
echo "$passed passed, $failed failed, 0 skipped"
((failed == 0))
