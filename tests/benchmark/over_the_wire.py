#!/usr/bin/env python3
"""The same rounds on the twin directly and through the emulated devices: do they come to the same?

  tests/benchmark/over_the_wire.py [--out DIR] [--rounds 3] [--count 5] [--part pvc_a] [--rate 1]    (from the repository)

Prints one JSON object per round: outcomes of the attempts both ways, what was placed by truth, what the links lost,
how well the clocks were kept.
"""

import argparse
import json
import os
import shutil
import subprocess
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", "support"))
from emulation import Emulation, Run  # noqa: E402


def outcomes(folder):
    with open(os.path.join(folder, "picks.jsonl")) as file:
        return [json.loads(line)["outcome"] for line in file]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", default="out/wire")
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--count", type=int, default=5)
    parser.add_argument("--part", default="pvc_a")
    parser.add_argument("--rate", type=float, default=1.0)
    parser.add_argument("--program", default=os.path.join(HERE, "..", "..", "build", "bin", "tubetwin"))
    choice = parser.parse_args()
    shutil.rmtree(choice.out, ignore_errors=True)
    same = 0
    for seed in range(1, choice.rounds + 1):
        folder = os.path.join(choice.out, str(seed))
        settings = [f"seed={seed}", f"pile.count={choice.count}", f"pile.part={choice.part}"]
        arguments = [x for setting in settings for x in ("--set", setting)]
        subprocess.run([choice.program, "run", "-q", "--out", folder + "/twin", *arguments], check=True,
                       stdout=subprocess.DEVNULL)
        emulation = Emulation(choice.program, folder + "/emulated", choice.rate, overrides=settings)
        run = Run(choice.program, emulation.cell, folder + "/wire")
        code, err = run.wait(3000 / choice.rate + 60)
        result, _ = emulation.stop()
        with open(folder + "/wire/links.json") as file:
            links = json.load(file)
        with open(folder + "/twin/summary.json") as file:
            placed = json.load(file)["placed"]
        row = {"seed": seed, "twin": outcomes(folder + "/twin"), "wire": outcomes(folder + "/wire"), "code": code,
               "message": err.strip(), "placed_twin": placed, "placed_wire": len(emulation.world()["placed_ids"]),
               "links": links, "emulate": result}
        same += row["twin"] == row["wire"]
        print(json.dumps(row), flush=True)
    print(json.dumps({"rounds": choice.rounds, "same_outcomes": same}))
    return 0


if __name__ == "__main__":
    sys.exit(main())
