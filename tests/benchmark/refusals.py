#!/usr/bin/env python3
"""How the rounds of a campaign ended (refusals.toml), and why those that a fault ended. refusals.py OUT..."""
import collections
import glob
import json
import sys


def records(out):
    for path in sorted(glob.glob(f"{out}/shard-*.jsonl")):
        for line in open(path):
            record = json.loads(line)
            if "summary" in record:
                yield record


def main():
    rounds, attempts = collections.Counter(), collections.Counter()
    placed = start = 0
    for record in (record for out in sys.argv[1:] for record in records(out)):
        summary = record["summary"]
        rounds[summary["end_reason"]] += 1
        placed += summary["placed"]
        start += summary["tubes_start"]
        attempts.update(pick["outcome"] for pick in record["picks"])
        if summary["end_reason"] == "fault":
            print(f"round {record['round']}: {summary['end_detail']}")
    print(f"{sum(rounds.values())} rounds, by end: {dict(rounds)}; {placed} of {start} tubes placed")
    print(f"attempts, by outcome: {dict(attempts)}")


if __name__ == "__main__":
    main()
