"""A stand-in for preCICE's Micro Manager plays its order of calls: windows repeated, simulations moved to
another process and activated."""
import os
import pickle
import sys
import unittest

import numpy as np

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
os.environ["GRAINLAW_MATERIAL"] = os.path.join(os.environ["GRAINLAW_TEST_DATA"], "rve400.toml")

import grainlaw
from grainlaw_micro import MicroSimulation

ONE = np.eye(2)
WINDOWS = [ONE + size * np.array([[0.3, 0.4], [-0.1, -1.0]]) for size in (5e-4, 1.2e-3, 2e-3)]


def macro(F):
    return {f"F{i + 1}": row for i, row in enumerate(F)}


class Manager:
    """Windows of an implicit coupling: a checkpoint, iterations from it, and the next window."""

    def __init__(self, count, kind=MicroSimulation):
        self.simulations = [kind(k) for k in range(count)]
        self.initial = [one.initialize() for one in self.simulations]

    def window(self, F, dt=1.0, iterations=(0.4, 1.3, 1.0), between=None):
        checkpoint = [one.get_state() for one in self.simulations]
        if between:
            between(self.simulations)
        for iteration, size in enumerate(iterations):
            if iteration:
                for one, state in zip(self.simulations, checkpoint):
                    one.set_state(state)
            tried = ONE + size * (F - ONE)
            data = [one.solve(macro(tried), dt) for one in self.simulations]
        return data


def reference(kind=MicroSimulation, dt=1.0):
    """What a host finds that says commit."""
    state = grainlaw.State(kind.material)
    state.set_time_step(dt)
    for F in WINDOWS:
        answer = state.evaluate(F, grainlaw.Tangent.EXACT)
        yield answer
        state.commit()


class Drag(MicroSimulation):
    with open(os.environ["GRAINLAW_MATERIAL"], encoding="utf-8") as file:
        material = grainlaw.Material.parse(
            file.read() + "[solver]\nviscous_number = 1e-3\nviscous_rate = 1e-3\n",
            os.environ["GRAINLAW_TEST_DATA"])


class Windows(unittest.TestCase):
    def assert_answer(self, data, answer):
        for i in range(2):
            self.assertEqual(data[f"P{i + 1}"].tobytes(), answer.P[i].tobytes())
            for J in range(2):
                for k in range(2):
                    self.assertEqual(data[f"A{i + 1}{J + 1}{k + 1}"].tobytes(),
                                     answer.A[i, J, k].tobytes())

    def test_repeated_ones_end_in_the_bits_of_a_host_that_says_commit(self):
        for kind, dt in ((MicroSimulation, 1.0), (Drag, 0.5)):
            manager = Manager(2, kind)
            for F, answer in zip(WINDOWS, reference(kind, dt)):
                for data in manager.window(F, dt):
                    self.assert_answer(data, answer)

    def test_simulations_are_moved_between_processes(self):
        manager = Manager(2)

        def move(simulations):
            sent = pickle.dumps(simulations[0].get_state())
            other = MicroSimulation(7)
            other.set_state(pickle.loads(sent))
            other.set_global_id(simulations[0].get_global_id())
            simulations[0] = other

        for F, answer in zip(WINDOWS, reference()):
            for data in manager.window(F, between=move):
                self.assert_answer(data, answer)
        self.assertEqual([one.get_global_id() for one in manager.simulations], [0, 1])

    def test_one_that_was_inactive_goes_on_from_an_active_one(self):
        manager = Manager(1)
        manager.window(WINDOWS[0])

        def activate(simulations):
            if len(simulations) == 1:
                simulations.append(MicroSimulation(1))
                simulations[1].set_state(simulations[0].get_state())

        answers = list(reference())
        manager.window(WINDOWS[1], iterations=(1.0,), between=activate)
        for data in manager.window(WINDOWS[2]):
            self.assert_answer(data, answers[2])
        self.assertEqual(len(manager.simulations), 2)

    def test_the_start_is_answered_without_an_increment(self):
        manager = Manager(1, Drag)
        self.assertAlmostEqual(manager.initial[0]["P1"][0] / -1e5, 1, places=3)
        self.assertEqual(sorted(manager.initial[0]), sorted(
            ["P1", "P2", "void_ratio"] + [f"A{i}{J}{k}" for i in "12" for J in "12" for k in "12"]))

    def test_a_window_that_is_too_long_is_told_and_leaves_the_start(self):
        manager = Manager(1)
        one = manager.simulations[0]
        before = one.get_state()
        with self.assertRaisesRegex(RuntimeError, "micro simulation 0: .*0.1 times this one"):
            one.solve(macro(1.5 * ONE), 1.0)
        self.assertEqual(one.get_state(), before)
        with self.assertRaisesRegex(ValueError, "micro simulation 0: found F1, expected F1, F2 in read_data_names"):
            one.solve({"F1": ONE[0]}, 1.0)
        with self.assertRaises(grainlaw.Error):
            one.set_state({"bytes": before["bytes"][:-1]})
        self.assertEqual(one.get_state(), before)


if __name__ == "__main__":
    unittest.main()
