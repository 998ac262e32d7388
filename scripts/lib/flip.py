"""FLIP of two pictures (scripts/flip cites it), and reading and writing of PNG files."""
import math
import struct
import zlib

import numpy as np

USUAL_PPD = 0.7 * 3840 / 0.7 * math.pi / 180
CHANNELS = {0: 1, 2: 3, 4: 2, 6: 4}  # of a PNG's colour types without a palette
TO_XYZ = np.array([[10135552 / 24577794, 8788810 / 24577794, 4435075 / 24577794],
                   [2613072 / 12288897, 8788810 / 12288897, 887015 / 12288897],
                   [1425312 / 73733382, 8788810 / 73733382, 70074185 / 73733382]])
WHITE = TO_XYZ.sum(axis=1)


class Unusable(Exception):
    """Names the file, what was found and what was expected."""


def unfilter(lines, row_bytes, pixel_bytes):
    """The rows of a PNG without its filters (PNG specification, 9.2)."""
    rows, before = [], np.zeros(row_bytes, np.uint8)
    for at in range(0, len(lines), row_bytes + 1):
        kind, row = lines[at], np.frombuffer(lines, np.uint8, row_bytes, at + 1).copy()
        if kind == 1:  # each byte of a pixel is a running sum of its own
            row = row.reshape(-1, pixel_bytes).cumsum(axis=0, dtype=np.uint8).ravel()
        elif kind == 2:
            row += before
        elif kind in (3, 4):
            values, above = row.tolist(), before.tolist()
            for i, value in enumerate(values):
                left = values[i - pixel_bytes] if i >= pixel_bytes else 0
                corner = above[i - pixel_bytes] if i >= pixel_bytes else 0
                if kind == 3:
                    guess = (left + above[i]) // 2
                else:
                    guess = min((left, above[i], corner), key=lambda near: abs(left + above[i] - corner - near))
                values[i] = (value + guess) & 255
            row = np.array(values, np.uint8)
        elif kind != 0:
            raise Unusable(f"a row has the filter {kind}, expected 0 to 4")
        rows.append(row)
        before = row
    return np.stack(rows)


def read_png(name):
    """Rows of sRGB, 0 to 1."""
    try:
        with open(name, "rb") as file:
            data = file.read()
    except OSError as error:
        raise Unusable(f"{name}: cannot be read: {error.strerror}") from error
    if data[:8] != b"\x89PNG\r\n\x1a\n":
        raise Unusable(f"{name}: is no PNG")
    try:
        at, packed = 8, b""
        while data[at + 4:at + 8] != b"IEND":
            length, kind = struct.unpack(">I4s", data[at:at + 8])
            body = data[at + 8:at + 8 + length]
            if kind == b"IHDR":
                width, height, depth, colours, _, _, interlaced = struct.unpack(">IIBBBBB", body)
            elif kind == b"IDAT":
                packed += body
            at += 12 + length
        if depth != 8 or colours not in CHANNELS or interlaced:
            raise Unusable(f"{name}: {depth} bits of colour type {colours}{', interlaced' if interlaced else ''}; "
                           "expected 8 bits of grey or RGB, not interlaced")
        channels = CHANNELS[colours]
        rows = unfilter(zlib.decompress(packed), width * channels, channels)
        pixels = rows.reshape(height, width, channels)
    except (struct.error, zlib.error, ValueError, UnboundLocalError) as error:
        raise Unusable(f"{name}: is cut off or damaged: {error}") from error
    return (pixels[..., :3] if channels > 2 else pixels[..., :1].repeat(3, axis=2)) / 255


def write_map(name, differences):
    grey = np.round(255 * differences).astype(np.uint8)
    height, width = grey.shape
    lines = b"".join(b"\0" + row.tobytes() for row in grey)
    with open(name, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n")
        header = struct.pack(">IIBBBBB", width, height, 8, 0, 0, 0, 0)
        for kind, body in ((b"IHDR", header), (b"IDAT", zlib.compress(lines)), (b"IEND", b"")):
            file.write(struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body)))


def linear(srgb):
    return np.where(srgb > 0.04045, ((srgb + 0.055) / 1.055) ** 2.4, srgb / 12.92)


def opponents(rgb):
    """Y, Cx, Cz: linear in light, so that filters may be applied."""
    x, y, z = np.moveaxis(rgb @ TO_XYZ.T / WHITE, -1, 0)
    return np.stack([116 * y - 16, 500 * (x - y), 200 * (y - z)])


def rgb_of(opponent):
    y = (opponent[0] + 16) / 116
    xyz = np.stack([y + opponent[1] / 500, y, y - opponent[2] / 200], axis=-1) * WHITE
    return xyz @ np.linalg.inv(TO_XYZ).T


def hunted_lab(rgb):
    """L, a, b, the colours as strong as they look at that lightness."""
    t = rgb @ TO_XYZ.T / WHITE
    edge = 6 / 29
    f = np.where(t > edge ** 3, np.cbrt(t), t / (3 * edge ** 2) + 4 / 29)
    lightness = 116 * f[..., 1] - 16
    return np.stack([lightness, 0.01 * lightness * 500 * (f[..., 0] - f[..., 1]),
                     0.01 * lightness * 200 * (f[..., 1] - f[..., 2])])


def hyab(a, b):
    return np.abs(a[0] - b[0]) + np.hypot(a[1] - b[1], a[2] - b[2])


def along(image, kernel, axis):
    """Convolved with an odd kernel; the border's pixels go on beyond it."""
    radius = len(kernel) // 2
    padded = np.pad(image, [(radius, radius) if a == axis else (0, 0) for a in (0, 1)], mode="edge")
    size = image.shape[axis]
    return sum(weight * padded.take(np.arange(i, i + size), axis) for i, weight in enumerate(kernel))


def separable(image, horizontal, vertical):
    return along(along(image, horizontal, 1), vertical, 0)


def seen(opponent, ppd):
    """What is left of it by the eye's sensitivity to contrast."""
    radius = math.ceil(3 * math.sqrt(0.04 / (2 * math.pi ** 2)) * ppd)
    x = np.arange(-radius, radius + 1) / ppd
    filtered = []
    for channel, gaussians in zip(opponent, (((1, 0.0047),), ((1, 0.0053),), ((34.1, 0.04), (13.5, 0.025)))):
        kernels = [(a * math.sqrt(math.pi / b), np.exp(-(math.pi * x) ** 2 / b)) for a, b in gaussians]
        whole = sum(weight * kernel.sum() ** 2 for weight, kernel in kernels)
        filtered.append(sum(weight / whole * separable(channel, kernel, kernel) for weight, kernel in kernels))
    return np.stack(filtered)


def feature_strengths(lightness, ppd):
    """Of edges and of points, about as wide as an edge that the eye detects."""
    deviation = 0.5 * 0.082 * ppd
    radius = math.ceil(3 * deviation)
    x = np.arange(-radius, radius + 1)
    gauss = np.exp(-x ** 2 / (2 * deviation ** 2))
    strengths = []
    for kernel in (-x * gauss, (x ** 2 / deviation ** 2 - 1) * gauss):
        positive, negative = kernel[kernel > 0].sum(), -kernel[kernel < 0].sum()
        kernel = np.where(kernel > 0, kernel / positive, kernel / negative)
        across = gauss / gauss.sum()
        strengths.append(np.hypot(separable(lightness, kernel, across), separable(lightness, across, kernel)))
    return strengths


def flip(a, b, ppd=USUAL_PPD):
    """The difference of each pixel of two pictures in sRGB, 0 to 1."""
    first, second = opponents(linear(a)), opponents(linear(b))
    colours = [hunted_lab(np.clip(rgb_of(seen(each, ppd)), 0, 1)) for each in (first, second)]
    green, blue = (hunted_lab(np.array([[colour]], float)) for colour in ((0, 1, 0), (0, 0, 1)))
    most = float(hyab(green, blue)[0, 0]) ** 0.7
    error = hyab(*colours) ** 0.7
    knee = 0.4 * most
    error = np.where(error < knee, 0.95 / knee * error, 0.95 + (error - knee) / (most - knee) * 0.05)
    features = [feature_strengths((each[0] + 16) / 116, ppd) for each in (first, second)]
    apart = np.maximum(*(np.abs(one - other) for one, other in zip(*features)))
    return np.clip(error, 0, 1) ** (1 - np.clip(np.sqrt(apart / math.sqrt(2)), 0, 1))
