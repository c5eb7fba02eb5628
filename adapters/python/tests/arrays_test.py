"""Particles and contacts as structured arrays; states that are pickled and copied."""
import copy
import multiprocessing
import os
import pickle
import unittest

import numpy as np

import grainlaw
from grainlaw import Measure, Status
from support import DATA, MATERIAL, Case, material

COMPRESSED = np.diag([1.0003, 0.9990])
SPHERES = os.path.join(DATA, "spheres500.toml")


def compressed(state):
    """The state, led on by a step: what a worker does."""
    answer = state.evaluate(np.diag([1.0, 0.998]))
    state.commit()
    return state, answer.P


class Arrays(Case):
    def test_contact_forces_make_the_stress(self):
        for path in (MATERIAL, SPHERES):
            state = grainlaw.State(material(path))
            F = np.eye(state.dimension)
            F[-1, -1] = 0.9995
            self.assertTrue(state.evaluate(F).ok)
            c = state.contacts()
            force = c["normal_force"][:, None] * c["normal"] + c["tangential_force"]
            sigma = -np.einsum("c,ci,cj->ij", c["weight"], force, c["branch"])
            sigma /= state.measure(Measure.VOLUME)
            cauchy = state.measure(Measure.CAUCHY_STRESS)
            self.assertLess(np.linalg.norm(sigma - cauchy), 1e-12 * np.linalg.norm(cauchy))

    def test_shapes_are_those_of_the_dimension(self):
        for path, d in ((MATERIAL, 2), (SPHERES, 3)):
            state = grainlaw.State(material(path))
            particles, contacts = state.particles(), state.contacts()
            n, m = len(particles), len(contacts)
            self.assertEqual(particles["position"].shape, (n, d))
            self.assertEqual(particles["rotation"].shape, (n,) if d == 2 else (n, 3))
            self.assertEqual(contacts["branch"].shape, (m, d))
            self.assertEqual(contacts["moment"].shape, (m,) if d == 2 else (m, 3))
            self.assertEqual(contacts["sliding"].dtype, bool)
            self.assertEqual(particles["contacts"].sum(), 2 * m)

    def test_discs_turn_anticlockwise(self):
        state = grainlaw.State(material())
        self.assertTrue(state.evaluate([[1.0, 0.0005], [0, 0.999]]).ok)
        mean = state.particles()["rotation"].mean()
        self.assertNotEqual(mean, 0)
        self.assertAlmostEqual(mean, state.measure(Measure.MEAN_ROTATION), places=14)

    def test_sliding_contacts_are_those_of_the_report(self):
        state = grainlaw.State(material())
        answer = state.evaluate([[1.0, 0.0005], [0, 0.999]])
        self.assertEqual(state.contacts()["sliding"].sum(), answer.reports["sliding"])

    def test_each_point_of_a_set_has_its_own(self):
        states = grainlaw.States(material(), 2)
        self.assertTrue(states.evaluate([np.eye(2), COMPRESSED]).ok)
        still, moved = (states.particles(point)["position"] for point in (0, 1))
        self.assertGreater(abs(still - moved).max(), 1e-5)
        self.assert_refused(Status.BAD_ARGUMENT, ["point 2"], states.particles, 2)
        self.assert_refused(Status.BAD_ARGUMENT, ["point -1"], states.contacts, -1)


class Pickled(Case):
    def test_states_go_on_with_the_same_bits(self):
        states = grainlaw.States(material(), 2)
        states.evaluate([COMPRESSED] * 2)
        states.commit()
        other = pickle.loads(pickle.dumps(states))
        self.assertEqual(other.save(), states.save())
        F = [2 * COMPRESSED - np.eye(2)] * 2
        self.assertEqual(other.evaluate(F).P.tobytes(), states.evaluate(F).P.tobytes())

    def test_a_material_is_read_again_once(self):
        first, second = pickle.loads(pickle.dumps([grainlaw.State(material()) for _ in range(2)]))
        self.assertIs(first.material, second.material)
        again = pickle.loads(pickle.dumps(grainlaw.Material.parse(material().text, DATA)))
        self.assertEqual(again.dimension, 2)

    def test_a_copy_is_a_clone_with_its_trial(self):
        state = grainlaw.State(material())
        state.evaluate(COMPRESSED)
        for other in (copy.copy(state), copy.deepcopy(state)):
            self.assertIs(other.material, state.material)
            other.commit()
            self.assertNotEqual(other.save(), state.save())

    def test_a_packing_that_is_gone_is_not_needed(self):
        saved = pickle.dumps(grainlaw.State(material())).replace(DATA.encode(), b"/" * len(DATA))
        again = pickle.loads(saved)
        self.assertEqual(again.save(), grainlaw.State(material()).save())

    def test_errors_too(self):
        error = pickle.loads(pickle.dumps(grainlaw.Error(Status.NOT_FINITE, "F12 is nan", 3)))
        self.assertEqual((error.status, error.message, error.point),
                         (Status.NOT_FINITE, "F12 is nan", 3))

    def test_workers_lead_states_and_send_them_back(self):
        states = [grainlaw.State(material()) for _ in range(3)]
        expected = compressed(states[0].clone())
        for method in ("fork", "spawn"):
            with multiprocessing.get_context(method).Pool(2) as pool:
                for state, P in pool.map(compressed, states):
                    self.assertEqual(P.tobytes(), expected[1].tobytes())
                    self.assertEqual(state.save(), expected[0].save())


if __name__ == "__main__":
    unittest.main()
