"""The images of the textured quadruped: its coat's colours, bumps and dullness, and the mane that is cut out."""
import math
import os
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
from creature import mix, png, smooth, unit

SIZE = 128       # texels a side of the coat
GLOSS_SIZE = 32  # of its dullness and occlusion, which vary little
MANE_SIZE = (64, 32)
INSET = 1.5 / SIZE  # of a chart, so that none bleeds into its neighbours
# Shares of the image: left, top, right, bottom.
CHARTS = {"body": (0, 0, 1, 0.5), "leg": (0, 0.5, 0.5, 1), "head": (0.5, 0.5, 1, 0.75), "neck": (0.5, 0.75, 0.75, 1),
          "tail": (0.75, 0.75, 1, 1)}
PATCH = (0.55, 0.48, 0.40)
MANE = (0.030, 0.014, 0.008)


def chart(name):
    left, top, right, bottom = CHARTS[name]
    return left + INSET, top + INSET, right - INSET, bottom - INSET


def dark_spot():
    """A point of the image where hooves are, for eyes."""
    left, _, right, bottom = chart("leg")
    x = 0.5 * (left + right)
    return x, bottom, x, bottom


def hashed(x, y, z):
    h = (x * 73856093 ^ y * 19349663 ^ z * 83492791) & 0xFFFFFFFF
    h = (h ^ h >> 15) * 0x2C1B3C6D & 0xFFFFFFFF
    h = (h ^ h >> 12) * 0x297A2D39 & 0xFFFFFFFF
    return (h >> 8) / 16777216.0


def noise(x, y, z):
    """Smooth, 0 to 1, a wavelength of about 2."""
    cell = [math.floor(v) for v in (x, y, z)]
    t = [smooth(v - c) for v, c in zip((x, y, z), cell)]
    total = 0.0
    for k in range(8):
        corner = (k & 1, k >> 1 & 1, k >> 2)
        weight = 1.0
        for j in range(3): weight *= t[j] if corner[j] else 1.0 - t[j]
        total += weight * hashed(*(cell[j] + corner[j] for j in range(3)))
    return total


def place(x, y, size):
    """The part that a texel belongs to, how far it is around it and along it."""
    u, v = (x + 0.5) / size, (y + 0.5) / size
    for name, (left, top, right, bottom) in CHARTS.items():
        if left <= u < right and top <= v < bottom:
            left, top, right, bottom = chart(name)
            return name, (u - left) / (right - left), min(1.0, max(0.0, (v - top) / (bottom - top)))


def along(stops, t):
    """Colours at equal distances."""
    k = min(int(t * (len(stops) - 1)), len(stops) - 2)
    return mix(stops[k], stops[k + 1], t * (len(stops) - 1) - k)


def srgb(v):
    return round(255 * (12.92 * v if v <= 0.0031308 else 1.055 * v ** (1 / 2.4) - 0.055))


def images(coat_colour, stops):
    """PNG files: colours, normals, occlusion with roughness, the mane. `stops` are the colours along other parts."""
    def around(name, s, t, fine):
        """A point of space, so that nothing shows where the image is cut."""
        length = {"body": 2.5, "leg": 3.0, "head": 1.5, "neck": 1.0, "tail": 1.5}[name]
        offset = 17 * sorted(CHARTS).index(name)
        angle = 2 * math.pi * s
        return fine * math.cos(angle) + offset, fine * math.sin(angle), fine * length * t

    def colour(name, s, t):
        angle = 2 * math.pi * s
        own = coat_colour(t, math.cos(angle), -math.sin(angle)) if name in ("body", "head") else along(stops[name], t)
        patch = smooth(8.0 * (noise(*around(name, s, t, 1.3)) - 0.52))
        if name == "leg": patch *= smooth(2.0 - 4.0 * t)
        if name == "tail": patch = 0.0
        shade = 0.85 + 0.3 * noise(*around(name, s, t, 9.0))
        return [min(1.0, shade * c) for c in mix(own, PATCH, patch)]

    def colours(x, y):
        name, s, t = place(x, y, SIZE)
        # Steps of 4 pack better and do not show.
        return [min(255, 4 * round(srgb(c) / 4)) for c in colour(name, s, t)]

    def height(x, y):
        name, s, t = place(min(max(x, 0), SIZE - 1), min(max(y, 0), SIZE - 1), SIZE)
        if name == "leg" and t > 0.8: return 0.5  # hooves are smooth
        x, y, z = around(name, s, t, 11.0)
        return noise(x, y, 0.4 * z)  # hair lies along the part

    heights = [[height(x, y) for x in range(-1, SIZE + 1)] for y in range(-1, SIZE + 1)]

    def normals(x, y):
        right = heights[y + 1][x + 2] - heights[y + 1][x]
        down = heights[y + 2][x + 1] - heights[y][x + 1]
        # Green is the way to the image's top.
        n = unit((-0.8 * right, 0.8 * down, 1.0))
        return [min(255, 4 * round((127.5 + 127.5 * c) / 4)) for c in n]

    def gloss(x, y):
        name, s, t = place(x, y, GLOSS_SIZE)
        below = max(0.0, math.sin(2 * math.pi * s)) if name == "body" else 0.0
        rough = 0.85 if name != "leg" else 0.85 - 0.45 * smooth(10.0 * (t - 0.75))
        return [round(255 * (1.0 - 0.45 * below)), round(255 * rough), 0]

    def mane(x, y):
        strand = noise(0.35 * x, 7.5, 0.05 * y)
        solid = y / MANE_SIZE[1] > 0.15 + 0.75 * strand
        return [srgb(c * (0.7 + 0.6 * strand)) for c in MANE] + [255 if solid else 0]

    return [png(SIZE, SIZE, 3, colours), png(SIZE, SIZE, 3, normals), png(GLOSS_SIZE, GLOSS_SIZE, 3, gloss),
            png(*MANE_SIZE, 4, mane)]
