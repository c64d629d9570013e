#!/usr/bin/env bash
# Straight tubes that lie along the bin's walls, where no finger fits beside them, with and without nudges.
#   tests/benchmark/walls.sh [OUT] [PILES]      (default: out/walls 40)
# Two tubes in each pile, one round with planner.nudges = 0 and one with 2 from each, compared in pairs. Finished rounds
# are skipped: stop it and start it again at any time. JOBS=n rounds at a time.
set -euo pipefail
here=$(cd "$(dirname "$0")/../.." && pwd)
out=${1:-out/walls}
piles=${2:-40}
program=${TUBETWIN:-$here/build/bin/tubetwin}
[ -x "$program" ] || { echo "build first: ./dev build" >&2; exit 69; }

mkdir -p "$out"
python3 "$here/tests/benchmark/walls.py" "$out/piles" "$piles"
cat > "$out/walls.toml" <<EOF
seed = 1
rounds = $piles
[keep]
failures = 0
sample = 0.0
films = false
[[variant]]
set = {pile.file = "piles", planner.nudges = [0, 2]}
EOF
"$program" campaign run "$out/walls.toml" --jobs "${JOBS:-2}" --out "$out/rounds"
"$program" campaign compare "$out/rounds" --out "$out/compare.json"
