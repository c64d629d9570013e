"""What really goes over the wire, seen from outside: packets of a network that holds nothing but a test, and the sockets
of processes."""

import ctypes
import os
import socket
import struct
import subprocess
import sys
import threading

LOOPBACK = 0x7F000001


def alone_or_exit():
    """Runs this program again in a network namespace of its own, where every packet to anywhere goes over `lo`. Exits
    with 77 where such a network cannot be had."""
    if os.environ.get("BRIDGE_WIRE_ALONE"):
        subprocess.run("ip link set lo up && ip route add default dev lo", shell=True, check=True)
        return
    tried = subprocess.run(["unshare", "--net", "--map-root-user", "ip", "link", "set", "lo", "up"], capture_output=True,
                           text=True)
    if tried.returncode != 0:
        print("SKIPPED: no network namespace can be made, so nobody has watched the wire:", tried.stderr)
        sys.exit(77)
    os.environ["BRIDGE_WIRE_ALONE"] = "yes"
    os.execvp("unshare", ["unshare", "--net", "--map-root-user", sys.executable, *sys.argv])


# Classic packet filters, which see a packet from its IP header on; 0xFFFF takes it, 0 leaves it.
_TAKE, _LEAVE = (0x06, 0, 0, 0xFFFF), (0x06, 0, 0, 0)
_OUTGOING_ONLY = [(0x20, 0, 0, 0xFFFFF004), (0x15, 1, 0, 4), _LEAVE]  # ld type; jeq outgoing
# All but IPv4 to 127.0.0.1: ldb [0]; and 0xF0; jeq 0x40; ld [16]; jeq loopback.
_STRAYS = [(0x30, 0, 0, 0), (0x54, 0, 0, 0xF0), (0x15, 0, 2, 0x40), (0x20, 0, 0, 16), (0x15, 1, 0, LOOPBACK), _TAKE,
           _LEAVE]
# Many and small, a sensor's records: UDP of at most 64 bytes. ldb [9]; jeq UDP; ldh [2]; jgt 64.
_SMALL = [(0x30, 0, 0, 9), (0x15, 0, 3, 17), (0x28, 0, 0, 2), (0x25, 1, 0, 64), _TAKE, _LEAVE]
_OTHERS = [*_SMALL[:4], _LEAVE, _TAKE]


class _Tap:
    """Keeps the packets that a filter takes. Each has a queue of its own in the kernel."""

    def __init__(self, instructions):
        self.packets, self.lost, self._done = [], 0, threading.Event()
        self._link = socket.socket(socket.AF_PACKET, socket.SOCK_DGRAM, socket.htons(3))  # All protocols.
        self._link.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1 << 24)
        instructions = _OUTGOING_ONLY + instructions
        code = ctypes.create_string_buffer(b"".join(struct.pack("HBBI", *each) for each in instructions))
        self._link.setsockopt(socket.SOL_SOCKET, 26,  # SO_ATTACH_FILTER
                              struct.pack("HL", len(instructions), ctypes.addressof(code)))
        self._link.settimeout(0.2)
        self._thread = threading.Thread(target=self._listen, daemon=True)
        self._thread.start()

    def _listen(self):
        while True:
            try:
                self.packets.append(self._link.recv(1 << 17))
            except TimeoutError:
                if self._done.is_set():
                    return

    def close(self):
        self._done.set()
        self._thread.join()
        self.lost = struct.unpack("2I", self._link.getsockopt(263, 6, 8))[1]  # SOL_PACKET, PACKET_STATISTICS
        self._link.close()


class Wire:
    """Listens to all packets from here on. What was sent is known after close(); `lost` are the packets of streams and
    requests that were too many to be kept."""

    def __init__(self):
        self.streams, self.datagrams = {}, {}
        self._strays, self._small, self._others = (_Tap(each) for each in (_STRAYS, _SMALL, _OTHERS))

    @property
    def strays(self):
        """Packets to any address but 127.0.0.1."""
        return self._strays.packets

    def close(self):
        for tap in (self._strays, self._small, self._others):
            tap.close()
        self.packets, self.lost = len(self._small.packets) + len(self._others.packets), self._others.lost
        for packet in self._small.packets + self._others.packets:
            self._sort(packet)

    def _sort(self, packet):
        head = (packet[0] & 15) * 4
        size, = struct.unpack_from("!H", packet, 2)
        if packet[9] == socket.IPPROTO_UDP:
            ports = struct.unpack_from("!2H", packet, head)
            self.datagrams.setdefault(ports, []).append(packet[head + 8:size])
        elif packet[9] == socket.IPPROTO_TCP:
            source, target, sequence = struct.unpack_from("!2HI", packet, head)
            payload = packet[head + (packet[head + 12] >> 4) * 4:size]
            if payload:
                self.streams.setdefault((source, target), {})[sequence] = payload

    def sent(self, source=None, target=None):
        """All bytes of TCP streams from, to a port, a stream after another, each in its order."""
        return b"".join(b"".join(parts[at] for at in sorted(parts)) for ports, parts in self.streams.items()
                        if source in (None, ports[0]) and target in (None, ports[1]))

    def sent_datagrams(self, source=None, target=None):
        return [each for ports, all_of in self.datagrams.items() for each in all_of
                if source in (None, ports[0]) and target in (None, ports[1])]


def inet_sockets(pid):
    """[(protocol, local, remote)] of a process, addresses as (text, port), remote port 0: none; of one that is gone []."""
    found = []
    try:
        inodes = {link[8:-1] for link in map(_target, os.scandir(f"/proc/{pid}/fd")) if link.startswith("socket:[")}
        for protocol in ("tcp", "tcp6", "udp", "udp6", "raw", "raw6"):
            with open(f"/proc/{pid}/net/{protocol}") as table:
                rows = [line.split() for line in table][1:]
            found += [(protocol, _address(row[1]), _address(row[2])) for row in rows if row[9] in inodes]
    except FileNotFoundError:
        return []
    return found


def _target(descriptor):
    try:
        return os.readlink(descriptor.path)
    except FileNotFoundError:
        return ""


def _address(word):
    address, port = word.split(":")
    data = b"".join(struct.pack("=I", int(address[i:i + 8], 16)) for i in range(0, len(address), 8))
    family = socket.AF_INET if len(data) == 4 else socket.AF_INET6
    return socket.inet_ntop(family, data), int(port, 16)
