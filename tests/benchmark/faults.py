#!/usr/bin/env python3
"""What scripted faults at five moments of a pick come to: FAULTS x MOMENTS rounds of one tube over the wire.

  tests/benchmark/faults.py [--out DIR] [--rate 5] [--only NAME[,NAME]] [--moments ...] [--table]     (from the repository; resumes)

One line of DIR/rows.jsonl per round; rounds that it holds are skipped. --table prints the table of the docs from it.
Every round is judged by truth, by the log of the emulated cell and by the program's exit code:
  outcome    placed (0, the tube lies on the tray by truth), ended (69, the round ended with a fault and says which)
  late       seconds of cell time from the fault to the end of the round
and it is wrong when it hangs or crashes, says 0 with the tube elsewhere, is not one of the documented outcomes, comes
later than stated, loses a tube that was held, opens the gripper or starts a motion after a stop.
"""

import argparse
import json
import os
import shutil
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", "support"))
from emulation import Emulation, Run  # noqa: E402

MOMENTS = {"scan": 'on = "scan"\nnth = 4', "reach": 'on = "reach"', "held": 'on = "held"', "lift": 'on = "lift"',
           "carry": 'on = "carry"\ndelay_s = 0.3'}
EITHER, ENDS, GOES_ON = ("placed", "ended"), ("ended",), ("placed",)


def fault(device, action, outcomes, within_s, rest="", moments=None):
    """`outcomes`: what is documented; `within_s`: cell time until a round that ends has ended. `moments`: outcomes
    that differ at some of them."""
    return {"device": device, "action": action, "outcomes": outcomes, "within_s": within_s, "rest": rest,
            "moments": moments or {}}


# Links: what is silent for longer than the cell's watch allows ends the round where its word is needed: the arm while
# it moves, the wrist while it guards or is weighed, the gripper from its next use on.
FAULTS = {
    "motion_drop": fault("arm.motion", "drop", ENDS, 15),
    "motion_drop_0.2s": fault("arm.motion", "drop", EITHER, 15, "for_s = 0.2"),
    "motion_delay_0.01s": fault("arm.motion", "delay", GOES_ON, 0, "value = 0.01"),
    # Every point waits for its answer: a round trip over the 32 ms between points starves the controller.
    "motion_delay_0.05s": fault("arm.motion", "delay", EITHER, 15, "value = 0.05"),
    "motion_duplicate": fault("arm.motion", "duplicate", EITHER, 15),
    "motion_corrupt": fault("arm.motion", "corrupt", ENDS, 15),
    "motion_freeze": fault("arm.motion", "freeze", ENDS, 15),
    "motion_freeze_0.2s": fault("arm.motion", "freeze", EITHER, 15, "for_s = 0.2"),
    "motion_close": fault("arm.motion", "close", ENDS, 15),
    "state_drop": fault("arm.state", "drop", ENDS, 15),
    "state_drop_0.05s": fault("arm.state", "drop", GOES_ON, 0, "for_s = 0.05"),
    "state_delay_0.05s": fault("arm.state", "delay", EITHER, 15, "value = 0.05"),
    "state_duplicate": fault("arm.state", "duplicate", GOES_ON, 0),
    "state_corrupt": fault("arm.state", "corrupt", ENDS, 15),
    "state_freeze": fault("arm.state", "freeze", ENDS, 15),
    "state_freeze_2s": fault("arm.state", "freeze", EITHER, 15, "for_s = 2"),
    "state_close": fault("arm.state", "close", ENDS, 15),
    "supervision_freeze": fault("arm.supervision", "freeze", GOES_ON, 0),
    "emergency_stop": fault("arm", "emergency_stop", ENDS, 15),
    "protective_stop": fault("arm", "protective_stop", ENDS, 15),
    "alarm": fault("arm", "alarm", ENDS, 15, "value = 4315"),
    "alarm_lasting": fault("arm", "alarm", ENDS, 15, "value = 4107\nfor_s = 600"),
    "hold_2s": fault("arm", "hold", EITHER, 15, "for_s = 2"),
    "servo_off": fault("arm", "servo_off", ENDS, 15),
    "local": fault("arm", "local", ENDS, 15),
    "teach": fault("arm", "teach", ENDS, 15),
    "refuse_start": fault("arm", "refuse", ENDS, 15, "value = 3011\ncount = 1"),
    "refuse_speed": fault("arm", "refuse", ENDS, 15, "value = 3013\ncount = 1"),
    "gripper_link_drop": fault("gripper.link", "drop", ENDS, 40),
    # The gripper itself calls silence of 1 s a fault; a lost answer is waited for 0.2 s on the wall, 1 s of a cell at
    # rate 5.
    "gripper_link_drop_0.05s": fault("gripper.link", "drop", EITHER, 40, "for_s = 0.05"),
    "gripper_link_drop_0.3s": fault("gripper.link", "drop", EITHER, 40, "for_s = 0.3"),
    "gripper_link_delay_0.1s": fault("gripper.link", "delay", EITHER, 80, "value = 0.1"),
    "gripper_link_duplicate": fault("gripper.link", "duplicate", EITHER, 40),
    "gripper_link_corrupt": fault("gripper.link", "corrupt", ENDS, 40),
    "gripper_link_freeze": fault("gripper.link", "freeze", ENDS, 40),
    "gripper_hot": fault("gripper", "fault", ENDS, 40, "value = 8"),
    "gripper_undervoltage": fault("gripper", "fault", ENDS, 40, "value = 10"),
    "gripper_internal": fault("gripper", "fault", ENDS, 40, "value = 12"),
    "gripper_overcurrent": fault("gripper", "fault", ENDS, 40, "value = 14"),
    "gripper_object_lost": fault("gripper", "lose_object", EITHER, 40),
    "wrist_link_drop": fault("wrist.link", "drop", ENDS, 40),
    "wrist_link_drop_0.02s": fault("wrist.link", "drop", GOES_ON, 0, "for_s = 0.02"),
    "wrist_link_delay_0.2s": fault("wrist.link", "delay", EITHER, 40, "value = 0.2"),
    "wrist_link_duplicate": fault("wrist.link", "duplicate", GOES_ON, 0),
    "wrist_link_corrupt": fault("wrist.link", "corrupt", ENDS, 40),
    "wrist_link_freeze": fault("wrist.link", "freeze", ENDS, 40),
    "wrist_saturated": fault("wrist", "saturate", ENDS, 40),
    "wrist_fault_status": fault("wrist", "status", ENDS, 40, "value = 2147614720"),
    "wrist_threshold": fault("wrist", "threshold", GOES_ON, 0),
    "wrist_sequence_gap": fault("wrist", "skip", GOES_ON, 0, "count = 100"),
    # One bad scan is asked for again; two in a row end the round.
    "scanner_no_answer": fault("scanner", "no_answer", GOES_ON, 0),
    "scanner_no_answer_twice": fault("scanner", "no_answer", ENDS, 80, "count = 2"),
    "scanner_late_2s": fault("scanner", "late", GOES_ON, 0, "value = 2"),
    "scanner_truncated": fault("scanner", "truncate", GOES_ON, 0),
    "scanner_truncated_twice": fault("scanner", "truncate", ENDS, 80, "count = 2"),
    "scanner_garbage": fault("scanner", "garbage", GOES_ON, 0),
    "scanner_refused": fault("scanner", "refuse", GOES_ON, 0),
    "scanner_refused_twice": fault("scanner", "refuse", ENDS, 80, "count = 2"),
    "scanner_covered": fault("scanner", "cover", EITHER, 80, "count = 100"),
    "scanner_link_freeze": fault("scanner.link", "freeze", ENDS, 80),
    "scanner_link_corrupt": fault("scanner.link", "corrupt", ENDS, 80),
}
HELD_AT = ("held", "lift", "carry")
TENS = ["motion_freeze", "state_freeze", "emergency_stop", "protective_stop", "alarm", "gripper_link_freeze",
        "gripper_link_drop_0.05s", "wrist_link_freeze", "scanner_no_answer_twice", "motion_close"]


def judge(name, moment, code, err, events, world, cell_s, rows):
    """What one round came to, and what is wrong with it."""
    spec, wrong = FAULTS[name], []
    begun = [e["at_s"] for e in events if "fault" in e and not e["fault"].endswith("undone")]
    row = {"fault": name, "moment": moment, "code": code, "at_s": begun[0] if begun else None}
    if not begun:
        wrong.append("the moment did not come")
    outcome = {0: "placed", 69: "ended"}.get(code, "hang" if code is None else f"exit {code}")
    if outcome == "placed" and world["placed_ids"] != [1]:
        wrong.append("says 0, and the tube is not on the tray")
    allowed = spec["moments"].get(moment, spec["outcomes"])
    if outcome not in allowed:
        wrong.append(f"{outcome}, documented {' or '.join(allowed)}")
    after_s = None
    if begun and outcome == "ended":
        after_s = round(cell_s - begun[0], 2)
        if after_s > spec["within_s"]:
            wrong.append(f"ended after {after_s} s, stated {spec['within_s']}")
        later = [e for e in events if e["at_s"] > begun[0] and "event" in e]
        opened = [e for e in later if e["event"] == "open"]
        if moment in HELD_AT:
            # Where the fault is in nobody's way yet, the tube is put down first, on the tray or back into the bin.
            put_down = world["placed_ids"] == [1] or world["in_bin_ids"] == [1]
            if opened and not put_down:
                wrong.append("the gripper was opened and the tube is nowhere")
            if not opened and world["held_ids"] != [1]:
                wrong.append("a held tube was lost")
        if spec["device"] == "arm" and spec["outcomes"] == ENDS and any(e["event"] == "arm moves" for e in later):
            wrong.append("the arm moved after the stop")
    row.update(outcome=outcome, after_s=after_s, wrong=wrong, message=err.strip().splitlines()[-1] if err.strip() else "",
               attempts=rows)
    return row


def one(program, folder, name, moment, rate):
    spec = FAULTS[name]
    script = f'[[fault]]\n{MOMENTS[moment]}\ndevice = "{spec["device"]}"\naction = "{spec["action"]}"\n{spec["rest"]}\n'
    shutil.rmtree(folder, ignore_errors=True)
    emulation = Emulation(program, folder + "/emulated", rate, script, ["seed=3", "pile.count=1"])
    run = Run(program, emulation.cell, folder + "/run")
    code, err = run.wait(900 / rate + 30)
    result, took_s = emulation.stop()
    attempts = None
    if os.path.exists(folder + "/run/picks.jsonl"):
        with open(folder + "/run/picks.jsonl") as file:
            attempts = sum(1 for _ in file)
    row = judge(name, moment, code, err, emulation.events(), emulation.world(), result["cell_s"], attempts)
    if took_s > 5.0:
        row["wrong"].append(f"emulate took {took_s:.1f} s to end")
    row.update(rate=rate, reached_rate=round(result["reached_rate"], 3), overruns=result["overruns"])
    return row


def table(rows):
    """The documented outcomes beside what was measured, as Markdown."""
    found = {(r["fault"], r["moment"]): r for r in rows}
    print("| fault | ends within | " + " | ".join(MOMENTS) + " |")
    print("|---|---|" + "---|" * len(MOMENTS))
    for name, spec in FAULTS.items():
        cells = []
        for moment in MOMENTS:
            row = found.get((name, moment))
            text = "not run" if row is None else row["outcome"]
            if row and row["after_s"] is not None:
                text += f" {row['after_s']:.1f} s"
            if row and row["wrong"]:
                text = "**" + text + "**: " + "; ".join(row["wrong"])
            cells.append(text)
        stated = f"{spec['within_s']} s" if "ended" in spec["outcomes"] else "goes on"
        print(f"| {name} | {stated} | " + " | ".join(cells) + " |")
    wrong = [r for r in rows if r["wrong"]]
    print(f"\n{len(rows)} rounds, {len(wrong)} not as documented")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", default="out/faults")
    parser.add_argument("--rate", type=float, default=5.0)
    parser.add_argument("--only", help="names of faults, with commas; 'ten': ten of them")
    parser.add_argument("--moments", help="names of moments, with commas; all otherwise")
    parser.add_argument("--program", default=os.path.join(HERE, "..", "..", "build", "bin", "tubetwin"))
    parser.add_argument("--table", action="store_true")
    choice = parser.parse_args()
    os.makedirs(choice.out, exist_ok=True)
    path = os.path.join(choice.out, "rows.jsonl")
    rows = []
    if os.path.exists(path):
        with open(path) as file:
            rows = [json.loads(line) for line in file]
    if choice.table:
        return table(rows)
    names = TENS if choice.only == "ten" else choice.only.split(",") if choice.only else list(FAULTS)
    done = {(r["fault"], r["moment"]) for r in rows}
    for moment in choice.moments.split(",") if choice.moments else MOMENTS:
        for name in names:
            if (name, moment) in done:
                continue
            row = one(os.path.abspath(choice.program), os.path.join(choice.out, "work"), name, moment, choice.rate)
            rows.append(row)
            with open(path, "a") as file:
                file.write(json.dumps(row) + "\n")
            print(name, moment, row["outcome"], row["after_s"], "; ".join(row["wrong"]), row["message"][:150], flush=True)
    wrong = [r for r in rows if r["wrong"]]
    print(f"{len(rows)} rounds, {len(wrong)} not as documented")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
