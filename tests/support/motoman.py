"""A client of the arm's ports that knows nothing but the byte tables: no codec of this project is behind it.

simple_message is little-endian words: length, id, kind of message (1 topic, 2 request, 3 reply), reply code, body.
"""

import socket
import struct
import time

SUCCESS, BUSY, INVALID = 0, 1, 3
HSES_HEAD, HSES_ASKS = "59455243 2000 ", " 00000000 3939393939393939 "
HSES_ANSWERS = " 00000080 3939393939393939 "


def h(text):
    """Bytes from hex with blanks; `00*40` is forty zero bytes."""
    out = b""
    for word in text.split():
        byte, _, times = word.partition("*")
        out += bytes.fromhex(byte) * int(times or 1)
    return out


PING = h("0c000000 01000000 02000000 00000000")
PING_REPLY = h("0c000000 01000000 03000000 01000000")
_CONTROL = "40000000 d1070000 02000000 00000000 00000000 00000000 "
_CONTROL_REPLY = "48000000 d2070000 03000000 01000000 00000000 00000000 "
CHECK_MOTION_READY = h(_CONTROL + "a50d0300 00*40")
CHECK_QUEUE_COUNT = h(_CONTROL + "a60d0300 00*40")
STOP_MOTION = h(_CONTROL + "af0d0300 00*40")
START_TRAJECTORY_MODE = h(_CONTROL + "b90d0300 00*40")
STOP_TRAJECTORY_MODE = h(_CONTROL + "ba0d0300 00*40")
READY_REPLY = h(_CONTROL_REPLY + "a50d0300 00000000 00000000 00*40")
QUEUE_EMPTY_REPLY = h(_CONTROL_REPLY + "a60d0300 00000000 00000000 00*40")
STOPPED_REPLY = h(_CONTROL_REPLY + "af0d0300 00000000 00000000 00*40")
STARTED_REPLY = h(_CONTROL_REPLY + "b90d0300 00000000 00000000 00*40")
ENDED_REPLY = h(_CONTROL_REPLY + "ba0d0300 00000000 00000000 00*40")
POINT_0_REPLY = h("48000000 d2070000 03000000 01000000 00000000 00000000 0e000000 00000000 00000000 00*40")
POINT_1_REPLY = h("48000000 d2070000 03000000 01000000 00000000 01000000 0e000000 00000000 00000000 00*40")
BUSY_WITH_1_REPLY = h("48000000 d2070000 03000000 01000000 00000000 01000000 0e000000 01000000 00000000 00*40")
STATUS_READY = h("28000000 0d000000 01000000 00000000 "
                 "01000000 00000000 00000000 00000000 00000000 02000000 01000000")
WRITE_OUT_1 = h("14000000 d5070000 02000000 00000000 1a270000 01000000")
WRITTEN_REPLY = h("10000000 d6070000 03000000 01000000 00000000")
HSES_STATUS = h(HSES_HEAD + "0000 03 01 00 01" + HSES_ASKS + "7200 0100 00 01 0000")
HSES_STATUS_PLAY_SERVO_ON = h(HSES_HEAD + "0800 03 01 01 01" + HSES_ANSWERS + "81 00 00 00 0000 0000 c4000000 40000000")
HSES_PULSES = h(HSES_HEAD + "0000 03 01 00 02" + HSES_ASKS + "7500 0100 00 01 0000")
HSES_SERVO_ON = h(HSES_HEAD + "0400 03 01 00 04" + HSES_ASKS + "8300 0200 01 10 0000 01000000")
HSES_DONE = h(HSES_HEAD + "0000 03 01 01 04" + HSES_ANSWERS + "90 00 00 00 0000 0000")


def point(sequence, time_s, q, qd):
    """JOINT_TRAJ_PT_FULL: group, sequence, fields 7 (time, position, velocity), then 31 floats."""
    floats = [time_s, *q, *[0.0] * (10 - len(q)), *qd, *[0.0] * (10 - len(qd)), *[0.0] * 10]
    return struct.pack("<7i31f", 148, 14, 2, 0, 0, sequence, 7, *floats)


def connect(port, timeout_s=20.0):
    link = socket.create_connection(("127.0.0.1", port), timeout=timeout_s)
    link.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
    return link


def receive(link, size):
    """Exactly so many bytes; fewer when the other side closes."""
    out = b""
    while len(out) < size:
        more = link.recv(size - len(out))
        if not more:
            break
        out += more
    return out


def ask(link, message, size):
    link.sendall(message)
    return receive(link, size)


class Motion:
    """The motion port."""

    def __init__(self, port):
        self.link = connect(port)
        self.busy = 0

    def ask(self, message):
        """The 76 bytes of a motion reply."""
        return ask(self.link, message, 76)

    def result(self, message):
        """Result and subcode of the reply: words 4 and 5 of its body."""
        return struct.unpack_from("<2i", self.ask(message), 28)

    def stream(self, points):
        """Sends [(sequence, time_s, q, qd)], each again while the controller is busy; the first result that is
        neither success nor busy ends it."""
        for each in points:
            while True:
                result = self.result(point(*each))
                if result != (BUSY, 0):
                    break
                self.busy += 1
                time.sleep(0.005)
            if result[0] != SUCCESS:
                return result
        return SUCCESS, 0


class State:
    """The state port: joints (148 bytes) and status (44 bytes) in turn."""

    def __init__(self, port):
        self.link = connect(port)

    def next(self):
        """Six joint angles and the status message that follows them."""
        feedback, status = receive(self.link, 148), receive(self.link, 44)
        assert feedback[:16] == h("90000000 0f000000 01000000 00000000"), feedback[:16].hex()
        assert status[:16] == h("28000000 0d000000 01000000 00000000"), status[:16].hex()
        return list(struct.unpack_from("<6f", feedback, 28)), status

    def newest(self):
        """What comes after all that has been waiting here."""
        self.link.setblocking(False)
        try:
            left = 0
            while True:
                left = (left + len(self.link.recv(65536))) % 192
        except BlockingIOError:
            pass
        self.link.settimeout(20.0)
        receive(self.link, -left % 192)
        return self.next()


def ask_hses(port, datagram, tries=5):
    """The answer to a datagram of the High-Speed Ethernet Server."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as link:
        link.settimeout(2.0)
        for _ in range(tries):
            link.sendto(datagram, ("127.0.0.1", port))
            try:
                return link.recv(2048)
            except TimeoutError:
                pass
    return b""
