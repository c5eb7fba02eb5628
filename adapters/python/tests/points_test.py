"""Points in numpy: evaluation, commit and revert, saving, measures, output."""
import ctypes
import os
import pickle
import tempfile
import unittest

import numpy as np

import grainlaw
from grainlaw import Measure, Status, Tangent
from grainlaw.abi import library
from support import DATA, MATERIAL, Case, material

COMPRESSED = np.array([[1.0003, 0.0002], [-0.0001, 0.9990]])


class Points(Case):
    def test_a_batch_gives_the_bits_of_single_points_for_any_number_of_threads(self):
        rng = np.random.default_rng(1)
        F = np.eye(2) + 1e-3 * rng.uniform(-1, 1, (5, 2, 2))
        singles = [grainlaw.State(material()).evaluate(row, Tangent.EXACT) for row in F]
        for threads in (1, 2, 0):
            batch = grainlaw.States(material(), 5).evaluate(F, Tangent.EXACT, threads)
            self.assertTrue(batch.ok)
            self.assertEqual(batch.P.tobytes(), np.array([s.P for s in singles]).tobytes())
            self.assertEqual(batch.A.tobytes(), np.array([s.A for s in singles]).tobytes())

    def test_tangent_is_the_derivative_of_the_stress(self):
        state = grainlaw.State(material())
        A = state.evaluate(COMPRESSED, Tangent.EXACT).A
        step = 1e-7
        for k in range(2):
            for L in range(2):
                E = np.zeros((2, 2))
                E[k, L] = step
                change = state.evaluate(COMPRESSED + E).P - state.evaluate(COMPRESSED - E).P
                difference = change / (2 * step) - A[:, :, k, L]
                self.assertLess(np.linalg.norm(difference), 1e-3 * np.linalg.norm(A))

    def test_with_drag_the_stress_depends_on_the_time_that_an_increment_takes(self):
        drag = "[solver]\nviscous_number = 1e-3\nviscous_rate = 1e-3\n"
        with open(MATERIAL, encoding="utf-8") as file:
            states = grainlaw.States(grainlaw.Material.parse(file.read() + drag, DATA), 2)
        stresses = []
        for step in (1, 1, 0.5):
            states.set_time_step(step)
            stresses.append(states.evaluate([COMPRESSED] * 2).P)
        self.assertEqual(stresses[0].tobytes(), stresses[1].tobytes())
        difference = np.linalg.norm(stresses[2] - stresses[0])
        self.assertGreater(difference, 1e-6 * np.linalg.norm(stresses[0]))

    def test_a_law_in_time_asks_for_it_before_it_deforms(self):
        drag = "[solver]\nviscous_number = 1e-3\nviscous_rate = 1e-3\n"
        with open(MATERIAL, encoding="utf-8") as file:
            states = grainlaw.States(grainlaw.Material.parse(file.read() + drag, DATA), 2)
        self.assertTrue(states.evaluate([np.eye(2)] * 2, Tangent.EXACT).ok)
        for told in (False, True):
            if told:
                states.set_time_step(0)
            self.assert_refused(Status.BAD_ARGUMENT, ["viscous_rate", "time step"],
                                states.evaluate, [COMPRESSED] * 2)
        states.set_time_step(0.5)
        self.assertTrue(states.evaluate([COMPRESSED] * 2).ok)

    def test_without_a_tangent_there_is_none(self):
        answer = grainlaw.State(material()).evaluate(COMPRESSED)
        self.assertIsNone(answer.A)
        self.assertEqual(answer.P.shape, (2, 2))

    def test_reports_are_columns_by_name(self):
        answer = grainlaw.States(material(), 2).evaluate([COMPRESSED] * 2, Tangent.EXACT)
        self.assertTrue(np.all(answer.reports["contacts"] > 700))
        self.assertTrue(np.all(answer.reports["tangent_exact"] == 1))
        self.assertTrue(np.all(answer.reports["residual"] < 1e-6))
        self.assertEqual(answer.step_ratio, 1.0)
        self.assertEqual(answer.message, "")

    def test_recoverable_failure_is_an_answer_that_names_the_point(self):
        states = grainlaw.States(material(), 3)
        before = states.save()
        F = np.array([np.eye(2), np.eye(2), 1.5 * np.eye(2)])
        answer = states.evaluate(F, Tangent.EXACT)
        self.assertFalse(answer.ok)
        self.assertEqual(list(answer.status), [Status.OK, Status.OK, Status.STEP_TOO_LARGE])
        self.assertTrue(answer.message.startswith("point 2: the stretch since"))
        self.assertEqual(answer.step_ratio, 0.1)
        self.assertTrue(np.isnan(answer.P[2]).all() and np.isfinite(answer.P[:2]).all())
        self.assert_refused(Status.NO_TRIAL, [], states.commit)
        states.revert()
        self.assertEqual(states.save(), before)

    def test_revert_restores_and_commit_moves_on(self):
        states = grainlaw.States(material(), 2)
        before = states.save()
        first = states.evaluate([COMPRESSED] * 2).P
        states.revert()
        self.assertEqual(states.save(), before)
        self.assertEqual(states.evaluate([COMPRESSED] * 2).P.tobytes(), first.tobytes())
        states.commit()
        self.assertNotEqual(states.save(), before)

    def test_saved_states_continue_with_the_same_bits(self):
        states = grainlaw.States(material(), 2)
        states.evaluate([COMPRESSED] * 2)
        states.commit()
        other = grainlaw.States(material(), 2)
        other.load(states.save())
        further = [2 * COMPRESSED - np.eye(2)] * 2
        self.assertEqual(states.evaluate(further).P.tobytes(), other.evaluate(further).P.tobytes())

    def test_a_saved_state_is_read_by_c_and_what_c_saves_is_loaded(self):
        state = grainlaw.State(material())
        state.evaluate(COMPRESSED)
        state.commit()
        saved = state.save()
        c_state = ctypes.c_void_p()
        library.grainlaw_state_create(material()._handle, ctypes.byref(c_state))
        try:
            self.assertEqual(library.grainlaw_state_load(c_state, saved, ctypes.c_size_t(len(saved))), 0)
            size = ctypes.c_size_t(len(saved))
            of_c = ctypes.create_string_buffer(len(saved))
            self.assertEqual(library.grainlaw_state_save(c_state, of_c, ctypes.byref(size)), 0)
        finally:
            library.grainlaw_state_destroy(c_state)
        self.assertEqual(of_c.raw, saved)
        other = grainlaw.State(material())
        other.load(of_c.raw)
        self.assertEqual(other.save(), saved)
        alone = grainlaw.States(material(), 1)
        alone.load(saved)
        other.load(alone.save())   # of a set, as State.save() was once
        self.assertEqual(other.save(), saved)

    def test_none_are_a_set_too(self):
        states = grainlaw.States(material(), 0)
        answer = states.evaluate(np.empty((0, 2, 2)), Tangent.EXACT)
        self.assertTrue(answer.ok)
        self.assertEqual((answer.P.shape, answer.A.shape), ((0, 2, 2), (0, 2, 2, 2, 2)))
        states.commit()
        states.revert()
        self.assertEqual(states.measure(Measure.FABRIC).shape, (0, 2, 2))
        self.assertEqual(states.measure(Measure.VOID_RATIO).shape, (0,))
        states.load(states.save())
        self.assertEqual(len(pickle.loads(pickle.dumps(states))), 0)
        self.assertEqual(len(states.clone()), 0)

    def test_clone_is_independent(self):
        state = grainlaw.State(material())
        state.evaluate(COMPRESSED)
        copy = state.clone()
        state.commit()
        self.assertNotEqual(copy.save(), state.save())
        copy.commit()  # its trial came along
        self.assertEqual(copy.save(), state.save())

    def test_every_measure_has_the_shape_the_header_gives(self):
        states = grainlaw.States(material(), 3)
        states.evaluate([COMPRESSED] * 3)
        for measure in Measure:
            self.assertEqual(states.measure(measure).shape[0], 3)
        self.assertTrue((states.measure(Measure.DEFORMATION_GRADIENT) == COMPRESSED).all())
        self.assertEqual(states.measure(Measure.PARTICLES).tolist(), [400] * 3)
        F = COMPRESSED
        cauchy = states.evaluate([F] * 3).P[0] @ F.T / np.linalg.det(F)
        self.assertTrue(np.allclose(states.measure(Measure.CAUCHY_STRESS)[0], cauchy, rtol=1e-12))

    def test_files_are_written_and_read_back(self):
        state = grainlaw.State(material())
        with tempfile.TemporaryDirectory() as directory:
            state.write_vtk(os.path.join(directory, "start.vtp"))
            with open(os.path.join(directory, "start.vtp"), encoding="utf-8") as file:
                self.assertIn("PolyData", file.read())
            state.write_packing(os.path.join(directory, "start"))
            self.assertTrue(os.path.getsize(os.path.join(directory, "start_particles.csv")))

    def test_states_outlive_their_material(self):
        states = grainlaw.States(grainlaw.Material(os.environ["GRAINLAW_TEST_DATA"]
                                                   + "/rve400.toml"), 1)
        self.assertTrue(states.evaluate([COMPRESSED]).ok)

    def test_material_from_text(self):
        with open(os.path.join(os.environ["GRAINLAW_TEST_DATA"], "rve400.toml"),
                  encoding="utf-8") as file:
            parsed = grainlaw.Material.parse(file.read(), os.environ["GRAINLAW_TEST_DATA"])
        ours = grainlaw.State(parsed).evaluate(COMPRESSED).P
        self.assertEqual(ours.tobytes(),
                         grainlaw.State(material()).evaluate(COMPRESSED).P.tobytes())


if __name__ == "__main__":
    unittest.main()
