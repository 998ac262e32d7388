#!/usr/bin/env python3
"""Writes the seeds of the fuzzers and their dictionary: seeds.py FOLDER

A folder a reader: the models, sidecars and scenes of assets/, and files as small as they can be that have every part
of their format. The dictionary, words.dict, holds the words of all of these and of the readers' sources.
"""
import base64
import glob
import json
import os
import re
import shutil
import struct
import sys
import zlib

root = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")
folder = sys.argv[1]
words = set()


def save(reader, name, data):
    os.makedirs(os.path.join(folder, reader), exist_ok=True)
    with open(os.path.join(folder, reader, name), "wb") as file:
        file.write(data)


def save_text(reader, name, text):
    learn(text)
    save(reader, name, text.encode())


def learn(text):
    words.update(re.findall(r'"([A-Za-z][A-Za-z0-9_.+-]{1,30})"', text))


class Gltf:
    """A skinned triangle on four legs of two bones, animated, with a sparse accessor, a morph target and lines."""

    def __init__(self):
        self.binary = b""
        self.views, self.accessors = [], []

    def view(self, data, **more):
        self.views.append({"buffer": 0, "byteOffset": len(self.binary), "byteLength": len(data), **more})
        self.binary += data + b"\0" * (-len(data) % 4)
        return len(self.views) - 1

    def accessor(self, kind, component, form, rows, **more):
        data = b"".join(struct.pack("<" + form, *row) for row in rows)
        self.accessors.append({"bufferView": self.view(data), "componentType": component, "type": kind,
                               "count": len(rows), **more})
        return len(self.accessors) - 1

    def json(self):
        nodes = [{"name": "body", "translation": [0, 1, 0], "children": [1, 4, 7, 10]}]
        for side, x in (("left", 0.3), ("right", -0.3)):
            for end, z in (("front", 0.5), ("hind", -0.5)):
                n = len(nodes)
                nodes += [{"name": f"{side}_{end}_hip", "translation": [x, 0, z], "children": [n + 1]},
                          {"name": f"{side}_{end}_knee", "translation": [x, -0.45, 0], "children": [n + 2],
                           "rotation": [0, 0, 0, 1]},
                          {"name": f"{side}_{end}_foot", "translation": [0, -0.5, 0.1], "scale": [1, 1, 1]}]
        nodes += [{"name": "skin", "mesh": 0, "skin": 0},
                  {"name": "hat", "mesh": 1, "matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 1, 0, 1]}]
        joints = len(nodes) - 2
        bind = [(1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -1 if n == 0 else 0, 0, 1) for n in range(joints)]
        at = [(0, 1, 0), (0.6, 0, 0.6), (-0.6, 0, 0.6)]
        skin = {"POSITION": self.accessor("VEC3", 5126, "3f", at, min=[-0.6, 0, 0], max=[0.6, 1, 0.6]),
                "NORMAL": self.accessor("VEC3", 5120, "3bx", [(0, 0, 127)] * 3, normalized=True),
                "COLOR_0": self.accessor("VEC4", 5121, "4B", [(255, 0, 9, 255)] * 3, normalized=True),
                "JOINTS_0": self.accessor("VEC4", 5121, "4B", [(0, 1, 2, 3)] * 3),
                "WEIGHTS_0": self.accessor("VEC4", 5126, "4f", [(1, 0, 0, 0), (0.5, 0.5, 0, 0), (1, 1, 0, 0)]),
                "JOINTS_1": self.accessor("VEC4", 5123, "4H", [(4, 5, 6, 7)] * 3),
                "WEIGHTS_1": self.accessor("VEC4", 5123, "4H", [(0, 0, 0, 65535)] * 3, normalized=True)}
        self.views[self.accessors[skin["NORMAL"]]["bufferView"]]["byteStride"] = 4
        indices = self.accessor("SCALAR", 5123, "H", [(0,), (1,), (2,)])
        sparse = {"componentType": 5126, "type": "VEC3", "count": 3,
                  "sparse": {"count": 1,
                             "indices": {"bufferView": self.view(struct.pack("<H", 1)), "componentType": 5123},
                             "values": {"bufferView": self.view(struct.pack("<3f", 1, 1, 0))}}}
        self.accessors.append(sparse)
        hat = len(self.accessors) - 1
        times = self.accessor("SCALAR", 5126, "f", [(0,), (1,)], min=[0], max=[1])
        turns = self.accessor("VEC4", 5126, "4f", [(0, 0, 0, 1), (0, 0.6, 0, 0.8)])
        quarters = self.accessor("VEC4", 5120, "4b", [(0, 0, 0, 127), (90, 0, 0, 90)], normalized=True)
        ways = self.accessor("VEC3", 5126, "3f", [(0, 0, 0), (0, 1, 0), (0, 0, 1), (0, 0, 1), (0.1, 1, 0.5), (0, 0, 0)])
        sizes = self.accessor("VEC3", 5126, "3f", [(1, 1, 1), (1, 2, 1)])
        return {
            "asset": {"version": "2.0"}, "scene": 0, "extensionsUsed": ["KHR_materials_unlit"],
            "scenes": [{"nodes": [0, joints, joints + 1], "extras": {"skitter": {
                "groups": ["A", "B"], "bodyHeight": 1, "bodyRadius": 0.5,
                "legs": [{"name": side, "group": group, "coneHalfAngleDegrees": [60, 180],
                          "joints": [f"{side}_front_{joint}" for joint in ("hip", "knee", "foot")]}
                         for side, group in (("left", "A"), ("right", "B"))]}}}],
            "nodes": nodes,
            "meshes": [{"primitives": [{"attributes": skin, "indices": indices, "material": 0, "mode": 4}]},
                       {"primitives": [{"attributes": {"POSITION": hat}, "mode": 5, "targets": [{"POSITION": hat}]},
                                       {"attributes": {"POSITION": hat}, "mode": 1}]}],
            "materials": [{"pbrMetallicRoughness": {"baseColorFactor": [1, 0.5, 0, 1]}}],
            "skins": [{"joints": list(range(joints)), "skeleton": 0,
                       "inverseBindMatrices": self.accessor("MAT4", 5126, "16f", bind)}],
            "animations": [{"name": "walk",
                            "samplers": [{"input": times, "output": output, "interpolation": kind} for output, kind in
                                         ((turns, "LINEAR"), (ways, "CUBICSPLINE"), (sizes, "STEP"), (quarters, "STEP"))],
                            "channels": [{"sampler": sampler, "target": {"node": node, "path": path}} for sampler, node, path in
                                         ((0, 1, "rotation"), (1, 0, "translation"), (2, 2, "scale"), (3, 4, "rotation"))]}],
            "images": [{"uri": "none.png"}], "accessors": self.accessors, "bufferViews": self.views}


def models():
    gltf = Gltf()
    content = gltf.json()
    data = base64.b64encode(gltf.binary).decode()
    content["buffers"] = [{"byteLength": len(gltf.binary),
                           "uri": "data:application/octet-stream;base64," + data}]
    text = json.dumps(content)
    save_text("model", "all.gltf", text)
    del content["buffers"][0]["uri"]
    text = json.dumps(content, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    glb = struct.pack("<II", len(text), 0x4E4F534A) + text + struct.pack("<II", len(gltf.binary), 0x004E4942) + gltf.binary
    for reader in ("model", "rig"):
        save(reader, "all.glb", struct.pack("<III", 0x46546C67, 2, 12 + len(glb)) + glb)
        for file in glob.glob(os.path.join(root, "assets", "*.glb")):
            shutil.copy(file, os.path.join(folder, reader))
    save("model", "empty.gltf", b'{"asset":{"version":"2.0"},"nodes":[{}]}')


def texts():
    for reader, pattern in (("sidecar", "assets/*.rig.json"), ("scene", "assets/scenes/*.json")):
        for file in glob.glob(os.path.join(root, pattern)):
            with open(file) as opened:
                text = opened.read()
            save_text(reader, os.path.basename(file), text)
    # The legs of assets/quadruped.glb.
    legs = [{"name": side, "group": "A", "joints": [f"{side}_shoulder", joint], "tipOffset": [0, -0.4, 0],
             "home": [x, 0, 0.2], "bend": [0, 0, 1], "bendDegrees": 20, "coneHalfAngleDegrees": [90, 180]}
            for side, joint, x in (("left", "#7", 0.1), ("right", "right_elbow", -0.1))]
    save_text("sidecar", "all.json", json.dumps({
        "model": "a.glb", "scale": 0.9, "forward": [0, 0, 1], "up": "+Y", "origin": [0, 0, 0], "bodyHeight": 0.5,
        "bodyRadius": 0.3, "colour": [1, 0.5, 0], "groups": ["A"], "legs": legs}))
    save_text("scene", "all.json", json.dumps({
        "terrain": {"kind": "file", "file": "hill.png", "spacingX": 1, "spacingZ": 2, "minHeight": -3, "maxHeight": 3,
                    "scale": 0.5, "exaggeration": 2, "columns": 4, "rows": 5, "voidValue": -32768},
        "herds": [{"rig": "a.glb", "controller": "loop", "agents": 0, "tuning": {"stepHeight": 0.2, "dutyStill": 0.8},
                   "spawn": {"kind": "grid", "spacing": 1, "centre": [1, -2], "heading": 1.5},
                   "goal": {"kind": "point", "target": [5, 6], "speed": 0}}, {"goal": {"kind": "none"}}],
        "camera": {"kind": "fixed", "position": [1, 2, 3], "target": [4, 5, 6]}}))


def png(columns, rows, bits, colour, interlace=0):
    def chunk(tag, data):
        return struct.pack(">I", len(data)) + tag + data + struct.pack(">I", zlib.crc32(tag + data))

    samples = {0: 1, 2: 3, 4: 2, 6: 4}[colour]
    row = b"\0" + bytes(range(columns * samples * bits // 8))
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", columns, rows, bits, colour, 0, 0, interlace)) +
            chunk(b"IDAT", zlib.compress(row * rows * (2 if interlace else 1))) + chunk(b"IEND", b""))


def heights():
    def height(name, kind, data, sidecar=b""):
        save("heights", name, bytes([kind, len(sidecar)]) + sidecar + data)

    height("grey16", 0, png(3, 3, 16, 0), b'{"width":3,"height":3,"spacing_x_m":30,"spacing_y_m":30}')
    height("grey8", 0, png(4, 2, 8, 0), b'{"min_m":0,"max_m":100,"void_value":0}')
    height("alpha", 0, png(2, 2, 16, 4))
    height("interlaced", 0, png(2, 2, 8, 0, 1))
    for kind, size, major in (("<f4", 4, 1), (">i2", 2, 1), ("<f8", 8, 2), ("|u1", 1, 3)):
        header = f"{{'descr': '{kind}', 'fortran_order': False, 'shape': (2, 3), }}".ljust(116) + "\n"
        length = struct.pack("<H" if major == 1 else "<I", len(header))
        height("npy" + kind[1:], 1, b"\x93NUMPY" + bytes([major, 0]) + length + header.encode() + bytes(6 * size))
    height("r16", 2, struct.pack("<6H", *range(6)), b'{"width":3,"height":2,"min_m":-1,"max_m":1}')
    height("r32f", 3, struct.pack("<4f", 0, 1, float("nan"), 3))
    height("hgt", 4, struct.pack(">5h", 1, 200, 8848, -3, 0))
    height("hgt_voids", 4, struct.pack(">5h", 1, -32768, -32768, -3, 0), b'{"spacing_x_m":30,"void_value":200}')


models()
texts()
heights()
for source in glob.glob(os.path.join(root, "engine", "assets", "*.cpp")):
    with open(source) as opened:
        learn(re.sub(r"#include.*", "", opened.read()))
with open(os.path.join(folder, "words.dict"), "w") as dictionary:
    dictionary.writelines(f'"\\"{word}\\""\n' for word in sorted(words))
    dictionary.writelines(f'"{word}"\n' for word in (
        "-1", "0", "1e9", "1e-9", "1e300", "1e-320", "0.5", "2147483648", "4294967295", "18446744073709551615", "null",
        "true", "[]", "{}", "IHDR", "PLTE", "tRNS", "iCCP", "IDAT", "IEND", "NUMPY", "False", "JSON", "glTF"))
