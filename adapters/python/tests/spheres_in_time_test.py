"""Spheres with drag: a step that is cut, and a drained test."""
import pathlib
import unittest

import numpy as np

import grainlaw
from grainlaw import Action, March, laboratory
from support import Case, material

SPHERES = pathlib.Path(__file__).resolve().parents[2] / "patch/spheres_in_time.toml"
SHORTENED = np.diag([0.0, 1e-3, -0.4])   # more than 30 % at once is refused


class Spheres(Case):
    def test_a_step_that_was_cut_ends_in_the_bits_of_its_parts(self):
        cut, parts = grainlaw.States(material(SPHERES), 2), []
        march = March(cut)
        for now in march.to(1.0):
            if now == Action.SOLVE:
                F = np.tile(np.eye(3) + march.load * SHORTENED, (2, 1, 1))
                answer = cut.evaluate(F)
                march.tell(answer)
            elif now == Action.ACCEPT:
                cut.commit()
                parts.append((F, march.time, answer.P))
            else:
                cut.revert()
        self.assertGreaterEqual(march.cuts, 1)
        self.assertAlmostEqual(sum(time for _, time, _ in parts), 1)
        uncut = grainlaw.States(material(SPHERES), 2)
        for F, time, P in parts:
            uncut.set_time_step(time)
            self.assertEqual(uncut.evaluate(F).P.tobytes(), P.tobytes())
            uncut.commit()

    def test_a_drained_test_keeps_its_lateral_stress(self):
        result = laboratory.drained(material(SPHERES), 0.004)
        self.assertLess(np.ptp(result.lateral_stress), 1e-4 * 100e3)
        self.assertGreater(result.axial_stress[-1], 1.5 * result.axial_stress[0])


if __name__ == "__main__":
    unittest.main()
