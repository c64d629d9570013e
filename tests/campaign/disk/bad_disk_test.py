#!/usr/bin/env python3
"""Campaigns on bad disks: killed, full, broken, and cut from power, each at many moments of a run. No saved round may be
lost, every folder goes on, and what is merged in the end has the bytes of an undisturbed run.

  bad_disk_test.py DISK_CAMPAIGN BAD_DISK_LIBRARY [MOMENTS]

MOMENTS are tried of each kind (default 6; kills twice as many), evenly over all calls that change a file. A power cut is
what POSIX leaves of one: of a file what it held when it was last synced, of a folder the names that it held then. Disks keep
more than that, and not always the same: three kinds of remains are tried (see Remains)."""

import errno
import os
import shutil
import subprocess
import sys
import tempfile

SHARD = "c/shard-00000-of-00001.jsonl"
ROUNDS = 16
MERGED = ["picks.jsonl", "rounds.jsonl", "summary.json", "campaign.json"]


class Bench:
    def __init__(self, program, library, folder):
        self.program, self.library, self.folder = program, library, folder
        self.disk = os.path.join(folder, "disk")
        self.log = os.path.join(folder, "calls")

    def fresh(self, prepared):
        """An empty disk, or one with a campaign that was stopped and whose last line is half there."""
        shutil.rmtree(self.disk, ignore_errors=True)
        for name in os.listdir(self.folder):
            if name.startswith("calls"):
                os.remove(os.path.join(self.folder, name))
        if prepared is None:
            os.mkdir(self.disk)
        else:
            shutil.copytree(prepared, self.disk)

    def run(self, log=False, **bad):
        """The program's exit code, how many rounds it said were saved, and its messages."""
        environment = {**os.environ, **{name.upper(): str(value) for name, value in bad.items()}}
        environment |= {"BAD_DISK_ROOT": self.disk, "LD_PRELOAD": self.library}
        if log:
            environment["BAD_DISK_LOG"] = self.log
        ran = subprocess.run([self.program, "run", os.path.join(self.disk, "c")], capture_output=True, text=True,
                             env=environment, timeout=120, check=False)
        saved = [int(line.split()[1]) for line in ran.stdout.splitlines() if line.startswith("saved ")]
        return ran.returncode, max(saved, default=0), ran.stderr

    def merged(self):
        target = os.path.join(self.folder, "m")
        shutil.rmtree(target, ignore_errors=True)
        subprocess.run([self.program, "merge", os.path.join(self.disk, "c"), target], check=True, timeout=120)
        return [open(os.path.join(target, name), "rb").read() for name in MERGED]

    def calls(self):
        with open(self.log, encoding="utf-8") as lines:
            return [line.split() for line in lines]

    def count(self, prepared):
        """Calls of an undisturbed run: the first that a kill would be too late for."""
        low, high = 1, 2000
        while low < high:
            middle = (low + high) // 2
            self.fresh(prepared)
            if self.run(bad_disk_kill=middle)[0] == 0:
                high = middle
            else:
                low = middle + 1
        return low - 1

    def synced(self, number):
        with open(f"{self.log}.{number}", "rb") as file:
            return file.read()


class Remains:
    """What a power cut leaves. "names": names are there before their content, as with XFS and ext4 without automatic
    allocation: unsynced content is missing. "zeros": the same, with zeros instead. "strict": names that their folder did not
    sync are missing, too, and removed ones are back."""

    def __init__(self, kind, before):
        self.kind, self.before = kind, before

    def leave(self, bench):
        names, kept = {}, {}        # Path: inode, now and on the disk.
        folders, kept_folders = {bench.disk}, {bench.disk}
        contents = {}               # Of inodes: what is on the disk.
        for path, content in files_below(bench.disk, self.before).items():
            names[path] = kept[path] = path  # A file of before has its path for an inode.
            contents[path] = content
            for above in parents(path, bench.disk):
                folders.add(above)
                kept_folders.add(above)
        for call, *words in bench.calls():
            if call == "create":
                contents.pop(words[0], None)
                names[words[1]] = words[0]
            elif call == "sync":
                # A file of before that is synced is known by its inode from here on.
                contents[words[0]] = bench.synced(words[1])
                for path, inode in list(names.items()):
                    if inode == path and os.path.exists(path) and os.stat(path).st_ino == int(words[0]):
                        names[path] = words[0]
                        if kept.get(path) == path:
                            kept[path] = words[0]
            elif call == "rename":
                names[words[1]] = names.pop(words[0])
            elif call == "unlink":
                names.pop(words[0], None)
            elif call == "mkdir":
                folders.add(words[0])
            elif call == "syncdir":
                for path in [p for p in kept if os.path.dirname(p) == words[0]]:
                    del kept[path]
                kept.update({p: i for p, i in names.items() if os.path.dirname(p) == words[0]})
                kept_folders.update(f for f in folders if os.path.dirname(f) == words[0])
        sizes = {path: os.path.getsize(path) for path in names if os.path.exists(path)}
        if self.kind == "strict":
            names, folders = kept, kept_folders
        shutil.rmtree(bench.disk)
        for folder in sorted(folders):
            if all(above in folders for above in parents(folder, bench.disk)):
                os.makedirs(folder, exist_ok=True)
        for path, inode in names.items():
            if not os.path.isdir(os.path.dirname(path)):
                continue
            content = contents.get(inode, b"")
            if self.kind == "zeros":
                content += bytes(max(0, sizes.get(path, 0) - len(content)))
            with open(path, "wb") as file:
                file.write(content)


def parents(path, root):
    out = []
    while len(path) > len(root):
        path = os.path.dirname(path)
        out.append(path)
    return out


def files_below(root, source):
    """Files of the folder that was copied to `root`, by their paths there."""
    out = {}
    for folder, _, files in os.walk(source) if source else []:
        for name in files:
            path = os.path.join(folder, name)
            with open(path, "rb") as file:
                out[os.path.join(root, os.path.relpath(path, source))] = file.read()
    return out


def moments(count, last):
    """So many calls of 1 to `last`, evenly."""
    return sorted({1 + (last - 1) * i // max(1, count - 1) for i in range(count)})


def require(condition, what):
    if not condition:
        raise SystemExit(f"FAILED: {what}")


def check_goes_on(bench, expected, saved, what):
    """Resumes after the fault is gone: nothing saved runs again, the rest does."""
    code, _, said = bench.run()
    require(code == 0, f"{what}: resuming ended with {code}: {said}")
    require(bench.merged() == expected, f"{what}: other bytes than the undisturbed run")
    require("stands already" not in said, f"{what}: a round was saved twice: {said}")
    with open(os.path.join(bench.disk, SHARD), encoding="utf-8") as lines:
        require(sum(1 for _ in lines) == 1 + ROUNDS, f"{what}: the shard has not a line for each of {ROUNDS} rounds")
    require(saved <= ROUNDS, what)


def rounds_in(bench):
    path = os.path.join(bench.disk, SHARD)
    if not os.path.exists(path):
        return 0
    with open(path, "rb") as file:
        return max(0, file.read().count(b',"check":"') - 1)


def main():
    program, library = map(os.path.abspath, sys.argv[1:3])
    wanted = int(sys.argv[3]) if len(sys.argv) > 3 else 6
    fast = "/dev/shm" if os.access("/dev/shm", os.W_OK) else None  # What a disk does is told by the library.
    with tempfile.TemporaryDirectory(dir=fast) as folder:
        bench = Bench(program, library, os.path.realpath(folder))
        bench.fresh(None)
        require(bench.run()[0] == 0, "the undisturbed run")
        expected = bench.merged()
        prepared = os.path.join(folder, "prepared")
        half = bench.count(None) // 2
        bench.fresh(None)
        bench.run(bad_disk_kill=half)
        with open(os.path.join(bench.disk, SHARD), "a", encoding="utf-8") as shard:
            shard.write('{"variant":1,"round"')
        shutil.copytree(bench.disk, prepared)
        done = rounds_in(bench)
        require(2 <= done < ROUNDS - 2, f"{done} rounds in the folder that goes on")
        tried = {}
        for start, before in ((None, 0), (prepared, done)):
            last = bench.count(start)
            for moment in moments(wanted, last):
                what = f"killed at call {moment} of {last}"
                bench.fresh(start)
                code, saved, _ = bench.run(bad_disk_kill=moment)
                require(code == -9, what)
                require(rounds_in(bench) >= max(saved, before), f"{what}: {saved} rounds were saved, {rounds_in(bench)} are there")
                check_goes_on(bench, expected, saved, what)
                tried["killed"] = tried.get("killed", 0) + 1
            for moment in moments((wanted + 1) // 2, last):
                for error in (errno.ENOSPC, errno.EIO):
                    what = f"{errno.errorcode[error]} from call {moment} of {last} on"
                    bench.fresh(start)
                    code, saved, said = bench.run(bad_disk_fail=moment, bad_disk_error=error)
                    require(code == 74, f"{what}: exit {code}: {said}")
                    require(os.strerror(error) in said, f"{what}: no reason: {said}")
                    require(rounds_in(bench) >= max(saved, before), f"{what}: a saved round is gone")
                    check_goes_on(bench, expected, saved, what)
                    tried[errno.errorcode[error]] = tried.get(errno.errorcode[error], 0) + 1
                for kind in ("names", "zeros", "strict"):
                    what = f"power cut before call {moment} of {last}, {kind}"
                    bench.fresh(start)
                    _, saved, _ = bench.run(log=True, bad_disk_kill=moment)
                    Remains(kind, start).leave(bench)
                    require(rounds_in(bench) >= max(saved, before),
                            f"{what}: {max(saved, before)} rounds were saved, {rounds_in(bench)} are there")
                    check_goes_on(bench, expected, saved, what)
                    tried["power cut"] = tried.get("power cut", 0) + 1
    print(", ".join(f"{kind}: {n}" for kind, n in tried.items()) + ": no round lost, the same bytes")


main()
