"""Includes lead down through the folders of docs/architecture.md, never up."""
import pathlib
import re
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
# From the bottom to the top. A file may include what is in its own folder or in one before it.
FOLDERS = ["include", "shaders", "engine/base", "engine/gpu", "engine/assets", "engine/ik", "engine/spline", "engine/ways",
           "engine/crowd", "engine/evolve", "render", "cpu_reference", "validation", "laws", "bench", "experiments", "bindings", "app"]
# Within these the same holds of their own folders; "" is the folder itself.
INNER = {
    "engine/assets": ["files", "materials", "models", "rigs", "clips", "heights", "scenes"],
    "cpu_reference": ["", "ik", "spline", "clips", "ways", "stages", "evolve"],
}
INCLUDE_ROOTS = ["", "engine", "include", "shaders"]


def files():
    return [path for folder in FOLDERS for path in sorted((ROOT / folder).rglob("*")) if path.suffix in (".cpp", ".h")]


def place(path):
    """Where the file is: its folder's number, its inner folder's number."""
    name = path.relative_to(ROOT).as_posix()
    folder = next((each for each in FOLDERS if name.startswith(each + "/")), None)
    if folder is None:
        return None
    inner = INNER.get(folder, [""])
    under = path.parent.relative_to(ROOT / folder).as_posix().replace(".", "", 1)
    return FOLDERS.index(folder), inner.index(under) if folder in INNER else 0


def included(path):
    """The files of the project that it includes."""
    for name in re.findall(r'^#include "([^"]+)"', path.read_text(), re.M):
        places = [path.parent / name, *(ROOT / root / name for root in INCLUDE_ROOTS)]
        found = next((each.resolve() for each in places if each.is_file()), None)
        if found:
            yield found


class Arrows(unittest.TestCase):
    def test_lead_down(self):
        up = [f"{path.relative_to(ROOT)} includes {other.relative_to(ROOT)}"
              for path in files() for other in included(path) if place(other) and place(other) > place(path)]
        self.assertEqual(up, [])

    def test_of_the_reference_and_of_the_laws_stay_in_them(self):
        out = [f"{path.relative_to(ROOT)} includes {other.relative_to(ROOT)}"
               for folder in (ROOT / "cpu_reference", ROOT / "laws")
               for path in files() if folder in path.parents
               for other in included(path) if folder not in other.parents]
        self.assertEqual(out, [])

    def test_are_found(self):
        self.assertGreater(sum(1 for path in files() for _ in included(path)), 1000)


if __name__ == "__main__":
    unittest.main()
