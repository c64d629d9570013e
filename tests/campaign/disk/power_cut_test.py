#!/usr/bin/env python3
"""Real power cuts: a campaign on a file system of a loop device that is shut down by its own ioctl at a random moment, as a
power cut leaves it, mounted again and gone on with. No saved round may be lost, and the merged bytes are those of an
undisturbed run.

  power_cut_test.py DISK_CAMPAIGN [CUTS]      (root; CUTS on each file system that can be made here, default 4)

Exit code 77 and a sentence where this cannot be done."""

import fcntl
import os
import random
import shutil
import struct
import subprocess
import sys
import tempfile
import time

SHUTDOWN = 0x8004587D  # _IOR('X', 125, __u32), of ext4, XFS and F2FS
NO_LOG_FLUSH = struct.pack("I", 2)
MAKE = {"ext4": ["mkfs.ext4", "-q", "-F"], "xfs": ["mkfs.xfs", "-q", "-f"]}
OPTIONS = {"ext4": "loop,noauto_da_alloc", "xfs": "loop"}
MERGED = ["picks.jsonl", "rounds.jsonl", "summary.json", "campaign.json"]
SEED = 20


def skip(why):
    print(f"SKIPPED: {why}")
    sys.exit(77)


def require(condition, what):
    if not condition:
        raise SystemExit(f"FAILED: {what}")


def run(*command):
    return subprocess.run(command, capture_output=True, text=True, check=False)


def merged(program, source, target):
    shutil.rmtree(target, ignore_errors=True)
    ran = run(program, "merge", source, target)
    require(ran.returncode == 0, ran.stderr)
    return [open(os.path.join(target, name), "rb").read() for name in MERGED]


def cut_at(program, mount, delay_s):
    """Runs the campaign and cuts the power after `delay_s`. What it said was saved before the cut, and its exit code.

    With the power gone nobody says anything; here the program lives on, and an fsync that was on its way through the shut
    file system may come back as done: ext4 drops the size of what was appended without a word (Linux 6.18, 5 of 300)."""
    process = subprocess.Popen([program, "run", mount + "/c"], stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    handle = os.open(mount, os.O_RDONLY)
    time.sleep(delay_s)
    os.set_blocking(process.stdout.fileno(), False)
    said = process.stdout.raw.read() or b""
    fcntl.ioctl(handle, SHUTDOWN, NO_LOG_FLUSH)
    os.close(handle)
    os.set_blocking(process.stdout.fileno(), True)
    _, errors = process.communicate(timeout=60)
    saved = [int(line.split()[1]) for line in said.splitlines(keepends=True) if line.endswith(b"\n")]
    return max(saved, default=0), process.returncode, errors


def try_cut(program, kind, work, expected, delay_s, damaged):
    image, mount = os.path.join(work, "image"), os.path.join(work, "mount")
    os.makedirs(mount, exist_ok=True)
    with open(image, "wb") as file:
        file.truncate(320 << 20)
    made = run(*MAKE[kind], image)
    if made.returncode != 0:
        skip(f"no {kind} can be made: {made.stderr.strip()}")
    mounted = run("mount", "-o", OPTIONS[kind], image, mount)
    if mounted.returncode != 0:
        skip(f"no loop device can be mounted here: {mounted.stderr.strip()}")
    try:
        before = 0
        if damaged:  # A resume that drops a line rewrites the shard.
            process = subprocess.Popen([program, "run", mount + "/c"], stdout=subprocess.PIPE, text=True)
            while before < 6:
                before = int(process.stdout.readline().split()[1])
            process.kill()
            process.communicate()
            with open(mount + "/c/shard-00000-of-00001.jsonl", "a", encoding="utf-8") as shard:
                shard.write('{"variant":1,"round"')
            run("sync")
        saved, code, errors = cut_at(program, mount, delay_s)
        saved = max(saved, before)
        require(code in (0, 74), f"{kind}: exit {code} after the cut: {errors}")
        run("umount", mount)
        require(run("mount", "-o", OPTIONS[kind], image, mount).returncode == 0, f"{kind}: cannot be mounted again")
        shard = mount + "/c/shard-00000-of-00001.jsonl"
        left = open(shard, "rb").read().count(b',"check":"') - 1 if os.path.exists(shard) else 0
        what = f"{kind}, cut after {delay_s:.3f} s: {saved} rounds were saved, {left} are there"
        require(left >= saved, what)
        ran = run(program, "run", mount + "/c")
        require(ran.returncode == 0, f"{what}; resuming ended with {ran.returncode}: {ran.stderr}")
        require(merged(program, mount + "/c", os.path.join(work, "m")) == expected, f"{what}; other bytes")
        return code, saved
    finally:
        run("umount", mount)


def main():
    program = os.path.abspath(sys.argv[1])
    cuts = int(sys.argv[2]) if len(sys.argv) > 2 else 4
    if os.geteuid() != 0:
        skip("only root may mount a file system")
    kinds = [kind for kind, command in MAKE.items() if shutil.which(command[0])]
    if not kinds:
        skip("no mkfs.ext4 or mkfs.xfs is installed (apt-get install e2fsprogs xfsprogs)")
    random.seed(SEED)
    with tempfile.TemporaryDirectory() as work:
        began = time.monotonic()
        require(run(program, "run", os.path.join(work, "whole")).returncode == 0, "the undisturbed run")
        whole_s = time.monotonic() - began
        expected = merged(program, os.path.join(work, "whole"), os.path.join(work, "m"))
        for kind in kinds:
            stopped, saved = 0, 0
            for i in range(cuts):
                delay_s = random.uniform(0.0, whole_s)
                code, rounds = try_cut(program, kind, work, expected, delay_s, damaged=i % 2 == 1)
                stopped += code == 74
                saved += rounds
            print(f"{kind}: {cuts} power cuts (seed {SEED}), {stopped} within the run, {saved} saved rounds: none lost")


main()
