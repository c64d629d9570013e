#!/usr/bin/env bash
# Rounds of 7 pvc_a and 7 hose_b, one seed each, and their statistics.
#   tests/benchmark/rounds.sh [OUT] [FIRST_SEED] [LAST_SEED] [EXTRA tubetwin run OPTIONS...]
# Finished rounds are skipped, so that it can be stopped and started again at any time; two rounds run at a
# time on two cores (JOBS=n for another number). The numbers come from OUT/*/summary.json and picks.jsonl.
set -euo pipefail
here=$(cd "$(dirname "$0")/../.." && pwd)
out=${1:-out/rounds}
first=${2:-1}
last=${3:-20}
shift $(($# < 3 ? $# : 3))
program="$here/build/bin/tubetwin"
[ -x "$program" ] || { echo "build first: ./dev build" >&2; exit 69; }
mkdir -p "$out"

one() {
  local part=$1 seed=$2
  shift 2
  local folder="$out/$part-$seed"
  [ -f "$folder/manifest.json" ] && return 0
  "$program" run --part "$part" --seed "$seed" --threads 1 --quiet --force --out "$folder" "$@" \
    > "$folder.log" 2>&1 || echo "$part seed $seed: exit $?" >&2
}
export -f one
export out program

for part in pvc_a hose_b; do
  for seed in $(seq "$first" "$last"); do printf '%s\0%s\0' "$part" "$seed"; done
done | xargs -0 -n 2 -P "${JOBS:-2}" bash -c 'one "$@"' _
python3 "$here/tests/benchmark/rounds.py" "$out"
