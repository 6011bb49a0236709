# SPDX-License-Identifier: MIT
"""Generated hostile archives, in the same form as the models of attack_models."""
import random

import sample_files as samples
from attack_models import LENGTHS, OUTSIDE, damaged
from zip_files import Member, build, of_many_entries

GOOD = Member(b"good.obj", samples.obj())


def names(chance: random.Random):
    """Paths that lead out of the folder, old code pages, NUL, very long paths, duplicates."""
    name = chance.choice([b"../x.obj", b"/etc/x.obj", b"C:\\x.obj", b"a/../../../x.obj", b"..\\..\\x.obj", b"caf\x82.obj", b"\xff\xfe.obj", b"a\0b.obj", b"x" * 5000 + b".obj",
                          b"good.obj", b"GOOD.OBJ", b"\x1b[2J.obj", b"a/" * 3000 + b"x.obj", b".", b"..", b"", b"good.obj/x.obj", "\u202e".encode() + b".obj", b"./good.obj"])
    return build([GOOD, Member(name, samples.obj(), flags=chance.choice([0, 0x800]))])


def bombs(chance: random.Random):
    """Decompression bombs: small archives that unpack to much data; the short ones declare a small size."""
    size = chance.choice([600, 64, 8]) << 20
    lies = {} if chance.random() < 0.5 else {"size": 100}
    return build([GOOD, Member(b"bomb.obj", bytes(size), **lies)])


def overlapping(chance: random.Random):
    """Members with overlapping bytes, and one that overlaps the central directory."""
    many = chance.choice([2, 20, 200])
    return build([GOOD] + [Member(f"o{i}.obj".encode(), samples.obj(), offset=chance.choice([0, 7, -1 & 0xFFFFFFFF, 10 ** 6])) for i in range(many)])


def lies(chance: random.Random):
    fields = ["crc", "size", "packed_size", "method", "flags", "offset", "name_size", "extra_size", "attributes"]
    chosen = {chance.choice(["", "local_", "list_"]) + field if field in fields[:5] else field: chance.choice(LENGTHS) & (0xFFFF if field in fields[3:5] + fields[6:8] else 0xFFFFFFFF)
              for field in chance.sample(fields, chance.randrange(1, 3))}
    return build([Member(b"lie.obj", samples.obj(), **chosen), GOOD])


def ends(chance: random.Random):
    """Changes of the end record of the whole archive."""
    chosen = {field: chance.choice(LENGTHS) for field in chance.sample(["count", "list_offset", "list_size"], chance.randrange(1, 3))}
    return build([GOOD], disk=chance.choice([0, 0, 1, 0xFFFF]), comment=b"x" * chance.choice([0, 1, 65_535]), **chosen)


def truncated(chance: random.Random):
    whole = build([GOOD, Member(b"b.obj", samples.obj())])
    return whole[:chance.randrange(len(whole))]


def changed(chance: random.Random):
    return damaged(chance, build([GOOD, Member(b"b.mtl", samples.mtl("c.png")), Member(b"c.png", samples.png())]))


def links(chance: random.Random):
    """A symbolic link as a member, as Unix programs store it."""
    return build([GOOD, Member(b"link.obj", f"{OUTSIDE}/secret.obj".encode(), attributes=0o120777 << 16)])


def nested(chance: random.Random):
    inside = build([GOOD])
    for _ in range(chance.choice([1, 5, 50])):
        inside = build([GOOD, Member(chance.choice([b"in.zip", b"in.sh3f", b"in.jar"]), inside)])
    return inside


def catalogues(chance: random.Random):
    """Central directories with wrong entries."""
    number = chance.choice(["nan", "inf", "-1", "0", "1e308", "", "5e-324", "1,5", "abc", "50"])
    path = chance.choice(["/good.obj", f"{OUTSIDE}/secret.obj", "../good.obj", "/etc/passwd", "", "good.obj", "nothing.obj", "a" * 10_000, "\\u0000good.obj"])
    text = (f"id=c\nname={chance.choice(['x', chr(92) + 'u001b[2J', 'x' * 100_000, chr(92) + 'ud800'])}\nid#1=c#1\nname#1=Chair\ncategory#1=Kitchen\nmodel#1={path}\nicon#1={path}\n"
            f"width#1={number}\ndepth#1=5\nheight#1=5\nmovable#1=true\nmodelRotation#1={chance.choice(['', '1 0 0', ' '.join([number] * 9), '0 ' * 9])}\n")
    text *= chance.choice([1, 1, 3])
    if chance.random() < 0.3:
        text = damaged(chance, text.encode()).decode("latin-1")
    return build([GOOD, Member(b"PluginFurnitureCatalog.properties", text.encode("latin-1"))])


CLASSES = {names: ".zip", bombs: ".zip", overlapping: ".zip", lies: ".zip", ends: ".zip", truncated: ".zip", changed: ".zip", links: ".zip", nested: ".zip",
           catalogues: ".sh3f"}


def millions() -> bytes:
    """More members than are allowed: 1,000,001, in 50 MB."""
    return of_many_entries(1_000_001)
