#!/usr/bin/python3
"""The biaxial test of adapters/biaxial/biaxial.toml in DOLFINx 0.5.

    biaxial.py ../biaxial/material.toml [PREFIX [STEPS]]
    OMP_NUM_THREADS=1 mpirun -n 2 biaxial.py ../biaxial/material.toml

Prints the residuals of Newton's method, and writes PREFIX_force.csv and PREFIX_newton.csv.
"""
import sys

import numpy as np
import ufl
from dolfinx import fem, mesh
from mpi4py import MPI

from grainlaw.dolfinx import Newton, Points, end_together, read_material
from grainlaw.files import write_whole

WIDTH, HEIGHT = 0.05, 0.1   # m
SIDE_PRESSURE = 100e3       # Pa, dead load
SHORTENING = 1e-3           # m, at full load


def main(material, prefix="biaxial", count="20"):
    comm, steps = MPI.COMM_WORLD, int(count)
    domain = mesh.create_rectangle(comm, [[0, 0], [WIDTH, HEIGHT]], [4, 8],
                                   mesh.CellType.triangle, diagonal=mesh.DiagonalType.right)
    V = fem.VectorFunctionSpace(domain, ("Lagrange", 1))
    top = fem.locate_dofs_geometrical(V, lambda x: np.isclose(x[1], HEIGHT))
    bottom = fem.locate_dofs_geometrical(V, lambda x: np.isclose(x[1], 0))
    top_displacement = fem.Constant(domain, np.zeros(2))
    sides = mesh.locate_entities_boundary(
        domain, 1, lambda x: np.isclose(x[0], 0) | np.isclose(x[0], WIDTH))
    tags = mesh.meshtags(domain, 1, np.sort(sides), np.ones(len(sides), np.int32))
    ds = ufl.Measure("ds", domain, subdomain_data=tags)

    def shorten(load):
        top_displacement.value = (0, -SHORTENING * load)

    newton = Newton(
        Points(domain, read_material(comm, material), degree=1), fem.Function(V),
        [fem.dirichletbc(np.zeros(2), bottom, V), fem.dirichletbc(top_displacement, top, V)],
        apply=shorten, tell=print, tolerance=1e-10,
        external=lambda v: -SIDE_PRESSURE * ufl.inner(ufl.FacetNormal(domain), v) * ds(1))
    force = "step[-],fraction[-],top_y_displacement[m],top_y_force[N/m]\n"
    iterations = "step[-],iteration[-],relative_residual[-]\n"
    for step in range(steps + 1):
        for part in newton.to(step / steps):
            top_force = newton.force(2 * top + 1)
            force += f"{step},{part.load:.17g},{-SHORTENING * part.load:.17g},{top_force:.17g}\n"
            for iteration, residual in enumerate(part.residuals, 1):
                iterations += f"{step},{iteration},{residual:.17g}\n"
            if comm.rank == 0:
                print(f"load {part.load:.6g}: force {top_force:.6g} N/m, residuals",
                      ", ".join(f"{residual:.1e}" for residual in part.residuals), flush=True)
                write_whole(prefix + "_force.csv", force)   # on a full disk the steps before stay
                write_whole(prefix + "_newton.csv", iterations)


if __name__ == "__main__":
    if not 2 <= len(sys.argv) <= 4:
        sys.exit(__doc__)
    with end_together(MPI.COMM_WORLD):
        main(*sys.argv[1:])
