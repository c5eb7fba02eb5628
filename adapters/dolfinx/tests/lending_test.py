"""Points of a mesh that ranks lend:  mpirun -n RANKS lending_test.py MATERIAL.toml OTHER.toml SPHERES.toml

The upper half of a box yields, the lower one does not move."""
import os
import sys
import unittest

import numpy as np
import ufl
from dolfinx import fem, mesh
from mpi4py import MPI

import grainlaw
from grainlaw.dolfinx import Elastic, Newton, Points, read_material
from grainlaw.lending import Lending

COMM = MPI.COMM_WORLD
LAST = COMM.size - 1
MATERIAL, OTHER, SPHERES = sys.argv[1:4]


def uneven(dimension, cells):
    """A box, and displacements."""
    if dimension == 2:
        domain = mesh.create_rectangle(COMM, [[0, 0], [1, 1]], [cells, cells])
    else:
        domain = mesh.create_box(COMM, [[0, 0, 0], [1, 1, 1]], [1, 1, cells])
    return domain, fem.Function(fem.VectorFunctionSpace(domain, ("Lagrange", 1)))


def bend(u, load):
    """Shorten and shear the upper half."""
    last = u.function_space.mesh.topology.dim - 1

    def field(x):
        moved = np.zeros((last + 1, x.shape[1]))
        moved[last] = -load * 2e-3 * np.maximum(x[last] - 0.5, 0)
        moved[0] = load * 1e-3 * np.maximum(x[last] - 0.5, 0) ** 2
        return moved
    u.interpolate(field)


def made(domain, materials, lend):
    top = domain.topology.dim - 1
    if len(materials) == 1:
        return Points(domain, materials[0], degree=1, lend=lend)
    return Points(domain, materials, degree=1, layer=lambda x: np.where(x[top] < 0.3, 0, 1 + (x[0] > 0.5)),
                  lend=lend)


class Lent(unittest.TestCase):
    def same(self, domain, u, materials):
        alone, lends = (made(domain, materials, lend) for lend in (False, True))
        self.assertIsNone(alone.lending)
        for step in range(1, 5):
            for points in (alone, lends):
                points.set_time_step(1)
                for iteration in (0.95, 1):
                    bend(u, step - 1 + iteration)
                    self.assertTrue(points.evaluate(u).ok)
                points.commit()
            for one, other in ((alone.P, lends.P), (alone.A, lends.A)):
                self.assertEqual(one.x.array.tobytes(), other.x.array.tobytes())
            self.assertEqual(alone.states.save(), lends.states.save())
        bend(u, 1000)   # beyond what an increment takes
        told = [points.evaluate(u) for points in (alone, lends)]
        self.assertEqual(told[0].message, told[1].message)
        self.assertEqual(set(COMM.allgather(told[1].message)), {told[1].message})
        self.assertEqual(bytes(told[0].summary), bytes(told[1].summary))
        count = lends.lending.count
        lent, taken = COMM.allreduce(count.lent), COMM.allreduce(count.taken)
        self.assertEqual(lent, taken)
        self.assertEqual(lent > 0, COMM.size > 1)
        lends.lending.close()

    def test_discs_have_the_bits_of_those_that_are_not(self):
        self.same(*uneven(2, 4), [read_material(COMM, OTHER)])

    def test_layers_too_one_of_them_elastic(self):
        self.same(*uneven(2, 4), [Elastic(1e8, 0.3), read_material(COMM, MATERIAL), read_material(COMM, OTHER)])

    def test_spheres_too(self):
        self.same(*uneven(3, 4), [read_material(COMM, SPHERES)])

    def test_points_that_were_led_to_a_stress_too(self):
        domain, u = uneven(2, 4)
        alone, lends = (made(domain, [read_material(COMM, OTHER)], lend) for lend in (False, True))
        for points in (alone, lends):
            points.set_time_step(1)
            points.consolidate(np.tile(np.diag([-60e3, -120e3]), (len(points.states), 1, 1)))
            for load in (1, 2, 3):
                bend(u, load)
                self.assertTrue(points.evaluate(u).ok)
            points.commit()
        self.assertEqual(alone.P.x.array.tobytes(), lends.P.x.array.tobytes())
        self.assertEqual(alone.states.save(), lends.states.save())
        self.assertEqual(COMM.allreduce(lends.lending.count.lent) > 0, COMM.size > 1)

    def test_a_run_of_newton_has_the_same_forces(self):
        material, runs = read_material(COMM, MATERIAL), []
        for lend in (False, True):
            domain, u = uneven(2, 4)
            V = u.function_space
            points = Points(domain, material, degree=1, lend=lend)
            bottom, top = (fem.locate_dofs_geometrical(V, lambda x, at=at: np.isclose(x[1], at)) for at in (0, 1))
            move = fem.Function(V)
            newton = Newton(points, u, [fem.dirichletbc(move, np.union1d(bottom, top))],
                            apply=lambda load, to=move: bend(to, load),
                            external=lambda v: -100e3 * ufl.inner(ufl.FacetNormal(domain), v) * ufl.ds,
                            tolerance=1e-10)
            runs.append([newton.force(2 * top + 1) for _ in newton.to(1)])
        self.assertGreater(len(runs[0]), 0)
        np.testing.assert_allclose(*runs, rtol=1e-12)   # MUMPS sums in any order

    def test_an_error_on_one_rank_is_told_on_all(self):
        domain, u = uneven(2, 4)
        points = Points(domain, read_material(COMM, MATERIAL), degree=1, lend=True)
        points.set_time_step(1)
        self.assertTrue(points.evaluate(u).ok)
        if COMM.rank == LAST:
            u.x.array[:] = np.nan
        with self.assertRaises(grainlaw.Error) as caught:
            points.evaluate(u)
        told = COMM.allgather(str(caught.exception))
        self.assertEqual(set(told), {told[0]})
        self.assertIn("F11 is nan", told[0])

    def test_materials_that_differ_are_told(self):
        text = open(MATERIAL, encoding="utf-8").read()
        if COMM.rank == LAST:
            text = text.replace("friction = ", "friction = 1.5 # ")
        material = grainlaw.Material.parse(text, os.path.dirname(MATERIAL))
        if COMM.size == 1:
            self.skipTest("one rank has one material")
        with self.assertRaises(grainlaw.Error) as caught:
            Lending(COMM, grainlaw.States(material, 2), [material])
        self.assertIn("the materials are not those of rank 0", str(caught.exception))


if __name__ == "__main__":
    with open(os.devnull, "w", encoding="utf-8") as nowhere:
        result = unittest.TextTestRunner(sys.stderr if COMM.rank == 0 else nowhere).run(
            unittest.defaultTestLoader.loadTestsFromTestCase(Lent))
    if not result.wasSuccessful():
        for _, text in result.failures + result.errors:
            print(f"rank {COMM.rank}: {text}", file=sys.stderr)
        COMM.Abort(1)
