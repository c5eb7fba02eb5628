"""Bad input: an Error with status and message, and what is committed as it was."""
import contextlib
import errno
import os
import subprocess
import sys
import tempfile
import unittest

import numpy as np

import grainlaw
from grainlaw import Status, Tangent
from support import DATA, MATERIAL, Case, material


class BadInput(Case):
    def setUp(self):
        self.states = grainlaw.States(material(), 3)
        self.states.evaluate(np.tile(np.diag([1.0, 0.999]), (3, 1, 1)))
        self.states.commit()
        self.before = self.states.save()
        self.good = np.tile(np.diag([1.0, 0.998]), (3, 1, 1))

    def tearDown(self):
        self.assertEqual(self.states.save(), self.before)

    def test_arrays_of_another_shape(self):
        for shape in [(2, 2, 2), (3, 2), (3, 3, 3), (12,), (0, 2, 2), (3, 2, 2, 1), ()]:
            self.assert_refused(Status.BAD_ARGUMENT, [str(shape), "(3, 2, 2)"],
                                self.states.evaluate, np.ones(shape))

    def test_arrays_of_another_type(self):
        for kind in (complex, object, str, bool, "datetime64[s]"):
            self.assert_refused(Status.BAD_ARGUMENT, ["real numbers"],
                                self.states.evaluate, np.zeros((3, 2, 2), kind))
        self.assert_refused(Status.BAD_ARGUMENT, ["F "], self.states.evaluate, None)
        self.assert_refused(Status.BAD_ARGUMENT, ["F "], self.states.evaluate, "F")
        self.assert_refused(Status.BAD_ARGUMENT, ["F "], self.states.evaluate,
                            [[[1, 0], [0]], [1], []])

    def test_other_layouts_and_precisions_are_converted(self):
        expected = self.states.evaluate(self.good).P
        strided = np.zeros((3, 2, 4))
        strided[:, :, ::2] = self.good
        for F in (strided[:, :, ::2], np.asfortranarray(self.good), self.good.tolist(),
                  self.good.astype(">f8")):
            self.assertEqual(self.states.evaluate(F).P.tobytes(), expected.tobytes())
        self.assertTrue(self.states.evaluate(self.good.astype(np.float32)).ok)
        self.states.revert()

    def test_numbers_that_are_none(self):
        for bad in (np.nan, np.inf, -np.inf):
            self.good[1, 0, 1] = bad
            refused = self.assert_refused(Status.NOT_FINITE, ["point 1", "F12"],
                                          self.states.evaluate, self.good, Tangent.EXACT)
            self.assertEqual(refused.point, 1)
            self.assert_refused(Status.NO_TRIAL, ["no evaluated trial"], self.states.commit)

    def test_unknown_tangent_and_measure(self):
        for want in (3, 8, 64):
            self.assert_refused(Status.BAD_ARGUMENT, [f"want is {want}, expected 0 or one of"],
                                self.states.evaluate, self.good, want)
        for measure in (-1, 1000):
            self.assert_refused(Status.BAD_ARGUMENT, [], self.states.measure, measure)

    def test_integers_that_c_would_cut(self):
        for beyond in (2**31, 2**32, 2**40, 2**64 + 3, 2**70):
            for call, word in ((lambda: self.states.evaluate(self.good, beyond), "tangent"),
                               (lambda: self.states.evaluate(self.good, None, beyond), "threads"),
                               (lambda: self.states.measure(beyond), "measure"),
                               (lambda: self.states.contacts(beyond), "point"),
                               (lambda: grainlaw.status_text(beyond), "status")):
                self.assert_refused(Status.BAD_ARGUMENT, [f"{word} {beyond}:", "from"], call)
        for count in (2**64, 2**64 + 3, 2**70, -2**64 + 1):
            self.assert_refused(Status.BAD_ARGUMENT, [f"number of points {count}", "from 0"],
                                grainlaw.States, material(), count)
        self.assertEqual(len(grainlaw.States(material(), np.int64(2))), 2)
        self.assertTrue(self.states.evaluate(self.good, np.uint8(1), np.int32(2)).ok)
        self.states.revert()

    def test_what_is_no_number(self):
        for bad in (1.5, "2", [1], np.ones(2), 1j):
            for call, word in ((lambda: self.states.evaluate(self.good, bad), "grainlaw.Tangent"),
                               (lambda: self.states.evaluate(self.good, None, bad), "threads"),
                               (lambda: self.states.measure(bad), "grainlaw.Measure"),
                               (lambda: self.states.particles(bad), "point")):
                self.assert_refused(Status.BAD_ARGUMENT, [repr(bad), word, "whole number"], call)
        self.assert_refused(Status.BAD_ARGUMENT, ["threads None"], self.states.evaluate, self.good,
                            None, None)
        for bad in ("x", "1", None, 1j, [1], np.ones(1), np.ma.masked, np.nan, np.inf, 10**400):
            self.assert_refused(Status.BAD_ARGUMENT, ["time step", "finite number"],
                                self.states.set_time_step, bad)
        self.assert_refused(Status.BAD_ARGUMENT, ["time step", "at least 0"],
                            self.states.set_time_step, -1.0)

    def test_masked_entries(self):
        holes = np.ma.array(self.good, mask=self.good == 0)
        for F in (holes, list(holes), [list(point) for point in holes]):
            self.assert_refused(Status.BAD_ARGUMENT, ["masked"], self.states.evaluate, F)
        self.assert_refused(Status.BAD_ARGUMENT, ["masked"], grainlaw.State(material()).evaluate,
                            holes[0])
        self.assertTrue(self.states.evaluate(np.ma.array(self.good)).ok)
        self.states.revert()

    def test_commit_before_evaluate(self):
        self.assert_refused(Status.NO_TRIAL, ["no evaluated trial"], self.states.commit)

    def test_what_is_no_material(self):
        for bad in (None, 3, "sand.toml", self.states):
            self.assert_refused(Status.BAD_HANDLE, ["Material"], grainlaw.States, bad, 1)
        for count in (-1, 1.5, None):
            self.assert_refused(Status.BAD_ARGUMENT, ["number of points"],
                                grainlaw.States, material(), count)

    def test_material_files(self):
        self.assert_refused(Status.FILE_ERROR, ["nowhere.toml"], grainlaw.Material, "nowhere.toml")
        self.assert_refused(Status.BAD_ARGUMENT, ["zero byte"], grainlaw.Material, "a\0b")
        text = "dimension = 2\n[contact]\nlaw = 'putty'\n"
        self.assert_refused(Status.BAD_MATERIAL, [], grainlaw.Material.parse, text, DATA)

    def test_saved_states_of_others(self):
        self.assert_refused(Status.BAD_ARGUMENT, ["2 points, expected 3"],
                            self.states.load, grainlaw.States(material(), 2).save())
        damaged = bytearray(self.before)
        damaged[-100] ^= 1  # of the last point
        fresh = grainlaw.States(material(), 3)
        kept = fresh.save()
        self.assert_refused(Status.BAD_BYTES, ["damaged"], fresh.load, damaged)
        self.assert_refused(Status.BAD_BYTES, ["truncated"], fresh.load, b"")
        for bad in (3, 2**70, "saved", None):
            self.assert_refused(Status.BAD_ARGUMENT, ["bytes", type(bad).__name__], fresh.load, bad)
        self.assertEqual(fresh.save(), kept)  # not even the good ones
        with open(MATERIAL, encoding="utf-8") as file:
            other = grainlaw.Material.parse(file.read().replace("0.546", "0.446"), DATA)
        self.assert_refused(Status.WRONG_MATERIAL, ["point 0"],
                            grainlaw.States(other, 3).load, self.before)

    def test_files_that_cannot_be_written(self):
        for path, cause in (("/nowhere/a.vtp", errno.ENOENT), (DATA, errno.EISDIR),
                            (os.path.join(MATERIAL, "a.vtp"), errno.ENOTDIR),
                            ("/dev/full", errno.ENOSPC)):
            self.assert_refused(Status.FILE_ERROR, [path, os.strerror(cause)],
                                self.states.write_vtk, path)
        self.assert_refused(Status.FILE_ERROR, ["/nowhere/a", os.strerror(errno.ENOENT)],
                            self.states.write_packing, "/nowhere/a")
        self.assert_refused(Status.BAD_ARGUMENT, ["point 3"], self.states.write_vtk, "a.vtp", 3)

    def test_files_without_a_name(self):
        with tempfile.TemporaryDirectory() as directory, contextlib.chdir(directory):
            for name in ("", b""):
                for write in (self.states.write_packing, self.states.write_vtk):
                    self.assert_refused(Status.BAD_ARGUMENT, ["not empty"], write, name)
            self.assertEqual(os.listdir(), [])

    def test_library_that_is_none(self):
        for path, words in (("/nowhere/libgrainlaw.so", "cannot be loaded"),
                            ("libm.so.6", "cannot be loaded")):
            run = subprocess.run([sys.executable, "-c", "import grainlaw"], text=True,
                                 env={**os.environ, "GRAINLAW_LIBRARY": path},
                                 stderr=subprocess.PIPE, check=False)
            self.assertEqual(run.returncode, 1)
            self.assertIn(words, run.stderr)
            self.assertIn("GRAINLAW_LIBRARY", run.stderr)


if __name__ == "__main__":
    unittest.main()
