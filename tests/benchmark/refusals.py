#!/usr/bin/env python3
"""How the rounds of a campaign ended, and how many a refused motion ended. refusals.py OUT"""
import collections
import json
import pathlib
import sys


def rows(folder, name):
    for path in sorted(pathlib.Path(folder).rglob(name)):
        with open(path) as lines:
            yield from (json.loads(line) for line in lines)


def main():
    attempts = collections.Counter()
    faults = []
    for row in rows(sys.argv[1], "picks.jsonl"):
        attempts[row["outcome"]] += 1
        if row["outcome"] == "fault":
            faults.append((row.get("round"), row["reason"]))
    rounds = collections.Counter()
    placed = start = 0
    for record in rows(sys.argv[1], "rounds*.jsonl"):
        summary = record["summary"]
        rounds[summary["end_reason"]] += 1
        placed += summary["placed"]
        start += summary["tubes_start"]
    print(f"rounds by end: {dict(rounds)}; {placed} of {start} tubes placed")
    print(f"attempts by outcome: {dict(attempts)}")
    for number, reason in faults:
        print(f"round {number}: {reason}")


if __name__ == "__main__":
    main()
