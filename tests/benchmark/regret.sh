#!/usr/bin/env bash
# What our choice among covered tubes costs more than the best motion offered, by two references of 1 ms and 5 samples.
#   tests/benchmark/regret.sh [OUT] [PILES] [EXTRA regret OPTIONS...]     (default 50 piles of each part)
# One file of rows per part (PARTS, default "hose_b pvc_a"; ARRANGEMENT, default threaded) of piles without a free
# tube; seeds that it holds are skipped, so stop it and start it again at any time. THREADS=n for each question.
# Two such folders of the same piles, as with and without `--set planner.x=V`, are compared in pairs by
# regret.py OUT/*.jsonl --against OTHER.
set -euo pipefail
here=$(cd "$(dirname "$0")/../.." && pwd)
out=${1:-out/regret}
piles=${2:-50}
shift $(($# < 2 ? $# : 2))
regret=${REGRET:-$here/build/bin/regret}
[ -x "$regret" ] || { echo "build first: ./dev build" >&2; exit 69; }
mkdir -p "$out"
for part in ${PARTS:-hose_b pvc_a}; do
  "$regret" --part "$part" --arrangement "${ARRANGEMENT:-threaded}" --piles "$piles" --threads "${THREADS:-2}" \
    --rows "$out/$part-${ARRANGEMENT:-threaded}.jsonl" "$@"
done
python3 "$here/tests/benchmark/regret.py" "$out"/*.jsonl
