"""Points by number, ranks that agree, tables by element, materials as bytes."""
import os
import pickle
import shutil
import tempfile
import threading
import unittest

import numpy as np

import grainlaw
from grainlaw import Measure, Status, Tangent
from support import DATA, MATERIAL, Case, material

ONE = np.eye(2)
COMPRESSED = np.array([[1.0003, 0.0002], [-0.0001, 0.9990]])
FURTHER = 2 * COMPRESSED - ONE


def targets(n):
    return COMPRESSED + 1e-5 * np.arange(n)[:, None, None]


class SomePoints(Case):
    def setUp(self):
        self.states = grainlaw.States(material(), 4)
        self.first = self.states.evaluate(targets(4), Tangent.EXACT)
        self.states.commit()

    def test_answer_has_the_committed_bits_after_a_load(self):
        other = grainlaw.States(material(), 4)
        other.load(self.states.save())
        answer = other.answer(Tangent.EXACT)
        self.assertEqual(answer.P.tobytes(), self.first.P.tobytes())
        self.assertEqual(answer.A.tobytes(), self.first.A.tobytes())
        self.assertIsNone(other.answer().A)
        self.assertEqual(grainlaw.State(material()).answer(Tangent.EXACT).A.shape, (2, 2, 2, 2))

    def test_bytes_of_some_are_those_of_a_state(self):
        saved = self.states.save_some([3, 1])
        one = grainlaw.State(material())
        one.load(saved[0])
        other = grainlaw.States(material(), 4)
        other.load_some([0, 2], saved)
        copied = grainlaw.States(material(), 4)
        copied.clone_some([0, 2], self.states, [3, 1])
        expected = self.states.evaluate_some([3, 1], [FURTHER] * 2)
        for states in (other, copied):
            self.assertEqual(states.evaluate_some([0, 2], [FURTHER] * 2).P.tobytes(),
                             expected.P.tobytes())
        self.assertEqual(one.evaluate(FURTHER).P.tobytes(), expected.P[0].tobytes())
        self.assertEqual(self.states.save_some([]), [])
        other.load_some([], [])

    def test_points_are_led_to_the_stress_that_they_begin_with(self):
        states = grainlaw.States(material(), 2)
        wanted = np.array([np.diag([-8e4, -1e5]), np.diag([-1e5, -2e5])])
        reached = states.consolidate(wanted)
        self.assertLess(np.abs(reached - wanted).max(), 2e-3)
        self.assertEqual(states.measure(Measure.DEFORMATION_GRADIENT).tolist(), [ONE.tolist()] * 2)
        self.assertLess(np.abs(states.answer().P - wanted).max(), 2e-3)
        one = grainlaw.State(material())
        found = one.consolidate(2 * wanted[0], route="k0", axis=[0, 1], overconsolidation=1.5)
        self.assertAlmostEqual(found[1, 1] / -2e5, 1, 7)
        self.assertLess(abs(found[0, 0]), 2e5)

    def test_stresses_that_points_cannot_have_are_told(self):
        states = grainlaw.States(material(), 3)
        before = states.save()
        good = np.diag([-9e4, -1e5])
        with self.assertRaises(grainlaw.StepError) as steep:
            states.consolidate([good, np.diag([-1e3, -2e5])], [0, 2])
        self.assertEqual(steep.exception.status, Status.NOT_CONVERGED)
        self.assertRegex(str(steep.exception), "^point 2: carries no more than sigma .11 ")
        for sigma, how, text in (([good, ONE], {}, "point 2: the largest principal stress"),
                                 ([good] * 2, {"route": "K0"}, "route 'K0': expected one of"),
                                 ([good], {}, "sigma has the shape"),
                                 ([good] * 2, {"overconsolidation": 0.5}, "expected at least 1")):
            with self.assertRaisesRegex(grainlaw.Error, text):
                states.consolidate(sigma, [0, 2], **how)
        self.assertEqual(states.save(), before)

    def test_failures_are_named_by_the_number_in_the_set(self):
        answer = self.states.evaluate_some([2, 0], [1.5 * ONE, FURTHER])
        self.assertFalse(answer.ok)
        self.assertTrue(answer.message.startswith("point 2: the stretch"))
        self.assertEqual(list(answer.status), [Status.STEP_TOO_LARGE, Status.OK])

    def test_there_may_be_more_and_fewer(self):
        self.states.resize(6)
        self.assertEqual(len(self.states), 6)
        self.assertTrue((self.states.cost() > 0).tolist() == [True] * 4 + [False] * 2)
        self.states.resize(1)
        self.assertEqual(len(self.states.save_some([0])), 1)

    def test_bad_numbers_and_bytes_are_told(self):
        saved = self.states.save_some([0])
        before = self.states.save()
        for which in ([4], [0, 0], [-1], [0.5], 3, [[0]]):
            self.assert_refused(Status.BAD_ARGUMENT, [], self.states.evaluate_some, which,
                                [COMPRESSED] * np.size(which))
        self.assert_refused(Status.BAD_ARGUMENT, ["expected as many"], self.states.load_some, [0, 1],
                            saved)
        self.assert_refused(Status.BAD_BYTES, ["point 1"], self.states.load_some, [1],
                            [saved[0][:-1]])
        self.assert_refused(Status.BAD_ARGUMENT, ["str"], self.states.load_some, [1], ["bytes"])
        self.assert_refused(Status.BAD_ARGUMENT, ["as many"], self.states.clone_some, [1],
                            self.states, [1, 2])
        self.assertEqual(self.states.save(), before)


class Ranks(Case):
    def on_ranks(self, on_rank, ranks=2):
        barrier, values, failures = threading.Barrier(ranks, timeout=60), [None] * ranks, []

        def run(rank):
            def reduce(mine, op):
                values[rank] = mine
                barrier.wait()
                found = np.sum(values, axis=0) if op == "sum" else np.min(values, axis=0)
                barrier.wait()
                return found

            try:
                states = grainlaw.States(material(), 2 - rank)
                states.share(rank, reduce)
                on_rank(rank, states)
            except Exception as error:   # of a thread: told by the test
                failures.append(error)

        threads = [threading.Thread(target=run, args=(rank,)) for rank in range(ranks)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(failures, [])

    def test_agree_on_the_first_failure_and_on_commits(self):
        def on_rank(rank, states):
            F = targets(len(states))
            if rank == 1:
                F[0] = 1.5 * ONE
            answer = states.evaluate(F)
            self.assertFalse(answer.ok)
            self.assertTrue(answer.message.startswith("rank 1, point 0: the stretch"))
            self.assertEqual(answer.step_ratio, 0.1)
            self.assert_refused(Status.NO_TRIAL, [], states.commit)
            self.assertTrue(states.evaluate(targets(len(states))).ok)
            states.commit()
            copy = states.clone()   # is not shared
            self.assertTrue(copy.evaluate(targets(len(states))).ok)
            states.agree()
            self.assert_refused(Status.FILE_ERROR, ["no such file"], states.agree,
                                None if rank else OSError("no such file"))
        self.on_ranks(on_rank)

    def test_what_a_reduction_raises_is_raised_by_the_call(self):
        """Of every call that reduces, once; a commit that could not be agreed is none."""
        class Lost(Exception):
            pass

        calls = []

        def reduce(values, op):
            calls.append(op)
            if lost:
                raise Lost("a rank is gone")
            return values

        lost = False
        states = grainlaw.States(material(), 1)
        states.share(0, reduce)
        self.assertTrue(states.evaluate([COMPRESSED]).ok)
        before = states.save()
        march = grainlaw.March(states)
        march.begin(1)
        lost = True
        march.next()
        for call in (states.commit, states.agree, states.answer,
                     lambda: states.evaluate([COMPRESSED]),
                     lambda: states.evaluate_some([0], [COMPRESSED]),
                     lambda: march.share(0.2), lambda: (march.next(), march.next(),
                                                        march.tell(grainlaw.Status.OK, 0.0, 3.0))):
            calls.clear()
            self.assertRaisesRegex(Lost, "a rank is gone", call)
            self.assertEqual(len(calls), 1)
        lost = False
        self.assertEqual(states.save(), before)
        states.share(0, lambda values, op: "min")
        self.assertRaisesRegex(ValueError, "min", states.commit)
        states.share(0, reduce)
        states.evaluate([COMPRESSED])
        states.commit()
        self.assertNotEqual(states.save(), before)

    def test_a_set_is_alone_again(self):
        states = grainlaw.States(material(), 1)
        states.share(0, lambda values, op: values)
        states.share(0, None)
        self.assertTrue(states.evaluate([COMPRESSED]).ok)
        states.commit()


class Tables(Case):
    def test_tokens_tell_retries_from_accepted_answers(self):
        table, state = grainlaw.Table(material()), grainlaw.State(material())
        token, start = 0.0, ONE
        for F in (COMPRESSED, FURTHER):
            table.evaluate(7, 1, token, 3 * COMPRESSED - 2 * ONE, start)
            answer, next_token = table.evaluate(7, 1, token, F, start, Tangent.EXACT)
            self.assertEqual(answer.P.tobytes(), state.evaluate(F).P.tobytes())
            state.commit()
            token, start = next_token, F
        self.assertEqual((len(table), token), (1, 2.0))
        failed, kept = table.evaluate(7, 1, token, 1.5 * ONE, start)
        self.assertFalse(failed.ok)
        self.assertEqual(kept, token)
        self.assertIn("the stretch", failed.message)
        loaded = grainlaw.Table(material())
        loaded.load(table.save())
        self.assertEqual(loaded.save(), table.save())
        self.assertTrue((loaded.measure(7, 1, Measure.DEFORMATION_GRADIENT).reshape(2, 2)
                         == FURTHER).all())
        loaded.forget(7, 1)
        self.assertEqual(len(loaded), 0)

    def test_a_token_of_no_state_is_told(self):
        table = grainlaw.Table(material())
        self.assert_refused(Status.BAD_ARGUMENT, ["without its states"], table.evaluate, 1, 1, 1.0,
                            COMPRESSED)
        self.assert_refused(Status.NOT_FINITE, ["F11"], table.evaluate, 1, 1, 0.0, np.nan * ONE)
        self.assert_refused(Status.BAD_BYTES, [], table.load, b"no table")


class Materials(Case):
    def test_bytes_make_the_same_material_without_its_files(self):
        with tempfile.TemporaryDirectory() as directory:
            for name in os.listdir(DATA):
                if name.startswith("rve400"):
                    shutil.copy(os.path.join(DATA, name), directory)
            there = grainlaw.Material(os.path.join(directory, "rve400.toml"))
            state = grainlaw.State(there)
            state.evaluate(COMPRESSED)
            state.commit()
            sent = pickle.dumps(state)
        again = pickle.loads(sent)
        self.assertEqual(again.material.fingerprint, material().fingerprint)
        self.assertEqual(again.material.description, grainlaw.Material(MATERIAL).description)
        self.assertEqual(again.evaluate(FURTHER).P.tobytes(), state.evaluate(FURTHER).P.tobytes())
        saved = there.save()
        self.assertEqual(grainlaw.Material.load_saved(saved).save(), saved)
        self.assert_refused(Status.BAD_BYTES, ["damaged"], grainlaw.Material.load_saved, saved[:-1])
        self.assert_refused(Status.BAD_ARGUMENT, ["str"], grainlaw.Material.load_saved, "saved")


if __name__ == "__main__":
    unittest.main()
