#!/usr/bin/python3
"""A pit in sand full of water in DOLFINx 0.5: it is dug beside a smooth wall before water can flow, then
its floor drains.

    wet_pit.py SAND.toml [OUTPUT.csv]
    OMP_NUM_THREADS=1 mpirun -n 2 wet_pit.py SAND.toml

Prints pore pressures, heave and the force out of balance. OUTPUT.csv has stress and pore pressure of every
point; wet_pit.edp of FreeFEM writes the same. Ends with a status that is not 0 where a step is not balanced
to 1e-6 of the weight, sealed ground changes its volume, or the base does not bear what is left.
"""
import sys

import numpy as np
import ufl
from dolfinx import fem, mesh
from mpi4py import MPI

from grainlaw.dolfinx import end_together
from grainlaw.dolfinx_ground import Ground, Layer
from grainlaw.dolfinx_water import PoreWater
from grainlaw.files import write_whole

COMM = MPI.COMM_WORLD
SURCHARGE = 20e3   # Pa, of total and grains
FLOWS = 400.0      # s, of the stage in which water flows


def top(x):
    return np.isclose(x[1], 0)


def pit(x):
    return (x[0] < 1) & (x[1] > -1)


def tell(text):
    if COMM.rank == 0:
        print(text, flush=True)


def resting(sand, comm=COMM, **how):
    """Two metres by three of ground under water and a surcharge."""
    domain = mesh.create_rectangle(comm, [[0, -3], [2, 0]], [2, 3], mesh.CellType.triangle,
                                   diagonal=mesh.DiagonalType.right)
    ground = Ground(domain, 0, [Layer(-3, sand, 2650 - 1000)], water=PoreWater(permeability=1e-9), degree=5,
                    **{"tolerance": 1e-11, **how})
    ground.hold(lambda x: np.isclose(x[1], -3), 1)
    ground.hold(lambda x: np.isclose(x[0], 0) | np.isclose(x[0], 2), 0)
    ground.traction(top, 1, -SURCHARGE)
    ground.geostatic(SURCHARGE)
    list(ground.to(0))
    return ground


def dig(ground):
    """The surcharge of the pit goes, the pit goes: all sealed. Then its floor is drained."""
    ground.stage()
    ground.traction(lambda x: top(x) & (x[0] < 1.01), 1, SURCHARGE)
    yield from ground.to(1)
    ground.stage()
    ground.hold(lambda x: np.isclose(x[0], 1) & (x[1] > -1.01), 0)
    ground.excavate(pit)
    for part in (0.5, 1):
        yield from ground.to(part)
    ground.stage()
    ground.drain(lambda x: (x[0] < 1.01) & np.isclose(x[1], -1))
    ground.step_time = FLOWS / 4   # of each of its four steps
    for part in (0.25, 0.5, 0.75, 1):
        yield from ground.to(part)


def rows(ground, step):
    """Stress of the grains and pore pressure of the points of all ranks that have not left."""
    points = ground.points
    P, p = points.values(points.P).reshape(-1, 4), points.values(ufl.split(ground.u)[1])
    there = ~points.gone
    own = np.column_stack([np.full(there.sum(), step), points.x[there], P[there], p[there]])
    return np.concatenate(ground.comm.allgather(own))


def volume(ground):
    """Of what has not left [m2]."""
    there, F = ground.points.scalars(~ground.points.gone), ufl.Identity(2) + ufl.grad(ufl.split(ground.u)[0])
    return ground.comm.allreduce(fem.assemble_scalar(fem.form(there * ufl.det(F) * ground.points.dx)))


def main(sand, output=None):
    ground = resting(sand)
    weight = ground.weight()
    table, volumes = [rows(ground, 0)], [volume(ground)]
    for step, part in enumerate(dig(ground), 1):
        now, left = rows(ground, step), ground.out_of_balance() / weight
        heave = COMM.allreduce(ground.moved(lambda x: x[1] > -9, 1).max(), MPI.MAX)
        tell(f"step {step}: pore pressure from {now[:, 7].min():.6g} to {now[:, 7].max():.6g} Pa, heave "
             f"{1e3 * heave:.6g} mm, out of balance {left:.1e} of the weight, {part.solves} iterations, "
             f"{part.cuts} cuts")
        assert left < 1e-6
        table.append(now)
        volumes.append(volume(ground))
    grown = max(abs(volumes[1] - volumes[0]), abs(volumes[3] - volumes[2]))
    tell(f"sealed, it grows by {grown:.1e} m2")
    borne, left = ground.force(lambda x: np.isclose(x[1], -3), 1), ground.weight() + SURCHARGE
    tell(f"the base bears {borne:.9g} N/m of {left:.9g}")
    if output is not None and COMM.rank == 0:
        write_whole(output, "step[-],x[m],y[m],P11[Pa],P12[Pa],P21[Pa],P22[Pa],p[Pa]\n" + "".join(
            ",".join(f"{value:.15g}" for value in row) + "\n" for row in np.concatenate(table)))
    assert grown < 1e-9 and abs(borne / left - 1) < 1e-6


if __name__ == "__main__":
    if not 2 <= len(sys.argv) <= 3:
        sys.exit(__doc__)
    with end_together(COMM):
        main(*sys.argv[1:])
