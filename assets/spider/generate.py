#!/usr/bin/env python3
"""Writes the built-in spider: generate.py OUTPUT.glb

A rigged, skinned low-poly spider with eight legs of four bones. Metres, +Y up, facing +Z (so +X is its left), the
origin on the ground below the body. Standard library only; the same bytes on every run and every machine, for which
everything is rounded well above the differences between mathematics libraries before it is written.
"""
import json
import math
import struct
import sys

BONES = ("coxa", "femur", "tibia", "tarsus")
LENGTHS = (0.10, 0.35, 0.32, 0.23)
CONES = (60, 60, 80, 65)  # degrees, half angles
ELEVATIONS = (10, 40, None, -80)  # degrees; the tibia's is solved so that the foot stands on the ground
AZIMUTHS = (40, 75, 108, 145)  # degrees from forward, front pair to hind pair
ROOTS = ((0.072, 0.105), (0.105, 0.042), (0.107, -0.030), (0.080, -0.098))  # x, z of the left coxae
ROOT_HEIGHT = 0.26
BODY = (0.0, 0.27, 0.0)
PEDICEL = (0.0, 0.275, -0.150)
BODY_RADIUS = 0.34

SHELL = (0.0100, 0.0065, 0.0050)
SHELL_EDGE = (0.040, 0.024, 0.014)
SHELL_STRIPE = (0.160, 0.092, 0.044)
BAND_DARK = (0.0105, 0.0070, 0.0055)
BAND_LIGHT = (0.140, 0.064, 0.024)
TIP = (0.020, 0.012, 0.008)
ABDOMEN = (0.0130, 0.0085, 0.0065)
ABDOMEN_SIDE = (0.060, 0.034, 0.018)
MARKING = (0.420, 0.120, 0.022)
EYE = (0.002, 0.002, 0.003)
FANG = (0.090, 0.016, 0.008)


def add(a, b): return tuple(x + y for x, y in zip(a, b))
def sub(a, b): return tuple(x - y for x, y in zip(a, b))
def scale(a, s): return tuple(x * s for x in a)
def dot(a, b): return sum(x * y for x, y in zip(a, b))
def cross(a, b): return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])
def unit(a): return scale(a, 1.0 / math.sqrt(dot(a, a)))
def mix(a, b, t): return tuple(x + t * (y - x) for x, y in zip(a, b))
def smooth(t): t = min(1.0, max(0.0, t)); return t * t * (3 - 2 * t)


class Mesh:
    def __init__(self):
        self.positions, self.colours, self.skins, self.triangles = [], [], [], []

    def vertex(self, position, colour, skin):
        """skin: {joint index: weight}, at most four."""
        self.positions.append(position)
        self.colours.append(colour)
        self.skins.append(sorted(skin.items()))
        return len(self.positions) - 1

    def tube(self, rings):
        """Joins rings of equally many vertices, each counter-clockwise seen from the tube's end. The diagonals of
        the half that faces away from the first vertex are mirrored, so a symmetric body is split symmetrically."""
        for a, b in zip(rings, rings[1:]):
            n = len(a)
            for i in range(n):
                j = (i + 1) % n
                if n <= 4 * i + 2 < 3 * n:
                    self.triangles += [(a[i], a[j], b[i]), (a[j], b[j], b[i])]
                else:
                    self.triangles += [(a[i], a[j], b[j]), (a[i], b[j], b[i])]

    def cap(self, ring, apex, at_end):
        for i in range(len(ring)):
            j = (i + 1) % len(ring)
            self.triangles.append((ring[i], ring[j], apex) if at_end else (ring[j], ring[i], apex))

    def normals(self):
        """Angle-weighted face normals (Thuermer and Wuethrich, 1998)."""
        sums = [(0.0, 0.0, 0.0)] * len(self.positions)
        for triangle in self.triangles:
            p = [self.positions[v] for v in triangle]
            face = unit(cross(sub(p[1], p[0]), sub(p[2], p[0])))
            for k in range(3):
                u, v = unit(sub(p[(k + 1) % 3], p[k])), unit(sub(p[(k + 2) % 3], p[k]))
                angle = math.acos(max(-1.0, min(1.0, dot(u, v))))
                sums[triangle[k]] = add(sums[triangle[k]], scale(face, angle))
        return [unit(s) for s in sums]


class Joint:
    def __init__(self, name, parent, position):
        self.name, self.parent, self.position = name, parent, position


def ring(mesh, centre, side, up, radii, colour, skin, count):
    """A ring about side x up, its first vertex at `side`; colour may be a function of the angle."""
    vertices = []
    for i in range(count):
        angle = 2 * math.pi * i / count
        offset = add(scale(side, radii[0] * math.cos(angle)), scale(up, radii[1] * math.sin(angle)))
        vertices.append(mesh.vertex(add(centre, offset), colour(angle) if callable(colour) else colour, skin))
    return vertices


def leg_joints(index, left):
    """The five joint positions of a leg at rest."""
    elevations = [math.radians(e) if e is not None else None for e in ELEVATIONS]
    rest = ROOT_HEIGHT + sum(l * math.sin(e) for l, e in zip(LENGTHS, elevations) if e is not None)
    elevations[2] = -math.asin(rest / LENGTHS[2])
    azimuth = math.radians(AZIMUTHS[index])
    sign = 1 if left else -1
    outward = (sign * math.sin(azimuth), 0.0, math.cos(azimuth))
    x, z = ROOTS[index]
    points = [(sign * x, ROOT_HEIGHT, z)]
    for length, e in zip(LENGTHS, elevations):
        direction = add(scale(outward, math.cos(e)), (0.0, math.sin(e), 0.0))
        points.append(add(points[-1], scale(direction, length)))
    points[-1] = (points[-1][0], 0.0, points[-1][2])
    return points, outward


# Rings along a leg: bone, place along it, radius, colour, weight of the bone before and of the bone after.
LEG_RINGS = (
    (0, 0.00, 0.046, SHELL, 0.5, 0.0),
    (1, 0.00, 0.041, SHELL_EDGE, 0.5, 0.0),
    (1, 0.24, 0.047, BAND_DARK, 0.05, 0.0),
    (1, 0.58, 0.042, BAND_LIGHT, 0.0, 0.0),
    (1, 0.87, 0.030, BAND_DARK, 0.0, 0.14),
    (2, 0.00, 0.036, BAND_DARK, 0.5, 0.0),
    (2, 0.16, 0.028, BAND_LIGHT, 0.14, 0.0),
    (2, 0.62, 0.026, BAND_DARK, 0.0, 0.0),
    (3, 0.00, 0.023, BAND_LIGHT, 0.5, 0.0),
    (3, 0.30, 0.015, BAND_DARK, 0.06, 0.0),
)
LEG_SIDES = 6


def build_leg(mesh, points, outward, joints, body):
    """`joints` are the indices of coxa, femur, tibia and tarsus."""
    side = unit(cross((0.0, 1.0, 0.0), outward))
    directions = [unit(sub(b, a)) for a, b in zip(points, points[1:])]
    rings = []
    for bone, along, radius, colour, before, after in LEG_RINGS:
        centre = mix(points[bone], points[bone + 1], along)
        axis = directions[bone]
        if along == 0.0 and bone > 0:
            axis = unit(add(directions[bone - 1], directions[bone]))
        # side x up must point along the leg, for the ring to run counter-clockwise seen from its end.
        up = cross(axis, side)
        skin = {joints[bone]: 1.0 - before - after}
        if before: skin[joints[bone - 1] if bone else body] = before
        if after: skin[joints[bone + 1]] = after
        rings.append(ring(mesh, centre, side, up, (radius, radius), colour, skin, LEG_SIDES))
    mesh.tube(rings)
    mesh.cap(rings[-1], mesh.vertex(points[-1], TIP, {joints[3]: 1.0}), True)


def build_loft(mesh, profile, sides, colour, skin):
    """A closed body along -Z. profile: (z, centre y, half width, half height up, half height down), poles included."""
    first, last = profile[0], profile[-1]
    rings = []
    for k, (z, y, width, top, bottom) in enumerate(profile[1:-1]):
        along = (k + 1) / (len(profile) - 1)
        vertices = []
        for i in range(sides):
            # From the left over the bottom: counter-clockwise seen from -Z needs x, -y.
            angle = 2 * math.pi * i / sides
            height = math.sin(angle)
            position = (width * math.cos(angle), y - height * (bottom if height > 0 else top), z)
            vertices.append(mesh.vertex(position, colour(along, math.cos(angle), -height), skin))
        rings.append(vertices)
    mesh.cap(rings[0], mesh.vertex((0.0, first[1], first[0]), colour(0.0, 0.0, 0.0), skin), False)
    mesh.tube(rings)
    mesh.cap(rings[-1], mesh.vertex((0.0, last[1], last[0]), colour(1.0, 0.0, 0.0), skin), True)


def carapace_colour(along, x, y):
    """A pale stripe along the middle of the back, pale edges."""
    if y > 0.99 and 0.2 < along < 0.95: return SHELL_STRIPE
    return mix(SHELL, SHELL_EDGE, smooth(1.0 - abs(y) * 1.6))


def abdomen_colour(along, x, y):
    """A row of chevrons along the back on dark ground, paler flanks."""
    if y > 0.99 and 0.10 < along < 0.92: return MARKING
    if y > 0.8 and 0.10 < along < 0.92:
        return mix(ABDOMEN, MARKING, 0.6 if round(along * 8) % 2 == 0 else 0.0)
    return mix(ABDOMEN, ABDOMEN_SIDE, smooth(0.8 - abs(y)))


def build_limb(mesh, points, radii, colours, skins, sides):
    """A tapered appendage that ends in a point."""
    rings = []
    for k, (point, radius) in enumerate(zip(points[:-1], radii)):
        axis = unit(sub(points[k + 1], points[max(0, k - 1)]))
        side = unit(cross((0.0, 1.0, 0.0) if abs(axis[1]) < 0.9 else (0.0, 0.0, 1.0), axis))
        rings.append(ring(mesh, point, side, cross(axis, side), (radius, radius), colours[k], skins[k], sides))
    mesh.tube(rings)
    mesh.cap(rings[-1], mesh.vertex(points[-1], colours[-1], skins[-1]), True)


def build_eye(mesh, centre, radius, body):
    """An octahedron."""
    offsets = ((1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1))
    v = [mesh.vertex(add(centre, scale(o, radius)), EYE, {body: 1.0}) for o in offsets]
    for x, y, z in ((0, 2, 4), (2, 1, 4), (1, 3, 4), (3, 0, 4), (2, 0, 5), (1, 2, 5), (3, 1, 5), (0, 3, 5)):
        mesh.triangles.append((v[x], v[y], v[z]))


def build():
    mesh = Mesh()
    joints = [Joint("body", None, BODY), Joint("abdomen", 0, PEDICEL),
              Joint("pedipalp_L", 0, (0.042, 0.252, 0.135)), Joint("pedipalp_R", 0, (-0.042, 0.252, 0.135))]
    body, abdomen = 0, 1

    build_loft(mesh, ((0.172, 0.262, 0, 0, 0),
                      (0.155, 0.264, 0.058, 0.044, 0.036),
                      (0.105, 0.266, 0.082, 0.072, 0.052),
                      (0.030, 0.264, 0.116, 0.082, 0.056),
                      (-0.060, 0.262, 0.118, 0.070, 0.056),
                      (-0.125, 0.264, 0.080, 0.050, 0.046),
                      (-0.160, 0.268, 0, 0, 0)), 12, carapace_colour, {body: 1.0})
    build_loft(mesh, ((-0.130, 0.275, 0, 0, 0),
                      (-0.152, 0.278, 0.052, 0.046, 0.040),
                      (-0.200, 0.284, 0.098, 0.084, 0.070),
                      (-0.275, 0.290, 0.134, 0.112, 0.094),
                      (-0.355, 0.292, 0.146, 0.120, 0.102),
                      (-0.430, 0.288, 0.128, 0.104, 0.092),
                      (-0.490, 0.280, 0.084, 0.072, 0.064),
                      (-0.528, 0.270, 0.034, 0.032, 0.030),
                      (-0.542, 0.266, 0, 0, 0)), 12, abdomen_colour, {abdomen: 1.0})
    for sign in (1, -1):
        palp = 2 if sign > 0 else 3
        build_limb(mesh, [(sign * x, y, z) for x, y, z in
                          ((0.042, 0.252, 0.128), (0.062, 0.270, 0.195), (0.068, 0.225, 0.245), (0.060, 0.160, 0.262))],
                   (0.022, 0.021, 0.018), (SHELL_EDGE, BAND_DARK, BAND_LIGHT, TIP),
                   ({body: 0.5, palp: 0.5}, {palp: 1.0}, {palp: 1.0}, {palp: 1.0}), 5)
        build_limb(mesh, [(sign * x, y, z) for x, y, z in
                          ((0.026, 0.250, 0.135), (0.030, 0.232, 0.186), (0.027, 0.180, 0.192), (0.012, 0.148, 0.172))],
                   (0.026, 0.028, 0.017), (SHELL, SHELL_EDGE, FANG, EYE), ({body: 1.0},) * 4, 5)
        build_eye(mesh, (sign * 0.018, 0.290, 0.161), 0.0150, body)
        build_eye(mesh, (sign * 0.043, 0.288, 0.150), 0.0105, body)
        build_eye(mesh, (sign * 0.033, 0.315, 0.136), 0.0110, body)

    legs = []
    for index in range(4):
        for letter in "LR":
            name = f"{letter}{index + 1}"
            points, outward = leg_joints(index, letter == "L")
            chain = []
            for suffix, point in zip(BONES + ("foot",), points):
                joints.append(Joint(f"{name}_{suffix}", chain[-1] if chain else body, point))
                chain.append(len(joints) - 1)
            build_leg(mesh, points, outward, chain[:4], body)
            legs.append({"name": name, "group": "A" if (letter == "L") == (index % 2 == 0) else "B",
                         "joints": [joints[j].name for j in chain], "coneHalfAngleDegrees": list(CONES)})
    return mesh, joints, legs


def rounded(values, digits=9):
    return [round(v, digits) + 0.0 for v in values]


def write(path):
    mesh, joints, legs = build()
    binary, views, accessors = bytearray(), [], []

    def accessor(data, component, kind, count, target=None, normalized=False, bounds=None):
        while len(binary) % 4: binary.append(0)
        view = {"buffer": 0, "byteOffset": len(binary), "byteLength": len(data)}
        if target: view["target"] = target
        binary.extend(data)
        views.append(view)
        entry = {"bufferView": len(views) - 1, "componentType": component, "count": count, "type": kind}
        if normalized: entry["normalized"] = True
        if bounds: entry["min"], entry["max"] = bounds
        accessors.append(entry)
        return len(accessors) - 1

    def floats(rows):
        return b"".join(struct.pack(f"<{len(r)}f", *rounded(r, 6)) for r in rows)

    count = len(mesh.positions)
    # Bounds are of what is stored, in single precision.
    stored = [struct.unpack("<3f", struct.pack("<3f", *rounded(p, 6))) for p in mesh.positions]
    bounds = ([min(p[i] for p in stored) for i in range(3)], [max(p[i] for p in stored) for i in range(3)])
    attributes = {
        "POSITION": accessor(floats(mesh.positions), 5126, "VEC3", count, 34962, bounds=bounds),
        "NORMAL": accessor(floats(mesh.normals()), 5126, "VEC3", count, 34962),
        "COLOR_0": accessor(b"".join(struct.pack("<4H", *(round(c * 65535) for c in colour), 65535)
                                     for colour in mesh.colours), 5123, "VEC4", count, 34962, normalized=True),
        "JOINTS_0": accessor(b"".join(bytes([j for j, _ in skin] + [0] * (4 - len(skin))) for skin in mesh.skins),
                             5121, "VEC4", count, 34962),
        "WEIGHTS_0": accessor(floats([w for _, w in skin] + [0.0] * (4 - len(skin)) for skin in mesh.skins),
                              5126, "VEC4", count, 34962),
    }
    indices = accessor(b"".join(struct.pack("<3H", *t) for t in mesh.triangles), 5123, "SCALAR",
                       3 * len(mesh.triangles), 34963)
    nodes = [{"name": "spider", "mesh": 0, "skin": 0}]
    for joint in joints:
        offset = sub(joint.position, joints[joint.parent].position) if joint.parent is not None else joint.position
        nodes.append({"name": joint.name, "translation": rounded(offset)})
        if joint.parent is not None:
            nodes[joint.parent + 1].setdefault("children", []).append(len(nodes) - 1)
    inverse_bind = accessor(b"".join(struct.pack("<16f", 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0,
                                                 *rounded(scale(j.position, -1.0)), 1) for j in joints),
                            5126, "MAT4", len(joints))
    document = {
        "asset": {"version": "2.0", "generator": "skitter assets/spider/generate.py"},
        "scene": 0,
        "scenes": [{"name": "spider", "nodes": [0, 1], "extras": {"skitter": {
            "groups": ["A", "B"], "legs": legs, "bodyHeight": BODY[1], "bodyRadius": BODY_RADIUS}}}],
        "nodes": nodes,
        "meshes": [{"name": "spider", "primitives": [{"attributes": attributes, "indices": indices, "material": 0}]}],
        "skins": [{"name": "spider", "skeleton": 1, "joints": list(range(1, len(joints) + 1)),
                   "inverseBindMatrices": inverse_bind}],
        "materials": [{"name": "chitin", "doubleSided": False, "pbrMetallicRoughness": {
            "baseColorFactor": [1, 1, 1, 1], "metallicFactor": 0, "roughnessFactor": 0.55}}],
        "accessors": accessors,
        "bufferViews": views,
        "buffers": [{"byteLength": len(binary)}],
    }
    text = json.dumps(document, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    binary += bytes(-len(binary) % 4)
    with open(path, "wb") as file:
        file.write(struct.pack("<4sII", b"glTF", 2, 12 + 8 + len(text) + 8 + len(binary)))
        file.write(struct.pack("<I4s", len(text), b"JSON") + text)
        file.write(struct.pack("<I4s", len(binary), b"BIN\0") + binary)
    return len(mesh.triangles), count


if __name__ == "__main__":
    if len(sys.argv) != 2: sys.exit("usage: generate.py OUTPUT.glb")
    print("%d triangles, %d vertices" % write(sys.argv[1]))
