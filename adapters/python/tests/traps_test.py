"""In a host that traps invalid operations: wrong numbers are refused, and no signal is raised."""
import ctypes
import os
import unittest

import numpy as np

import grainlaw
from grainlaw import Status, Tangent, tests
from grainlaw.march import load_steps
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

    def test_marches(self):
        for bad in (np.nan, np.inf):
            self.assertRaises(ValueError, load_steps, [0, bad, 1])
            march = grainlaw.March()
            march.begin(1)
            for residual, scale in ((bad, 1.0), (0.0, 0.0), (1.0, 0.0)):
                self.assertEqual(march.next(), grainlaw.Action.SOLVE)
                march.tell(grainlaw.Status.OK, residual, scale, bad)
                self.assertEqual(march.next(), grainlaw.Action.BACK)
            self.assertEqual(march.next(), grainlaw.Action.SOLVE)
            self.assertEqual(march.share(bad), 0)
            self.assertEqual(march.next(), grainlaw.Action.BACK)
            self.assertEqual(march.next(), grainlaw.Action.SOLVE)
            self.assertEqual(march.load, 1 / 16)


if __name__ == "__main__":
    unittest.main()
