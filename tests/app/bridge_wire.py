#!/usr/bin/env python3
"""bridge_wire.py PROGRAM: what goes over the wire between pipeline and emulated devices, byte for byte, seen from outside.
It runs in a network of its own, in which every packet to any address would be seen. 77 says that it cannot be had."""

import os
import socket
import struct
import sys
import time

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "support"))
import motoman as yrc  # noqa: E402
from checks import check, run_tests  # noqa: E402
from emulation import Emulation, Run  # noqa: E402
from motoman import h  # noqa: E402
from wire import Wire, alone_or_exit, inet_sockets  # noqa: E402

PROGRAM = sys.argv[1]
ONE_TUBE = ["seed=3", "pile.count=1"]
BOUNDED = ["--for", "1200"]  # Should this test be killed.


def pdu(link, slave, request):
    """The answer of a Modbus TCP slave to a request, both without their head."""
    link.sendall(struct.pack("!3HB", 7, 0, len(request) + 1, slave) + request)
    head = yrc.receive(link, 7)
    check(len(head) == 7 and head[:4] == h("0007 0000") and head[6] == slave, f"Modbus head {head.hex()}")
    return yrc.receive(link, struct.unpack("!H", head[4:6])[0] - 1) if len(head) == 7 else b""


def raw_client_drives_the_arm(folder):
    """Nothing but the byte tables: readies, streams points, is refused, watches it move."""
    emulation = Emulation(PROGRAM, folder + "/e", overrides=ONE_TUBE, options=BOUNDED)
    arm = emulation.devices()["arm"]
    state, motion = yrc.State(arm["state_port"]), yrc.Motion(arm["motion_port"])
    check(yrc.ask(motion.link, yrc.PING, 16) == yrc.PING_REPLY, "PING")
    check(motion.result(yrc.CHECK_MOTION_READY) == (2, 5006), "drives are off at first")
    refused = motion.ask(yrc.point(0, 0.0, [0.0] * 6, [0.0] * 6))
    check(struct.unpack_from("<2i", refused, 28) == (5, 5006), "no point before the mode: " + refused.hex())
    check(motion.ask(yrc.START_TRAJECTORY_MODE) == yrc.STARTED_REPLY, "START_TRAJ_MODE")
    check(motion.ask(yrc.CHECK_MOTION_READY) == yrc.READY_REPLY, "CHECK_MOTION_READY")
    start, status = state.newest()
    check(status == yrc.STATUS_READY, "ready status: " + status.hex())
    still = [0.0] * 6
    elsewhere = [start[0] + 0.01, *start[1:]]
    check(motion.result(yrc.point(0, 0.0, elsewhere, still)) == (yrc.INVALID, 3011), "3011: starts elsewhere")
    check(motion.result(yrc.point(0, 0.0, start, [9.0] * 6)) == (yrc.INVALID, 3013), "3013: too fast")
    check(motion.ask(yrc.point(0, 0.0, start, still)) == yrc.POINT_0_REPLY, "point 0")
    # More than the queue of 200 increments of 4 ms takes, so the next point is too early.
    away = [start[0] + 0.05, *start[1:]]
    check(motion.ask(yrc.point(1, 1.6, away, still)) == yrc.POINT_1_REPLY, "point 1")
    check(motion.ask(yrc.point(1, 3.2, start, still)) == yrc.BUSY_WITH_1_REPLY, "BUSY")
    moved = []
    back = motion.stream([(2, 1.6 + 0.1 * k, [start[0] + 0.05 - 0.05 * (k / 16) ** 2 * (3 - 2 * k / 16), *start[1:]],
                           [-0.05 * 6 * (k / 16) * (1 - k / 16) / 1.6, *still[1:]]) for k in range(1, 17)])
    check(back == (yrc.SUCCESS, 0), f"points that are streamed: {back}")
    while len(moved) < 400:
        joints, status = state.next()
        moved.append(joints)
        if status[32:36] == h("00000000") and motion.ask(yrc.CHECK_QUEUE_COUNT) == yrc.QUEUE_EMPTY_REPLY:
            break
    check(abs(max(q[0] for q in moved) - start[0] - 0.05) < 0.001, "the state port shows it go")
    check(max(abs(a - b) for a, b in zip(state.newest()[0], start)) < 0.001, "and come back")
    check(all(max(abs(q[i] - start[i]) for i in range(1, 6)) < 0.001 for q in moved), "others stand still")
    check(motion.busy > 0, "some points were too early")
    check(motion.ask(yrc.STOP_MOTION) == yrc.STOPPED_REPLY, "STOP_MOTION")
    check(motion.ask(yrc.STOP_TRAJECTORY_MODE) == yrc.ENDED_REPLY, "STOP_TRAJ_MODE")
    supervise(arm, state)
    emulation.stop()


def supervise(arm, state):
    """I/O and HSES, the documented bytes."""
    with yrc.connect(arm["io_port"]) as io:
        check(yrc.ask(io, yrc.WRITE_OUT_1, 20) == yrc.WRITTEN_REPLY, "OUT#1")
    check(yrc.ask_hses(arm["hses_port"], yrc.HSES_SERVO_ON) == yrc.HSES_DONE, "HSES: servo on")
    answer = yrc.ask_hses(arm["hses_port"], yrc.HSES_STATUS)
    check(answer == yrc.HSES_STATUS_PLAY_SERVO_ON, "HSES: status " + answer.hex())
    position = yrc.ask_hses(arm["hses_port"], yrc.HSES_PULSES)
    check(len(position) == 32 + 52, "HSES: position " + position.hex())
    pulses = struct.unpack_from("<6i", position, 32 + 20)
    joints = [q * 57.29577951308232 * 1000 for q in state.newest()[0]]
    check(max(abs(a - b) for a, b in zip(pulses, joints)) < 5, f"HSES: pulses {pulses}, joints {joints}")


def listens_on_loopback_only(emulation):
    of = inet_sockets(emulation.process.pid)
    cell = emulation.devices()
    expected = {cell["arm"][p] for p in ("motion_port", "state_port", "io_port", "hses_port")}
    expected |= {cell["gripper"]["port"], cell["wrist"]["port"], cell["wrist"]["http_port"]}
    listening = {local[1] for _, local, remote in of if remote[1] == 0}
    # One more: where files of the high-speed Ethernet server are refused, next to it or any free port.
    check(expected <= listening and len(listening - expected) == 1,
          f"emulate listens on {listening}, cell.toml says {expected}")
    check(all(local[0] == "127.0.0.1" for _, local, _ in of), f"on the loopback address alone: {of}")


def frames_of_a_round(folder):
    """A round over the wire: documented frames in it, and not a packet to anywhere else."""
    wire = Wire()
    # The watch sees what it should: a packet to elsewhere is one.
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        probe.sendto(b"to elsewhere", ("192.0.2.1", 9))
    time.sleep(0.5)
    check(len(wire.strays) == 1 and b"to elsewhere" in wire.strays[0], f"the watch sees a stray: {wire.strays}")
    wire.strays.clear()
    emulation = Emulation(PROGRAM, folder + "/e", rate=2, overrides=ONE_TUBE, options=BOUNDED)
    listens_on_loopback_only(emulation)
    # Not the watchdogs are tested here: a busy machine may be late.
    patient = [w for device in ("arm", "wrist", "gripper") for w in ("--set", f"cell.safety.{device}_silence_s=4")]
    run = Run(PROGRAM, emulation.cell, folder + "/r", patient)
    seen = set()
    while run.process.poll() is None:
        seen |= {(protocol, *remote) for protocol, _, remote in inet_sockets(run.process.pid)}
        time.sleep(0.2)
    code, err = run.wait(300)
    check(code == 0, f"the round ends with 0: {code} {err}")
    listens_on_loopback_only(emulation)
    cell = emulation.devices()
    emulation.stop()
    wire.close()
    print(f"{wire.packets} packets; run connected to {sorted(seen)}", flush=True)
    arm, gripper, wrist = cell["arm"], cell["gripper"], cell["wrist"]
    check(wire.lost == 0, f"the watch has missed {wire.lost} packets")
    check(not wire.strays, f"packets to elsewhere: {[p.hex() for p in wire.strays[:3]]}")
    check({a for _, a, port in seen if port} == {"127.0.0.1"}, f"run talks to the loopback address alone: {seen}")
    check({p for _, _, p in seen if p} - {wrist["http_port"]} <=
          {arm["motion_port"], arm["state_port"], arm["io_port"], arm["hses_port"], gripper["port"], wrist["port"]},
          f"to the cell file's ports alone: {seen}")
    check_arm_frames(wire, arm)
    check_gripper_frames(wire, gripper["port"])
    check_wrist_frames(wire, wrist)


def messages(stream, sizes):
    """simple_message's messages of a stream; controls and their replies with sequence 0, as the byte tables have them."""
    out = []
    while len(stream) >= 16:
        length, kind = struct.unpack_from("<2i", stream)
        message, stream = stream[:length + 4], stream[length + 4:]
        if len(message) != sizes.get(kind):
            check(False, f"a message that no table holds: {message[:64].hex()}")
            break
        if kind in (2001, 2002) and message[24:28] != h("0e000000"):
            message = message[:20] + bytes(4) + message[24:]
        out.append(message)
    return out


def check_arm_frames(wire, arm):
    asked = messages(wire.sent(target=arm["motion_port"]), {1: 16, 14: 152, 2001: 68})
    answered = messages(wire.sent(source=arm["motion_port"]), {1: 16, 2002: 76})
    for name in ("PING", "CHECK_MOTION_READY", "START_TRAJECTORY_MODE", "STOP_TRAJECTORY_MODE"):
        check(getattr(yrc, name) in asked, name + " of the driver")
    for name in ("PING_REPLY", "STARTED_REPLY", "ENDED_REPLY", "POINT_0_REPLY", "POINT_1_REPLY"):
        check(getattr(yrc, name) in answered, name + " of the controller")
    check(yrc.STATUS_READY in wire.sent(source=arm["state_port"]), "ready status on the state port")
    check(len([m for m in asked if len(m) == 152]) > 100, "points were streamed")
    check(len(asked) == len(answered), f"{len(asked)} requests have {len(answered)} answers")


def check_gripper_frames(wire, port):
    """RTU's examples without slave and check sum, which Modbus TCP has not."""
    asked, answered = wire.sent(target=port), wire.sent(source=port)
    for name, frame in (("set rACT", "10 03E8 0003 06 0100 0000 0000"), ("read", "03 07D0 0003")):
        check(h(frame) in asked, f"gripper: {name}")
    check(h("09 03 06 31 00") in answered, "gripper: activation done")
    check(h("09 10 03E8 0003") in answered, "gripper: a write's answer")
    # gACT, gGTO, gSTA 3, gOBJ 2: an object held while closing.
    check(h("09 03 06 B9 00 00") in answered, "gripper: an object held")


def check_wrist_frames(wire, wrist):
    asked = wire.sent_datagrams(target=wrist["port"])
    check(asked and asked[0] == h("1234 0002 00000000"), f"RDT starts: {[a.hex() for a in asked[:1]]}")
    check(asked and asked[-1] == h("1234 0000 00000000"), f"RDT stops: {[a.hex() for a in asked[-1:]]}")
    records = wire.sent_datagrams(source=wrist["port"])
    check(len(records) > 1000 and {len(r) for r in records} == {36}, "RDT: records of 36 bytes")
    check(b"GET /netftapi2.xml HTTP/1." in wire.sent(target=wrist["http_port"]), "the box's page is read")


alone_or_exit()
run_tests(raw_client_drives_the_arm, frames_of_a_round)
