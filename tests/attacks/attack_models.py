# SPDX-License-Identifier: MIT
"""Generated hostile models. Each class is a function of a random generator that returns one file: its extension and its bytes.
OUTSIDE names a folder outside of the imported one; its texts contain SECRET, which must never come into a database."""
import json
import pathlib
import random
import struct

import sample_files as samples

SECRET = "OUTSIDE-SECRET-7261"
OUTSIDE = pathlib.PurePosixPath("../outside")

LENGTHS = [0, 1, 3, 4, 12, 0x7F, 0xFFFF, 0x10000, 0x7FFFFFFF, 0x80000000, 0xFFFFFFFE, 0xFFFFFFFF]
JSON_NUMBERS = ["-1", "0", "1e308", "-1e308", "1e999", "4294967295", "4294967296", "18446744073709551616", "0.5", "null", "NaN", "Infinity", "\"1\"", "true",
                "[]", "{}", "9007199254740993", "2147483648"]
NUMERALS = ["nan", "inf", "-inf", "1e308", "-1e308", "1e999", "1e-320", "0x10", "1.2.3", "--1", "99999999999999999999999999", "", "1e", "٣"]


def damaged(chance: random.Random, content: bytes) -> bytes:
    """Random changes of bytes, blocks and the end."""
    data = bytearray(content)
    for _ in range(chance.choice([1, 1, 2, 4, 16])):
        at = chance.randrange(len(data)) if data else 0
        way = chance.randrange(6)
        if way == 0 and data:
            data[at] = chance.randrange(256)
        elif way == 1:
            data[at:at + 4] = struct.pack(chance.choice("<>") + "I", chance.choice(LENGTHS))
        elif way == 2:
            del data[at:at + chance.randrange(1, 40)]
        elif way == 3:
            data[at:at] = data[at // 2:at // 2 + chance.randrange(1, 60)]
        elif way == 4:
            data[at:at + 1] = chance.choice(NUMERALS).encode()
        elif chance.random() < 0.3:
            del data[at:]
    return bytes(data)


def any_place(chance: random.Random, value, wanted=(int, float, str, list, dict)):
    """(container, key) of a random value inside a JSON document."""
    places = []

    def walk(inside):
        for key, child in (inside.items() if isinstance(inside, dict) else enumerate(inside)):
            if isinstance(child, wanted):
                places.append((inside, key))
            if isinstance(child, (dict, list)):
                walk(child)
    walk(value)
    return chance.choice(places)


def outside_path(chance: random.Random, name: str) -> str:
    way = chance.randrange(8)
    plain = f"{OUTSIDE}/{name}"
    return [plain, "/etc/passwd", "file:///etc/passwd", plain.replace("/", "\\"), "./a/../../outside/" + name, "%2e%2e/outside/" + name,
            "http://127.0.0.1:9/" + name, "//localhost/c$/" + name][way]


def gltf_fields(chance: random.Random):
    """Exchanges a field of any kind; in the text, because Python does not write such numbers."""
    document = samples.gltf_document(samples.data_uri(samples.gltf_buffer()), samples.png())
    for _ in range(chance.randrange(1, 4)):
        inside, key = any_place(chance, document)
        inside[key] = f"@{chance.choice(JSON_NUMBERS)}@"
    text = json.dumps(document)
    for number in JSON_NUMBERS:
        text = text.replace(json.dumps(f"@{number}@"), number)
    return ".gltf", text.encode()


def gltf_outside(chance: random.Random):
    document = samples.gltf_document(samples.data_uri(samples.gltf_buffer()), samples.png())
    if chance.random() < 0.5:
        document["buffers"][0]["uri"] = outside_path(chance, "secret.bin")
    else:
        document["images"][0]["uri"] = outside_path(chance, "secret.png")
    return ".gltf", json.dumps(document).encode()


def gltf_nodes(chance: random.Random):
    """Cycles, deep nesting, large numbers of nodes."""
    document = samples.gltf_document(samples.data_uri(samples.gltf_buffer()))
    count = chance.choice([1, 2, 50, 3000, 20000])
    way = chance.randrange(4)
    nodes = [{"mesh": 0} for _ in range(count)]
    for i, node in enumerate(nodes):
        if way == 0:
            node["children"] = [(i + 1) % count]
        elif way == 1 and i + 1 < count:
            node["children"] = [i + 1]
        elif way == 2 and i + 1 < min(count, 24):
            node["children"] = [i + 1, i + 1]
        elif way == 3:
            node["children"] = [chance.choice([-1, count, 2 ** 31, 0])]
        if chance.random() < 0.01:
            node["matrix"] = [chance.choice([0, 1e308, -1, 1]) for _ in range(16)]
    document["nodes"] = nodes
    return ".gltf", json.dumps(document).encode()


def gltf_deep(chance: random.Random):
    depth = chance.choice([65, 1000, 100_000])
    opening, closing = chance.choice([("[", "]"), ('{"a":', "}")])
    text = samples.gltf().decode()
    return ".gltf", (text[:-1] + ', "extras": ' + opening * depth + "1" + closing * depth + "}").encode()


def glb_lengths(chance: random.Random):
    data = bytearray(samples.glb())
    binary = 20 + struct.unpack_from("<I", data, 12)[0]
    for _ in range(chance.randrange(1, 3)):
        struct.pack_into("<I", data, chance.choice([4, 8, 12, 16, binary, binary + 4]), chance.choice(LENGTHS + [len(data), len(data) + 1]))
    return ".glb", bytes(data)


def glb_numbers(chance: random.Random):
    """Points that are no numbers, indices out of range."""
    binary = bytearray(samples.gltf_buffer())
    for _ in range(chance.randrange(1, 6)):
        if chance.random() < 0.6:
            struct.pack_into("<f", binary, 4 * chance.randrange(12), chance.choice([float("nan"), float("inf"), -float("inf"), 3e38, -3e38, 1e-45]))
        else:
            struct.pack_into("<H", binary, 48 + 2 * chance.randrange(12), chance.choice([4, 255, 0xFFFF]))
    return ".glb", samples.join_glb(json.dumps(samples.gltf_document()).encode(), bytes(binary))


def obj_paths(chance: random.Random):
    way = chance.randrange(3)
    if way == 0:
        return ".obj", samples.obj().replace(b"v ", f"mtllib {outside_path(chance, 'secret.mtl')}\nusemtl {SECRET[:3]}\nv ".encode(), 1)
    if way == 1:
        return ".obj", b"mtllib " + b"../" * chance.choice([1, 40, 5000]) + b"etc/passwd\n" + samples.obj()
    return ".obj", b"mtllib textured.mtl\nusemtl wood\n" + samples.obj()


def obj_numbers(chance: random.Random):
    lines = samples.obj().decode().splitlines()
    for _ in range(chance.randrange(1, 5)):
        at = chance.randrange(len(lines))
        words = lines[at].split()
        words[chance.randrange(len(words))] = chance.choice(NUMERALS + ["-5", "0", "4294967296/1", "1//", "/", "2147483647/2147483647/2147483647", "v", "f"])
        lines[at] = " ".join(words)
    if chance.random() < 0.2:
        lines.append("f " + "1 " * chance.choice([2, 1000, 200_000]))
    return ".obj", "\n".join(lines).encode()


def ply_counts(chance: random.Random):
    form = chance.choice(["ascii", "binary_little_endian", "binary_big_endian"])
    count = str(chance.choice(LENGTHS + [2 ** 63, -1, 10 ** 30]))
    text = samples.ply(form)
    word = chance.choice([b"element vertex 4", b"element face 4"])
    return ".ply", text.replace(word, word[:-1] + count.encode())


def ply_headers(chance: random.Random):
    """Lines of the header repeated, removed, exchanged, and without an end."""
    head, body = samples.ply(chance.choice(["ascii", "binary_little_endian"])).split(b"end_header\n", 1)
    lines = head.split(b"\n")
    way = chance.randrange(5)
    if way == 0:
        lines[1:1] = [chance.choice(lines)] * chance.choice([1, 100, 100_000])
    elif way == 1:
        lines.pop(chance.randrange(len(lines)))
    elif way == 2:
        chance.shuffle(lines)
    elif way == 3:
        lines.insert(-1, b"property list " + chance.choice([b"float", b"char", b"double", b"list", b"int"]) + b" " + chance.choice([b"char", b"void", b"int"]) +
                     b" " + chance.choice([b"x", b"vertex_indices", b"y" * 10_000]))
    else:
        return ".ply", head + b"comment " + b"x" * chance.choice([10, 1_000_000])
    return ".ply", b"\n".join(lines) + b"end_header\n" + body


def ply_lists(chance: random.Random):
    """Faces with wrong lengths and with corners out of range."""
    faces = "".join(f"{chance.choice([-1, 0, 1, 2, 3, 4, 200, 255])} " + " ".join(str(chance.choice([0, 1, 2, 3, 4, -1, 2 ** 31])) for _ in range(chance.randrange(6))) +
                    "\n" for _ in range(4))
    points = "".join(f"{x} {y} {chance.choice([str(z)] * 6 + NUMERALS)} 9 8 7\n" for x, y, z in samples.POINTS)
    return ".ply", samples.ply_header("ascii") + (points + faces).encode()


def stl_sizes(chance: random.Random):
    count = chance.choice(LENGTHS + [3, 5, 85899345])
    data = samples.stl(count)
    return ".stl", chance.choice([data, data[:chance.randrange(len(data))], b"solid " + data[6:], data + bytes(chance.randrange(5000))])


def stl_numbers(chance: random.Random):
    data = bytearray(samples.stl())
    for _ in range(chance.randrange(1, 8)):
        struct.pack_into("<f", data, 84 + 50 * chance.randrange(4) + 4 * chance.randrange(12), chance.choice([float("nan"), float("inf"), 3.4e38, -3.4e38, 1e-45, 0]))
    return ".stl", bytes(data)


def ac3d_counts(chance: random.Random):
    text = samples.ac3d(chance.choice(["", outside_path(chance, "secret.png"), "wood.png"])).decode()
    for _ in range(chance.randrange(1, 3)):
        word, true = chance.choice([("kids ", "1"), ("kids ", "0"), ("numvert ", "4"), ("numsurf ", "4"), ("refs ", "3"), ("mat ", "0"), ("SURF ", "0x10")])
        text = text.replace(word + true, word + str(chance.choice(LENGTHS + [-1, 2, "x", "", "0x0", "0xFFFFFFFF"])), chance.choice([1, 99]))
    return ".ac", text.encode()


def ac3d_deep(chance: random.Random):
    depth = chance.choice([10, 1000, 30_000])
    group = "OBJECT group\nkids 1\n" * depth
    head, poly = samples.ac3d().decode().split("OBJECT poly", 1)
    return ".ac", (head + group + "OBJECT poly" + poly).encode()


def dae_entities(chance: random.Random):
    way = chance.randrange(4)
    if way == 0:
        lines = ['<!ENTITY a0 "x">'] + [f'<!ENTITY a{i} "{f"&a{i - 1};" * 10}">' for i in range(1, chance.choice([3, 9]))]
        doctype = "<!DOCTYPE COLLADA [" + "".join(lines) + "]>"
        return ".dae", samples.dae(f"<extra>&a{len(lines) - 1};</extra>", doctype)
    if way == 1:
        doctype = f'<!DOCTYPE COLLADA [<!ENTITY e SYSTEM "{outside_path(chance, "secret.mtl")}">]>'
        return ".dae", samples.dae("<extra><technique>&e;</technique></extra>", doctype)
    if way == 2:
        return ".dae", samples.dae(f'<library_images><image id="i"><init_from>{outside_path(chance, "secret.png")}</init_from></image></library_images>')
    return ".dae", samples.dae("", f'<!DOCTYPE COLLADA PUBLIC "x" "{outside_path(chance, "secret.mtl")}">')


def dae_deep(chance: random.Random):
    depth = chance.choice([10, 2000, 50_000])
    name = chance.choice(["node", "extra", "technique"])
    if name == "node":
        return ".dae", samples.dae(node="<node>" * depth + '<instance_geometry url="#g"/>' + "</node>" * depth)
    return ".dae", samples.dae(f"<{name}>" * depth + f"</{name}>" * depth)


def dae_cycles(chance: random.Random):
    links = chance.choice(['<node id="n"><instance_node url="#n"/></node>',
                           '<node id="a"><instance_node url="#b"/></node><node id="b"><instance_node url="#a"/></node>',
                           '<node><instance_node url="#nothing"/><instance_geometry url="#nothing"/></node>',
                           '<node><instance_geometry url="#g"/><matrix>' + "1e308 " * 16 + "</matrix></node>"])
    return ".dae", samples.dae(node=links)


def dae_numbers(chance: random.Random):
    text = samples.dae().decode()
    for _ in range(chance.randrange(1, 4)):
        old = chance.choice(['count="12"', 'count="4"', 'stride="3"', 'offset="0"', "0 2 1", "0 0 0", 'meter="1"', "Y_UP", 'source="#a"', 'url="#g"'])
        quote = '"' if '"' in old else ""
        # Rarely large: assimp reserves memory for any declared length, which takes time.
        most = LENGTHS if chance.random() < 0.03 else [0, 1, 3, 4, 0x7F, 0xFFFF, 100_000]
        text = text.replace(old, old.split('"')[0] + quote + str(chance.choice(most + NUMERALS[:-4] + ["-1", "#v", "#s"])) + quote, 1)
    return ".dae", text.encode()


def vrml_texts(chance: random.Random):
    text = samples.vrml().decode()
    extra = chance.choice(["", f'Inline {{ url "{outside_path(chance, "secret.wrl")}" }}\n', "DEF A Group { children USE A }\n", "Group { children [ " * 300,
                           f'Shape {{ appearance Appearance {{ texture ImageTexture {{ url "{outside_path(chance, "secret.png")}" }} }} geometry Box {{}} }}\n',
                           "Shape { geometry ElevationGrid { xDimension 99999 zDimension 99999 height [0] } }\n"])
    return ".wrl", damaged(chance, (text + extra).encode()) if chance.random() < 0.4 else (text + extra).encode()


def any_image(chance: random.Random) -> bytes:
    """PNG and JPEG with wrong declarations, and valid ones among them."""
    way = chance.randrange(10)
    side = chance.choice([0, 1, 7, 65_535, 32_768, 8001, 0x7FFFFFFF])
    if way == 0:
        return samples.png(width=side, height=side, pixels=bytes(10))
    if way == 1:
        return samples.jpeg(side & 0xFFFF, side & 0xFFFF, chance.choice([0xC0, 0xC1, 0xC2, 0xC3, 0xC9, 0xCF]))
    if way == 2:  # a bomb that declares its true, huge size
        return samples.png(width=20_000, height=chance.choice([20_000, 3000]), color=0, bits=1, pixels=bytes(4 << 20))
    if way == 3:
        return samples.png(color=chance.choice([0, 2, 3, 4, 6]), bits=chance.choice([1, 2, 4, 8, 16, 0, 3, 32]))
    if way == 4:
        return samples.png(color=3, bits=8, pixels=b"\0" + b"\xff" * 5 + b"\0" + b"\xfe" * 5 + b"\7" + b"\xfd" * 5)  # invalid colour and filter
    if way == 5:
        chunk = samples.png_chunk(chance.choice([b"tRNS", b"gAMA", b"iCCP", b"PLTE", b"IHDR", b"zTXt", b"IEND"]), bytes(chance.randrange(400)),
                                  chance.choice([None, None, 0xFFFFFFFF, 0x7FFFFFFF]))
        return samples.png(before=chunk * chance.choice([1, 3, 2000]))
    if way == 6:
        whole = chance.choice(list(samples.IMAGES.values()))()
        return whole[:chance.randrange(len(whole))]
    if way == 7:
        return b"\xff\xd8" + b"\xff\xc4" + struct.pack(">H", chance.choice([2, 19, 0xFFFF])) + bytes([chance.randrange(256)]) + bytes([255] * 16) + bytes(200)
    whole = chance.choice(list(samples.IMAGES.values()))()
    return damaged(chance, whole)


def textured(chance: random.Random):
    return ".gltf", samples.gltf(any_image(chance))


def named_texts(chance: random.Random):
    """Names inside of files: terminal escapes, characters that change the direction of writing, NUL, very long, not UTF-8."""
    name = chance.choice([b"\x1b]0;x\x07", b"\x1b[2J", "\u202e\u2066".encode(), b"a\0b", b"\xff\xfe\xc0\x80", b"x" * 70_000, b"\xed\xa0\x80", b"\n\r", b"'; DROP TABLE model;--",
                          b"<script>", b"%n%s%x", b"../../x"])
    if chance.random() < 0.5:
        return ".obj", samples.obj().replace(b"v ", b"o " + name + b"\nusemtl " + name + b"\nv ", 1)
    document = samples.gltf_document(samples.data_uri(samples.gltf_buffer()))
    document["nodes"][0]["name"] = document["materials"][0]["name"] = name.decode("utf-8", "surrogateescape" if b"\xff" in name or b"\xed" in name else "strict")
    return ".gltf", json.dumps(document).encode("utf-8", "surrogateescape")


def any_damaged(chance: random.Random):
    name, make = chance.choice(list(samples.MODELS.items()))
    return pathlib.PurePosixPath(name).suffix, damaged(chance, make())


def foreign(chance: random.Random):
    """Files with another format's extension, random bytes, empty files."""
    content = chance.choice([b"", b"\0" * 100, bytes(chance.randrange(256) for _ in range(chance.randrange(3000))), b"<html>", b"\x7fELF" + bytes(60), samples.png(),
                             samples.glb(), samples.stl_text(), samples.ac3d(), samples.dae()])
    return chance.choice([".obj", ".stl", ".ply", ".dae", ".gltf", ".glb", ".ac", ".wrl"]), content


CLASSES = [gltf_fields, gltf_outside, gltf_nodes, gltf_deep, glb_lengths, glb_numbers, obj_paths, obj_numbers, ply_counts, ply_headers, ply_lists, stl_sizes, stl_numbers,
           ac3d_counts, ac3d_deep, dae_entities, dae_deep, dae_cycles, dae_numbers, vrml_texts, textured, named_texts, any_damaged, foreign]

FILE_NAMES = ["\x1b[31mred", "line\nend", "\u202egnp.exe", "tab\there", "x" * 200, " ", "-rf", "--help", "'quote\"", "$(touch pwned)", "%s%n", "caf\udce9", "\udcff\udcfe", "стол",
              "a\u0000b".replace("\0", "␀"), "con", "..hidden", "a!b", "a#b", "né"]
