#!/usr/bin/env python3
"""Writes the built-in spider: generate.py OUTPUT.glb

A rigged, skinned low-poly spider with eight legs of four bones, and its clips. Metres, +Y up, facing +Z (so +X is its left), the
origin on the ground below the body.
"""
import math
import os
import sys

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
import clips
from creature import Joint, Mesh, add, build_eye, build_leg, build_limb, build_loft, mix, scale, smooth, write

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
        build_eye(mesh, (sign * 0.018, 0.290, 0.161), 0.0150, EYE, {body: 1.0})
        build_eye(mesh, (sign * 0.043, 0.288, 0.150), 0.0105, EYE, {body: 1.0})
        build_eye(mesh, (sign * 0.033, 0.315, 0.136), 0.0110, EYE, {body: 1.0})

    legs, walkers = [], {}
    for index in range(4):
        for letter in "LR":
            name = f"{letter}{index + 1}"
            points, outward = leg_joints(index, letter == "L")
            chain = []
            for suffix, point in zip(BONES + ("foot",), points):
                joints.append(Joint(f"{name}_{suffix}", chain[-1] if chain else body, point))
                chain.append(len(joints) - 1)
            build_leg(mesh, points, outward, chain[:4], body, LEG_RINGS, LEG_SIDES, TIP)
            in_a = (letter == "L") == (index % 2 == 0)
            walkers[chain[0]] = (clips.Leg(points, outward, CONES), index, in_a)
            legs.append({"name": name, "group": "A" if in_a else "B",
                         "joints": [joints[j].name for j in chain], "coneHalfAngleDegrees": list(CONES)})
    return mesh, joints, legs, clips.build(walkers, (body, BODY), abdomen, (2, 3))


if __name__ == "__main__":
    if len(sys.argv) != 2: sys.exit("usage: generate.py OUTPUT.glb")
    mesh, joints, legs, moves = build()
    extras = {"skitter": {"groups": ["A", "B"], "legs": legs, "bodyHeight": BODY[1], "bodyRadius": BODY_RADIUS}}
    print("%d triangles, %d vertices" % write(sys.argv[1], "spider", mesh, joints, ("chitin", 0.55), extras, moves))
