#!/usr/bin/env python3
"""bridge_first_contact.py PROGRAM: what a person does first with a cell, on emulated devices."""

import json
import os
import subprocess
import sys
import tomllib

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "support"))
from checks import check, run_tests  # noqa: E402
from emulation import Emulation  # noqa: E402

PROGRAM = sys.argv[1]
ONE_TUBE = ["seed=3", "pile.count=1"]


def joints_told(cell):
    told = subprocess.run([PROGRAM, "doctor", "--cell", cell], capture_output=True, text=True,
                          timeout=60).stdout
    return told.split("joints ")[1].split(" degrees")[0]


def first_contact(folder):
    emulation = Emulation(PROGRAM, folder + "/first", rate=4, overrides=ONE_TUBE)

    def verb(*words, yes=True):
        command = [PROGRAM, *words, "--cell", emulation.cell] + (["--yes"] if yes else [])
        return subprocess.run(command, capture_output=True, text=True, timeout=120,
                              stdin=subprocess.DEVNULL)

    early = verb("home")
    check(early.returncode == 69 and "--activate-gripper" in early.stderr,
          f"home needs to know what the fingers hold: {early.returncode} {early.stderr}")
    asked = verb("doctor", "--activate-gripper", yes=False)
    check(asked.returncode == 64 and "--yes" in asked.stderr, f"nobody to ask: {asked.stderr}")
    told = verb("doctor", yes=False).stdout
    check("not activated" in told, f"and nothing was activated: {told}")
    done = verb("doctor", "--activate-gripper")
    check(done.returncode == 0 and "was not activated" in done.stderr,
          f"the gripper is activated: {done.returncode} {done.stderr}")
    again = verb("doctor", "--activate-gripper")
    check("nothing was moved" in again.stderr, f"once is enough: {again.stderr}")

    before = joints_told(emulation.cell)
    asked = verb("home", yes=False)
    check(asked.returncode == 64 and "--yes" in asked.stderr, f"nobody to ask: {asked.stderr}")
    jogged_away = [verb("jog", "--joint", "1", "--degrees", "1") for _ in range(3)]
    check(all(j.returncode == 0 for j in jogged_away), f"jogged: {jogged_away[-1].stderr}")
    home = verb("home", "--json")
    check(home.returncode == 0, f"home: {home.returncode} {home.stderr}")
    off = [abs(a - float(b)) for a, b in zip(json.loads(home.stdout)["joints_deg"], before.split())]
    check(max(off) < 0.05, f"an emulated arm begins at home: {home.stdout} {before}")

    views = folder + "/views"
    for _ in range(2):
        view = verb("calibrate", "view", "--out", views, yes=False)
        check(view.returncode == 0, f"a view is taken: {view.returncode} {view.stderr}")
    touch = verb("calibrate", "touch", "--out", views, "--tip", "0,0,0.2", "--on", "floor", yes=False)
    check(touch.returncode == 0, f"a touch is taken: {touch.stderr}")
    with open(views + "/views.toml", "rb") as file:
        taken = tomllib.load(file)
    check([v["cloud"] for v in taken["view"]] == ["view_0.pcd", "view_1.pcd"], f"views: {taken}")
    check(all(abs(a - float(b)) < 0.05 for a, b in zip(taken["view"][1]["joints_deg"], before.split())),
          f"with the arm's joints: {taken}")
    check(abs(taken["touch"][0]["p_BTip"][2] - 0.527) < 0.002, f"the tip is over the bin: {taken}")
    refused = verb("calibrate", "hand-eye", "--views", views, yes=False)
    check(refused.returncode == 65, f"too little is seen: {refused.returncode} {refused.stderr}")
    emulation.stop()


run_tests(first_contact)
