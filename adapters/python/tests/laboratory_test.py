"""Tests of a laboratory: they hold what they say, go where `grainlaw point` goes, and end where they are told."""
import contextlib
import csv
import functools
import importlib
import io
import itertools
import os
import pickle
import re
import signal
import subprocess
import tempfile
import threading
import unittest
import warnings
from unittest import mock

import numpy as np

import grainlaw
from grainlaw import Measure, Status, plots
from grainlaw import laboratory as tests
from grainlaw.laboratory import Ensemble, Loops, Stop
from grainlaw.lead import Options
from grainlaw.progress import duration
from support import DATA, MATERIAL, Case, material

SPHERES = os.path.join(DATA, "spheres500.toml")
PROGRAM = os.environ.get("GRAINLAW_PROGRAM")

# The call, and the same as a segment of a scene.
SAME = [
    (lambda m: tests.isotropic(m, 150e3, 5), 'test = "isotropic"\npressure = 150e3\nsteps = 5'),
    (lambda m: tests.k0(m, 150e3, 5), 'test = "k0"\naxial_stress = 150e3\nsteps = 5'),
    (lambda m: tests.oedometric(m, 0.003), 'test = "oedometric"\nstrain = 0.003'),
    (lambda m: tests.drained(m, 0.004), 'test = "drained"\nstrain = 0.004'),
    (lambda m: tests.undrained(m, 0.004), 'test = "undrained"\nstrain = 0.004'),
    (lambda m: tests.constant_p(m, 0.004), 'test = "constant_p"\nstrain = 0.004'),
    (lambda m: tests.shear_constant_volume(m, 0.004),
     'test = "shear_constant_volume"\nstrain = 0.004'),
    (lambda m: tests.shear_constant_stress(m, 0.004),
     'test = "shear_constant_stress"\nstrain = 0.004'),
    (lambda m: tests.undrained(m, 0.05, loops=Loops(2, q=30e3)),
     'test = "undrained"\nstrain = 0.05\ncycles = 2\namplitude = { q = 30e3 }'),
    (lambda m: tests.drained(m, -0.05, loops=Loops(1, strain=2e-3)),
     'test = "drained"\nstrain = -0.05\ncycles = 1\namplitude = { strain = 2e-3 }'),
    (lambda m: tests.k0(m, steps=4, loops=1), 'test = "k0"\nsteps = 4\ncycles = 1'),
    (lambda m: tests.drained(m, stop=Stop(ratio=0.4)), 'test = "drained"\nstop = { ratio = 0.4 }'),
    (lambda m: tests.path(m, 4, F22=0.997, dF12=0.002, P11=-110e3),
     "steps = 4\nF22 = 0.997\ndF12 = 0.002\nP11 = -110e3"),
    (lambda m: tests.path(m, 4, F22=0.997, F11="free", mean_pressure=110e3),
     'steps = 4\nF22 = 0.997\nF11 = "free"\nmean_pressure = 110e3'),
    # Of all stresses one is another's: a rotation is free.
    (lambda m: tests.path(m, 3, sigma11=-1e5, sigma22=-1.1e5, sigma12=0.0, sigma21=0.0),
     "steps = 3\nsigma11 = -1e5\nsigma22 = -1.1e5\nsigma12 = 0.0\nsigma21 = 0.0"),
    (lambda m: tests.path(m, 3, sigma11=-1e5, sigma22=-1e5, sigma12=0.0, sigma21=0.0),
     "steps = 3\nsigma11 = -1e5\nsigma22 = -1e5\nsigma12 = 0.0\nsigma21 = 0.0"),
    (lambda m: tests.path(m, 3, sigma12=5e3, sigma21=5e3),
     "steps = 3\nsigma12 = 5e3\nsigma21 = 5e3"),
    (lambda m: tests.path(m, 3, sigma11=-1e5, sigma22=-1.1e5, sigma21=0.0),
     "steps = 3\nsigma11 = -1e5\nsigma22 = -1.1e5\nsigma21 = 0.0"),
    (lambda m: tests.path(m, 3, P11=-1e5, P22=-1.1e5, P12=0.0, P21=0.0),
     "steps = 3\nP11 = -1e5\nP22 = -1.1e5\nP12 = 0.0\nP21 = 0.0"),
]
OF_SPHERES = [
    (lambda m: tests.drained(m, 0.002), 'test = "drained"\nstrain = 0.002'),
    (lambda m: tests.drained(m, -0.002), 'test = "drained"\nstrain = -0.002'),
    (lambda m: tests.undrained(m, 0.002), 'test = "undrained"\nstrain = 0.002'),
    (lambda m: tests.constant_p(m, 0.002), 'test = "constant_p"\nstrain = 0.002'),
    (lambda m: tests.shear_constant_stress(m, 0.002),
     'test = "shear_constant_stress"\nstrain = 0.002'),
    (lambda m: tests.path(m, 2, F33=0.998, sigma11="sigma22", isochoric=True),
     'steps = 2\nF33 = 0.998\nsigma11 = "sigma22"\nisochoric = true'),
]


def by_program(file, segment):
    """Columns of `grainlaw point`."""
    with tempfile.TemporaryDirectory() as directory:
        scene = os.path.join(directory, "scene.toml")
        with open(scene, "w", encoding="utf-8") as out:
            out.write(f'material = "{file}"\nfigure = false\n[[segment]]\n{segment}\n')
        subprocess.run([PROGRAM, "point", scene, "--output", directory], check=True,
                       stdout=subprocess.DEVNULL)
        with open(os.path.join(directory, "scene.csv"), encoding="utf-8") as table:
            rows = list(csv.DictReader(table))
    return {name.split("[")[0]: np.array([float(row[name]) for row in rows]) for name in rows[0]}


class AsInTheProgram(Case):
    def compare(self, path, cases):
        for call, segment in cases:
            with self.subTest(segment=segment):
                ours, theirs = call(material(path)), by_program(path, segment)
                columns = ours.columns()
                self.assertEqual(len(ours), len(theirs["F11"]))
                scale = np.linalg.norm(ours.sigma[0])
                for i in range(1, ours.F.shape[1] + 1):
                    for j in range(1, ours.F.shape[1] + 1):
                        name = f"sigma{i}{j}"
                        self.assertLess(abs(columns[name] - theirs[name]).max(), 1e-10 * scale, name)
                        name = f"F{i}{j}"
                        self.assertLess(abs(columns[name] - theirs[name]).max(), 1e-11, name)
                for name in ("void_ratio", "coordination", "axial_strain", "elastic_energy",
                             "dissipated_energy", "external_work", "sliding"):
                    size = abs(theirs[name]).max()
                    self.assertLess(abs(columns[name] - theirs[name]).max(), 1e-8 * size + 1e-15,
                                    name)
                for name in ("axial_stress", "lateral_stress", "mean_pressure", "deviatoric_stress"):
                    if name in theirs:
                        self.assertLess(abs(columns[name] - theirs[name]).max(), 1e-9 * scale, name)

    @unittest.skipUnless(PROGRAM, "the command grainlaw is not built")
    def test_discs(self):
        self.compare(os.path.join(DATA, "rve400.toml"), SAME)

    @unittest.skipUnless(PROGRAM, "the command grainlaw is not built")
    def test_spheres(self):
        self.compare(SPHERES, OF_SPHERES)


class Elements(Case):
    def test_what_a_test_holds_is_held(self):
        m = material()
        near = 1e-8 * np.linalg.norm(tests.path(m, 1).sigma[0])
        result = tests.drained(m, 0.003)
        self.assertLess(np.ptp(result.lateral_stress), 2 * near)
        self.assertAlmostEqual(result.axial_strain[-1], 0.003)
        self.assertLess(np.ptp(tests.constant_p(m, 0.003).mean_pressure), 2 * near)
        self.assertLess(np.ptp(tests.shear_constant_stress(m, 0.003).axial_stress), 2 * near)
        self.assertEqual(np.ptp(tests.k0(m, steps=3).F[:, 0, 0]), 0)
        isotropic = tests.isotropic(m, 130e3, 3)
        self.assertLess(abs(isotropic.lateral_stress[-1] - 130e3), near)
        self.assertLess(abs(isotropic.axial_stress[-1] - 130e3), near)

    def test_undrained_keeps_the_volume_by_itself(self):
        for path, strain in ((None, 0.02), (SPHERES, 0.003)):
            result = tests.undrained(material(path) if path else material(), strain)
            self.assertLess(abs(result.volumetric_strain).max(), 1e-15)

    def test_work_is_stored_or_dissipated(self):
        result = tests.drained(material(), 0.01, 2e-4)
        stored = result.elastic_energy - result.elastic_energy[0]
        lost = result.dissipated_energy - result.dissipated_energy[0]
        self.assertLess(abs(stored + lost - result.external_work)[-1],
                        0.01 * result.external_work[-1])

    def test_consolidation_comes_before_and_tests_follow_each_other(self):
        at_once = tests.drained(material(), 0.002, consolidation=150e3)
        self.assertAlmostEqual(at_once.mean_pressure[0] / 150e3, 1, places=7)
        self.assertEqual(len(at_once.before), 21)
        state = grainlaw.State(material())
        tests.isotropic(state, 150e3)
        after = tests.drained(state, 0.002)
        self.assertEqual(after.sigma.tobytes(), at_once.sigma.tobytes())
        self.assertEqual(state.save(), at_once.state.save())

    def test_a_stop_ends_and_says_so(self):
        m = material()
        for stop, words in ((Stop(q=30e3), "q 3"), (Stop(strain=0.002), "strain 0.002 reached"),
                            (Stop(ratio=0.3), "q/p 0.3"), (Stop(p=105e3), "mean pressure 1"),
                            (Stop(axial_stress=120e3), "axial stress 12")):
            result = tests.drained(m, step=1e-4, stop=stop)
            self.assertIn(words, result.ended)
            self.assertLess(len(result), 22)
            self.assertFalse(result.liquefied)
        liquefied = tests.oedometric(m, -0.01, 2e-4, stop=Stop(liquefied=0.5))
        self.assertTrue(liquefied.liquefied)
        self.assertIn("liquefied: mean pressure", liquefied.ended)
        self.assertEqual(tests.drained(m, 0.002).ended, "")

    def test_loops_end_where_they_began(self):
        result = tests.shear_constant_volume(material(), loops=Loops(2, strain=2e-3))
        self.assertAlmostEqual(result.shear_strain[-1], 0)
        self.assertEqual(len(result), 1 + 2 + 4 + 4 + 4 + 2)
        for step in (1e-3, 1e-4):   # q turns where it is asked to, on any step
            stressed = tests.drained(material(), step=step, loops=Loops(1, q=20e3))
            q = stressed.deviatoric_stress - stressed.deviatoric_stress[0]
            self.assertLess(abs(q.max() - 20e3), 0.02)
            self.assertLess(abs(q.min() + 20e3), 0.02)
            self.assertLess(abs(q[-1]), 0.02)

    def test_what_cannot_be_meant_is_told(self):
        m = material()
        for call, words in (
                (lambda: tests.drained(m, 0.6), "0.05 for 5 %"),
                (lambda: tests.drained(m, 0.01, -1), "one step"),
                (lambda: tests.drained(m, lateral_stress=-1e5), "compression positive"),
                (lambda: tests.isotropic(m, 0), "pressure above 0"),
                (lambda: tests.k0(m, steps=0), "number of steps"),
                (lambda: Loops(0, q=1), "number of loops"), (lambda: Loops(1), "one of strain"),
                (lambda: Loops(1, strain=1), "below 0.5"), (lambda: Stop(q=-1), "stop.q"),
                (lambda: Stop(liquefied=2), "at most 1"),
                (lambda: tests.path(m, 2, F22=-0.01), "a stretch"),
                (lambda: tests.path(m, 2, sigma11=1e5), "which is tension"),
                (lambda: tests.path(m, 2, F22=0.99, dF22=0.1), "second condition"),
                (lambda: tests.path(m, 2, sigma11="sigma11"), "name of another stress"),
                (lambda: tests.path(m, 2, mean_pressure=1e5), "\"free\""),
                (lambda: tests.path(m, 2, F11=1, F22=1, isochoric=True), "follows det F")):
            with self.assertRaises(ValueError) as caught:
                call()
            self.assertIn(words, str(caught.exception))
        for call in (lambda: tests.path(m, 2, F33=0.9), lambda: tests.path(m, 2, strain=0.1),
                     lambda: tests.drained("sand.toml")):
            self.assertRaises(TypeError, call)
        for call, words in ((lambda: tests.drained(m, stop=3), "Stop(q=100e3) or None, got 3"),
                            (lambda: tests.k0(m, stop="q"), "got 'q'"),
                            (lambda: tests.drained(m, loops=3), "Loops(2, strain=0.005) or None")):
            with self.assertRaisesRegex(TypeError, re.escape(words)):
                call()

    def test_what_is_no_number_is_told_and_leaves_the_state(self):
        state = grainlaw.State(material())
        before = state.save()
        for call, name in (
                (lambda bad: tests.drained(state, bad), "strain"),
                (lambda bad: tests.oedometric(state, 0.01, bad), "step"),
                (lambda bad: tests.drained(state, tolerance=bad), "tolerance"),
                (lambda bad: tests.drained(state, consolidation=[bad]), "consolidation"),
                (lambda bad: tests.drained(state, consolidation=1e5, lateral_stress=bad),
                 "lateral_stress"),
                (lambda bad: tests.shear_constant_stress(state, normal_stress=bad), "normal_stress"),
                (lambda bad: tests.isotropic(state, bad), "pressure"),
                (lambda bad: tests.isotropic(state, steps=bad), "number of steps"),
                (lambda bad: tests.k0(state, bad), "axial_stress"),
                (lambda bad: tests.k0(state, loops=bad), "number of loops"),
                (lambda bad: tests.path(state, bad), "number of steps"),
                (lambda bad: tests.path(state, 2, F11="free", mean_pressure=bad), "mean_pressure"),
                (lambda bad: tests.path(state, 2, F11=[bad]), "F11"),
                (lambda bad: Loops(bad, q=1), "number of loops"),
                (lambda bad: Loops(1, q=bad), "amplitude"),
                (lambda bad: Stop(p=bad), "stop.p")):
            for bad in ("x", [1], 1j, np.nan):
                with self.assertRaisesRegex(ValueError, rf"{name} .*: expected a \w+ number"):
                    call(bad)
        self.assertRaisesRegex(ValueError, "above 0", tests.drained, state, tolerance=0)
        self.assertEqual(state.save(), before)

    def test_more_steps_than_end_are_refused(self):
        m = material()
        for test in (tests.oedometric, tests.drained, tests.undrained, tests.constant_p,
                     tests.shear_constant_volume, tests.shear_constant_stress):
            for strain, step in ((0.01, 1e-12), (-0.01, 9e-10), (0.01, 5e-324)):
                with self.assertRaisesRegex(ValueError, rf"step {step} of strain 0.01: .*, 1e-09"):
                    test(m, strain, step)
        with self.assertRaisesRegex(ValueError, "step 2e-08 of strain 0.4: .*, 4e-08"):
            tests.drained(m, 0.01, 2e-8, loops=Loops(1, strain=0.4))
        for call in (lambda: tests.isotropic(m, steps=10**8), lambda: tests.k0(m, steps=2**70),
                     lambda: tests.path(m, 10**8), lambda: tests.k0(m, loops=10**8),
                     lambda: Loops(10**8, q=1)):
            self.assertRaisesRegex(ValueError, "from [01] to 10000000", call)
        self.assertEqual(len(tests.drained(m, 0.01, 1e-9, stop=Stop(strain=2e-9))), 3)

    def test_one_condition_for_two_components_is_refused(self):
        for path, conditions in (
                (None, {"sigma11": "sigma22", "sigma22": "sigma11"}),
                (None, {"sigma12": "sigma21"}), (None, {"sigma12": -1e3, "sigma21": "sigma12"}),
                (SPHERES, {"sigma11": "sigma22", "sigma22": "sigma33", "sigma33": "sigma11"}),
                (SPHERES, {"sigma13": "sigma12", "sigma31": "sigma21"})):
            with self.assertRaisesRegex(ValueError, "one condition for each F"):
                tests.path(material(path) if path else material(), 1, **conditions)
        result = tests.path(material(SPHERES), 1, sigma11="sigma22", sigma22="sigma33", F33=0.9995)
        self.assertLess(np.ptp(np.diagonal(result.sigma[-1])), 1e-6 * result.mean_pressure[-1])

    def test_a_step_that_fails_keeps_what_was_reached(self):
        once = functools.partial(Options, max_cuts=1)
        with mock.patch("grainlaw.laboratory.Options", once):
            with self.assertRaises(tests.StepFailed) as caught:
                tests.path(material(), 4, F11=1.013, F22=1.013)   # grains part
        result, text = caught.exception.result, str(caught.exception)
        self.assertEqual(caught.exception.status, Status.CONTACTS_LOST)
        self.assertIn("after axial strain -0.0", text)
        self.assertIn("lost its contacts", text)
        F = result.state.measure(Measure.DEFORMATION_GRADIENT)
        self.assertEqual(F.tobytes(), result.F[-1].tobytes())
        self.assertGreater(F[0, 0], 1)

    def test_a_material_that_starts_from_the_last_trial_is_led_as_far_as_it_is_exact(self):
        trial = grainlaw.Material.parse(material().text + '[solver]\nstart = "trial"\n',
                                        material().directory)
        ours, reference = (tests.drained(m, 0.003) for m in (trial, material()))
        difference = np.linalg.norm(ours.sigma[-1] - reference.sigma[-1])
        self.assertLess(difference, 1e-3 * np.linalg.norm(reference.sigma[-1]))

    def test_results_and_failures_travel_between_processes(self):
        result = tests.oedometric(material(), 0.001)
        for thing in (result, tests.Interrupted(result), tests.StepFailed("why", 1, result)):
            again = pickle.loads(pickle.dumps(thing))
            again = again if isinstance(again, tests.Result) else again.result
            self.assertEqual(again.sigma.tobytes(), result.sigma.tobytes())
            self.assertEqual(again.state.save(), result.state.save())

    def test_columns_have_every_component(self):
        columns = tests.oedometric(material(), 0.001).columns()
        self.assertEqual({len(column) for column in columns.values()}, {3})
        for name in ("axial_strain", "sigma12", "fabric22", "void_ratio", "sliding"):
            self.assertIn(name, columns)

    def test_drag_is_a_column_and_told_where_it_carries_part_of_the_load(self):
        self.assertFalse(tests.oedometric(material(), 0.001).unbalanced.any())
        with open(MATERIAL, encoding="utf-8") as file:
            sand = grainlaw.Material.parse(file.read() + "[solver]\nviscous_number = 0.3\n", DATA)
        with self.assertWarnsRegex(UserWarning, "drag carries part of the load") as told:
            result = tests.drained(sand, 0.02, step=2e-3)
        much = (result.unbalanced > 0.1).sum()
        self.assertGreater(much, 0)
        self.assertIn(f"above 0.1 in {much} steps", str(told.warning))
        self.assertEqual(told.filename, __file__)
        self.assertEqual(len(result.columns()["unbalanced"]), len(result))

    def test_q_is_below_0_in_extension(self):
        for path in (None, SPHERES):
            result = tests.drained(material(path) if path else material(), -0.002)
            q = result.deviatoric_stress
            self.assertLess(q[-1], q[0] - 1e3)
            self.assertEqual(q.tobytes(), (result.axial_stress - result.lateral_stress).tobytes())

    def test_all_stresses_are_reached_with_a_rotation_left_free(self):
        result = tests.path(material(), 3, sigma11=-1e5, sigma22=-1.2e5, sigma12=0.0, sigma21=0.0)
        self.assertLess(abs(result.sigma[-1] - np.diag([-1e5, -1.2e5])).max(), 1e-7 * 1.2e5)

    def test_the_old_name_works(self):
        self.assertIs(grainlaw.tests.drained, tests.drained)
        self.assertIs(importlib.import_module("grainlaw.tests").Result, tests.Result)

    def test_tangents_are_those_of_the_rows(self):
        for call in (lambda **how: tests.oedometric(material(), 0.002, **how),
                     lambda **how: tests.drained(material(), 0.002, **how)):
            result, without = call(tangents=True), call()
            self.assertEqual(result.sigma.tobytes(), without.sigma.tobytes())
            self.assertEqual(result.A.shape, (len(result), 2, 2, 2, 2))
            self.assertIn("A1122", result.columns())
            self.assertRaises(AttributeError, lambda result=without: result.A)
            again = grainlaw.State(material())
            for F, A in zip(result.F, result.A):
                found = again.evaluate(F, grainlaw.Tangent.EXACT).A
                again.commit()
                if (F != np.eye(2)).any():
                    self.assertLess(np.linalg.norm(A - found), 1e-9 * np.linalg.norm(A))

    def test_progress_tells_how_far_and_why_steps_are_cut(self):
        told = []
        tests.drained(material(), 0.004, progress=lambda *one: told.append(one))
        self.assertEqual([fraction for fraction, _ in told], [0.25, 0.5, 0.75, 1])
        self.assertRegex(told[-1][1], r"^sigma22 -1\d\d\.\d kPa, F22 0\.9960, F12 ")
        told.clear()
        tests.path(material(), 1, F22=0.65, stop=Stop(strain=0.01),
                   progress=lambda *one: told.append(one))
        self.assertRegex(told[0][1], r"^step 1 in parts of \d\.\de-0\d of it: .*stretch")
        told.clear()
        tests.shear_constant_volume(material(), loops=Loops(2, strain=2e-3),
                                    progress=lambda *one: told.append(one))
        self.assertEqual(told[-1][0], 1)
        tests.isotropic(material(), 11e4, 2, loops=1, progress=lambda *one: told.append(one))
        self.assertEqual([fraction for fraction, _ in told[-4:]], [0.25, 0.5, 0.75, 1])

    def test_progress_on_stderr_tells_the_time_left(self):
        with mock.patch("sys.stderr", io.StringIO()) as stderr, \
                mock.patch("time.monotonic", itertools.count(0, 20).__next__):
            tests.drained(material(), 0.003, progress=True)
        lines = stderr.getvalue().splitlines()
        self.assertEqual(len(lines), 3)
        self.assertRegex(lines[1], r"^drained:  67 %, 40 s, 20 s left, sigma22 -")
        self.assertEqual([duration(s) for s in (99.4, 725, 12000)], ["99 s", "12 min 05 s", "3 h 20 min"])

    def test_a_stress_in_another_unit_is_asked_about(self):
        m = material()
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            for call, words in (
                    (lambda: tests.isotropic(m, 100), r"direction 1 of -100 Pa .* under 1.*e\+05 Pa: is it"),
                    (lambda: tests.drained(m, lateral_stress=1e8), "direction 1 of -1e"),
                    (lambda: tests.path(m, 1, sigma22=-100), "direction 2 of -100"),
                    (lambda: tests.drained(m, consolidation=200), "of -200 Pa"),
                    (lambda: tests.drained(m, stop=Stop(q=30)), "stop.q of 30 Pa"),
                    (lambda: tests.drained(m, loops=Loops(1, q=30)), "loops.q of 30 Pa")):
                self.assertRaisesRegex(UserWarning, words, call)
            tests.drained(m, 0.001, consolidation=150e3)
            tests.constant_p(material(SPHERES), 0.001)
        with self.assertWarns(UserWarning) as caught:
            tests.drained(m, 1e-3, stop=Stop(q=30))
        self.assertEqual(caught.filename, __file__)

    def test_an_ensemble_is_the_mean_of_its_results_and_how_far_they_spread(self):
        results = [tests.drained(material(), strain) for strain in (0.002, 0.003)]
        results.append(tests.drained(material(), 0.003, lateral_stress=120e3))
        ensemble = Ensemble(iter(results))
        self.assertEqual(ensemble.runs.tolist(), [3, 3, 3, 2])
        for row in (2, 3):
            draws = [one.axial_stress[row] for one in results if len(one) > row]
            self.assertAlmostEqual(ensemble.mean["axial_stress"][row] / np.mean(draws), 1)
            self.assertAlmostEqual(ensemble.deviation["axial_stress"][row] / np.std(draws, ddof=1), 1)
        table = ensemble.columns()
        self.assertEqual({len(column) for column in table.values()}, {4})
        self.assertIn("sd_sigma12", table)
        for bad in ([], results[:1], [results[0], tests.drained(material(SPHERES), 0.001)]):
            self.assertRaisesRegex(ValueError, "expected two or more", Ensemble, bad)
        for bad in (results[0], [material(), material()]):
            self.assertRaisesRegex(TypeError, "expected (several )?results of a test", Ensemble, bad)

    def test_an_unknown_column_is_told(self):
        with self.assertRaisesRegex(AttributeError, "help"):
            tests.path(material(), 1).strains  # pylint: disable=expression-not-assigned

    def test_help_tells_shapes_and_units(self):
        for thing, words in ((tests.Result, "(n, d, d) Cauchy stress [Pa]"),
                             (grainlaw.States.contacts, "(d,) on j [N]"),
                             (grainlaw.Evaluation, "(n, d, d, d, d) tangent"),
                             (grainlaw.Measure, "VOLUME: current volume [m3]"),
                             (tests.drained, "[Pa]"), (tests.path, "tension positive")):
            self.assertIn(words, thing.__doc__)

    def test_a_plot_has_stress_volume_and_contacts(self):
        try:
            import matplotlib  # pylint: disable=import-outside-toplevel,unused-import
        except ImportError:
            with self.assertRaisesRegex(ImportError, "python3-matplotlib"):
                tests.path(material(), 1).plot()
            return
        for result, words in ((tests.drained(material(), 0.002), "axial strain [-]"),
                              (tests.shear_constant_volume(material(), 0.002), "shear strain [-]")):
            figure = result.plot()
            self.assertEqual(len(figure.axes), 3)
            self.assertEqual(figure.axes[-1].get_xlabel(), words)
            with tempfile.TemporaryDirectory() as directory:
                file = os.path.join(directory, "test.png")
                figure.savefig(file)
                self.assertGreater(os.path.getsize(file), 10000)

    def test_plots_are_those_of_soil_mechanics_with_a_band_of_an_ensemble(self):
        try:
            import matplotlib  # pylint: disable=import-outside-toplevel,unused-import
        except ImportError:
            return
        result = tests.drained(material(), 0.002)
        sheared = tests.shear_constant_volume(material(), 0.002)
        for one, kind, below, beside in (
                (result, "p-q", "mean pressure p [kPa]", "deviatoric stress q [kPa]"),
                (sheared, "p-q", "mean pressure p [kPa]", "shear stress [kPa]"),
                (result, "e-log-p", "mean pressure p [kPa]", "void ratio e [-]"),
                (result, "stress-path", "lateral stress [kPa]", "axial stress [kPa]"),
                (sheared, "stress-path", "normal stress [kPa]", "shear stress [kPa]")):
            for picture, lines in ((one.plot(kind=kind), 2), (Ensemble([one, one]).plot(kind=kind), 4)):
                axes = picture.axes[0]
                self.assertEqual((axes.get_xlabel(), axes.get_ylabel()), (below, beside))
                self.assertEqual(len(axes.lines), lines)
                self.assertEqual(len(axes.lines[0].get_xdata()), len(one))
        held = result.plot(kind="stress-path").axes[0].get_xlim()
        self.assertGreater(held[1] - held[0], 10)   # kPa, not what the tolerance leaves
        columns = sheared.columns()
        columns["void_ratio"] = 0.2 + 1e-13 * np.arange(len(sheared))   # what rounding leaves
        for kind, panel in (("history", 1), ("e-log-p", 0)):
            self.assertGreater(np.ptp(plots.draw(kind, columns, True).axes[panel].get_ylim()), 0.01)
        bands = Ensemble([result, result]).plot().axes[0].collections
        self.assertEqual(len(bands), 3)
        self.assertRaisesRegex(ValueError, "p-q, e-log-p", result.plot, kind="pq")

    def test_a_plot_of_a_packing_has_its_particles_and_contacts(self):
        try:
            from matplotlib.collections import LineCollection  # pylint: disable=import-outside-toplevel
        except ImportError:
            return
        for path, share in ((None, 1), (SPHERES, 0.6)):
            state = grainlaw.State(material(path) if path else material())
            axes = state.plot().axes[0]
            chains = [c for c in axes.collections if isinstance(c, LineCollection)]
            drawn, there = len(chains[0].get_segments()), len(state.contacts())
            self.assertLessEqual(drawn, share * there)
            self.assertGreater(drawn, 0.2 * there)
            # Both fill the view: centres and bars are in the same unit.
            box = axes.dataLim
            self.assertLess(np.ptp(state.particles()["position"][:, 0]), box.width)
            self.assertLess(box.width, 2 * np.ptp(state.particles()["position"][:, 0]))


class Pressed(grainlaw.State):
    """A state during one of whose evaluations Ctrl-C is pressed."""
    evaluations = 0

    def evaluate(self, F, tangent=None, threads=1):
        self.evaluations += 1
        if self.evaluations == self.last:
            signal.raise_signal(signal.SIGINT)
        return super().evaluate(F, tangent, threads)


class CtrlC(Case):
    def interrupted(self, evaluation):
        """A state, and the exception that ends a test during this evaluation of it."""
        state = Pressed(material())
        state.last = evaluation
        with self.assertRaises(tests.Interrupted) as caught:
            tests.drained(state, 0.3, 1e-4)
        self.assertEqual(state.evaluations, evaluation)
        return state, caught.exception

    def test_loses_nothing(self):
        for evaluation in (1, 2, 40, 41, 42, 43):
            state, stopped = self.interrupted(evaluation)
            result = stopped.result
            self.assertEqual(result.ended, "interrupted")
            # The state is where the last row is, and that is where it would have been.
            F = state.measure(Measure.DEFORMATION_GRADIENT)
            self.assertEqual(F.tobytes(), result.F[-1].tobytes())
            if len(result) > 1:
                whole = tests.drained(material(), 1e-4 * (len(result) - 1), 1e-4)
                self.assertEqual(whole.sigma.tobytes(), result.sigma.tobytes())
                self.assertEqual(whole.state.save(), state.save())
        self.assertGreater(len(result), 10)

    def test_between_parts_of_a_step_keeps_what_is_committed(self):
        # Steps of 35 % are refused and cut.
        state = Pressed(material())
        state.last = 3
        with self.assertRaises(tests.Interrupted) as caught:
            tests.path(state, 1, F22=0.65)
        result = caught.exception.result
        self.assertEqual(len(result), 2)
        F = state.measure(Measure.DEFORMATION_GRADIENT)
        self.assertEqual(F.tobytes(), result.F[-1].tobytes())
        self.assertTrue(0.65 < F[1, 1] < 1)

    def test_the_handler_of_the_host_is_back_afterwards(self):
        self.interrupted(10)
        self.assertIs(signal.getsignal(signal.SIGINT), signal.default_int_handler)

    def test_a_test_in_another_thread_leaves_signals_alone(self):
        results = []
        worker = threading.Thread(
            target=lambda: results.append(tests.oedometric(material(), 0.002)))
        worker.start()
        worker.join()
        self.assertEqual(len(results[0]), 5)

    def test_a_set_keeps_what_is_committed(self):
        states = grainlaw.States(material(), 4)
        before = states.save()
        timer = threading.Timer(0.1, os.kill, (os.getpid(), signal.SIGINT))
        timer.start()
        with self.assertRaises(KeyboardInterrupt):
            while True:
                states.evaluate(np.tile(np.diag([1.0, 0.995]), (4, 1, 1)))
        self.assertEqual(states.save(), before)


if __name__ == "__main__":
    unittest.main()
