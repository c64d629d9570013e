#!/usr/bin/env bash
# Resolution strategies on the same stored moments in which several hoses hang in the fingers.
#   tests/benchmark/resolution.sh [OUT] [STRATEGY...]      (default: plus45 plus45_minus45)
# Harvests one moment of each round that comes to one (OUT/harvest/held), starts one round of every strategy from
# each and compares them in pairs. Finished rounds are skipped: stop it and start it again at any time.
# JOBS=n rounds at a time.
set -euo pipefail
here=$(cd "$(dirname "$0")/../.." && pwd)
out=${1:-out/resolution}
shift $(($# < 1 ? $# : 1))
[ $# -gt 0 ] || set -- plus45 plus45_minus45
program=${TUBETWIN:-$here/build/bin/tubetwin}
[ -x "$program" ] || { echo "build first: ./dev build" >&2; exit 69; }

mkdir -p "$out"
"$program" campaign run "$here/tests/benchmark/resolution.toml" --jobs "${JOBS:-2}" --out "$out/harvest" > "$out/harvest.txt"
states=$(find "$out/harvest/held" -name '*.json' | wc -l)
printf '"%s"\n' "$@" | paste -sd, > "$out/strategies"
cat > "$out/compare.toml" <<EOF
seed = 1
rounds = $states
[keep]
failures = 0
sample = 0.0
films = false
[[variant]]
set = {pile.file = "harvest/held", resolution.strategy = [$(cat "$out/strategies")]}
EOF
"$program" campaign run "$out/compare.toml" --jobs "${JOBS:-2}" --out "$out/compare"
"$program" campaign compare "$out/compare" --out "$out/compare.json"
