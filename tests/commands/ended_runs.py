"""Runs of the command `grainlaw` that fail or are stopped tell what they took and which files there
are, leave no others, and keep what the other cases have done."""
import csv
import re
import signal
import time
import unittest

from command import DNS, LATTICE, PERIODIC, POINT, SOLVE, WAVE, Place, written

# Too far for a lattice that may not be cut, after a step that it can do.
FAILING = "max_cuts = 0\n[[case.segment]]\nsteps = 1\nF22 = 0.9999\n[[case.segment]]\nsteps = 1\nF12 = 1.0\n"

# Packings of two seeds.
SEEDS = """
[material]
dimension = 2
thickness = 0.1
packing = { generator = "compaction", count = 30, radii = [4e-3, 9e-3], seed = 3, pressure = 1e5, friction = 0.3 }
contact = { law = "frictional", young = 6e8, ratio = 0.8, friction = 0.5 }
boundary = { type = "periodic-cell" }
""" + POINT.format(steps=1, stretch=0.9999) + '[[case]]\nname = "a"\nseeds = 2\n'

TABLE = "axial_strain,axial_stress,lateral_stress,volumetric_strain,coordination\n0,1,1,0,4\n0.02,3,1,0.01,4\n"


class EndedRuns(unittest.TestCase):
    def setUp(self):
        self.place = Place()

    def tearDown(self):
        self.place.temporary.cleanup()

    def without_other_programs(self):
        self.place.environment["PATH"] = str(self.place.home)

    def table(self, name):
        with open(self.place.path / "out" / name, encoding="utf-8", newline="") as file:
            return list(csv.DictReader(file))

    def check_files(self, out):
        """What is named is there, and nothing else is left over."""
        lines = [line for line in out.splitlines() if "wrote " in line]
        self.assertTrue(lines, out)
        for line in lines:
            for name in written(line):
                self.assertTrue((self.place.path / name).exists(), name)
        for name in self.place.files("out"):
            self.assertNotRegex(name, r"_state|_read|\.new$")

    def stop(self, table, rows, *arguments, number=signal.SIGINT):
        """Asks the command to end when that table has so many rows."""
        process = self.place.start(*arguments, "--output", "out")
        path = self.place.path / "out" / table
        end = time.monotonic() + 60
        while time.monotonic() < end and process.poll() is None:
            if path.exists() and path.read_bytes().count(b"\n") > rows:
                break
            time.sleep(0.005)
        process.send_signal(number)
        out, err = process.communicate(timeout=120)
        self.assertEqual(process.returncode, 128 + number, out + err)
        return out, err

    def test_one_case_that_fails_leaves_the_others(self):
        for jobs in ("1", "3"):
            with self.subTest(jobs=jobs):
                scene = self.place.write("p.toml", PERIODIC + POINT.format(steps=3, stretch=0.9999)
                                         + '[[case]]\nname = "wrong"\nmaterial = { thickness = -1 }\n'
                                         + '[[case]]\nname = "far"\n' + FAILING
                                         + '[[case]]\nname = "right"\n')
                status, out, err = self.place.run("point", scene, "--output", "out", "--jobs", jobs)
                self.assertEqual(status, 1, err)
                self.assertIn("p_wrong: ", err)
                self.assertIn("thickness", err)
                self.assertRegex(err, r"p_far: step 2 \(from F22 = 0.999900, .*\) failed")
                self.check_files(out)
                wrong, far, right = self.table("p_cases.csv")
                self.assertIn("thickness", wrong["end"])
                self.assertEqual((far["steps[-]"], right["steps[-]"]), ("1", "3"))
                self.assertIn("failed", far["end"])
                self.assertEqual(right["end"], "done")
                # What the step that failed took is in the sum.
                self.assertEqual(far["evaluations[-]"], "2")
                self.assertRegex(out, r"p_far: 1 steps, .* 3 evaluations, .* 1 cuts")
                self.assertEqual(len(self.table("p_right.csv")), 4)

    def test_wrong_cases_alone_are_wrong_input(self):
        scene = self.place.write("p.toml", PERIODIC + POINT.format(steps=1, stretch=0.9999)
                                 + '[[case]]\nname = "wrong"\nmaterial = { thickness = -1 }\n'
                                 + '[[case]]\nname = "right"\n')
        status, _, err = self.place.run("point", scene, "--output", "out")
        self.assertEqual(status, 2, err)

    def test_without_the_programs_that_draw_no_picture_is_named(self):
        self.without_other_programs()
        self.place.write("p.toml", PERIODIC + POINT.format(steps=1, stretch=0.9999))
        self.place.write("s.toml", "steps = 1\n" + PERIODIC + SOLVE.format(value=-1e-5))
        self.place.write("d.toml", DNS.format(steps=1))
        self.place.write("w.toml", WAVE.format(repeat=3, duration=1e-4))
        self.place.write("r.toml", LATTICE)
        for command, scene in (("point", "p"), ("solve", "s"), ("dns", "d"), ("wave", "w"),
                               ("pack", "r")):
            status, out, err = self.place.run(command, scene + ".toml", "--output", "out")
            self.assertEqual(status, 0, err)
            self.assertIn("rsvg-convert was not found (Debian package librsvg2-bin)" if command == "pack"
                          else "gnuplot was not found (Debian package gnuplot-nox)", err)
            self.assertNotIn(".svg", out)
            self.check_files(out)

    def test_an_ensemble_is_of_this_run_alone(self):
        run = ("point", "y.toml", "--output", "out")
        self.place.write("y.toml", SEEDS)
        status, out, err = self.place.run(*run)
        self.assertEqual(status, 0, err)
        self.assertIn("y_a: 2 packings", out)
        path = self.place.path / "out" / "y_a_ensemble.csv"
        old = path.stat()
        self.place.write("y.toml", SEEDS.replace("count = 30", "count = -1"))
        status, out, err = self.place.run(*run)
        self.assertEqual(status, 2, err)
        self.assertIn("y_a: found 0 packings, expected 2 or more for an ensemble", out)
        self.assertIn("y_a_ensemble.csv is of an earlier run", out)
        self.place.write("y.toml", SEEDS)
        status, out, err = self.place.run(*run, "--case", "a_s2", "--case", "a_s2")
        self.assertEqual(status, 0, err)
        self.assertIn("y_a: found 1 packings", out)
        self.assertEqual(out.count("starts at"), 1, out)
        self.assertEqual((path.stat().st_ino, path.stat().st_mtime_ns), (old.st_ino, old.st_mtime_ns))

    def test_two_outputs_of_one_name_are_refused(self):
        for more, words in (('name = "a_ensemble"', "y_a_ensemble.csv, of y_a_ensemble and of the ensemble of y_a"),
                            ('name = "a_s1"', '"a_s1" with results y_a_s1 as of "a"'),
                            ('name = "cases"', "y_cases.csv, of y_cases and of the ends of the cases"),
                            ('name = "a_s1_particles"\n[[case]]\nname = "b"', "y_a_s1_particles.csv, of y_a_s1"),
                            ('name = "a_s2_packing"', "y_a_s2_packing.svg, of y_a_s2")):
            scene = self.place.write("y.toml", "particle_measures = true\npictures = [0.0]\n" + SEEDS
                                     + f"[[case]]\n{more}\n")
            status, out, err = self.place.run("point", scene, "--output", "out")
            self.assertEqual((status, out), (2, ""), more + err)
            self.assertIn(words, err)
        scene = self.place.write("z.toml", DNS.format(steps=1) + '[[case]]\nname = "a"\n[[case]]\nname = "a_cost"\n')
        status, _, err = self.place.run("dns", scene, "--output", "out")
        self.assertEqual(status, 2, err)
        self.assertIn("z_a_cost.csv, of", err)
        self.assertFalse((self.place.path / "out").exists())
        scene = self.place.write("y.toml", SEEDS + '[[case]]\nname = "a_s1_particles"\n')
        status, _, err = self.place.run("point", scene, "--output", "out")
        self.assertEqual(status, 0, err)

    def test_loads_that_fail_at_the_start_are_not_put_down_to_the_load_steps(self):
        pulled = SOLVE.format(value=-1e-5).replace("value = 100e3", "value = -100e6")
        scene = self.place.write("s.toml", "steps = 1\n" + PERIODIC + pulled)
        status, _, err = self.place.run("solve", scene, "--output", "out")
        self.assertEqual(status, 1, err)
        self.assertIn("loads that act from time 0 on", err)

    def test_compare_says_what_a_table_lacks(self):
        good = self.place.write("good.csv", TABLE)
        for text, words in ((TABLE.split("\n", 1)[0] + "\n", "found no row below the header"),
                            (TABLE.replace("0.02,3,", "0.02,nan,"), "axial_stress: found nan in row 2"),
                            (TABLE.replace("0.02,3,", "0.02,3 kPa,"), "axial_stress: found nan in row 2"),
                            (TABLE.replace("0.02,3,", "0.02,,"), "axial_stress: found nan in row 2"),
                            (TABLE.replace("axial_stress", "axial_stress[kPa]", 1),
                             "axial_stress: found the unit [kPa], expected [Pa]"),
                            (TABLE.replace("axial_strain", "axial_strain[%]", 1),
                             "axial_strain: found the unit [%], expected [-]"),
                            (TABLE.replace(",3,1,", ",3,inf,"), "lateral_stress: found inf in row 2"),
                            ("x\n1\n", "found columns x, expected axial_strain too")):
            bad = self.place.write("bad.csv", text)
            status, out, err = self.place.run("compare", f"a={bad}", f"b={good}", "--output", "out")
            self.assertEqual((status, out), (2, ""), text + err)
            self.assertIn(f"{bad}: {words}", err)
        blanks = self.place.write("blanks.csv", TABLE.replace(",", ", ", 4).replace("axial_stress", "axial_stress [Pa]", 1))
        self.assertEqual(self.place.run("compare", f"a={blanks}", f"b={good}", "--output", "blanks")[0], 0)
        status, out, err = self.place.run("compare", f"a={good}", f"a={good}", "--output", "out")
        self.assertEqual((status, out), (2, ""), err)
        self.assertIn("found the NAME a twice", err)
        for table in ("a=", f"={good}", good):
            status, out, err = self.place.run("compare", table, f"b={good}", "--output", "out")
            self.assertEqual((status, out), (2, ""), err)
            self.assertIn(f"found {table}, expected NAME=TABLE", err)
        for option in ("--stress-within", "--peak-within", "--volume-within"):
            for bound in ("nan", "-1"):
                status, out, err = self.place.run("compare", f"a={good}", f"b={good}", "--output", "out",
                                                  f"{option}={bound}")
                self.assertEqual((status, out), (2, ""), err)
                self.assertIn(f"found {bound}, expected a number >= 0", err)
        self.assertFalse((self.place.path / "out").exists())

    def test_stopped_point(self):
        scene = self.place.write("p.toml", "pictures = [0.0]\n" + PERIODIC
                                 + POINT.format(steps=20000, stretch=0.9999)
                                 + '[[case]]\nname = "a"\n[[case]]\nname = "b"\n')
        out, err = self.stop("p_a.csv", 3, "point", scene)
        self.check_files(out)
        done = len(self.table("p_a.csv")) - 1
        self.assertRegex(out, rf"p_a: {done} steps, .* s of CPU\n  ended: stopped by Ctrl-C \(SIGINT\) "
                              rf"after step {done} of 20000\n")
        self.assertIn("once more ends it at once", err)
        first, second = self.table("p_cases.csv")
        self.assertIn("stopped by Ctrl-C", first["end"])
        self.assertIn("stopped by Ctrl-C", second["end"])
        self.assertEqual(second["steps[-]"], "0")

    def test_left_point(self):
        scene = self.place.write("p.toml", PERIODIC + POINT.format(steps=20, stretch=0.9999))
        status, out, _ = self.place.run("point", scene, "--output", "out", "--steps", "2")
        self.assertEqual(status, 0)
        self.assertIn("ended: left after step 2 of 20 as asked", out)

    def test_stopped_solve(self):
        scene = self.place.write("s.toml", "steps = 20000\n" + PERIODIC + SOLVE.format(value=-1e-5))
        out, _ = self.stop("s.csv", 3, "solve", scene, number=signal.SIGTERM)
        self.check_files(out)
        done = len(self.table("s.csv")) - 1
        self.assertIn(f"ended after step {done} of 20000 as asked; go on with\n  grainlaw solve", out)
        self.assertRegex(out, rf"s: {done} steps, ")
        self.assertIn("core-seconds", out)

    def test_failed_solve(self):
        scene = self.place.write("s.toml", "steps = 2\n[newton]\nmax_cuts = 2\n" + PERIODIC
                                 + SOLVE.format(value=-2e-5).replace(
                                     "value = -2e-05", "path = [[0, 0], [0.5, -1e-5], [1, -0.9]]"))
        status, out, err = self.place.run("solve", scene, "--output", "out")
        self.assertEqual(status, 1, out)
        self.assertRegex(err, r"s.toml: load step 2 failed")
        self.check_files(out)
        self.assertEqual([row["step[-]"] for row in self.table("s.csv")], ["0", "1"])
        costs = self.table("s_cost.csv")
        self.assertEqual([row["step[-]"] for row in costs], ["0", "1", "2"])
        self.assertGreater(int(costs[2]["evaluations[-]"]), 0)
        self.assertGreater(int(costs[2]["cuts[-]"]), 0)
        evaluations = sum(int(row["evaluations[-]"]) for row in costs)
        self.assertIn(f" {evaluations} evaluations", out)

    def test_failed_start_of_solve(self):
        scene = self.place.write("s.toml", "steps = 2\n" + PERIODIC
                                 + SOLVE.format(value=-2e-5).replace("100e3", "1e12"))
        status, out, err = self.place.run("solve", scene, "--output", "out")
        self.assertEqual(status, 1, out)
        self.assertIn("core-seconds", out)
        self.assertNotIn(".svg", out)
        self.check_files(out)

    def test_stopped_and_failed_dns(self):
        scene = self.place.write("d.toml", DNS.format(steps=5000))
        out, _ = self.stop("d.csv", 3, "dns", scene)
        self.check_files(out)
        self.assertRegex(out, r"s of CPU, .* s elapsed\n  ended: stopped by Ctrl-C \(SIGINT\) after step")
        scene = self.place.write("d.toml", DNS.format(steps=1) + "[[case]]\nname = 'far'\nmax_cuts = 0\n"
                                 "[[case.segment]]\nsteps = 1\nF12 = 2.0\n[[case]]\nname = 'right'\n")
        status, out, err = self.place.run("dns", scene, "--output", "out")
        self.assertEqual(status, 1)
        self.assertRegex(err, r"d_far: step 1 .* failed")
        self.assertRegex(out, r"d_right: .* 1 of 1 steps")
        self.check_files(out)

    def test_stopped_wave(self):
        scene = self.place.write("w.toml", WAVE.format(repeat=40, duration=1.0)
                                 + "[[case]]\nname = 'a'\n[[case]]\nname = 'b'\n")
        process = self.place.start("wave", scene, "--output", "out")
        while not (self.place.path / "out").exists() and process.poll() is None:
            time.sleep(0.005)
        time.sleep(0.5)
        process.send_signal(signal.SIGINT)
        out, err = process.communicate(timeout=120)
        self.assertEqual(process.returncode, 130, err)
        self.assertRegex(out, r"w_a: particles, .* core-seconds\n  ended after .* ms: stopped by Ctrl-C")
        self.check_files(out)

    def test_a_seed_that_fails_is_told_and_counted(self):
        recipe = self.place.write("r.toml", """
dimension = 2
thickness = 1e-3
packing = { generator = "compaction", count = 30, radii = [1e-3, 2e-3], seed = 1, pressure = 1e5, friction = 0.3 }
contact = { law = "frictional", kn = 1e6, ratio = 0.8, friction = 0.5 }
boundary = { type = "frame-p" }
""")
        status, out, err = self.place.run("pack", recipe, "--output", "out", "--seeds", "12")
        told = [line for line in out.splitlines()[1:] if not re.match(r"^ *\d+( +[\d.]+)+$", line)]
        if told:
            self.assertEqual(status, 1, out + err)
            self.assertIn(f"{len(told)} of 12 seeds", err)
        else:
            self.assertEqual(status, 0, out + err)


if __name__ == "__main__":
    unittest.main()
