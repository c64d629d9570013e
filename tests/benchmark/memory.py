#!/usr/bin/env python3
"""Memory of a campaign round by round.
   python3 memory.py [ROUNDS] [OUT] [PROGRAM]
Runs ROUNDS rounds of seven `hose_b` (default 200), one at a time, and watches the largest resident memory
of each round's process and of the campaign's own. Prints both, and what the second half of the rounds took
over the first. Exit 1 when a process took more than 600 MB or the campaign's own grew by more than 10 MB.
The same OUT goes on where it was, but only the rounds of this run are watched."""
import os
import statistics
import subprocess
import sys
import time

LIMIT_MB = 600.0
GROWTH_MB = 10.0  # The campaign's own: it keeps the rows of rounds, nothing else.


def peak_mb(pid):
    """VmHWM, the largest resident memory so far; None when the process is gone."""
    try:
        with open(f"/proc/{pid}/status") as status:
            for line in status:
                if line.startswith("VmHWM:"):
                    return int(line.split()[1]) / 1024.0
    except OSError:
        pass
    return None


def now_mb(pid):
    try:
        with open(f"/proc/{pid}/statm") as statm:
            return int(statm.read().split()[1]) * os.sysconf("SC_PAGE_SIZE") / 2**20
    except OSError:
        return None


def children(pid):
    try:
        with open(f"/proc/{pid}/task/{pid}/children") as listed:
            return [int(child) for child in listed.read().split()]
    except OSError:
        return []


def watch(process):
    """Peaks of the children in the order they came, and the parent's memory at each new child."""
    peaks, own = {}, []
    while process.poll() is None:
        for child in children(process.pid):
            if child not in peaks:
                own.append(now_mb(process.pid))
            peak = peak_mb(child)
            if peak is not None:
                peaks[child] = max(peak, peaks.get(child, 0.0))
        time.sleep(0.05)
    return list(peaks.values()), [value for value in own if value is not None]


def main(arguments):
    rounds = int(arguments[0]) if arguments else 200
    out = arguments[1] if len(arguments) > 1 else "out/memory"
    here = os.path.dirname(os.path.abspath(__file__))
    program = arguments[2] if len(arguments) > 2 else os.path.join(here, "../../build/bin/tubetwin")
    os.makedirs(out, exist_ok=True)
    campaign = os.path.join(out, "memory.toml")
    with open(campaign, "w") as file:
        file.write(f'seed = 1\nrounds = {rounds}\n[keep]\nfailures = 0\nsample = 0.0\nfilms = false\n'
                   '[[variant]]\npart = "hose_b"\ncount = 7\n')
    process = subprocess.Popen([program, "campaign", "run", campaign, "--jobs", "1", "--quiet", "--out", out],
                               stdout=subprocess.DEVNULL)
    peaks, own = watch(process)
    if process.returncode != 0 or len(peaks) < 2:
        sys.exit(f"the campaign ended with {process.returncode} after {len(peaks)} rounds")
    half = len(peaks) // 2
    first, second = statistics.median(peaks[:half]), statistics.median(peaks[half:])
    growth = own[-1] - own[1 if len(own) > 2 else 0]
    print(f"{len(peaks)} rounds: a round's process at most {max(peaks):.0f} MB, median {first:.0f} MB in the "
          f"first half, {second:.0f} MB in the second; the campaign's own {own[-1]:.0f} MB, grown by {growth:.1f} MB")
    return 1 if max(peaks) > LIMIT_MB or growth > GROWTH_MB else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
