#!/usr/bin/env python3
"""Scenes of a few megabytes whose textures would fill the memory: generated, then rendered with the default limits.

Each must end within 10 seconds of processor time and 1 GiB, with a picture if it fits, otherwise with a message that
names the limit and the option to raise it.

Usage: hostile_textures_test.py ALHAZEN
"""

import json
import os
import struct
import sys
import tempfile
import zlib

from hostile_files_test import TEXTURED, Outcome

RGB, RGBA = 2, 6


def png(path, width, height, color, bits=8):
    """All zeros: a thousandth of the decoded size."""
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    row = bytes(1 + width * {RGB: 3, RGBA: 4}[color] * bits // 8)
    # Rows that refer to no row before them are all the same; the last block is empty. The sum of n zeros is n and 1.
    packer = zlib.compressobj(1, wbits=-15)
    packed = packer.compress(row) + packer.flush(zlib.Z_FULL_FLUSH)
    data = b"\x78\x01" + packed * height + b"\x03\x00" + struct.pack(">HH", height * len(row) % 65521, 1)
    with open(path, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, bits, color, 0, 0, 0)) +
                   chunk(b"IDAT", data) + chunk(b"IEND", b""))


def exr(path, width, height, channels=("B", "G", "R"), tile=None):
    """Floats with rows packed by runs (compression 1): after the predictor all zeros but the first are 128."""
    def attribute(name, kind, value):
        return name.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<I", len(value)) + value

    window = struct.pack("<iiii", 0, 0, width - 1, height - 1)
    listed = b"".join(name.encode() + b"\0" + struct.pack("<iBBBBii", 2, 0, 0, 0, 0, 1, 1) for name in channels) + b"\0"
    header = attribute("channels", "chlist", listed) + attribute("compression", "compression", b"\1") + \
        attribute("dataWindow", "box2i", window) + attribute("displayWindow", "box2i", window) + \
        attribute("lineOrder", "lineOrder", b"\0") + attribute("pixelAspectRatio", "float", struct.pack("<f", 1)) + \
        attribute("screenWindowCenter", "v2f", struct.pack("<ff", 0, 0)) + \
        attribute("screenWindowWidth", "float", struct.pack("<f", 1))
    if tile:
        header += attribute("tiles", "tiledesc", struct.pack("<IIB", *tile, 0))
    start = struct.pack("<II", 20000630, 2 | (0x200 if tile else 0)) + header + b"\0"
    left = width * len(channels) * 4 - 1
    packed = b"\x00\x00" + b"\x7f\x80" * (left // 128)
    if left % 128:
        packed += bytes([left % 128 - 1]) + b"\x80"
    with open(path, "wb") as file:
        file.write(start)
        if tile:
            file.write(struct.pack("<Q", len(start) + 8) + bytes(64))
            return
        at = len(start) + 8 * height
        file.write(b"".join(struct.pack("<Q", at + y * (8 + len(packed))) for y in range(height)))
        for y in range(height):
            file.write(struct.pack("<ii", y, len(packed)) + packed)


def hdr(path, width, height):
    row = bytes((2, 2, width >> 8, width & 255))
    for _ in range(4):
        row += b"\xff\x80" * (width // 127)
        if width % 127:
            row += bytes([128 + width % 127, 128])
    with open(path, "wb") as file:
        file.write(b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y %d +X %d\n" % (height, width))
        for _ in range(height):
            file.write(row)


def sparse(path, start, size):
    with open(path, "wb") as file:
        file.write(start)
        file.truncate(size)


def bmp(path, width, height):
    """16 bits with masks: decoded through floats."""
    sparse(path, b"BM" + struct.pack("<IHHI", 0, 0, 0, 66) +
           struct.pack("<IiiHHIIiiII", 40, width, height, 1, 16, 3, 0, 0, 0, 0, 0) +
           struct.pack("<III", 0xf800, 0x7e0, 0x1f), 66 + width * height * 2)


def pfm(path, width, height):
    start = b"PF\n%d %d\n-1.0\n" % (width, height)
    sparse(path, start, len(start) + 12 * width * height)


def native(folder, make, *arguments):
    make(os.path.join(folder, "texture"), *arguments)
    path = os.path.join(folder, "scene.alhazen")
    with open(path, "w", encoding="utf-8") as file:
        file.write(TEXTURED % "texture")
    return path


def gltf(folder, pictures, materials):
    """A triangle for each material. Both arguments are lists of glTF objects; every image is a texture."""
    corners = struct.pack("<15f", 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 1)
    with open(os.path.join(folder, "corners.bin"), "wb") as file:
        file.write(corners)
    primitive = {"attributes": {"POSITION": 0, "TEXCOORD_0": 1}}
    document = {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{**primitive, "material": i} for i in range(len(materials))]}],
        "materials": materials, "images": [{"uri": uri} for uri in pictures],
        "textures": [{"source": i} for i in range(len(pictures))],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0],
                       "max": [1, 1, 0]}, {"bufferView": 1, "componentType": 5126, "count": 3, "type": "VEC2"}],
        "bufferViews": [{"buffer": 0, "byteOffset": 0, "byteLength": 36},
                        {"buffer": 0, "byteOffset": 36, "byteLength": 24}],
        "buffers": [{"uri": "corners.bin", "byteLength": 60}]}
    path = os.path.join(folder, "scene.gltf")
    with open(path, "w", encoding="utf-8") as file:
        json.dump(document, file)
    return path


def color(index):
    return {"pbrMetallicRoughness": {"baseColorTexture": {"index": index}}}


def many_pictures(folder):
    names = [f"{i}.png" for i in range(20)]
    png(os.path.join(folder, names[0]), 8192, 4096, RGB)
    for name in names[1:]:
        os.link(os.path.join(folder, names[0]), os.path.join(folder, name))
    return gltf(folder, names, [color(i) for i in range(20)])


def color_and_normal(folder, width, height):
    png(os.path.join(folder, "p.png"), width, height, RGBA)
    return gltf(folder, ["p.png"], [{**color(0), "normalTexture": {"index": 0}}])


MEMORY, SIDE, PIXELS = "--max-image-mib", "--max-image-side", "--max-image-pixels"
# Scene, and None or the option that its message must name.
CASES = {
    "20 PNGs of 8192 x 4096 in one glTF": (many_pictures, MEMORY),
    # 128 MiB and twice 85. Twice the height would need 597 MiB, which is within the limit but slow.
    "a PNG of 8192 x 4096 as colour and as normals": (lambda f: color_and_normal(f, 8192, 4096), None),
    "a PNG of 8192 x 8192 x 16 bits": (lambda f: native(f, png, 8192, 8192, RGBA, 16), MEMORY),
    "a PNG of 2048 x 2048 x 16 bits": (lambda f: native(f, png, 2048, 2048, RGBA, 16), None),
    "a PNG of 32768 x 4096": (lambda f: native(f, png, 32768, 4096, RGB), PIXELS),
    "an EXR of 65500 x 16": (lambda f: native(f, exr, 65500, 16), SIDE),
    "an EXR of 32768 x 2048": (lambda f: native(f, exr, 32768, 2048), MEMORY),
    "an EXR of 32768 x 128": (lambda f: native(f, exr, 32768, 128), None),
    "an EXR tile of 4096 x 4096 x 30": (lambda f: native(f, exr, 8, 8, [f"c{i:03}" for i in range(30)], (4096, 4096)),
                                         MEMORY),
    "an HDR of 16384 x 4096": (lambda f: native(f, hdr, 16384, 4096), MEMORY),
    "an HDR of 16384 x 256": (lambda f: native(f, hdr, 16384, 256), None),
    "a BMP of 8192 x 8192 by masks": (lambda f: native(f, bmp, 8192, 8192), MEMORY),
    "a PFM of 8192 x 8192": (lambda f: native(f, pfm, 8192, 8192), MEMORY),
}


def main():
    failures = 0
    for name, (make, option) in CASES.items():
        with tempfile.TemporaryDirectory() as folder:
            out = os.path.join(folder, "out.png")
            outcome = Outcome([sys.argv[1], "render", "-q", make(folder), "-o", out, "--size", "32x32"])
            faults = list(outcome.faults({0} if option is None else {3, 5}))
            if option is None and not os.path.exists(out):
                faults.append("no picture")
            if option is not None and option not in outcome.message:
                faults.append(f"no {option} in the message")
        first_line = outcome.message.strip().split("\n")[0].replace(folder + "/", "")
        print(f"{name}: exit {outcome.status}, {outcome.seconds:.2f} s, {outcome.memory >> 20} MiB {first_line}")
        if faults:
            failures += 1
            print("FAILED", name, ": ", ", ".join(faults))
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
