"""The classes of FEMxDEM's scripts: equilibrium, the packing's own answers, water, cut steps, bad input."""
import contextlib
import io
import os
import tempfile
import unittest
from unittest import mock

import numpy as np
from esys.escript import FunctionOnBoundary, ReducedSolution, Solution, Vector, interpolate, whereZero

import grainlaw
from grainlaw import laboratory
from grainlaw.femxdem import MultiScale2D, MultiScale3D, MultiScaleUP, saveGauss2D, saveGauss3D
from support import DISCS, PRESSURE, ROOT, Case, biaxial, brick, count, rectangle, rough, rows, unbalanced

STRAIN = 1e-3
YADE = os.path.join(ROOT, "verification/scenes/yade400.toml")   # 400 discs, packed by YADE


class Plane(Case):
    def single_element(self, rtol, steps=4):
        """FEMxDEM's single element: four points, drained."""
        domain = rectangle(1, 1, order=1)
        prob = MultiScale2D(domain=domain, ng=4, np=1, rtol=rtol, material=YADE)
        mask, values, sides = biaxial(domain, STRAIN)
        for _ in range(steps):
            prob.initialize(f=sides, specified_u_mask=mask, specified_u_val=values)
            prob.solve(iter_max=100)
        return prob

    def test_a_single_element_goes_where_the_element_test_goes(self):
        state = grainlaw.State(grainlaw.Material(YADE))
        for _ in range(4):
            result = laboratory.path(state, 1, dF22=-STRAIN, sigma11=-PRESSURE, sigma12=0.0, tolerance=1e-10)
        expected = result.sigma[-1]
        found = rows(self.single_element(1e-9).getCurrentStress())
        np.testing.assert_allclose(found[:, 1, 1], expected[1, 1], rtol=1e-5)
        at_its_own = rows(self.single_element(1e-2).getCurrentStress())
        np.testing.assert_allclose(at_its_own[:, 1, 1], expected[1, 1], rtol=1e-3)

    def test_a_mesh_is_in_equilibrium_and_has_what_scripts_ask_for(self):
        domain = rectangle(1, 2)
        prob = MultiScale2D(domain, ng=count(domain), np=2, rtol=1e-9, material=self.discs)
        disp = Vector(0.0, Solution(domain))
        mask, values, sides = biaxial(domain, STRAIN)
        for _ in range(3):
            prob.initialize(f=sides, specified_u_mask=mask, specified_u_val=values)
            disp += prob.solve()
        self.assertIs(prob.getDomain(), domain)
        self.assertEqual(prob.getRelTolerance(), 1e-9)
        self.assertLess(unbalanced(prob.getDomain(), prob.getCurrentStress(), sides, mask), 1e-8)
        n, own = count(domain), prob._states
        np.testing.assert_allclose(rows(prob.getCurrentStress()), own.measure(grainlaw.Measure.CAUCHY_STRESS),
                                   rtol=1e-9, atol=1e-4)
        self.assertEqual(rows(prob.getLocalVoidRatio()).tolist(), own.measure(grainlaw.Measure.VOID_RATIO).tolist())
        self.assertEqual(rows(prob.getLocalFabric()).tolist(), own.measure(grainlaw.Measure.FABRIC).tolist())
        mean = [np.mean(own.particles(k)["rotation"]) for k in range(n)]
        np.testing.assert_allclose(rows(prob.getLocalAvgRotation()), mean, rtol=1e-9)
        self.assertEqual(prob.getCurrentTangent().getShape(), (2, 2, 2, 2))
        np.testing.assert_allclose(rows(prob.getCurrentStrain())[:, 1, 1].mean(), -3 * STRAIN, rtol=5e-3)
        np.testing.assert_allclose(rows(interpolate(disp, Solution(domain)))[:, 1].min(), -3 * STRAIN)
        with tempfile.TemporaryDirectory() as folder:
            prob.getCurrentPacking(pos=[5], time=7, prefix=folder + "/")
            self.assertEqual(sorted(os.listdir(folder)), [f"packing_5_7{end}" for end in (
                ".vtp", "_cell.csv", "_contacts.csv", "_particles.csv")])
            prob.getCurrentPacking(pos=(), time=8, prefix=folder + "/all")
            self.assertEqual(len(os.listdir(folder)), 4 + 4 * n)
            name = os.path.join(folder, "gauss.dat")
            saveGauss2D(name=name, pos=[0, 3], strain=prob.getCurrentStrain(), stress=prob.getCurrentStress())
            with open(name, encoding="ascii") as file:
                lines = file.read().splitlines()
        self.assertEqual([lines[0], lines[3], len(lines)], ["strain 2", "stress 2", 6])
        self.assertEqual([float(word) for word in lines[5].split()],
                         rows(prob.getCurrentStress())[3].ravel().tolist())
        prob.exitSimulation()

    def test_a_step_that_fails_is_cut_and_one_that_cannot_be_made_leaves_an_equilibrium(self):
        domain = rectangle(1, 1, order=1)
        prob = MultiScale2D(domain, ng=4, rtol=1e-6, material=self.discs, verbose=True)
        mask, values, sides = biaxial(domain, 0.01)
        told = io.StringIO()
        with contextlib.redirect_stdout(told):
            prob.initialize(f=sides, specified_u_mask=mask, specified_u_val=values)
            prob.solve(iter_max=4)
        self.assertGreater(prob.march.cuts, 0)
        self.assertIn("it is cut", told.getvalue())
        self.assertLess(unbalanced(domain, prob.getCurrentStress(), sides, mask), 1e-4)
        height = rows(domain.getX())[:, 1].max()
        self.assertAlmostEqual(height, 0.99, places=12)
        prob.initialize(f=sides * 100, specified_u_mask=mask * 0, specified_u_val=values)   # nothing holds it
        with contextlib.redirect_stdout(told), self.assertRaisesRegex(grainlaw.StepError, "supports"):
            prob.solve()
        self.assertEqual(rows(domain.getX())[:, 1].max(), height)

    def test_what_cannot_be_meant_is_told(self):
        domain = rectangle(1, 1)
        for said, how in (("ng 3: expected 4", {"ng": 3}), ("np 0: expected", {"ng": 4, "np": 0}),
                          ("dimension 3, expected 2", {"ng": 4, "material": self.spheres}),
                          ("material and random", {"ng": 4, "material": self.discs, "random": True})):
            with self.subTest(said), self.assertRaisesRegex((ValueError, TypeError), said):
                MultiScale2D(domain, **{"material": self.discs, **how})
        with self.assertRaisesRegex(ValueError, "a domain of dimension 2: expected 3"):
            MultiScale3D(domain, ng=4, material=self.spheres)
        with self.assertRaisesRegex(grainlaw.Error, "0.toml: cannot be read"), \
                contextlib.chdir(tempfile.gettempdir()):
            MultiScale2D(domain, ng=4)
        prob = MultiScale2D(domain, ng=4, material=self.discs)
        with self.assertRaisesRegex(ValueError, "initialize"):
            prob.solve()
        with self.assertRaisesRegex(ValueError, "f has entries that are no numbers"):
            prob.initialize(b=[0.0, -1e4], f=[float("nan"), 0.0])
        mask, values, sides = biaxial(domain, STRAIN)
        prob.initialize(f=sides, specified_u_mask=mask, specified_u_val=values)
        with self.assertRaisesRegex(ValueError, "iter_max 0: expected"):
            prob.solve(iter_max=0)
        self.assertRaisesRegex(ValueError, "rtol 0", MultiScale2D, domain, ng=4, rtol=0, material=self.discs)

    def test_points_have_files_of_their_own_and_only_one_process_of_a_pool_goes_on(self):
        with tempfile.TemporaryDirectory() as folder, contextlib.chdir(folder):
            with open(DISCS, encoding="utf-8") as file:
                text = file.read().replace('"sand100', f'"{os.path.dirname(os.path.realpath(DISCS))}/sand100')
            for k in range(4):
                with open(f"{k}.toml", "w", encoding="utf-8") as file:
                    file.write(text.replace("ratio = 0.8", f"ratio = 0.{5 + k}"))
            prob = MultiScale2D(rectangle(1, 1), ng=4, useMPI=True, random=True)
            stiff = rows(prob.getCurrentTangent())[:, 0, 0, 0, 0]
            self.assertTrue(np.all(np.diff(stiff) > 0), stiff)
        with mock.patch.dict(os.environ, {"OMPI_COMM_WORLD_RANK": "1"}), self.assertRaises(SystemExit) as ended:
            MultiScale2D(rectangle(1, 1), ng=4, useMPI=True, material=self.discs)
        self.assertEqual(ended.exception.code, 0)


class Solid(Case):
    def test_a_rough_triaxial_test_is_in_equilibrium_and_has_what_scripts_ask_for(self):
        domain = brick(1)
        prob = MultiScale3D(domain=domain, ng=8, useMPI=True, rtol=1e-8, material=self.spheres)
        mask, values, sides = rough(domain, STRAIN)
        for _ in range(2):
            prob.initialize(f=sides, specified_u_mask=mask, specified_u_val=values)
            prob.solve(iter_max=100)
        self.assertLess(unbalanced(domain, prob.getCurrentStress(), sides, mask), 1e-7)
        shapes = [data.getShape() for data in (
            prob.getLocalVoidRatio(), prob.getLocalAvgRotation(), prob.getLocalFabric(), prob.getCurrentStrain(),
            prob.getCurrentTangent())]
        self.assertEqual(shapes, [(), (3,), (3, 3), (3, 3), (3, 3, 3, 3)])
        np.testing.assert_allclose(np.trace(rows(prob.getLocalFabric()), axis1=1, axis2=2), 1, rtol=1e-12)
        own = [prob._states.particles(k)["rotation"].mean(axis=0) for k in range(8)]
        np.testing.assert_allclose(rows(prob.getLocalAvgRotation()), own, rtol=1e-9)
        with tempfile.TemporaryDirectory() as folder:
            name = os.path.join(folder, "gauss.dat")
            saveGauss3D(name=name, fabric=prob.getLocalFabric())
            with open(name, encoding="ascii") as file:
                lines = file.read().splitlines()
        self.assertEqual([len(line.split()) for line in lines], [2] + 8 * [9])


class Water(Case):
    def problem(self, strain, steps=2, drains=False, **how):
        domain = rectangle(1, 2)
        prob = MultiScaleUP(domain, ng=8, rtol=1e-7, material=self.discs, **how)
        mask, values, sides = biaxial(domain, strain, PRESSURE + how.get("pore0", 0.0))
        held = {}
        if drains:
            held = {"pmsk": whereZero(ReducedSolution(domain).getX()[1] - 1),
                    "pvalue": how.get("pore0", 0.0) + 0 * ReducedSolution(domain).getX()[1]}
        for _ in range(steps):
            prob.initialize(f=sides, umsk=mask, uvalue=values, **held)
            prob.solve(globalIter=10, solidIter=50)
        return prob, mask, sides

    def total(self, prob):
        pore = interpolate(prob.getCurrentPore(), prob.getCurrentStress().getFunctionSpace())
        return prob.getCurrentStress() - pore * np.eye(2)

    def test_closed_water_keeps_the_volume_but_for_its_own_compression(self):
        for bulk in (2.2e9, 2.2e17):
            prob, mask, sides = self.problem(STRAIN, pore0=5e4, kf=bulk, perm=1e-6, dt=0.1)
            self.assertLess(unbalanced(prob.getDomain(), self.total(prob), sides, mask), 1e-5)
            rise = rows(prob.getCurrentPore()).mean() - 5e4
            self.assertGreater(rise, 5e3)
            porosity = rows(prob.getEquivalentPorosity()).mean()
            lost = -np.log(np.linalg.det(prob._start)).mean()
            self.assertAlmostEqual(lost, porosity * rise / bulk, delta=2e-8)

    def test_water_that_drains_at_once_leaves_the_drained_test(self):
        prob, _, _ = self.problem(STRAIN, pore0=5e4, perm=1.0, dt=10.0, drains=True)
        np.testing.assert_allclose(rows(prob.getCurrentPore()), 5e4, rtol=1e-4)
        domain = rectangle(1, 2)
        dry = MultiScale2D(domain, ng=8, rtol=1e-7, material=self.discs)
        mask, values, sides = biaxial(domain, STRAIN)
        for _ in range(2):
            dry.initialize(f=sides, specified_u_mask=mask, specified_u_val=values)
            dry.solve()
        np.testing.assert_allclose(rows(prob.getCurrentStress()), rows(dry.getCurrentStress()), rtol=1e-4, atol=20)

    def test_a_column_consolidates_as_terzaghi_found(self):
        bonded = grainlaw.Material(os.path.join(ROOT, "tests/data/bonded100.toml"))
        answer = grainlaw.State(bonded).answer(grainlaw.Tangent.EXACT)
        load, modulus, shear = 1e3, answer.A[1, 1, 1, 1], answer.P[0, 1]
        domain = rectangle(1, 4)
        prob = MultiScaleUP(domain, ng=16, rtol=1e-4, material=bonded, perm=1e-9, kf=2.2e15)
        n = rows(prob.getEquivalentPorosity()).mean()
        diffusivity = modulus * 1e-9 * n**3 / (1 - n)**2
        x, edge = domain.getX(), FunctionOnBoundary(domain).getX()
        pore = ReducedSolution(domain).getX()
        held = whereZero(x[1]) * [1, 1] + (whereZero(x[0]) + whereZero(x[0] - 1)) * [1, 0]
        forces = (whereZero(edge[1] - 1) * [shear, answer.P[1, 1] - load]
                  + (whereZero(edge[0] - 1) - whereZero(edge[0])) * [0, shear])
        prob.setTimeStep(1e-7 / diffusivity)
        prob.initialize(f=forces, umsk=held)
        prob.solve()
        np.testing.assert_allclose(rows(prob.getCurrentPore()), load, rtol=1e-6)
        prob.setTimeStep(0.02 / diffusivity)
        for _ in range(10):
            prob.initialize(f=forces, umsk=held, pmsk=whereZero(pore[1] - 1), pvalue=0 * pore[1])
            prob.solve()
        settled = (1 - rows(domain.getX())[:, 1].max()) * modulus / load
        roots = np.pi * (np.arange(100) + 0.5)
        fade = np.exp(-roots**2 * 0.2)
        self.assertAlmostEqual(settled, 1 - np.sum(2 / roots**2 * fade), delta=0.01)
        self.assertAlmostEqual(rows(prob.getCurrentPore()).max() / load, np.sum(2 / roots * np.sin(roots) * fade),
                               delta=0.015)

    def test_the_flux_leaves_by_the_top_as_volume_is_lost(self):
        prob, _, _ = self.problem(STRAIN, steps=1, perm=1e-9, dt=10.0, drains=True)
        pore = rows(prob.getCurrentPore())
        self.assertGreater(pore.max(), 100.0)
        self.assertGreater(rows(prob.getCurrentFlux())[:, 1].max(), 0)
        self.assertEqual(prob.getCurrentFlux().getShape(), (2,))

    def test_what_cannot_be_meant_is_told(self):
        for said, how in (("kf -1", {"kf": -1.0}), ("dt 0", {"dt": 0}), ("perm -1", {"perm": -1.0})):
            with self.subTest(said), self.assertRaisesRegex(ValueError, said):
                MultiScaleUP(rectangle(1, 1), ng=4, material=self.discs, **how)


if __name__ == "__main__":
    unittest.main()
