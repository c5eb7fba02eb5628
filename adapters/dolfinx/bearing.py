#!/usr/bin/python3
"""A rough strip footing, 2 m wide, on sand that rests under its weight and a surcharge, in DOLFINx 0.5: half
of it is modelled, by quadratic triangles. The same problem as bearing.edp of FreeFEM, on another mesh.

    OMP_NUM_THREADS=1 [mpirun -n 2] bearing.py SAND.toml -gravity 1e-9 -settlement 0.18 -steps 90 -output run

-gravity 1e-9: without weight. Writes run.csv (settlement, pressure under the footing, the same over the
surcharge), run.xdmf (displacement, shear strain, void ratio) and the packing below its edge as run_edge.vtp.
Bounds: strength.py of FreeFEM.
"""
import argparse

import numpy as np
from dolfinx import mesh
from mpi4py import MPI

from grainlaw.dolfinx import end_together
from grainlaw.dolfinx_ground import Ground, Layer
from grainlaw.dolfinx_output import write_curve, write_fields, write_packing

WIDTH, DEPTH, FOOT = 7, 4, 1   # m
RATE = 5e-4                    # strain of a unit of time, viscous_rate of the sand
COMM = MPI.COMM_WORLD


def arguments():
    how = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    how.add_argument("material")
    how.add_argument("-gravity", type=float, default=9.81)
    how.add_argument("-surcharge", type=float, default=20e3, help="[Pa]")
    how.add_argument("-settlement", type=float, default=0.1, help="over the width")
    how.add_argument("-steps", type=int, default=50)
    how.add_argument("-fine", type=int, default=1, help="half of the cells below half of the footing")
    how.add_argument("-rehearse", action="store_true")
    how.add_argument("-output", default="bearing")
    return how.parse_args()


def graded(fine):
    """Cells grow with their distance from the footing."""
    domain = mesh.create_rectangle(COMM, [[0, 0], [5, 3]], [5 * fine, 3 * fine], mesh.CellType.triangle)
    x = domain.geometry.x
    beyond = np.maximum(x[:, 0] - 2, 0) / 3
    x[:, 0] = FOOT * np.minimum(x[:, 0], 2) / 2 + (WIDTH - FOOT) * beyond**1.6
    x[:, 1] = -DEPTH * (1 - x[:, 1] / 3)**1.6
    return domain


def top(x):
    return np.isclose(x[1], 0)


def under(x):
    return top(x) & (x[0] < FOOT + 1e-9)


def resting(of):
    ground = Ground(graded(of.fine), 0, [Layer(-DEPTH, of.material, 2650)], gravity=of.gravity, order=2,
                    rehearse=of.rehearse, tolerance=1e-8, step_time=of.settlement / of.steps / RATE)
    for axis in (0, 1):
        ground.hold(lambda x: np.isclose(x[1], -DEPTH), axis)
    ground.hold(lambda x: np.isclose(x[0], 0) | np.isclose(x[0], WIDTH), 0)
    ground.traction(top, 1, -of.surcharge)
    ground.geostatic(of.surcharge)
    list(ground.to(0))
    return ground


def main():
    of = arguments()
    ground = resting(of)
    ground.stage()
    ground.hold(under, 0)
    ground.hold(under, 1, -2 * of.settlement * FOOT)

    def measured(done):
        pressure = of.surcharge - ground.force(under, 1) / FOOT
        return 2 * of.settlement * FOOT * done, pressure, pressure / of.surcharge

    write_curve(ground, of.steps, ("settlement[m]", "pressure[Pa]", "ratio[-]"), measured, of.output + ".csv")
    write_fields(ground, of.output + ".xdmf")
    if not of.rehearse:
        write_packing(ground, (FOOT, -0.2), of.output + "_edge.vtp")


if __name__ == "__main__":
    with end_together(COMM):
        main()
