#!/usr/bin/env python3
"""lying_devices.py PROGRAM [TEST...]: devices that say what is not so, and clients that should not be there, over the wire.

A link between program and emulated device changes what the device says from a moment of the pick on; truth is the
emulated cell's. tests/cycle/lying_devices_test.cc has the same without a wire, for many more lies."""

import os
import socket
import struct
import subprocess
import sys
import time

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "support"))
from checks import check, run_tests  # noqa: E402
from emulation import Emulation, Run  # noqa: E402
from links import TcpLink, UdpLink  # noqa: E402

PROGRAM = sys.argv[1]
RATE = 2
BIAS = struct.pack(">HHI", 0x1234, 0x42, 0)


def events_since(emulation, at_s):
    return [e["event"] for e in emulation.events() if "event" in e and e["at_s"] > at_s]


def now_s(emulation):
    return max((e["at_s"] for e in emulation.events()), default=0.0)


class Cell:
    """An emulated cell with links to wrist and gripper that lie once `lies` is set."""

    def __init__(self, folder, wrist=None, gripper=None, count=1):
        self.lies, self.kept = False, None
        self.emulation = Emulation(PROGRAM, folder + "/emulated", rate=RATE,
                                   overrides=["seed=3", f"pile.count={count}"])
        devices = self.emulation.devices()
        self.wrist, self.gripper = devices["wrist"]["port"], devices["gripper"]["port"]
        self.links = []
        if wrist:
            link = UdpLink(self.wrist, lambda data: self._records(data, wrist))
            self.links += ["--set", f"cell.wrist.port={link.port}"]
        if gripper:
            link = TcpLink(self.gripper, lambda data: self._status(data, gripper))
            self.links += ["--set", f"cell.gripper.port={link.port}"]

    def _records(self, data, change):
        if not self.lies:
            return data
        records = [data[i:i + 36] for i in range(0, len(data), 36)]
        return b"".join(r[:12] + change(self, r[12:]) for r in records)

    def _status(self, data, change):
        # Answers of six bytes to functions 3 and 4.
        if not self.lies or len(data) < 15 or data[7] not in (3, 4) or data[8] != 6:
            return data
        return data[:9] + change(data[9:15]) + data[15:]

    def command_gripper(self, *words):
        pdu = struct.pack(">BHHB", 16, 0x03E8, 3, 6) + struct.pack(">3H", *words)
        with socket.create_connection(("127.0.0.1", self.gripper), timeout=3) as client:
            client.sendall(struct.pack(">HHHB", 7, 0, len(pdu) + 1, 9) + pdu)
            client.recv(64)

    def bias_wrist(self):
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as client:
            client.sendto(BIAS, ("127.0.0.1", self.wrist))


def check_stops(folder, name, cell, says, at="carry", happens=None, may_open=False):
    """A round in which the lie begins, or something happens, ends with 69 and closed fingers."""
    emulation = cell.emulation
    run = Run(PROGRAM, emulation.cell, folder + "/run", cell.links)
    check(emulation.wait_for(at), f"{name}: the moment '{at}' comes")
    began_s = now_s(emulation)
    cell.lies = True
    if happens:
        happens()
    code, err = run.wait(120)
    time.sleep(0.5)
    check(code == 69, f"{name}: ends with 69: {code} {err}")
    check(says in err, f"{name}: says '{says}': {err}")
    check(may_open or "open" not in events_since(emulation, began_s), f"{name}: nothing opens")
    emulation.stop()
    world = emulation.world()
    check(not world["placed_ids"], f"{name}: nothing is placed: {world}")
    if not may_open:
        check(world["held_ids"] == [1], f"{name}: the tube is held still: {world}")


def a_wrist_that_lies_over_the_tray(folder):
    def kept(cell, counts):
        cell.kept = cell.kept or counts
        return cell.kept

    lies = {
        "zero": (lambda cell, counts: bytes(24), "the same counts"),
        # The last bit varies: constant counts are another lie.
        "least": (lambda cell, counts: struct.pack(">6i", *[-2**31 + (counts[-1] & 1)] * 6), "its range ends at"),
        "stuck": (kept, "the same counts"),
        "halved": (lambda cell, counts: struct.pack(
            ">6i", *(c // 2 for c in struct.unpack(">6i", counts))), "wrist"),
    }
    for name, (lie, says) in lies.items():
        check_stops(f"{folder}/{name}", name, Cell(f"{folder}/{name}", wrist=lie), says)


def a_wrist_that_another_client_biases(folder):
    cell = Cell(folder)
    check_stops(folder, "biased", cell, "less than when they were empty", happens=cell.bias_wrist)


def a_gripper_that_another_client_opens(folder):
    cell = Cell(folder)
    check_stops(folder, "opened", cell, "another client commands the gripper", may_open=True,
                happens=lambda: cell.command_gripper(0x0900, 3, 0xFF20))


def a_gripper_that_says_that_it_is_empty(folder):
    def empty(status):
        return bytes([0xF9, 0, 0, status[3], 230, 0])

    cell = Cell(folder, gripper=empty)
    check_stops(folder, "empty", cell, "wrist and gripper disagree")


def what_a_killed_program_left_is_not_dropped(folder):
    cell = Cell(folder, count=3)
    emulation = cell.emulation
    run = Run(PROGRAM, emulation.cell, folder + "/first")
    check(emulation.wait_for("carry"), "a tube is carried")
    run.process.kill()
    run.wait(5)
    time.sleep(1.0)
    began_s = now_s(emulation)
    doctor = subprocess.run([PROGRAM, "doctor", "--cell", emulation.cell], capture_output=True, text=True, timeout=60)
    check(doctor.returncode == 69 and "press on something" in doctor.stdout,
          f"doctor tells of it: {doctor.returncode} {doctor.stdout}")
    code, err = Run(PROGRAM, emulation.cell, folder + "/second").wait(60)
    # Where the arm was killed in motion its controller is the first to say that something is left.
    said = "left there by an earlier program" in err or "an earlier connection has left motion" in err
    check(code == 69 and said, f"the next round does not begin: {code} {err}")
    left = "an earlier connection has left motion" in err
    check(("nobody commands" in doctor.stdout) == left, f"doctor tells of motion where some is left: {doctor.stdout}")
    time.sleep(0.5)
    check(not {"open", "arm moves"} & set(events_since(emulation, began_s)), "nothing moves")
    emulation.stop()
    check(len(emulation.world()["held_ids"]) == 1, f"it is held still: {emulation.world()}")


def a_faulty_gripper_that_holds_is_not_activated(folder):
    fault = '[[fault]]\non = "carry"\ndelay_s = 0.3\ndevice = "gripper"\naction = "fault"\nvalue = 14\n'
    emulation = Emulation(PROGRAM, folder + "/emulated", rate=RATE, overrides=["seed=3", "pile.count=2"], faults=fault)
    code, err = Run(PROGRAM, emulation.cell, folder + "/first").wait(120)
    check(code == 69, f"the fault ends the round: {code} {err}")
    time.sleep(1.0)
    began_s = now_s(emulation)
    code, err = Run(PROGRAM, emulation.cell, folder + "/second").wait(60)
    check(code == 69 and "may hold something" in err, f"the next one does not activate it: {code} {err}")
    activated = subprocess.run([PROGRAM, "doctor", "--activate-gripper", "--yes", "--cell", emulation.cell],
                               capture_output=True, text=True, timeout=60, stdin=subprocess.DEVNULL)
    check(activated.returncode == 69 and "nothing was moved" in activated.stderr,
          f"nor when asked to: {activated.returncode} {activated.stderr}")
    check("open" not in events_since(emulation, began_s), "nothing opens")
    emulation.stop()
    check(len(emulation.world()["held_ids"]) == 1, f"it is held still: {emulation.world()}")


def one_owner(folder):
    emulation = Emulation(PROGRAM, folder + "/emulated", rate=RATE, overrides=["seed=3", "pile.count=1"])
    run = Run(PROGRAM, emulation.cell, folder + "/run")
    check(emulation.wait_for("carry"), "a tube is carried")
    doctor = subprocess.run([PROGRAM, "doctor", "--cell", emulation.cell], capture_output=True, text=True, timeout=60)
    mine = f"process {run.process.pid} ({os.path.basename(PROGRAM)} run"
    check(doctor.returncode == 0 and mine in doctor.stdout, f"doctor leaves it alone: {doctor.stdout}")
    check("nobody commands" not in doctor.stdout, f"and says whose motion it is: {doctor.stdout}")
    code, err = Run(PROGRAM, emulation.cell, folder + "/second").wait(60)
    check(code == 75 and mine in err, f"a second round is refused by name: {code} {err}")
    code, err = run.wait(120)
    check(code == 0, f"the first goes on to its end: {code} {err}")
    emulation.stop()
    check(emulation.world()["placed_ids"] == [1], "and places its tube")


def one_datagram_does_not_end_the_camera(folder):
    emulation = Emulation(PROGRAM, folder + "/emulated", rate=RATE, overrides=["seed=3", "pile.count=1"],
                          options=["--gige"])
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as client:
        client.sendto(bytes.fromhex("420100800004000100012000"), ("127.0.0.1", 3956))
        client.settimeout(3)
        check(client.recv(64)[:4] == bytes.fromhex("80030081"), "such a register is refused")
    code, err = Run(PROGRAM, emulation.cell, folder + "/run").wait(120)
    check(code == 0, f"the round goes on: {code} {err}")
    emulation.stop()


TESTS = [a_wrist_that_lies_over_the_tray, a_wrist_that_another_client_biases,
         a_gripper_that_another_client_opens, a_gripper_that_says_that_it_is_empty,
         what_a_killed_program_left_is_not_dropped, a_faulty_gripper_that_holds_is_not_activated,
         one_owner, one_datagram_does_not_end_the_camera]
run_tests(*(test for test in TESTS if not sys.argv[2:] or test.__name__ in sys.argv[2:]))
