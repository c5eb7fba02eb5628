#!/usr/bin/python3
"""The patch through DOLFINx:  patch.py MATERIAL.toml PATH.csv > dolfinx.csv

A unit square of triangles, or of spheres a unit cube that is one hexahedron, follows u = (F - I) X; P and
A come back as integrals of the forms that residual and stiffness are made of, against virtual fields of
unit gradients.
"""
import sys

import numpy as np
from dolfinx import fem, mesh
from mpi4py import MPI

import grainlaw
from grainlaw.dolfinx import Points


def main(material, path):
    material = grainlaw.Material(material)
    d = material.dimension
    domain = (mesh.create_unit_square(MPI.COMM_SELF, 1, 1) if d == 2 else
              mesh.create_unit_cube(MPI.COMM_SELF, 1, 1, 1, mesh.CellType.hexahedron))
    V = fem.VectorFunctionSpace(domain, ("Lagrange", 1))
    u, v, du = fem.Function(V), fem.Function(V), fem.Function(V)
    points = Points(domain, material, degree=1 if d == 2 else 3)
    points.set_time_step(1)
    stress, tangent = fem.form(points.stress_power(v)), fem.form(points.stiffness(du, v))
    units = np.eye(d * d).reshape(d * d, d, d)
    names = [f"{k}{L}" for k in "123"[:d] for L in "123"[:d]]
    print(",".join([f"P{a}" for a in names] + [f"A{a}{b}" for a in names for b in names]))
    for F in np.loadtxt(path, delimiter=",", skiprows=1).reshape(-1, d, d):
        u.interpolate(lambda x, F=F: (F - np.eye(d)) @ x[:d])
        answer = points.evaluate(u)
        if not answer.ok:
            sys.exit(answer.message)
        points.commit()
        row = []
        for test in units:
            v.interpolate(lambda x, G=test: G @ x[:d])
            row.append(fem.assemble_scalar(stress))
        for test in units:
            v.interpolate(lambda x, G=test: G @ x[:d])
            for trial in units:
                du.interpolate(lambda x, G=trial: G @ x[:d])
                row.append(fem.assemble_scalar(tangent))
        print(",".join(f"{number:.17g}" for number in row))


if __name__ == "__main__":
    main(*sys.argv[1:])
