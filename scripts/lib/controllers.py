"""The names of the controllers (include/skitter/controller.h)."""
import pathlib
import re

HEADER = pathlib.Path(__file__).resolve().parents[2] / "include" / "skitter" / "controller.h"
CONTROLLERS = re.findall(r'"([a-z-]+)"', re.search(
    r"nameOf\(Controller controller\).*?\{([^{}]*)\};", HEADER.read_text(), re.S)[1])
