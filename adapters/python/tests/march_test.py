"""Load steps that are cut, alone and around a point that refuses a large increment."""
import unittest

import numpy as np

import grainlaw
from grainlaw import Action, March, Status, StepError
from grainlaw.march import load_steps
from support import Case, material


def lead(states, march, loads, compression):
    """Stresses along uniaxial compression and their loads, wherever a part was accepted."""
    stresses, accepted = [], []
    for load in loads:
        for now in march.to(load):
            if now == Action.SOLVE:
                F = np.tile(np.diag([1.0, 1.0 - compression * march.load]), (len(states), 1, 1))
                answer = states.evaluate(F)
                march.tell(answer)
            elif now == Action.ACCEPT:
                states.commit()
                stresses.append(answer.P)
                accepted.append(march.load)
            else:
                states.revert()
    return np.array(stresses), accepted


class Marches(Case):
    def test_a_refused_increment_is_cut_and_the_load_reached(self):
        cut = grainlaw.States(material(), 2)
        march = March(cut)
        stresses, accepted = lead(cut, march, [1.0], 0.33)  # a stretch by more than 30 % is refused
        self.assertGreaterEqual(march.cuts, 1)
        self.assertEqual(accepted[-1], 1.0)
        self.assertEqual(march.reached, 1.0)

        uncut = grainlaw.States(material(), 2)
        same = March()
        again, _ = lead(uncut, same, accepted, 0.33)
        self.assertEqual(again.tobytes(), stresses.tobytes())
        self.assertEqual(same.cuts, 0)
        self.assertEqual(uncut.save(), cut.save())

    def test_why_a_part_was_cut_is_told(self):
        states = grainlaw.States(material(), 2)
        march = March(states)
        reasons = []
        for now in march.to(1.0):
            if now == Action.SOLVE:
                march.tell(states.evaluate(np.tile(np.diag([1.0, 1 - 0.33 * march.load]), (2, 1, 1))))
            elif now == Action.ACCEPT:
                states.commit()
            else:
                states.revert()
                reasons.append(march.message)
        self.assertTrue(reasons[0].startswith("point 0: the stretch"), reasons)

    def test_a_step_that_always_fails_goes_back_and_ends(self):
        march = March(max_cuts=3)
        seen = []
        with self.assertRaisesRegex(StepError, "load 0.125: 0 % along, in parts of 1.2e-01 of it too: "
                                               "why") as caught:
            for now in march.to(1.0):
                seen.append(now)
                if now == Action.SOLVE:
                    march.tell(Status.NOT_CONVERGED, reason="why")
        self.assertEqual(caught.exception.status, Status.NOT_CONVERGED)
        self.assertEqual(seen, 4 * [Action.SOLVE, Action.BACK])
        self.assertEqual(march.reached, 0)

    def test_parts_of_a_step_take_the_time_of_the_whole(self):
        march, parts = March(), []
        for now in march.to(0.5, start=0.25):
            if now == Action.SOLVE and not march.cuts:
                march.tell(Status.NOT_CONVERGED)
            elif now == Action.SOLVE:
                march.tell(Status.OK)
            elif now == Action.ACCEPT:
                parts.append((march.load, march.time, march.complete))
        self.assertEqual(parts, [(0.375, 0.5, False), (0.5, 0.5, True)])

    def test_load_at_the_start_is_a_step_that_cannot_be_cut(self):
        march = March()
        with self.assertRaisesRegex(StepError, "load 0: why"):
            for now in march.to(0.0):
                if now == Action.SOLVE:
                    march.tell(Status.NOT_CONVERGED, reason="why")
        for now in march.to(0.0):
            self.assertEqual(march.time, 1)
            if now == Action.SOLVE:
                march.tell(Status.OK)

    def test_ranks_decide_alike(self):
        """One rank that hears of another's residual: what the others' sums would come to."""
        states = grainlaw.States(material(), 0)
        def reduce(values, operation):
            self.assertEqual(memoryview(values).format, "d")   # which mpi4py knows
            return values + [9, 0, 0, 0] if len(values) == 4 else values

        states.share(0, reduce)
        march = March(states)
        march.begin(1)
        self.assertEqual(march.next(), Action.SOLVE)
        march.tell(Status.OK, 0.0, 3.0)
        self.assertEqual(march.next(), Action.SOLVE)
        self.assertEqual(march.residuals, [1.0])

    def test_options_are_those_of_the_header(self):
        march = March(patience=1, max_iterations=5)
        actions = []
        for now in march.to(1.0):
            actions.append(now)
            if now == Action.BACK:
                break
            march.tell(Status.OK, 1.0)
        self.assertEqual(actions, [Action.SOLVE, Action.SOLVE, Action.BACK])
        self.assertRaisesRegex(TypeError, "cuts is no option .* expected one of tolerance, max_it",
                               March, cuts=3)
        for wrong in ({"tolerance": 0}, {"patience": 0}, {"max_cuts": 2000}, {"max_cuts": 1.5},
                      {"tolerance": "x"}, {"step_time": -1}):
            self.assertRaises(ValueError, March, **wrong)
        self.assertRaisesRegex(ValueError, "load .*: expected a finite number", March().begin, "1")

    def test_loads_are_a_number_of_steps_or_ascend(self):
        self.assertEqual(load_steps(4), [0.25, 0.5, 0.75, 1.0])
        self.assertEqual(load_steps(np.int64(2)), [0.5, 1])
        self.assertEqual(load_steps(np.linspace(0, 1, 3)), [0, 0.5, 1])
        for loads in (0, [], [0.5, 0.5], [0.5, 0.2], [-1, 1], [1, 2], [float("nan")]):
            self.assertRaises(ValueError, load_steps, loads)
        for loads in ("12", "x", 1.5, None, 10**8, 2**70):
            self.assertRaisesRegex(ValueError, "number of load steps .* from 1 to", load_steps, loads)
        for loads in ([0, "1"], [None], [0.5, 1j]):
            self.assertRaisesRegex(ValueError, "load .*: expected a finite number", load_steps, loads)


if __name__ == "__main__":
    unittest.main()
