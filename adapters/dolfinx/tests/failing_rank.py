"""A rank of two that fails, at ten places: the job ends within seconds, with one message of grainlaw's where one is told, and the
last checkpoint is whole.

    failing_rank.py MPIRUN MATERIAL.toml
"""
import os
import resource
import signal
import subprocess
import sys
import tempfile
import time
import unittest

SECONDS = 120   # of a job, with the start of two interpreters on a busy machine
LAST = 1        # the rank that fails

# What each must say, or nothing where a rank is killed.
PLACES = {
    "read": "rank 0: .*nowhere.toml: cannot be read",
    "make": f"rank {LAST}: no memory for the points",
    "load": f"rank {LAST}: .*cell .*: the checkpoint could not be read",
    "evaluate": f"rank {LAST}: evaluate failed alone",
    "memory": "memory",
    "solve": f"rank {LAST}: solve failed alone",
    "commit": f"rank {LAST}: commit failed alone",
    "save": f"rank {LAST}: the disk is full",
    "killed_evaluate": None,
    "killed_save": None,
}


def without_memory():
    """No more of it from now on than there is."""
    with open("/proc/self/statm", encoding="ascii") as file:
        size = int(file.read().split()[0]) * resource.getpagesize()
    resource.setrlimit(resource.RLIMIT_AS, (size, resource.RLIM_INFINITY))


def run(place, material_path, path):
    """The program of a user: goes on from a checkpoint at half the load, and saves again."""
    from mpi4py import MPI
    from restart import problem

    import grainlaw
    from grainlaw import checkpoint, dolfinx
    from grainlaw.dolfinx import end_together, read_material

    comm = MPI.COMM_WORLD
    fails = comm.rank == LAST

    def failing(text):
        def call(*_, **__):
            raise grainlaw.Error(grainlaw.Status.OUT_OF_MEMORY, text)
        return call

    def killed(*_, **__):
        os.kill(os.getpid(), signal.SIGKILL)

    with end_together(comm):
        material = read_material(comm, "nowhere.toml" if place == "read" else material_path)
        if place == "make" and fails:
            dolfinx._states = failing("no memory for the points")
        newton, _ = problem(material)
        if place == "start":
            for load in (0, 0.5):
                for _ in newton.to(load):
                    pass
            newton.save(path)
            return
        if place == "load" and fails:
            checkpoint._read = failing("the checkpoint could not be read")
        newton.load(path)
        if fails:
            states = newton.points.states
            states.evaluate = {"evaluate": failing("evaluate failed alone"), "killed_evaluate": killed}.get(place, states.evaluate)
            states.commit = failing("commit failed alone") if place == "commit" else states.commit
            newton.solve = failing("solve failed alone") if place == "solve" else newton.solve
            checkpoint._write = {"save": failing("the disk is full"), "killed_save": killed}.get(place, checkpoint._write)
            if place == "memory":
                without_memory()
        for _ in newton.to(0.6):
            pass
        newton.save(path)
        if comm.rank == 0:
            print("ended well")


class FailingRank(unittest.TestCase):
    def setUp(self):
        directory = tempfile.TemporaryDirectory()
        self.addCleanup(directory.cleanup)
        self.path = os.path.join(directory.name, "cells")
        done = self.job("start")
        self.assertEqual(done.returncode, 0, done.stderr)
        with open(self.path, "rb") as file:
            self.saved = file.read()

    def job(self, place):
        return subprocess.run([MPIRUN, "--oversubscribe", "-n", "2", sys.executable, __file__, place, MATERIAL, self.path],
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, timeout=SECONDS, check=False)

    def test_the_job_ends_with_one_message_and_the_checkpoint_is_whole(self):
        for place, words in PLACES.items():
            with self.subTest(place):
                start = time.monotonic()
                done = self.job(place)
                seconds = time.monotonic() - start
                told = [line for line in done.stderr.splitlines() if line.startswith("grainlaw: ")]
                print(f"{place}: ended after {seconds:.0f} s with {done.returncode}: {' | '.join(told)}", flush=True)
                self.assertNotEqual(done.returncode, 0)
                self.assertNotIn("ended well", done.stdout)
                self.assertEqual(len(told), 0 if words is None else 1, done.stderr)
                if words is not None:
                    self.assertRegex(told[0], words)
                with open(self.path, "rb") as file:
                    self.assertEqual(file.read(), self.saved)

    def test_it_ends_well_where_nothing_fails(self):
        done = self.job("nowhere")
        self.assertIn("ended well", done.stdout, done.stderr)
        with open(self.path, "rb") as file:
            self.assertNotEqual(file.read(), self.saved)


if __name__ == "__main__":
    sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
    if len(sys.argv) == 4:
        run(*sys.argv[1:])
    else:
        MPIRUN, MATERIAL = sys.argv[1:3]
        unittest.main(argv=sys.argv[:1])
