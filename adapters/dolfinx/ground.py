#!/usr/bin/python3
"""Layers of sand under their weight in DOLFINx 0.5, and an excavation in stages.

    ground.py UPPER.toml LOWER.toml
    OMP_NUM_THREADS=1 mpirun -n 2 ground.py UPPER.toml LOWER.toml

Prints the force out of balance before anything moves, after ten steps of nothing, and the heave of the
pit. Ends with a status that is not 0 where the ground does not rest, or a row does not carry the weight
above it.
"""
import sys

import numpy as np
from dolfinx import mesh
from mpi4py import MPI

from grainlaw.dolfinx import end_together
from grainlaw.dolfinx_ground import Ground, Layer


def tell(text):
    """On one rank."""
    if MPI.COMM_WORLD.rank == 0:
        print(text, flush=True)


def stress_error(ground, height):
    """Of the mean vertical stress of what is left, against the weight above it below a height [-]."""
    points = ground.points
    P = points.values(points.P[1, 1])[~points.gone]
    pressure = ground.pressure(points.x[:, 1]) - ground.pressure(np.array([height]))
    stress, above = ground.comm.allreduce(np.array([P.sum(), pressure[~points.gone].sum()]))
    return abs(stress / above + 1)


def main(upper, lower):
    domain = mesh.create_rectangle(MPI.COMM_WORLD, [[0, -4], [2, 0]], [2, 4],
                                   mesh.CellType.triangle, diagonal=mesh.DiagonalType.right)
    ground = Ground(domain, 0, [Layer(-2, upper, 2650), Layer(-4, lower, 2600)])
    ground.hold(lambda x: np.isclose(x[1], -4), 1)
    ground.hold(lambda x: np.isclose(x[0], 0) | np.isclose(x[0], 2), 0)
    ground.geostatic()
    weight = ground.weight()
    worst = ground.out_of_balance() / weight
    tell(f"weight {weight / 1e3:.6g} kN/m, out of balance {worst:.1e} of it")
    for step in range(11):   # nothing happens, ten times
        list(ground.to(step / 10))
        worst = max(worst, ground.out_of_balance() / weight)
    moved = domain.comm.allreduce(np.abs(ground.u.x.array).max(), MPI.MAX)
    tell(f"after ten steps of nothing: {worst:.1e} of it, moved by {moved:.1e} m; mean vertical stress "
         f"against the weight above {stress_error(ground, 0):.1e}")
    assert worst < 1e-6 and moved < 1e-9 and stress_error(ground, 0) < 1e-6
    ground.stage()
    ground.excavate(lambda x: x[1] > -1)
    for step in range(4):
        list(ground.to((step + 1) / 4))
        heave = domain.comm.allreduce(ground.u.x.array[1::2].max(), MPI.MAX)
        tell(f"excavated by {25 * (step + 1)} %: heave {1e3 * heave:.6g} mm")
    tell(f"mean vertical stress against the weight above: {stress_error(ground, -1):.1e}")
    assert stress_error(ground, -1) < 1e-6


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    with end_together(MPI.COMM_WORLD):
        main(*sys.argv[1:])
