#!/usr/bin/env python3
"""Statistics of the rounds that rounds.sh made: python3 rounds.py OUT. Rates with 95 % intervals: those over
attempts and tubes by rounds, Wilson's of bins."""
import collections
import glob
import json
import os
import statistics
import sys

from intervals import cluster_interval, told, wilson


def rate(rounds):
    rounds = list(rounds)
    return told(sum(k for k, _ in rounds), sum(n for _, n in rounds), cluster_interval(rounds))


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
        start = sum(s["tubes_start"] for _, s, _, _, _ in done)
        attempts = [p for _, _, picks, _, _ in done for p in picks]
        good = [p for p in attempts if p["success"]]
        outcomes = collections.Counter(p["outcome"] for p in attempts)

        def of_attempts(counted, test):
            return rate((sum(map(test, filter(counted, picks))), sum(map(counted, picks))) for _, _, picks, _, _ in done)

        def of_tubes(name):
            return rate((s[name], s["tubes_start"]) for _, s, _, _, _ in done)

        def of_summaries(name):
            return rate((s[name]["k"], s[name]["n"]) for _, s, _, _, _ in done if s.get(name))

        def any_attempt(_):
            return True

        print(f"{part}: {n} rounds, {start} tubes")
        print(f"  bins emptied          {wilson(sum(s['emptied'] for _, s, _, _, _ in done), n)}")
        print(f"  tubes placed          {of_tubes('placed')}")
        print(f"  attempts with success {of_summaries('success')}")
        print(f"  in tolerance          {of_summaries('in_tolerance')}")
        print(f"  first attempt         {of_summaries('first_attempt')}")
        print(f"  of all at the start   {of_summaries('first_attempt_of_start')}")
        print(f"  attempts              {len(attempts)}: {dict(outcomes)}")
        print(f"  dropped               {of_attempts(any_attempt, lambda p: p['outcome'] == 'dropped')}")
        print(f"  outside               {of_tubes('outside')}")
        print(f"  belief not truth      "
              f"{of_attempts(any_attempt, lambda p: (p['outcome'] == 'placed') != bool(p['success']))}")
        print(f"  resolution succeeded  "
              f"{of_attempts(lambda p: p['resolution']['used'], lambda p: p['resolution']['outcome'] == 'one')}")
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
