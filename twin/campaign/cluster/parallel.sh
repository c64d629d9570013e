#!/usr/bin/env bash
# A campaign in shards by GNU parallel, on this machine or on several by ssh:
#   twin/campaign/cluster/parallel.sh C.toml OUT SHARDS [campaign run OPTION...]
#   tubetwin campaign merge OUT --out OUT/merged
# Environment:
#   JOBS      shards at a time on each machine (default: as many as cores)
#   HOSTS     "alice,bob,4/carol": what parallel's --sshlogin takes; default this machine alone. The hosts have
#             the same program, and the same paths by a shared file system.
#   TUBETWIN  the program, when `tubetwin` is not on PATH: TUBETWIN=build/bin/tubetwin after ./dev build
# Stop it and start it again with the same words at any time: finished shards are not run again. Shards that end
# with 75 ("not finished, try again") are run again here, up to five times. One that ends with 74 (the disk of its host is
# full or broken) does not keep the others from their end. Any other failure ends it.
set -euo pipefail
(($# >= 3)) || { echo "usage: parallel.sh C.toml OUT SHARDS [OPTION...]" >&2; exit 64; }
[[ $3 =~ ^[1-9][0-9]*$ ]] || { echo "parallel.sh: SHARDS '$3' is no number from 1" >&2; exit 64; }
command -v parallel >/dev/null || { echo "parallel.sh: GNU parallel is missing (apt-get install parallel)" >&2; exit 69; }
campaign=$(realpath -- "$1") out=$(realpath -m -- "$2") shards=$3
shift 3
program=$(command -v -- "${TUBETWIN:-tubetwin}") || {
  echo "parallel.sh: there is no program ${TUBETWIN:-tubetwin}; TUBETWIN=PATH names it (build/bin/tubetwin after ./dev build)" >&2
  exit 69
}
program=$(realpath -- "$program")
mkdir -p "$out"
log=$out/parallel.log

where=()
[[ -n ${HOSTS:-} ]] && where=(--sshlogin "$HOSTS")
[[ -n ${JOBS:-} ]] && where+=(--jobs "$JOBS")

# {#} is the number that parallel calls PARALLEL_SEQ: it stays a shard's own when the list is run again.
for attempt in 1 2 3 4 5; do
  code=0
  seq "$shards" | parallel "${where[@]}" --will-cite --joblog "$log" --resume-failed --workdir "$PWD" --quote \
    env PARALLEL_SEQ='{#}' "$program" campaign run "$campaign" --shards "$shards" --jobs 1 --quiet \
    --out "$out" "$@" || code=$?
  ((code == 0)) && exit 0
  # The log keeps every run: the last line of a shard counts.
  read -r worst full unfinished < <(awk 'NR > 1 { code[$1] = $8 ? 128 + $8 : $7 }
    END { for (k in code) if (code[k] == 74) full++; else if (code[k] == 75) again++; else if (code[k]) worst = code[k]
          print worst + 0, full + 0, again + 0 }' "$log")
  ((worst == 0)) || { echo "parallel.sh: a shard ended with $worst; see $log" >&2; exit "$worst"; }
  ((unfinished)) || { echo "parallel.sh: no room on the disk for $full shards; make room and start this again" >&2; exit 74; }
  echo "parallel.sh: run $attempt: some shards are not finished" >&2
done
exit 75
