"""Messages that are rarely seen: each provoked by its cause, and its cure followed where it has one."""
import unittest

import numpy as np

import grainlaw
from grainlaw import Tangent
from support import Case

TEXT = """dimension = {dimension}
packing = {{ generator = "compaction", count = {count}, radii = [4e-3, 9e-3], seed = 1, pressure = 1e5{friction} }}
contact = {{ law = "frictional", young = 6e8, ratio = 0.8, friction = {contact_friction} }}
solver = {{ {solver} }}
"""


def sand(count=30, dimension=2, friction=", friction = 0.3", contact_friction=0.5, solver=""):
    return grainlaw.Material.parse(TEXT.format(
        count=count, friction=friction, contact_friction=contact_friction, solver=solver,
        dimension="2\nthickness = 0.1" if dimension == 2 else "3"))


def lattice(kind="hexagonal", shape="rows = 4, columns = 4", dimension="2\nthickness = 0.1", young=6e8):
    return grainlaw.Material.parse(
        f'dimension = {dimension}\n'
        f'packing = {{ generator = "{kind}", {shape}, radius = 5e-3, overlap = 5e-6 }}\n'
        f'contact = {{ law = "frictional", young = {young}, ratio = 0.8, friction = 0.5 }}\n')


def message_of(answer):
    return answer.reports["message"].decode()


def shortened(strain):
    return np.diag([1 / (1 - strain), 1 - strain])


class RareMessages(Case):
    def ended_loosely(self, text):
        """The first answer with this text along a path in coarse steps, as (state before it, F)."""
        state = grainlaw.State(sand(solver="loose_tolerance = 5e-2, tolerance = 1e-9"))
        for step in range(1, 21):
            before, F = state.save(), shortened(5e-3 * step)
            answer = state.evaluate(F, Tangent.EXACT)
            if answer.ok and text in message_of(answer):
                self.assertEqual(answer.reports["tangent_exact"], 0)
                self.assertGreater(answer.reports["residual"], 1e-9)
                self.assertLessEqual(answer.reports["residual"], 5e-2)
                self.assertTrue(np.isfinite(answer.A).all())
                return before, F
            state.commit() if answer.ok else state.revert()
        self.fail(f"no answer says: {text}")

    def test_of_a_loose_end_with_the_tangent_of_its_contacts(self):
        self.ended_loosely("ended at solver.loose_tolerance; the tangent is of the contacts there")

    def test_of_a_loose_end_with_the_elastic_tangent(self):
        self.ended_loosely("ended at solver.loose_tolerance; the elastic tangent was returned")

    def test_of_a_sphere_that_rests_against_one_that_nothing_holds(self):
        state = grainlaw.State(sand(count=30, dimension=3))
        for step in range(1, 21):
            strain = 1e-3 * step
            answer = state.evaluate(np.diag([1 + 0.4 * strain, 1 + 0.4 * strain, 1 - strain]), Tangent.EXACT)
            self.assertTrue(answer.ok)
            if "a sphere of two contacts rests against one that nothing holds" in message_of(answer):
                self.assertEqual(answer.reports["tangent_exact"], 0)
                return
            state.commit()
        self.fail("every sphere is held")

    def test_of_differences_that_ask_for_too_much(self):
        """At the edge of losing its contacts a packing has an answer at F and none beside it."""
        state = grainlaw.State(sand(count=20, friction="", contact_friction=0.01))
        F, stretch = np.eye(2), 3e-4
        while stretch > 1e-12:
            answer = state.evaluate(F * (1 + stretch), Tangent.PERTURBED)
            if answer.ok:
                state.commit()
                F = F * (1 + stretch)
                continue
            if message_of(answer) == "a perturbed increment found no equilibrium":
                state.revert()
                self.assertTrue(state.evaluate(F * (1 + stretch), Tangent.EXACT).ok)
                return
            state.revert()
            stretch *= 0.5
        self.fail("differences never asked for too much")

    def test_of_discs_that_slide_on_all_contacts(self):
        """Rows have parted, and nothing resists a rotation of a disc: the stiffness is singular."""
        state = grainlaw.State(lattice())
        for step in (1, 2):
            F = np.diag([1 + 4e-4 * step, 1 - 1e-3 * step])
            answer = state.evaluate(F, Tangent.EXACT)
            state.commit()
        self.assertEqual(message_of(answer), "the stiffness is singular; the elastic tangent was returned")
        self.assertEqual(answer.reports["tangent_exact"], 0)
        self.assertTrue(np.isfinite(answer.A).all())
        steepness = np.arctan2(np.sqrt(3) * F[1, 1], F[0, 0]) + np.arctan(0.5)  # of contact forces
        self.assertAlmostEqual(answer.P[0, 0] / answer.P[1, 1], 1 / np.tan(steepness) / np.sqrt(3), delta=1e-9)
        led = grainlaw.laboratory.path(state, 10, F22=1 - 4e-3, sigma11=-6e3)
        self.assertEqual(led.loose_parts, 0)
        self.assertAlmostEqual(led.sigma[-1, 0, 0] / -6e3, 1, delta=1e-6)

    def test_of_numbers_that_overflow(self):
        """A stiffness whose square is no number any more, and the one that was meant."""
        F = np.diag([1, 1, 1 - 1e-3])
        for young, told in ((6e200, "numbers too large: the stress, the tangent or the state overflows"), (6e8, "")):
            answer = grainlaw.State(lattice("fcc", "cells = [1, 1, 1]", "3", young)).evaluate(F, Tangent.EXACT)
            self.assertEqual((answer.ok, message_of(answer)), (not told, told))

    def test_of_a_packing_that_flows(self):
        """On the way to an initial stress that it does not carry: less is carried."""
        states = grainlaw.States(sand(count=60), 1)
        asked = np.array([[[-1e5, 0.0], [0.0, -1e6]]])
        with self.assertRaises(grainlaw.StepError) as caught:
            states.consolidate(asked)
        told = str(caught.exception)
        self.assertRegex(told, "the packing (flows|yields)")
        carried = float(told.split("22 ")[1].split(",")[0])
        states.consolidate(np.array([[[-1e5, 0.0], [0.0, 0.8 * carried]]]))


if __name__ == "__main__":
    unittest.main()
