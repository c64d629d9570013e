#!/usr/bin/env python3
"""bridge_test.py PROGRAM: the pipeline over the wire, as a user meets it, on emulated devices."""

import json
import os
import signal
import socket
import subprocess
import sys
import time

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "support"))
from checks import check, run_tests  # noqa: E402
from emulation import Emulation, Run  # noqa: E402

PROGRAM = sys.argv[1]
ONE_TUBE = ["seed=3", "pile.count=1"]


def events(emulation, kind):
    return [e["at_s"] for e in emulation.events() if e.get("event") == kind]


def a_round_over_the_wire(folder):
    emulation = Emulation(PROGRAM, folder + "/emulated", rate=4, overrides=ONE_TUBE)
    doctor = subprocess.run([PROGRAM, "doctor", "--cell", emulation.cell], capture_output=True,
                            text=True, timeout=60)
    check(doctor.returncode == 0, "doctor reads every device: " + doctor.stdout + doctor.stderr)
    check(not events(emulation, "arm moves"), "doctor moves nothing")
    dry = Run(PROGRAM, emulation.cell, folder + "/dry", ["--dry-run"])
    code, err = dry.wait(120)
    check(code == 0, f"a dry run ends with 0: {code} {err}")
    check(not events(emulation, "arm moves") and not events(emulation, "close"),
          "a dry run moves nothing")
    run = Run(PROGRAM, emulation.cell, folder + "/run")
    code, err = run.wait(240)
    result, took_s = emulation.stop()
    check(code == 0, f"the round ends with 0: {code} {err}")
    check(took_s < 5.0, "emulate ends within 5 s")
    check(emulation.world()["placed_ids"] == [1], "the tube lies on the tray by truth")
    summary = run.summary()
    check(summary["placed"] == 1 and summary["scored_by"] == "belief", f"summary: {summary}")


def killed_or_frozen_while_carrying(folder):
    for name, number in (("killed", signal.SIGKILL), ("frozen", signal.SIGSTOP)):
        emulation = Emulation(PROGRAM, f"{folder}/{name}", rate=4, overrides=ONE_TUBE)
        run = Run(PROGRAM, emulation.cell, f"{folder}/{name}_run")
        check(emulation.wait_for("carry"), f"{name}: a tube is carried")
        opened = events(emulation, "open")
        emulation.signal(number)
        began = time.monotonic()
        code, err = run.wait(30)
        check(code == 69, f"{name}: run ends with 69: {code} {err}")
        check(time.monotonic() - began < 15.0, f"{name}: run ends within 15 s")
        if number == signal.SIGSTOP:
            emulation.signal(signal.SIGCONT)
            time.sleep(0.5)
            check(events(emulation, "open") == opened, "frozen: the gripper was not opened")
            check(emulation.stop()[1] < 5.0, "frozen: emulate ends within 5 s")
            check(emulation.world()["held_ids"] == [1], "frozen: the tube still hangs")
        else:
            emulation.kill()


def joints_told(cell):
    told = subprocess.run([PROGRAM, "doctor", "--cell", cell], capture_output=True, text=True,
                          timeout=60).stdout
    return told.split("joints ")[1].split(" degrees")[0], told


def killed_and_started_again(folder):
    emulation = Emulation(PROGRAM, folder + "/again", rate=2, overrides=ONE_TUBE)
    run = Run(PROGRAM, emulation.cell, folder + "/again_run")
    check(emulation.wait_for("carry"), "a tube is carried")
    opened = events(emulation, "open")
    run.process.kill()
    run.wait(20)
    time.sleep(1.0)
    before, told = joints_told(emulation.cell)
    check("nobody commands it from here" in told, "doctor tells what is left: " + told)
    again = Run(PROGRAM, emulation.cell, folder + "/again_run2")
    code, err = again.wait(60)
    check(code == 69, f"what is left in the controller is 69: {code} {err}")
    check("press HOLD" in err and "nothing was sent" in err, "and says what to do: " + err)
    check(joints_told(emulation.cell)[0] == before, "nothing has moved")
    check(events(emulation, "open") == opened, "the fingers were not opened")
    emulation.stop()


def jogged(folder):
    emulation = Emulation(PROGRAM, folder + "/jogged", rate=4, overrides=ONE_TUBE)
    verb = [PROGRAM, "jog", "--cell", emulation.cell, "--joint", "6", "--json"]
    asked = subprocess.run(verb, capture_output=True, text=True, timeout=60,
                           stdin=subprocess.DEVNULL)
    check(asked.returncode == 64 and "--yes" in asked.stderr, f"nobody to ask: {asked.stderr}")
    check(not events(emulation, "arm moves"), "and nothing moved")
    joints = []
    for degrees in ("1", "-1"):
        done = subprocess.run(verb + ["--yes", "--degrees", degrees], capture_output=True,
                              text=True, timeout=60)
        check(done.returncode == 0, f"jog by {degrees}: {done.returncode} {done.stderr}")
        joints.append(json.loads(done.stdout)["joints_deg"])
    check(abs(joints[0][5] - joints[1][5] - 1.0) < 0.1, f"joint 6 has turned: {joints}")
    emulation.stop()


def asked_twice_to_stop(folder):
    emulation = Emulation(PROGRAM, folder + "/twice", rate=2, overrides=ONE_TUBE)
    run = Run(PROGRAM, emulation.cell, folder + "/twice_run")
    check(emulation.wait_for("carry"), "a tube is carried")
    opened = events(emulation, "open")
    run.process.send_signal(signal.SIGINT)
    time.sleep(0.2)
    run.process.send_signal(signal.SIGINT)
    began = time.monotonic()
    code, err = run.wait(20)
    check(time.monotonic() - began < 5.0, "a second Ctrl-C ends the round within 5 s")
    check(code == 75, f"and it was interrupted: {code} {err}")
    check(run.summary()["end_reason"] == "interrupted", f"the summary says so: {run.summary()}")
    check(events(emulation, "open") == opened, "the fingers were not opened")
    emulation.stop()
    check(emulation.world()["held_ids"] == [1], "the tube still hangs")


def what_may_not_move(folder):
    emulation = Emulation(PROGRAM, folder + "/unarmed", overrides=ONE_TUBE)
    with open(emulation.cell) as file:
        text = file.read()
    unarmed = folder + "/unarmed.toml"
    with open(unarmed, "w") as file:
        file.write(text.replace("armed = true", "armed = false"))
    # In place of the motion port: whoever connects would be heard.
    with socket.create_server(("127.0.0.1", 0)) as motion:
        motion.settimeout(0.5)
        port = motion.getsockname()[1]
        run = Run(PROGRAM, unarmed, folder + "/r",
                  ["--set", f"cell.arm.motion_port={port}"])
        code, err = run.wait(20)
        check(code == 78, f"an unarmed arm is 78: {code} {err}")
        check("armed" in err, "and the message says what is missing: " + err)
        dry = Run(PROGRAM, unarmed, folder + "/d",
                  ["--dry-run", "--set", f"cell.arm.motion_port={port}"])
        time.sleep(3.0)
        dry.process.send_signal(signal.SIGTERM)
        try:
            motion.accept()
            check(False, "nobody connects to the motion port of an unarmed arm")
        except TimeoutError:
            pass
        dry.wait(60)
        motion.close()
        for key in ("arm.motion_port", "arm.state_port", "gripper.port", "wrist.port"):
            began = time.monotonic()
            closed = Run(PROGRAM, emulation.cell, folder + "/c", ["--set", f"cell.{key}={port}"])
            code, err = closed.wait(20)
            check(code == 69, f"a closed {key} is 69: {code} {err}")
            check(time.monotonic() - began < 10.0, f"a closed {key}: within 10 s")
            check(str(port) in err, f"a closed {key} is named: {err}")
    emulation.stop()


run_tests(a_round_over_the_wire, killed_or_frozen_while_carrying, asked_twice_to_stop, killed_and_started_again, jogged, what_may_not_move)
