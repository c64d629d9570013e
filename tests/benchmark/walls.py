#!/usr/bin/env python3
"""Piles of straight tubes that drop along the bin's walls: walls.py FOLDER COUNT [TUBES] [SEED]

Every tube of pvc_a's radius, length and mass lies parallel to a wall of its own, its side 0.3 to 6 mm from it, and falls
10 mm; every third stands with an end in the corner."""
import json
import os
import random
import sys

SIZE_M = [0.77, 0.58, 0.09]
RADIUS_M, LENGTH_M, MASS_KG = 0.0125, 0.50, 0.055
NODES = 51


def tube(rng, wall):
    along, across = (1, 0) if wall < 2 else (0, 1)
    sign = 1 if wall % 2 == 0 else -1
    room = 0.5 * (SIZE_M[along] - LENGTH_M) - RADIUS_M - 0.0005
    middle = rng.choice([-room, room]) if rng.random() < 1 / 3 else rng.uniform(-room, room)
    gap = rng.uniform(0.0003, 0.006)
    line = []
    for k in range(NODES):
        p = [0.0, 0.0, RADIUS_M + 0.010]
        p[along] = middle + LENGTH_M * (k / (NODES - 1) - 0.5)
        p[across] = sign * (0.5 * SIZE_M[across] - RADIUS_M - gap)
        line.append(p)
    return line


def main():
    folder, count = sys.argv[1], int(sys.argv[2])
    tubes = int(sys.argv[3]) if len(sys.argv) > 3 else 2  # At most two.
    seed = int(sys.argv[4]) if len(sys.argv) > 4 else 1
    os.makedirs(folder, exist_ok=True)
    for i in range(count):
        rng = random.Random(seed * 100003 + i)
        # Two opposite walls, so that no two tubes share a corner.
        first = rng.choice([0, 2])
        walls = rng.sample([first, first + 1], min(tubes, 2))
        lines = [tube(rng, wall) for wall in walls]
        pile = {
            "schema": "tubetwin/pile/1",
            "bin": {"size_m": SIZE_M, "X_BN": {"p_m": [0.6, 0.0, 0.1], "q_wxyz": [0.5**0.5, 0, 0, 0.5**0.5]}},
            "part": "pvc_a",
            "tubes": [{"id": k + 1, "centerline_m": line, "radius_m": RADIUS_M, "mass_kg": MASS_KG}
                      for k, line in enumerate(lines)],
            "seed": i,
            "settled": False,
        }
        with open(os.path.join(folder, f"wall_{i:03d}.json"), "w") as file:
            json.dump(pile, file)


main()
