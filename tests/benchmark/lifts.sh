#!/usr/bin/env bash
# Predictions of the evaluator against lifts of the true pile, and the choice among covered tubes.
#   tests/benchmark/lifts.sh [OUT] [FIRST_SEED] [LAST_SEED]
# One file of rows per part and arrangement (PARTS, default "hose_b pvc_a"; ARRANGEMENTS, default "threaded
# dropped"); seeds that it holds are skipped, so stop it and start it again at any time. SAMPLES=k roll-outs each.
set -euo pipefail
here=$(cd "$(dirname "$0")/../.." && pwd)
out=${1:-out/lifts}
lifts="$here/build/bin/lifts"
[ -x "$lifts" ] || { echo "build first: ./dev build" >&2; exit 69; }
mkdir -p "$out"
for part in ${PARTS:-hose_b pvc_a}; do
  for arrangement in ${ARRANGEMENTS:-threaded dropped}; do
    "$lifts" --part "$part" --arrangement "$arrangement" --seeds "${2:-1}" "${3:-100}" --samples "${SAMPLES:-5}" \
      --threads "${THREADS:-2}" --rows "$out/$part-$arrangement.jsonl"
  done
done
python3 "$here/tests/benchmark/lifts.py" "$out"/*.jsonl
