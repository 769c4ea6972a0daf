"""A daemon like spacenavd on a Unix socket, which sends what a test wants, at the rate of a device."""
import os
import socket
import struct
import threading
import time

ASK_PROTOCOL, ASK_TYPE = 0x7FAA5500, 0x7FAA2005
SPACE_MOUSE_PRO = 0x20A


class FakeSpacenavd:
    def __init__(self, path, device=SPACE_MOUSE_PRO):
        self.path, self.device = path, device
        self.clients = []
        if os.path.exists(path):
            os.remove(path)
        self.listens = socket.socket(socket.AF_UNIX)
        self.listens.bind(path)
        self.listens.listen(8)
        threading.Thread(target=self.accept, daemon=True).start()

    def accept(self):
        while True:
            try:
                client, _ = self.listens.accept()
            except OSError:
                return
            threading.Thread(target=self.serve, args=(client,), daemon=True).start()

    def serve(self, client):
        try:
            if client.recv(4, socket.MSG_WAITALL) != struct.pack("=i", ASK_PROTOCOL | 1):
                return client.close()  # only looked whether the daemon is there
            client.sendall(struct.pack("=i", ASK_PROTOCOL | 1))
            self.clients.append(client)
            while len(client.recv(32, socket.MSG_WAITALL)) == 32:
                client.sendall(struct.pack("=8i", ASK_TYPE, self.device or 0, 0, 0, 0, 0, 0, 0 if self.device else -1))
        except OSError:
            pass
        if client in self.clients:
            self.clients.remove(client)

    def send(self, *numbers):
        for client in list(self.clients):
            try:
                client.sendall(struct.pack("=8i", *numbers))
            except OSError:
                pass

    def motion(self, *axes):
        self.send(0, *axes, 16)

    def push(self, axes, seconds):
        """The cap is deflected so long, and then at rest."""
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            self.motion(*axes)
            time.sleep(0.008)
        self.motion(0, 0, 0, 0, 0, 0)

    def button(self, number, down):
        self.send(1 if down else 2, number, 0, 0, 0, 0, 0, 0)

    def flood(self, seconds):
        """Motion and garbage, as much as the socket takes; then it hangs up."""
        end, packet = time.monotonic() + seconds, struct.pack("=8i", 0, 0, 0, 0, 0, 0, 0, 16) * 512
        for client in list(self.clients):
            client.setblocking(False)
            while time.monotonic() < end:
                try:
                    client.send(packet)
                except BlockingIOError:
                    time.sleep(0.001)
                except OSError:
                    break
            client.setblocking(True)

    def stop(self, keeps_file=False):
        self.listens.shutdown(socket.SHUT_RDWR)
        self.listens.close()
        for client in list(self.clients):
            client.shutdown(socket.SHUT_RDWR)
            client.close()
        self.clients = []
        if not keeps_file:
            os.remove(self.path)
