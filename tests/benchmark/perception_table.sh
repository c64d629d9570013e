#!/usr/bin/env bash
# Accuracy of perception by part, tube count and noise, on generated piles (and the public ones where they are).
#   tests/benchmark/perception_table.sh [OUT] [FIRST_SEED] [LAST_SEED]
# Piles are made once in PILES (default OUT/piles, PART/COUNT/SEED.json), rows once per pile and set-up, so it can be
# stopped and started again at any time. COUNTS, PARTS and SETUPS narrow the work; BIN is the bin of the piles.
#   SETUPS: above (one view from 1.1 m), above3 (three times its noise), cell, cell3 (eight views), handeye (cell's error)
set -euo pipefail
here=$(cd "$(dirname "$0")/../.." && pwd)
out=${1:-out/perception}
first=${2:-1}
last=${3:-30}
piles=${PILES:-$out/piles}
tubetwin="$here/build/bin/tubetwin"
table="$here/build/bin/perception_table"
[ -x "$tubetwin" ] && [ -x "$table" ] || { echo "build first: ./dev build" >&2; exit 69; }
mkdir -p "$out"

make_pile() {
  local file="$piles/$1/$2/$3.json"
  [ -f "$file" ] && return 0
  mkdir -p "$(dirname "$file")"
  "$tubetwin" pile generate --part "$1" --count "$2" --seed "$3" --threads 1 --quiet --out "$file" \
    ${BIN:+--bin "$BIN"} || echo "no pile: $1 $2 $3" >&2
}
export -f make_pile
export piles tubetwin

chosen=()
for part in ${PARTS:-pvc_a hose_b leao2022}; do
  for count in ${COUNTS:-1 3 5 7 10 15 20}; do
    for seed in $(seq "$first" "$last"); do chosen+=("$part" "$count" "$seed"); done
  done
done
printf '%s\0' "${chosen[@]}" | xargs -0 -n 3 -P "${JOBS:-2}" bash -c 'make_pile "$@"' _

files=()
for ((i = 0; i < ${#chosen[@]}; i += 3)); do
  file="$piles/${chosen[i]}/${chosen[i + 1]}/${chosen[i + 2]}.json"
  [ -f "$file" ] && files+=("$file")
done
public=()
for file in "$here"/../shared/data/leao2022/*.csv; do [ -f "$file" ] && public+=("$file"); done

for setup in ${SETUPS:-above above3 cell cell3 handeye}; do
  case $setup in
    above) options=(--setup overhead) ;;
    above3) options=(--setup overhead --noise 3) ;;
    cell) options=(--setup cell) ;;
    cell3) options=(--setup cell --noise 3) ;;
    handeye) options=(--setup cell --hand-eye) ;;
    *) echo "SETUPS: $setup is none of above above3 cell cell3 handeye" >&2; exit 64 ;;
  esac
  "$table" "${options[@]}" --rows "$out/$setup.jsonl" "${files[@]}"
  [ "$setup" = above ] && [ ${#public[@]} -gt 0 ] &&
    "$table" "${options[@]}" --rows "$out/public.jsonl" "${public[@]}"
done
for rows in "$out"/*.jsonl; do
  echo
  echo "$(basename "$rows" .jsonl):"
  python3 "$here/tests/benchmark/perception_table.py" "$rows"
done
