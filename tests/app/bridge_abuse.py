#!/usr/bin/env python3
"""bridge_abuse.py PROGRAM: garbage, half messages, wrong lengths and floods of connections on every port of `emulate`;
afterwards it serves normal clients as before."""

import os
import random
import socket
import struct
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "support"))
import motoman as yrc  # noqa: E402
from checks import check, finish  # noqa: E402
from emulation import Emulation, resident_MB  # noqa: E402
from motoman import h  # noqa: E402

PROGRAM = sys.argv[1]
FLOOD = 150
ACTIVATE = h("0001 0000 000d 09 10 03e8 0003 06 0100 0000 0000")
READ_STATUS = h("0002 0000 0006 09 03 07d0 0003")
RDT_ONE_RECORD = h("1234 0002 00000001")
GET_PAGE = b"GET /netftapi2.xml HTTP/1.0\r\n\r\n"


class Ports:
    def __init__(self, cell):
        arm = cell["arm"]
        self.motion, self.state, self.io = arm["motion_port"], arm["state_port"], arm["io_port"]
        self.gripper, self.http = cell["gripper"]["port"], cell["wrist"]["http_port"]
        self.hses, self.rdt = arm["hses_port"], cell["wrist"]["port"]
        # What each understands, to be cut short, lengthened and repeated. None of it moves anything.
        self.tcp = {self.motion: yrc.CHECK_MOTION_READY, self.state: yrc.PING, self.io: yrc.WRITE_OUT_1,
                    self.gripper: READ_STATUS, self.http: GET_PAGE}
        self.udp = {self.hses: yrc.HSES_STATUS, self.rdt: RDT_ONE_RECORD}


def bad_messages(message, random_):
    """What a port may be sent instead of `message`."""
    yield from (random_.randbytes(size) for size in (1, 4, 15, 16, 100, 1500, 20000))
    yield from (message[:size] for size in (1, 4, 5, len(message) // 2, len(message) - 1))
    for length in (0, -1, 1, 15, 17, 0x7FFFFFFF, -0x80000000):
        yield struct.pack("<i", length) + message[4:]
        yield message[:4] + struct.pack("!H", length & 0xFFFF) + message[6:]
    yield message * 50 + random_.randbytes(30)
    yield random_.randbytes(3) + message
    for _ in range(20):
        damaged = bytearray(message)
        damaged[random_.randrange(min(16, len(message)))] ^= 1 << random_.randrange(8)
        yield bytes(damaged)
    yield b"A" * 300000


def offend(ports):
    """Every bad message on a connection of its own, some of them left half open, some torn down."""
    random_ = random.Random(7)
    sent = 0
    for port, message in ports.tcp.items():
        for bad in bad_messages(message, random_):
            try:
                with yrc.connect(port, 5.0) as link:
                    link.settimeout(0.02)
                    if random_.random() < 0.3:
                        link.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
                    link.sendall(bad)
                    link.recv(4096)
            except (TimeoutError, ConnectionError):
                pass  # It may close on garbage, and need not answer.
            sent += 1
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as link:
        for port, message in ports.udp.items():
            for bad in bad_messages(message, random_):
                link.sendto(bad[:60000], ("127.0.0.1", port))
                link.sendto(b"", ("127.0.0.1", port))
                sent += 2
            for _ in range(3000):
                link.sendto(random_.randbytes(random_.randrange(200)), ("127.0.0.1", port))
            sent += 3000
    return sent


def flood(ports):
    """Many connections to each port at once: silent ones, half messages, and clients that never read."""
    links = []
    for port, message in ports.tcp.items():
        for k in range(FLOOD):
            link = socket.socket()
            link.settimeout(5.0)
            try:
                link.connect(("127.0.0.1", port))
                link.sendall((b"", message[:5], message * 3)[k % 3])
            except (TimeoutError, ConnectionError):
                pass  # One too many may be turned away.
            links.append(link)
    time.sleep(1.0)
    for link in links:
        link.close()
    return len(links)


def arm_serves(ports, state):
    motion = None
    for _ in range(40):  # The flood's last may still be being closed.
        try:
            motion = yrc.Motion(ports.motion)
            if yrc.ask(motion.link, yrc.PING, 16) == yrc.PING_REPLY:
                break
        except ConnectionError:
            pass
        time.sleep(0.1)
    check(motion.ask(yrc.START_TRAJECTORY_MODE) == yrc.STARTED_REPLY, "the arm is made ready")
    start, status = state.newest()
    check(status == yrc.STATUS_READY, "a state client is served: " + status.hex())
    goal = [start[0] + 0.02, *start[1:]]
    result = motion.stream([(0, 0.0, start, [0.0] * 6), (1, 0.6, goal, [0.0] * 6)])
    check(result == (yrc.SUCCESS, 0), f"points are taken: {result}")
    for _ in range(400):
        if abs(state.next()[0][0] - goal[0]) < 0.0005:
            break
    check(abs(state.newest()[0][0] - goal[0]) < 0.001, "and the arm goes there")
    with yrc.connect(ports.io) as io:
        check(yrc.ask(io, yrc.WRITE_OUT_1, 20) == yrc.WRITTEN_REPLY, "I/O is written")
    check(len(yrc.ask_hses(ports.hses, yrc.HSES_STATUS)) == 40, "HSES answers")


def others_serve(ports):
    with yrc.connect(ports.gripper) as link:
        check(yrc.ask(link, ACTIVATE, 12) == h("0001 0000 0006 09 10 03e8 0003"), "the gripper is activated")
        for _ in range(300):
            answer = yrc.ask(link, READ_STATUS, 15)
            if answer[9:10] == b"\x31":
                break
            time.sleep(0.05)
        check(answer[:10] == h("0002 0000 0009 09 03 06 31"), "and says so: " + answer.hex())
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as link:
        link.settimeout(10.0)
        link.sendto(RDT_ONE_RECORD, ("127.0.0.1", ports.rdt))
        record = link.recv(100)
        check(len(record) == 36 and record[:4] == h("00000001"), "one record: " + record.hex())
    with yrc.connect(ports.http) as link:
        page = yrc.ask(link, GET_PAGE, 1 << 16)
        check(page.startswith(b"HTTP/1.0 200 OK") and b"<scfgfu>N</scfgfu>" in page, "the page is served")


with tempfile.TemporaryDirectory() as top:
    emulation = Emulation(PROGRAM, top + "/e", overrides=["seed=3", "pile.count=1"], options=["--for", "600"])
    ports = Ports(emulation.devices())
    state = yrc.State(ports.state)
    state.next()
    before_mb = resident_MB(emulation.process.pid)
    bad, connections = offend(ports), flood(ports)
    check(emulation.process.poll() is None, "emulate still runs")
    moved = [e for e in emulation.events() if e.get("event") in ("arm moves", "open", "close")]
    check(not moved, f"nothing has moved: {moved}")
    # As with the controller, the flood has taken the first place, and the next one takes it back.
    state = yrc.State(ports.state)
    state.next()
    arm_serves(ports, state)
    others_serve(ports)
    doctor = subprocess.run([PROGRAM, "doctor", "--cell", emulation.cell], capture_output=True, text=True, timeout=120)
    check(doctor.returncode == 0, "doctor reads every device: " + doctor.stdout + doctor.stderr)
    after_mb = resident_MB(emulation.process.pid)
    check(after_mb < before_mb + 20, f"memory goes from {before_mb:.0f} to {after_mb:.0f} MB")
    emulation.stop()
    check(emulation.process.returncode == 0, f"emulate ends with {emulation.process.returncode}")
    print(f"{bad} bad messages, {connections} connections at once, {before_mb:.0f} MB before, {after_mb:.0f} after")
finish()
