#!/usr/bin/python3
"""The triaxial test of adapters/biaxial/triaxial.toml in DOLFINx 0.5.

    triaxial.py ../patch/spheres_in_time.toml [PREFIX [STEPS [SHORTENING]]]

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


def main(material, prefix="triaxial", count="5", shortening="5e-4"):
    comm, steps, full = MPI.COMM_WORLD, int(count), float(shortening)
    domain = mesh.create_box(comm, [[0, 0, 0], [WIDTH, WIDTH, HEIGHT]], [1, 1, 2],
                             mesh.CellType.hexahedron)
    V = fem.VectorFunctionSpace(domain, ("Lagrange", 1))
    top = fem.locate_dofs_geometrical(V, lambda x: np.isclose(x[2], HEIGHT))
    bottom = fem.locate_dofs_geometrical(V, lambda x: np.isclose(x[2], 0))
    top_displacement = fem.Constant(domain, np.zeros(3))
    sides = np.unique(np.concatenate([
        mesh.locate_entities_boundary(domain, 2, lambda x: np.isclose(x[axis], place))
        for axis in (0, 1) for place in (0, WIDTH)]))
    tags = mesh.meshtags(domain, 2, sides, np.ones(len(sides), np.int32))
    ds = ufl.Measure("ds", domain, subdomain_data=tags)

    def shorten(load):
        top_displacement.value = (0, 0, -full * load)

    newton = Newton(
        Points(domain, read_material(comm, material), degree=3), fem.Function(V),
        [fem.dirichletbc(np.zeros(3), bottom, V), fem.dirichletbc(top_displacement, top, V)],
        apply=shorten, tell=print, tolerance=1e-10,
        external=lambda v: -SIDE_PRESSURE * ufl.inner(ufl.FacetNormal(domain), v) * ds(1))
    force = "step[-],fraction[-],top_z_displacement[m],top_z_force[N]\n"
    iterations = "step[-],iteration[-],relative_residual[-]\n"
    for step in range(steps + 1):
        for part in newton.to(step / steps):
            top_force = newton.force(3 * top + 2)
            force += f"{step},{part.load:.17g},{-full * part.load:.17g},{top_force:.17g}\n"
            for iteration, residual in enumerate(part.residuals, 1):
                iterations += f"{step},{iteration},{residual:.17g}\n"
            if comm.rank == 0:
                print(f"load {part.load:.6g}: force {top_force:.6g} N, residuals",
                      ", ".join(f"{residual:.1e}" for residual in part.residuals), flush=True)
                write_whole(prefix + "_force.csv", force)
                write_whole(prefix + "_newton.csv", iterations)


if __name__ == "__main__":
    if not 2 <= len(sys.argv) <= 5:
        sys.exit(__doc__)
    with end_together(MPI.COMM_WORLD):
        main(*sys.argv[1:])
