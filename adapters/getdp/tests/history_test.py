"""A history that cannot be written is a failure that GetDP sees; the last good one stays."""
import contextlib
import errno
import io
import os
import sys
import tempfile
import unittest
from unittest import mock

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))

import grainlaw_getdp as law

MATERIAL = sys.argv.pop(1)


class History(unittest.TestCase):
    def setUp(self):
        directory = tempfile.TemporaryDirectory()
        self.addCleanup(directory.cleanup)
        self.addCleanup(os.chdir, os.getcwd())
        os.chdir(directory.name)
        self.said = io.StringIO()

    @staticmethod
    def evaluate():
        law.collect([1, 0, [0, 0, 0], [0, 0, 0]])
        return law.evaluate()

    def start(self):
        return law.start(MATERIAL, 2, 1e-8, history="run") and self.evaluate()

    def step(self):
        self.evaluate()
        for residual in (1.0, 1e-9):
            outcome = law.judge([residual, 1.0])
        return law.finish([outcome, -1e-3, 0.0, 1.0])

    @staticmethod
    def read():
        with open("run_force.csv", encoding="utf-8") as force, \
                open("run_newton.csv", encoding="utf-8") as newton:
            return force.read(), newton.read()

    def fails(self, call, nth):
        original, count = os.write, []

        def full(*arguments):
            count.append(1)
            if len(count) == nth:
                raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
            return original(*arguments)

        with mock.patch.object(os, "write", full), contextlib.redirect_stderr(self.said):
            return call()

    def test_grows_by_whole_steps(self):
        self.assertEqual(self.start(), law.GO_ON)
        os.mkdir("elsewhere")
        os.chdir("elsewhere")  # the name is of where the run started
        self.assertEqual(self.step(), law.GO_ON)
        self.assertEqual(self.step(), law.CONVERGED)
        os.chdir("..")
        force, newton = self.read()
        self.assertEqual([row.split(",")[0] for row in force.splitlines()[1:]], ["0", "1"])
        self.assertEqual(len(newton.splitlines()), 5)
        self.assertEqual(sorted(os.listdir()), ["elsewhere", "run_force.csv", "run_newton.csv"])

    def test_a_full_disk_in_a_step(self):
        for nth in (1, 2):
            self.start()
            self.step()
            before = self.read()
            self.assertEqual(self.fails(self.step, nth), law.FAILED)
            self.assertIn("No space left on device", self.said.getvalue())
            force, newton = self.read()
            self.assertEqual(force, before[0])
            self.assertEqual(newton.startswith(before[1]), True)
            self.assertEqual(len(os.listdir()), 2)

    def test_a_full_disk_at_the_start(self):
        self.start()
        self.step()
        before = self.read()
        self.assertEqual(self.fails(self.start, 1), law.FAILED)
        self.assertEqual(self.read(), before)
        self.assertEqual(self.start(), law.GO_ON)


if __name__ == "__main__":
    unittest.main()
