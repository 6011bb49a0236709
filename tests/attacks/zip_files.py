# SPDX-License-Identifier: MIT
"""Zip archives whose fields can all be set to wrong values."""
import struct
import zlib


class Member:
    """One member; fields that are not given have their true values."""

    def __init__(self, name: bytes, content: bytes = b"", *, packed: bool = True, **fields):
        self.name, self.content, self.fields = name, content, fields
        if packed:
            worker = zlib.compressobj(9, zlib.DEFLATED, -15)
            self.data = worker.compress(content) + worker.flush()
        else:
            self.data = content
        self.method = 8 if packed else 0

    def common(self, where: str) -> bytes:
        """The fields that the local header and the central directory both have; `where` is "local" or "list", to change only one of them."""
        def field(name: str, true: int) -> int:
            return self.fields.get(f"{where}_{name}", self.fields.get(name, true))
        return struct.pack("<HHHHHIII", 20, field("flags", 0), field("method", self.method), 0, 0x21, field("crc", zlib.crc32(self.content)),
                           field("packed_size", len(self.data)) & 0xFFFFFFFF, field("size", len(self.content)) & 0xFFFFFFFF)


def build(members: list, *, comment: bytes = b"", count: int | None = None, list_offset: int | None = None, list_size: int | None = None,
          disk: int = 0) -> bytes:
    body, listed = b"", b""
    for member in members:
        extra = member.fields.get("extra", b"")
        offset = member.fields.get("offset", len(body))
        name = member.fields.get("local_name", member.name)
        body += (b"PK\3\4" + member.common("local") + struct.pack("<HH", len(name), member.fields.get("extra_size", len(extra))) + name + extra +
                 member.data)
        listed += (b"PK\1\2" + struct.pack("<H", 20) + member.common("list") +
                   struct.pack("<HHHHHII", member.fields.get("name_size", len(member.name)), member.fields.get("extra_size", len(extra)), 0, disk, 0,
                               member.fields.get("attributes", 0), offset & 0xFFFFFFFF) + member.name + extra)
    number = len(members) if count is None else count
    return body + listed + struct.pack("<4sHHHHIIH", b"PK\5\6", disk, disk, min(number, 0xFFFF), min(number, 0xFFFF),
                                       (len(listed) if list_size is None else list_size) & 0xFFFFFFFF,
                                       (len(body) if list_offset is None else list_offset) & 0xFFFFFFFF, len(comment)) + comment


def of_many_entries(count: int) -> bytes:
    """A central directory with so many entries, all with the same bytes: zip64, because the older form cannot count so far."""
    member = Member(b"a.obj", b"v 0 0 0\n", packed=False)
    one = build([member])
    split = one.index(b"PK\1\2")
    body, entry = one[:split], one[split:one.index(b"PK\5\6")]
    at, size = len(body), len(entry) * count
    end64 = struct.pack("<4sQHHIIQQQQ", b"PK\6\6", 44, 45, 45, 0, 0, count, count, size, at)
    locator = struct.pack("<4sIQI", b"PK\6\7", 0, at + size, 1)
    end = struct.pack("<4sHHHHIIH", b"PK\5\6", 0, 0, 0xFFFF, 0xFFFF, 0xFFFFFFFF, 0xFFFFFFFF, 0)
    return body + entry * count + end64 + locator + end
