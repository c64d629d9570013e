#!/usr/bin/env python3
"""Table of perception_table's rows: python3 perception_table.py [--worst N] ROWS.jsonl...

Rates carry Wilson 95 % intervals. `--worst N` also lists the N piles of each cell with the most tubes not found.
"""
import collections
import json
import sys

from intervals import wilson_interval


def rate(k, n):
    low, high = wilson_interval(k, n)
    return f"{100 * k / n:.1f} [{100 * low:.1f}, {100 * high:.1f}] of {n}" if n else "-"


def quantile(values, q):
    return sorted(values)[int(q * (len(values) - 1))] if values else float("nan")


def cell_of(row):
    return (row["part"], row["setup"], row["noise"], row["hand_eye"], row["count"])


def table(rows, worst):
    cells = collections.defaultdict(list)
    for row in rows:
        cells[cell_of(row)].append(row)
    print("| part | setup | noise | hand-eye | tubes | piles | micro-recall | found % | extra | seen median/p95 mm | "
          "all p95 mm | visible crossings right % | hidden right % | on a bridge % | on an unseen end % | reversed | spurious | class right % | "
          "covered called free % | joint F1 (P, R) | ms median |")
    print("|" + "---|" * 21)
    for key in sorted(cells):
        done = cells[key]
        total = lambda name: sum(r[name] for r in done)
        item = lambda name, i: sum(r[name][i] for r in done)
        points = total("points")
        recall = sum(r["micro_recall"] * r["points"] for r in done) / max(1, points)
        seen = [e / 1000 for r in done for e in r["seen_um"]]
        both = seen + [e / 1000 for r in done for e in r["hidden_um"]]
        truth, perceived, right = (item("joints", i) for i in range(3))
        precision, hit = right / max(1, perceived), right / max(1, truth)
        f1 = 2 * right / max(1, truth + perceived)
        columns = [key[0], key[1], f"{key[2]:g}", "on" if key[3] else "off", key[4], len(done), f"{recall:.4f}",
                   rate(total("found"), total("tubes")), total("predicted") - total("paired"),
                   f"{quantile(seen, .5):.2f}/{quantile(seen, .95):.2f}", f"{quantile(both, .95):.2f}",
                   rate(item("visible", 1), item("visible", 0)), rate(item("hidden", 1), item("hidden", 0)),
                   rate(item("hidden", 1) - item("unseen_end", 1), item("hidden", 0) - item("unseen_end", 0)),
                   rate(item("unseen_end", 1), item("unseen_end", 0)),
                   item("visible", 2) + item("hidden", 2), total("spurious"),
                   rate(total("class_right"), total("paired")),
                   rate(total("covered_called_free"), total("covered")),
                   f"{f1:.3f} ({precision:.3f}, {hit:.3f}) of {truth}", f"{quantile([r['ms'][5] for r in done], .5):.0f}"]
        print("| " + " | ".join(str(c) for c in columns) + " |")
    if not worst:
        return
    for key in sorted(cells):
        bad = lambda r: (r["tubes"] - r["found"], r["paired"] - r["class_right"], r["joints"][0] - r["joints"][2])
        for row in sorted(cells[key], key=bad, reverse=True)[:worst]:
            if bad(row) != (0, 0, 0):
                print(f"{row['pile']}: found {row['found']}/{row['tubes']}, predicted {row['predicted']}, recall "
                      f"{row['micro_recall']:.3f}, class {row['class_right']}/{row['paired']}, joints {row['joints']}, "
                      f"visible {row['visible']}, hidden {row['hidden']}, spurious {row['spurious']}")


def main(arguments):
    worst = 0
    if arguments and arguments[0] == "--worst":
        worst = int(arguments[1])
        arguments = arguments[2:]
    rows = {}
    for path in arguments:
        with open(path) as f:
            for line in f:
                row = json.loads(line)
                rows[(row["pile"],) + cell_of(row)] = row
    table(rows.values(), worst)


main(sys.argv[1:])
