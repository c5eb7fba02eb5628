#!/usr/bin/env python3
"""Makes an anisotropic sand of a material's packing, with its bedding at angles to the horizontal.

  bedded.py MATERIAL.toml [--stress 100e3] [--rest 1e3] DEGREES ...

The packing is led to a vertical stress without lateral strain, as below ground that has left since, and back to an isotropic
stress at rest. That one packing, turned by each angle, is written beside its material: bedded_90.toml and so on."""
import argparse
import csv
import pathlib
import re

import numpy as np

import grainlaw


def table(path):
    with open(path, encoding="utf-8") as file:
        rows = list(csv.reader(file))
    return rows[0], np.array(rows[1:], float)


def write(path, names, rows, whole):
    with open(path, "w", encoding="utf-8") as file:
        print(*names, sep=",", file=file)
        for row in rows:
            print(*(int(value) if name in whole else repr(float(value)) for name, value in zip(names, row)), sep=",", file=file)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("material")
    parser.add_argument("degrees", nargs="+", type=float)
    parser.add_argument("--stress", type=float, default=100e3)
    parser.add_argument("--rest", type=float, default=1e3)
    ask = parser.parse_args()
    state = grainlaw.State(grainlaw.Material(ask.material))
    state.consolidate(-ask.stress / 2 * np.eye(2))
    state.consolidate(-ask.stress * np.eye(2), route="k0")
    state.consolidate(-ask.rest * np.eye(2), largest_step=0.02)
    fabric = state.measure(grainlaw.Measure.FABRIC)
    print(f"at rest: void ratio {state.measure(grainlaw.Measure.VOID_RATIO):.4f}, fabric {fabric[0, 0]:.3f} along, "
          f"{fabric[1, 1]:.3f} across the bedding")
    text = pathlib.Path(ask.material).read_text(encoding="utf-8")
    state.write_packing("bedded")
    particles, contacts, cell = (table(f"bedded_{what}.csv") for what in ("particles", "contacts", "cell"))
    for degrees in ask.degrees:
        turn = np.radians(degrees)
        R = np.array([[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]])
        name = f"bedded_{degrees:g}"
        turned = [(names, rows.copy()) for names, rows in (particles, contacts, cell)]
        for (names, rows), pairs in zip(turned, ([("x", "y")], [("ftx_on_j", "fty_on_j")],
                                                 [("H00", "H10"), ("H01", "H11")])):
            for pair in pairs:
                columns = [names.index(one) for one in pair]
                rows[:, columns] = rows[:, columns] @ R.T
        for what, (names, rows) in zip(("particles", "contacts", "cell"), turned):
            write(f"{name}_{what}.csv", names, rows, ("id", "i", "j", "shift_x", "shift_y"))
        files = "".join(f'{what} = "{name}_{what}.csv"\n' for what in ("particles", "contacts", "cell"))
        packing = f"[packing]\n{files}"
        pathlib.Path(f"{name}.toml").write_text(
            re.sub(r"\[packing\]\n.*?(?=\n\[)", packing.rstrip(), text, flags=re.S), encoding="utf-8")


if __name__ == "__main__":
    main()
