#!/usr/bin/python3
"""A wall on all ranks, whose corrections are those that one rank found alone, has the force of that rank, through
steps that are cut too:

    mpirun -n 2 same_corrections.py SAND.toml WALL_ARGUMENTS ...

What is left between ranks is then the rounding of their linear solver. Prints how far the forces are where ranks
solve by themselves, and on one rank whose corrections are changed by one unit in the last place.
"""
import csv
import pathlib
import sys
import tempfile

import numpy as np
from mpi4py import MPI

from grainlaw.dolfinx import end_together
from grainlaw.dolfinx_ground import Ground

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent))
import retaining_wall

BOUND = 1e-10
WORLD = MPI.COMM_WORLD
LAST_PLACE = np.finfo(float).eps


class Observed(Ground):
    """Ground whose corrections are kept by place and component, or given."""

    kept, given, nudge = [], None, 0.0

    def _solve(self, fraction, wanted):
        names = [(*place, component) for place, component in zip(np.round(self._places, 9) + 0.0, self._component)]
        if self.given is not None:
            correction = self._correction
            changes = self.given[len(self.kept)]
            correction.x.array[:] = [changes[name] for name in names]
        else:
            correction = super()._solve(fraction, wanted)
            free = self._held.x.array == 0
            signs = np.random.default_rng(len(self.kept)).choice((-1, 1), len(free))
            correction.x.array[free] *= 1 + self.nudge * signs[free]
        self.kept.append(dict(zip(names, correction.x.array.tolist())))
        return correction


def curve(comm, folder, given=None, nudge=0.0):
    """Forces and cuts of each step."""
    Observed.kept, Observed.given, Observed.nudge = [], given, nudge
    retaining_wall.COMM = comm
    retaining_wall.main()
    comm.barrier()
    with open(folder + "/wall.csv", encoding="utf-8") as table:
        rows = list(csv.DictReader(table))
    comm.barrier()
    return (np.array([float(row["force[N/m]"]) for row in rows]), sum(int(row["cuts[-]"]) for row in rows))


def apart(one, other):
    return float(np.abs(one - other).max() / np.abs(one).max())


def main():
    with tempfile.TemporaryDirectory() as own:
        folder = WORLD.bcast(own)
        sys.argv += ["-output", folder + "/wall"]
        alone, cuts, nudged = None, 0, 0.0
        if WORLD.rank == 0:
            alone, cuts = curve(MPI.COMM_SELF, folder)
            kept = Observed.kept
            nudged = apart(alone, curve(MPI.COMM_SELF, folder, nudge=LAST_PLACE)[0])
        alone, cuts, given = WORLD.bcast((alone, cuts, kept if WORLD.rank == 0 else None))
        together = apart(alone, curve(WORLD, folder, given)[0])
        free = apart(alone, curve(WORLD, folder)[0])
        if WORLD.rank == 0:
            print(f"force against that of one rank, {cuts} cuts: {together:.1e} with its corrections, bound {BOUND}; "
                  f"{free:.1e} with their own; {nudged:.1e} on one rank whose corrections are changed by {LAST_PLACE:.1e}")
        assert cuts > 0, "expected a step that is cut"
        assert together < BOUND, f"{together:.1e}, expected less than {BOUND}"
        WORLD.barrier()


if __name__ == "__main__":
    with end_together(WORLD):
        main()
