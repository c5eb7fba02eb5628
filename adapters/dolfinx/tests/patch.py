#!/usr/bin/python3
"""The patch through DOLFINx:  patch.py MATERIAL.toml PATH.csv > dolfinx.csv

A unit square follows u = (F - I) X; P and A come back as integrals of the forms that residual and
stiffness are made of, against virtual fields of unit gradients.
"""
import sys

import numpy as np
from dolfinx import fem, mesh
from mpi4py import MPI

import grainlaw
from grainlaw.dolfinx import Points


def main(material, path):
    domain = mesh.create_unit_square(MPI.COMM_SELF, 1, 1)
    V = fem.VectorFunctionSpace(domain, ("Lagrange", 1))
    u, v, du = fem.Function(V), fem.Function(V), fem.Function(V)
    points = Points(domain, grainlaw.Material(material), degree=1)
    points.set_time_step(1)
    stress, tangent = fem.form(points.stress_power(v)), fem.form(points.stiffness(du, v))
    units = np.eye(4).reshape(4, 2, 2)
    names = [f"{k}{L}" for k in "12" for L in "12"]
    print(",".join([f"P{a}" for a in names] + [f"A{a}{b}" for a in names for b in names]))
    for F in np.loadtxt(path, delimiter=",", skiprows=1).reshape(-1, 2, 2):
        u.interpolate(lambda x, F=F: (F - np.eye(2)) @ x[:2])
        answer = points.evaluate(u)
        if not answer.ok:
            sys.exit(answer.message)
        points.commit()
        row = []
        for test in units:
            v.interpolate(lambda x, G=test: G @ x[:2])
            row.append(fem.assemble_scalar(stress))
        for test in units:
            v.interpolate(lambda x, G=test: G @ x[:2])
            for trial in units:
                du.interpolate(lambda x, G=trial: G @ x[:2])
                row.append(fem.assemble_scalar(tangent))
        print(",".join(f"{number:.17g}" for number in row))


if __name__ == "__main__":
    main(*sys.argv[1:])
