"""Checks of scripts that run the program: all of them are made, and what failed is the exit code."""

import os
import sys
import tempfile
import time

failures = []


def check(holds, what):
    if not holds:
        failures.append(what)
        print("FAILED:", what, flush=True)


def finish():
    sys.exit(1 if failures else 0)


def run_tests(*tests):
    """Each in a folder of its own, with the time that it took."""
    with tempfile.TemporaryDirectory() as top:
        for test in tests:
            folder = os.path.join(top, test.__name__)
            os.mkdir(folder)
            began = time.monotonic()
            test(folder)
            print(f"{test.__name__}: {time.monotonic() - began:.1f} s", flush=True)
    finish()
