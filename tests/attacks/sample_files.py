# SPDX-License-Identifier: MIT
"""Small valid files of every format that is read, as bytes, made with the standard library alone. Attacks and the corpus of the fuzz
targets are made from them."""
import base64
import json
import struct
import zlib

# A closed tetrahedron of 1 m.
POINTS = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
FACES = [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)]


def obj(material: str = "", height: float = 1.0) -> bytes:
    head = f"mtllib {material}.mtl\n" if material else ""
    lines = [f"v {x} {y * height} {z}" for x, y, z in POINTS] + ["vt 0 0", "vt 1 0", "vt 0 1", "vn 0 1 0"]
    if material:
        lines.append("usemtl wood")
    lines += ["f " + " ".join(f"{i + 1}/{k + 1}/1" for k, i in enumerate(face)) for face in FACES]
    return (head + "\n".join(lines) + "\n").encode()


def mtl(texture: str = "") -> bytes:
    return ("newmtl wood\nKd 0.5 0.4 0.3\nd 1\n" + (f"map_Kd {texture}\n" if texture else "")).encode()


def stl_text() -> bytes:
    facets = ""
    for face in FACES:
        corners = "".join(f"      vertex {' '.join(map(str, POINTS[i]))}\n" for i in face)
        facets += f"  facet normal 0 0 0\n    outer loop\n{corners}    endloop\n  endfacet\n"
    return f"solid t\n{facets}endsolid t\n".encode()


def stl(count: int | None = None) -> bytes:
    body = b"".join(struct.pack("<12fH", 0, 0, 0, *(c for i in face for c in POINTS[i]), 0) for face in FACES)
    return bytes(80) + struct.pack("<I", len(FACES) if count is None else count) + body


def ply_header(form: str, vertices=len(POINTS), faces=len(FACES), extra: str = "") -> bytes:
    return (f"ply\nformat {form} 1.0\ncomment sample\nelement vertex {vertices}\nproperty float x\nproperty float y\nproperty float z\n"
            f"property uchar red\nproperty uchar green\nproperty uchar blue\n{extra}element face {faces}\n"
            "property list uchar int vertex_indices\nend_header\n").encode()


def ply(form: str = "ascii") -> bytes:
    if form == "ascii":
        rows = [f"{x} {y} {z} 9 8 7" for x, y, z in POINTS] + ["3 " + " ".join(map(str, face)) for face in FACES]
        return ply_header(form) + ("\n".join(rows) + "\n").encode()
    order = "<" if "little" in form else ">"
    return (ply_header(form) + b"".join(struct.pack(order + "3f3B", *p, 9, 8, 7) for p in POINTS) +
            b"".join(struct.pack(order + "B3i", 3, *face) for face in FACES))


def ply_strips() -> bytes:
    return (b"ply\nformat ascii 1.0\nelement vertex 4\nproperty double x\nproperty double y\nproperty double z\nproperty float nx\n"
            b"property float ny\nproperty float nz\nproperty float s\nproperty float t\nelement tristrips 1\n"
            b"property list int int vertex_indices\nend_header\n" +
            "".join(f"{x} {y} {z} 0 1 0 0.5 0.5\n" for x, y, z in POINTS).encode() + b"7 0 1 2 -1 1 2 3\n")


def dae(extra: str = "", doctype: str = "", node: str = '<node><instance_geometry url="#g"/></node>') -> bytes:
    numbers = " ".join(str(c) for p in POINTS for c in p)
    indices = " ".join(str(i) for face in FACES for i in face)
    return f"""<?xml version="1.0" encoding="utf-8"?>
{doctype}<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit name="meter" meter="1"/><up_axis>Y_UP</up_axis></asset>{extra}
<library_geometries><geometry id="g"><mesh>
<source id="p"><float_array id="a" count="{3 * len(POINTS)}">{numbers}</float_array>
<technique_common><accessor source="#a" count="{len(POINTS)}" stride="3"><param name="X" type="float"/><param name="Y" type="float"/>
<param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="{len(FACES)}"><input semantic="VERTEX" source="#v" offset="0"/><p>{indices}</p></triangles>
</mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s">{node}</visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>
""".encode()


def ac3d(texture: str = "", kids: int = 1) -> bytes:
    rows = "\n".join(" ".join(map(str, p)) for p in POINTS)
    surfaces = "\n".join("SURF 0x10\nmat 0\nrefs 3\n" + "\n".join(f"{i} 0 0" for i in face) for face in FACES)
    return (f'AC3Db\nMATERIAL "wood" rgb 0.5 0.4 0.3 amb 0.2 0.2 0.2 emis 0 0 0 spec 0.1 0.1 0.1 shi 10 trans 0\n'
            f'OBJECT world\nkids {kids}\nOBJECT poly\nname "t"\n' + (f'texture "{texture}"\ntexrep 1 1\n' if texture else "") +
            f"loc 0 0 0\nrot 1 0 0 0 1 0 0 0 1\ncrease 45\nnumvert {len(POINTS)}\n{rows}\nnumsurf {len(FACES)}\n{surfaces}\nkids 0\n").encode()


def vrml() -> bytes:
    points = ", ".join(" ".join(map(str, p)) for p in POINTS)
    indices = ", ".join(", ".join(map(str, face)) + ", -1" for face in FACES)
    return f"#VRML V2.0 utf8\nShape {{ geometry IndexedFaceSet {{ coord Coordinate {{ point [ {points} ] }} coordIndex [ {indices} ] }} }}\n".encode()


def gltf_buffer() -> bytes:
    return b"".join(struct.pack("<3f", *p) for p in POINTS) + b"".join(struct.pack("<3H", *face) for face in FACES)


def gltf_document(uri: str | None = None, image: bytes = b"") -> dict:
    """`uri` None: the buffer is the binary chunk."""
    points = 12 * len(POINTS)
    document = {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0, "name": "t"}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "material": 0}]}],
        "materials": [{"name": "wood", "pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.4, 0.3, 1], "metallicFactor": 0}}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": len(POINTS), "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 1]},
                      {"bufferView": 1, "componentType": 5123, "count": 3 * len(FACES), "type": "SCALAR"}],
        "bufferViews": [{"buffer": 0, "byteOffset": 0, "byteLength": points},
                        {"buffer": 0, "byteOffset": points, "byteLength": 6 * len(FACES)}],
        "buffers": [{"byteLength": len(gltf_buffer())}]}
    if uri is not None:
        document["buffers"][0]["uri"] = uri
    if image:
        document["images"] = [{"uri": data_uri(image, "image/png")}]
        document["textures"] = [{"source": 0}]
        document["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = {"index": 0}
    return document


def data_uri(content: bytes, kind: str = "application/octet-stream") -> str:
    return f"data:{kind};base64," + base64.b64encode(content).decode()


def gltf(image: bytes = b"") -> bytes:
    return json.dumps(gltf_document(data_uri(gltf_buffer()), image)).encode()


def join_glb(document: bytes, binary: bytes, version: int = 2) -> bytes:
    document += b" " * (-len(document) % 4)
    binary += bytes(-len(binary) % 4)
    chunks = struct.pack("<II", len(document), 0x4E4F534A) + document + struct.pack("<II", len(binary), 0x004E4942) + binary
    return struct.pack("<III", 0x46546C67, version, 12 + len(chunks)) + chunks


def glb(document: dict | None = None) -> bytes:
    return join_glb(json.dumps(document or gltf_document()).encode(), gltf_buffer())


def png_chunk(kind: bytes, content: bytes, length: int | None = None, checksum: int | None = None) -> bytes:
    return (struct.pack(">I", len(content) if length is None else length) + kind + content +
            struct.pack(">I", zlib.crc32(kind + content) if checksum is None else checksum))


CHANNELS = {0: 1, 2: 3, 3: 1, 4: 2, 6: 4}


def png(width: int = 5, height: int = 3, color: int = 2, bits: int = 8, interlaced: bool = False, pixels: bytes | None = None,
        before: bytes = b"") -> bytes:
    if pixels is None:
        row = (width * CHANNELS[color] * bits + 7) // 8
        # Interlaced images hold the same bytes and one filter byte more for each row of each pass; surplus bytes are
        # allowed.
        rows = height if not interlaced else 3 * height + 8
        pixels = b"".join(b"\0" + bytes((17 * (y + x)) % 251 % (4 if color == 3 else 251) for x in range(row)) for y in range(rows))
    palette = png_chunk(b"PLTE", bytes(i % 256 for i in range(3 << min(bits, 6)))) if color == 3 else b""
    return (b"\x89PNG\r\n\x1a\n" + png_chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, bits, color, 0, 0, int(interlaced))) + palette +
            before + png_chunk(b"IDAT", zlib.compress(pixels)) + png_chunk(b"IEND", b""))


# 8 × 8 grey pixels: the tables of the standard's annex K, of which two codes are used.
def jpeg(width: int = 8, height: int = 8, start: int = 0xC0) -> bytes:
    def segment(marker: int, content: bytes) -> bytes:
        return struct.pack(">BBH", 255, marker, len(content) + 2) + content
    table = bytes([0] + [16] * 64)
    codes = bytes([0, 1, 1]) + bytes(14) + bytes([0, 3])
    return (b"\xff\xd8" + segment(0xE0, b"JFIF\0\1\1\0\0\1\0\1\0\0") + segment(0xDB, table) +
            segment(start, struct.pack(">BHHB", 8, height, width, 1) + bytes([1, 0x11, 0])) + segment(0xC4, codes) +
            segment(0xC4, bytes([0x10]) + codes[1:]) + segment(0xDA, bytes([1, 1, 0, 0, 63, 0])) + bytes([0x15]) + b"\xff\xd9")


def bmp(width: int = 4, height: int = 3) -> bytes:
    body = b"".join(bytes((7 * (x + y)) % 256 for x in range(3 * width)).ljust((3 * width + 3) // 4 * 4, b"\0") for y in range(abs(height)))
    return b"BM" + struct.pack("<IHHIIiiHHIIiiII", 54 + len(body), 0, 0, 54, 40, width, height, 1, 24, 0, len(body), 2835, 2835, 0, 0) + body


def tga(width: int = 4, height: int = 3, packed: bool = True) -> bytes:
    head = struct.pack("<BBBHHBHHHHBB", 0, 0, 10 if packed else 2, 0, 0, 0, 0, 0, width, height, 24, 0x20)
    return head + (bytes([128 | (width - 1), 1, 2, 3]) * height if packed else bytes(3 * width * height))


def gif() -> bytes:
    return (b"GIF89a" + struct.pack("<HHBBB", 2, 2, 0x80, 0, 0) + bytes([0, 0, 0, 255, 255, 255]) + b"," +
            struct.pack("<HHHHB", 0, 0, 2, 2, 0) + bytes([2, 3, 0x84, 0x8F, 0x05, 0]) + b";")


def sgi(width: int = 4, height: int = 3, channels: int = 3) -> bytes:
    return (struct.pack(">HBBHHHHII", 474, 0, 1, 3, width, height, channels, 0, 255) + bytes(4) + b"sample".ljust(80, b"\0") +
            bytes(408) + bytes(range(width * height * channels)))


IMAGES = {"rgb.png": lambda: png(), "rgba.png": lambda: png(color=6), "grey16.png": lambda: png(color=0, bits=16),
          "greyalpha.png": lambda: png(color=4), "palette.png": lambda: png(color=3, bits=2), "rgba16.png": lambda: png(color=6, bits=16),
          "interlaced.png": lambda: png(interlaced=True), "grey.jpg": jpeg, "image.bmp": bmp, "image.tga": tga, "image.gif": gif,
          "image.sgi": sgi}
MODELS = {"model.obj": obj, "text.stl": stl_text, "model.stl": stl, "ascii.ply": ply, "little.ply": lambda: ply("binary_little_endian"),
          "big.ply": lambda: ply("binary_big_endian"), "strips.ply": ply_strips, "model.dae": dae, "model.ac": ac3d, "model.gltf": gltf,
          "picture.gltf": lambda: gltf(png()), "model.glb": glb}
