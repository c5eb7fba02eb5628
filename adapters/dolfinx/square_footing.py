#!/usr/bin/python3
"""A rough square footing, 1 m wide, on sand of spheres under its weight and a surcharge, in DOLFINx 0.5: a
quarter of it is modelled, by quadratic tetrahedra.

    OMP_NUM_THREADS=1 [mpirun -n 2] square_footing.py ground_spheres.toml -settlement 0.05 -steps 25 -output run

Writes run.csv (settlement, pressure under the footing, the same over the surcharge, what the base bears over
all loads), run.xdmf (displacement, shear strain, void ratio) and the packing below its edge as run_edge.vtp.
Ends with a status that is not 0 where the base does not bear weight, surcharge and footing.
"""
import argparse

import numpy as np
from dolfinx import mesh
from mpi4py import MPI

from grainlaw.dolfinx import end_together
from grainlaw.dolfinx_ground import Ground, Layer
from grainlaw.dolfinx_output import write_curve, write_fields, write_packing

WIDTH, DEPTH, FOOT = 2, 1.5, 0.5   # m, of a quarter
RATE = 5e-4                        # strain of a unit of time, viscous_rate of the sand
COMM = MPI.COMM_WORLD


def arguments():
    how = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    how.add_argument("material")
    how.add_argument("-gravity", type=float, default=9.81)
    how.add_argument("-surcharge", type=float, default=20e3, help="[Pa]")
    how.add_argument("-settlement", type=float, default=0.05, help="over the width")
    how.add_argument("-steps", type=int, default=25)
    how.add_argument("-fine", type=int, default=1, help="cells below half of the footing")
    how.add_argument("-rehearse", action="store_true")
    how.add_argument("-output", default="square_footing")
    return how.parse_args()


def graded(fine):
    """Cells grow with their distance from the footing."""
    domain = mesh.create_box(COMM, [[0, 0, 0], [2, 2, 2]], [2 * fine] * 3, mesh.CellType.tetrahedron)
    x = domain.geometry.x
    x[:, :2] = FOOT * np.minimum(x[:, :2], 1) + (WIDTH - FOOT) * np.maximum(x[:, :2] - 1, 0)**1.5
    x[:, 2] = -DEPTH * (1 - x[:, 2] / 2)**1.5
    return domain


def top(x):
    return np.isclose(x[2], 0)


def base(x):
    return np.isclose(x[2], -DEPTH)


def under(x):
    return top(x) & (np.maximum(x[0], x[1]) < FOOT + 1e-9)


def resting(of):
    ground = Ground(graded(of.fine), 0, [Layer(-DEPTH, of.material, 2650)], gravity=of.gravity, order=2,
                    rehearse=of.rehearse, tolerance=1e-8, step_time=2 * of.settlement * FOOT / of.steps / RATE)
    for axis in range(3):
        ground.hold(base, axis)
    for axis in (0, 1):
        ground.hold(lambda x, axis=axis: np.isclose(x[axis], 0) | np.isclose(x[axis], WIDTH), axis)
    ground.traction(top, 2, -of.surcharge)
    ground.geostatic(of.surcharge)
    list(ground.to(0))
    return ground


def main():
    of = arguments()
    ground = resting(of)
    ground.stage()
    for axis in (0, 1):
        ground.hold(lambda x, axis=axis: under(x) & ~np.isclose(x[axis], 0), axis)
    ground.hold(under, 2, -2 * of.settlement * FOOT)
    loads = ground.weight() + of.surcharge * WIDTH**2

    def measured(done):
        footing = -ground.force(under, 2)
        borne = ground.force(base, 2) / (loads + footing)
        assert abs(borne - 1) < 1e-6
        pressure = of.surcharge + footing / FOOT**2
        return 2 * of.settlement * FOOT * done, pressure, pressure / of.surcharge, borne

    write_curve(ground, of.steps, ("settlement[m]", "pressure[Pa]", "ratio[-]", "base[-]"), measured,
                of.output + ".csv")
    write_fields(ground, of.output + ".xdmf")
    if not of.rehearse:
        write_packing(ground, (FOOT, FOOT, -0.2), of.output + "_edge.vtp")


if __name__ == "__main__":
    with end_together(COMM):
        main()
