"""In a host that traps invalid operations: wrong numbers are refused, and no signal is raised."""
import ctypes
import os
import unittest

import numpy as np

import grainlaw
from grainlaw import Status, Tangent, tests
from grainlaw.steps import LoadSteps
from support import Case, material

ALL = 1 | 4 | 8  # invalid, division by zero, overflow


@unittest.skipUnless(os.uname().machine == "x86_64", "numbers of the traps are of x86")
class Traps(Case):
    def setUp(self):
        self.states = grainlaw.States(material(), 2)
        self.good = np.tile(np.diag([1.0, 0.999]), (2, 1, 1))
        self.environment = ctypes.CDLL("libm.so.6")
        self.environment.feenableexcept(ALL)

    def tearDown(self):
        self.assertEqual(self.environment.fegetexcept(), ALL)
        self.environment.fedisableexcept(ALL)

    def test_deformation_gradients(self):
        for bad in (np.nan, np.inf):
            self.good[1, 0, 1] = bad
            for F in (self.good, self.good.tolist(), self.good.astype(np.float32)):
                self.assert_refused(Status.NOT_FINITE, ["point 1", "F12"], self.states.evaluate, F,
                                    Tangent.EXACT)

    def test_steps_that_fail(self):
        self.good[0] *= 3
        answer = self.states.evaluate(self.good, Tangent.EXACT)
        self.assertFalse(answer.ok)
        self.assertLess(answer.step_ratio, 1)
        self.assertIn("point 0", answer.message)

    def test_numbers_of_tests(self):
        for bad in (np.nan, np.inf):
            self.assert_refused(Status.BAD_ARGUMENT, ["time step"], self.states.set_time_step, bad)
            for call in (lambda: tests.drained(material(), bad), lambda: tests.Stop(q=bad),
                         lambda: tests.drained(material(), consolidation=bad)):
                self.assertRaisesRegex(ValueError, "finite", call)

    def test_load_steps(self):
        for bad in (float("nan"), float("inf")):
            with self.assertRaises(ValueError):
                LoadSteps([0, bad, 1])
            steps = LoadSteps(1)
            steps.cut(bad)
            self.assertEqual(steps.load, 0.5)


if __name__ == "__main__":
    unittest.main()
