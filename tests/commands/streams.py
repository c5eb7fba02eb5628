#!/usr/bin/env python3
"""What stands in place of files and streams: closed ones, full ones, pipes and devices."""
import os
import subprocess
import unittest

from command import GRAINLAW, MATERIAL, POINT, Place

SCENE = MATERIAL + POINT.format(steps=2, stretch=0.9999)


class Streams(unittest.TestCase):
    def setUp(self):
        self.place = Place()
        self.addCleanup(self.place.temporary.cleanup)
        self.place.write("scene.toml", "figure = false\n" + SCENE)
        self.whole = self.table("whole")

    def table(self, output, close=()):
        self.run_point(output, close)
        return (self.place.path / output / "scene.csv").read_text()

    def run_point(self, output, close=(), stdout=subprocess.DEVNULL):
        """The run, with these of its streams closed."""
        def before():
            for stream in close:
                os.close(stream)
        return subprocess.run([GRAINLAW, "point", "scene.toml", "--output", output], cwd=self.place.path,
                              env=self.place.environment, preexec_fn=before, timeout=20, stdout=stdout,
                              stderr=subprocess.PIPE)

    def test_no_message_gets_into_a_table_where_streams_are_closed(self):
        for close in ((0,), (1,), (2,), (1, 2), (0, 1, 2)):
            with self.subTest(closed=close):
                self.assertEqual(self.table("closed", close=close), self.whole)

    def test_results_that_cannot_be_printed_are_an_error(self):
        with open("/dev/full", "wb") as full:
            run = self.run_point("full", stdout=full)
        self.assertEqual(run.returncode, 1)
        self.assertIn(b"standard output", run.stderr)

    def test_a_pipe_in_place_of_a_table_is_told_at_once(self):
        (self.place.path / "pipe").mkdir()
        os.mkfifo(self.place.path / "pipe" / "scene.csv")
        run = self.run_point("pipe")
        self.assertNotEqual(run.returncode, 0)
        self.assertIn(b"scene.csv: cannot be written", run.stderr)

    def test_a_file_that_cannot_be_written_is_told_with_the_cause(self):
        self.place.write("scene.toml", f'name = "{"a" * 250}"\nfigure = false\nvtk_every = 1\n' + SCENE)
        run = self.run_point("long")
        self.assertNotEqual(run.returncode, 0)
        self.assertIn(b"File name too long", run.stderr)

    def test_a_device_is_no_table_to_compare(self):
        for path in ("/dev/zero", str(self.place.path / "fifo")):
            if path.endswith("fifo"):
                os.mkfifo(path)
            status, _, err = self.place.run("compare", "a=whole/scene.csv", f"b={path}")
            self.assertNotEqual(status, 0)
            self.assertIn("expected a file", err)


if __name__ == "__main__":
    unittest.main()
