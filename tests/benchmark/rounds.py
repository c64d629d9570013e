#!/usr/bin/env python3
"""Statistics of the rounds that rounds.sh made: python3 rounds.py OUT. Rates with Wilson 95 % intervals."""
import collections
import glob
import json
import os
import statistics
import sys

from intervals import wilson_interval


def rate(k, n):
    low, high = wilson_interval(k, n)
    return f"{k}/{n} = {100 * k / max(1, n):.1f} % [{100 * low:.1f}, {100 * high:.1f}]"


def main(folder):
    rounds = collections.defaultdict(list)
    for path in sorted(glob.glob(os.path.join(folder, "*", "summary.json"))):
        here = os.path.dirname(path)
        part = os.path.basename(here).rsplit("-", 1)[0]
        with open(path) as f:
            summary = json.load(f)
        picks = [json.loads(line) for line in open(os.path.join(here, "picks.jsonl"))]
        times = [json.loads(line) for line in open(os.path.join(here, "timings.jsonl"))]
        times = [t for t in times if t["attempt"] > 0]  # 0: the look after the last attempt.
        manifest = os.path.join(here, "manifest.json")
        wall = json.load(open(manifest))["wall_s"] if os.path.exists(manifest) else float("nan")
        rounds[part].append((os.path.basename(here), summary, picks, times, wall))
    for part, done in rounds.items():
        n = len(done)
        placed = sum(s["placed"] for _, s, _, _, _ in done)
        start = sum(s["tubes_start"] for _, s, _, _, _ in done)
        k = sum(s["first_attempt"]["k"] for _, s, _, _, _ in done)
        m = sum(s["first_attempt"]["n"] for _, s, _, _, _ in done)
        attempts = [p for _, _, picks, _, _ in done for p in picks]
        good = [p for p in attempts if p["success"]]
        outcomes = collections.Counter(p["outcome"] for p in attempts)
        belief = sum((p["outcome"] == "placed") != bool(p["success"]) for p in attempts)
        several = [p for p in attempts if p["resolution"]["used"]]
        solved = sum(p["resolution"]["outcome"] == "one" for p in several)
        print(f"{part}: {n} rounds, {start} tubes")
        print(f"  bins emptied          {rate(sum(s['emptied'] for _, s, _, _, _ in done), n)}")
        print(f"  tubes placed          {rate(placed, start)}")
        print(f"  first attempt         {rate(k, m)}")
        print(f"  attempts              {len(attempts)}: {dict(outcomes)}")
        print(f"  dropped               {rate(outcomes['dropped'], len(attempts))}")
        print(f"  outside               {rate(sum(s['outside'] for _, s, _, _, _ in done), start)}")
        print(f"  belief not truth      {rate(belief, len(attempts))}")
        print(f"  resolution succeeded  {rate(solved, len(several))}")
        if good:
            sims = [p["sim_s"]["total"] for p in attempts]
            walls = [t["wall_s"] for _, _, _, times, _ in done for t in times]
            compute = [t["compute_s"]["total"] for _, _, _, times, _ in done for t in times]
            print(f"  per attempt: simulated {statistics.mean(sims):.1f} s, wall {statistics.mean(walls):.1f} s, "
                  f"of which the pipeline computes {statistics.mean(compute):.2f} s")
        print(f"  wall time of a round: median {statistics.median(w for *_, w in done):.0f} s")
        ends = collections.Counter(s["end_reason"] for _, s, _, _, _ in done)
        print(f"  ends: {dict(ends)}")
        for name, s, _, _, _ in done:
            if not s["emptied"]:
                print(f"    {name}: {s['placed']}/{s['tubes_start']} {s['end_reason']}: {s['end_detail'][:140]}")


main(sys.argv[1])
