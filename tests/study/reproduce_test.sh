#!/usr/bin/env bash
# `reproduce leao2020` with two rounds of each kind. usage: reproduce_test.sh PROGRAM
set -euo pipefail
program=$1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
Fail() { echo "FAILED: $*" >&2; exit 1; }

"$program" reproduce leao2020 --rounds 2 --quiet --out "$work/out" >"$work/printed.md"
cmp "$work/printed.md" "$work/out/tables.md" || Fail "what is printed is not tables.md"
for table in 3 4 5 6 7 8 9; do
  grep -q "^## Table $table\." "$work/out/tables.md" || Fail "no table $table"
done
[[ $(wc -l <"$work/out/rounds.jsonl") == 8 ]] || Fail "not 8 rounds"
# Again: nothing is run, the same tables.
"$program" reproduce leao2020 --rounds 2 --quiet --out "$work/out" >"$work/again.md"
cmp "$work/printed.md" "$work/again.md" || Fail "the second call gave other tables"
code=0
"$program" reproduce leao2020 --rounds 3 --quiet --out "$work/out" 2>"$work/error" || code=$?
[[ $code == 73 ]] || Fail "another number of rounds in the same folder: exit $code, not 73"
cmp "$work/printed.md" "$work/out/tables.md" || Fail "a refused call changed the tables"
code=0
"$program" reproduce leao2019 --out "$work/x" 2>"$work/error" || code=$?
[[ $code == 64 ]] || Fail "an unknown paper: exit $code, not 64"
