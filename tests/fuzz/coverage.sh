#!/usr/bin/env bash
# Lines of each reader's own files that a corpus reaches, and those that it does not: of the seeds, or of the inputs
# that tests/fuzz/search.sh keeps in BUILD/corpus.
# usage: tests/fuzz/coverage.sh [FOLDER with a corpus for each reader, tests/fuzz/corpus] [READER ...]
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
build="${WALE_COVERAGE_BUILD:-$root/build-coverage}"
corpora=$(realpath "${1:-$root/tests/fuzz/corpus}")
shift || true
readers=("$@")
((${#readers[@]})) || mapfile -t readers < <(ls "$root/tests/fuzz/corpus")
for tool in clang++ llvm-profdata llvm-cov; do
  command -v $tool >/dev/null || { echo "coverage: $tool is not installed (apt-get install clang llvm)" && exit 1; }
done
if [[ ! -f "$build/build.ninja" ]]; then
  cmake -S "$root" -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=None -DWALE_FUZZ=ON -DCMAKE_CXX_COMPILER=clang++ \
    "-DCMAKE_CXX_FLAGS=-O1 -fprofile-instr-generate -fcoverage-mapping" >/dev/null
fi
cmake --build "$build" --target fuzz_readers >"$build/build.log" 2>&1 || { cat "$build/build.log"; exit 1; }

program="$build/tests/fuzz_readers"
for reader in "${readers[@]}"; do
  profile="$build/$reader.prof"
  LLVM_PROFILE_FILE="$profile.raw" WALE_FUZZ_TARGET=$reader "$program" -runs=0 -max_len=65536 \
    "$corpora/$reader" "$root/tests/fuzz/corpus/$reader" >"$build/$reader.txt" 2>&1 || { cat "$build/$reader.txt"; exit 1; }
  llvm-profdata merge -sparse "$profile.raw" -o "$profile"
  llvm-cov export -format=lcov "$program" -instr-profile="$profile" >"$profile.lcov"
  # The reader's own files stand behind its name in the list of targets.
  sources=$(tr '\n' ' ' <"$root/tests/fuzz/targets.cpp" | grep -oP "\{\"$reader\",\s*\"[^\"]*\",\s*\"\K[^\"]*")
  for source in $sources; do
    awk -F '[:,]' -v source="$source" -v name="$reader: $source" '
      NR == FNR { text[FNR] = $0; next }
      $1 == "SF" { own = substr($0, length($0) - length(source)) == "/" source }
      own && $1 == "DA" { ++lines; if ($3 == 0) { ++missed; list = list "\n  " $2 ": " text[$2] } }
      END { printf "%s: %d of %d lines, %.1f %%%s\n", name, lines - missed, lines, 100 - 100 * missed / lines, list }' \
      "$root/$source" "$profile.lcov"
  done
done
