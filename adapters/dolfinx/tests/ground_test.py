"""Ground with stages on any number of ranks:  ground_test.py UPPER.toml LOWER.toml SPHERES.toml"""
import os
import sys
import unittest

import numpy as np
from dolfinx import mesh
from mpi4py import MPI

import grainlaw
from grainlaw.dolfinx import _elastic_answer
from grainlaw.dolfinx_ground import Elastic, Ground, Layer
from told import Told

COMM = MPI.COMM_WORLD
UPPER, LOWER, SPHERES = sys.argv[1:4]
BELOW = Layer(-4, Elastic(2e7, 0.25), 2000)
SURFACE = 1e3   # Pa


def block(comm=COMM):
    return mesh.create_rectangle(comm, [[0, -4], [2, 0]], [2, 4], mesh.CellType.triangle)


def supported(layers, domain=None, **how):
    ground = Ground(domain or block(), 0, layers, **how)
    ground.hold(lambda x: np.isclose(x[1], -4), 1)
    ground.hold(lambda x: np.isclose(x[0], 0) | np.isclose(x[0], 2), 0)
    return ground


def resting(layers, domain=None, **how):
    ground = supported(layers, domain, **how)
    ground.geostatic()
    list(ground.to(0))
    return ground


def top(x):
    return np.isclose(x[1], 0)


def above(height):
    return lambda x: x[1] > height


def at(height):
    return lambda x: np.isclose(x[1], height)


def cut(ground):
    """Half of an excavation, in the middle of a stage."""
    ground.stage()
    ground.excavate(above(-1))
    for part in (0.25, 0.5):
        list(ground.to(part))


def answers(ground):
    """u, P, A, loads of this rank."""
    points = ground.points
    return [np.array(f.x.array) for f in (ground.u, points.P, points.A, ground._load, ground._ramp)]


def largest(values):
    """Over all ranks, which have to agree whether a test fails."""
    return COMM.allreduce(float(np.abs(values).max(initial=0)), MPI.MAX)


class Stages(unittest.TestCase):
    def test_an_elastic_layer_gives_way_by_its_closed_form(self):
        young, nu = BELOW.material
        oedometric = young * (1 - nu) / (1 + nu) / (1 - 2 * nu)
        ground = resting([Layer(-2, UPPER, 2650), BELOW])
        self.assertEqual(largest(np.array([len(ground.points.states) - np.sum(ground.points.layer == 0)])), 0)
        P = ground.points.values(ground.points.P).reshape(-1, 2, 2)[ground.points.layer == 1]
        self.assertLess(largest(P[:, 0, 0] / P[:, 1, 1] - nu / (1 - nu)), 1e-6)
        self.assertLess(largest(ground.u.x.array), 1e-9)
        ground.stage()
        ground.traction(top, 1, -SURFACE)
        list(ground.to(1))
        own = slice(ground.owned)
        dofs = np.flatnonzero(np.isclose(ground._places[own, 1], -2) & (ground._component[own] == 1))
        shares = np.where(np.isclose(ground._places[dofs, 0], 1), 0.5, 0.25)
        settled = -COMM.allreduce(shares @ ground.u.x.array[dofs])
        form = sum(SURFACE / (oedometric - ground.pressure(np.array([height]))[0]) for height in (-3.5, -2.5))
        self.assertLess(abs(settled / form - 1), 1e-4)

    def test_the_tangent_of_elastic_layers_is_that_of_differences(self):
        chance = np.random.default_rng(3)
        F, resting_stress = np.eye(2) + 0.1 * chance.random((3, 2, 2)), -1e5 * np.eye(2) + np.zeros((3, 2, 2))
        tangent = _elastic_answer(BELOW.material, F, resting_stress)[1]
        for k in range(2):
            for column in range(2):
                bump = np.zeros((2, 2))
                bump[k, column] = 1e-4
                plus, minus = (_elastic_answer(BELOW.material, F + sign * bump, resting_stress)[0]
                               for sign in (1, -1))
                self.assertLess(np.abs((plus - minus) / 2e-4 - tangent[..., k, column]).max(), 1e-7 * 2e7)

    def test_a_restart_within_a_stage_has_the_bits_of_a_run_that_went_on(self):
        layers = [Layer(-2, UPPER, 2650), BELOW]
        whole = resting(layers)
        cut(whole)
        whole.save("ground.cells")
        list(whole.to(1))
        later = supported(layers)
        later.load("ground.cells")
        self.assertEqual(later.fraction, 0.5)
        list(later.to(1))
        for one, other in zip(answers(whole), answers(later)):
            self.assertEqual(largest(one - other), 0)
        self.assertEqual(whole.out_of_balance(), later.out_of_balance())
        self.assertTrue(np.array_equal(whole.unit_weights, later.unit_weights))
        turned = [Layer(-2, Elastic(2e7, 0.25), 2000), Layer(-4, UPPER, 2650)]
        with self.assertRaises(grainlaw.Error) as caught:
            supported(turned).load("ground.cells")
        self.assertIn("its points are of other layers", str(caught.exception))
        COMM.Barrier()
        if COMM.rank == 0:
            os.unlink("ground.cells")

    def test_a_plate_that_comes_and_goes_leaves_nothing(self):
        ground = resting([Layer(-2, UPPER, 2650), Layer(-4, LOWER, 2600)])
        before, weight = ground._load.x.array.copy(), ground.weight()
        ground.stage()
        ground.hold(top, 1, -1e-4)
        list(ground.to(1))
        pressed = ground.force(top, 1)
        self.assertLess(pressed, -1e-3 * weight)
        ground.stage()
        ground.release(top, 1)
        for step in range(4):
            list(ground.to((step + 1) / 4))
        ground.stage()
        self.assertLess(largest(ground._load.x.array - before), 1e-7 * weight)
        self.assertLess(ground.out_of_balance(), 1e-6 * weight)
        self.assertLess(abs(ground.force(at(-4), 1) / weight - 1), 1e-6)

    def test_a_load_comes_and_goes_on_quadratic_elements(self):
        ground = resting([Layer(-2, UPPER, 2650), BELOW], order=2)
        weight = ground.weight()
        for sign in (1, -1):
            ground.stage()
            ground.traction(top, 1, -sign * SURFACE)
            for step in range(2):
                list(ground.to((step + 1) / 2))
            loaded = 2 * SURFACE * (sign > 0)
            self.assertLess(abs(ground.force(at(-4), 1) / (weight + loaded) - 1), 1e-6)

    def test_solid_ground_rests_and_bears_a_load_that_goes(self):
        box = mesh.create_box(COMM, [[0, 0, -2], [1, 1, 0]], [1, 1, 2])
        ground = Ground(box, 0, [Layer(-1, SPHERES, 2650), Layer(-2, Elastic(1e8, 0.3), 2000)])
        ground.hold(lambda x: np.isclose(x[2], -2), 2)
        for axis in (0, 1):
            ground.hold(lambda x, axis=axis: np.isclose(x[axis], 0) | np.isclose(x[axis], 1), axis)
        surcharge = 150e3
        ground.traction(lambda x: np.isclose(x[2], 0), 2, -surcharge)
        ground.geostatic(surcharge)
        list(ground.to(0))
        self.assertLess(largest(ground.u.x.array), 1e-7)
        base, weight = lambda x: np.isclose(x[2], -2), ground.weight()
        self.assertLess(abs(ground.force(base, 2) / (weight + surcharge) - 1), 1e-6)
        ground.stage()
        with self.assertRaises(ValueError):
            ground.excavate(lambda x: x[2] > -1)
        ground.traction(lambda x: np.isclose(x[2], 0), 2, 0.2 * surcharge)
        list(ground.to(1))
        self.assertLess(abs(ground.force(base, 2) / (weight + 0.8 * surcharge) - 1), 1e-6)
        self.assertGreater(largest(ground.u.x.array), 1e-6)

    @unittest.skipIf(COMM.size == 1, "on several ranks")
    def test_ranks_answer_as_one_alone(self):
        def forces(comm):
            ground = resting([Layer(-2, UPPER, 2650), BELOW], block(comm), tolerance=1e-12)
            cut(ground)
            return np.array([ground.force(at(-4), 1), ground.force(lambda x: np.isclose(x[0], 0), 0),
                             ground.force(lambda x: np.isclose(x[0], 2), 0)])

        alone = forces(MPI.COMM_SELF) if COMM.rank == 0 else None
        self.assertLess(np.abs(forces(COMM) / COMM.bcast(alone) - 1).max(), 1e-10)


class Mistakes(Told):
    """What a script does wrong is told before a point of grains is made."""

    def test_of_layers(self):
        sand = Layer(-4, UPPER, 2650)
        for surface, layers, gravity, words in (
                (0, [Layer(-2, UPPER, 2650), Layer(-2, UPPER, 2650)], 9.81, "layer 1 from -2 m down to -2 m"),
                (0, [Layer(-4, UPPER, 0)], 9.81, "layer 0: the density is 0 kg/m3"),
                (0, [Layer(-3, UPPER, 2650)], 9.81, "the mesh reaches from -4.0 to 0.0 m"),
                (-1, [sand], 9.81, "the mesh reaches from -4.0 to 0.0 m"),
                (0, [sand], -9.81, "gravity is -9.81 m/s2"),
                (0, [Layer(-2, UPPER, 2650), Layer(-4, "nowhere.toml", 2650)], 9.81, "nowhere.toml"),
                (0, [Layer(-2, UPPER, 2650), Layer(-4, "", 2650)], 9.81, "layer 1 has no material"),
                (0, [Layer(-2, UPPER, 2650), Layer(-4, Elastic(2e7, 0.5), 2000)], 9.81,
                 "layer 1 of modulus 20000000.0 Pa and Poisson ratio 0.5"),
                (0, [BELOW], 9.81, "every layer is elastic"),
                (0, [], 9.81, "expected a list of one Layer"), (0, sand, 9.81, "expected a list of one Layer"),
                (0, [(-4, UPPER, 2650)], 9.81, "expected a list of one Layer"),
                (0, [Layer(-4, UPPER, "2650")], 9.81, "layer 0: density '2650': expected a finite number"),
                (0, [Layer(-4, 3, 2650)], 9.81, "layer 0: material 3, expected a file")):
            self.told(words, lambda: Ground(block(), surface, layers, gravity))
        self.told("every material is elastic", lambda: grainlaw.dolfinx.Points(block(), [BELOW.material], 1))

    def test_of_supports_and_loads(self):
        sand = [Layer(-4, UPPER, 2650)]
        ground = supported(sand)
        self.told("the surcharge is -1000 Pa", lambda: ground.geostatic(-1000))
        self.told("overconsolidation is 0.5", lambda: ground.geostatic(overconsolidation=0.5))
        self.told("the surface would be in tension", lambda: ground.traction(top, 1, SURFACE))
        self.told("traction: no side lies there", lambda: ground.traction(above(1), 1, -SURFACE))
        self.told("hold: no node lies there", lambda: ground.hold(above(1), 0))
        self.told("component 2: expected a whole number from 0 to 1", lambda: ground.hold(top, 2))
        self.told("hold: value nan: expected a finite number", lambda: ground.hold(top, 0, np.nan))
        self.told("traction: value nan: expected a finite number", lambda: ground.traction(top, 1, np.nan))
        for early in (lambda: list(ground.to(1)), ground.stage, lambda: ground.excavate(above(-1)),
                      lambda: ground.save("run.cells"), ground.weight, ground.out_of_balance):
            with self.assertRaisesRegex(AttributeError, r"geostatic\(\) or load\(\) has to come before"):
                early()
        self.assertFalse(ground._made)
        sliding = Ground(block(), 0, sand)
        sliding.hold(at(-4), 1)
        self.told("nothing holds component 0 of what is around (", sliding.geostatic)
        self.assertFalse(sliding._made)

    def test_of_stages_in_a_rehearsal(self):
        def rehearsed():
            ground = resting([Layer(-2, UPPER, 2650), Layer(-4, LOWER, 2600)], rehearse=True)
            self.assertEqual(len(ground.points.states), 0)
            ground.stage()
            ground.traction(top, 1, -SURFACE)
            list(ground.to(1))
            ground.stage()
            return ground

        ground = rehearsed()
        self.told("nothing is excavated", lambda: ground.excavate(above(1)))
        self.told("the part that is excavated carries a load at (", lambda: ground.excavate(above(-1)))
        self.told("release: nothing is held there", lambda: ground.release(at(-1), 1))
        self.told("would be in tension", lambda: ground.traction(top, 1, 20 * SURFACE))
        self.told("nothing holds component 1", lambda: ground.release(at(-4), 1))
        ground = rehearsed()
        self.told("nothing holds component 1", lambda: ground.excavate(lambda x: (x[1] < -2) & (x[1] > -3)))
        self.told("the ground has its weight already", ground.geostatic)
        for fraction in (-0.5, 2, np.nan):
            self.told(f"to: fraction {fraction!r}: expected", lambda: list(ground.to(fraction)))
        ground = rehearsed()   # and without a mistake
        ground.traction(top, 1, SURFACE)
        list(ground.to(1))
        cut(ground)
        self.assertEqual(ground.fraction, 0.5)


if __name__ == "__main__":
    with open(os.devnull, "w", encoding="utf-8") as nowhere:
        result = unittest.TextTestRunner(sys.stderr if COMM.rank == 0 else nowhere).run(
            unittest.defaultTestLoader.loadTestsFromModule(sys.modules["__main__"]))
    if not result.wasSuccessful():
        for _, text in result.failures + result.errors:
            print(f"rank {COMM.rank}: {text}", file=sys.stderr)
        COMM.Abort(1)
