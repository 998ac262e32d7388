#!/usr/bin/env python3
"""A table of how well spiders walk, over speed x tuning x seed: one row a crowd.

    PYTHONPATH=build/release/python /usr/bin/python3 examples/python/sweep.py --out sweep.csv

Each crowd walks the same ground. The mean over seeds of each speed and tuning is printed; --out writes every row.
"""
import argparse
import csv
import itertools
import sys

import numpy as np

import skitter

# What is set, by the name that the table has for it.
TUNINGS = {
    "usual": {},
    "short strides": {"halfStrideMax": 0.15},
    "high steps": {"stepHeight": 0.3},
}
FIGURES = ["slip", "skating", "penetration", "float", "crossing", "margin", "footJerk"]


def walk(device, ground, speed, tuning, seed, agents, ticks):
    """The figures of one crowd: lengths in leg lengths, as docs/stages/measure.md has them."""
    scene = skitter.Scene.builtin()
    scene.seed = seed
    herd = scene.herds[0]
    herd.agents = agents
    herd.goal.speed = speed
    herd.tuning = skitter.Tuning(**tuning)
    crowd = skitter.Crowd(device, scene, ground, pose=False, watch_every=1)
    crowd.step(ticks)
    return crowd.fidelity()


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--speeds", type=float, nargs="+", default=[0.5, 1, 2], help="leg lengths a second")
    parser.add_argument("--seeds", type=int, default=3, help="so many, from 1 on")
    parser.add_argument("--agents", type=int, default=64)
    parser.add_argument("--ticks", type=int, default=300, help="of 1/60 s")
    parser.add_argument("--out", help="a CSV file for every row")
    options = parser.parse_args()

    device = skitter.Device()
    ground = skitter.Scene.builtin().load_terrain()
    table = []
    for speed, name, seed in itertools.product(options.speeds, TUNINGS, range(1, options.seeds + 1)):
        figures = walk(device, ground, speed, TUNINGS[name], seed, options.agents, options.ticks)
        table.append({"speed": speed, "tuning": name, "seed": seed, **{key: figures[key] for key in FIGURES}})

    print(f"{'speed':>6} {'tuning':<14}" + "".join(f"{key:>13}" for key in FIGURES))
    for speed, name in itertools.product(options.speeds, TUNINGS):
        rows = [row for row in table if (row["speed"], row["tuning"]) == (speed, name)]
        means = [np.mean([row[key] for row in rows]) for key in FIGURES]
        print(f"{speed:>6g} {name:<14}" + "".join(f"{mean:>13.4g}" for mean in means))
    if options.out:
        with open(options.out, "w", newline="") as file:
            writer = csv.DictWriter(file, table[0].keys())
            writer.writeheader()
            writer.writerows(table)
        print(f"{len(table)} rows in {options.out}", file=sys.stderr)


if __name__ == "__main__":
    main()
