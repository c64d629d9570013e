#!/usr/bin/env bash
# mcap_reader_test.sh SOURCE TUBETWIN: an exported recording is read by the public Python package `mcap` and its messages are
# checked against their own schemas. 77 says that the packages cannot be had here.
set -euo pipefail
source_dir=$1 tubetwin=$2
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"

if ! { python3 -m venv venv && venv/bin/pip install --quiet --disable-pip-version-check mcap jsonschema; } >pip.log 2>&1; then
  echo "SKIPPED: the Python packages mcap and jsonschema cannot be installed, so no public reader has seen the export:"
  tail -3 pip.log
  exit 77
fi

"$tubetwin" run --record --seed 2 --threads 1 -q --set pile.count=1 --set scan.views=4 --out round
"$tubetwin" replay round/cell.rec.zst --mcap round.mcap --json -q > counts.json
venv/bin/python "$source_dir/tests/app/mcap_reader.py" round.mcap counts.json

# A few seconds alone, every point: fewer messages of the same kinds, still a whole file.
"$tubetwin" replay round/cell.rec.zst --mcap part.mcap --from 4 --to 6 --cloud-step 1 -q
venv/bin/python - <<'END'
from mcap.reader import make_reader
times = [m.log_time for _, _, m in make_reader(open("part.mcap", "rb"), validate_crcs=True).iter_messages()]
assert len(times) > 100 and min(times) >= 3.99e9 and max(times) <= 6e9, (len(times), min(times), max(times))
END
