"""Ground with pore water and stages on any number of ranks:  wet_ground_test.py SAND.toml BONDED.toml"""
import importlib.util
import os
import pathlib
import sys
import unittest

import numpy as np
import ufl
from dolfinx import mesh
from mpi4py import MPI

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent))
from grainlaw.dolfinx_ground import Elastic, Ground, Layer  # pylint: disable=wrong-import-position
from grainlaw.dolfinx_water import PoreWater
from told import Told
import wet_pit

COMM = MPI.COMM_WORLD
SAND, BONDED = sys.argv[1:3]
WATER = PoreWater(permeability=1e-9)
BUOYANT = 2650 - 1000


def top(x):
    return np.isclose(x[1], 0)


def base(x):
    return np.isclose(x[1], -3)


def everywhere(x):
    return x[0] > -1


def column(material=SAND, **how):
    """Three metres of ground that moves along y alone."""
    domain = mesh.create_rectangle(COMM, [[0, -3], [1, 0]], [1, 3], mesh.CellType.triangle)
    ground = Ground(domain, 0, [Layer(-3, material, BUOYANT)], water=WATER, tolerance=1e-11, **how)
    ground.hold(base, 1)
    ground.hold(everywhere, 0)
    return ground


def resting(**how):
    ground = column(**how)
    ground.geostatic()
    list(ground.to(0))
    return ground


def largest(values):
    """Over all ranks, which have to agree whether a test fails."""
    return COMM.allreduce(float(np.abs(values).max(initial=0)), MPI.MAX)


def pore(ground):
    return ground.points.values(ufl.split(ground.u)[1])[~ground.points.gone]


def stress(ground):
    return ground.points.values(ground.points.P).reshape(-1, 4)[~ground.points.gone]


class Stages(unittest.TestCase):
    def test_what_leaves_sealed_ground_is_taken_from_its_water_and_then_from_its_grains(self):
        ground = resting()
        self.assertLess(largest(ground.u.x.array[ground._component < 2]), 1e-9)
        ground.stage()
        ground.excavate(lambda x: x[1] > -1)
        removed, before = ground.unit_weights[0], stress(ground)
        for part in (0.5, 1):
            list(ground.to(part))
        self.assertLess(largest(pore(ground) / removed + 1), 1e-6)
        self.assertLess(largest(stress(ground) - before), 1e-6 * removed)
        ground.stage()
        ground.drain(lambda x: np.isclose(x[1], -1))
        ground.step_time = 1e9
        for part in (0.25, 0.5, 0.75, 1):
            list(ground.to(part))
        heights = ground.points.x[~ground.points.gone, 1]
        above = ground.pressure(heights) - removed
        self.assertLess(abs(COMM.allreduce((stress(ground)[:, 3] + above).sum())),
                        1e-6 * COMM.allreduce(above.sum()))
        self.assertLess(largest(pore(ground)), 1e-3 * removed)
        self.assertLess(ground.out_of_balance(), 1e-6 * ground.weight())

    def test_loads_and_supports_come_and_go_and_the_water_carries_them_first(self):
        ground, load = resting(material=BONDED), 5e3
        weight = ground.weight()
        ground.stage()
        ground.traction(top, 1, -load)
        list(ground.to(1))
        self.assertLess(largest(pore(ground) / load - 1), 1e-6)
        ground.stage()
        ground.drain(top)
        ground.step_time = 1e9
        for part in (0.5, 1):
            list(ground.to(part))
        self.assertLess(largest(pore(ground)), 1e-3 * load)
        ground.stage()
        ground.hold(top, 1)   # a lid that drains; the load goes from it, and nothing moves
        ground.traction(top, 1, load)
        moved = ground.u.x.array.copy()
        list(ground.to(1))
        self.assertLess(largest((ground.u.x.array - moved)[ground._component < 2]), 1e-9)
        self.assertLess(abs(ground.force(top, 1) / -load - 1), 1e-6)
        ground.stage()
        ground.release(top, 1)
        for part in (0.5, 1):
            list(ground.to(part))
        self.assertLess(abs(ground.force(base, 1) / weight - 1), 1e-6)

    @unittest.skipUnless(importlib.util.find_spec("h5py"), "checkpoints need h5py")
    def test_a_restart_while_water_flows_has_the_bits_of_a_run_that_went_on(self):
        def answers(ground):
            flow = ground._flow
            return [np.array(f.x.array) for f in (ground.u, ground.points.P, ground.points.A, ground._load,
                                                  ground._ramp, flow.former)] + [
                                                      ground.points.values(flow.solid)]

        def on(ground):
            ground.step_time = 10
            list(ground.to(0.75))
            list(ground.to(1))
            return answers(ground)

        whole = resting()
        whole.stage()
        whole.drain(lambda x: np.isclose(x[1], -1))
        whole.excavate(lambda x: x[1] > -1)
        whole.step_time = 10
        list(whole.to(0.5))
        self.assertLess(COMM.allreduce(pore(whole).min(initial=0), MPI.MIN), -1e2)
        whole.save("wet.cells")
        later = column()
        later.load("wet.cells")
        COMM.Barrier()
        if COMM.rank == 0:
            os.unlink("wet.cells")
        self.assertEqual(later.fraction, 0.5)
        for one, other in zip(on(whole), on(later)):
            self.assertEqual(largest(one - other), 0)

    @unittest.skipIf(COMM.size == 1, "on several ranks")
    def test_ranks_answer_as_one_alone(self):
        def answer(comm):
            ground = wet_pit.resting(SAND, comm)
            for part in wet_pit.dig(ground):
                if part.load == 0.5:
                    break
            of_pore = ground.points.values(ufl.split(ground.u)[1])[~ground.points.gone]
            return np.array([ground.force(lambda x: np.isclose(x[1], -3), 1),
                             ground.force(lambda x: np.isclose(x[0], 0), 0),
                             comm.allreduce(of_pore.min(initial=0), MPI.MIN)])

        alone = answer(MPI.COMM_SELF) if COMM.rank == 0 else None
        self.assertLess(np.abs(answer(COMM) / COMM.bcast(alone) - 1).max(), 1e-10)


class Mistakes(Told):
    """What a script does wrong is told before a point of grains is made."""

    def test_before_any_point(self):
        self.told("the permeability is 0 m2/(Pa s), expected above 0", lambda: PoreWater(0))
        self.told("permeability '1e-9': expected a number", lambda: PoreWater("1e-9"))
        domain = mesh.create_unit_square(COMM, 1, 1)
        self.told("water 1e-09: expected PoreWater(permeability)",
                  lambda: Ground(domain, 1, [Layer(0, SAND, BUOYANT)], water=1e-9))
        self.told("order 3: expected a whole number from 1 to 2", lambda: Ground(domain, 1, [Layer(0, SAND, 2650)], order=3))
        layers = [Layer(-1, SAND, BUOYANT), Layer(-3, Elastic(1e8, 0.3), 1000)]
        self.told("layer 1, in closed form, has no pores", lambda: Ground(domain, 1, layers, water=WATER))
        self.told("layer 0 from 0 m down to 1 m, expected a depth above 0",
                  lambda: Ground(domain, 0, [Layer(1, SAND, BUOYANT)], water=WATER))
        dry = Ground(domain, 1, [Layer(0, SAND, BUOYANT)])
        self.told("the ground has no pore water", lambda: dry.drain(top))
        ground = column()
        self.told("drain: no node lies there", lambda: ground.drain(lambda x: x[1] > 1))
        self.told("drain: value nan: expected a finite number", lambda: ground.drain(top, float("nan")))
        self.told("seal: nothing is drained there", lambda: ground.seal(top))
        self.told("the surface would be in tension", lambda: ground.drain(top, 2e3))
        self.assertFalse(ground._made)
        shut = column()
        shut.hold(everywhere, 1)
        self.told("nothing determines the pore pressure around (0, -", shut.geostatic)   # the node by rank
        self.assertFalse(shut._made)
        shut.drain(base, 0)
        shut._check_held()

    def test_of_stages_in_a_rehearsal(self):
        ground = resting(rehearse=True)
        self.assertEqual(len(ground.points.states), 0)
        ground.stage()
        ground.traction(top, 1, -5e3)
        ground.drain(top, 4e3)
        self.told("the surface would be in tension", lambda: ground.drain(top, 8e3))
        ground.drain(top, 4e3)
        ground.step_time = -1
        self.told("step_time is -1 s", lambda: list(ground.to(1)))
        ground.step_time = 100
        list(ground.to(1))
        ground.stage()
        self.told("the surface would be in tension", lambda: ground.traction(top, 1, 4e3))
        ground = resting(rehearse=True)
        ground.stage()
        ground.hold(everywhere, 1)
        self.told("nothing determines the pore pressure", lambda: list(ground.to(1)))
        ground.drain(lambda x: np.isclose(x[1], -1))
        self.told("nothing determines the pore pressure", lambda: list(ground.to(1)))   # in no time
        ground.step_time = 100
        list(ground.to(1))
        ground.stage()
        ground.excavate(lambda x: x[1] > -1)
        ground.seal(lambda x: np.isclose(x[1], -1))
        self.told("nothing determines the pore pressure", lambda: list(ground.to(1)))


if __name__ == "__main__":
    with open(os.devnull, "w", encoding="utf-8") as nowhere:
        result = unittest.TextTestRunner(sys.stderr if COMM.rank == 0 else nowhere).run(
            unittest.defaultTestLoader.loadTestsFromModule(sys.modules["__main__"]))
    if not result.wasSuccessful():
        for _, text in result.failures + result.errors:
            print(f"rank {COMM.rank}: {text}", file=sys.stderr)
        COMM.Abort(1)
