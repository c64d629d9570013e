#!/usr/bin/env bash
# install_test.sh SOURCE_DIR BUILD_DIR: what `cmake --install` leaves serves a project of its own: it finds tubetwin, builds a
# program of ten lines that perceives clouds, and the installed program made these. 77: a build with sanitizers, which the
# other project would have to use too.
set -euo pipefail
source=$1 build=$2
if grep -q fsanitize "$build/CMakeCache.txt"; then
  echo "SKIPPED: $build is built with sanitizers"
  exit 77
fi
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
Fail() { echo "FAILED: $*" >&2; exit 1; }

cmake --install "$build" --prefix "$work/prefix" >"$work/log" || Fail "install: $(tail -5 "$work/log")"
program=$work/prefix/bin/tubetwin
[[ $("$program" --version) == "tubetwin "* ]] || Fail "the installed program does not run"
"$program" pile generate --part pvc_a --count 3 --seed 1 --out "$work/pile.json"
"$program" scan "$work/pile.json" --view all --out "$work/scans"

cmake -S "$source/tests/install/consumer" -B "$work/consumer" -G Ninja -DCMAKE_BUILD_TYPE=Release \
  -DCMAKE_PREFIX_PATH="$work/prefix" >"$work/log" 2>&1 || Fail "configure: $(tail -20 "$work/log")"
cmake --build "$work/consumer" >"$work/log" 2>&1 || Fail "build: $(tail -20 "$work/log")"
found=$("$work/consumer/perceive_cloud" "$work"/scans/*.pcd)
[[ $found == "3 tubes" ]] || Fail "a pile of 3 tubes, but: $found"
