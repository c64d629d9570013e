#!/usr/bin/env python3
"""A long round over the wire at real time: memory, drift, latency, what was lost.

  tests/benchmark/soak.py [--out DIR] [--minutes 30] [--count 7] [--speed 0.05]      (from the repository)

The arm's speed is limited to --speed m/s so that a bin of --count tubes lasts; the round is stopped after --minutes.
Prints one JSON object: resident memory of both processes over time (MB, one sample per 10 s; the mean of the third
third less that of the second), what tests/benchmark/motion_of_recording says, links.json of the run.
"""

import argparse
import json
import os
import shutil
import signal
import subprocess
import sys
import time

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", "support"))
from emulation import Emulation, Run, resident_MB  # noqa: E402


def growth(samples):
    third = len(samples) // 3
    if third < 2:
        return None
    mean = lambda part: sum(part) / len(part)  # noqa: E731
    return round(mean(samples[2 * third:]) - mean(samples[third:2 * third]), 2)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", default="out/soak")
    parser.add_argument("--minutes", type=float, default=30)
    parser.add_argument("--count", type=int, default=7)
    parser.add_argument("--speed", type=float, default=0.05)
    parser.add_argument("--bin", default=os.path.join(HERE, "..", "..", "build", "bin"))
    choice = parser.parse_args()
    program = os.path.join(choice.bin, "tubetwin")
    shutil.rmtree(choice.out, ignore_errors=True)
    emulation = Emulation(program, choice.out + "/emulated", overrides=["seed=1", f"pile.count={choice.count}"])
    run = Run(program, emulation.cell, choice.out + "/run",
              ["--record", "--set", f"cell.safety.max_speed_m_s={choice.speed}"])
    memory = {"emulate": [], "run": []}
    end = time.monotonic() + 60 * choice.minutes
    while time.monotonic() < end and run.process.poll() is None:
        time.sleep(10)
        for name, pid in (("emulate", emulation.process.pid), ("run", run.process.pid)):
            MB = resident_MB(pid)
            if MB is not None:
                memory[name].append(round(MB, 1))
    run.process.send_signal(signal.SIGINT)  # Ends the round after the attempt under way.
    code, err = run.wait(600)
    result, _ = emulation.stop()
    world = emulation.world()
    motion = subprocess.run([os.path.join(choice.bin, "motion_of_recording"), choice.out + "/run/cell.rec.zst"],
                            capture_output=True, text=True)
    summary = run.summary()
    out = {"minutes": round((time.monotonic() - end) / 60 + choice.minutes, 2), "code": code, "message": err.strip(),
           "emulate": result, "placed": summary["placed"], "attempts": summary["attempts"],
           "placed_by_truth": len(world["placed_ids"]), "memory_MB": memory,
           "growth_MB": {name: growth(samples) for name, samples in memory.items()},
           "motion": json.loads(motion.stdout) if motion.returncode == 0 else motion.stderr}
    links = choice.out + "/run/links.json"
    if os.path.exists(links):
        with open(links) as file:
            out["links"] = json.load(file)
    print(json.dumps(out, indent=1))
    return 0


if __name__ == "__main__":
    sys.exit(main())
