"""Pore water on any number of ranks:  water_test.py LATTICE.toml SPHERES.toml SAND.toml"""
import importlib.util
import math
import os
import pathlib
import sys
import unittest

import numpy as np
import ufl
from dolfinx import fem, mesh
from mpi4py import MPI

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent))
import grainlaw  # pylint: disable=wrong-import-position
from grainlaw.dolfinx import Points, read_material
from grainlaw.dolfinx_water import PoreWater, WaterNewton, check_drainage, water_space
from water import column

COMM = MPI.COMM_WORLD
LATTICE, SPHERES, SAND = sys.argv[1:4]
CONFINING = 100e3   # Pa


def square():
    return mesh.create_unit_square(COMM, 2, 2, mesh.CellType.triangle, diagonal=mesh.DiagonalType.crossed)


def on(space, side, value=None):
    """A condition by 0 or by the components of a constant, on nodes where side(x)."""
    collapsed = space.collapse()[0]
    dofs = fem.locate_dofs_geometrical((space, collapsed), side)
    held = fem.Function(collapsed)
    if value is not None:
        held.x.array[:] = value
    return fem.dirichletbc(held, dofs, space), held


def element(water, side_pressure=True, strain=5e-3, led_to=None):
    """A sealed square between smooth sides, shortened along y over a load of 1."""
    domain = square()
    w = fem.Function(water_space(domain))
    V = w.function_space.sub(0)
    top, moved = on(V.sub(1), lambda x: np.isclose(x[1], 1))
    conditions = [top] + [on(V.sub(axis), lambda x, axis=axis: np.isclose(x[axis], 0))[0] for axis in (0, 1)]
    if not side_pressure:
        conditions.append(on(V.sub(0), lambda x: np.isclose(x[0], 1))[0])
    facets = mesh.locate_entities_boundary(domain, 1, lambda x: np.isclose(x[0], 1))
    tags = mesh.meshtags(domain, 1, np.sort(facets), np.ones(len(facets), np.int32))
    ds = ufl.Measure("ds", domain, subdomain_data=tags)

    def push(v):
        F = ufl.Identity(2) + ufl.grad(ufl.split(w)[0])
        return -CONFINING * ufl.inner(ufl.det(F) * ufl.inv(F).T * ufl.FacetNormal(domain), v) * ds(1)

    def shorten(load):
        moved.x.array[:] = -strain * load

    points = Points(domain, read_material(COMM, LATTICE), degree=2)
    if led_to is not None:
        points.consolidate(np.tile(-led_to * np.eye(2), (len(points.layer), 1, 1)))
    return WaterNewton(points, w, conditions, shorten, water, external=push if side_pressure else None,
                       tolerance=1e-12)


def pressures(newton):
    collapsed, dofs = newton.u.function_space.sub(1).collapse()
    own = np.asarray(dofs)[:collapsed.dofmap.index_map.size_local]
    return np.concatenate(COMM.allgather(newton.u.x.array[own]))


def determinants(newton):
    F = np.eye(2) + newton.points.values(ufl.grad(ufl.split(newton.u)[0])).reshape(-1, 2, 2)
    return np.linalg.det(F)


class Water(unittest.TestCase):
    def test_a_sealed_element_has_the_pressure_of_the_packing_at_constant_volume(self):
        newton = element(PoreWater(1e-9))
        state = grainlaw.State(read_material(COMM, LATTICE))
        list(newton.to(0))
        for load in (0.2, 0.4, 0.6, 0.8, 1):
            newton.step_time = 100 * load   # sealed, whatever the time
            list(newton.to(load))
            shorter = 1 - 5e-3 * load
            F = np.diag([1 / shorter, shorter])
            stress = state.evaluate(F).P
            state.commit()
            expected = CONFINING + stress[0, 0] * F[0, 0]
            self.assertGreater(expected, 1e3)
            self.assertLess(np.abs(pressures(newton) / expected - 1).max(), 1e-6)
            P = newton.points.P.x.array.reshape(-1, 2, 2)[newton.points._P_rows]
            self.assertLess(np.abs(P - stress).max(initial=0), 1e-6 * np.abs(stress).max())
            self.assertLess(np.abs(determinants(newton) - 1).max(initial=0), 1e-10)

    def test_water_of_a_bulk_modulus_is_compressed_by_its_pressure(self):
        modulus = 1e7
        newton = element(PoreWater(1e-9, modulus), side_pressure=False)
        before = newton.points.states.measure(grainlaw.Measure.VOID_RATIO)
        list(newton.to(0))
        for load in (0.5, 1):
            list(newton.to(load))
        after = newton.points.states.measure(grainlaw.Measure.VOID_RATIO)
        p = pressures(newton)
        self.assertGreater(p.min(), 1e5)
        self.assertLess(np.ptp(p), 1e-6 * p.max())
        self.assertLess(np.abs(after / before * np.exp(p[0] / modulus) - 1).max(initial=0), 1e-9)

    @unittest.skipIf(COMM.size > 1, "on one rank")
    def test_stiffness_is_that_of_differences(self):
        cases = [(square(), LATTICE, 2)]
        cases += [(mesh.create_unit_cube(COMM, 1, 1, 1), SPHERES, 3)]
        for domain, material, dimension in cases:
            with self.subTest(dimension=dimension):
                w = fem.Function(water_space(domain))
                points = Points(domain, read_material(COMM, material), degree=2)
                newton = WaterNewton(points, w, [], lambda load: None, PoreWater(1e-9, 1e9, True))
                points.set_time_step(1)
                newton.flow.time.value = 10
                pore = np.zeros(len(w.x.array), bool)
                pore[w.function_space.sub(1).collapse()[1]] = True
                chance = np.random.default_rng(7)
                size = np.where(pore, 1e4, 1e-4)
                u, d = (size * (chance.random(len(size)) - 0.5) for _ in range(2))
                h, sides = 1e-4, []
                for sign in (1, -1):
                    w.x.array[:] = u + sign * h * d
                    self.assertTrue(points.evaluate(w).ok)
                    sides.append(fem.petsc.assemble_vector(newton._residual).array.copy())
                w.x.array[:] = u
                points.evaluate(w)
                matrix = fem.petsc.assemble_matrix(newton._stiffness)
                matrix.assemble()
                direction = fem.Function(w.function_space)
                direction.x.array[:] = d
                foreseen = (matrix * direction.vector).array
                change = (sides[0] - sides[1]) / (2 * h)
                for part in (pore, ~pore):
                    self.assertLess(np.abs(change - foreseen)[part].max(), 1e-6 * np.abs(change[part]).max())

    def test_mistakes_are_told(self):
        for wrong, words in (({"permeability": 0}, "the permeability is 0 m2/(Pa s), expected above 0"),
                             ({"permeability": -1e-9}, "the permeability is -1e-09"),
                             ({"permeability": math.nan}, "the permeability is nan"),
                             ({"permeability": 1e-9, "bulk_modulus": -2e9}, "the bulk modulus of water is -2"),
                             ({"permeability": 1e-9, "bulk_modulus": 0}, "the bulk modulus of water is 0 Pa")):
            with self.assertRaises(grainlaw.Error) as caught:
                PoreWater(**wrong)
            self.assertIn(words, str(caught.exception))
        with self.assertRaises(grainlaw.Error) as caught:
            element(PoreWater(1e-9), side_pressure=False)
        self.assertIn("nothing determines the pore pressure", str(caught.exception))
        w = fem.Function(water_space(square()))   # before any point is made
        walls = [on(w.function_space.sub(0).sub(axis), lambda x, axis=axis: np.isclose(x[axis], 0) |
                    np.isclose(x[axis], 1))[0] for axis in (0, 1)]
        with self.assertRaises(grainlaw.Error) as caught:
            check_drainage(w, walls, PoreWater(1e-9))
        self.assertIn("nothing determines the pore pressure", str(caught.exception))
        check_drainage(w, walls, PoreWater(1e-9, 1e9))
        check_drainage(w, walls[:1], PoreWater(1e-9))
        newton = element(PoreWater(1e-9))
        newton.step_time = -1
        with self.assertRaises(grainlaw.Error) as caught:
            list(newton.to(1))
        self.assertIn("step_time is -1 s, expected at least 0", str(caught.exception))
        with self.assertRaises(grainlaw.Error) as caught:
            read_material(COMM, "nowhere.toml")
        self.assertIn("nowhere.toml", str(caught.exception))

    @unittest.skipUnless(importlib.util.find_spec("h5py"), "checkpoints need h5py")
    def test_a_restart_goes_on_as_if_nothing_had_happened(self):
        water = PoreWater(1e-9, 1e8, True)
        whole = element(water, led_to=1.2 * CONFINING)
        whole.step_time = 1
        list(whole.to(0))
        list(whole.to(0.5))
        whole.save("water.h5")
        list(whole.to(1))
        half = element(water)
        half.load("water.h5")
        self.assertLess(np.abs(half.flow.solid.x.array - whole.flow.solid.x.array).max(), 1e-12)
        COMM.Barrier()
        if COMM.rank == 0:
            os.unlink("water.h5")
        half.step_time = 1
        list(half.to(1))
        self.assertLess(np.abs(pressures(half) - pressures(whole)).max(), 1e-10 * CONFINING)

    @unittest.skipIf(COMM.size == 1, "on several ranks")
    def test_ranks_answer_as_one_alone(self):
        def answer(comm):
            newton, stiffness, top = column(comm, read_material(comm, SAND), PoreWater(1e-9, 1e9, True))
            list(newton.to(0))
            newton.step_time = 0.02 / (1e-9 * stiffness)
            for step in range(3):
                list(newton.to(step + 1))
            moved = newton.u.x.array[top[top < newton.owned]].min(initial=0)
            return np.array((comm.allreduce(moved, MPI.MIN), newton.force(top)))

        alone = answer(MPI.COMM_SELF) if COMM.rank == 0 else None
        self.assertLess(np.abs(answer(COMM) / COMM.bcast(alone) - 1).max(), 1e-10)


if __name__ == "__main__":
    with open(os.devnull, "w", encoding="utf-8") as nowhere:
        result = unittest.TextTestRunner(sys.stderr if COMM.rank == 0 else nowhere).run(
            unittest.defaultTestLoader.loadTestsFromTestCase(Water))
    if not result.wasSuccessful():
        for _, text in result.failures + result.errors:
            print(f"rank {COMM.rank}: {text}", file=sys.stderr)
        COMM.Abort(1)
