"""Load steps that are cut, alone and around a point that refuses a large increment."""
import unittest

import numpy as np

import grainlaw
from grainlaw.steps import LoadSteps, StepTooSmall
from support import Case, material


def lead(states, steps, compression):
    """Stresses along uniaxial compression, wherever a step was accepted."""
    stresses = []
    while steps:
        F = np.tile(np.diag([1.0, 1.0 - compression * steps.load]), (len(states), 1, 1))
        answer = states.evaluate(F)
        if answer.ok:
            states.commit()
            steps.accept()
            stresses.append(answer.P)
        else:
            states.revert()
            steps.cut(answer.step_ratio)
    return np.array(stresses)


class Steps(Case):
    def test_a_number_stands_for_equal_steps(self):
        steps = LoadSteps(4)
        while steps:
            steps.accept()
        self.assertEqual(steps.accepted, [0.25, 0.5, 0.75, 1.0])

    def test_a_refused_increment_is_cut_and_the_load_reached(self):
        cut = grainlaw.States(material(), 2)
        steps = LoadSteps(1)
        stresses = lead(cut, steps, 0.33)  # a stretch by more than 30 % is refused
        self.assertGreaterEqual(steps.cuts, 1)
        self.assertEqual(steps.accepted[-1], 1.0)

        uncut = grainlaw.States(material(), 2)
        same = LoadSteps(steps.accepted)
        self.assertEqual(lead(uncut, same, 0.33).tobytes(), stresses.tobytes())
        self.assertEqual(same.cuts, 0)
        self.assertEqual(uncut.save(), cut.save())

    def test_a_cut_follows_the_ratio_within_bounds_and_parts_grow_again(self):
        for ratio, part in ((0.3, 0.3), (0.0, 0.1), (1.0, 0.5), (float("nan"), 0.5)):
            steps = LoadSteps(1)
            steps.cut(ratio)
            self.assertAlmostEqual(steps.load, part, msg=str(ratio))
        steps = LoadSteps(1)
        steps.cut(0.3)
        steps.accept()
        self.assertAlmostEqual(steps.load, 0.9)
        steps.accept()
        self.assertEqual(steps.load, 1.0)

    def test_a_step_that_always_fails_ends(self):
        steps = LoadSteps(2, max_cuts=3)
        with self.assertRaises(StepTooSmall):
            for _ in range(5):
                steps.cut(0.5)
        self.assertEqual(steps.accepted, [])

    def test_parts_of_a_step_take_the_time_of_the_whole(self):
        steps = LoadSteps([0, 0.5, 1])
        self.assertEqual(steps.part, 1)
        steps.accept()
        self.assertEqual(steps.part, 1)
        steps.cut(0.25)
        parts = []
        while steps.number == 1:
            parts.append(steps.part)
            steps.accept()
        self.assertEqual(parts, [0.25, 0.5, 0.25])
        self.assertEqual(steps.part, 1)

    def test_load_at_the_start_is_a_step_that_cannot_be_cut(self):
        steps = LoadSteps([0, 1])
        self.assertEqual(steps.load, 0.0)
        with self.assertRaises(StepTooSmall):
            steps.cut(0.5)
        steps.accept()
        self.assertEqual(steps.load, 1.0)

    def test_bad_loads_are_refused(self):
        for loads in (0, [], [0.5, 0.5], [0.5, 0.2], [-1, 1], [1, 2], [float("nan")]):
            with self.assertRaises(ValueError):
                LoadSteps(loads)

    def test_what_is_no_number_is_told(self):
        for loads in ("12", "x", 1.5, None, 10**8, 2**70):
            with self.assertRaisesRegex(ValueError, "number of load steps .* from 1 to"):
                LoadSteps(loads)
        for loads in ([0, "1"], [None], [0.5, 1j]):
            self.assertRaisesRegex(ValueError, "load .*: expected a finite number", LoadSteps, loads)
        for cuts in (-1, 1.5, "x", None, 2000):
            self.assertRaisesRegex(ValueError, "max_cuts .* from 0", LoadSteps, 1, cuts)
        for ratio in ("x", None, [0.5]):
            self.assertRaisesRegex(ValueError, "ratio .*: expected a number", LoadSteps(1).cut, ratio)
        self.assertEqual(LoadSteps(np.int64(2)).load, 0.5)
        self.assertEqual(LoadSteps(np.linspace(0.25, 1, 4)).load, 0.25)


if __name__ == "__main__":
    unittest.main()
