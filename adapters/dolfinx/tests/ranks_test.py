"""Points of a mesh on several ranks:  mpirun -n RANKS ranks_test.py MATERIAL.toml SPHERES.toml"""
import os
import sys
import unittest

import numpy as np
import ufl
from dolfinx import fem, mesh
from mpi4py import MPI

import grainlaw
from grainlaw.dolfinx import Points, read_material, together

COMM = MPI.COMM_WORLD
LAST = COMM.size - 1
MATERIAL, SPHERES = sys.argv[1:3]


def square(divisions):
    domain = mesh.create_unit_square(COMM, divisions, divisions)
    return domain, fem.Function(fem.VectorFunctionSpace(domain, ("Lagrange", 1)))


class Ranks(unittest.TestCase):
    def raised_on_all(self, words, call):
        with self.assertRaises(grainlaw.Error) as caught:
            call()
        told = COMM.allgather(str(caught.exception))
        self.assertEqual(set(told), {told[0]})
        self.assertIn(words, told[0])

    def test_a_rank_may_have_no_cells(self):
        domain, u = square(1)
        points = Points(domain, read_material(COMM, MATERIAL), degree=1)
        points.set_time_step(1)
        u.interpolate(lambda x: 1e-4 * x[:2])
        answer = points.evaluate(u)
        self.assertTrue(answer.ok)
        points.commit()
        self.assertEqual(COMM.allreduce(len(points.states)), 2)
        self.assertEqual(sorted(sum(COMM.allgather(points.cells.tolist()), [])), [0, 1])
        power = fem.form(points.stress_power(ufl.SpatialCoordinate(domain)))
        traces = np.trace(answer.P, axis1=1, axis2=2)   # of two cells of half the area
        told, expected = COMM.allreduce(fem.assemble_scalar(power)), COMM.allreduce(traces.sum()) / 2
        self.assertAlmostEqual(told / expected, 1, places=9)

    def test_solids_have_stress_and_tangent_of_their_points(self):
        domain = mesh.create_unit_cube(COMM, 1, 1, 1)   # six tetrahedra
        u = fem.Function(fem.VectorFunctionSpace(domain, ("Lagrange", 1)))
        material = read_material(COMM, SPHERES)
        points = Points(domain, material, degree=1)
        gradient = 1e-4 * np.array([[1, 2, 0], [-1, -3, 1], [2, 0, -2]])
        u.interpolate(lambda x: gradient @ x)
        points.set_time_step(1)
        self.assertTrue(points.evaluate(u).ok)
        state = grainlaw.State(material)
        state.set_time_step(1)
        expected = state.evaluate(np.eye(3) + gradient, grainlaw.Tangent.EXACT)
        V = u.function_space
        v, du = fem.Function(V), fem.Function(V)
        stress, tangent = fem.form(points.stress_power(v)), fem.form(points.stiffness(du, v))
        test, trial = np.arange(9).reshape(3, 3) / 9, np.arange(9, 0, -1).reshape(3, 3) ** 2 / 81
        v.interpolate(lambda x: test @ x)
        du.interpolate(lambda x: trial @ x)
        for form, value in ((stress, np.sum(expected.P * test)),
                            (tangent, np.einsum("ij,ijkl,kl", test, expected.A, trial))):
            told = COMM.allreduce(fem.assemble_scalar(form))
            self.assertLess(abs(told / value - 1), 1e-8)

    def test_another_material_on_one_rank_is_told_on_all(self):
        text = open(MATERIAL, encoding="utf-8").read()
        if COMM.rank == LAST:
            text = text.replace("friction = ", "friction = 1.5 # ")
        material = grainlaw.Material.parse(text, os.path.dirname(MATERIAL))
        self.raised_on_all(f"rank {LAST}: the material has fingerprint",
                           lambda: Points(square(2)[0], material, degree=1))

    def test_what_cannot_be_read_is_told_on_all(self):
        self.raised_on_all("rank 0: nowhere.toml: cannot be read",
                           lambda: read_material(COMM, "nowhere.toml"))

    def test_a_mesh_of_another_dimension_is_told(self):
        domain = mesh.create_unit_cube(COMM, 1, 1, 1)
        self.raised_on_all("a mesh of dimension 3 in 3D: expected 2, as of the material",
                           lambda: Points(domain, read_material(COMM, MATERIAL), degree=1))

    def test_a_displacement_that_is_no_number_is_told_on_all(self):
        domain, u = square(4)
        points = Points(domain, read_material(COMM, MATERIAL), degree=1)
        self.assertTrue(points.evaluate(u).ok)
        points.commit()
        P = points.P.x.array.copy()
        if COMM.rank == LAST:
            u.x.array[:] = np.nan
        self.raised_on_all("point", lambda: points.evaluate(u))
        np.testing.assert_array_equal(P, points.P.x.array)

    def test_one_rank_that_raises_raises_on_all(self):
        def call():
            with together(COMM):
                if COMM.rank == LAST:
                    raise grainlaw.Error(grainlaw.Status.OUT_OF_MEMORY, "no memory")
        self.raised_on_all(f"rank {LAST}: no memory", call)


if __name__ == "__main__":
    with open(os.devnull, "w", encoding="utf-8") as nowhere:
        result = unittest.TextTestRunner(sys.stderr if COMM.rank == 0 else nowhere).run(
            unittest.defaultTestLoader.loadTestsFromTestCase(Ranks))
    if not result.wasSuccessful():
        for _, text in result.failures + result.errors:
            print(f"rank {COMM.rank}: {text}", file=sys.stderr)
        COMM.Abort(1)
