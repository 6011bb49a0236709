# SPDX-License-Identifier: MIT
"""A server on a scene, and a viewer of it that speaks the WebSocket protocol with nothing but the standard library."""
import base64
import json
import os
import pathlib
import socket
import ssl
import struct
import subprocess
import tempfile

HEAD = struct.Struct("<IHHIIdQ")  # docs/protocol.md: magic, version, flags, records, point sets, time, step


class Server:
    """`embody serve` with a home folder of its own, on any free port."""

    def __init__(self, embody: str, database: str, scene: str):
        self.home = tempfile.TemporaryDirectory()
        self.words = [embody, "serve", "--port", "0", "--database", database, "--scene", scene]
        self.restart()

    def restart(self):
        """Starts the program, again after it has ended; on another port."""
        self.process = subprocess.Popen(self.words, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True,
                                        env={**os.environ, "XDG_DATA_HOME": self.home.name})
        line = self.process.stdout.readline()
        assert "http://127.0.0.1:" in line, f"embody serve did not start: {line!r}"
        self.port = int(line.rsplit(":", 1)[1].strip(" /\n"))

    def memory(self, peak: bool = False) -> int:
        """Resident memory in bytes, now or the maximum so far."""
        status = pathlib.Path(f"/proc/{self.process.pid}/status").read_text()
        return 1024 * int(next(line for line in status.splitlines() if line.startswith("VmHWM" if peak else "VmRSS")).split()[1])

    def close(self) -> int:
        self.process.terminate()
        self.process.communicate(timeout=60)
        self.home.cleanup()
        return self.process.returncode

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()


class Viewer:
    """One WebSocket. It reads only when asked to; messages wait in the system's buffers meanwhile."""

    def __init__(self, port: int, buffer: int = 0, context: ssl.SSLContext | None = None):
        self.socket = socket.socket()
        if buffer:
            self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, buffer)
        self.socket.connect(("127.0.0.1", port))
        if context:
            self.socket = context.wrap_socket(self.socket, server_hostname="127.0.0.1")
        self.socket.settimeout(300)
        key = base64.b64encode(os.urandom(16)).decode()
        self.socket.sendall((f"GET /ws HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
                             f"Sec-WebSocket-Key: {key}\r\nSec-WebSocket-Version: 13\r\n\r\n").encode())
        self.held = b""
        while b"\r\n\r\n" not in self.held:
            more = self.socket.recv(4096)
            if not more:
                raise ConnectionError("the server has hung up")
            self.held += more
        head, self.held = self.held.split(b"\r\n\r\n", 1)
        assert b" 101 " in head.split(b"\r\n", 1)[0], head
        self.commands = 0

    def _take(self, count: int) -> bytes:
        while len(self.held) < count:
            more = self.socket.recv(1 << 20)
            if not more:
                raise ConnectionError("the server has hung up")
            self.held += more
        taken, self.held = self.held[:count], self.held[count:]
        return taken

    def read(self):
        """The next message: a dict of JSON, or the bytes of a state frame."""
        while True:
            first, second = self._take(2)
            length = second & 127
            if length == 126:
                length = struct.unpack(">H", self._take(2))[0]
            elif length == 127:
                length = struct.unpack(">Q", self._take(8))[0]
            payload = self._take(length)
            kind = first & 15
            if kind == 1:
                return json.loads(payload)
            if kind == 2:
                return payload
            if kind == 9:
                self._send(10, payload)
            if kind == 8:
                raise ConnectionError("the server has closed the connection")

    def _send(self, kind: int, payload: bytes):
        head = bytes([128 | kind])
        size = len(payload)
        if size < 126:
            head += bytes([128 | size])
        else:
            head += bytes([254]) + struct.pack(">H", size) if size < 65536 else bytes([255]) + struct.pack(">Q", size)
        self.socket.sendall(head + bytes(4) + payload)

    def ask(self, command: str, **params):
        """Sends a command; does not wait for its reply."""
        self.commands += 1
        self._send(1, json.dumps({"id": self.commands, "command": command, "params": params}).encode())
        return self.commands

    def do(self, command: str, **params):
        """Sends a command and returns its result; messages before the reply are dropped."""
        asked = self.ask(command, **params)
        while True:
            message = self.read()
            if isinstance(message, dict) and message.get("id") == asked:
                assert message["ok"], message
                return message["result"]

    def close(self):
        self.socket.close()
