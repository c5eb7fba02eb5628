#!/usr/bin/python3
"""A wall on all ranks, whose points get the displacement gradients that one rank found alone: every point has
the bits of that rank, and the wall its force, through steps that are cut too:

    mpirun -n 2 same_gradients.py SAND.toml WALL_ARGUMENTS ...

What else differs between ranks is rounding, of gradients and of the linear solver. Prints how far the force then
is, and that of one rank whose gradients are changed in their last place.
"""
import csv
import pathlib
import sys
import tempfile

import numpy as np
from mpi4py import MPI

from grainlaw import dolfinx_ground
from grainlaw.dolfinx import Points, end_together

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent))
import retaining_wall

BOUND = 1e-10         # of forces, over the largest [-]
LAST_PLACE = 1.1e-16  # of F, which is near 1 [-]
NUDGED = 2            # runs
WORLD = MPI.COMM_WORLD


class Observed(Points):
    """Points whose gradients are kept by place, or given; and their stresses."""

    gradients, stresses, given, chance = [], [], None, None

    def _gradient(self, u):
        found = super()._gradient(u)
        if self.given is not None:
            if len(self.gradients) == len(self.given):
                raise AssertionError(f"more than the {len(self.given)} gradients of one rank were asked for")
            known = self.given[len(self.gradients)]
            found = np.array([known[place] for place in self._names()]).reshape(found.shape)
        if self.chance is not None:
            found = found + LAST_PLACE * self.chance.choice((-1, 1), found.shape)
        self.gradients.append(dict(zip(self._names(), found)))
        return found

    def evaluate(self, u):
        answer = super().evaluate(u)
        self.stresses.append({place: P.tobytes() for place, P in zip(self._names(), answer.P)})
        return answer

    def _names(self):
        return [tuple(place) for place in (np.round(self.x, 9) + 0.0).tolist()]


def forces(comm, folder, given=None, chance=None):
    """Of the wall after each step, and how many parts were cut."""
    Observed.gradients, Observed.stresses, Observed.given, Observed.chance = [], [], given, chance
    retaining_wall.COMM = comm
    retaining_wall.main()
    comm.barrier()
    with open(folder + "/wall.csv", encoding="utf-8") as table:
        rows = list(csv.DictReader(table))
    comm.barrier()
    return np.array([float(row["force[N/m]"]) for row in rows]), sum(int(row["cuts[-]"]) for row in rows)


def apart(one, other):
    return float(np.abs(one - other).max() / np.abs(one).max())


def evaluations_with_other_bits(stresses):
    """Of all ranks, against those of one."""
    parts = WORLD.allgather(Observed.stresses)
    together = [{place: P for part in one for place, P in part.items()} for one in zip(*parts)]
    return sum(one != other for one, other in zip(stresses, together)) + abs(len(stresses) - len(together))


def main():
    with tempfile.TemporaryDirectory() as own:
        folder = WORLD.bcast(own)
        sys.argv += ["-output", folder + "/wall"]
        found = None
        if WORLD.rank == 0:
            alone, cuts = forces(MPI.COMM_SELF, folder)
            found = alone, cuts, Observed.gradients, Observed.stresses
        alone, cuts, gradients, stresses = WORLD.bcast(found)
        told, _ = forces(WORLD, folder, given=gradients)
        other = evaluations_with_other_bits(stresses)
        free, _ = forces(WORLD, folder)
        if WORLD.rank == 0:
            print(f"one rank, {cuts} cuts, {len(stresses)} evaluations; with its gradients {other} of them have other "
                  f"bits, forces are {apart(alone, told):.1e} apart, bound {BOUND}")
            nudged = [apart(alone, forces(MPI.COMM_SELF, folder, chance=np.random.default_rng(seed))[0])
                      for seed in range(NUDGED)]
            print(f"with gradients of their own {apart(alone, free):.1e}; on one rank whose gradients are changed by "
                  f"{LAST_PLACE}: {', '.join(f'{one:.1e}' for one in nudged)}")
        assert cuts > 0, "expected a step that is cut"
        assert other == 0, f"{other} evaluations have other bits"
        assert apart(alone, told) < BOUND
        WORLD.barrier()


if __name__ == "__main__":
    dolfinx_ground.Points = Observed
    with end_together(WORLD):
        main()
