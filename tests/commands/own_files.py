"""No command writes over a file that it read or that it has not made, or removes one, without --force; it says so before
any work. What it needs for itself alone is elsewhere. A scene is run again into the same directory as often as one likes."""
import os
import pathlib
import re
import shutil
import signal
import time
import unittest

from command import DNS, LATTICE, PERIODIC, POINT, SOLVE, WAVE, Place
from starts import SOLID_BODY, SPHERES

PACKING = ("_particles.csv", "_contacts.csv", "_cell.csv")
# What commands need for a moment.
SCRATCH = [f"_{what}{end}" for what in ("state", "read", "start", "state_frame", "prestress", "0001_state")
           for end in (*PACKING, ".vtp")]
TABLE = "axial_strain,axial_stress,lateral_stress,volumetric_strain,coordination\n0,1,1,0,4\n0.02,3,1,0.01,4\n"
COMPACTED = """
[material]
dimension = 2
thickness = 0.1
packing = { generator = "compaction", count = 30, radii = [4e-3, 9e-3], seed = 3, pressure = 1e5, friction = 0.3 }
contact = { law = "frictional", young = 6e8, ratio = 0.8, friction = 0.5 }
boundary = { type = "periodic-cell" }
"""
DYNAMICS = """
[mesh]
size = [0.5, 1.0]
divisions = [1, 1]
[dynamics]
density = 2000
duration = 1e-4
[[displacement]]
on = "bottom"
component = "x"
value = 0.0
[[displacement]]
on = "bottom"
component = "y"
value = 0.0
[[displacement]]
on = "top"
component = "y"
value = -1e-5
"""


def every_command(place):
    """Arguments of every command, by a name, that make it write all that it can."""
    write = place.write
    write("sand.txt", "x,y,r\n" + "".join(f"{x},{y},0.0501\n" for x in (0.05, 0.15) for y in (0.05, 0.15)))
    write("a.csv", TABLE)
    imported = ("import", "sand.txt", "--cell", "0.2,0.2", "--thickness", "0.1", "--young", "1e8")
    place.run(*imported, "--name", "i", "--output", "imported")
    point = "vtk_every = 1\npictures = [0.0]\nparticle_measures = true\n"
    return {
        "point": ("point", write("p.toml", point + 'figures = ["p-q", "stress-path", "e-log-p"]\n' + COMPACTED
                                 + POINT.format(steps=2, stretch=0.9999)
                                 + '[[case]]\nname = "a"\nseeds = 2\n[[case]]\nname = "b"\n')),
        "solve": ("solve", write("s.toml", "steps = 2\nvtk_every = 1\npackings = [0]\npoints = [0]\n"
                                 'every_point = ["void_ratio"]\ncheckpoint_every = 1\n' + PERIODIC
                                 + SOLVE.format(value=-1e-5)
                                 + '[picture]\nfields = ["void_ratio"]\npackings = [0]\nextremes = ["coordination"]\n'
                                   '[[prestress.segment]]\nsteps = 1\nF22 = 0.9999\n'
                                   '[[probe]]\nname = "p"\non = "top"\n')),
        "dynamics": ("solve", write("t.toml", 'steps = 2\nsolver = "dynamics"\n' + PERIODIC + DYNAMICS)),
        "solid": ("solve", write("b.toml", "steps = 1\nvtk_every = 1\n[material]" + SPHERES + SOLID_BODY)),
        "dns": ("dns", write("d.toml", "vtk_every = 1\npictures = [0.0]\n" + DNS.format(steps=1))),
        "wave": ("wave", write("w.toml", WAVE.format(repeat=3, duration=1e-4))),
        "pack": ("pack", write("r.toml", LATTICE), "--vtk"),
        "seeds": ("pack", write("g.toml", COMPACTED.replace("[material]", "")), "--seeds", "2"),
        "import": (*imported, "--name", "i"),
        "yade": ("export", "imported/i.toml"),
        "lammps": ("export", "imported/i.toml", "--format", "lammps"),
        "dump": ("export", "imported/i.toml", "--format", "dump"),
        "choose": ("choose", write("h.toml", LATTICE), "--error", "1", "--strain", "1e-3"),
        "compare": ("compare", "a=a.csv", "b=a.csv"),
    }


class OwnFiles(unittest.TestCase):
    def setUp(self):
        self.place = Place()
        self.addCleanup(self.place.temporary.cleanup)
        # Pictures are not what is tested: a gnuplot that draws at once.
        gnuplot = self.place.home / "gnuplot"
        gnuplot.write_text("#!/bin/sh\ncat >/dev/null\necho picture\n")
        gnuplot.chmod(0o755)
        self.place.environment["PATH"] = f"{self.place.home}:{os.environ['PATH']}"
        self.scratch = self.place.path / "scratch"
        self.scratch.mkdir()
        self.place.environment["TMPDIR"] = str(self.scratch)
        self.commands = every_command(self.place)
        self.addCleanup(lambda: self.assertEqual(list(self.scratch.iterdir()), []))

    def run_well(self, *arguments, output="out"):
        status, out, err = self.place.run(*arguments, "--output", output)
        self.assertEqual(status, 0, out + err)
        return out

    def refuses(self, words, *arguments, output="out"):
        """Before any work: nothing is told but the reason with its cure, and nothing is written."""
        before = self.contents(self.place.path)
        status, out, err = self.place.run(*arguments, "--output", output)
        self.assertEqual((status, out), (2, ""), err)
        self.assertIn(words, err)
        self.assertIn("or --force to write over it", err)
        self.assertEqual(self.contents(self.place.path), before)

    def contents(self, directory):
        return {str(path.relative_to(directory)): path.read_bytes()
                for path in pathlib.Path(directory).rglob("*") if path.is_file()}

    def seed(self, directory, names):
        """A file of the user's at each of these names."""
        path = self.place.path / directory
        shutil.rmtree(path, ignore_errors=True)
        path.mkdir()
        for name in names:
            (path / name).write_text(f"mine: {name}\n")

    def check_seeds(self, directory, names):
        for name in names:
            self.assertEqual((self.place.path / directory / name).read_text(), f"mine: {name}\n")

    def test_all_commands_are_here(self):
        known = set(re.findall(r"^  ([a-z]+) ", self.place.run("--help")[1].split("Subcommands:")[1], re.M))
        self.assertEqual({arguments[0] for arguments in self.commands.values()}, known - {"keys"})

    def test_every_output_of_every_command_is_kept(self):
        for name, arguments in self.commands.items():
            with self.subTest(name):
                self.run_well(*arguments, output=name)
                outputs = sorted(self.place.files(name) - {".grainlaw"})
                self.assertGreater(len(outputs), 0)
                self.seed("all", outputs)
                self.refuses("was not written by grainlaw", *arguments, output="all")
                for output in outputs:
                    self.seed("one", [output])
                    self.refuses(f"one/{output}: is there, and was not written by grainlaw", *arguments, output="one")
                self.seed("all", outputs)
                self.run_well(*arguments, "--force", output="all")
                for output in outputs:
                    self.assertNotIn(b"mine", (self.place.path / "all" / output).read_bytes(), output)
                self.run_well(*arguments, output="all")
                self.run_well(*arguments, output=name)
                self.assertEqual(self.place.files(name) - {".grainlaw"}, set(outputs))
                print(f"{name}: {len(outputs)} outputs")

    def test_nothing_beside_the_outputs_is_touched(self):
        for name, arguments in self.commands.items():
            with self.subTest(name):
                self.run_well(*arguments, output=name)
                outputs = self.place.files(name) - {".grainlaw"}
                stems = {pathlib.Path(arguments[1]).stem, "comparison", "i", "p_a_s1", "p_b", "g_s3"}
                beside = {stem + end for stem in stems for end in SCRATCH} | {file + ".new" for file in outputs}
                self.seed("beside", beside - outputs)
                self.run_well(*arguments, output="beside")
                self.check_seeds("beside", beside - outputs)

    def test_nothing_is_touched_where_the_input_is_refused(self):
        for name, arguments in self.commands.items():
            if arguments[0] in ("import", "export", "compare"):
                continue
            with self.subTest(name):
                self.run_well(*arguments, output=name)
                names = self.place.files(name) - {".grainlaw"}
                names |= {pathlib.Path(arguments[1]).stem + end for end in SCRATCH}
                scene = pathlib.Path(arguments[1])
                text = scene.read_text()
                scene.write_text(re.sub(r"(?m)contact = { law = \"\w+\"", 'contact = { law = "none"', text))
                self.seed("refused", names)
                status, out, err = self.place.run(*arguments, "--output", "refused")
                self.assertEqual(status, 2, out + err)
                self.check_seeds("refused", names)
                self.seed("refused", ())
                status, out, err = self.place.run(*arguments, "--output", "refused")
                self.assertEqual(status, 2, out + err)
                self.assertEqual(self.place.files("refused") - {".grainlaw", "p_cases.csv"}, set())

    def test_files_of_the_user_beside_a_path_and_beside_a_packing_that_is_read(self):
        scene = self.place.write("q.toml", "figure = false\n" + PERIODIC + POINT.format(steps=2, stretch=0.999))
        names = ["q_state_particles.csv", "q_state_contacts.csv", "q_state_cell.csv", "q_state.vtp"]
        self.seed("out", names)
        self.run_well("point", scene)
        self.check_seeds("out", names)
        for end in PACKING:
            shutil.copy(self.place.path / "imported" / ("i" + end), self.place.path / ("a_read" + end))
        before = self.contents(self.place.path)
        self.run_well("import", "a_read_particles.csv", "--friction", "0.5463", "--young", "1e8", "--name", "a", output=".")
        after = self.contents(self.place.path)
        self.assertEqual({name: after.get(name) for name in before}, before)

    def test_what_is_read_is_not_written_over(self):
        self.run_well("pack", "r.toml", output=".")
        lattice = LATTICE.split("packing")[0] + "contact" + LATTICE.split("contact")[1]
        packing = "packing = {{ particles = '{0}_particles.csv', contacts = '{0}_contacts.csv', cell = '{0}_cell.csv' }}\n"
        read = "r_particles.csv: is read and would be written over"
        self.place.write("again.toml", lattice + packing.format("r"))
        self.refuses(read, "pack", "again.toml", "--name", "r", output=".")
        # By another spelling, through a link, and with another name.
        (self.place.path / "a").mkdir()
        self.place.write("again.toml", lattice + packing.format("./a/../r"))
        self.refuses(read, "pack", "again.toml", "--name", "r", output=".")
        self.place.write("again.toml", lattice + packing.format("r"))
        os.symlink(".", self.place.path / "linked")
        self.refuses(read, "pack", "again.toml", "--name", "r", output="linked")
        for end in PACKING:
            os.link(self.place.path / ("r" + end), self.place.path / ("hard" + end))
        self.place.write("again.toml", lattice + packing.format("hard"))
        self.refuses("hard_particles.csv: is read and would be written over", "pack", "again.toml", "--name", "r",
                     output=".")
        # The measures of a path, and the path of another case.
        measured = "figure = false\nparticle_measures = true\n"
        path = POINT.format(steps=1, stretch=0.9999)
        self.place.write("r.toml", measured + path + "[material]\n" + lattice + packing.format("r"))
        self.refuses(read, "point", "r.toml", output=".")
        self.place.write("y.toml", measured + PERIODIC + path + '[[case]]\nname = "a"\n')
        self.run_well("point", "y.toml", output=".")
        two = (measured + "[material]\n" + lattice + path + '[[case]]\nname = "a"\n[case.material]\n' + packing.format("r")
               + '[[case]]\nname = "b"\n[case.material]\n' + packing.format("y_a"))
        self.place.write("y.toml", two)
        self.refuses("y_a_particles.csv: is read and would be written over", "point", "y.toml", output=".")
        # The other commands.
        self.place.write("c.toml", "figure = false\n" + PERIODIC + path)
        self.run_well("point", "c.toml", output=".")
        self.refuses("c.csv: is read and would be written over", "compare", "a=a.csv", "b=./c.csv", "--name", "c", output=".")
        self.refuses("sand.txt: is there, and was not written by grainlaw", "export", "imported/i.toml", "--name", "sand",
                     output=".")
        self.refuses("i_particles.csv: is read", "import", "imported/i_particles.csv", "--young", "1e8", output="imported")
        self.refuses("i_particles.csv: is read", "pack", "imported/i.toml", output="imported")
        self.run_well("pack", "imported/i.toml", "--force", output="imported")

    def test_what_the_user_changed_since_is_kept(self):
        self.run_well(*self.commands["import"])
        material = self.place.path / "out/i.toml"
        material.write_text(material.read_text() + "[solver]\ntolerance = 1e-9\n")
        self.refuses("out/i.toml: is there, and was not written by grainlaw or was changed since", *self.commands["import"])
        self.run_well(*self.commands["solve"])
        table = self.place.path / "out/s_force.csv"
        text = table.read_text()
        table.write_text(text + "a remark\n")
        self.refuses("out/s_force.csv: is there", *self.commands["solve"])
        table.write_text(text)
        self.run_well(*self.commands["solve"])

    def test_links_are_files_of_the_user(self):
        scene = self.place.write("q.toml", "figure = false\n" + PERIODIC + POINT.format(steps=1, stretch=0.999))
        (self.place.path / "out").mkdir()
        self.place.write("precious", "mine\n")
        for target in ("../precious", "../nothing"):
            os.symlink(target, self.place.path / "out/q.csv")
            self.refuses("out/q.csv: is there", "point", scene)
            (self.place.path / "out/q.csv").unlink()

    def test_a_checkpoint_vouches_for_its_tables_where_the_list_is_lost(self):
        scene = self.place.write("s.toml", "steps = 3\n" + PERIODIC + SOLVE.format(value=-1e-5))
        self.run_well("solve", scene, "--stop-after", "1")
        shutil.rmtree(self.place.path / "out/.grainlaw")
        for picture in self.place.path.glob("out/*.[sp][vn]g"):
            picture.unlink()
        out = self.run_well("solve", scene, "--restart", "--stop-after", "2")
        self.assertIn("goes on after step 1", out)
        self.run_well("solve", scene, "--restart")
        (self.place.path / "out/s.checkpoint").write_text("mine\n")
        self.refuses("out/s.checkpoint: is there", "solve", scene)
        status, _, err = self.place.run("solve", scene, "--restart", "--output", "out")
        self.assertEqual(status, 2, err)
        self.assertEqual((self.place.path / "out/s.checkpoint").read_text(), "mine\n")

    def test_a_second_run_leaves_what_a_first_one_is_writing(self):
        scene = self.place.write("s.toml", "steps = 400\n" + PERIODIC + SOLVE.format(value=-1e-5))
        first = self.place.start("solve", scene, "--output", "out")
        table = self.place.path / "out/s_force.csv"
        while not table.exists():
            self.assertIsNone(first.poll())
            time.sleep(0.01)
        first.send_signal(signal.SIGSTOP)
        status, _, err = self.place.run("solve", scene, "--output", "out")
        self.assertEqual(status, 1, err)
        self.assertRegex(err, r"out/s\w*\.csv: another run is writing it, expected one at a time: wait for its end, or give another")
        self.run_well("point", self.place.write("q.toml", "figure = false\n" + PERIODIC + POINT.format(steps=1, stretch=0.999)))
        first.send_signal(signal.SIGCONT)
        _, err = first.communicate(timeout=300)
        self.assertEqual(first.returncode, 0, err)
        self.assertEqual(len(table.read_text().splitlines()), 402)
        self.run_well("solve", scene)


if __name__ == "__main__":
    unittest.main()
