"""Low-poly creatures from rings and lofts, and the glTF binary that they are written to.

Standard library only; the same bytes on every run and every machine, for which everything is rounded well above the
differences between mathematics libraries before it is written. Only images, which zlib packs, may be other bytes of the
same texels.
"""
import json
import math
import struct
import zlib


def add(a, b): return tuple(x + y for x, y in zip(a, b))
def sub(a, b): return tuple(x - y for x, y in zip(a, b))
def scale(a, s): return tuple(x * s for x in a)
def dot(a, b): return sum(x * y for x, y in zip(a, b))
def cross(a, b): return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])
def unit(a): return scale(a, 1.0 / math.sqrt(dot(a, a)))
def mix(a, b, t): return tuple(x + t * (y - x) for x, y in zip(a, b))
def along(a, normal): return sub(a, scale(normal, dot(a, normal)))
def smooth(t): t = min(1.0, max(0.0, t)); return t * t * (3 - 2 * t)


class Mesh:
    """With `textured`, vertices have a place in an image instead of a colour: around a part in u and along it in v, both
    0 to 1, which `chart` (left, top, right, bottom) takes to the part's share of the image. A ring then ends with its
    first vertex once more, at u = 1."""

    def __init__(self, textured=False):
        self.positions, self.colours, self.skins, self.triangles = [], [], [], []
        self.textured, self.uvs, self.chart = textured, [], (0.0, 0.0, 1.0, 1.0)

    def vertex(self, position, colour, skin, uv=(0.0, 0.0)):
        """skin: {joint index: weight}, at most four."""
        self.positions.append(position)
        self.colours.append(colour)
        self.skins.append(sorted(skin.items()))
        left, top, right, bottom = self.chart
        self.uvs.append((left + uv[0] * (right - left), top + uv[1] * (bottom - top)))
        return len(self.positions) - 1

    def corners(self, sides):
        return sides + 1 if self.textured else sides

    def pairs(self, ring):
        """Neighbours in a ring."""
        if self.textured: return [(i, i + 1) for i in range(len(ring) - 1)]
        return [(i, (i + 1) % len(ring)) for i in range(len(ring))]

    def apex(self, position, colour, skin, sides, along):
        """The end of a part: one vertex, or one for each side, each above the middle of its own."""
        if not self.textured: return [self.vertex(position, colour, skin)] * sides
        return [self.vertex(position, colour, skin, ((i + 0.5) / sides, along)) for i in range(sides)]

    def tube(self, rings):
        """Joins rings of equally many vertices, each counter-clockwise seen from the tube's end. The diagonals of
        the half that faces away from the first vertex are mirrored, so a symmetric body is split symmetrically."""
        for a, b in zip(rings, rings[1:]):
            n = len(self.pairs(a))
            for i, j in self.pairs(a):
                if n <= 4 * i + 2 < 3 * n:
                    self.triangles += [(a[i], a[j], b[i]), (a[j], b[j], b[i])]
                else:
                    self.triangles += [(a[i], a[j], b[j]), (a[i], b[j], b[i])]

    def cap(self, ring, apex, at_end):
        for i, j in self.pairs(ring):
            self.triangles.append((ring[i], ring[j], apex[i]) if at_end else (ring[j], ring[i], apex[i]))

    def normals(self):
        """Angle-weighted face normals (Thuermer and Wuethrich, 1998). Vertices that differ in their place in the image
        alone have one."""
        places = {}
        same = [places.setdefault(tuple(rounded(p)), v) if self.textured else v for v, p in enumerate(self.positions)]
        sums = [(0.0, 0.0, 0.0)] * len(self.positions)
        for triangle in self.triangles:
            p = [self.positions[v] for v in triangle]
            face = unit(cross(sub(p[1], p[0]), sub(p[2], p[0])))
            for k in range(3):
                u, v = unit(sub(p[(k + 1) % 3], p[k])), unit(sub(p[(k + 2) % 3], p[k]))
                angle = math.acos(max(-1.0, min(1.0, dot(u, v))))
                sums[same[triangle[k]]] = add(sums[same[triangle[k]]], scale(face, angle))
        return [unit(sums[v]) for v in same]

    def tangents(self):
        """The image's right on the surface, weighted by angles as normals are, and the side of its top (glTF 2.0, section
        3.7.2.1). Where a part's image is one point, some direction along the surface."""
        normals = self.normals()
        rights, tops = ([(0.0, 0.0, 0.0)] * len(self.positions) for _ in range(2))
        for triangle in self.triangles:
            p, uv = [self.positions[v] for v in triangle], [self.uvs[v] for v in triangle]
            a, b = sub(p[1], p[0]), sub(p[2], p[0])
            s, t = sub(uv[1], uv[0]), sub(uv[2], uv[0])
            area = s[0] * t[1] - t[0] * s[1]
            if area == 0: continue
            right = scale(sub(scale(a, t[1]), scale(b, s[1])), 1 / area)
            top = scale(sub(scale(a, t[0]), scale(b, s[0])), 1 / area)
            for k, v in enumerate(triangle):
                ways = unit(sub(p[(k + 1) % 3], p[k])), unit(sub(p[(k + 2) % 3], p[k]))
                angle = math.acos(max(-1.0, min(1.0, dot(*ways))))
                rights[v] = add(rights[v], scale(unit(along(right, normals[v])), angle))
                tops[v] = add(tops[v], scale(unit(along(top, normals[v])), angle))
        result = []
        for normal, right, top in zip(normals, rights, tops):
            if right == (0.0, 0.0, 0.0): right = (1.0, 0.0, 0.0) if abs(normal[0]) < 0.9 else (0.0, 1.0, 0.0)
            right = unit(along(right, normal))
            result.append(right + (-1.0 if dot(cross(normal, right), top) < 0 else 1.0,))
        return result


class Joint:
    def __init__(self, name, parent, position):
        self.name, self.parent, self.position = name, parent, position


def ring(mesh, centre, side, up, radii, colour, skin, count, along=0.0):
    """A ring about side x up, its first vertex at `side`; colour may be a function of the angle."""
    vertices = []
    for i in range(mesh.corners(count)):
        angle = 2 * math.pi * i / count
        offset = add(scale(side, radii[0] * math.cos(angle)), scale(up, radii[1] * math.sin(angle)))
        vertices.append(mesh.vertex(add(centre, offset), colour(angle) if callable(colour) else colour, skin,
                                    (i / count, along)))
    return vertices


def build_leg(mesh, points, outward, joints, body, leg_rings, sides, tip):
    """Rings along a leg: bone, place along it, radius, colour, weight of the bone before and of the bone after;
    `joints` are the indices of its bones' joints, `tip` the colour of its end."""
    side = unit(cross((0.0, 1.0, 0.0), outward))
    directions = [unit(sub(b, a)) for a, b in zip(points, points[1:])]
    rings = []
    for bone, along, radius, colour, before, after in leg_rings:
        centre = mix(points[bone], points[bone + 1], along)
        axis = directions[bone]
        if along == 0.0 and bone > 0:
            axis = unit(add(directions[bone - 1], directions[bone]))
        # side x up must point along the leg, for the ring to run counter-clockwise seen from its end.
        up = cross(axis, side)
        skin = {joints[bone]: 1.0 - before - after}
        if before: skin[joints[bone - 1] if bone else body] = before
        if after: skin[joints[bone + 1]] = after
        rings.append(ring(mesh, centre, side, up, (radius, radius), colour, skin, sides, len(rings) / len(leg_rings)))
    mesh.tube(rings)
    mesh.cap(rings[-1], mesh.apex(points[-1], tip, {joints[-1]: 1.0}, sides, 1.0), True)


def build_loft(mesh, profile, sides, colour, skin):
    """A closed body along -Z. profile: (z, centre y, half width, half height up, half height down), poles included."""
    first, last = profile[0], profile[-1]
    rings = []
    for k, (z, y, width, top, bottom) in enumerate(profile[1:-1]):
        along = (k + 1) / (len(profile) - 1)
        vertices = []
        for i in range(mesh.corners(sides)):
            # From the left over the bottom: counter-clockwise seen from -Z needs x, -y.
            angle = 2 * math.pi * i / sides
            height = math.sin(angle)
            position = (width * math.cos(angle), y - height * (bottom if height > 0 else top), z)
            vertices.append(mesh.vertex(position, colour(along, math.cos(angle), -height), skin,
                                        (i / sides, along)))
        rings.append(vertices)
    mesh.cap(rings[0], mesh.apex((0.0, first[1], first[0]), colour(0.0, 0.0, 0.0), skin, sides, 0.0), False)
    mesh.tube(rings)
    mesh.cap(rings[-1], mesh.apex((0.0, last[1], last[0]), colour(1.0, 0.0, 0.0), skin, sides, 1.0), True)


def build_limb(mesh, points, radii, colours, skins, sides):
    """A tapered appendage that ends in a point."""
    rings = []
    for k, (point, radius) in enumerate(zip(points[:-1], radii)):
        axis = unit(sub(points[k + 1], points[max(0, k - 1)]))
        side = unit(cross((0.0, 1.0, 0.0) if abs(axis[1]) < 0.9 else (0.0, 0.0, 1.0), axis))
        rings.append(ring(mesh, point, side, cross(axis, side), (radius, radius), colours[k], skins[k], sides,
                          k / len(radii)))
    mesh.tube(rings)
    mesh.cap(rings[-1], mesh.apex(points[-1], colours[-1], skins[-1], sides, 1.0), True)


def build_eye(mesh, centre, radius, colour, skin):
    """An octahedron."""
    offsets = ((1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1))
    v = [mesh.vertex(add(centre, scale(o, radius)), colour, skin) for o in offsets]
    for x, y, z in ((0, 2, 4), (2, 1, 4), (1, 3, 4), (3, 0, 4), (2, 0, 5), (1, 2, 5), (3, 1, 5), (0, 3, 5)):
        mesh.triangles.append((v[x], v[y], v[z]))


def png(width, height, channels, texel_at):
    """Three or four numbers a texel, 0 to 255."""
    rows = b"".join(b"\1" + delta(bytes(v for x in range(width) for v in texel_at(x, y)), channels) for y in range(height))

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    header = struct.pack(">IIBBBBB", width, height, 8, {3: 2, 4: 6}[channels], 0, 0, 0)
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(rows, 9)) + chunk(b"IEND", b""))


def delta(row, channels):
    """PNG's filter 1: each byte less the one a texel before."""
    return bytes((row[i] - (row[i - channels] if i >= channels else 0)) & 255 for i in range(len(row)))


def rounded(values, digits=9):
    return [round(v, digits) + 0.0 for v in values]


def write(path, name, mesh, joints, material, extras=None, clips=()):
    """The joints' first is the root; `material` is a name and a roughness; a clip has a name, times, and channels: a joint, a
    path and a row a time, linear between."""
    return write_textured(path, name, [(mesh, {"name": material[0], "doubleSided": False, "pbrMetallicRoughness": {
        "baseColorFactor": [1, 1, 1, 1], "metallicFactor": 0, "roughnessFactor": material[1]}})], [], joints, extras, clips)


def write_textured(path, name, parts, images, joints, extras=None, clips=()):
    """Each part is a mesh and its material, as glTF has it; texture N is image N, the bytes of a PNG file."""
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

    def primitive(mesh, material, tangents):
        count = len(mesh.positions)
        # Bounds are of what is stored, in single precision.
        stored = [struct.unpack("<3f", struct.pack("<3f", *rounded(p, 6))) for p in mesh.positions]
        bounds = ([min(p[i] for p in stored) for i in range(3)], [max(p[i] for p in stored) for i in range(3)])
        attributes = {
            "POSITION": accessor(floats(mesh.positions), 5126, "VEC3", count, 34962, bounds=bounds),
            "NORMAL": accessor(floats(mesh.normals()), 5126, "VEC3", count, 34962)}
        if tangents:
            attributes["TANGENT"] = accessor(floats(mesh.tangents()), 5126, "VEC4", count, 34962)
        if mesh.textured:
            attributes["TEXCOORD_0"] = accessor(floats(mesh.uvs), 5126, "VEC2", count, 34962)
        else:
            attributes["COLOR_0"] = accessor(
                b"".join(struct.pack("<4H", *(round(c * 65535) for c in colour), 65535) for colour in mesh.colours),
                5123, "VEC4", count, 34962, normalized=True)
        attributes["JOINTS_0"] = accessor(
            b"".join(bytes([j for j, _ in skin] + [0] * (4 - len(skin))) for skin in mesh.skins), 5121, "VEC4", count, 34962)
        attributes["WEIGHTS_0"] = accessor(
            floats([w for _, w in skin] + [0.0] * (4 - len(skin)) for skin in mesh.skins), 5126, "VEC4", count, 34962)
        indices = accessor(b"".join(struct.pack("<3H", *t) for t in mesh.triangles), 5123, "SCALAR",
                           3 * len(mesh.triangles), 34963)
        return {"attributes": attributes, "indices": indices, "material": material}

    def image(data):
        while len(binary) % 4: binary.append(0)
        views.append({"buffer": 0, "byteOffset": len(binary), "byteLength": len(data)})
        binary.extend(data)
        return {"bufferView": len(views) - 1, "mimeType": "image/png"}

    primitives = [primitive(mesh, index, "normalTexture" in material) for index, (mesh, material) in enumerate(parts)]
    nodes = [{"name": name, "mesh": 0, "skin": 0}]
    for joint in joints:
        offset = sub(joint.position, joints[joint.parent].position) if joint.parent is not None else joint.position
        nodes.append({"name": joint.name, "translation": rounded(offset)})
        if joint.parent is not None:
            nodes[joint.parent + 1].setdefault("children", []).append(len(nodes) - 1)
    inverse_bind = accessor(b"".join(struct.pack("<16f", 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0,
                                                 *rounded(scale(j.position, -1.0)), 1) for j in joints),
                            5126, "MAT4", len(joints))
    animations = []
    for clip in clips:
        times = rounded(clip["times"], 6)
        bounds = [[struct.unpack("<f", struct.pack("<f", t))[0]] for t in (times[0], times[-1])]
        samplers = {"input": accessor(floats([times]), 5126, "SCALAR", len(times), bounds=bounds)}
        outputs = [accessor(floats(rows), 5126, f"VEC{len(rows[0])}", len(rows)) for _, _, rows in clip["channels"]]
        animations.append({
            "name": clip["name"],
            "samplers": [dict(samplers, output=output) for output in outputs],
            "channels": [{"sampler": k, "target": {"node": joint + 1, "path": kind}}
                         for k, (joint, kind, _) in enumerate(clip["channels"])]})
    scene = {"name": name, "nodes": [0, 1]}
    if extras: scene["extras"] = extras
    document = {
        "asset": {"version": "2.0", "generator": f"skitter assets/{name}/generate.py"},
        "scene": 0,
        "scenes": [scene],
        "nodes": nodes,
        "meshes": [{"name": name, "primitives": primitives}],
        "skins": [{"name": name, "skeleton": 1, "joints": list(range(1, len(joints) + 1)),
                   "inverseBindMatrices": inverse_bind}],
        "materials": [material for _, material in parts],
        "accessors": accessors,
        "bufferViews": views,
        "buffers": [{"byteLength": len(binary)}],
    }
    if animations: document["animations"] = animations
    if images:
        document["images"] = [image(data) for data in images]
        # Around a part images repeat, along it they end.
        document["samplers"] = [{"magFilter": 9729, "minFilter": 9987, "wrapS": 10497, "wrapT": 33071}]
        document["textures"] = [{"source": i, "sampler": 0} for i in range(len(images))]
        document["buffers"] = [{"byteLength": len(binary)}]
    text = json.dumps(document, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    binary += bytes(-len(binary) % 4)
    with open(path, "wb") as file:
        file.write(struct.pack("<4sII", b"glTF", 2, 12 + 8 + len(text) + 8 + len(binary)))
        file.write(struct.pack("<I4s", len(text), b"JSON") + text)
        file.write(struct.pack("<I4s", len(binary), b"BIN\0") + binary)
    return sum(len(mesh.triangles) for mesh, _ in parts), sum(len(mesh.positions) for mesh, _ in parts)
