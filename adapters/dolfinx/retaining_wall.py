#!/usr/bin/python3
"""A rigid wall before sand, 1 m high, in DOLFINx 0.5: the sand rests by K0, then the wall moves away from it
(active) or into it (passive). The same problem as retaining_wall.edp of FreeFEM.

    OMP_NUM_THREADS=1 [mpirun -n 2] retaining_wall.py SAND.toml -way active -wall smooth -output run

Writes run.csv (force of the sand on a metre of the wall, and K: over half of the weight beside it times its
height of the moment), run.xdmf (displacement, shear strain, void ratio), and the packings of a point beside
the wall and of one far from it as run_near.vtp, run_far.vtp.
"""
import argparse

import numpy as np
from dolfinx import mesh
from mpi4py import MPI

from grainlaw.dolfinx import end_together
from grainlaw.dolfinx_ground import Ground, Layer
from grainlaw.dolfinx_output import write_curve, write_fields, write_packing

RATE = 5e-4   # strain of a unit of time, viscous_rate of the sand
COMM = MPI.COMM_WORLD


def arguments():
    how = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    how.add_argument("material")
    how.add_argument("-way", choices=("active", "passive"), default="active")
    how.add_argument("-wall", choices=("smooth", "rough"), default="smooth")
    how.add_argument("-base", choices=("smooth", "rough"), default="smooth")
    how.add_argument("-move", type=float, default=0.05, help="of the wall over its height")
    how.add_argument("-steps", type=int, default=25)
    how.add_argument("-cells", type=int, default=4, help="over the height")
    how.add_argument("-width", type=float, default=2, help="of the sand [m]")
    how.add_argument("-rehearse", action="store_true")
    how.add_argument("-output", default="retaining_wall")
    return how.parse_args()


def wall(x):
    return np.isclose(x[0], 0)


def base(x):
    return np.isclose(x[1], -1)


def resting(of):
    domain = mesh.create_rectangle(COMM, [[0, -1], [of.width, 0]], [int(of.width * of.cells), of.cells],
                                   mesh.CellType.triangle, diagonal=mesh.DiagonalType.right)
    ground = Ground(domain, 0, [Layer(-1, of.material, 2650)], rehearse=of.rehearse, tolerance=1e-8,
                    step_time=of.move / of.width / of.steps / RATE)
    ground.hold(base, 1)
    ground.hold(lambda x: wall(x) | np.isclose(x[0], of.width), 0)
    ground.geostatic()
    list(ground.to(0))
    return ground


def main():
    of = arguments()
    ground = resting(of)
    ground.stage()
    if of.base == "rough":
        ground.hold(lambda x: base(x) & ~wall(x), 0)
    if of.wall == "rough":
        ground.hold(wall, 1)
    ground.hold(wall, 0, of.move if of.way == "passive" else -of.move)

    def measured(done):
        top = ground.moved(lambda x: wall(x) & np.isclose(x[1], 0), 1)
        height = 1 + COMM.allreduce(top.min(initial=np.inf), MPI.MIN)
        force = ground.force(wall, 0)
        return of.move * done, force, force / (ground.unit_weights[0] * height / 2)

    write_curve(ground, of.steps, ("displacement[m]", "force[N/m]", "K[-]"), measured, of.output + ".csv")
    write_fields(ground, of.output + ".xdmf")
    if not of.rehearse:
        write_packing(ground, (0.1, -0.6), of.output + "_near.vtp")
        write_packing(ground, (of.width, -0.6), of.output + "_far.vtp")


if __name__ == "__main__":
    with end_together(COMM):
        main()
