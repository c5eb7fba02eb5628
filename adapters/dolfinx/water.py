#!/usr/bin/python3
"""Terzaghi's column of sand with pore water in DOLFINx 0.5, drained at its top.

    water.py MATERIAL.toml
    OMP_NUM_THREADS=1 mpirun -n 2 water.py MATERIAL.toml

A load that comes at once settles as the water leaves. Prints the degree of consolidation beside that of
Terzaghi's series, whose stiffness is that of the packing's exact tangent. Ends with a status that is not
0 where they differ by more than 1 %.
"""
import sys

import numpy as np
import ufl
from dolfinx import fem, mesh
from mpi4py import MPI

from grainlaw.dolfinx import Points, end_together, read_material
from grainlaw.dolfinx_water import PoreWater, WaterNewton, water_space

HEIGHT, WIDTH = 1.0, 0.1   # m
STRAIN = 1e-6              # that the load makes in the end


def terzaghi(time):
    """Share of the settlement by the time cv t / H^2."""
    M = np.pi / 2 * (2 * np.arange(200) + 1)
    return 1 - np.sum(2 / M**2 * np.exp(-M**2 * time))


def column(comm, material, water, layers=8):
    """Newton of the column, its load [Pa], the stiffness [Pa] and the unknowns on top."""
    domain = mesh.create_rectangle(comm, [[0, 0], [WIDTH, HEIGHT]], [1, layers], mesh.CellType.triangle)
    V = water_space(domain)

    def on(space, side):
        collapsed = space.collapse()[0]
        dofs = fem.locate_dofs_geometrical((space, collapsed), side)
        return fem.dirichletbc(fem.Function(collapsed), dofs, space), dofs[0]

    base, sides, drained = (on(space, side)[0] for space, side in (
        (V.sub(0).sub(1), lambda x: np.isclose(x[1], 0)),
        (V.sub(0).sub(0), lambda x: np.isclose(x[0], 0) | np.isclose(x[0], WIDTH)),
        (V.sub(1), lambda x: np.isclose(x[1], HEIGHT))))
    top = on(V.sub(0).sub(1), lambda x: np.isclose(x[1], HEIGHT))[1]
    facets = mesh.locate_entities_boundary(domain, 1, lambda x: np.isclose(x[1], HEIGHT))
    tags = mesh.meshtags(domain, 1, np.sort(facets), np.ones(len(facets), np.int32))
    ds = ufl.Measure("ds", domain, subdomain_data=tags)
    points, pressure = Points(domain, material, degree=2), fem.Constant(domain, 0.0)
    newton = WaterNewton(points, fem.Function(V), [base, sides, drained], lambda load: None, water,
                         external=lambda v: -pressure * v[1] * ds(1), tolerance=1e-10)
    rest, stiffness = comm.bcast((-points.P.x.array[3], points.A.x.array[15]))   # P22, dP22/dF22
    pressure.value = rest + STRAIN * stiffness
    return newton, stiffness, top


def main(path):
    comm, water = MPI.COMM_WORLD, PoreWater(permeability=1e-9)
    newton, stiffness, top = column(comm, read_material(comm, path), water)
    own = top[top < newton.owned]
    cv, time, step, worst = water.permeability * stiffness / HEIGHT**2, 0.0, 0, 0.0
    list(newton.to(0))
    for target in (0.197, 0.848):
        begin = max(time, 1e-3)
        steps = 20 * int(np.ceil(np.log(target / begin)))
        for share in np.arange(time > 0, steps + 1) / steps:   # each a twentieth longer than the one before
            later, step = begin * (target / begin)**share, step + 1
            newton.step_time, time = (later - time) / cv, later
            list(newton.to(step))
            moved = comm.allreduce(newton.u.x.array[own].min(initial=0), MPI.MIN)
            U = -moved / (STRAIN * HEIGHT)
            if time > 0.06:   # the water of more than two elements has begun to flow
                worst = max(worst, abs(U / terzaghi(time) - 1))
        if comm.rank == 0:
            print(f"Tv {time:.4g}: {U:.12g}, by the series {terzaghi(time):.6f}", flush=True)
    assert worst < 0.01, worst


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    with end_together(MPI.COMM_WORLD):
        main(sys.argv[1])
