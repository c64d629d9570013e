"""Links in between a program and its devices, which change what a device says."""

import socket
import threading


def _pump(source, sink, change):
    while True:
        try:
            data = source.recv(65536)
        except OSError:
            data = b""
        if not data:
            for end in (source, sink):
                try:
                    end.shutdown(socket.SHUT_RDWR)
                except OSError:
                    pass
            return
        try:
            sink.sendall(change(data))
        except OSError:
            return


class TcpLink:
    """Passes on what a client says to `target`, a port of loopback; `change(bytes)` what it answers."""

    def __init__(self, target, change):
        self.listener = socket.create_server(("127.0.0.1", 0))
        self.port = self.listener.getsockname()[1]
        self.target, self.change = target, change
        threading.Thread(target=self._accept, daemon=True).start()

    def _accept(self):
        while True:
            client, _ = self.listener.accept()
            try:
                server = socket.create_connection(("127.0.0.1", self.target), timeout=10)
            except OSError:
                client.close()
                continue
            server.settimeout(None)
            for end in (client, server):
                end.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
            for ends in ((client, server, lambda data: data), (server, client, self.change)):
                threading.Thread(target=_pump, args=ends, daemon=True).start()


class UdpLink:
    """The same for datagrams, of one client."""

    def __init__(self, target, change):
        self.near = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.near.bind(("127.0.0.1", 0))
        self.port = self.near.getsockname()[1]
        self.far = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.far.connect(("127.0.0.1", target))
        self.client, self.change = None, change
        for work in (self._out, self._back):
            threading.Thread(target=work, daemon=True).start()

    def _out(self):
        while True:
            data, self.client = self.near.recvfrom(65536)
            try:
                self.far.send(data)
            except OSError:
                pass

    def _back(self):
        while True:
            try:
                data = self.far.recv(65536)
            except OSError:
                continue
            if self.client:
                self.near.sendto(self.change(data), self.client)
