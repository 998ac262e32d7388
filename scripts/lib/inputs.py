"""Creatures and grounds for scripts that run the command: what scripts/validate-all and scripts/zoo share."""
import array
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
SHARED = ROOT.parent / "shared" / "data"
TERRAIN = ROOT / "assets" / "terrain"


def said(skitter, *arguments):
    done = subprocess.run([skitter, *map(str, arguments)], capture_output=True, text=True)
    return done.returncode, done.stdout, done.stderr.strip()


def leg_length(text):
    """Metres, from what `skitter inspect` printed about a model; None where it has no legs."""
    found = re.search(r"leg length ([\d.e+-]+) m", text)
    return float(found[1]) if found else None


def write_heights(folder, name, columns, rows, spacing, height):
    """A grid of heights(column, row), in metres, as the terrain of a scene in the same folder."""
    file = folder / f"{name}_{columns}x{rows}.r32f"
    samples = array.array("f", (height(x, z) for z in range(rows) for x in range(columns)))
    if sys.byteorder == "big":
        samples.byteswap()
    file.write_bytes(samples.tobytes())
    return {"kind": "file", "file": file.name, "spacingX": spacing, "spacingZ": spacing}
