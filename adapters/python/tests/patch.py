#!/usr/bin/env python3
"""The patch through the package:  patch.py MATERIAL.toml PATH.csv > python.csv"""
import sys

import numpy as np

import grainlaw


def main(material, path):
    point = grainlaw.State(grainlaw.Material(material))
    point.set_time_step(1)
    d = point.dimension
    component = [f"{k}{L}" for k in "123"[:d] for L in "123"[:d]]
    print(",".join([f"P{c}" for c in component]
                   + [f"A{c}{e}" for c in component for e in component]))
    for F in np.loadtxt(path, delimiter=",", skiprows=1):
        answer = point.evaluate(F.reshape(d, d), grainlaw.Tangent.EXACT)
        if not answer.ok:
            sys.exit(answer.message)
        point.commit()
        print(",".join(f"{number:.17g}" for number in [*answer.P.flat, *answer.A.flat]))


if __name__ == "__main__":
    main(*sys.argv[1:])
