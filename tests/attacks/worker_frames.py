# SPDX-License-Identifier: MIT
"""The protocol between the importing program and its workers (src/catalog/prepare/worker_protocol.h), as a worker or as the program."""
import os
import pathlib
import struct
import subprocess

READY, ITEM, PREPARED, FAILED, OUT_OF_MEMORY = range(1, 6)
VERSION = 5


def hash_of(payload: bytes) -> int:
    value = 0xCBF29CE484222325
    for byte in payload:
        value = (value ^ byte) * 0x100000001B3 & 0xFFFFFFFFFFFFFFFF
    return value


def frame(kind: int, payload: bytes = b"", *, magic: bytes = b"EMBW", version: int = VERSION, length: int | None = None,
          checksum: int | None = None) -> bytes:
    return (magic + struct.pack("<III", version, kind, len(payload) if length is None else length) + payload +
            struct.pack("<Q", hash_of(payload) if checksum is None else checksum))


def text(value: str) -> bytes:
    return struct.pack("<Q", len(value.encode())) + value.encode()


def item(path: str, name: str = "t") -> bytes:
    """An ImportItem of a plain file."""
    texts = [path, "", path, "", name, "source", "licence", "author", "chair", ""]
    rotation = (1, 0, 0, 0, 1, 0, 0, 0, 1)
    return (b"".join(map(text, texts)) + struct.pack("<Q", 1) + text("tag") + struct.pack("<B3d", 0, 0, 0, 0) + struct.pack("<Bd", 0, 0) +
            struct.pack("<9d", *rotation) + struct.pack("<Q", 0) + bytes([0, 0]))


def failed(where: str, why: str) -> bytes:
    return text(where) + text(why) + text("")


def read_frame(stream) -> tuple[int, bytes]:
    head = stream.read(16)
    if len(head) < 16:
        raise EOFError
    _, _, kind, length = struct.unpack("<IIII", head)
    payload = stream.read(length)
    stream.read(8)
    return kind, payload


def prepare(worker: pathlib.Path, file: pathlib.Path) -> bytes:
    """The answer of a real worker for one file: the payload of `prepared`."""
    words = [str(worker), str(os.getpid()), str(2 << 30), str(file.parent)]
    with subprocess.Popen(words, stdin=subprocess.PIPE, stdout=subprocess.PIPE) as process:
        kind, _ = read_frame(process.stdout)
        assert kind == READY
        process.stdin.write(frame(ITEM, item(str(file))))
        process.stdin.flush()
        kind, payload = read_frame(process.stdout)
        process.stdin.close()
        assert kind == PREPARED, payload
        return payload
