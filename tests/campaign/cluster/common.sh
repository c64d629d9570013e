# Sourced by the tests of twin/campaign/cluster: a small campaign, its uninterrupted result, and skipping aloud.
set -euo pipefail
source_dir=$1 program=$2
export TUBETWIN=$program
work=$(mktemp -d)
readonly kSkipped=77  # tests/CMakeLists.txt says so to ctest.

Skip() { echo "SKIPPED: $*"; exit "$kSkipped"; }
Fail() { echo "FAILED: $*" >&2; exit 1; }

# Rounds of one tube: each takes about two seconds.
SmallCampaign() {
  cat >"$work/C.toml" <<'TOML'
seed = 5
rounds = 4
[[variant]]
part = "pvc_a"
count = 1
TOML
}

# Expect NAME FOLDER: the merge of its shards has the bytes of the uninterrupted run.
Expect() {
  local file
  "$program" campaign merge "$2" --out "$2/merged" --quiet >/dev/null
  [[ -d $work/whole ]] || "$program" campaign run "$work/C.toml" --out "$work/whole" --quiet >/dev/null
  for file in picks.jsonl rounds.jsonl; do
    [[ -s $work/whole/$file ]] || Fail "the uninterrupted run left no $file"
    cmp "$work/whole/$file" "$2/merged/$file" || Fail "$1: $file differs from the uninterrupted run's"
  done
  echo "$1: same bytes as the uninterrupted run"
}

# A program that ends with the codes of its arguments in turn, counting its runs in FOLDER/runs.
FakeProgram() {
  local file=$1
  shift
  cat >"$file" <<SH
#!/usr/bin/env bash
echo run >>"$file.runs"
codes=($*)
n=\$(wc -l <"$file.runs")
exit "\${codes[n - 1]:-0}"
SH
  chmod +x "$file"
}
Runs() { wc -l <"$1.runs"; }
