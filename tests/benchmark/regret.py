#!/usr/bin/env python3
"""Tables of what regret.sh wrote: share of piles with a regret of at most 2 cm, its distribution, the same for one
reference against the other, and the worst piles.
    python3 regret.py ROWS.jsonl... [--worst N] [--against FOLDER]
--against: the rows of the same piles in FOLDER, chosen otherwise; the cost of both choices by the same references."""
import argparse
import json
import math
import os
import random

from intervals import wilson

LIMIT_M = 0.02


def quantile(values, share):
    values = sorted(values)
    return values[min(len(values) - 1, int(share * len(values)))] if values else math.nan


def spread(values):
    return "median, 75, 90, 95 %, most: " + ", ".join(f"{100 * quantile(values, s):.1f}" for s in (0.5, 0.75, 0.9, 0.95, 1)) + " cm"


def read(path):
    rows = [json.loads(line) for line in open(path)]
    return [r for r in rows if not r["left_out"]], sum(r["left_out"] for r in rows)


def report(name, rows, left_out, worst):
    made = [r for r in rows if r["choice"]]
    print(f"\n## {name}: {len(rows)} piles, {left_out} left out for free tubes, {len(rows) - len(made)} without a plan\n")
    if not made:
        return
    for what, key in (("regret of our choice", "regret_m"), ("of one reference by the other", "agreement_m")):
        # The second reference knows nothing of how the first was judged: one value per pile counts, the other repeats it.
        one, two = ([r[key][k] for r in made] for k in (0, 1))
        print(f"- {what}: at most 2 cm in {wilson(sum(v <= LIMIT_M for v in one), len(one))}, with the seeds exchanged "
              f"{wilson(sum(v <= LIMIT_M for v in two), len(two))}; {spread(one + two)}")
    both = [sum(r["regret_m"]) / 2 for r in made]
    print(f"- of the mean of both references: at most 2 cm in {wilson(sum(v <= LIMIT_M for v in both), len(both))}")
    costs = [r["best"][k]["cost_m"] for r in made for k in (0, 1)]
    print(f"- cost of the best motion: {spread(costs)}")
    print(f"- motions asked about, of them runnable, compared (median): "
          + ", ".join(f"{quantile([r[k] for r in made], 0.5)}" for k in ("asked", "runnable", "compared")))
    for r in sorted(made, key=lambda r: -sum(r["regret_m"]))[:worst]:
        choice, by, best = r["choice"], r["choice_by"], r["best"]
        print(f"  - seed {r['seed']}: tube {choice['tube']} {choice['motion']}, own {100 * choice['own_m']:.1f} cm, costs "
              f"{100 * by[0]['cost_m']:.1f} and {100 * by[1]['cost_m']:.1f} cm (others along in {by[0]['extra']} and "
              f"{by[1]['extra']} of 5); best "
              + " and ".join(f"tube {b['tube']} {b['motion']}, own {100 * b['own_m']:.1f}, {100 * b['cost_m']:.1f} cm" for b in best))


def compare(name, rows, others):
    """By bootstrap over piles: how much less our choice costs than theirs."""
    theirs = {r["seed"]: r for r in others if r["choice"]}
    cost = lambda r: sum(by["cost_m"] for by in r["choice_by"]) / 2
    pairs = [(cost(r), cost(theirs[r["seed"]])) for r in rows if r["choice"] and r["seed"] in theirs]
    if not pairs:
        return
    less = [b - a for a, b in pairs]
    rng = random.Random(1)
    means = sorted(sum(rng.choice(less) for _ in less) / len(less) for _ in range(2000))
    print(f"\n{name}, {len(less)} pairs: costs {100 * sum(less) / len(less):.2f} cm less on the mean "
          f"[{100 * means[50]:.2f}, {100 * means[1949]:.2f}]; by 2 cm or more less in {sum(v >= LIMIT_M for v in less)}, "
          f"more in {sum(v <= -LIMIT_M for v in less)}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("rows", nargs="+")
    parser.add_argument("--worst", type=int, default=3)
    parser.add_argument("--against")
    args = parser.parse_args()
    every, left = [], 0
    for path in args.rows:
        rows, out = read(path)
        every, left = every + rows, left + out
        report(os.path.basename(path)[:-6], rows, out, args.worst)
        if args.against:
            compare(os.path.basename(path)[:-6], rows, read(os.path.join(args.against, os.path.basename(path)))[0])
    if len(args.rows) > 1:
        report("all", every, left, 0)


main()
