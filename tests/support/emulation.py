"""An emulated cell and pipelines that run on it, for tests and measurements of the bridge."""

import json
import os
import signal
import subprocess
import time
import tomllib


def resident_MB(pid):
    """Memory of a process, None when it is gone."""
    try:
        with open(f"/proc/{pid}/status") as file:
            return next((int(line.split()[1]) / 1024 for line in file if line.startswith("VmRSS")), None)
    except OSError:
        return None


class Emulation:
    """`tubetwin emulate` in a folder, on free ports of the loopback address."""

    def __init__(self, program, folder, rate=1.0, faults=None, overrides=(), options=()):
        self.program, self.folder = program, folder
        os.makedirs(folder, exist_ok=True)
        command = [program, "emulate", "--any-ports", "--rate", str(rate), "--json", "--out", folder]
        command += list(options)
        for override in overrides:
            command += ["--set", override]
        if faults is not None:
            script = folder + ".faults.toml"
            with open(script, "w") as file:
                file.write(faults)
            command += ["--faults", script]
        self.log = open(folder + ".log", "w+")
        self.process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=self.log, text=True)
        self.cell = os.path.join(folder, "cell.toml")
        for _ in range(600):
            if os.path.exists(self.cell):
                return
            if self.process.poll() is not None:
                break
            time.sleep(0.05)
        self.process.kill()
        self.log.seek(0)
        raise RuntimeError("emulate did not begin to listen: " + self.log.read())

    def devices(self):
        """The tables [cell.*] of its cell file."""
        with open(self.cell, "rb") as file:
            return tomllib.load(file)["cell"]

    def events(self):
        """Lines of events.jsonl so far: [{at_s, event | fault}]."""
        with open(os.path.join(self.folder, "events.jsonl")) as file:
            return [json.loads(line) for line in file if line.endswith("\n")]

    def wait_for(self, event, limit_s=120.0):
        """Until the event has come; False when it has not within `limit_s` of wall time."""
        end = time.monotonic() + limit_s
        while time.monotonic() < end:
            if any(e.get("event") == event for e in self.events()):
                return True
            time.sleep(0.02)
        return False

    def signal(self, number):
        self.process.send_signal(number)

    def stop(self):
        """What `emulate` printed when it was asked to end, and how long that took."""
        began = time.monotonic()
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGTERM)
        out, _ = self.process.communicate(timeout=30)
        self.log.close()
        return json.loads(out), time.monotonic() - began

    def kill(self):
        self.process.kill()
        self.process.communicate()
        self.log.close()

    def world(self):
        """What lies where by truth, after stop()."""
        with open(os.path.join(self.folder, "world.json")) as file:
            return json.load(file)


class Run:
    """`tubetwin run --cell` in the background."""

    def __init__(self, program, cell, folder, options=()):
        self.folder = folder
        self.began = time.monotonic()
        self.process = subprocess.Popen(
            [program, "run", "--cell", cell, "--out", folder, "-q", *options],
            stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)

    def wait(self, limit_s):
        """Exit code, stderr; None as the code of one that hangs, which is killed."""
        try:
            _, err = self.process.communicate(timeout=limit_s)
            return self.process.returncode, err
        except subprocess.TimeoutExpired:
            self.process.kill()
            _, err = self.process.communicate()
            return None, err

    def summary(self):
        with open(os.path.join(self.folder, "summary.json")) as file:
            return json.load(file)
