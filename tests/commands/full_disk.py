"""The disk is full from any write on: the command says which file could not be written, no file is
left half under its name, the last checkpoint stays, and a run goes on from it to the same bytes."""
import os
import shutil
import stat
import unittest

from command import DNS, LATTICE, PERIODIC, POINT, SOLVE, WAVE, Place

# Pictures are not what is tested: a gnuplot that draws at once.
GNUPLOT = "#!/bin/sh\ncat >/dev/null\necho picture\n"
TABLES = ("s.csv", "s_newton.csv", "s_balance.csv", "s_force.csv", "s_cost.csv", "s_point0.csv", "p.csv",
          "d.csv", "d_cost.csv", "w_cost.csv", "w_dns.csv", "w_fe2.csv")
TIMES = ("s_cost.csv", "d_cost.csv", "w_cost.csv")


class FullDisk(unittest.TestCase):
    def setUp(self):
        self.place = Place()
        gnuplot = self.place.home / "gnuplot"
        gnuplot.write_text(GNUPLOT, encoding="utf-8")
        gnuplot.chmod(gnuplot.stat().st_mode | stat.S_IXUSR)
        self.place.environment["PATH"] = f"{self.place.home}:{os.environ['PATH']}"

    def tearDown(self):
        self.place.temporary.cleanup()

    def run_full(self, writes, *arguments):
        self.place.environment.update(LD_PRELOAD=os.environ["FULL_DISK"], GRAINLAW_WRITES=str(writes))
        try:
            return self.place.run(*arguments, "--output", "full")
        finally:
            del self.place.environment["LD_PRELOAD"], self.place.environment["GRAINLAW_WRITES"]

    def contents(self, directory):
        return {path.name: path.read_bytes() for path in (self.place.path / directory).iterdir()
                if path.is_file() and path.name not in TIMES}

    def check_whole(self, whole):
        """Every file is that of the whole run; a table may end after any row."""
        for name, found in self.contents("full").items():
            if name == "s.checkpoint":
                continue
            self.assertIn(name, whole)
            if name.endswith(".pvd"):  # of so many steps
                end = b"</Collection>"
                self.assertIn(end, found)
                self.assertTrue(whole[name].startswith(found[:found.index(end)]), name)
            elif name in TABLES:
                self.assertTrue(whole[name].startswith(found), name)
                self.assertTrue(found == b"" or found.endswith(b"\n"), name)
            else:
                self.assertEqual(found, whole[name], name)

    def every_write(self, *arguments, again=()):
        status, out, err = self.place.run(*arguments, "--output", "whole")
        self.assertEqual(status, 0, err)
        whole = self.contents("whole")
        for writes in range(1000):
            with self.subTest(writes=writes):
                shutil.rmtree(self.place.path / "full", ignore_errors=True)
                status, out, err = self.run_full(writes, *arguments, *again)
                if status == 0:
                    break
                self.assertEqual(status, 1, out + err)
                self.assertRegex(err, r"full/[\w.]+(/written)?: cannot be written: No space left on device"
                                      r"|writing full/[\w.]+: |writing .*/grainlaw_\w+/(state|frame)")
                self.check_whole(whole)
                if again:
                    status, out, err = self.place.run(*arguments, *again, "--restart", "--output",
                                                      "full")
                    self.assertEqual(status, 0, out + err)
                    found = self.contents("full")
                    found.pop("s.checkpoint", None)
                    self.assertEqual(found, whole)
        self.assertGreater(writes, 3)
        print(f"{arguments[0]}: {writes} writes failed in turn")

    def test_solve(self):
        scene = self.place.write("s.toml", "steps = 2\nthreads = 1\nvtk_every = 1\npackings = [0]\n"
                                 "points = [0]\n" + PERIODIC + SOLVE.format(value=-1e-5)
                                 + '[picture]\nfields = ["void_ratio"]\npackings = [0]\n')
        self.every_write("solve", scene, again=("--checkpoint-every", "1"))

    def test_point(self):
        scene = self.place.write("p.toml", "vtk_every = 1\npictures = [0.0]\n" + PERIODIC
                                 + POINT.format(steps=1, stretch=0.9999))
        self.every_write("point", scene)

    def test_dns(self):
        self.every_write("dns", self.place.write("d.toml", "vtk_every = 1\n" + DNS.format(steps=1)))

    def test_wave(self):
        scene = self.place.write("w.toml", WAVE.format(repeat=3, duration=1e-4))
        self.every_write("wave", scene)

    def test_pack(self):
        self.every_write("pack", self.place.write("r.toml", LATTICE), "--vtk")

    def test_old_packing_stays(self):
        recipe = self.place.write("r.toml", LATTICE)
        self.place.run("pack", recipe, "--output", "full")
        before = self.contents("full")
        recipe = self.place.write("r.toml", LATTICE.replace("5e-3", "6e-3"))
        status, _, err = self.run_full(1, "pack", recipe)
        self.assertEqual(status, 1, err)
        self.assertEqual(self.contents("full"), before)


if __name__ == "__main__":
    unittest.main()
