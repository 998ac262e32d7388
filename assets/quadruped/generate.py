#!/usr/bin/env python3
"""Writes a four-legged beast: generate.py [--textured] OUTPUT.glb

A rigged, skinned low-poly quadruped as a modeller would hand it over: nothing in it says which joints are legs, that
is for a sidecar (docs/rig.md). Metres, +Y up, facing +Z, the origin on the ground below the body. Textured it is piebald, with
a coat of images and a mane that is cut out of one.
"""
import os
import sys

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
import coat
from creature import (Joint, Mesh, add, build_eye, build_leg, build_limb, build_loft, cross, mix, scale, smooth, sub, unit,
                      write, write_textured)

# Joints of the left legs at rest; elbows and hocks point back, knees ahead.
FORELEG = (("shoulder", (0.105, 0.500, 0.250)), ("elbow", (0.120, 0.345, 0.090)), ("wrist", (0.120, 0.130, 0.215)),
           ("forefoot", (0.120, 0.000, 0.240)))
HINDLEG = (("hip", (0.100, 0.510, -0.270)), ("knee", (0.125, 0.345, -0.130)), ("hock", (0.125, 0.165, -0.340)),
           ("hindfoot", (0.125, 0.000, -0.295)))
SPINE = (0.0, 0.52, -0.20)
HEAD = ("neck", (0.0, 0.56, 0.32)), ("head", (0.0, 0.74, 0.50))
TAIL = ("tail_1", (0.0, 0.54, -0.40)), ("tail_2", (0.0, 0.47, -0.60))

COAT = (0.170, 0.070, 0.022)
BACK = (0.050, 0.022, 0.010)
BELLY = (0.360, 0.250, 0.150)
SOCK = (0.030, 0.018, 0.012)
HOOF = (0.008, 0.007, 0.006)
EYE = (0.002, 0.002, 0.002)

# Rings along a leg: bone, place along it, radius, colour, weight of the bone before and of the bone after.
LEG_RINGS = (
    (0, 0.00, 0.078, COAT, 0.5, 0.0),
    (0, 0.50, 0.066, COAT, 0.1, 0.0),
    (1, 0.00, 0.050, COAT, 0.5, 0.0),
    (1, 0.30, 0.042, COAT, 0.1, 0.0),
    (1, 0.80, 0.030, SOCK, 0.0, 0.1),
    (2, 0.00, 0.031, SOCK, 0.5, 0.0),
    (2, 0.70, 0.026, SOCK, 0.0, 0.0),
    (2, 0.88, 0.036, HOOF, 0.0, 0.0),
    (2, 0.99, 0.040, HOOF, 0.0, 0.0),
)
LEG_SIDES = 7


def coat_colour(along, x, y):
    """Dark along the back, pale below."""
    return mix(mix(COAT, BACK, smooth(2.0 * y - 0.8)), BELLY, smooth(-2.0 * y - 0.6))


# The neck's line and radii, and what moves it, from the body to the head.
NECK = ((0.0, 0.530, 0.300), (0.0, 0.640, 0.400), (0.0, 0.735, 0.480), (0.0, 0.790, 0.510))
NECK_RADII = (0.110, 0.085, 0.070)
NECK_COLOURS = (COAT, BACK, COAT, BACK)
TAIL_COLOURS = (COAT, BACK, BACK, HOOF)


def neck_skins(spine, neck, head):
    return {spine: 0.6, neck: 0.4}, {neck: 1.0}, {neck: 0.4, head: 0.6}, {head: 1.0}


def build(textured=False):
    mesh = Mesh(textured)

    def use(chart):
        mesh.chart = coat.chart(chart)

    joints = [Joint("spine", None, SPINE)]
    spine = 0

    def chain(parts):
        parent, indices = spine, []
        for name, position in parts:
            joints.append(Joint(name, parent, position))
            parent = len(joints) - 1
            indices.append(parent)
        return indices

    neck, head = chain(HEAD)
    tail = chain(TAIL)
    use("body")
    build_loft(mesh, ((0.400, 0.520, 0, 0, 0),
                      (0.370, 0.520, 0.070, 0.080, 0.080),
                      (0.280, 0.510, 0.128, 0.120, 0.130),
                      (0.120, 0.505, 0.138, 0.115, 0.145),
                      (-0.060, 0.520, 0.122, 0.095, 0.120),
                      (-0.220, 0.530, 0.128, 0.090, 0.105),
                      (-0.340, 0.530, 0.110, 0.080, 0.090),
                      (-0.410, 0.535, 0.050, 0.045, 0.050),
                      (-0.430, 0.535, 0, 0, 0)), 12, coat_colour, {spine: 1.0})
    use("neck")
    build_limb(mesh, NECK, NECK_RADII, NECK_COLOURS, neck_skins(spine, neck, head), 9)
    use("head")
    build_loft(mesh, ((0.760, 0.690, 0, 0, 0),
                      (0.750, 0.692, 0.036, 0.030, 0.026),
                      (0.660, 0.715, 0.046, 0.042, 0.036),
                      (0.570, 0.740, 0.074, 0.062, 0.058),
                      (0.490, 0.755, 0.080, 0.068, 0.066),
                      (0.430, 0.755, 0, 0, 0)), 9, coat_colour, {head: 1.0})
    use("tail")
    build_limb(mesh, [TAIL[0][1], (0.0, 0.520, -0.500), TAIL[1][1], (0.0, 0.400, -0.760)], (0.036, 0.032, 0.034),
               TAIL_COLOURS, ({spine: 0.5, tail[0]: 0.5}, {tail[0]: 1.0},
                                          {tail[0]: 0.5, tail[1]: 0.5}, {tail[1]: 1.0}), 6)
    for sign, side in ((1, "left"), (-1, "right")):
        use("tail")
        build_limb(mesh, [(sign * x, y, z) for x, y, z in
                          ((0.045, 0.800, 0.480), (0.060, 0.850, 0.470), (0.068, 0.900, 0.460))],
                   (0.030, 0.024), (COAT, BACK, BACK), ({head: 1.0},) * 3, 5)
        mesh.chart = coat.dark_spot()
        build_eye(mesh, (sign * 0.060, 0.765, 0.580), 0.014, EYE, {head: 1.0})
        use("leg")
        for parts in (FORELEG, HINDLEG):
            points = [(sign * p[0], p[1], p[2]) for _, p in parts]
            indices = chain([(f"{side}_{name}", point) for (name, _), point in zip(parts, points)])
            build_leg(mesh, points, (0.0, 0.0, 1.0), indices[:3], spine, LEG_RINGS, LEG_SIDES, HOOF)
    return mesh, joints


def build_mane(spine, neck, head):
    """A strip that stands on the back of the neck, its image's lower edge in it."""
    mesh = Mesh(True)
    skins = neck_skins(spine, neck, head)
    radii = NECK_RADII + (0.030,)
    rows = []
    for k, point in enumerate(NECK):
        axis = unit(sub(NECK[min(k + 1, 3)], NECK[max(k - 1, 0)]))
        outward = unit(cross((1.0, 0.0, 0.0), axis))
        if outward[1] < 0: outward = scale(outward, -1.0)
        foot = add(point, scale(outward, 0.8 * radii[k]))
        tip = add(foot, scale(outward, 0.105))
        rows.append([mesh.vertex(p, None, skins[k], (k / 3, v)) for p, v in ((foot, 1.0), (tip, 0.0))])
    for a, b in zip(rows, rows[1:]):
        mesh.triangles += [(a[0], b[0], b[1]), (a[0], b[1], a[1])]
    return mesh


def write_piebald(path):
    mesh, joints = build(True)
    index = {joint.name: i for i, joint in enumerate(joints)}
    images = coat.images(coat_colour, {"leg": [ring[3] for ring in LEG_RINGS] + [HOOF], "neck": NECK_COLOURS,
                                       "tail": TAIL_COLOURS})
    hide = {"name": "coat", "pbrMetallicRoughness": {"baseColorTexture": {"index": 0},
                                                     "metallicRoughnessTexture": {"index": 2}},
            "normalTexture": {"index": 1}, "occlusionTexture": {"index": 2}}
    mane = {"name": "mane", "alphaMode": "MASK", "doubleSided": True,
            "pbrMetallicRoughness": {"baseColorTexture": {"index": 3}, "metallicFactor": 0, "roughnessFactor": 0.9}}
    strip = build_mane(index["spine"], index["neck"], index["head"])
    return write_textured(path, "quadruped", [(mesh, hide), (strip, mane)], images, joints)


if __name__ == "__main__":
    arguments = [a for a in sys.argv[1:] if a != "--textured"]
    if len(arguments) != 1: sys.exit("usage: generate.py [--textured] OUTPUT.glb")
    counts = write(arguments[0], "quadruped", *build(), ("coat", 0.8)) if len(arguments) == len(sys.argv) - 1 \
        else write_piebald(arguments[0])
    print("%d triangles, %d vertices" % counts)
