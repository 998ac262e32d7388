"""symbols_test.py LIBRARY PROGRAM: the program calls every C++ function, overload by overload, that the library shows.

tests/scripts/public_test.py finds functions by their names, without a build, those of headers alone among them.
"""
import subprocess
import sys

# No program can call these: private functions of classes that are shown.
PRIVATE = {
    "skitter::Device::Device(std::unique_ptr<skitter::gpu::Context, std::default_delete<skitter::gpu::Context> >)",
    "skitter::Spline::placeAt(double) const",
    "skitter::Spline::placeAtLength(double) const",
}
# Values go, and move, in every program.
IS_MOVE = ("&&)", "~")


def functions(file, *options):
    lines = subprocess.run(["nm", "-D", "-C", *options, file], check=True, capture_output=True, text=True).stdout
    for line in lines.splitlines():
        kind, _, name = line[17:].partition(" ")
        if kind in ("T", "U") and name.startswith("skitter::"):
            yield name.partition("@")[0]


library, program = sys.argv[1:]
shown = {name for name in functions(library, "--defined-only") if not any(move in name for move in IS_MOVE)}
missing = sorted(shown - PRIVATE - set(functions(program, "--undefined-only")))
if len(shown) < 150:
    sys.exit(f"{library} shows {len(shown)} functions, expected more: is it stripped?")
for name in missing:
    print(f"{program} does not call {name}")
sys.exit(1 if missing else 0)
