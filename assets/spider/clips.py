"""The spider's clips: a walk in alternating tetrapods, and an idle in which it breathes.

A leg moves in a vertical plane through its root: the coxa turns the plane, femur and tibia bend in it, tibia and tarsus keep
their angle. So two angles and a turn put the foot anywhere, with the knee up as at rest.
"""
import math

from creature import add, dot, scale, sub

# Alternating tetrapods: the groups half a cycle apart, inside a group leg 4 first. On a side that gives the
# order 4-2-3-1 of real spiders. All in keys, so that feet lift and land at one.
KEYS = 30
KEY_SECONDS = 0.02
STANCE_KEYS = 18  # duty factor 0.6
LAGS = (2, 1, 1, 0)  # of legs 1 to 4
SPEED = 1.0  # metres a second: leg lengths a second
LIFT = 0.12
BOB = 0.006  # to either side, twice a cycle
SWAY = 0.004

IDLE_KEYS = 24
IDLE_SECONDS = 3.0
BREATH = 0.005


def about(axis, angle):
    """A quaternion, xyzw."""
    return scale(axis, math.sin(angle / 2)) + (math.cos(angle / 2),)


def wrap(angle): return (angle + math.pi) % (2 * math.pi) - math.pi


class Leg:
    """points: its joints at rest, root to foot; cones: half angles in degrees."""

    def __init__(self, points, outward, cones):
        self.root, self.home, self.cones = points[0], points[-1], cones
        self.outward = outward
        self.axis = (-outward[2], 0.0, outward[0])  # turning about it lifts
        self.flat = [self.in_plane(sub(p, self.root), outward) for p in points]
        self.azimuth = math.atan2(outward[0], outward[2])

    @staticmethod
    def in_plane(p, outward): return (dot(p, outward), p[1])

    def rotations(self, foot):
        """Coxa, femur, tibia and tarsus, each relative to the joint before, for a foot given in the body's frame."""
        to = sub(foot, self.root)
        turn = wrap(math.atan2(to[0], to[2]) - self.azimuth)
        femur, knee, tip = self.flat[1], self.flat[2], self.flat[4]
        target = (math.hypot(to[0], to[2]) - femur[0], to[1] - femur[1])
        upper = (knee[0] - femur[0], knee[1] - femur[1])
        lower = (tip[0] - knee[0], tip[1] - knee[1])
        a, b, c = math.hypot(*upper), math.hypot(*lower), math.hypot(*target)
        assert abs(a - b) < c < a + b, "out of reach"
        # The law of cosines, the knee above the line from root to foot.
        upper_angle = math.atan2(target[1], target[0]) + math.acos((a * a + c * c - b * b) / (2 * a * c))
        elbow = (a * math.cos(upper_angle), a * math.sin(upper_angle))
        lower_angle = math.atan2(target[1] - elbow[1], target[0] - elbow[0])
        lift = wrap(upper_angle - math.atan2(upper[1], upper[0]))
        fold = wrap(lower_angle - math.atan2(lower[1], lower[0])) - lift
        for angle, cone in zip((turn, lift, fold), self.cones):
            assert abs(math.degrees(angle)) < cone, "over its limit"
        return [about((0.0, 1.0, 0.0), turn), about(self.axis, lift), about(self.axis, fold), (0.0, 0.0, 0.0, 1.0)]


def foot_at(home, key, first):
    """The foot of a walking leg that lifts at key `first`: straight back in stance; in swing a cubic that leaves and
    meets the ground's speed, and an arc."""
    swing_keys = KEYS - STANCE_KEYS
    half = SPEED * STANCE_KEYS * KEY_SECONDS / 2
    k = (key - first) % KEYS
    if k >= swing_keys:
        return add(home, (0.0, 0.0, half - SPEED * (k - swing_keys) * KEY_SECONDS))
    u = k / swing_keys
    slope = -SPEED * swing_keys * KEY_SECONDS
    z = -half * (2 * u**3 - 3 * u**2 + 1) + half * (3 * u**2 - 2 * u**3) + slope * ((u**3 - 2 * u**2 + u) + (u**3 - u**2))
    return add(home, (0.0, LIFT * 16 * u**2 * (1 - u)**2, z))


def clip(name, seconds, keys, legs, body, offset, feet, turns):
    """legs: {first joint: Leg}; body: (joint, position at rest); offset(k): of the body; feet(joint, k); turns: {joint: turn(k)}."""
    channels = [(body[0], "translation", [add(body[1], offset(k)) for k in range(keys + 1)])]
    for joint, turn in turns.items():
        channels.append((joint, "rotation", [turn(k) for k in range(keys + 1)]))
    for joint, leg in legs.items():
        poses = [leg.rotations(sub(feet(joint, k), offset(k))) for k in range(keys + 1)]
        for bone in range(3):
            channels.append((joint + bone, "rotation", [pose[bone] for pose in poses]))
    return {"name": name, "times": [seconds * k / keys for k in range(keys + 1)], "channels": channels}


def build(legs, body, abdomen, pedipalps):
    """legs: {first joint: (Leg, index 0 to 3 from the front, is in group A)}; the others are joints, body with its position."""
    only_legs = {joint: leg for joint, (leg, _, _) in legs.items()}
    wave = lambda k, keys, times, phase=0.0: math.sin(2 * math.pi * (times * k / keys + phase))

    def walking_foot(joint, k):
        leg, index, in_a = legs[joint]
        return foot_at(leg.home, k, LAGS[index] + (KEYS // 2 if in_a else 0))

    degree = math.pi / 180
    up, side = (0.0, 1.0, 0.0), (1.0, 0.0, 0.0)
    walk = clip("walk", KEYS * KEY_SECONDS, KEYS, only_legs, body,
                lambda k: (SWAY * wave(k, KEYS, 1), BOB * wave(k, KEYS, 2), 0.0), walking_foot,
                {abdomen: lambda k: about(up, 1.5 * degree * wave(k, KEYS, 1, 0.25)),
                 pedipalps[0]: lambda k: about(side, 6 * degree * wave(k, KEYS, 1)),
                 pedipalps[1]: lambda k: about(side, -6 * degree * wave(k, KEYS, 1))})
    idle = clip("idle", IDLE_SECONDS, IDLE_KEYS, only_legs, body,
                lambda k: (0.0, BREATH * wave(k, IDLE_KEYS, 1), 0.0), lambda joint, k: legs[joint][0].home,
                {abdomen: lambda k: about(side, 1.2 * degree * wave(k, IDLE_KEYS, 1, 0.1)),
                 pedipalps[0]: lambda k: about(side, 4 * degree * wave(k, IDLE_KEYS, 1, 0.2)),
                 pedipalps[1]: lambda k: about(side, 4 * degree * wave(k, IDLE_KEYS, 1, 0.6))})
    return [walk, idle]
