#!/usr/bin/python3
"""A specimen of 0.05 x 0.05 x 0.1 m between rough platens, under a pressure that follows its sides, in
DOLFINx 0.5: verification/scenes/triaxial_rough.toml with plain hexahedra (-order 1) or with the quadratic ones of
20 nodes (-order 2, the default).

    OMP_NUM_THREADS=1 [mpirun -n 2] triaxial_rough.py ../../verification/scenes/spheres200.toml -cells 1 1 2 -steps 20 -output run

Writes run.csv: displacement of the upper platen, force on it, volumetric strain, residual, solves, cuts and
core time. A load step is one unit of time.
"""
import argparse
import time

import numpy as np
import ufl
from dolfinx import fem, mesh
from mpi4py import MPI

from grainlaw.dolfinx import Newton, Points, assembled, end_together, read_material
from grainlaw.files import write_whole

WIDTH, HEIGHT = 0.05, 0.1   # m
COMM = MPI.COMM_WORLD


def arguments():
    how = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    how.add_argument("material")
    how.add_argument("-cells", type=int, nargs=3, default=[1, 1, 2])
    how.add_argument("-order", type=int, choices=[1, 2], default=2)
    how.add_argument("-pressure", type=float, default=100e3, help="on the sides [Pa]")
    how.add_argument("-strain", type=float, default=0.002, help="axial, of a step")
    how.add_argument("-steps", type=int, default=50)
    how.add_argument("-tolerance", type=float, default=1e-6, help="of forces")
    how.add_argument("-lend", action="store_true", help="points between ranks")
    how.add_argument("-output", default="triaxial_rough")
    return how.parse_args()


def run(of):
    domain = mesh.create_box(COMM, [[0, 0, 0], [WIDTH, WIDTH, HEIGHT]], of.cells, mesh.CellType.hexahedron)
    V = fem.VectorFunctionSpace(domain, ("Lagrange", 1) if of.order == 1 else ("S", 2))
    top = fem.locate_dofs_topological(V, 2, mesh.locate_entities_boundary(
        domain, 2, lambda x: np.isclose(x[2], HEIGHT)))
    bottom = fem.locate_dofs_topological(V, 2, mesh.locate_entities_boundary(
        domain, 2, lambda x: np.isclose(x[2], 0)))
    sides = np.unique(np.concatenate([
        mesh.locate_entities_boundary(domain, 2, lambda x: np.isclose(x[axis], place))
        for axis in (0, 1) for place in (0, WIDTH)]))
    tags = mesh.meshtags(domain, 2, sides, np.ones(len(sides), np.int32))
    rule = {"quadrature_degree": 2 * of.order + 1}
    ds = ufl.Measure("ds", domain, subdomain_data=tags, metadata=rule)
    u, fixed, platen = fem.Function(V), fem.Function(V), fem.Function(V)
    F = ufl.Identity(3) + ufl.grad(u)

    def shorten(load):
        platen.x.array[2::3] = -of.strain * of.steps * HEIGHT * load   # at nodes, and the means on edges

    def membrane(v):
        return -of.pressure * ufl.inner(ufl.det(F) * ufl.inv(F).T * ufl.FacetNormal(domain), v) * ds(1)

    points = Points(domain, read_material(COMM, of.material), degree=rule["quadrature_degree"], lend=of.lend)
    newton = Newton(points, u, [fem.dirichletbc(fixed, bottom), fem.dirichletbc(platen, top)],
                    apply=shorten, tell=print, tolerance=of.tolerance, external=membrane)
    upper = np.asarray(top) * 3 + 2
    upper = upper[upper < newton.owned]
    pressed = fem.form(membrane(ufl.TestFunction(V)))   # sides that tilt press along the axis too
    volume = fem.form(ufl.det(F) * points.dx)
    text = ("step[-],top_z_displacement[m],top_z_force[N],volumetric_strain[-],residual[-],iterations[-],cuts[-],"
            "core_time[s]\n")
    for step in range(of.steps + 1):
        solves = cuts = 0
        for part in newton.to(step / of.steps):
            residual, solves, cuts = part.residuals[-1], part.solves, part.cuts
        force = newton.force(upper) - COMM.allreduce(assembled(pressed)[upper].sum())
        dilation = COMM.allreduce(fem.assemble_scalar(volume)) / (WIDTH**2 * HEIGHT) - 1
        core = COMM.allreduce(time.process_time())
        text += (f"{step},{-of.strain * HEIGHT * step:.15g},{force:.15g},{dilation:.12g},{residual:.3g},{solves},"
                 f"{cuts},{core:.1f}\n")
        if COMM.rank == 0:
            print(f"axial strain {of.strain * step:.4f}: {-force:.9g} N, volume {dilation:.5f}, out of balance "
                  f"{residual:.1e}, {solves} solves, {cuts} cuts", flush=True)
            write_whole(of.output + ".csv", text)


if __name__ == "__main__":
    with end_together(COMM):
        run(arguments())
