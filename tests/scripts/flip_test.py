"""scripts/flip, against what follows from the paper's definitions, and its reading of PNG files."""
import pathlib
import struct
import subprocess
import sys
import tempfile
import unittest
import zlib

import numpy as np

SCRIPTS = pathlib.Path(__file__).resolve().parents[2] / "scripts"
SCRIPT = SCRIPTS / "flip"
sys.dont_write_bytecode = True
sys.path.insert(0, str(SCRIPTS / "lib"))
import flip  # noqa: E402


def even(colour, height=24, width=40):
    return np.broadcast_to(np.array(colour, float), (height, width, 3)).copy()


def picture():
    """Colours and edges of all kinds."""
    return np.random.default_rng(1).integers(0, 256, (6, 9, 3)).repeat(6, axis=0).repeat(6, axis=1) / 255


def encoded(pixels, row_filter):
    """As a PNG of RGB, each row by the same filter, written out by the specification."""
    height, width, _ = pixels.shape
    raw, lines = pixels.astype(int), b""
    for y in range(height):
        lines += bytes([row_filter])
        for x in range(width):
            for c in range(3):
                left = raw[y, x - 1, c] if x else 0
                above = raw[y - 1, x, c] if y else 0
                corner = raw[y - 1, x - 1, c] if x and y else 0
                guess = left + above - corner
                distances = abs(guess - left), abs(guess - above), abs(guess - corner)
                paeth = (left, above, corner)[distances.index(min(distances))]
                lines += bytes([(raw[y, x, c] - (0, left, above, (left + above) // 2, paeth)[row_filter]) & 255])
    header = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    file = b"\x89PNG\r\n\x1a\n"
    for kind, body in ((b"IHDR", header), (b"IDAT", zlib.compress(lines)), (b"IEND", b"")):
        file += struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))
    return file


class Measure(unittest.TestCase):
    def test_equal_pictures_do_not_differ(self):
        self.assertEqual(flip.flip(picture(), picture()).max(), 0)

    def test_the_greatest_difference_is_that_of_green_and_blue(self):
        found = flip.flip(even((0, 1, 0)), even((0, 0, 1)))
        np.testing.assert_allclose(found, 1, atol=1e-9)

    def test_both_ways_are_alike(self):
        a = picture()
        b = np.roll(a, 3, axis=1)
        np.testing.assert_allclose(flip.flip(a, b), flip.flip(b, a), atol=1e-12)

    def test_even_greys_differ_by_their_lightness_alone(self):
        # Grey of Y = 1/8 has L = 116 / 2 - 16 = 42, white 100: 58, in the paper's second part of the curve or first.
        y = 0.125
        grey = 1.055 * y ** (1 / 2.4) - 0.055
        most = float(flip.hyab(flip.hunted_lab(np.array([[[0, 1, 0]]], float)),
                               flip.hunted_lab(np.array([[[0, 0, 1]]], float)))[0, 0]) ** 0.7
        error = 58 ** 0.7
        knee = 0.4 * most
        expected = 0.95 * error / knee if error < knee else 0.95 + 0.05 * (error - knee) / (most - knee)
        np.testing.assert_allclose(flip.flip(even((grey,) * 3), even((1, 1, 1))), expected, atol=1e-6)

    def test_what_is_finer_than_the_eye_sees_hardly_counts(self):
        fine = even((0.5, 0.5, 0.5), 64, 64)
        coarse = fine.copy()
        fine[::2] += 0.1
        coarse[:32] += 0.1
        grey = even((0.5, 0.5, 0.5), 64, 64)
        # Rows of one pixel are lighter by half as much to the eye.
        self.assertLess(flip.flip(grey, fine, 300).max(), flip.flip(grey, coarse, 300)[8].mean())

    def test_edges_count_more_than_what_is_even(self):
        moved, grey = even((0.4, 0.4, 0.4), 40, 60), even((0.4, 0.4, 0.4), 40, 60)
        moved[:, 30:] += 0.2
        found = flip.flip(grey, moved)[20]
        self.assertGreater(found[31], 1.05 * found[55])


class Files(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def file(self, name, data):
        path = pathlib.Path(self.folder.name) / name
        path.write_bytes(data)
        return str(path)

    def run_on(self, *arguments):
        return subprocess.run([SCRIPT, *arguments], capture_output=True, text=True, check=False)

    def test_every_filter_is_read(self):
        pixels = np.random.default_rng(2).integers(0, 256, (7, 5, 3), np.uint8)
        for row_filter in range(5):
            with self.subTest(filter=row_filter):
                read = flip.read_png(self.file("a.png", encoded(pixels, row_filter)))
                np.testing.assert_array_equal(np.round(255 * read), pixels)

    def test_a_map_is_read_back(self):
        differences = np.random.default_rng(3).random((4, 6))
        name = self.file("map.png", b"")
        flip.write_map(name, differences)
        np.testing.assert_allclose(flip.read_png(name)[..., 1], differences, atol=0.5 / 255 + 1e-9)

    def test_exit_codes_tell_the_outcome(self):
        dark, light = (self.file(name, encoded(np.full((8, 8, 3), value, np.uint8), 0))
                       for name, value in (("dark.png", 30), ("light.png", 220)))
        same = self.run_on(dark, dark, "--most", "0")
        self.assertEqual((same.returncode, same.stdout.split(",")[0]), (0, "mean 0.000000"))
        self.assertEqual(self.run_on(dark, light, "--most", "0.5").returncode, 1)
        self.assertEqual(self.run_on(dark, light).returncode, 0)
        small = self.file("small.png", encoded(np.zeros((8, 4, 3), np.uint8), 0))
        cut = self.file("cut.png", encoded(np.zeros((8, 8, 3), np.uint8), 0)[:50])
        for wrong, word in ((small, "4 x 8"), (cut, "damaged"), (self.file("text", b"text"), "no PNG"),
                            (self.folder.name + "/none", "No such file")):
            result = self.run_on(dark, wrong)
            self.assertEqual(result.returncode, 2)
            self.assertIn(word, result.stderr)


if __name__ == "__main__":
    unittest.main()
