import csv
import os
import pathlib
import subprocess
import sys

EXAMPLES = pathlib.Path(__file__).parent.parent.parent / "examples" / "python"


def test_a_sweep_fills_a_table(tmp_path):
    out = tmp_path / "sweep.csv"
    command = [sys.executable, EXAMPLES / "sweep.py", "--speeds", "0.5", "1", "--seeds", "2", "--agents", "8",
               "--ticks", "120", "--out", out]  # fmt: skip
    printed = subprocess.run(command, check=True, capture_output=True, text=True, env=os.environ).stdout
    rows = list(csv.DictReader(out.open()))
    assert len(rows) == 2 * 3 * 2 and len(printed.splitlines()) == 1 + 2 * 3
    assert {row["tuning"] for row in rows} == {"usual", "short strides", "high steps"}
    jerk = {name: {row["footJerk"] for row in rows if row["tuning"] == name} for name in ("usual", "high steps")}
    assert jerk["usual"] != jerk["high steps"] and all(float(row["slip"]) < 0.05 for row in rows)
