"""Tests by b, along rays, in torsion, cyclic until an amplitude; stiffness against strain; batches."""
import os
import unittest

import numpy as np

import grainlaw
from grainlaw import laboratory
from grainlaw.laboratory import Batch, Loops
from support import DATA, Case

TEXT = """dimension = {dimension}
{thickness}
[packing]
generator = "compaction"
count = {count}
radii = [3e-3, 5e-3]
seed = {seed}
pressure = 100e3
[contact]
law = "frictional"
young = {young}
ratio = 0.8
friction = 0.5
"""
_made = {}


def sand(dimension=2, seed=2, count=60):
    """A small packing at 100 kPa, made once."""
    key = (dimension, seed, count)
    if key not in _made:
        _made[key] = grainlaw.Material.parse(TEXT.format(
            dimension=dimension, seed=seed, count=count,
            thickness="thickness = 0.1" if dimension == 2 else "",
            young=2e9 if dimension == 2 else 1e8))
    return _made[key]


def normal(result):
    return -np.diagonal(result.sigma, axis1=1, axis2=2)


def direction(result):
    """Of the largest principal stress of the plane 1, 3 from axis 3 [degree], and b, past the start."""
    compression = -result.sigma[1:]
    half = 0.5 * (compression[:, 2, 2] - compression[:, 0, 0])
    mean, size = 0.5 * (compression[:, 2, 2] + compression[:, 0, 0]), np.hypot(half, compression[:, 0, 2])
    turned = 0.5 * np.degrees(np.arctan2(-compression[:, 0, 2], half))
    return turned, (compression[:, 1, 1] - mean + size) / (2 * size)


class Paths(Case):
    def test_true_triaxial_keeps_b_and_the_mean_pressure(self):
        result = laboratory.true_triaxial(sand(3), b=0.4, strain=0.002)
        third, second, first = normal(result)[1:].T
        np.testing.assert_allclose((second - third) / (first - third), 0.4, atol=1e-5)
        np.testing.assert_allclose(result.mean_pressure, result.mean_pressure[0], rtol=1e-7)
        held = laboratory.true_triaxial(sand(3), b=1.0, strain=0.001, lateral_stress=100e3)
        np.testing.assert_allclose(normal(held)[-1, 0], 100e3, rtol=1e-7)
        self.assertRaises(ValueError, laboratory.true_triaxial, sand(), 0.5, 0.002)
        self.assertRaises(ValueError, laboratory.true_triaxial, sand(3), 1.5)

    def test_rays_keep_their_ratio_of_stresses_or_strains(self):
        by_stress = laboratory.radial(sand(), 0.002, stress_ratio=0.45)
        change = normal(by_stress) - normal(by_stress)[0]
        np.testing.assert_allclose(change[1:, 0] / change[1:, 1], 0.45, rtol=1e-5)
        by_strain = laboratory.radial(sand(), 0.002, poisson=0.25)
        F = by_strain.F[-1]
        self.assertAlmostEqual((F[0, 0] - 1) / (1 - F[1, 1]), 0.25, places=10)
        zero = laboratory.radial(sand(), 0.001, poisson=0.0)
        np.testing.assert_allclose(zero.sigma, laboratory.oedometric(sand(), 0.001).sigma, rtol=1e-9)
        self.assertRaises(ValueError, laboratory.radial, sand())
        self.assertRaises(ValueError, laboratory.radial, sand(), stress_ratio=0.4, poisson=0.2)

    def test_torsion_keeps_normal_stresses_or_volume_with_their_differences(self):
        for dimension in (2, 3):
            drained = laboratory.torsional(sand(dimension), 0.002)
            np.testing.assert_allclose(normal(drained)[-1], normal(drained)[0], rtol=1e-7)
            undrained = laboratory.torsional(sand(dimension), 0.002, drained=False)
            np.testing.assert_allclose(np.linalg.det(undrained.F), 1, rtol=1e-12)
            ends = normal(undrained)
            np.testing.assert_allclose(ends[-1] - ends[-1, -2], ends[0] - ends[0, -2],
                                       atol=1e-7 * 100e3)
            self.assertAlmostEqual(undrained.shear_strain[-1], 0.002, delta=1e-5)

    def test_a_hollow_cylinder_keeps_alpha_b_and_the_mean_pressure_or_the_volume(self):
        for alpha in (0, 30, 45, 75, 90):
            for drained in (True, False):
                result = laboratory.hollow_cylinder(sand(3), alpha, b=0.3, strain=0.001, step=2.5e-4,
                                                    drained=drained)
                turned, b = direction(result)
                np.testing.assert_allclose(np.cos(2 * np.radians(turned - alpha)), 1, atol=1e-9)
                np.testing.assert_allclose(b, 0.3, atol=1e-5)
                if drained:
                    np.testing.assert_allclose(result.mean_pressure, 100e3, rtol=1e-6)
                else:
                    np.testing.assert_allclose(np.linalg.det(result.F), 1, rtol=1e-12)
        self.assertGreater(result.F[-1, 2, 2], 1)   # alpha 90 is extension
        for how in ({"alpha": 91}, {"alpha": 30, "b": -0.1}, {"alpha": 30, "strain": -0.1}):
            self.assertRaises(ValueError, laboratory.hollow_cylinder, sand(3), **how)
        with self.assertRaisesRegex(ValueError, "expected spheres"):
            laboratory.hollow_cylinder(sand(), 30)

    def test_principal_stresses_turn_and_stay_as_they_are(self):
        for dimension in (2, 3):
            state = grainlaw.State(sand(dimension))
            laboratory.constant_p(state, 3e-4)
            result = laboratory.rotation(state, 180, 12)
            plane = result.sigma[:, ::dimension - 1, ::dimension - 1]
            stresses = np.linalg.eigvalsh(plane)
            np.testing.assert_allclose(stresses, np.broadcast_to(stresses[0], stresses.shape), rtol=1e-6)
            np.testing.assert_allclose(plane[-1], plane[0], atol=1)
            np.testing.assert_allclose(plane[6] + plane[0], np.eye(2) * np.trace(plane[0]), atol=1)
            self.assertGreater(abs(result.sigma[3, 0, -1]), 1e3)
        with self.assertRaisesRegex(ValueError, "a test before"):
            laboratory.rotation(laboratory.path(sand(), 1, sigma11=-1e5, sigma22=-1e5, sigma12=0.0).state)
        self.assertRaises(ValueError, laboratory.rotation, sand(), 0.0)

    def test_simple_shear_with_constant_volume_ends_at_its_double_amplitude_and_keeps_the_volume(self):
        result = laboratory.shear_constant_volume(
            sand(), 0.05, loops=Loops(20, q=15e3), stop=laboratory.Stop(double_amplitude=1e-4))
        self.assertIn("double amplitude", result.ended)
        np.testing.assert_allclose(np.linalg.det(result.F), 1, rtol=1e-12)

    def test_cyclic_undrained_ends_at_its_double_amplitude(self):
        result = laboratory.cyclic_undrained(sand(), 0.2, cycles=5, double_amplitude=2e-4)
        self.assertIn("double amplitude", result.ended)
        self.assertIn("in loop", result.ended)
        strain = result.axial_strain
        self.assertGreaterEqual(np.ptp(strain), 2e-4 * (1 - 1e-6))
        self.assertLess(np.abs(result.deviatoric_stress).max(), 42e3)
        self.assertRaises(ValueError, laboratory.cyclic_undrained, sand(), 0.0)


class Series(Case):
    def test_stiffness_falls_and_damping_rises_with_strain(self):
        found = laboratory.stiffness(sand(), (1e-6, 1e-4, 1e-3), 5)
        self.assertTrue(np.all(np.diff(found.modulus) < 0), found.modulus)
        self.assertLess(np.abs(found.damping[:2]).max(), 1e-5)   # elastic
        self.assertGreater(found.damping[2], 0.01)
        A = grainlaw.State(sand()).answer(grainlaw.Tangent.EXACT).A
        self.assertLess(abs(found.modulus[0] / A[0, 1, 0, 1] - 1), 0.02)
        loop = laboratory.shear_constant_volume(sand(), 1e-4, 2e-5, loops=Loops(2, strain=1e-4))
        self.assertEqual(loop.sigma.tobytes(), found.results[1].sigma.tobytes())
        self.assertRaises(ValueError, laboratory.stiffness, sand(), (0.0,))

    def test_bonds_that_hold_have_no_damping(self):
        bonded = grainlaw.Material(os.path.join(DATA, "bonded100.toml"))
        found = laboratory.stiffness(bonded, (1e-6, 1e-5), 5)
        np.testing.assert_allclose(found.damping, 0, atol=1e-5)
        np.testing.assert_allclose(found.modulus[1], found.modulus[0], rtol=1e-2)

    def test_a_batch_has_a_result_for_each_packing_and_pressure(self):
        batch = Batch(laboratory.drained, {"one": sand(), "other": sand(seed=3)}, [80e3, 120e3],
                      strain=0.001)
        self.assertEqual(len(batch), 4)
        self.assertAlmostEqual(batch["other", 120e3].mean_pressure[0], 120e3, delta=1)
        self.assertRaises(ValueError, Batch, laboratory.drained, {}, [1e5])
        self.assertRaisesRegex(TypeError, "by name, as", Batch, laboratory.drained, [sand()], [1e5])
        self.assertRaisesRegex(TypeError, "pressures 100000.0: expected several", Batch, laboratory.drained,
                               {"one": sand()}, 1e5)
        self.assertRaisesRegex(TypeError, "strains 0.0001: expected several", laboratory.stiffness, sand(), 1e-4)
        try:
            import matplotlib  # pylint: disable=import-outside-toplevel,unused-import
        except ImportError:
            return
        self.assertEqual(len(batch.plot().axes), 4)


if __name__ == "__main__":
    unittest.main()
