"""Clients of an OpenIGTLink server that send garbage, flood it with requests, announce giant messages, do not read, or leave at once."""
import os
import socket
import struct
import threading
import time

HEADER = struct.Struct(">H12s20sQQQ")


class HostileClients:
    """Attacks the server at 127.0.0.1:port from six threads for the time of a `with` block."""
    def __init__(self, port):
        self.port, self.stop = port, threading.Event()
        acts = (self.garbage, self.flood, self.giant, self.slow, self.slow, self.brief)
        self.threads = [threading.Thread(target=self.repeat, args=(act,), daemon=True) for act in acts]

    def __enter__(self):
        for t in self.threads:
            t.start()
        return self

    def __exit__(self, *_):
        self.stop.set()
        for t in self.threads:
            t.join(60)

    def repeat(self, act):
        while not self.stop.is_set():
            try:
                with socket.create_connection(("127.0.0.1", self.port), timeout=1) as s:
                    act(s)
            except OSError:
                pass
            time.sleep(0.005)

    def garbage(self, s):
        for _ in range(20):
            s.sendall(os.urandom(5000))

    def flood(self, s):
        s.settimeout(0.2)
        while not self.stop.is_set():
            s.sendall(HEADER.pack(1, b"GET_TRANSFOR", b"ToolToWorld", 0, 0, 0) * 500)

    def giant(self, s):
        s.sendall(HEADER.pack(1, b"TRANSFORM", b"ToolToWorld", 0, 2**63, 0) + bytes(1000))
        s.recv(10)

    def slow(self, s):
        s.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 2048)
        self.stop.wait(2.0)

    def brief(self, s):
        s.shutdown(socket.SHUT_RDWR)
