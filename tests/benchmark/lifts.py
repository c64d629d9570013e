#!/usr/bin/env python3
"""Tables of what lifts.sh wrote: area under the ROC curve of "another tube comes along", and how often the chosen
motion takes one tube alone.   python3 lifts.py ROWS.jsonl..."""
import collections
import json
import math
import os
import random
import sys

from intervals import wilson


def auc(scored):
    """Share of pairs in which the positive has the larger score, equal ones count half."""
    positive = [s for s, hit in scored if hit]
    negative = [s for s, hit in scored if not hit]
    if not positive or not negative:
        return math.nan
    wins = sum((p > q) + 0.5 * (p == q) for p in positive for q in negative)
    return wins / (len(positive) * len(negative))


def with_interval(lifts, score, repeats=300):
    """By bootstrap over piles."""
    piles = collections.defaultdict(list)
    for row in lifts:
        piles[row["seed"]].append((score(row), row["a"]["extra"]))
    keys, rng, values = list(piles), random.Random(1), []
    for _ in range(repeats):
        value = auc([item for _ in keys for item in piles[rng.choice(keys)]])
        if not math.isnan(value):
            values.append(value)
    values.sort()
    whole = auc([item for key in keys for item in piles[key]])
    if not values:
        return "-"
    return f"{whole:.3f} [{values[int(0.025 * len(values))]:.3f}, {values[int(0.975 * len(values))]:.3f}]"


def quantile(values, share):
    values = sorted(values)
    return values[min(len(values) - 1, int(share * len(values)))] if values else math.nan


def main(paths):
    for path in paths:
        rows = [json.loads(line) for line in open(path)]
        lifts = [r for r in rows if r["kind"] == "lift" and not r["mistaken"]]
        choices = [r for r in rows if r["kind"] == "choice"]
        print(f"\n## {os.path.basename(path)[:-6]}: {len({r['seed'] for r in rows})} piles\n")
        along = sum(r["a"]["extra"] for r in lifts)
        print(f"- random lifts of covered tubes: another comes along in {wilson(along, len(lifts))}")
        probability = lambda r: r["predicted"]["extra_probability"]
        print(f"- area under the ROC curve: probability {with_interval(lifts, probability)}, "
              f"displacement {with_interval(lifts, lambda r: r['predicted']['displacement_m'])}, "
              f"both {with_interval(lifts, lambda r: probability(r) + 1e-3 * r['predicted']['displacement_m'])}, "
              f"what the choice goes by {with_interval(lifts, lambda r: r['predicted']['probability'])}, "
              f"another draw of the true lift {with_interval(lifts, lambda r: r['b']['extra'])}, "
              f"and its displacement {with_interval(lifts, lambda r: r['b']['extra'] + 1e-3 * r['b']['displacement_m'])}")
        made = [r for r in choices if r["motion"] and not r["mistaken"]]
        good = lambda r, w: not r[w]["extra"] and r[w]["status"] == "done"
        print(f"- plans {len(made)} of {len(choices)}, of mistaken tubes {sum(bool(r['motion']) and r['mistaken'] for r in choices)}")
        print(f"- the chosen motion takes one tube alone: {wilson(sum(good(r, w) for r in made for w in 'ab'), 2 * len(made))}")
        hard = [r for r in made if r["covers"] >= 2]
        print(f"- of tubes with two covers or more: {wilson(sum(good(r, w) for r in hard for w in 'ab'), 2 * len(hard))}")
        for motion in sorted({r["motion"] for r in made}):
            of = [r for r in made if r["motion"] == motion]
            print(f"  - {motion}: {wilson(sum(good(r, w) for r in of for w in 'ab'), 2 * len(of))}")
        for low, high in ((0, 0), (0.01, 0.34), (0.35, 0.67), (0.68, 1)):
            of = [r for r in lifts if low <= probability(r) <= high]
            print(f"  - predicted {low} to {high}: came along in {wilson(sum(r[w]['extra'] for r in of for w in 'ab'), 2 * len(of))}")
        times = [r["planning_s"] for r in choices]
        print(f"- planning: median {quantile(times, 0.5):.2f} s, 99th percentile {quantile(times, 0.99):.2f} s, candidates "
              f"median {quantile([r['candidates'] for r in choices], 0.5)}")


main(sys.argv[1:])
