#!/usr/bin/env python3
"""Undrained cyclic simple shear of the packing of cyclic_shear.edp alone, and how far the column is from it.

  cyclic_element.py MATERIAL.toml [--curve cyclic_shear.csv] [--alike 1] [--strain 0.01] [--steps 20]
                    [--cycles 20] [--surcharge 100e3] [--until 0.95]

The packing is led to the vertical stress without lateral strain; then it is sheared to and fro at constant
volume. The ratio of pore pressure is what the vertical stress has lost, over what it was. With --curve the
status is not 0 where the column, in so many cycles (--alike), differs by more than 1e-6 of the surcharge in shear
stress or pressure, or changed its volume by more than 1e-10, or has steps out of balance by more than 1e-6."""
import argparse
import csv
import sys
import warnings

import numpy as np

import grainlaw
from grainlaw import laboratory


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("material")
    parser.add_argument("--curve")
    for name, value in (("alike", 1.0), ("strain", 0.01), ("steps", 20), ("cycles", 20), ("surcharge", 100e3),
                        ("until", 0.95)):
        parser.add_argument(f"--{name}", type=type(value), default=value)
    ask = parser.parse_args()
    warnings.simplefilter("ignore")           # what drag carries is told by every test
    state = grainlaw.State(grainlaw.Material(ask.material))
    state.consolidate(-ask.surcharge / 2 * np.eye(2))
    first = state.consolidate(-ask.surcharge * np.eye(2), route="k0")
    test = laboratory.shear_constant_volume(
        state, step=ask.strain / ask.steps, tolerance=1e-6,
        loops=laboratory.Loops(ask.cycles, strain=ask.strain), stop=laboratory.Stop(liquefied=(1 - ask.until) / 4))
    ratio = 1 - test.sigma[:, 1, 1] / first[1, 1]
    reached = np.flatnonzero(ratio >= ask.until)
    last = reached[0] if len(reached) else len(ratio) - 1
    for row in range(4 * ask.steps, last + 1, 4 * ask.steps):
        print(f"{row // (4 * ask.steps)} cycles: ratio {ratio[row]:.4f}, highest so far {ratio[:row + 1].max():.4f}")
    print(f"K0 {first[0, 0] / first[1, 1]:.3f}; a ratio of {ask.until} "
          f"{'was reached after' if len(reached) else 'was not reached in'} {last / (4 * ask.steps):g} cycles")
    if ask.curve:
        compare(ask, test.sigma[:last + 1, 0, 1], ratio[:last + 1] * ask.surcharge)


def compare(ask, shear, pressure):
    """The column beside the element, in cycles while rounding has not led them apart, and in all."""
    with open(ask.curve, encoding="utf-8") as file:
        column = {name: [] for name in csv.DictReader(file).fieldnames}
        file.seek(0)
        for row in csv.DictReader(file):
            for name, value in row.items():
                column[name].append(float(value))
    count = min(len(shear), len(column["cycle[-]"]))
    gap = np.maximum(np.abs(np.array(column["shear_stress[Pa]"][:count]) - shear[:count]),
                     np.abs(np.array(column["pore_pressure[Pa]"][:count]) - pressure[:count])) / ask.surcharge
    volume, residual = np.array(column["volume[-]"]), max(column["residual[-]"])
    alike = round(4 * ask.steps * ask.alike) + 1
    print(f"the column in {ask.alike:g} cycles: to {gap[:alike].max():.1e} of the surcharge, |det F - 1| "
          f"{volume[:alike].max():.1e}; in {(count - 1) / (4 * ask.steps):g} cycles: {gap.max():.1e}, "
          f"{volume[:count].max():.1e}; out of balance {residual:.1e}")
    if not (count >= alike and gap[:alike].max() < 1e-6 and volume[:alike].max() < 1e-10 and residual < 1e-6):
        sys.exit("cyclic_element: the column is not the element")


if __name__ == "__main__":
    main()
