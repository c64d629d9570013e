#!/usr/bin/env python3
"""How a campaign's attempts at covered tubes ended (covered.toml): taken alone by the motion (one tube in the fingers when
it was weighed, by truth), and one tube placed, shaken off others included. All, by covers, by tubes left in the bin, by
what was foretold, by motion.
Intervals by rounds.
    python3 covered.py OUT..."""
import glob
import json
import re
import sys

from intervals import by_rounds


def attempts(out):
    for path in sorted(glob.glob(f"{out}/shard-*.jsonl")):
        for line in open(path):
            for pick in json.loads(line).get("picks", []):
                # Free tubes go up without the simulator.
                if pick["outcome"] != "no_plan" and pick["used_simulator"]:
                    yield pick | {"in": (out, pick["variant"], pick["round"])}


def foretold(pick):
    prediction = pick["prediction"]
    if prediction["samples"] == 0:
        return "touches nothing"
    if prediction["extra_probability"] >= 0.3:
        return "others come along in 30 % or more of the samples"
    return f"alone, by {'all' if prediction['samples'] >= 5 else 'fewer'} samples"


def main():
    picks = [pick for out in sys.argv[1:] for pick in attempts(out)]
    if not picks:
        sys.exit("covered.py: no attempts at covered tubes; give folders of `campaign run tests/benchmark/covered.toml`")
    groups = {"all": lambda pick: "all",
              "covers": lambda pick: "two or more" if pick["class"] == "strong" else "one",
              "tubes left": lambda pick: str(pick["tubes_in_bin"]),
              "foretold": foretold,
              "motion": lambda pick: re.sub(r"[+-]?\d*$", "", pick["motion"]["name"])}
    print("| | | taken alone | one placed |\n|---|---|---|---|")
    for name, group in groups.items():
        for value in sorted({group(pick) for pick in picks}):
            those = [pick for pick in picks if group(pick) == value]
            alone = by_rounds((pick["in"], pick["truth"]["held"] == 1) for pick in those)
            placed = by_rounds((pick["in"], pick["outcome"] == "placed" and pick["success"]) for pick in those)
            print(f"| {name} | {value} | {alone} | {placed} |")


main()
